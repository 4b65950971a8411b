//! Input of the narrow phase, and the quantities derived from it for the two sides of a contact.

use super::record::Contact;
use crate::manifold::LocalManifold;
use crate::math::{Lane, Pose, Rot, Vector, WorldPose, max, min};
use crate::shape::Shape;
use crate::table::{BodyKind, BodyPose, BodyTable, ColliderTable, NONE, Reach, Velocity, is_swinging, turn};

/// Computes the manifolds of pairs with a [foreign shape](crate::shape::Shape::Foreign).
pub trait ManifoldSource: Sync {
    /// Adds the manifolds of colliders `a` and `b` in A's frame, with normals from A to B and points up to
    /// `prediction` metres apart. `pose` is B's pose in A's frame.
    fn manifolds(&self, colliders: [u32; 2], pose: &Pose, prediction: f32, out: &mut Vec<LocalManifold>);

    /// Adds the manifolds of a collider and a ball whose centre is given in the collider's frame.
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

/// Input of the narrow phase, constant while it runs.
pub struct NarrowPhaseInput<'a> {
    /// The bodies.
    pub bodies: &'a BodyTable,
    /// The colliders.
    pub colliders: &'a ColliderTable,
    /// Computes the manifolds of pairs with a foreign shape.
    pub source: &'a dyn ManifoldSource,
    /// The step's length, in seconds.
    pub dt: f32,
    /// Contacts up to this distance are always found, in metres.
    pub tolerance: f32,
    /// The distance up to which contacts are predicted at rest, in metres, where the colliders'
    /// speculative margins allow it.
    pub speculative: f32,
    /// Maximum relative motion of the surfaces, in metres, up to which a manifold is recycled; 0 switches
    /// recycling off.
    pub recycle_distance: f32,
    /// Whether points inherit the impulses of the last step.
    pub match_points: bool,
    /// Recycles four contacts side by side even if the CPU has wider lanes. Results are the same.
    pub narrow: bool,
}

impl<'a> NarrowPhaseInput<'a> {
    /// Input with the usual lengths for shapes of about a metre: a tolerance of 5 mm, prediction up to 2 cm,
    /// recycling up to 5 cm. `source` is `&()` if no shape is [foreign](crate::shape::Shape::Foreign), `dt`
    /// is in seconds.
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
    /// The sides of a contact. The pose of a collider without a body is kept in `fixed`.
    #[inline(always)]
    pub(super) fn sides<'a>(&'a self, contact: &Contact, fixed: &'a mut [Option<BodyPose>; 2]) -> Sides<'a> {
        let Contact { colliders, bodies, .. } = *contact;
        let [a, b] = fixed;
        let poses = [self.pose(colliders[0], bodies[0], a), self.pose(colliders[1], bodies[1], b)];
        Sides { input: self, colliders, bodies, poses }
    }

    #[inline(always)]
    fn pose<'a>(&'a self, collider: u32, body: u32, fixed: &'a mut Option<BodyPose>) -> &'a BodyPose {
        match body {
            NONE => {
                let WorldPose { position, rotation } = self.colliders.poses[collider as usize];
                fixed.insert(BodyPose { center: position, rotation, ..BodyPose::default() })
            }
            body => &self.bodies.poses[body as usize],
        }
    }

    /// The velocity of a body, 0 for [`NONE`].
    #[inline(always)]
    pub(super) fn velocity(&self, body: u32) -> Velocity {
        match body {
            NONE => Velocity::default(),
            body => self.bodies.velocities[body as usize],
        }
    }

    /// Whether a body is dynamic. [`NONE`] is not.
    #[inline(always)]
    pub(super) fn is_dynamic(&self, body: u32) -> bool {
        body != NONE && self.bodies[body].kind == BodyKind::Dynamic
    }

    /// Query to a [`ManifoldSource`] for a contact with a foreign shape: B's pose in A's frame, and the
    /// maximum separation of points.
    pub fn foreign_view(&self, contact: &Contact) -> (Pose, f32) {
        let mut fixed = [None; 2];
        let sides = self.sides(contact, &mut fixed);
        (sides.relative(), sides.farthest(sides.prediction()) + sides.margin())
    }
}

/// The two sides of a contact in the tables.
#[derive(Clone, Copy)]
pub(super) struct Sides<'a> {
    pub(super) input: &'a NarrowPhaseInput<'a>,
    pub(super) colliders: [u32; 2],
    pub(super) bodies: [u32; 2],
    /// The poses of the bodies, or of colliders without a body. By reference: a copy is written and read in
    /// different sizes, which stalls the processor.
    pub(super) poses: [&'a BodyPose; 2],
}

impl<'a> Sides<'a> {
    #[inline(always)]
    pub(super) fn velocity(&self, side: usize) -> Velocity {
        self.input.velocity(self.bodies[side])
    }

    /// Without `map`, which the compiler does not inline here.
    #[inline(always)]
    pub(super) fn reaches(&self) -> [&'a Reach; 2] {
        let ([a, b], reaches) = (self.colliders, &self.input.colliders.reaches);
        [&reaches[a as usize], &reaches[b as usize]]
    }

    #[inline(always)]
    pub(super) fn shapes(&self) -> [&'a Shape; 2] {
        let ([a, b], colliders) = (self.colliders, self.input.colliders);
        [&colliders[a].def.shape, &colliders[b].def.shape]
    }

    /// The poses of the colliders.
    #[inline(always)]
    pub(super) fn shape_poses(&self) -> [&'a WorldPose; 2] {
        let ([a, b], poses) = (self.colliders, &self.input.colliders.poses);
        [&poses[a as usize], &poses[b as usize]]
    }

    /// The rotation of A's shape, in whose frame manifolds are computed.
    #[inline(always)]
    pub(super) fn frame(&self) -> Rot {
        self.shape_poses()[0].rotation
    }

    /// The pose of B's shape in the frame of A's shape.
    #[inline(always)]
    pub(super) fn relative(&self) -> Pose {
        let [a, b] = self.shape_poses();
        a.relative(b)
    }

    /// From A's to B's centre of mass.
    #[inline(always)]
    pub(super) fn offset(&self) -> Vector {
        (self.poses[1].center - self.poses[0].center).to_local()
    }

    /// Whether each body is dynamic.
    #[inline(always)]
    pub(super) fn are_dynamic(&self) -> [bool; 2] {
        let [a, b] = self.bodies;
        [self.input.is_dynamic(a), self.input.is_dynamic(b)]
    }

    /// The sum of both margins: the distance kept between the shapes, in metres.
    #[inline(always)]
    pub(super) fn margin(&self) -> f32 {
        let [a, b] = self.reaches();
        a.margin + b.margin
    }

    /// Each side's revision, combined from its collider and its body.
    #[inline(always)]
    pub(super) fn revisions(&self) -> [u32; 2] {
        let ([a, b], poses) = (self.reaches(), self.poses);
        let of = |reach: &Reach, pose: &BodyPose| {
            reach.revision.wrapping_add(pose.revision.wrapping_mul(0x9E37_79B1))
        };
        [of(a, poses[0]), of(b, poses[1])]
    }

    /// The distance up to which contacts are predicted at rest: no body's speculative margin is exceeded. A
    /// body that does not move sets no limit.
    pub(super) fn near(&self) -> f32 {
        let [a, b] = self.reaches().map(|reach| match reach.turning {
            0.0 => f32::MAX,
            _ => reach.speculative,
        });
        max(self.input.tolerance, min(self.input.speculative, min(a, b)))
    }

    /// The velocity of a side's body, limited so that its motion in the step stays within its speculative
    /// margin.
    #[inline(always)]
    fn predicted_velocity(&self, side: usize) -> Vector {
        let (velocity, margin) = (self.velocity(side).linear, self.reaches()[side].speculative);
        let way = velocity * self.input.dt;
        let is_beyond = way.length_squared() > margin * margin;
        if is_beyond { velocity * (margin / way.length()) } else { velocity }
    }

    /// Maximum separation of a contact: the distance that the surfaces can close in this step without
    /// turning. The velocity of each body is limited by its own speculative margin.
    pub(super) fn prediction(&self) -> f32 {
        max(self.near(), self.predicted_motion().length())
    }

    /// Motion of B relative to A in this step, in world axes, within their speculative margins.
    pub(super) fn predicted_motion(&self) -> Vector {
        (self.predicted_velocity(1) - self.predicted_velocity(0)) * self.input.dt
    }

    /// The [`prediction`](Self::prediction) plus the distance that turning may close.
    pub(super) fn farthest(&self, prediction: f32) -> f32 {
        let mut turning = 0.0;
        let NarrowPhaseInput { dt, speculative, .. } = *self.input;
        for (side, reach) in self.reaches().into_iter().enumerate() {
            let velocity = self.velocity(side);
            let turn = turn(velocity.angular.length(), dt);
            if is_swinging(reach, turn, speculative) {
                let left = max(reach.speculative - velocity.linear.length() * dt, 0.0);
                turning += min(reach.arm * turn, left);
            }
        }
        prediction + turning
    }

    #[inline(always)]
    pub(super) fn fat_boxes_overlap(&self) -> bool {
        let ([a, b], fat) = (self.colliders, &self.input.colliders.fat);
        fat[a as usize].overlaps(&fat[b as usize])
    }

    /// The gap between the tight boxes of both sides, margins not subtracted.
    #[inline(always)]
    pub(super) fn box_gap(&self) -> f32 {
        let ([a, b], tight) = (self.colliders, &self.input.colliders.tight);
        tight[a as usize].gap(&tight[b as usize])
    }
}

/// The smaller of two reaches. A half-space has reach 0, and the other side's reach counts.
#[inline(always)]
pub(super) fn smaller<N: Lane>([a, b]: [N; 2]) -> N {
    let is_half_space = N::or(a.eq(N::ZERO), b.eq(N::ZERO));
    N::select(is_half_space, a.max(b), a.min(b))
}
