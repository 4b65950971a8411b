//! Which colliders interact: layers as bits, and the memberships and filters of one collider.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::Component;
use bevy_ecs::reflect::ReflectComponent;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use core::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, BitXorAssign, Not};

pub use avian_derive::PhysicsLayer;

/// A layer that a collider can be in: usually an enum without fields that derives this trait.
///
/// The `#[default]` variant is bit 0, the layer of colliders that name none.
///
/// ```
/// # use avian::prelude::*;
/// #[derive(PhysicsLayer, Clone, Copy, Default)]
/// enum Layer {
///     #[default]
///     Ground,
///     Player,
///     Enemy,
/// }
///
/// assert_eq!(Layer::Ground.to_bits(), 1);
/// assert_eq!(Layer::all_bits(), 0b111);
///
/// let player = CollisionLayers::new(Layer::Player, [Layer::Ground, Layer::Enemy]);
/// let enemy = CollisionLayers::new(Layer::Enemy, LayerMask::ALL);
/// assert!(player.interacts_with(enemy));
/// ```
pub trait PhysicsLayer: Sized + Default {
    /// The layer as a mask, usually with one bit set.
    fn to_bits(&self) -> u32;

    /// The mask with the bits of every layer of this type.
    fn all_bits() -> u32;
}

impl<'a, L: PhysicsLayer> PhysicsLayer for &'a L
where
    &'a L: Default,
{
    fn to_bits(&self) -> u32 {
        L::to_bits(self)
    }

    fn all_bits() -> u32 {
        L::all_bits()
    }
}

/// A set of up to 32 layers, one per bit.
#[derive(Reflect, Clone, Copy, Debug, Deref, DerefMut, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct LayerMask(pub u32);

impl LayerMask {
    /// Every layer.
    pub const ALL: Self = Self(0xffff_ffff);
    /// No layer.
    pub const NONE: Self = Self(0);
    /// The default layer, bit 0.
    pub const DEFAULT: Self = Self(1);

    /// Adds layers to this mask.
    #[inline]
    pub fn add(&mut self, layers: impl Into<Self>) {
        self.0 |= layers.into().0;
    }

    /// Removes layers from this mask.
    #[inline]
    pub fn remove(&mut self, layers: impl Into<Self>) {
        self.0 &= !layers.into().0;
    }

    /// Whether all of the given layers are in this mask.
    #[inline]
    pub fn has_all(self, layers: impl Into<Self>) -> bool {
        let layers = layers.into().0;
        self.0 & layers == layers
    }
}

impl From<u32> for LayerMask {
    fn from(bits: u32) -> Self {
        Self(bits)
    }
}

impl<L: PhysicsLayer> From<L> for LayerMask {
    fn from(layer: L) -> Self {
        Self(layer.to_bits())
    }
}

impl<L: Into<LayerMask>, const N: usize> From<[L; N]> for LayerMask {
    fn from(layers: [L; N]) -> Self {
        layers.into_iter().fold(Self::NONE, |mask, layer| mask | layer)
    }
}

impl<L: Into<LayerMask> + Copy> PartialEq<L> for LayerMask {
    fn eq(&self, other: &L) -> bool {
        self.0 == (*other).into().0
    }
}

/// Implements the operators between a mask and types that convert to one.
macro_rules! mask_operators {
    ($($op:ident $method:ident $assign:ident $assign_method:ident $symbol:tt)+) => {$(
        impl<L: Into<LayerMask>> $op<L> for LayerMask {
            type Output = Self;

            #[inline]
            fn $method(self, other: L) -> Self {
                Self(self.0 $symbol other.into().0)
            }
        }

        impl<L: Into<LayerMask>> $assign<L> for LayerMask {
            #[inline]
            fn $assign_method(&mut self, other: L) {
                *self = *self $symbol other;
            }
        }
    )+};
}

mask_operators! {
    BitAnd bitand BitAndAssign bitand_assign &
    BitOr bitor BitOrAssign bitor_assign |
    BitXor bitxor BitXorAssign bitxor_assign ^
}

impl Not for LayerMask {
    type Output = Self;

    #[inline]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

/// The layers that a collider is in, and the layers it interacts with.
///
/// Two colliders interact if the filters of each contain a layer of the other. By default a collider is in
/// layer 0 and interacts with all layers. The component is immutable: insert it again to change it, and
/// existing contacts are filtered again.
///
/// ```
/// # use avian::prelude::*;
/// #[derive(PhysicsLayer, Default, Clone, Copy)]
/// enum Layer {
///     #[default]
///     World,
///     Player,
///     Bullet,
/// }
///
/// let player = CollisionLayers::new(Layer::Player, LayerMask::ALL);
/// let bullet = CollisionLayers::new(Layer::Bullet, [Layer::World, Layer::Player]);
/// assert!(player.interacts_with(bullet));
/// assert!(!bullet.interacts_with(bullet));
/// ```
#[derive(Reflect, Clone, Copy, Component, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[component(immutable)]
pub struct CollisionLayers {
    /// The layers that the collider is in.
    pub memberships: LayerMask,
    /// The layers that the collider interacts with.
    pub filters: LayerMask,
}

impl CollisionLayers {
    /// In the default layer, interacts with all.
    pub const DEFAULT: Self = Self { memberships: LayerMask::DEFAULT, filters: LayerMask::ALL };
    /// In every layer, interacts with all.
    pub const ALL: Self = Self { memberships: LayerMask::ALL, filters: LayerMask::ALL };
    /// In no layer, interacts with nothing.
    pub const NONE: Self = Self { memberships: LayerMask::NONE, filters: LayerMask::NONE };
    /// In every layer, interacts with nothing.
    pub const ALL_MEMBERSHIPS: Self = Self { memberships: LayerMask::ALL, filters: LayerMask::NONE };
    /// In no layer, interacts with all.
    pub const ALL_FILTERS: Self = Self { memberships: LayerMask::NONE, filters: LayerMask::ALL };

    /// In the layers `memberships`, interacting with the layers `filters`.
    pub fn new(memberships: impl Into<LayerMask>, filters: impl Into<LayerMask>) -> Self {
        Self { memberships: memberships.into(), filters: filters.into() }
    }

    /// Layers from raw bits.
    pub const fn from_bits(memberships: u32, filters: u32) -> Self {
        Self { memberships: LayerMask(memberships), filters: LayerMask(filters) }
    }

    /// Whether two colliders with these layers interact. Both filters must allow it.
    #[inline]
    pub fn interacts_with(self, other: Self) -> bool {
        self.memberships & other.filters != LayerMask::NONE
            && other.memberships & self.filters != LayerMask::NONE
    }
}

impl Default for CollisionLayers {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug, Default)]
    enum Layer {
        #[default]
        Ground,
        Player,
    }

    impl PhysicsLayer for Layer {
        fn to_bits(&self) -> u32 {
            1 << *self as u32
        }

        fn all_bits() -> u32 {
            0b11
        }
    }

    #[test]
    fn masks_are_sets_of_layers() {
        let mut mask = LayerMask::from([Layer::Ground, Layer::Player]);
        assert_eq!(mask, 0b11);
        assert!(mask.has_all(Layer::Player) && mask.has_all([Layer::Ground, Layer::Player]));
        mask.remove(Layer::Ground);
        assert_eq!(mask, Layer::Player);
        assert!(!mask.has_all([Layer::Ground, Layer::Player]));
        mask.add(4);
        assert_eq!(mask, 0b110);
        assert_eq!(
            (mask & 4, mask | 1, mask ^ 6, !LayerMask::NONE),
            (LayerMask(4), LayerMask(7), LayerMask(0), LayerMask::ALL)
        );
        mask &= Layer::Player;
        mask |= 8;
        mask ^= 2;
        assert_eq!(mask, 8);
        assert_eq!(LayerMask::from([0u32; 0]), LayerMask::NONE);
    }

    #[test]
    fn both_sides_must_want_to_interact() {
        let ground = CollisionLayers::new(Layer::Ground, LayerMask::ALL);
        let ghost = CollisionLayers::new(Layer::Player, LayerMask::NONE);
        let player = CollisionLayers::new(Layer::Player, Layer::Ground);
        assert!(player.interacts_with(ground) && ground.interacts_with(player));
        assert!(!player.interacts_with(player));
        assert!(!ghost.interacts_with(ground) && !ground.interacts_with(ghost));
    }

    #[test]
    fn the_default_is_in_layer_zero_and_meets_all() {
        let default = CollisionLayers::default();
        assert_eq!(default, CollisionLayers::from_bits(1, u32::MAX));
        assert!(default.interacts_with(default) && default.interacts_with(CollisionLayers::ALL));
        for other in [CollisionLayers::NONE, CollisionLayers::ALL_MEMBERSHIPS, CollisionLayers::ALL_FILTERS] {
            assert!(!default.interacts_with(other) && !other.interacts_with(CollisionLayers::ALL));
        }
        assert!(!CollisionLayers::ALL_MEMBERSHIPS.interacts_with(CollisionLayers::ALL_FILTERS));
    }
}
