//! Where one body stops in the step.

use super::cast::{Cast, CastBuffers, Caster, Pair, Side};
use super::path::Path;
use crate::bvh::{TreeKind, Trees};
use crate::contact::{ContactTable, ManifoldSource};
use crate::math::{Vector, WorldPose, max, min};
use crate::shape::Aabb;
use crate::table::{BodyKind, BodyPose, BodyTable, ColliderTable, NONE, Reach};
use crate::tuning::sweeps::{CORE_SHARE, MET};

/// The radii of the balls that are cast where shapes touch already, as shares of that within them. The first that is free when
/// the step begins counts.
const BALLS: [f32; 3] = [CORE_SHARE, MET, 0.0];

/// The trees of what does not move.
const FIXED: [TreeKind; 2] = [TreeKind::Static, TreeKind::Standalone];

/// What sweeps read; constant while they run.
pub struct SweepInput<'a, S> {
    /// The bodies as the step began.
    pub bodies: &'a BodyTable,
    /// The colliders as the step began.
    pub colliders: &'a ColliderTable,
    /// The trees of the colliders.
    pub trees: &'a Trees,
    /// The contacts of all pairs with overlapping fat boxes. Such a pair without a contact was refused, and is not swept.
    pub contacts: &'a ContactTable,
    /// For pairs with a foreign shape.
    pub source: &'a S,
    /// Shapes this far apart count as touching, in metres.
    pub tolerance: f32,
    /// The step's length, in seconds.
    pub dt: f32,
}

/// How a body is swept against what moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swept {
    /// Whether turning counts; else both bodies keep their rotation of the step's start.
    pub turns: bool,
    /// Whether it is swept against dynamic bodies, not against kinematic ones alone.
    pub include_dynamic: bool,
    /// Two bodies that move slower than this against each other are not swept if they turn slower as well, in m/s.
    pub linear_threshold: f32,
    /// The same for turning, in rad/s.
    pub angular_threshold: f32,
}

/// Buffers of one worker, kept for their memory.
#[derive(Clone, Debug)]
pub struct SweepBuffers<W = ()> {
    cast: CastBuffers<W>,
    candidates: Vec<u32>,
    /// Bodies that stop, and after what fractions of the step.
    pub(crate) stops: Vec<(u32, f32)>,
}

impl<W: Default> Default for SweepBuffers<W> {
    fn default() -> Self {
        Self { cast: CastBuffers::default(), candidates: Vec::new(), stops: Vec::new() }
    }
}

impl<S: ManifoldSource> SweepInput<'_, S> {
    /// Whether a body that moves by `way` metres and turns by `angle` radians may get past something.
    #[inline(always)]
    pub fn is_far(&self, body: u32, way: f32, angle: f32) -> bool {
        let size = self.colliders.size_of(body);
        way + size.arm * angle > max(CORE_SHARE * size.core, MET * self.tolerance)
    }

    /// Whether there is anything that does not move, and that a body may meet on a way of the step however it turns. Most fast
    /// bodies are far from all that.
    pub fn may_meet(&self, body: u32, way: Vector) -> bool {
        let (mut reach, mut is_known) = (0.0, true);
        for id in self.colliders.of_body(body, self.bodies) {
            let Reach { extent, margin, .. } = self.colliders.reaches[id as usize];
            reach = max(reach, extent + margin);
            // Casts stop this far before shapes touch.
            let around = self.ball(body, extent + margin).swept(way).grown(MET * self.tolerance);
            is_known &= self.colliders.fat[id as usize].contains(&around);
        }
        if is_known {
            // Within its fat boxes a body meets only what has contacts with it.
            return self.colliders.of_body(body, self.bodies).any(|collider| {
                let mut contacts = self.contacts.of_collider(collider, self.colliders);
                contacts.any(|contact| {
                    self.contacts.bodies_of(contact).into_iter().any(|body| self.is_fixed(body))
                })
            });
        }
        let around = self.ball(body, reach).swept(way).grown(self.tolerance);
        FIXED.iter().any(|kind| !self.trees[*kind].query(&around, |_| false))
    }

    /// Whether colliders of a body are in the trees of what does not move.
    fn is_fixed(&self, body: u32) -> bool {
        body == NONE || self.bodies[body].kind == BodyKind::Static
    }

    /// The box of a ball about the centre of mass of a body where the step begins.
    fn ball(&self, body: u32, radius: f32) -> Aabb {
        Aabb::new(Vector::ZERO, Vector::ZERO).at(self.bodies.poses[body as usize].center).grown(radius)
    }

    /// The fraction of the step after which a body stops at what does not move; 1 if it does not.
    pub fn stop(&self, body: u32, path: &Path, buffers: &mut SweepBuffers<S::Workspace>) -> f32 {
        let mut first = 1.0;
        self.each_candidate(body, path, &FIXED, buffers, |[collider, other], buffers| {
            first = min(first, self.impact(collider, path, self.side(other, None), &mut buffers.cast));
        });
        first
    }

    /// Notes after what fractions of the step a body, and the moving bodies that it meets, stop. `path_of` gives the path of
    /// a body that may move, if it has one in this step.
    pub(crate) fn stop_swept(
        &self,
        body: u32,
        swept: &Swept,
        path_of: &impl Fn(u32) -> Option<Path>,
        buffers: &mut SweepBuffers<S::Workspace>,
    ) {
        let Some(path) = path_of(body).map(|path| path.turning_if(swept.turns)) else { return };
        let kinds = [TreeKind::Kinematic, TreeKind::Dynamic];
        let kinds = if swept.include_dynamic { &kinds[..] } else { &kinds[..1] };
        self.each_candidate(body, &path, kinds, buffers, |[collider, other], buffers| {
            let other_body = self.colliders.body(other);
            if other_body == body || other_body == NONE {
                return;
            }
            let velocities = [body, other_body].map(|id| self.bodies.velocities[id as usize]);
            let linear = (velocities[0].linear - velocities[1].linear).length();
            let angular = (velocities[0].angular - velocities[1].angular).length();
            if linear < swept.linear_threshold && angular < swept.angular_threshold {
                return;
            }
            let other_path = path_of(other_body).map(|path| path.turning_if(swept.turns));
            let fraction = self.impact(collider, &path, self.side(other, other_path), &mut buffers.cast);
            if fraction < 1.0 {
                buffers.stops.extend([(body, fraction), (other_body, fraction)]);
            }
        });
    }

    /// Calls `met` with each collider of a body and each that it may meet on its path, of some kinds.
    fn each_candidate(
        &self,
        body: u32,
        path: &Path,
        kinds: &[TreeKind],
        buffers: &mut SweepBuffers<S::Workspace>,
        mut met: impl FnMut([u32; 2], &mut SweepBuffers<S::Workspace>),
    ) {
        let mut candidates = core::mem::take(&mut buffers.candidates);
        for collider in self.colliders.of_body(body, self.bodies) {
            let def = &self.colliders[collider].def;
            if def.flags.sensor {
                continue;
            }
            candidates.clear();
            let around = self.around(collider, path);
            for &kind in kinds {
                self.trees[kind].query(&around, |other| {
                    let found = &self.colliders[other].def;
                    let interacts = !found.flags.sensor && def.layers.interacts_with(found.layers);
                    if interacts && !self.is_refused(collider, other) {
                        candidates.push(other);
                    }
                    true
                });
            }
            candidates.iter().for_each(|other| met([collider, *other], buffers));
        }
        buffers.candidates = candidates;
    }

    /// Whether the embedder lets two colliders through each other. A pair whose fat boxes did not overlap when the step began was
    /// not offered to it, and counts as not refused.
    fn is_refused(&self, a: u32, b: u32) -> bool {
        match self.contacts.find(a, b) {
            Some(id) => self.contacts.get(id).is_let_through(),
            None => self.colliders.fat[a as usize].overlaps(&self.colliders.fat[b as usize]),
        }
    }

    /// The box of all places that a collider takes on its body's path.
    fn around(&self, collider: u32, path: &Path) -> Aabb {
        let (def, extent) = (&self.colliders[collider].def, self.colliders.reaches[collider as usize].extent);
        let boxes = [0.0, 1.0].map(|fraction| def.shape.aabb(&path.frame(fraction).then(&def.local)));
        let round = Aabb::new(Vector::ZERO, Vector::ZERO).at(path.start.center).grown(extent);
        // A point goes along an arc. Off the line between its ends that is by r (1 - cos φ/2) < r φ²/8 at most.
        let spin = path.spin.length_squared();
        let arcs = boxes[0].union(&boxes[1]).grown(min(0.125 * extent * spin, 2.0 * extent));
        arcs.intersection(&round.swept(path.way)).grown(def.margin + self.tolerance)
    }

    /// A collider on its body's path; without one it stays where it is.
    fn side(&self, collider: u32, path: Option<Path>) -> Side<'_> {
        let entry = &self.colliders[collider];
        let def = &entry.def;
        let (path, local) = match (path, def.body) {
            (Some(path), _) => (path, def.local),
            (None, NONE) => {
                let WorldPose { position, rotation } = self.colliders.poses[collider as usize];
                let pose = BodyPose { center: position, rotation, ..BodyPose::default() };
                (Path::still(pose, Vector::ZERO), crate::math::Pose::IDENTITY)
            }
            (None, body) => {
                (Path::still(self.bodies.poses[body as usize], self.bodies[body].local_center), def.local)
            }
        };
        Side { collider, shape: &def.shape, local, path, arm: self.colliders.reaches[collider as usize].arm }
    }

    /// The fraction of the step after which a collider meets another, 1 if it does not.
    fn impact(
        &self,
        collider: u32,
        path: &Path,
        other: Side,
        buffers: &mut CastBuffers<S::Workspace>,
    ) -> f32 {
        let moving = self.side(collider, Some(*path));
        let (center, core) = moving.shape.core();
        let reaches = [collider, other.collider].map(|id| self.colliders.reaches[id as usize]);
        let size = if core > 0.0 { min(core, self.tolerance) } else { self.tolerance };
        let mut pair = Pair {
            source: self.source,
            moving,
            other,
            margin: reaches[0].margin + reaches[1].margin,
            target: MET * size,
            extent: reaches[0].extent,
        };
        if pair.depth_at_end(buffers) > CORE_SHARE * core {
            // What touches already, as a rod that falls over on its foot, goes on to the overlap at which it would be put
            // back: stopped where it touches, it would hang there for many steps and gain their speed.
            if pair.begins_within(self.tolerance, buffers) {
                pair.margin -= CORE_SHARE * core;
            }
            if let Cast::Hit(fraction) = pair.cast(Caster::Whole, buffers) {
                return fraction;
            }
        }
        // What touches may slide, roll, and run over the seams of a floor. It must not pass.
        pair.margin = 0.0;
        for share in BALLS {
            match pair.cast(Caster::Ball(center, share * core), buffers) {
                Cast::Touching => {}
                Cast::Miss => return 1.0,
                Cast::Hit(fraction) => return fraction,
            }
        }
        1.0
    }
}
