//! [`CollisionHit`]: impacts above a minimum speed, for sound and damage.
//!
//! A collider with [`CollisionHitsEnabled`] reports each impact in which it meets another collider faster
//! than its [`min_speed`](CollisionHitsEnabled::min_speed). Hits are sent as messages and entity events, just
//! before the [collision events](super::collision_events) of the step.
//!
//! ```
//! # use avian::prelude::*;
//! # use bevy_ecs::prelude::*;
//! # #[derive(Component)]
//! # struct Health(f32);
//! fn spawn(mut commands: Commands) {
//!     commands
//!         .spawn((RigidBody::Dynamic, Collider::default(), CollisionHitsEnabled::above(3.0), Health(100.0)))
//!         .observe(|hit: On<CollisionHit>, mut healths: Query<&mut Health>| {
//!             if let Ok(mut health) = healths.get_mut(hit.collider1) {
//!                 health.0 -= hit.impulse as f32;
//!             }
//!         });
//! }
//! ```

use bevy_ecs::{message::Messages, prelude::*};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::{
    contact::{Contact, Manifold},
    math as k,
    solver::ManifoldBlow,
    table::{BodyTable, NONE, Velocity},
};

use crate::{
    collision::collision_events::IsSending,
    dynamics::{
        reports::{Approach, Blow, GoingBlow, Hits},
        solver::{config::PhysicsLengthUnit, substeps::StepSolver},
        tables::{Bodies, Colliders, Contacts},
    },
    math::{AdjustPrecision, Scalar, Vector, to_f32, vector_from_kernel, world_from_kernel},
};

/// Two colliders hit each other.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CollisionHit {
    /// The first collider, on which observers run.
    #[event_target]
    pub collider1: Entity,
    /// The second collider.
    pub collider2: Entity,
    /// The body of the first collider, if it has one.
    pub body1: Option<Entity>,
    /// The body of the second collider, if it has one.
    pub body2: Option<Entity>,
    /// The point of impact in the world, in metres: the mean of the contact points, weighted by their
    /// impulses.
    pub point: Vector,
    /// The unit normal at the point, from the first collider to the second.
    pub normal: Vector,
    /// The approach speed along the normal at the impact, m/s.
    pub speed: Scalar,
    /// The impulse along the normal, N·s. The impulse that stops a body is its momentum. If the body hits
    /// several colliders at once, they share the impulse.
    pub impulse: Scalar,
}

impl From<Blow> for CollisionHit {
    fn from(blow: Blow) -> Self {
        let Blow { colliders: [collider1, collider2], bodies: [body1, body2], point, normal, speed, impulse } =
            blow;
        Self { collider1, collider2, body1, body2, point, normal, speed, impulse }
    }
}

impl CollisionHit {
    /// The same hit, seen from the other collider.
    pub fn flipped(&self) -> Self {
        Self {
            collider1: self.collider2,
            collider2: self.collider1,
            body1: self.body2,
            body2: self.body1,
            normal: -self.normal,
            ..*self
        }
    }
}

/// Makes a collider report impacts by [`CollisionHit`].
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, Default, PartialEq)]
pub struct CollisionHitsEnabled {
    /// Impacts with a higher approach speed are reported, m/s, times the [`PhysicsLengthUnit`]. 1 by default.
    /// NaN reports none.
    pub min_speed: Scalar,
}

impl Default for CollisionHitsEnabled {
    fn default() -> Self {
        Self::above(1.0)
    }
}

impl CollisionHitsEnabled {
    /// Reports impacts above a speed, m/s.
    pub fn above(min_speed: Scalar) -> Self {
        Self { min_speed }
    }
}

/// Records the contacts of reporting colliders before they are solved.
pub(crate) fn note_approaches(
    settings: Query<&CollisionHitsEnabled>,
    unit: Res<PhysicsLengthUnit>,
    bodies: Res<Bodies>,
    colliders: Res<Colliders>,
    mut contacts: ResMut<Contacts>,
) {
    let Contacts { table, hits, .. } = &mut *contacts.bypass_change_detection();
    let Hits { approaches, going, .. } = hits;
    approaches.clear();
    if colliders.hitting.is_empty() {
        return going.clear();
    }
    let all = colliders.hitting.iter().flat_map(|id| table.of_collider(id, &colliders.table));
    let mut ids: Vec<u32> = all.filter(|id| table.is_active(*id) && table.get(*id).is_solved()).collect();
    ids.sort_unstable();
    ids.dedup();
    for id in ids {
        let contact = table.get(id);
        let entities = contact.colliders.map(|collider| colliders.entities[collider as usize]);
        let min_speed = |entity: Entity| settings.get(entity).map_or(f32::INFINITY, |s| to_f32(s.min_speed));
        let min_speed = min_speed(entities[0]).min(min_speed(entities[1])) * unit.metres();
        let blow = going.binary_search_by_key(&id, |blow| blow.contact).ok().map(|place| going[place]);
        let mut approach = Approach {
            min_speed,
            blow: blow.filter(|blow| blow.colliders == entities),
            ..approach(&bodies.table, &colliders, id, contact)
        };
        let manifolds = core::iter::once(&contact.manifold).chain(table.extra_of(contact));
        let solved = manifolds.filter(|manifold| manifold.solved_points() > 0);
        let mut points =
            solved.flat_map(|manifold| manifold.points().iter().map(move |p| (manifold, p.anchor)));
        approach.is_fast =
            points.any(|(manifold, anchor)| approach.speed(manifold.normal, anchor) > min_speed);
        approaches.push(approach);
    }
    going.clear();
}

/// The bodies of a contact before it is solved.
fn approach(bodies: &BodyTable, colliders: &Colliders, id: u32, contact: &Contact) -> Approach {
    let center = |side: usize| match contact.bodies[side] {
        NONE => colliders.table.poses[contact.colliders[side] as usize].position,
        body => bodies.poses[body as usize].center,
    };
    Approach {
        contact: id,
        colliders: contact.colliders.map(|collider| colliders.entities[collider as usize]),
        center: center(0),
        offset: (center(1) - center(0)).to_local(),
        velocities: velocities(bodies, contact.bodies),
        min_speed: f32::INFINITY,
        is_fast: false,
        blow: None,
    }
}

impl Approach {
    /// The approach speed of the bodies at a point, given relative to the first centre of mass.
    fn speed(&self, normal: k::Vector, anchor: k::Vector) -> f32 {
        -self.parting(self.velocities, normal, anchor)
    }

    /// The separation speed along the normal at a point, for the given velocities.
    fn parting(&self, [a, b]: [Velocity; 2], normal: k::Vector, anchor: k::Vector) -> f32 {
        let arm = anchor - self.offset;
        normal.dot(b.linear + b.angular.cross(arm) - a.linear - a.angular.cross(anchor))
    }
}

fn velocities(bodies: &BodyTable, pair: [u32; 2]) -> [Velocity; 2] {
    pair.map(|body| match body {
        NONE => Velocity::default(),
        body => bodies.velocities[body as usize],
    })
}

/// Makes hits of fast contacts that got impulses, once at least half of the approach speed is gone. An impact
/// that takes several steps is one hit, with its highest approach speed.
pub(crate) fn find_hits(solver: Res<StepSolver>, bodies: Res<Bodies>, mut contacts: ResMut<Contacts>) {
    let Contacts { table, hits: Hits { approaches, going, blows }, .. } =
        &mut *contacts.bypass_change_detection();
    if approaches.is_empty() {
        return;
    }
    let mut struck: Vec<ManifoldBlow> = solver.kernel.blows().collect();
    // The sort is stable: the blows of a contact stay in order of time.
    struck.sort_by_key(|blow| blow.contact);
    for approach in approaches.drain(..) {
        let contact = table.get(approach.contact);
        let manifolds = core::iter::once(&contact.manifold).chain(table.extra_of(contact));
        let places = manifolds.filter_map(struck_place);
        let place = places.clone().max_by(|a, b| a.impulse.total_cmp(&b.impulse));
        let Some(Struck { normal, anchor, .. }) = place else { continue };
        let first = struck.partition_point(|blow| blow.contact < approach.contact);
        let of_contact = struck[first..].iter().take_while(|blow| blow.contact == approach.contact);
        let gained = of_contact.clone().next().map_or(0.0, |blow| blow.gained);
        let before = approach.blow.map_or(k::Vector::ZERO, |blow| blow.impulse);
        let impulse = of_contact.fold(before, |sum, blow| sum + blow.impulse);
        let now = approach.speed(normal, anchor) + gained;
        let is_fast = approach.is_fast || now > approach.min_speed;
        if !is_fast && approach.blow.is_none_or(|blow| blow.is_told) {
            continue;
        }
        let speed = approach.blow.map_or(now, |blow| blow.speed.max(now));
        if !(speed > approach.min_speed) {
            continue;
        }
        let change = approach.parting(velocities(&bodies.table, contact.bodies), normal, anchor) + speed;
        let was_told = approach.blow.is_some_and(|blow| blow.is_told);
        let is_told = was_told || change > 0.5 * speed;
        let Approach { contact: id, colliders, center, offset, .. } = approach;
        let is_now = is_told && !was_told;
        let along = impulse.dot(normal);
        let mut movable = contact.bodies.into_iter().filter(|body| *body != NONE);
        if is_now && !(along > 0.0) && movable.any(|body| solver.kernel.was_struck(bodies.table.row(body))) {
            // Another collider stopped the body.
            continue;
        }
        going.push(GoingBlow { contact: id, colliders, speed, impulse, is_told });
        if !is_now {
            continue;
        }
        let impulse = if along > 0.0 {
            along
        } else {
            // Slow bodies get no blow. The impulses of their step also carry their weight.
            let arms = [anchor, anchor - offset];
            let stopping = change * mass_along(&solver, &bodies.table, contact.bodies, normal, arms);
            stopping.min(places.map(|place| place.impulse).sum())
        };
        blows.push(Blow {
            colliders,
            bodies: contact.bodies.map(|body| (body != NONE).then(|| bodies.entities[body as usize])),
            point: world_from_kernel(center + anchor.to_world()),
            normal: vector_from_kernel(normal),
            speed: speed.adjust_precision(),
            impulse: impulse.adjust_precision(),
        });
    }
}

/// The effective mass of two bodies along a normal, at a point given relative to both centres of mass. 0 if
/// neither body moves.
fn mass_along(
    solver: &StepSolver,
    bodies: &BodyTable,
    pair: [u32; 2],
    normal: k::Vector,
    arms: [k::Vector; 2],
) -> f32 {
    let mut inverse_mass = 0.0;
    for (body, arm) in pair.into_iter().zip(arms).filter(|(body, _)| *body != NONE) {
        let mass = solver.kernel.bodies.masses.get(bodies.row(body) as usize).copied().unwrap_or_default();
        let moment = arm.cross(normal);
        inverse_mass += mass.inv_mass() + moment.dot(mass.inv_inertia().apply(moment));
    }
    if inverse_mass > 0.0 { 1.0 / inverse_mass } else { 0.0 }
}

/// The place where a manifold got impulses.
struct Struck {
    impulse: f32,
    normal: k::Vector,
    /// The mean of the points, weighted by their impulses, relative to the first centre of mass.
    anchor: k::Vector,
}

/// The place where a manifold got impulses in this step, if it got any.
fn struck_place(manifold: &Manifold) -> Option<Struck> {
    let points = &manifold.points()[..manifold.solved_points() as usize];
    let impulse = points.iter().fold(0.0, |sum, point| sum + point.total_impulse);
    let sum = points.iter().fold(k::Vector::ZERO, |sum, point| sum + point.anchor * point.total_impulse);
    (impulse > 0.0).then(|| Struck { impulse, normal: manifold.normal, anchor: sum * (1.0 / impulse) })
}

/// Sends the hits of the step.
pub(crate) fn send_hits(world: &mut World) {
    let mut contacts = world.resource_mut::<Contacts>();
    if contacts.hits.blows.is_empty() {
        return;
    }
    let blows = core::mem::take(&mut contacts.bypass_change_detection().hits.blows);
    // Collisions that observers of hits end are sent with the collision events of the step.
    world.resource_mut::<IsSending>().0 = true;
    let hits: Vec<CollisionHit> = blows.into_iter().map(CollisionHit::from).collect();
    if let Some(mut messages) = world.get_resource_mut::<Messages<CollisionHit>>() {
        messages.write_batch(hits.iter().copied());
    }
    for hit in hits {
        for seen in [hit, hit.flipped()] {
            let entity = world.get_entity(seen.collider1);
            if entity.is_ok_and(|entity| entity.contains::<CollisionHitsEnabled>()) {
                world.trigger(seen);
                // The commands of this observer are applied before the next observer runs.
                world.flush();
            }
        }
    }
    world.resource_mut::<IsSending>().0 = false;
}
