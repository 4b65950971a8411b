//! Colliders by id: native shape, world pose, boxes, surface, layers and revision.
#![expect(unsafe_code, reason = "colliders are changed by several threads, each its own")]

use super::{BodyKind, BodyTable, NONE};
use crate::data::{BitSet, IdPool, Parts, prefetch};
use crate::math::{DIM, Pose, Rot, Vector, WorldPose, min};
use crate::shape::{Aabb, Shape};
use crate::thread_pool::ThreadPool;
use core::ops::{Index, IndexMut};
use std::sync::{Mutex, PoisonError};

/// Number of bodies in a block of the job that refreshes their colliders.
const BLOCK: usize = 128;

/// So many bodies ahead colliders are brought near.
const AHEAD: usize = 8;

/// How two surfaces' coefficients make one. Of two different rules the greater wins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Combine {
    /// (a + b) / 2.
    #[default]
    Average = 1,
    /// √(a b).
    GeometricMean = 2,
    /// The smaller.
    Min = 3,
    /// a b.
    Multiply = 4,
    /// The larger.
    Max = 5,
}

/// A coefficient and how it is combined with another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surface {
    /// ≥ 0.
    pub coefficient: f32,
    /// The rule.
    pub rule: Combine,
}

impl Surface {
    /// The coefficient of two surfaces in contact.
    #[inline]
    pub fn mix(self, other: Self) -> f32 {
        let (a, b) = (self.coefficient, other.coefficient);
        match self.rule.max(other.rule) {
            Combine::Average => 0.5 * (a + b),
            Combine::GeometricMean => (a * b).sqrt(),
            Combine::Min => crate::math::min(a, b),
            Combine::Multiply => a * b,
            Combine::Max => crate::math::max(a, b),
        }
    }
}

/// A collider's surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Material {
    /// Of sliding.
    pub friction: Surface,
    /// Of bouncing, 0 … 1.
    pub restitution: Surface,
}

/// What a collider is and what it collides with, as bit masks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layers {
    /// What it is.
    pub memberships: u32,
    /// What it collides with.
    pub filters: u32,
}

impl Layers {
    /// Whether each is in the other's filter.
    #[inline(always)]
    pub fn interacts_with(self, other: Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }
}

/// Bits of a collider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColliderFlags {
    /// Detects, but is not pushed and does not push.
    pub sensor: bool,
}

/// What the embedder says of a collider.
#[derive(Clone, Debug)]
pub struct ColliderDef {
    /// The shape, scaled.
    pub shape: Shape,
    /// The body, or [`NONE`].
    pub body: u32,
    /// The shape's frame in the body's; without a body unused.
    pub local: Pose,
    /// The surface.
    pub material: Material,
    /// The layers.
    pub layers: Layers,
    /// Bits.
    pub flags: ColliderFlags,
    /// How far from the shape others are kept, in metres.
    pub margin: f32,
    /// The greatest distance at which contacts are predicted, in metres; may be infinite.
    pub speculative: f32,
}

impl ColliderDef {
    /// Whether another definition says the same. Hulls are the same only if they are shared.
    pub fn is_same(&self, other: &Self) -> bool {
        self.body == other.body
            && self.local == other.local
            && self.material == other.material
            && self.layers == other.layers
            && self.flags == other.flags
            && self.margin == other.margin
            && self.speculative == other.speculative
            && self.shape.is_same(&other.shape)
    }
}

/// What is kept of a collider.
#[derive(Clone, Debug)]
pub struct Collider {
    /// What the embedder said.
    pub def: ColliderDef,
    /// The first of its contacts, as `contact << 1 | side`, or [`NONE`].
    pub first_contact: u32,
    /// Its leaf in its tree, or [`NONE`].
    pub proxy: u32,
    /// The neighbours in its body's list.
    next: u32,
    previous: u32,
}

/// What the narrow phase asks of a collider for every contact.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reach {
    /// The distance from the body's centre of mass to the farthest point of the shape, in metres.
    pub extent: f32,
    /// The same, but 0 on a static body: how far the surface moves for each radian the body may turn.
    pub turning: f32,
    /// The greatest distance at which contacts are predicted, in metres.
    pub speculative: f32,
    /// How far from the shape others are kept, in metres.
    pub margin: f32,
    /// Counts changes that make cached contacts wrong: shape, place on the body, margins.
    pub revision: u32,
}

/// Bodies that turn further in a step are looked at as if they turned by this, in radians.
pub(crate) const MOST_TURN: f32 = 1.5;

/// How far a body that turns at `spin` rad/s turns in `dt` seconds, as far as it is looked at, in radians.
#[inline(always)]
pub(crate) fn turn(spin: f32, dt: f32) -> f32 {
    min(spin * dt, MOST_TURN)
}

/// Whether a turn may take the surface farther than `small`, or far for its size.
#[inline(always)]
pub(crate) fn is_swinging(reach: &Reach, turn: f32, small: f32) -> bool {
    reach.extent * turn > min(small, FAT_SHARE * reach.extent)
}

/// All colliders that take part in the simulation.
#[derive(Clone, Debug, Default)]
pub struct ColliderTable {
    /// Which ids are in use.
    pub ids: IdPool,
    colliders: Vec<Collider>,
    /// Bodies by id: what else would have to be looked up in the colliders, a line of memory each.
    owners: Vec<u32>,
    /// World poses by id.
    pub poses: Vec<WorldPose>,
    /// The smallest boxes around the colliders as they stood when last refreshed, by id.
    pub tight: Vec<Aabb>,
    /// Fat boxes by id: what the trees hold.
    pub fat: Vec<Aabb>,
    /// Reaches by id.
    pub reaches: Vec<Reach>,
}

/// How a box is made fat, constant over a step.
#[derive(Clone, Copy, Debug)]
pub struct Fattening {
    /// Added on every side when a box is enlarged, in metres; less on what is small.
    pub margin: f32,
    /// The time for which boxes are swept along their body's velocity, in seconds.
    pub dt: f32,
}

/// A fat box is larger by no more than this share of how far its shape reaches, and how far that turns in a step.
/// Fatter boxes change less often but meet more that never touch, the more of it the more directions there are: with
/// twice the share in space, a step of a pile of boxes takes a quarter longer.
const FAT_SHARE: f32 = 0.5 / (1 << DIM) as f32;

impl ColliderTable {
    /// How many bytes are kept of each collider here, but for one bit, and for the geometry of a hull, which
    /// colliders share.
    pub const BYTES_PER_COLLIDER: usize = size_of::<Collider>()
        + size_of::<u32>()
        + size_of::<WorldPose>()
        + 2 * size_of::<Aabb>()
        + size_of::<Reach>();

    /// Adds a collider at a pose and links it to its body. Its fat box is empty until
    /// [`refresh`](Self::refresh).
    pub fn add(&mut self, def: ColliderDef, pose: WorldPose, bodies: &mut BodyTable) -> u32 {
        let id = self.ids.allocate();
        let collider = Collider { def, first_contact: NONE, proxy: NONE, next: NONE, previous: NONE };
        let i = id as usize;
        if i == self.colliders.len() {
            self.colliders.push(collider);
            self.owners.push(NONE);
            self.poses.push(pose);
            self.tight.push(Aabb::EMPTY);
            self.fat.push(Aabb::EMPTY);
            self.reaches.push(Reach::default());
        } else {
            self.colliders[i] = collider;
            self.poses[i] = pose;
            self.tight[i] = Aabb::EMPTY;
            self.fat[i] = Aabb::EMPTY;
        }
        self.attach(id, bodies);
        // The revision goes on counting, so that nothing cached for the id's last owner fits.
        self.update_reach(id, bodies);
        id
    }

    /// Takes a collider from its body and frees its id. Its contacts and its leaf must be gone.
    pub fn remove(&mut self, id: u32, bodies: &mut BodyTable) {
        debug_assert!(self[id].first_contact == NONE, "a removed collider has no contacts");
        self.detach(id, bodies);
        self.ids.free(id);
    }

    /// Changes shape, place, margin or body; cached contacts are invalidated. The contacts of a
    /// collider that changes its body must be gone; others are to be told of the rest
    /// (`Link::reflag_of_collider`).
    pub fn redefine(&mut self, id: u32, def: ColliderDef, bodies: &mut BodyTable) {
        debug_assert!(
            self[id].def.body == def.body || self[id].first_contact == NONE,
            "contacts know their bodies"
        );
        self.detach(id, bodies);
        self[id].def = def;
        self.attach(id, bodies);
        self.update_reach(id, bodies);
    }

    /// Recomputes how far the shape reaches from the body's centre of mass; cached contacts are
    /// invalidated. To be called after changes of the shape, the margins, or the body's kind or centre of
    /// mass.
    pub fn update_reach(&mut self, id: u32, bodies: &BodyTable) {
        let def = &self.colliders[id as usize].def;
        let center = if def.body == NONE {
            Vector::ZERO
        } else {
            def.local.inverse_transform(bodies[def.body].local_center)
        };
        let extent = def.shape.extent(center);
        let fixed = def.body == NONE || bodies[def.body].kind == BodyKind::Static;
        let reach = &mut self.reaches[id as usize];
        *reach = Reach {
            extent,
            turning: if fixed { 0.0 } else { extent },
            speculative: def.speculative,
            margin: def.margin,
            revision: reach.revision.wrapping_add(1),
        };
    }

    /// The colliders of a body.
    pub fn of_body<'a>(&'a self, body: u32, bodies: &BodyTable) -> impl Iterator<Item = u32> + 'a {
        let first = bodies[body].first_collider;
        core::iter::successors((first != NONE).then_some(first), |id| {
            let next = self[*id].next;
            (next != NONE).then_some(next)
        })
    }

    /// The body of a collider, or [`NONE`].
    #[inline(always)]
    pub fn body(&self, id: u32) -> u32 {
        self.owners[id as usize]
    }

    /// The collider after `id` in its body's list, or [`NONE`].
    pub fn next_of_body(&self, id: u32) -> u32 {
        self[id].next
    }

    /// Puts a collider where its body is, and enlarges its fat box if it no longer holds the shape, its
    /// margin, and its motion of one step. Returns whether it did. Colliders without a body keep their
    /// pose.
    pub fn refresh(&mut self, id: u32, bodies: &BodyTable, fattening: Fattening) -> bool {
        let i = id as usize;
        let places = (&mut self.poses[i], &mut self.tight[i], &mut self.fat[i]);
        self.colliders[i].fit(bodies, fattening, &self.reaches[i], places)
    }

    /// Refreshes the colliders of the bodies that were given a velocity by hand, and forgets that they were.
    /// `outgrown` receives those whose fat box was enlarged.
    pub fn refresh_pushed(&mut self, bodies: &mut BodyTable, fattening: Fattening, outgrown: &mut BitSet) {
        let mut pushed = core::mem::take(&mut bodies.pushed);
        for body in pushed.iter() {
            let mut id = bodies[body].first_collider;
            while id != NONE {
                if self.refresh(id, bodies, fattening) {
                    outgrown.insert(id);
                }
                id = self[id].next;
            }
        }
        pushed.clear();
        bodies.pushed = pushed;
    }

    /// Refreshes the colliders of the bodies that have a row in this step, `listed` in the order of their rows from
    /// row 1. `outgrown` receives those whose fat box was enlarged.
    pub fn refresh_listed(
        &mut self,
        listed: &[u32],
        bodies: &BodyTable,
        fattening: Fattening,
        pool: &ThreadPool,
        outgrown: &mut BitSet,
    ) {
        let Self { colliders, poses, tight, fat, reaches, .. } = self;
        let (poses, tight, fat) = (Parts::of(poses), Parts::of(tight), Parts::of(fat));
        let outgrown = Mutex::new(outgrown);
        pool.each(listed.chunks(BLOCK).enumerate(), |(block, ids)| {
            // To lock for each would have the members wait for each other.
            let mut found = [NONE; BLOCK];
            let mut count = 0;
            let note = |found: &[u32]| {
                let mut outgrown = outgrown.lock().unwrap_or_else(PoisonError::into_inner);
                found.iter().for_each(|id| _ = outgrown.insert(*id));
            };
            for (i, &body) in ids.iter().enumerate() {
                if let Some(&next) = ids.get(i + AHEAD) {
                    prefetch(colliders, bodies[next].first_collider);
                }
                if let Some(&next) = ids.get(i + AHEAD / 2)
                    && let Some(collider) = colliders.get(bodies[next].first_collider as usize)
                {
                    collider.def.shape.prefetch();
                }
                if bodies.row(body) as usize != 1 + block * BLOCK + i {
                    continue;
                }
                let mut id = bodies[body].first_collider;
                while id != NONE {
                    let collider = &colliders[id as usize];
                    if collider.def.body != body {
                        break;
                    }
                    prefetch(colliders, collider.next);
                    let i = id as usize;
                    // SAFETY: a collider is of one body, and no two bodies have one row.
                    let places = unsafe { (poses.one(i), tight.one(i), fat.one(i)) };
                    if collider.fit(bodies, fattening, &reaches[i], places) {
                        found[count] = id;
                        count += 1;
                        if count == BLOCK {
                            note(&found);
                            count = 0;
                        }
                    }
                    id = collider.next;
                }
            }
            if count > 0 {
                note(&found[..count]);
            }
        });
    }

    fn attach(&mut self, id: u32, bodies: &mut BodyTable) {
        let body = self[id].def.body;
        self.owners[id as usize] = body;
        if body == NONE {
            return;
        }
        let first = core::mem::replace(&mut bodies[body].first_collider, id);
        self[id].next = first;
        self[id].previous = NONE;
        if first != NONE {
            self[first].previous = id;
        }
    }

    fn detach(&mut self, id: u32, bodies: &mut BodyTable) {
        let Collider { next, previous, .. } = self[id];
        let body = self[id].def.body;
        if body == NONE {
            return;
        }
        match previous {
            NONE => bodies[body].first_collider = next,
            _ => self[previous].next = next,
        }
        if next != NONE {
            self[next].previous = previous;
        }
    }
}

impl Collider {
    /// How far normals of the surface pass from the body's centre of mass at most, in metres: how fast the surface moves
    /// along its normals for each radian a second.
    pub(crate) fn arm(&self, bodies: &BodyTable) -> f32 {
        let def = &self.def;
        if def.body == NONE {
            return 0.0;
        }
        def.shape.arm(def.local.inverse_transform(bodies[def.body].local_center))
    }

    /// The box of all places that the shape, whose box is `tight` now, takes in a step while its body turns.
    #[inline(never)]
    fn swung(&self, bodies: &BodyTable, fattening: Fattening, reach: &Reach, tight: &Aabb) -> Aabb {
        let def = &self.def;
        let arm = self.arm(bodies);
        if arm == 0.0 {
            return *tight;
        }
        let mut body = bodies.poses[def.body as usize];
        // Turning takes nothing farther out than the farthest point is.
        let round = Aabb::new(Vector::ZERO, Vector::ZERO).at(body.center).grown(reach.extent);
        let velocity = bodies.velocities[def.body as usize].angular;
        let spin = velocity.length();
        let turn = min(turn(spin, fattening.dt), def.speculative / arm);
        let rotation = Rot::IDENTITY.turned_by(velocity * (turn / spin)).mul(body.rotation);
        if !rotation.is_finite() {
            return round;
        }
        body.rotation = rotation;
        let after = def.shape.aabb(&body.frame(bodies[def.body].local_center).then(&def.local));
        // A point goes along an arc. Off the line between its ends that is by r (1 - cos φ/2) < r φ²/8 at most.
        tight.union(&after).grown(0.125 * reach.extent * turn * turn).intersection(&round)
    }

    /// Finds pose and box of a collider as it stands, and enlarges the fat box if it must. Returns whether it did.
    #[inline]
    fn fit(
        &self,
        bodies: &BodyTable,
        fattening: Fattening,
        reach: &Reach,
        (pose, tight, fat): (&mut WorldPose, &mut Aabb, &mut Aabb),
    ) -> bool {
        let def = &self.def;
        let (mut motion, mut turning) = (Vector::ZERO, 0.0);
        if def.body != NONE {
            *pose = bodies.frame(def.body).then(&def.local);
            let velocity = &bodies.velocities[def.body as usize];
            let speed = bodies.poses[def.body as usize].speed;
            motion = velocity.linear * fattening.dt;
            if speed * fattening.dt > def.speculative {
                motion = velocity.linear * (def.speculative / speed);
            }
            if !motion.is_finite() {
                motion = Vector::ZERO;
            }
            turning = velocity.angular.length() * fattening.dt;
        }
        *tight = def.shape.aabb(pose);
        let mut needed = tight.grown(def.margin);
        if is_swinging(reach, turning, fattening.margin) {
            needed = needed.union(&self.swung(bodies, fattening, reach, tight).grown(def.margin));
        }
        let needed = needed.swept(motion);
        let outgrown = !fat.contains(&needed);
        if outgrown {
            *fat = needed.grown(min(FAT_SHARE * reach.extent + reach.turning * turning, fattening.margin));
        }
        outgrown
    }
}

impl Index<u32> for ColliderTable {
    type Output = Collider;
    #[inline(always)]
    fn index(&self, id: u32) -> &Collider {
        &self.colliders[id as usize]
    }
}

impl IndexMut<u32> for ColliderTable {
    #[inline(always)]
    fn index_mut(&mut self, id: u32) -> &mut Collider {
        &mut self.colliders[id as usize]
    }
}
