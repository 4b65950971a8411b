//! Bodies by id: kind, pose, velocity, and solver row of this step.

use super::{ConstraintTable, NONE};
use crate::data::{BitSet, IdPool, Parts};
use crate::graph::ConstraintKind;
use crate::math::{Angular, Rot, Vector, WorldPose, WorldVector};
use crate::tuning::rest::MEAN_TIME;

/// The cause of a body's motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BodyKind {
    /// Nothing.
    Static,
    /// Its velocity, which neither contacts nor gravity change.
    Kinematic,
    /// Forces, contacts and joints.
    #[default]
    Dynamic,
}

/// The speed below which a body counts as at rest. It is measured by displacement and angle over a whole
/// step, not by velocity, so a body that jitters in place rests. A dynamic body also rests if its average
/// over the last steps is below this speed. With a negative value or NaN the body never rests.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RestSpeed {
    /// Speed of the centre of mass, m/s.
    pub linear: f32,
    /// Angular speed, rad/s.
    pub angular: f32,
}

impl RestSpeed {
    /// A body that never rests.
    pub const NEVER: Self = Self { linear: -1.0, angular: -1.0 };

    /// Whether a body rests that moved and turned by these amounts in `dt` seconds, given as squares of
    /// metres and radians.
    #[inline(always)]
    pub fn admits(self, displacement_squared: f32, angle_squared: f32, dt: f32) -> bool {
        let (far, wide) = (self.linear * dt, self.angular * dt);
        far >= 0.0 && wide >= 0.0 && displacement_squared <= far * far && angle_squared <= wide * wide
    }
}

/// Properties of a body that few stages read.
#[derive(Clone, Debug)]
pub struct Body {
    /// How the body moves.
    pub kind: BodyKind,
    /// Whether the body takes part in steps. Static bodies are never awake.
    pub awake: bool,
    /// Of two dynamic bodies in contact, the body with lower dominance does not push the other.
    pub dominance: i8,
    /// The centre of mass in the body's frame, in metres.
    pub local_center: Vector,
    /// The first collider of the body, or [`NONE`].
    pub first_collider: u32,
    /// The speed below which the body counts as at rest.
    pub rest_speed: RestSpeed,
    /// Seconds for which the body has been at rest; 0 while it moves.
    pub sleep_timer: f32,
    /// The average velocity over the last steps, measured by displacement.
    pub mean_velocity: Velocity,
    /// The farthest that its colliders have reached from its centre of mass, in metres.
    pub(crate) extent: f32,
}

impl Body {
    /// Adds a step of `dt` seconds to the average velocity, and returns whether the body rests by this
    /// average. So a body that shakes in a cycle of a few steps rests, and a body that rolls slowly does not.
    /// `turn` is the step's rotation vector.
    #[inline(always)]
    pub(crate) fn rests_on_average(&mut self, displacement: Vector, turn: Angular, dt: f32) -> bool {
        let share = 1.0 / (MEAN_TIME + dt);
        let mean = &mut self.mean_velocity;
        mean.linear += (displacement - mean.linear * dt) * share;
        mean.angular += (turn - mean.angular * dt) * share;
        self.rest_speed.admits(mean.linear.length_squared(), mean.angular.length_squared(), 1.0)
    }

    /// The dominance, with static and kinematic bodies above all dynamic ones.
    pub fn effective_dominance(&self) -> i16 {
        if self.kind == BodyKind::Dynamic { i16::from(self.dominance) } else { i16::from(i8::MAX) + 1 }
    }
}

/// The pose of a body, and all other data of a body that the narrow phase reads for every contact. One cache
/// line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyPose {
    /// Centre of mass in world space.
    pub center: WorldVector,
    /// The rotation.
    pub rotation: Rot,
    /// An upper bound of the speed of the surface, m/s.
    pub speed: f32,
    /// An upper bound of the distance that the surface has moved so far, in units of 2⁻²⁴ length units. It
    /// overflows.
    pub travel: u32,
    /// Counter of changes that invalidate cached contacts: kind, centre of mass, teleports.
    pub revision: u32,
}

impl BodyPose {
    /// The frame of the body; `local_center` is the centre of mass in it.
    #[inline(always)]
    pub fn frame(&self, local_center: Vector) -> WorldPose {
        let center = self.rotation.rotate(local_center);
        WorldPose { position: self.center - center.to_world(), rotation: self.rotation }
    }
}

/// Velocity of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Velocity of the centre of mass, m/s.
    pub linear: Vector,
    /// Angular velocity, rad/s.
    pub angular: Angular,
}

impl Velocity {
    /// An upper bound of the speed of a surface that reaches `extent` metres from the centre of mass, m/s.
    #[inline(always)]
    pub(crate) fn surface_speed(&self, extent: f32) -> f32 {
        self.linear.length() + extent * self.angular.length()
    }
}

/// Travel units per length unit. More units overflow sooner, fewer count too much for bodies that hardly
/// move.
const TRAVEL_UNITS: f32 = (1 << 24) as f32;

/// The maximum travel that is counted at once: a quarter of the counter, so the sum of two does not overflow.
pub(crate) const FAR: u32 = 1 << 30;

/// The scale in which a table counts the travels of all its bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TravelScale {
    /// Units per metre.
    units: f32,
    /// Metres per unit.
    metres: f32,
}

impl Default for TravelScale {
    fn default() -> Self {
        Self::new(1.0)
    }
}

impl TravelScale {
    /// For a length unit in metres.
    fn new(length_unit: f32) -> Self {
        Self { units: TRAVEL_UNITS / length_unit, metres: length_unit / TRAVEL_UNITS }
    }

    /// The travel of a way in metres, at most [`FAR`]; 0 if it is negative or NaN.
    #[inline(always)]
    pub(crate) fn travelled(self, way: f32) -> u32 {
        ((way * self.units) as u32).min(FAR)
    }

    /// The way of a difference of travels, in metres.
    #[inline(always)]
    pub(crate) fn way_of(self, travel: i32) -> f32 {
        travel as f32 * self.metres
    }
}

/// All bodies of the simulation, sleeping ones included.
#[derive(Clone, Debug, Default)]
pub struct BodyTable {
    /// The ids in use.
    pub ids: IdPool,
    bodies: Vec<Body>,
    /// Poses by id.
    pub poses: Vec<BodyPose>,
    /// Velocities by id; written through [`set_velocity`](Self::set_velocity).
    pub velocities: Vec<Velocity>,
    /// Solver row of each body in this step. Bodies without a row have 0, the row of the immovable dummy.
    pub(crate) rows: Vec<u32>,
    pub(crate) travel_scale: TravelScale,
    /// Bodies whose velocity was set by hand since the embedder last emptied this set. Their boxes must be
    /// swept before pairs are found.
    pub pushed: BitSet,
    /// Bodies that woke or fell asleep since the embedder last emptied this list. A body may be back in its
    /// original state.
    pub flipped: Vec<u32>,
    /// Whether any body has a dominance other than 0. Rows skip dominance otherwise. Set it with
    /// [`Body::dominance`].
    pub any_dominance: bool,
    awake_kinematic: BitSet,
    awake_dynamic: BitSet,
    /// Constraints by kind. Contacts have a table of their own.
    constraints: [ConstraintTable; ConstraintKind::COUNT],
}

impl BodyTable {
    /// Bytes of memory per body, besides one bit in each of four sets.
    pub const BYTES_PER_BODY: usize =
        size_of::<Body>() + size_of::<BodyPose>() + size_of::<Velocity>() + size_of::<u32>();

    /// Adds a body, awake unless static.
    pub fn add(&mut self, kind: BodyKind, local_center: Vector, pose: WorldPose) -> u32 {
        let is_static = kind == BodyKind::Static;
        // Static bodies have no row, and do not change the order of bodies with a row.
        let id = if is_static { self.ids.allocate_aside() } else { self.ids.allocate() };
        let body = Body {
            kind,
            awake: false,
            dominance: 0,
            local_center,
            first_collider: NONE,
            rest_speed: RestSpeed::NEVER,
            sleep_timer: 0.0,
            mean_velocity: Velocity::default(),
            extent: 0.0,
        };
        let mut placed = BodyPose {
            center: pose.transform(local_center),
            rotation: pose.rotation,
            speed: 0.0,
            travel: 0,
            revision: 0,
        };
        let i = id as usize;
        if i == self.bodies.len() {
            self.bodies.push(body);
            self.poses.push(placed);
            self.velocities.push(Velocity::default());
            self.rows.push(0);
        } else {
            // The revision keeps counting, so caches of the id's previous owner do not match.
            placed.revision = self.poses[i].revision.wrapping_add(1);
            self.bodies[i] = body;
            self.poses[i] = placed;
            self.velocities[i] = Velocity::default();
            self.rows[i] = 0;
        }
        self.set_awake(id, true);
        id
    }

    /// The constraints of a kind. Empty for contacts, which have a table of their own.
    pub fn constraints(&self, kind: ConstraintKind) -> &ConstraintTable {
        &self.constraints[kind as usize]
    }

    pub(crate) fn constraints_mut(&mut self, kind: ConstraintKind) -> &mut ConstraintTable {
        &mut self.constraints[kind as usize]
    }

    /// Frees the id of a body. Its colliders, contacts and other constraints must be removed before.
    pub fn remove(&mut self, id: u32) {
        debug_assert!(self[id].first_collider == NONE, "a removed body has no colliders");
        self.set_awake(id, false);
        self.pushed.remove(id);
        self.ids.free(id);
    }

    /// Changes the kind of a body, and updates the sets of awake bodies.
    pub fn set_kind(&mut self, id: u32, kind: BodyKind) {
        let awake = self[id].awake;
        self.set_awake(id, false);
        self[id].kind = kind;
        self.revise(id);
        self.set_awake(id, awake || kind != BodyKind::Static);
    }

    /// Wakes a body or puts it to sleep. Static bodies are never awake.
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

    /// The number of awake bodies.
    pub fn awake_count(&self) -> usize {
        self.awake_kinematic.count() + self.awake_dynamic.count()
    }

    /// Gives every awake body a row for this step: kinematic bodies first, each kind in the order of ids. All
    /// other bodies get row 0. `listed` receives the bodies in the order of their rows, from row 1. Returns
    /// the number of kinematic bodies.
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
            travel_scale: self.travel_scale,
        }
    }

    /// The typical length of objects, in metres. 1 if never set.
    #[inline(always)]
    pub fn length_unit(&self) -> f32 {
        self.travel_scale.metres * TRAVEL_UNITS
    }

    /// Sets the typical length of objects, in metres. If it changes, all contacts are checked in the next
    /// step.
    pub fn set_length_unit(&mut self, length_unit: f32) {
        debug_assert!(length_unit > 0.0 && length_unit.is_finite(), "a length unit of {length_unit} m");
        let scale = TravelScale::new(length_unit);
        if core::mem::replace(&mut self.travel_scale, scale) != scale {
            self.poses.iter_mut().for_each(|pose| pose.travel = pose.travel.wrapping_add(FAR));
        }
    }

    /// The frame of a body in world space.
    pub fn frame(&self, id: u32) -> WorldPose {
        self.poses[id as usize].frame(self[id].local_center)
    }

    /// Moves a body by hand, and invalidates its cached contacts.
    pub fn teleport(&mut self, id: u32, frame: WorldPose) {
        let center = frame.transform(self[id].local_center);
        let pose = &mut self.poses[id as usize];
        pose.center = center;
        pose.rotation = frame.rotation;
        self.revise(id);
    }

    /// Sets the velocity of a body by hand. Call
    /// [`ColliderTable::refresh_pushed`](super::ColliderTable::refresh_pushed) before pairs are found, or the
    /// body may tunnel in the next step.
    #[inline]
    pub fn set_velocity(&mut self, id: u32, velocity: Velocity) {
        if velocity != self.velocities[id as usize] && velocity != Velocity::default() {
            self.pushed.insert(id);
        }
        self.velocities[id as usize] = velocity;
        self.bound_speed(id);
    }

    /// Records that a collider of a body reaches `extent` metres from the body's centre of mass.
    pub(super) fn reach_out(&mut self, id: u32, extent: f32) {
        if extent > self[id].extent {
            self[id].extent = extent;
            self.bound_speed(id);
        }
    }

    fn bound_speed(&mut self, id: u32) {
        let i = id as usize;
        self.poses[i].speed = self.velocities[i].surface_speed(self.bodies[i].extent);
    }

    fn revise(&mut self, id: u32) {
        let pose = &mut self.poses[id as usize];
        pose.revision = pose.revision.wrapping_add(1);
    }
}

/// Columns of [`BodyTable`] that several threads change at once.
pub(crate) struct BodyParts<'a> {
    pub(crate) bodies: Parts<'a, Body>,
    pub(crate) poses: Parts<'a, BodyPose>,
    pub(crate) velocities: Parts<'a, Velocity>,
    /// Row of each body in this step. No two bodies share a row other than 0.
    pub(crate) rows: &'a [u32],
    pub(crate) travel_scale: TravelScale,
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The longest time of rest in two seconds at the given speeds, in seconds.
    fn rest_time(speed: impl Fn(f32) -> f32) -> f32 {
        let mut table = BodyTable::default();
        let id = table.add(BodyKind::Dynamic, Vector::ZERO, WorldPose::IDENTITY);
        let body = &mut table[id];
        body.rest_speed = RestSpeed { linear: 0.15, angular: 0.15 };
        let dt = 1.0 / 60.0;
        let (mut time, mut longest) = (0.0f32, 0.0f32);
        for step in 0..120 {
            let way = Vector::X * (speed(step as f32 * dt) * dt);
            let rests = body.rest_speed.admits(way.length_squared(), 0.0, dt);
            let rests = body.rests_on_average(way, Angular::ZERO, dt) | rests;
            time = if rests { time + dt } else { 0.0 };
            longest = longest.max(time);
        }
        longest
    }

    #[test]
    fn what_shakes_in_place_rests_and_what_moves_on_does_not() {
        let shaking = |t: f32| if (t * 60.0 + 0.5) as i32 % 2 == 0 { 0.8 } else { -0.8 };
        assert!(rest_time(shaking) > 1.9, "it is in one place");
        assert!(rest_time(|_| 0.17) < 0.5, "it moves on");
        assert!(rest_time(|t| 0.4 * t) < 0.5, "it begins to roll");
        assert!(rest_time(|t| shaking(t) + 0.3) < 0.5, "it shakes and moves on");
    }
}
