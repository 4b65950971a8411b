//! Computes the mass properties of bodies.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_transform::prelude::Transform;

use super::{
    components::{
        AngularInertia, CenterOfMass, ColliderMassProperties, ComputedAngularInertia, ComputedCenterOfMass,
        ComputedMass, Mass, NoAutoAngularInertia, NoAutoCenterOfMass, NoAutoMass,
    },
    inertia::{Inertia, Part, PartFrame, computed_center},
};
use crate::{
    collision::collider::{
        ColliderDisabled, Sensor,
        collider_hierarchy::{ColliderOf, RigidBodyColliders},
        collider_transform::ColliderTransform,
    },
    dynamics::rigid_body::RigidBody,
    math::MassProperties,
};

/// Computes mass properties on demand: the totals of a body, or of its parts.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn weigh(bodies: Query<Entity, With<RigidBody>>, mass: MassPropertyHelper) -> f32 {
///     bodies.iter().map(|body| mass.total_mass_properties(body).mass).sum()
/// }
/// ```
#[derive(SystemParam)]
pub struct MassPropertyHelper<'w, 's> {
    totals: Query<
        'w,
        's,
        (
            Option<&'static RigidBody>,
            &'static mut ComputedMass,
            &'static mut ComputedAngularInertia,
            &'static mut ComputedCenterOfMass,
            Has<NoAutoMass>,
            Has<NoAutoAngularInertia>,
            Has<NoAutoCenterOfMass>,
        ),
    >,
    parts: Query<
        'w,
        's,
        (
            Option<&'static Mass>,
            Option<&'static AngularInertia>,
            Option<&'static CenterOfMass>,
            Option<&'static ColliderMassProperties>,
            Option<&'static ColliderTransform>,
            Has<ColliderOf>,
            (Has<Sensor>, Has<ColliderDisabled>),
        ),
        Or<(With<Mass>, With<AngularInertia>, With<CenterOfMass>, With<ColliderMassProperties>)>,
    >,
    hierarchy: Query<
        'w,
        's,
        (
            Option<&'static Children>,
            Option<&'static RigidBodyColliders>,
            Option<&'static Transform>,
            Has<RigidBody>,
        ),
    >,
}

impl MassPropertyHelper<'_, '_> {
    /// Computes an entity's [`ComputedMass`], [`ComputedAngularInertia`] and [`ComputedCenterOfMass`] by the
    /// rules of the [module](super). Does nothing to an entity that lacks any of the three.
    ///
    /// A static body gets infinite mass and inertia.
    pub fn update_mass_properties(&mut self, entity: Entity) {
        let total = self.total(entity);
        let own = self.parts.get(entity).ok().map(|(mass, inertia, center, ..)| {
            let none = Part::ZERO.overridden(mass, inertia, center);
            (mass.map(|_| none.mass), inertia.map(|_| none.inertia), center.map(|_| none.center))
        });
        let (own_mass, own_inertia, own_center) = own.unwrap_or((None, None, None));
        let Ok((body, mut mass, mut inertia, mut center, no_auto_mass, no_auto_inertia, no_auto_center)) =
            self.totals.get_mut(entity)
        else {
            return;
        };
        // A property that is restricted to the body's own component is left to the app if this component is
        // missing.
        let choose_center = if no_auto_center { own_center } else { Some(total.center) };
        if let Some(value) = choose_center {
            center.set_if_neq(computed_center(value));
        }
        if body.is_some_and(RigidBody::is_static) {
            mass.set_if_neq(ComputedMass::INFINITY);
            inertia.set_if_neq(ComputedAngularInertia::INFINITY);
            return;
        }
        let choose_mass = if no_auto_mass { own_mass } else { Some(total.mass) };
        if let Some(value) = choose_mass {
            mass.set_if_neq(Part { mass: value, ..total }.computed_mass());
        }
        let choose_inertia: Option<Inertia> = if no_auto_inertia { own_inertia } else { Some(total.inertia) };
        if let Some(value) = choose_inertia {
            inertia.set_if_neq(value.computed());
        }
    }

    /// The number of colliders and children of a body.
    pub(super) fn count_parts(&self, body: Entity) -> usize {
        let Ok((children, colliders, ..)) = self.hierarchy.get(body) else { return 0 };
        children.map_or(0, |list| list.len()) + colliders.map_or(0, |list| list.len())
    }

    /// The mass properties of an entity and its descendants, in the entity's frame. [`NoAutoMass`] and its
    /// siblings are ignored.
    pub fn total_mass_properties(&self, entity: Entity) -> MassProperties {
        self.total(entity).to_properties()
    }

    /// The mass properties of an entity's descendants, without the entity, in the entity's frame.
    pub fn descendants_mass_properties(&self, entity: Entity) -> MassProperties {
        let mut parts = Vec::new();
        self.collect_descendants(entity, &mut parts);
        Part::sum(&parts).to_properties()
    }

    /// The mass properties of an entity without its descendants: its collider's properties, with values
    /// replaced by the entity's own components. `None` if it has neither.
    pub fn local_mass_properties(&self, entity: Entity) -> Option<MassProperties> {
        self.local(entity).map(Part::to_properties)
    }

    fn total(&self, entity: Entity) -> Part {
        let mut parts = Vec::new();
        parts.extend(self.local(entity));
        self.collect_descendants(entity, &mut parts);
        Part::sum(&parts)
    }

    fn local(&self, entity: Entity) -> Option<Part> {
        let (mass, inertia, center, collider, _, _, (sensor, disabled)) = self.parts.get(entity).ok()?;
        let part = match collider {
            Some(collider) if !sensor && !disabled => Part::from_collider(collider),
            _ => Part::ZERO,
        };
        Some(part.overridden(mass, inertia, center))
    }

    /// Adds the properties of a body's colliders on other entities, then of its other descendants.
    fn collect_descendants(&self, body: Entity, parts: &mut Vec<Part>) {
        let Ok((children, colliders, transform, _)) = self.hierarchy.get(body) else {
            return;
        };
        for collider in colliders.into_iter().flatten().filter(|collider| *collider != body) {
            if let (Some(part), Ok((.., transform, _, _))) = (self.local(collider), self.parts.get(collider))
            {
                let frame = transform.map(PartFrame::of_collider);
                parts.push(frame.map_or(part, |frame| part.moved(&frame)));
            }
        }
        let Some(children) = children else {
            return;
        };
        let frame = PartFrame::scaled_by(transform.unwrap_or(&Transform::IDENTITY));
        let mut pending: Vec<(Entity, PartFrame)> =
            children.iter().rev().map(|child| (child, frame)).collect();
        while let Some((entity, outer)) = pending.pop() {
            let Ok((children, _, transform, false)) = self.hierarchy.get(entity) else {
                continue;
            };
            let frame = outer.then(&PartFrame::of_entity(transform.unwrap_or(&Transform::IDENTITY)));
            if let Ok((mass, inertia, center, _, _, false, _)) = self.parts.get(entity)
                && (mass.is_some() || inertia.is_some() || center.is_some())
            {
                parts.push(Part::ZERO.overridden(mass, inertia, center).moved(&frame));
            }
            pending.extend(children.into_iter().flatten().rev().map(|child| (*child, frame)));
        }
    }
}
