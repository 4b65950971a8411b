//! Pairs of shapes as in a heap: face on face, aligned and rotated, and edges and corners at any angle, some
//! overlapping and some slightly apart.

use super::dim;
use crate::kernel;
use kernel::manifold::{FeatureCache, LocalManifold, collide};
use kernel::math::{Pose, Rot, Vector};
use kernel::shape::Shape;

/// Maximum distance at which contacts are predicted, in metres.
pub const PREDICTION: f32 = 0.02;

/// Pseudo-random numbers, the same in each run (G. Marsaglia, "Xorshift RNGs", 2003).
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// A number from `low` up to `high`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * ((self.next() >> 40) as f32 / (1u64 << 24) as f32)
    }

    /// An index below a number.
    pub fn pick(&mut self, count: usize) -> usize {
        (self.next() >> 33) as usize % count
    }

    /// A vector with components within `range`.
    pub fn vector(&mut self, range: f32) -> Vector {
        Vector::AXES.iter().fold(Vector::ZERO, |v, axis| v + *axis * self.between(-range, range))
    }

    /// A unit vector.
    pub fn direction(&mut self) -> Vector {
        loop {
            let v = self.vector(1.0);
            if v.length() > 0.1 && v.length() < 1.0 {
                return v * (1.0 / v.length());
            }
        }
    }
}

/// The relative orientation of two shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lie {
    /// Face on face, with parallel sides for boxes.
    Stacked,
    /// Face on face, rotated about the normal.
    Turned,
    /// Any orientation.
    Loose,
}

/// All orientations; the last is as frequent as the others together.
pub const MIXED: [Lie; 4] = [Lie::Stacked, Lie::Loose, Lie::Turned, Lie::Loose];

/// Two shapes.
pub struct Pair {
    pub shapes: [Shape; 2],
    /// The pose of the second shape in the frame of the first, in a step and in the next.
    pub poses: [Pose; 2],
    /// State from the first step for the next.
    pub cache: FeatureCache,
}

impl Pair {
    /// Places the second shape so that the surfaces overlap by up to 1 cm, or are apart by up to the
    /// prediction distance.
    pub fn new(shapes: [Shape; 2], lie: Lie, dice: &mut Dice) -> Self {
        let (rotation, direction, aside) = match lie {
            Lie::Loose => (dim::rotation(dice), dice.direction(), Vector::ZERO),
            Lie::Stacked | Lie::Turned => {
                let normals = [0, 1].map(|i| dim::normal_of(&shapes[i], dice));
                let tilt = dim::small_turn(dice, 0.003);
                let facing = dim::facing(normals, lie == Lie::Turned, dice);
                let aside = dice.vector(0.3);
                (tilt.mul(facing), normals[0], aside - normals[0] * aside.dot(normals[0]))
            }
        };
        let wanted = dice.between(-0.01, 0.9 * PREDICTION);
        let at = |t: f32| Pose::new(direction * t + aside, rotation.normalized());
        let (mut low, mut high) = (0.0, 4.0);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            let far = separation(&shapes, &at(middle)) > wanted;
            (low, high) = if far { (low, middle) } else { (middle, high) };
        }
        let first = at(high);
        let turn: Rot = dim::small_turn(dice, 0.001);
        let second = Pose::new(first.position + dice.vector(0.0005), turn.mul(first.rotation).normalized());
        let mut cache = FeatureCache::NONE;
        collide(&shapes[0], &shapes[1], &first, PREDICTION, &mut cache, &mut LocalManifold::default());
        Self { shapes, poses: [first, second], cache }
    }
}

fn separation(shapes: &[Shape; 2], pose: &Pose) -> f32 {
    let mut out = LocalManifold::default();
    collide(&shapes[0], &shapes[1], pose, 100.0, &mut FeatureCache::NONE.clone(), &mut out);
    out.points().iter().fold(100.0, |least, p| p.separation.min(least))
}

/// A number of pairs of a kind, each with shapes of its own.
pub fn pairs(count: usize, lies: &[Lie], shapes: &mut dyn FnMut(&mut Dice) -> [Shape; 2]) -> Vec<Pair> {
    let mut dice = Dice::new(7);
    (0..count)
        .map(|i| {
            let shapes = shapes(&mut dice);
            Pair::new(shapes, lies[i % lies.len()], &mut dice)
        })
        .collect()
}
