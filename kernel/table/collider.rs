//! Colliders by id: shape, world pose, boxes, surface, layers and revision.
#![expect(unsafe_code, reason = "colliders are changed by several threads, each its own")]

use super::{BodyKind, BodyTable, FacetMaterials, Material, NONE};
use crate::data::{BitSet, IdPool, Parts, prefetch};
use crate::math::{Pose, Rot, Vector, WorldPose, max, min};
use crate::shape::{Aabb, Shape};
use crate::thread_pool::ThreadPool;
use crate::tuning::rest::FAT_SHARE;
use crate::tuning::sweeps::MOST_TURN;
use core::ops::{Index, IndexMut};
use std::sync::{Arc, Mutex, PoisonError};

/// Number of bodies in a block of the job that refreshes their colliders.
const BLOCK: usize = 128;

/// Prefetch distance, in bodies. The collider of a body this far ahead is prefetched, and its hull half as
/// far ahead. Less hides too little latency, more evicts lines before their use.
const PREFETCH_DISTANCE: usize = 8;

/// Collision layers as bit masks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layers {
    /// The layers that the collider is in.
    pub memberships: u32,
    /// The layers that the collider interacts with.
    pub filters: u32,
}

impl Layers {
    /// Whether each is in a layer that the other interacts with.
    #[inline(always)]
    pub fn interacts_with(self, other: Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }
}

/// Flags of a collider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColliderFlags {
    /// The collider detects contacts without response.
    pub sensor: bool,
    /// The collider is for queries only: the embedder makes no contacts for it.
    pub inactive: bool,
}

/// Definition of a collider, by the embedder.
#[derive(Clone, Debug)]
pub struct ColliderDef {
    /// The shape, scaled.
    pub shape: Shape,
    /// The body, or [`NONE`] for a collider without one.
    pub body: u32,
    /// Frame of the shape in the body's frame. Unused without a body.
    pub local: Pose,
    /// Friction and restitution.
    pub material: Material,
    /// Materials of single facets, which replace `material` there.
    pub facets: Option<Arc<FacetMaterials>>,
    /// Collision layers.
    pub layers: Layers,
    /// Flags.
    pub flags: ColliderFlags,
    /// Distance from the shape at which other shapes are kept, in metres.
    pub margin: f32,
    /// Maximum distance at which contacts are predicted, in metres. May be infinite.
    pub speculative: f32,
}

impl ColliderDef {
    /// A collider of a shape in the frame of its body, or without a body for [`NONE`]: without friction and
    /// restitution, in layer 1, which interacts with all, without margin, and with unlimited prediction.
    pub fn new(shape: Shape, body: u32) -> Self {
        Self {
            shape,
            body,
            local: Pose::IDENTITY,
            material: Material::default(),
            facets: None,
            layers: Layers { memberships: 1, filters: u32::MAX },
            flags: ColliderFlags::default(),
            margin: 0.0,
            speculative: f32::MAX,
        }
    }

    /// Whether two definitions are equal. Hulls are equal only if they are the same allocation.
    pub fn is_same(&self, other: &Self) -> bool {
        self.body == other.body
            && self.local == other.local
            && self.material == other.material
            && self.facets == other.facets
            && self.layers == other.layers
            && self.flags == other.flags
            && self.margin == other.margin
            && self.speculative == other.speculative
            && self.shape.is_same(&other.shape)
    }
}

/// A collider and its place in lists.
#[derive(Clone, Debug)]
pub struct Collider {
    /// The definition.
    pub def: ColliderDef,
    /// First contact of the collider, as `contact << 1 | side`, or [`NONE`].
    pub first_contact: u32,
    /// Leaf in the tree, or [`NONE`].
    pub proxy: u32,
    /// Neighbours in the list of the body's colliders.
    next: u32,
    previous: u32,
}

/// Properties of a collider that the narrow phase reads for every contact.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reach {
    /// The distance from the body's centre of mass to the farthest point of the shape, in metres.
    pub extent: f32,
    /// As `extent`, but 0 on a static body: maximum displacement of the surface per radian of rotation.
    pub turning: f32,
    /// Maximum distance between a normal of the surface and the body's centre of mass, in metres; 0 if the
    /// body does not turn.
    pub arm: f32,
    /// Maximum distance at which contacts are predicted, in metres.
    pub speculative: f32,
    /// Distance from the shape at which other shapes are kept, in metres.
    pub margin: f32,
    /// Counter of changes that invalidate cached contacts: shape, pose on the body, margins.
    pub revision: u32,
}

/// The sizes of a body's colliders that decide whether the body is fast.
#[derive(Clone, Copy, Debug)]
pub struct BodySize {
    /// A lower bound of the core radius of every collider, in metres; infinite without colliders.
    pub core: f32,
    /// Maximum distance between a normal of the colliders' surfaces and the centre of mass, in metres.
    pub arm: f32,
}

impl BodySize {
    const NONE: Self = Self { core: f32::INFINITY, arm: 0.0 };
}

/// The rotation in `dt` seconds at an angular speed of `spin` rad/s, clamped to [`MOST_TURN`], in radians.
#[inline(always)]
pub(crate) fn turn(spin: f32, dt: f32) -> f32 {
    min(spin * dt, MOST_TURN)
}

/// Whether a rotation may displace the surface by more than `small`, or by much for the size of the shape.
#[inline(always)]
pub(crate) fn is_swinging(reach: &Reach, turn: f32, small: f32) -> bool {
    reach.extent * turn > min(small, FAT_SHARE * reach.extent)
}

/// All colliders of the simulation.
#[derive(Clone, Debug, Default)]
pub struct ColliderTable {
    /// The ids in use. Colliders that were added as sensors have ids aside, so they do not change the order
    /// of others.
    pub ids: IdPool,
    colliders: Vec<Collider>,
    /// The numbers in use.
    in_numbers: IdPool,
    /// The [number](Self::number) of each collider by id, [`NONE`] for sensors.
    numbers: Vec<u32>,
    /// The body of each collider, by collider id. A look-up in `colliders` would load a cache line for each.
    owners: Vec<u32>,
    /// World poses by id.
    pub poses: Vec<WorldPose>,
    /// Tight boxes by id, as of the last refresh.
    pub tight: Vec<Aabb>,
    /// Fat boxes by id. The trees hold these.
    pub fat: Vec<Aabb>,
    /// Reaches by id.
    pub reaches: Vec<Reach>,
    /// The sizes by body, as far as bodies had colliders. Removed colliders count until the last collider of
    /// the body is removed.
    sizes: Vec<BodySize>,
}

/// How boxes are fattened, constant over a step.
#[derive(Clone, Copy, Debug)]
pub struct Fattening {
    /// Growth of a box on every side when it is enlarged, in metres. Small shapes get less.
    pub margin: f32,
    /// The time for which boxes are swept along their body's velocity, in seconds.
    pub dt: f32,
}

impl ColliderTable {
    /// Bytes of memory per collider, besides one bit, and besides the geometry of hulls, which colliders
    /// share.
    pub const BYTES_PER_COLLIDER: usize = size_of::<Collider>()
        + 2 * size_of::<u32>()
        + size_of::<WorldPose>()
        + 2 * size_of::<Aabb>()
        + size_of::<Reach>();

    /// Adds a collider at a pose and attaches it to its body. Its fat box is empty until
    /// [`refresh`](Self::refresh).
    pub fn add(&mut self, def: ColliderDef, pose: WorldPose, bodies: &mut BodyTable) -> u32 {
        let is_sensor = def.flags.sensor;
        let id = if is_sensor { self.ids.allocate_aside() } else { self.ids.allocate() };
        let collider = Collider { def, first_contact: NONE, proxy: NONE, next: NONE, previous: NONE };
        let i = id as usize;
        if i == self.colliders.len() {
            self.colliders.push(collider);
            self.owners.push(NONE);
            self.numbers.push(NONE);
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
        self.renumber(id);
        self.attach(id, bodies);
        // The revision keeps counting, so caches of the id's previous owner do not match.
        self.update_reach(id, bodies);
        id
    }

    /// Detaches a collider from its body and frees its id. Its contacts and its leaf must be removed before.
    pub fn remove(&mut self, id: u32, bodies: &mut BodyTable) {
        debug_assert!(self[id].first_contact == NONE, "a removed collider has no contacts");
        self.detach(id, bodies);
        self.ids.free(id);
        let number = core::mem::replace(&mut self.numbers[id as usize], NONE);
        if number != NONE {
            self.in_numbers.free(number);
        }
    }

    /// Makes ids and numbers that were freed before this call usable again.
    pub fn recycle_ids(&mut self) {
        self.ids.recycle();
        self.in_numbers.recycle();
    }

    /// The number of a collider among the colliders that are not sensors: equal to its id if there never was
    /// a sensor. Code that depends on more than the order of ids uses this number, so sensors do not change
    /// the behaviour of other colliders. [`NONE`] for sensors.
    #[inline]
    pub fn number(&self, id: u32) -> u32 {
        self.numbers[id as usize]
    }

    /// Gives a collider a number if and only if it is not a sensor.
    fn renumber(&mut self, id: u32) {
        let is_sensor = self[id].def.flags.sensor;
        let number = &mut self.numbers[id as usize];
        if is_sensor == (*number == NONE) {
            return;
        }
        if is_sensor {
            self.in_numbers.free(core::mem::replace(number, NONE));
        } else {
            *number = self.in_numbers.allocate();
        }
    }

    /// Changes the definition of a collider, and invalidates its cached contacts. If the body changes, the
    /// contacts must be removed before. Otherwise call `ContactManager::reflag_of_collider` after it.
    pub fn redefine(&mut self, id: u32, def: ColliderDef, bodies: &mut BodyTable) {
        debug_assert!(
            self[id].def.body == def.body || self[id].first_contact == NONE,
            "contacts know their bodies"
        );
        self.detach(id, bodies);
        self[id].def = def;
        self.renumber(id);
        self.attach(id, bodies);
        self.update_reach(id, bodies);
    }

    /// Recomputes the reach of a collider, and invalidates its cached contacts. Call it after the shape, the
    /// margins, or the body's kind or centre of mass changed.
    pub fn update_reach(&mut self, id: u32, bodies: &mut BodyTable) {
        let def = &self.colliders[id as usize].def;
        let center = if def.body == NONE {
            Vector::ZERO
        } else {
            def.local.inverse_transform(bodies[def.body].local_center)
        };
        let extent = def.shape.extent(center);
        let fixed = def.body == NONE || bodies[def.body].kind == BodyKind::Static;
        let arm = if fixed { 0.0 } else { def.shape.arm(center) };
        if def.body != NONE {
            let size = &mut self.sizes[def.body as usize];
            size.core = min(size.core, def.shape.core().1);
            size.arm = max(size.arm, arm);
            bodies.reach_out(def.body, extent);
        }
        let reach = &mut self.reaches[id as usize];
        *reach = Reach {
            extent,
            turning: if fixed { 0.0 } else { extent },
            arm,
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

    /// The sizes that decide whether a body is fast.
    #[inline(always)]
    pub fn size_of(&self, body: u32) -> BodySize {
        self.sizes.get(body as usize).copied().unwrap_or(BodySize::NONE)
    }

    /// The next collider of the same body, or [`NONE`].
    pub fn next_of_body(&self, id: u32) -> u32 {
        self[id].next
    }

    /// Moves a collider to its body's pose, and enlarges its fat box if the box no longer contains the shape,
    /// the margin and the motion of one step. Returns whether the fat box was enlarged. A collider without a
    /// body keeps its pose.
    pub fn refresh(&mut self, id: u32, bodies: &BodyTable, fattening: Fattening) -> bool {
        let i = id as usize;
        let places = (&mut self.poses[i], &mut self.tight[i], &mut self.fat[i]);
        self.colliders[i].fit(bodies, fattening, &self.reaches[i], places)
    }

    /// Refreshes the colliders of bodies whose velocity was set by hand, and empties the set of those bodies.
    /// `outgrown` receives the colliders whose fat box was enlarged.
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

    /// Refreshes the colliders of the bodies with a row in this step. `listed` holds these bodies in the
    /// order of rows, from row 1. `outgrown` receives the colliders whose fat box was enlarged.
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
            // The lock is taken once per batch of ids: with a lock for each id, workers would wait for each
            // other.
            let mut found = [NONE; BLOCK];
            let mut count = 0;
            let note = |found: &[u32]| {
                let mut outgrown = outgrown.lock().unwrap_or_else(PoisonError::into_inner);
                found.iter().for_each(|id| _ = outgrown.insert(*id));
            };
            for (i, &body) in ids.iter().enumerate() {
                if let Some(&next) = ids.get(i + PREFETCH_DISTANCE) {
                    prefetch(colliders, bodies[next].first_collider);
                }
                if let Some(&next) = ids.get(i + PREFETCH_DISTANCE / 2)
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
                    // SAFETY: a collider has one body, and no two bodies share a row.
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
        if self.sizes.len() <= body as usize {
            self.sizes.resize(body as usize + 1, BodySize::NONE);
        }
        if first == NONE {
            self.sizes[body as usize] = BodySize::NONE;
        }
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
    /// The box swept by the shape in a step while its body turns. `tight` is the current box.
    #[inline(never)]
    fn swung(&self, bodies: &BodyTable, fattening: Fattening, reach: &Reach, tight: &Aabb) -> Aabb {
        let def = &self.def;
        let arm = reach.arm;
        if arm == 0.0 {
            return *tight;
        }
        let mut body = bodies.poses[def.body as usize];
        // No point of the shape leaves the sphere of its extent around the centre of mass.
        let round = Aabb::new(Vector::ZERO, Vector::ZERO).at(body.center).grown(reach.extent);
        let velocity = bodies.velocities[def.body as usize].angular;
        let spin = velocity.length();
        let turn = turn(spin, fattening.dt);
        let rotation = Rot::IDENTITY.turned_by(velocity * (turn / spin)).mul(body.rotation);
        if !rotation.is_finite() {
            return round;
        }
        body.rotation = rotation;
        let after = def.shape.aabb(&body.frame(bodies[def.body].local_center).then(&def.local));
        // A point moves along an arc, which deviates from its chord by at most r (1 - cos φ/2) < r φ²/8.
        tight.union(&after).grown(0.125 * reach.extent * turn * turn).intersection(&round)
    }

    /// Recomputes pose and tight box of a collider, and enlarges the fat box if needed. Returns whether it
    /// was enlarged.
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
            motion = velocity.linear * fattening.dt;
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
