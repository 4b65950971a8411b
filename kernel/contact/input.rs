//! What the narrow phase reads, and what follows from it for the two sides of a contact.

use super::record::Contact;
use crate::manifold::LocalManifold;
use crate::math::{Lane, Pose, Vector, WorldPose, max, min};
use crate::shape::Shape;
use crate::table::{BodyKind, BodyPose, BodyTable, ColliderTable, NONE, Reach, Velocity, is_swinging, turn};

/// Computes the manifolds of pairs with a [foreign shape](crate::shape::Shape::Foreign).
pub trait ManifoldSource: Sync {
    /// Adds the manifolds of colliders `a` and `b`, `pose` being where B is in A's frame: in A's frame with normals from A to
    /// B, with points up to `prediction` metres apart.
    fn manifolds(&self, colliders: [u32; 2], pose: &Pose, prediction: f32, out: &mut Vec<LocalManifold>);

    /// The same for a collider and a ball, whose centre is given in the collider's frame.
    fn ball_manifolds(
        &self,
        collider: u32,
        center: Vector,
        radius: f32,
        prediction: f32,
        out: &mut Vec<LocalManifold>,
    );
}

impl ManifoldSource for () {
    fn manifolds(&self, _: [u32; 2], _: &Pose, _: f32, _: &mut Vec<LocalManifold>) {}

    fn ball_manifolds(&self, _: u32, _: Vector, _: f32, _: f32, _: &mut Vec<LocalManifold>) {}
}

/// What the narrow phase reads; constant while it runs.
pub struct NarrowPhaseInput<'a> {
    /// The bodies.
    pub bodies: &'a BodyTable,
    /// The colliders.
    pub colliders: &'a ColliderTable,
    /// For pairs with a foreign shape.
    pub source: &'a dyn ManifoldSource,
    /// The step's length, in seconds.
    pub dt: f32,
    /// Contacts up to this distance are always found, in metres.
    pub tolerance: f32,
    /// The distance up to which contacts are predicted at rest, in metres, where the colliders'
    /// speculative margins allow it.
    pub speculative: f32,
    /// How far, in metres, a surface may have moved against the other for the manifold to be recycled;
    /// 0 switches recycling off.
    pub recycle_distance: f32,
    /// Whether points inherit the impulses of the last step.
    pub match_points: bool,
    /// Recycles four contacts side by side even if the CPU has wider lanes. Results are the same.
    pub narrow: bool,
}

impl<'a> NarrowPhaseInput<'a> {
    /// Input with the usual lengths for shapes of about a metre: a tolerance of 5 mm, prediction up to 2 cm, recycling up
    /// to 5 cm. `source` is `&()` if no shape is [foreign](crate::shape::Shape::Foreign), `dt` is in seconds.
    pub fn new(
        bodies: &'a BodyTable,
        colliders: &'a ColliderTable,
        source: &'a dyn ManifoldSource,
        dt: f32,
    ) -> Self {
        Self {
            bodies,
            colliders,
            source,
            dt,
            tolerance: 0.005,
            speculative: 0.02,
            recycle_distance: 0.05,
            match_points: true,
            narrow: false,
        }
    }
}

impl NarrowPhaseInput<'_> {
    /// The poses of both sides' bodies; of a collider without one, its own, kept in `fixed`. By reference: a copy is
    /// written in other pieces than it is read in, which a processor waits for.
    #[inline(always)]
    pub(super) fn poses<'a>(
        &'a self,
        contact: &Contact,
        fixed: &'a mut [Option<BodyPose>; 2],
    ) -> [&'a BodyPose; 2] {
        let [a, b] = fixed;
        [self.pose(contact, 0, a), self.pose(contact, 1, b)]
    }

    #[inline(always)]
    fn pose<'a>(&'a self, contact: &Contact, side: usize, fixed: &'a mut Option<BodyPose>) -> &'a BodyPose {
        match contact.bodies[side] {
            NONE => {
                let WorldPose { position, rotation } = self.colliders.poses[contact.colliders[side] as usize];
                fixed.insert(BodyPose { center: position, rotation, ..BodyPose::default() })
            }
            body => &self.bodies.poses[body as usize],
        }
    }

    #[inline(always)]
    pub(super) fn velocity(&self, contact: &Contact, side: usize) -> Velocity {
        match contact.bodies[side] {
            NONE => Velocity::default(),
            body => self.bodies.velocities[body as usize],
        }
    }

    /// The side's revision: of its collider and its body together.
    #[inline(always)]
    fn revision(reach: &Reach, pose: &BodyPose) -> u32 {
        reach.revision.wrapping_add(pose.revision.wrapping_mul(0x9E37_79B1))
    }

    /// The reaches of both sides. Without `map`, which the compiler does not inline here.
    #[inline(always)]
    pub(super) fn reaches(&self, contact: &Contact) -> [&Reach; 2] {
        let [a, b] = contact.colliders;
        [&self.colliders.reaches[a as usize], &self.colliders.reaches[b as usize]]
    }

    /// How far apart the shapes are kept, in metres.
    #[inline(always)]
    pub(super) fn margin(&self, contact: &Contact) -> f32 {
        let [a, b] = self.reaches(contact);
        a.margin + b.margin
    }

    #[inline(always)]
    pub(super) fn revisions(&self, contact: &Contact, poses: [&BodyPose; 2]) -> [u32; 2] {
        let [a, b] = self.reaches(contact);
        [Self::revision(a, poses[0]), Self::revision(b, poses[1])]
    }

    /// The distance up to which contacts are predicted at rest: no body's speculative margin is exceeded. What does not
    /// move has none.
    pub(super) fn near(&self, contact: &Contact) -> f32 {
        let [a, b] = self.reaches(contact).map(|reach| match reach.turning {
            0.0 => f32::MAX,
            _ => reach.speculative,
        });
        max(self.tolerance, min(self.speculative, min(a, b)))
    }

    /// The velocity of a side's body, no faster than to its speculative margin in the step.
    #[inline(always)]
    fn predicted_velocity(&self, contact: &Contact, side: usize, margin: f32) -> Vector {
        let velocity = self.velocity(contact, side).linear;
        let way = velocity * self.dt;
        let is_beyond = way.length_squared() > margin * margin;
        if is_beyond { velocity * (margin / way.length()) } else { velocity }
    }

    /// Surfaces up to this distance apart count as a contact: as far as they can close in this step if nothing turns. The
    /// velocity of each body is limited by its own speculative margin.
    pub(super) fn prediction(&self, contact: &Contact) -> f32 {
        max(self.near(contact), self.predicted_motion(contact).length())
    }

    /// How far B moves against A in this step, in world axes, as far as their speculative margins allow.
    pub(super) fn predicted_motion(&self, contact: &Contact) -> Vector {
        let [a, b] = self.reaches(contact);
        let a = self.predicted_velocity(contact, 0, a.speculative);
        let b = self.predicted_velocity(contact, 1, b.speculative);
        (b - a) * self.dt
    }

    /// The [`prediction`](Self::prediction), and as far as turning may close as well.
    pub(super) fn farthest(&self, contact: &Contact, prediction: f32) -> f32 {
        let mut turning = 0.0;
        for (side, reach) in self.reaches(contact).into_iter().enumerate() {
            let velocity = self.velocity(contact, side);
            let turn = turn(velocity.angular.length(), self.dt);
            if is_swinging(reach, turn, self.speculative) {
                let left = max(reach.speculative - velocity.linear.length() * self.dt, 0.0);
                turning += min(reach.arm * turn, left);
            }
        }
        prediction + turning
    }

    /// What a [`ManifoldSource`] is asked of a contact with a foreign shape: where B is in A's frame, and how far apart points
    /// may be.
    pub fn foreign_view(&self, contact: &Contact) -> (Pose, f32) {
        let [a, b] = self.shape_poses(contact);
        let prediction = self.prediction(contact);
        (a.relative(b), self.farthest(contact, prediction) + self.margin(contact))
    }

    /// The shapes of both sides.
    #[inline(always)]
    pub(super) fn shapes(&self, contact: &Contact) -> [&Shape; 2] {
        let [a, b] = contact.colliders;
        [&self.colliders[a].def.shape, &self.colliders[b].def.shape]
    }

    /// The poses of both colliders.
    #[inline(always)]
    pub(super) fn shape_poses(&self, contact: &Contact) -> [&WorldPose; 2] {
        let [a, b] = contact.colliders;
        [&self.colliders.poses[a as usize], &self.colliders.poses[b as usize]]
    }

    /// Whether a body is dynamic. [`NONE`] is not.
    #[inline(always)]
    pub(super) fn is_dynamic(&self, body: u32) -> bool {
        body != NONE && self.bodies[body].kind == BodyKind::Dynamic
    }

    /// The gap between the tight boxes of both sides, margins not subtracted.
    #[inline(always)]
    pub(super) fn box_gap(&self, contact: &Contact) -> f32 {
        let [a, b] = contact.colliders;
        self.colliders.tight[a as usize].gap(&self.colliders.tight[b as usize])
    }
}

/// The smaller of two reaches. Half-spaces reach nowhere, and count by the other side.
#[inline(always)]
pub(super) fn smaller<N: Lane>([a, b]: [N; 2]) -> N {
    let is_half_space = N::or(a.eq(N::ZERO), b.eq(N::ZERO));
    N::select(is_half_space, a.max(b), a.min(b))
}
