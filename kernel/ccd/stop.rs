//! The fraction of the step at which one body stops.

use super::cast::{Cast, CastBuffers, Caster, Pair, Side};
use super::path::Path;
use crate::bvh::{TreeKind, Trees};
use crate::contact::{Contact, ContactFlags, ContactTable, ManifoldSource};
use crate::graph::ConstraintKind;
use crate::math::{Vector, WorldPose, max, min};
use crate::shape::Aabb;
use crate::table::{BodyKind, BodyPose, BodyTable, ColliderTable, NONE, Reach};
use crate::tuning::sweeps::{CORE_SHARE, MET};

/// The trees of the colliders that do not move.
const FIXED: [TreeKind; 2] = [TreeKind::Static, TreeKind::Standalone];

/// The input of sweeps, constant while they run.
pub struct SweepInput<'a> {
    /// The bodies at the start of the step.
    pub bodies: &'a BodyTable,
    /// The colliders at the start of the step.
    pub colliders: &'a ColliderTable,
    /// The trees of the colliders.
    pub trees: &'a Trees,
    /// The contacts of all pairs with overlapping fat boxes. A pair with overlapping fat boxes but no contact
    /// was refused, and is not swept.
    pub contacts: &'a ContactTable,
    /// The source of manifolds for pairs with a foreign shape.
    pub source: &'a dyn ManifoldSource,
    /// Shapes this far apart count as touching, in metres.
    pub tolerance: f32,
    /// The step's length, in seconds.
    pub dt: f32,
}

/// How a body is swept against moving bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swept {
    /// Whether rotation counts. If not, both bodies keep their rotation of the start of the step.
    pub turns: bool,
    /// Whether the body is swept against dynamic bodies as well, not only against kinematic bodies.
    pub include_dynamic: bool,
    /// Two bodies are not swept against each other if their relative speed is below this, in m/s, and their
    /// relative angular speed is below `angular_threshold`.
    pub linear_threshold: f32,
    /// Threshold of the relative angular speed, in rad/s.
    pub angular_threshold: f32,
}

/// A body that is swept.
struct Sweep<'a> {
    path: &'a Path,
    /// Whether its surface moves far enough to pass through something.
    is_fast: bool,
    /// Whether it is put back from any overlap above the tolerance. If not, only from overlaps above
    /// [`CORE_SHARE`] of the ball within it.
    is_strict: bool,
}

/// A collider at the end of the step.
struct End {
    pose: WorldPose,
    aabb: Aabb,
    /// The box around all poses of the collider on its path.
    swept: Aabb,
}

/// Buffers of one worker, kept for their memory.
#[derive(Clone, Debug, Default)]
pub struct SweepBuffers {
    cast: CastBuffers,
    candidates: Vec<u32>,
    /// The bodies that stop, each with its fraction of the step.
    pub(crate) stops: Vec<(u32, f32)>,
}

impl SweepInput<'_> {
    /// Whether a body that moves by `way` metres and turns by `angle` radians may pass through something, or
    /// press a corner into something where the contacts of the start of the step have no point.
    #[inline(always)]
    pub fn is_far(&self, body: u32, way: f32, angle: f32) -> bool {
        let turning = self.colliders.size_of(body).arm * angle;
        turning > self.tolerance || self.is_fast(body, way + turning)
    }

    /// Whether a body whose surface moves by `way` metres may pass through something.
    #[inline(always)]
    fn is_fast(&self, body: u32, way: f32) -> bool {
        way > max(CORE_SHARE * self.colliders.size_of(body).core, MET * self.tolerance)
    }

    /// The sweep of a body along a path against colliders that do not move.
    fn sweep<'a>(&self, body: u32, path: &'a Path) -> Sweep<'a> {
        let turning = self.colliders.size_of(body).arm * path.spin.length();
        Sweep {
            path,
            is_fast: self.is_fast(body, path.way.length() + turning),
            is_strict: turning > self.tolerance && self.is_alone(body),
        }
    }

    /// Whether a body has no joints and touches only colliders that do not move. A body that moves with
    /// others is not put back for a corner, since all bodies connected to it would be put back as well.
    fn is_alone(&self, body: u32) -> bool {
        let is_free = |kind| self.bodies.constraints(kind).of_body(body).next().is_none();
        is_free(ConstraintKind::Joint)
            && is_free(ConstraintKind::Custom)
            && self.contacts_of(body).all(|(contact, moving)| {
                let pushes = contact.flags.has(ContactFlags::TOUCHING) && !contact.is_inert();
                !pushes || self.is_fixed(contact.bodies[1 - moving])
            })
    }

    /// The contacts of a body, each with the side that the body is on.
    fn contacts_of(&self, body: u32) -> impl Iterator<Item = (&Contact, usize)> {
        self.colliders.of_body(body, self.bodies).flat_map(|collider| self.contacts_of_collider(collider))
    }

    /// The contacts of a collider, each with the side that the collider is on.
    fn contacts_of_collider(&self, collider: u32) -> impl Iterator<Item = (&Contact, usize)> {
        self.contacts.of_collider(collider, self.colliders).map(move |id| {
            let contact = self.contacts.get(id);
            (contact, usize::from(contact.colliders[1] == collider))
        })
    }

    /// Whether a collider that does not move lies within reach of a body that moves by `way`, however the
    /// body turns. Most fast bodies are far from such colliders, so the few boxes of the trees are tested
    /// before the many contacts of a heap.
    pub fn may_meet(&self, body: u32, way: Vector) -> bool {
        let (mut reach, mut is_known) = (0.0, true);
        for id in self.colliders.of_body(body, self.bodies) {
            let Reach { extent, margin, .. } = self.colliders.reaches[id as usize];
            reach = max(reach, extent + margin);
            // Casts stop at this distance before the shapes touch.
            let around = self.ball(body, extent + margin).swept(way).grown(MET * self.tolerance);
            is_known &= self.colliders.fat[id as usize].contains(&around);
        }
        let around = self.ball(body, reach).swept(way).grown(self.tolerance);
        let is_near = FIXED.iter().any(|kind| !self.trees[*kind].query(&around, |_| false));
        // Within its fat boxes a body can only meet colliders that it has contacts with.
        is_near
            && (!is_known
                || self.contacts_of(body).any(|(contact, side)| self.is_fixed(contact.bodies[1 - side])))
    }

    /// The tree that contains the colliders of a body.
    fn kind_of(&self, body: u32) -> TreeKind {
        if body == NONE {
            return TreeKind::Standalone;
        }
        match self.bodies[body].kind {
            BodyKind::Static => TreeKind::Static,
            BodyKind::Kinematic => TreeKind::Kinematic,
            BodyKind::Dynamic => TreeKind::Dynamic,
        }
    }

    fn is_fixed(&self, body: u32) -> bool {
        FIXED.contains(&self.kind_of(body))
    }

    /// The box of a ball about the centre of mass of a body at the start of the step.
    fn ball(&self, body: u32, radius: f32) -> Aabb {
        Aabb::new(Vector::ZERO, Vector::ZERO).at(self.bodies.poses[body as usize].center).grown(radius)
    }

    /// The fraction of the step at which a body stops at a collider that does not move; 1 if it does not
    /// stop.
    pub fn stop(&self, body: u32, path: &Path, buffers: &mut SweepBuffers) -> f32 {
        let sweep = self.sweep(body, path);
        let mut first = 1.0;
        if sweep.is_fast || sweep.is_strict {
            // Colliders without a body stop only bodies that would pass through them.
            let kinds = if sweep.is_fast { &FIXED[..] } else { &[TreeKind::Static] };
            self.each_candidate(body, &sweep, kinds, buffers, |[collider, other], buffers| {
                let impact = self.impact(collider, &sweep, self.side(other, None), &mut buffers.cast);
                first = min(first, impact);
            });
        }
        first
    }

    /// Stores the fractions of the step at which a body, and the moving bodies that it meets, stop. `path_of`
    /// gives the path of a body that may move; `None` if it has no path in this step.
    pub(crate) fn stop_swept(
        &self,
        body: u32,
        swept: &Swept,
        path_of: &impl Fn(u32) -> Option<Path>,
        buffers: &mut SweepBuffers,
    ) {
        let Some(path) = path_of(body).map(|path| path.turning_if(swept.turns)) else { return };
        let kinds = [TreeKind::Kinematic, TreeKind::Dynamic];
        let kinds = if swept.include_dynamic { &kinds[..] } else { &kinds[..1] };
        let sweep = Sweep { path: &path, is_fast: true, is_strict: false };
        self.each_candidate(body, &sweep, kinds, buffers, |[collider, other], buffers| {
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
            let fraction = self.impact(collider, &sweep, self.side(other, other_path), &mut buffers.cast);
            if fraction < 1.0 {
                buffers.stops.extend([(body, fraction), (other_body, fraction)]);
            }
        });
    }

    /// Calls `met` with each collider of a body and each collider of the given kinds that it may meet on its
    /// path.
    fn each_candidate(
        &self,
        body: u32,
        sweep: &Sweep,
        kinds: &[TreeKind],
        buffers: &mut SweepBuffers,
        mut met: impl FnMut([u32; 2], &mut SweepBuffers),
    ) {
        let mut candidates = core::mem::take(&mut buffers.candidates);
        for collider in self.colliders.of_body(body, self.bodies) {
            let def = &self.colliders[collider].def;
            if def.flags.sensor {
                continue;
            }
            candidates.clear();
            let end = self.end(collider, sweep.path);
            if self.colliders.fat[collider as usize].contains(&end.swept) {
                // The collider can only meet colliders that it has contacts with.
                self.find_in_contacts(collider, sweep, kinds, &end, &mut candidates);
            } else {
                self.find_in_trees(collider, kinds, &end.swept, &mut candidates);
            }
            candidates.iter().for_each(|other| met([collider, *other], buffers));
        }
        buffers.candidates = candidates;
    }

    /// Adds the colliders of the given kinds that a collider has contacts with, and may meet on its path to
    /// `end`.
    fn find_in_contacts(
        &self,
        collider: u32,
        sweep: &Sweep,
        kinds: &[TreeKind],
        end: &End,
        found: &mut Vec<u32>,
    ) {
        let allowed = self.allowed_overlap(collider, sweep);
        for (contact, moving) in self.contacts_of_collider(collider) {
            let (other, body) = (contact.colliders[1 - moving], contact.bodies[1 - moving]);
            let is_near = end.swept.overlaps(&self.colliders.fat[other as usize]);
            if !is_near || !kinds.contains(&self.kind_of(body)) || contact.is_let_through() {
                continue;
            }
            // The poses at the end decide only if the other side does not move.
            if self.is_fixed(body) && self.ends_apart(contact, moving, sweep, end, allowed) {
                continue;
            }
            found.push(other);
        }
    }

    /// Adds the colliders of the given kinds in a box that a collider may meet.
    fn find_in_trees(&self, collider: u32, kinds: &[TreeKind], around: &Aabb, found: &mut Vec<u32>) {
        let layers = self.colliders[collider].def.layers;
        for &kind in kinds {
            self.trees[kind].query(around, |other| {
                let def = &self.colliders[other].def;
                let interacts = !def.flags.sensor && layers.interacts_with(def.layers);
                if interacts && !self.is_refused(collider, other) {
                    found.push(other);
                }
                true
            });
        }
    }

    /// Whether the embedder lets two colliders pass through each other. A pair whose fat boxes did not
    /// overlap at the start of the step was not offered to the embedder, and counts as not refused. A pair
    /// that waits in a crowd counts as refused.
    fn is_refused(&self, a: u32, b: u32) -> bool {
        match self.contacts.find(a, b) {
            Some(id) => self.contacts.get(id).is_let_through(),
            None => self.colliders.fat[a as usize].overlaps(&self.colliders.fat[b as usize]),
        }
    }

    /// A collider at the end of its body's path.
    fn end(&self, collider: u32, path: &Path) -> End {
        let (def, extent) = (&self.colliders[collider].def, self.colliders.reaches[collider as usize].extent);
        let pose = path.frame(1.0).then(&def.local);
        let aabb = def.shape.aabb(&pose);
        let round = Aabb::new(Vector::ZERO, Vector::ZERO).at(path.start.center).grown(extent);
        // A point moves along an arc, which deviates from its chord by at most r (1 - cos φ/2) < r φ²/8.
        let spin = path.spin.length_squared();
        let ends = self.colliders.tight[collider as usize].union(&aabb);
        let arcs = ends.grown(min(0.125 * extent * spin, 2.0 * extent));
        let swept = arcs.intersection(&round.swept(path.way)).grown(def.margin + self.tolerance);
        End { pose, aabb, swept }
    }

    /// A collider on the path of its body. Without a path it stays at its pose.
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

    /// Whether a plane proves that the sides of a contact overlap by less than `allowed` at the end of the
    /// step, and that neither passed the other. The plane is the contact's or a side of their boxes. Most
    /// turning bodies slide, roll or land on such a plane.
    fn ends_apart(&self, contact: &Contact, moving: usize, sweep: &Sweep, end: &End, allowed: f32) -> bool {
        let sides = [contact.colliders[moving], contact.colliders[1 - moving]];
        let margins = sides.map(|id| self.colliders.reaches[id as usize].margin);
        let least = margins[0] + margins[1] - allowed;
        // A fast body may have passed to another side of the box.
        if !sweep.is_fast && end.aabb.gap(&self.colliders.tight[sides[1] as usize]) > least {
            return true;
        }
        if contact.manifold.count == 0 {
            return false;
        }
        let toward = if moving == 0 { contact.manifold.normal } else { -contact.manifold.normal };
        let farthest = |side: usize, pose: &WorldPose, direction: Vector| {
            let shape = &self.colliders[sides[side]].def.shape;
            Some(pose.rotation.rotate(shape.support(pose.rotation.inverse_rotate(direction))?).dot(direction))
        };
        let place = &self.colliders.poses[sides[1] as usize];
        let reaches = farthest(0, &end.pose, toward).zip(farthest(1, place, -toward));
        reaches
            .is_some_and(|(a, b)| (place.position - end.pose.position).to_local().dot(toward) - a - b > least)
    }

    /// The overlap at the end of the step that is left to the solver.
    fn allowed_overlap(&self, collider: u32, sweep: &Sweep) -> f32 {
        let allowed = CORE_SHARE * self.colliders[collider].def.shape.core().1;
        if sweep.is_strict { min(allowed, self.tolerance) } else { allowed }
    }

    /// The fraction of the step at which a collider meets another; 1 if they do not meet.
    fn impact(&self, collider: u32, sweep: &Sweep, other: Side, buffers: &mut CastBuffers) -> f32 {
        let moving = self.side(collider, Some(*sweep.path));
        let (center, core) = moving.shape.core();
        let reaches = [collider, other.collider].map(|id| self.colliders.reaches[id as usize]);
        let size = if core > 0.0 { min(core, self.tolerance) } else { self.tolerance };
        let pair = Pair {
            source: self.source,
            moving,
            other,
            margin: reaches[0].margin + reaches[1].margin,
            target: MET * size,
            extent: reaches[0].extent,
        };
        let allowed = self.allowed_overlap(collider, sweep);
        let is_deep = pair.depth_at_end(buffers) > allowed;
        if is_deep && let Some(fraction) = self.overlap(&pair, allowed, core, buffers) {
            return fraction;
        }
        // A touching shape may slide, roll, and run over the seams of a floor, but it must not pass through.
        if !sweep.is_fast {
            return 1.0;
        }
        let passed = pair.pass(center, core, buffers);
        // The end of a long shape may be far inside when the ball within it arrives.
        let first = (passed < 1.0 && !is_deep).then(|| self.overlap(&pair, allowed, core, buffers)).flatten();
        min(first.unwrap_or(1.0), passed)
    }

    /// The fraction of the step at which the shapes of a pair overlap by `allowed`, or touch if they were
    /// apart; `None` if they overlap more from the start.
    fn overlap(&self, pair: &Pair, allowed: f32, core: f32, buffers: &mut CastBuffers) -> Option<f32> {
        let mut pair = *pair;
        // A shape that touches already, such as a rod that falls over on its foot, moves on to the
        // allowed overlap. If it stopped at the first touch, it would hang there for many steps and gain
        // the speed of all of them. A shape that overlaps more moves on slowly.
        let gap = pair.gap_at_start(self.tolerance, buffers);
        if gap < self.tolerance {
            let deeper = 0.5 * allowed - gap;
            pair.margin -= min(max(allowed, deeper), CORE_SHARE * core);
        }
        match pair.cast(Caster::Whole, buffers) {
            Cast::Hit(fraction) => Some(fraction),
            Cast::Miss | Cast::Touching => None,
        }
    }
}
