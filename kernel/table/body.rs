//! Bodies by id: what kind, where, how fast, and which row they have in this step.

use super::{ConstraintTable, NONE};
use crate::data::{BitSet, IdPool, Parts};
use crate::graph::ConstraintKind;
use crate::math::{Angular, Rot, Vector, WorldPose, WorldVector};

/// What moves a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BodyKind {
    /// Nothing.
    Static,
    /// Its velocity, which nothing in the simulation changes.
    Kinematic,
    /// Forces, contacts and joints.
    #[default]
    Dynamic,
}

/// How slow a body must be to count as at rest: over a whole step, by how far it got, not by its velocity, so that
/// what jitters in place rests. Negative values and NaN never count as at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RestSpeed {
    /// Of the centre of mass, m/s.
    pub linear: f32,
    /// rad/s.
    pub angular: f32,
}

impl RestSpeed {
    /// Never at rest.
    pub const NEVER: Self = Self { linear: -1.0, angular: -1.0 };

    /// Whether a body rests that in `dt` seconds got as far as the root of `way_squared`, and turned by that of
    /// `angle_squared`.
    #[inline(always)]
    pub fn admits(self, way_squared: f32, angle_squared: f32, dt: f32) -> bool {
        let (far, wide) = (self.linear * dt, self.angular * dt);
        far >= 0.0 && wide >= 0.0 && way_squared <= far * far && angle_squared <= wide * wide
    }
}

/// What is rarely needed of a body.
#[derive(Clone, Debug)]
pub struct Body {
    /// What moves it.
    pub kind: BodyKind,
    /// Whether it takes part in steps. Static bodies are never awake.
    pub awake: bool,
    /// Among dynamic bodies, higher dominance acts on lower as if it could not be moved.
    pub dominance: i8,
    /// The centre of mass in the body's frame, in metres.
    pub local_center: Vector,
    /// The first of its colliders, or [`NONE`].
    pub first_collider: u32,
    /// What counts as at rest.
    pub rest_speed: RestSpeed,
    /// Seconds for which it has been at rest; 0 while it is not.
    pub sleep_timer: f32,
}

impl Body {
    /// Static and kinematic bodies dominate whatever number a dynamic one has.
    pub fn effective_dominance(&self) -> i16 {
        if self.kind == BodyKind::Dynamic { i16::from(self.dominance) } else { i16::from(i8::MAX) + 1 }
    }
}

/// Where a body is, and what else the narrow phase asks of a body for every contact: one cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyPose {
    /// The centre of mass in the world.
    pub center: WorldVector,
    /// The rotation.
    pub rotation: Rot,
    /// How fast the centre of mass moves, m/s.
    pub speed: f32,
    /// Counts changes that make cached contacts wrong: kind, centre of mass, teleports.
    pub revision: u32,
}

impl BodyPose {
    /// The frame of a body whose centre of mass is at `local_center` in it.
    #[inline(always)]
    pub fn frame(&self, local_center: Vector) -> WorldPose {
        let center = self.rotation.rotate(local_center);
        WorldPose { position: self.center - center.to_world(), rotation: self.rotation }
    }
}

/// How fast a body moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Of the centre of mass, m/s.
    pub linear: Vector,
    /// rad/s.
    pub angular: Angular,
}

/// All bodies that take part in the simulation, asleep ones included.
#[derive(Clone, Debug, Default)]
pub struct BodyTable {
    /// Which ids are in use.
    pub ids: IdPool,
    bodies: Vec<Body>,
    /// Poses by id.
    pub poses: Vec<BodyPose>,
    /// Velocities by id; written through [`set_velocity`](Self::set_velocity).
    pub velocities: Vec<Velocity>,
    /// The solver row of each body in this step; 0, the immovable dummy, if it has none.
    pub(crate) rows: Vec<u32>,
    /// Bodies that were given a velocity by hand since the embedder last emptied this: their boxes are to be swept
    /// before pairs are found.
    pub pushed: BitSet,
    /// Bodies that woke or fell asleep since the embedder last emptied this; some may be back.
    pub flipped: Vec<u32>,
    /// Whether any body's dominance is not 0: what rows need not ask otherwise. Set by whoever sets it.
    pub any_dominance: bool,
    awake_kinematic: BitSet,
    awake_dynamic: BitSet,
    /// By kind; contacts are elsewhere.
    constraints: [ConstraintTable; ConstraintKind::COUNT],
}

impl BodyTable {
    /// How many bytes are kept of each body here, but for one bit in each of four sets.
    pub const BYTES_PER_BODY: usize =
        size_of::<Body>() + size_of::<BodyPose>() + size_of::<Velocity>() + size_of::<u32>();

    /// Adds a body, awake unless static.
    pub fn add(&mut self, kind: BodyKind, local_center: Vector, pose: WorldPose) -> u32 {
        let id = self.ids.allocate();
        let body = Body {
            kind,
            awake: false,
            dominance: 0,
            local_center,
            first_collider: NONE,
            rest_speed: RestSpeed::NEVER,
            sleep_timer: 0.0,
        };
        let mut placed = BodyPose {
            center: pose.transform(local_center),
            rotation: pose.rotation,
            speed: 0.0,
            revision: 0,
        };
        let i = id as usize;
        if i == self.bodies.len() {
            self.bodies.push(body);
            self.poses.push(placed);
            self.velocities.push(Velocity::default());
            self.rows.push(0);
        } else {
            // The revision goes on counting, so that nothing cached for the id's last owner fits.
            placed.revision = self.poses[i].revision.wrapping_add(1);
            self.bodies[i] = body;
            self.poses[i] = placed;
            self.velocities[i] = Velocity::default();
            self.rows[i] = 0;
        }
        self.set_awake(id, true);
        id
    }

    /// The constraints of a kind between bodies; none for contacts, which have a table of their own.
    pub fn constraints(&self, kind: ConstraintKind) -> &ConstraintTable {
        &self.constraints[kind as usize]
    }

    pub(crate) fn constraints_mut(&mut self, kind: ConstraintKind) -> &mut ConstraintTable {
        &mut self.constraints[kind as usize]
    }

    /// Frees a body's id. Its colliders, contacts and other constraints must be gone.
    pub fn remove(&mut self, id: u32) {
        debug_assert!(self[id].first_collider == NONE, "a removed body has no colliders");
        self.set_awake(id, false);
        self.pushed.remove(id);
        self.ids.free(id);
    }

    /// Changes what moves a body, and keeps the awake lists true.
    pub fn set_kind(&mut self, id: u32, kind: BodyKind) {
        let awake = self[id].awake;
        self.set_awake(id, false);
        self[id].kind = kind;
        self.revise(id);
        self.set_awake(id, awake || kind != BodyKind::Static);
    }

    /// Wakes a body or puts it to sleep; static bodies stay as they are.
    pub fn set_awake(&mut self, id: u32, awake: bool) {
        let body = &mut self[id];
        let kind = body.kind;
        let was = core::mem::replace(&mut body.awake, awake && kind != BodyKind::Static);
        if was != body.awake {
            self.flipped.push(id);
        }
        let set = match kind {
            BodyKind::Static => return,
            BodyKind::Kinematic => &mut self.awake_kinematic,
            BodyKind::Dynamic => &mut self.awake_dynamic,
        };
        if awake {
            set.insert(id);
        } else {
            set.remove(id);
        }
    }

    /// The awake kinematic bodies, by id.
    pub fn awake_kinematic(&self) -> impl Iterator<Item = u32> + '_ {
        self.awake_kinematic.iter()
    }

    /// The awake dynamic bodies, by id.
    pub fn awake_dynamic(&self) -> impl Iterator<Item = u32> + '_ {
        self.awake_dynamic.iter()
    }

    /// The bodies that woke or fell asleep since [`flipped`](Self::flipped) was last emptied, as a set.
    pub fn flipped_set(&self) -> BitSet {
        let mut set = BitSet::new();
        for &id in &self.flipped {
            set.insert(id);
        }
        set
    }

    /// How many bodies are awake.
    pub fn awake_count(&self) -> usize {
        self.awake_kinematic.count() + self.awake_dynamic.count()
    }

    /// Gives every awake body its row for this step, kinematic ones first, each kind in the order of
    /// ids, and all others row 0. `listed` receives the bodies in the order of their rows, from row 1.
    /// Returns the number of kinematic bodies.
    pub fn assign_rows(&mut self, listed: &mut Vec<u32>) -> usize {
        for id in listed.drain(..) {
            if let Some(row) = self.rows.get_mut(id as usize) {
                *row = 0;
            }
        }
        listed.extend(self.awake_kinematic.iter());
        let kinematic = listed.len();
        listed.extend(self.awake_dynamic.iter());
        for (i, id) in listed.iter().enumerate() {
            self.rows[*id as usize] = 1 + i as u32;
        }
        kinematic
    }

    /// The solver row of a body in this step; 0 if it has none.
    #[inline(always)]
    pub fn row(&self, id: u32) -> u32 {
        self.rows[id as usize]
    }

    /// Columns that several threads change at once, each body by one thread.
    pub(crate) fn parts(&mut self) -> BodyParts<'_> {
        BodyParts {
            bodies: Parts::of(&mut self.bodies),
            poses: Parts::of(&mut self.poses),
            velocities: Parts::of(&mut self.velocities),
            rows: &self.rows,
        }
    }

    /// The body's frame in the world: its pose less its centre of mass.
    pub fn frame(&self, id: u32) -> WorldPose {
        self.poses[id as usize].frame(self[id].local_center)
    }

    /// Moves a body by hand. Cached contacts are invalidated.
    pub fn teleport(&mut self, id: u32, frame: WorldPose) {
        let center = frame.transform(self[id].local_center);
        let pose = &mut self.poses[id as usize];
        pose.center = center;
        pose.rotation = frame.rotation;
        self.revise(id);
    }

    /// Sets how fast a body moves, by hand. [`ColliderTable::refresh_pushed`](super::ColliderTable::refresh_pushed) then
    /// has to be called before pairs are found, or it may pass through something in the next step.
    #[inline]
    pub fn set_velocity(&mut self, id: u32, velocity: Velocity) {
        if velocity != self.velocities[id as usize] && velocity != Velocity::default() {
            self.pushed.insert(id);
        }
        self.velocities[id as usize] = velocity;
        self.poses[id as usize].speed = velocity.linear.length();
    }

    fn revise(&mut self, id: u32) {
        let pose = &mut self.poses[id as usize];
        pose.revision = pose.revision.wrapping_add(1);
    }
}

/// Bodies by id, changed by several threads at once.
pub(crate) struct BodyParts<'a> {
    pub(crate) bodies: Parts<'a, Body>,
    pub(crate) poses: Parts<'a, BodyPose>,
    pub(crate) velocities: Parts<'a, Velocity>,
    /// The row of each in this step; no two have the same but 0.
    pub(crate) rows: &'a [u32],
}

impl core::ops::Index<u32> for BodyTable {
    type Output = Body;
    #[inline(always)]
    fn index(&self, id: u32) -> &Body {
        &self.bodies[id as usize]
    }
}

impl core::ops::IndexMut<u32> for BodyTable {
    #[inline(always)]
    fn index_mut(&mut self, id: u32) -> &mut Body {
        &mut self.bodies[id as usize]
    }
}
