//! Contacts at a later time of the step: of shapes that will meet, and of round shapes that rock on each
//! other.
//!
//! The plane at the present closest points is no wall: it would stop a body that passes by, and a point far
//! out on a turning body moves along an arc. So the pair is advanced to its time of impact ([conservative
//! advancement](advance)). The solver gets the contact at this time, with separations that lead the bodies
//! there. A pair that does not meet has no contact. Round bodies that rock get the contact in the middle of
//! the step; see [`midstep_contact`].

#[cfg(test)]
#[path = "tests_time_of_impact.rs"]
mod tests;

use super::input::{Sides, smaller};
use super::record::{Contact, Manifold};
use crate::distance::{Approach, advance};
use crate::manifold::{self, LocalManifold};
use crate::math::{Angular, Rot, Vector, WorldPose, max, min};
use crate::shape::Shape;
use crate::table::{BodyPose, NONE, Reach};
use crate::tuning::contact::{MOST_WAY, SAME_FACE, STILL};
use crate::tuning::solver::SMALL_TURN;
use crate::tuning::sweeps::{AHEAD, CHORDS, LAG, MEETING_ROUNDS, MET, MOST_TURN};

/// The poses at a time within the step: at the time of impact or in the middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    pub(super) placed: [Placed; 2],
    /// From A's to B's centre of mass.
    pub(super) offset: Vector,
    /// Shift of B's centre of mass relative to A's until this time.
    shift: Vector,
}

/// One side of a contact at some time within the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) body: BodyPose,
    /// Rotation of the body until this time.
    turn: Rot,
    pub(super) shape: WorldPose,
}

/// Advances two native shapes, `gap` apart without margins, to their time of impact in this step. `local`
/// holds their present points within `prediction`, and receives the points at the time of impact, or none.
#[inline(never)]
pub(super) fn find_meeting(
    sides: &Sides,
    contact: &mut Contact,
    gap: f32,
    prediction: f32,
    local: &mut LocalManifold,
) -> Option<Meeting> {
    let farthest = sides.farthest(prediction);
    if gap > farthest || (local.count == 0 && !(farthest > prediction)) {
        return None;
    }
    let shapes = sides.shapes();
    let mut motion = Motion::new(sides);
    if local.count > 0 {
        motion.met *= MET;
    }
    let margin = sides.margin();
    let end = min(sides.input.dt, MOST_TURN / max(motion.spins[0], motion.spins[1]));
    let placed = [Placed::now(sides, 0), Placed::now(sides, 1)];
    // A lower bound of the time when the shapes meet, given their gap at `time`.
    let apart_until = |placed: &[Placed; 2], local: &LocalManifold, gap: f32, time: f32| {
        let offset = (placed[1].body.center - placed[0].body.center).to_local();
        let slab = Slab { shapes, placed, motion: &motion, offset, margin };
        time + match local.count {
            0 => max(gap, 0.5 * motion.met) / motion.fastest(offset),
            _ => slab.time_to_cross(placed[0].shape.rotation.rotate(local.normal), gap, end - time),
        }
    };
    let first = apart_until(&placed, local, gap, 0.0);
    let meeting = advance(first, MEETING_ROUNDS, |time, round| {
        // A NaN ends the advance too.
        if !(time >= 0.0 && time < end) {
            return None;
        }
        let placed = place_at(sides, time);
        let relative = placed[0].shape.relative(&placed[1].shape);
        // Shapes farther apart than the remaining motion do not meet.
        let rest = max(farthest * (1.0 - time / sides.input.dt), sides.near()) + margin;
        manifold::collide(shapes[0], shapes[1], &relative, rest, &mut contact.cache, local);
        let gap = local.lower_bound() - margin;
        if gap <= motion.met || (round == MEETING_ROUNDS && local.count > 0) {
            // Points that only turning brings together are found again when they are near.
            let prediction = prediction + margin;
            manifold::collide(shapes[0], shapes[1], &relative, prediction, &mut contact.cache, local);
            return (local.count > 0).then(|| Approach::Met(Meeting::new(placed, sides)));
        }
        Some(Approach::ApartUntil(apart_until(&placed, local, gap, time)))
    });
    if meeting.is_none() {
        local.count = 0;
    }
    meeting
}

/// Whether two shapes that have points, and do not touch, may pass each other by in this step: their motion
/// may cross the plane between them.
#[inline(always)]
pub(super) fn may_pass_by(sides: &Sides, local: &LocalManifold) -> bool {
    let motion = Motion::new(sides);
    let gap = local.lower_bound() - sides.margin();
    let normal = sides.frame().rotate(local.normal);
    is_straight(sides)
        && gap > MET * motion.met
        && motion.closing(normal, sides.offset()) * (AHEAD * sides.input.dt) > gap
}

/// The distance at which two shapes that move past each other count as having met.
pub(super) fn met_at(sides: &Sides) -> f32 {
    MET * Motion::new(sides).met
}

/// Whether the bodies turn little in this step. The solver keeps the arms of the step's start. A body that
/// turns farther gains energy if it is pushed at its later position.
pub(super) fn is_straight(sides: &Sides) -> bool {
    sides.reaches().into_iter().enumerate().all(|(side, reach)| {
        reach.arm == 0.0 || sides.velocity(side).angular.length() * sides.input.dt < 0.5 * MOST_TURN
    })
}

/// Whether the solver would push at some point if the bodies kept their velocities.
pub(super) fn pushes(sides: &Sides, local: &LocalManifold) -> bool {
    let [frame, _] = sides.shape_poses();
    let normal = frame.rotation.rotate(local.normal);
    let margin = sides.margin();
    local.points().iter().any(|p| {
        let place = frame.transform(p.point);
        let [a, b] = [0, 1].map(|side| {
            let velocity = sides.velocity(side);
            velocity.linear + velocity.angular.cross((place - sides.poses[side].center).to_local())
        });
        (a - b).dot(normal) * (AHEAD * sides.input.dt) > p.separation - margin
    })
}

/// Moves the single point of `local`, where a round surface presses another body, to its position in the
/// middle of the step, up to `prediction` apart. Leaves all other manifolds unchanged.
///
/// The solver keeps normals and arms for a step. The contact point of a rocking round body runs along both
/// surfaces. An arm that lags behind this point feeds the rocking like a negative damper: a light body
/// between heavy bodies never came to rest.
pub(super) fn midstep_contact(
    sides: &Sides,
    contact: &mut Contact,
    prediction: f32,
    local: &mut LocalManifold,
) -> Option<Meeting> {
    let is_round = |local: &LocalManifold| local.count == 1 && max(local.radii[0], local.radii[1]) > 0.0;
    let presses = is_round(local) && local.points[0].separation <= sides.margin();
    if !presses || contact.is_inert() {
        return None;
    }
    let [va, vb] = [sides.velocity(0), sides.velocity(1)];
    let turn = (vb.angular - va.angular).length() * sides.input.dt;
    let fastest = max(va.angular.length(), vb.angular.length()) * sides.input.dt;
    let way = (vb.linear - va.linear).length() * sides.input.dt;
    let size = min(smaller(sides.reaches().map(|reach| reach.extent)), smaller(local.radii));
    let rocks = turn > STILL && turn < SMALL_TURN && fastest < MOST_TURN && way < MOST_WAY * size;
    if !(rocks && sides.are_dynamic() == [true; 2]) {
        return None;
    }
    let placed = place_at(sides, 0.5 * sides.input.dt);
    let relative = placed[0].shape.relative(&placed[1].shape);
    let [a, b] = sides.shapes();
    let mut then = LocalManifold::default();
    manifold::collide(a, b, &relative, prediction, &mut contact.cache, &mut then);
    let normal = sides.frame().rotate(local.normal);
    let continues = placed[0].shape.rotation.rotate(then.normal).dot(normal) > SAME_FACE;
    if !(is_round(&then) && continues) {
        return None;
    }
    *local = then;
    Some(Meeting::new(placed, sides))
}

/// How fast two shapes may close in this step.
struct Motion<'a> {
    /// The velocity of B against A.
    linear: Vector,
    angular: [Angular; 2],
    spins: [f32; 2],
    reaches: [&'a Reach; 2],
    /// The distance at which they count as having met.
    met: f32,
}

impl<'a> Motion<'a> {
    fn new(sides: &Sides<'a>) -> Self {
        let reaches = sides.reaches();
        let [a, b] = [sides.velocity(0), sides.velocity(1)];
        Self {
            linear: b.linear - a.linear,
            angular: [a.angular, b.angular],
            spins: [a.angular.length(), b.angular.length()],
            reaches,
            met: min(sides.input.tolerance, LAG * smaller(reaches.map(|reach| reach.extent))),
        }
    }

    /// An upper bound of the speed at which turning brings the shapes together. They meet no farther out than
    /// the other shape reaches; `offset` is from A's to B's centre of mass.
    fn turning(&self, offset: Vector) -> f32 {
        let far = offset.length();
        let arm = |side: usize| match self.reaches[1 - side].extent {
            0.0 => self.reaches[side].arm,
            other => min(self.reaches[side].arm, far + other),
        };
        arm(0) * self.spins[0] + arm(1) * self.spins[1]
    }

    /// An upper bound of the speed at which the shapes close.
    fn fastest(&self, offset: Vector) -> f32 {
        self.linear.length() + self.turning(offset)
    }

    /// An upper bound of the closing speed along a normal from A to B: the slab between the shapes is not
    /// crossed sooner.
    fn closing(&self, normal: Vector, offset: Vector) -> f32 {
        self.turning(offset) - self.linear.dot(normal)
    }
}

/// Two shapes that move evenly, each about its own centre of mass, and a plane between them.
struct Slab<'a> {
    shapes: [&'a Shape; 2],
    placed: &'a [Placed; 2],
    motion: &'a Motion<'a>,
    /// From A's to B's centre of mass.
    offset: Vector,
    margin: f32,
}

/// The slab between two shapes in the frame of one body: its normal turns with this body, whose face may
/// define it.
struct View<'a> {
    slab: &'a Slab<'a>,
    /// The side that moves in this view.
    moving: usize,
    /// From the moving shape to the other shape.
    normal: Vector,
    /// The slab's width now.
    width: f32,
    /// How fast the moving body's centre of mass approaches, in m/s.
    speed: f32,
    angular: Angular,
    /// An upper bound of the acceleration of any point in this view, in m/s².
    acceleration: f32,
    /// The distance of the moving shape's farthest point along the normal from its centre of mass.
    height: f32,
}

impl<'a> Slab<'a> {
    /// A lower bound of the time until the slab between the shapes, `gap` wide along a normal from A to B,
    /// narrows to half of the distance that counts as having met; infinite beyond `end`.
    fn time_to_cross(&self, normal: Vector, gap: f32, end: f32) -> f32 {
        let goal = 0.5 * self.motion.met;
        let rate = self.motion.closing(normal, self.offset);
        // A minimum step, so that the advance does not slow down without end.
        let least = if rate > 0.0 { goal / rate } else { f32::INFINITY };
        let coarse = max(gap / rate, least);
        let Some(views) = self.views(normal, end) else { return coarse };
        // Points that are cut off by an edge may be within the slab.
        if !(views[0].width > goal) {
            return coarse;
        }
        let last = [views[0].width_after(end), views[1].width_after(end)];
        let better = usize::from(last[1] > last[0]);
        // Speeds near the limits of floats have no finite square.
        if !last[better].is_finite() {
            return coarse;
        }
        max(views[better].time_to(goal, end, last[better]), least)
    }

    /// The views of both bodies; `None` if a shape has no support point.
    fn views(&'a self, normal: Vector, end: f32) -> Option<[View<'a>; 2]> {
        let heights = [self.height(0, normal)?, self.height(1, -normal)?];
        let Motion { linear, angular, spins, reaches, .. } = self.motion;
        let width = self.offset.dot(normal) - heights[0] - heights[1] - self.margin;
        let view = |moving: usize| {
            let still = 1 - moving;
            let normal = if moving == 0 { normal } else { -normal };
            let [offset, linear] = [self.offset, *linear].map(|v| if moving == 1 { v } else { -v });
            let speed = linear.length();
            // A point r of the moving body, seen from the other centre of mass, is at x = Q⁻¹ (d + t v + P
            // r), where Q and P turn by the angular velocities ω and ψ: x'' is at most ω² |d + t v| + 2
            // ω |v| + (ω + ψ)² |r|.
            let both = spins[0] + spins[1];
            let away = offset.length() + speed * end;
            View {
                slab: self,
                moving,
                normal,
                width,
                speed: (linear - angular[still].cross(offset)).dot(normal),
                angular: angular[moving] - angular[still],
                acceleration: spins[still] * (spins[still] * away + 2.0 * speed)
                    + both * both * reaches[moving].extent,
                height: heights[moving],
            }
        };
        Some([view(0), view(1)])
    }

    /// How far a side reaches along a direction from its centre of mass, times the direction's length.
    fn height(&self, side: usize, direction: Vector) -> Option<f32> {
        let Placed { body, shape, .. } = &self.placed[side];
        let farthest = self.shapes[side].support(shape.rotation.inverse_rotate(direction))?;
        let arm = (shape.position - body.center).to_local() + shape.rotation.rotate(farthest);
        Some(arm.dot(direction))
    }
}

impl View<'_> {
    /// A lower bound of the slab's width after a time.
    ///
    /// n · (ω × r) = r · (n × ω): the highest point after the time t is the farthest one along n + t n × ω.
    fn width_after(&self, time: f32) -> f32 {
        let direction = self.normal - self.angular.cross(self.normal) * time;
        let height = self.slab.height(self.moving, direction).unwrap_or(f32::INFINITY);
        let closed = self.speed * time + (height - self.height) + 0.5 * self.acceleration * time * time;
        self.width - closed
    }

    /// A lower bound of the time until the width falls to `goal`; infinite if it stays above `goal` until
    /// `end`. `last` is the width at `end`.
    ///
    /// The bound of the width is concave over time. So a chord lies below the bound, and reaches the goal no
    /// later.
    fn time_to(&self, goal: f32, end: f32, last: f32) -> f32 {
        if last >= goal {
            return f32::INFINITY;
        }
        let (mut time, mut width) = (0.0, self.width);
        for _ in 0..CHORDS {
            time += (end - time) * (width - goal) / (width - last);
            width = self.width_after(time);
            if !(width > 2.0 * goal) {
                break;
            }
        }
        time
    }
}

/// Both sides of the contact, `time` seconds after the step's start.
fn place_at(sides: &Sides, time: f32) -> [Placed; 2] {
    core::array::from_fn(|side| {
        let (body, mut placed) = (sides.bodies[side], Placed::now(sides, side));
        if body != NONE {
            let velocity = sides.velocity(side);
            placed.turn = Rot::IDENTITY.turned_by(velocity.angular * time);
            placed.body.center += (velocity.linear * time).to_world();
            placed.body.rotation = placed.turn.mul(placed.body.rotation);
            let frame = placed.body.frame(sides.input.bodies[body].local_center);
            placed.shape = frame.then(&sides.input.colliders[sides.colliders[side]].def.local);
        }
        placed
    })
}

impl Placed {
    /// A side at the step's start.
    fn now(sides: &Sides, side: usize) -> Self {
        Self { body: *sides.poses[side], turn: Rot::IDENTITY, shape: *sides.shape_poses()[side] }
    }
}

impl Meeting {
    /// From both sides at the meeting, and the poses of their bodies at the step's start.
    fn new(placed: [Placed; 2], sides: &Sides) -> Self {
        let offset = (placed[1].body.center - placed[0].body.center).to_local();
        Self { placed, offset, shift: offset - sides.offset() }
    }

    /// Converts the separations of a manifold to the step's start. The solver moves the bodies with these
    /// arms, and so reaches the given separations at the meeting.
    pub(super) fn rewind(&self, m: &mut Manifold) {
        let n = m.normal;
        let cores = [n * m.radii[0], self.offset - n * m.radii[1]];
        let along = self.shift.dot(n);
        for p in &mut m.points[..usize::from(m.count)] {
            let shifts: [f32; 2] = core::array::from_fn(|side| {
                let arm = p.anchor - cores[side];
                self.placed[side].turn.shift_along(arm, arm.cross(n), n)
            });
            p.separation -= along + shifts[1] - shifts[0];
        }
    }
}
