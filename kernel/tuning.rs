//! The tuning constants of the kernel: every length, speed, angle, share and count by which contacts,
//! manifolds, sweeps, rest and the solver decide, with its meaning and the effect of larger and smaller
//! values.
//!
//! Shares are relative to a length of the pair itself, mostly the smaller shape's extent. All other lengths
//! and speeds are in length units, so the scale of the world does not matter. Angles are in radians, or given
//! by their cosine or sine.
//!
//! Not included are settings of the user, laws of physics and geometry, limits of floats, and sizes of blocks
//! and buffers, which change only speed or memory.

/// Contact points of two shapes. Shares are of the smaller shape's extent, unless stated otherwise.
pub mod manifold {
    // The axis that separates two shapes.
    /// A cached result is kept if it is worse by less than this share: an axis that separates less than the
    /// best axis, or less than when it was found. The manifold of round bodies is kept while they move by
    /// less than this share of their radii. Larger keeps worse axes, and lets capsules rock in a pile;
    /// smaller searches more often.
    pub const KEPT: f32 = 0.005;

    /// The accuracy of points. Clipped points count as over a face up to this far beyond it, the nearest
    /// points of an exact axis are this accurate, and points of a patch that differ by less are equally deep.
    /// An edge axis must separate by twice this more than a face axis, and a face of B by a fifth of this
    /// more than a face of A. Angles below this sine move points by less: a normal that leans less over a
    /// border is the facet's own normal, and capsules with a smaller angle have no common normal across both.
    /// Larger creates points in the air, and chooses faces that are deeper than edges; smaller loses corners
    /// of equal boxes on each other by rounding, and lets resting contacts flip between axes.
    pub const MARGIN: f32 = 1.0e-3;

    /// The sine below which edges of polyhedra have no common normal, and the angle below which two normals
    /// prevent the same motion: 0.2°. Larger misses axes of nearly parallel edges, and merges slopes; smaller
    /// uses normals that are only rounding, and compares planes with themselves.
    pub const PARALLEL: f32 = 0.003_464_102;

    /// A vertex behind a facet that lies inside a side by this many depths proves that the face is a better
    /// axis than any axis of that side. Smaller is wrong for axes within 2 atan(1 / REACH) of the reversed
    /// normal; larger proves less and costs time.
    pub const REACH: f32 = 10.0;

    /// The least cosine between a direction and the normal of a face that faces in that direction. Larger
    /// ignores faces that bodies lie in; smaller takes sides for faces.
    pub const FACING: f32 = 0.5;

    /// The sine up to which a direction counts as along a plane or a line, and the slope up to which it
    /// counts as level. Larger takes leaning sides for level ones, and creates points in the air; smaller
    /// lets rounding decide, and gives lying cylinders a single point.
    pub const SIDEWAYS: f32 = 0.05;

    // The points that are kept.
    /// The first candidate with at least this share of the best score is chosen. Larger lets points change
    /// from step to step; smaller keeps worse points.
    pub const ABOUT_EQUAL: f32 = 0.952;

    /// If a manifold has several faces, a point higher than the deepest point by this share of the patch's
    /// size is in the air. Larger drops one end of an edge that a body leans on; smaller makes the choice
    /// flicker.
    pub const HIGH: f32 = 0.02;

    /// The share of its score that a point in the air keeps. Larger drops points that carry load; smaller
    /// drops points that the body falls on.
    pub const IN_THE_AIR: f32 = 0.5;

    /// Lengths below this share of the whole size, and squares and areas below this share of its square,
    /// count as 0, as do offsets along an edge below this share of both lengths. Smaller keeps points on a
    /// line; larger drops corners of slender patches.
    pub const FLAT: f64 = 1.0e-6;

    // Round shapes.
    /// Capsules with a larger sine between them touch in a point, however short they are. Larger creates
    /// lines of contact where capsules cross.
    pub const LINE_SINE: f32 = 0.2;

    /// A hundred times the rounding of floats. Points closer than this share of their largest coordinate have
    /// no direction, triangles with a corner of a smaller sine have no normal, and when overlapping curves
    /// are moved apart, a round that gains less separation is the last. Platforms that turn by less, in
    /// radians, do not turn their contacts. Larger uses fallback normals too early, and tilts bodies that
    /// slide on platforms; smaller uses normals that are only rounding, and more rounds.
    pub const ROUNDING: f32 = 2.0e-5;

    /// Frusta roll on their side or edge if the sine between axis and normal is larger, otherwise they stand.
    /// Larger brakes rolling on edges; smaller lets standing frusta roll.
    pub const ROLLING: f32 = 0.3;

    /// Circles with a larger sine between them touch at their lowest points only. Capsules touch along a line
    /// if the direction between their axes turns by less along it, in radians. Larger creates crossings far
    /// above the contact, and two points where capsules cross; smaller lets resting capsules rock.
    pub const CROSSED: f32 = 0.1;

    // Parts of composites.
    /// The cosine from which two normals count as equal, and their manifolds are merged: 2°. Smaller merges
    /// slopes; larger solves a plane several times.
    pub const SAME_NORMAL: f32 = 0.9994;

    /// Smaller differences between round shapes do not count: of normals and slopes in radians, of distances
    /// and of an ellipse's axes as a share. The four points of a standing disc are kept until the lowest
    /// point is below them by twice this share of the radius. Larger brakes bodies that roll over seams, and
    /// lets discs sink on one side; smaller moves points by rounding, and lets parallel capsules flip.
    pub const ALIKE: f32 = 1.0e-4;

    /// Differences below this share of a size do not count:
    /// - Points of a manifold, and radii of curved contacts, that differ by less are equal.
    /// - Lines that are side by side over less have one point.
    /// - A face is deeper than the contact that it replaces if the difference is above this share of the
    ///   prediction.
    /// - Depths of deep overlaps are computed to this accuracy, and deep overlap stays deep down to it.
    /// - A limit of a tree of joints acts if a step would pass it by this share of the tolerance; for angles
    ///   the tolerance is as many radians.
    ///
    /// Larger loses corners, pushes out along worse normals, and lets springs push out the rest of deep
    /// overlap, so rows of bodies fly apart; smaller solves points twice.
    pub const SAME: f32 = 0.01;

    /// Points up to this share of a facet's size inside its border count as on the border. Larger takes inner
    /// points for points of an edge; smaller misses edges.
    pub const ON_BORDER: f32 = 0.02;

    /// The cosine below which two normals differ: 8°. Larger doubts normals that differ by rounding; smaller
    /// misses edges that poke into walls.
    pub const TURNED: f32 = 0.99;

    /// The error by rounding and clipping in the depth of a corner that pokes into a seam, as a share of the
    /// prediction. Smaller drops the wall at the seam.
    pub const POKE: f32 = 0.25;
}

/// Contacts from step to step. Shares are of the smaller side's extent, unless stated otherwise.
pub mod contact {
    // Contacts that continue.
    /// The cosine from which two normals belong to the same face: 25°. Larger loses impulses of turning
    /// bodies, and creates contacts for sides far from the ground; smaller hands impulses to other faces, and
    /// lets bodies that tip over slap down.
    pub const SAME_FACE: f32 = 0.9;

    /// Bodies may move by this share while their manifold is kept. Larger makes contacts of small bodies lag;
    /// smaller recomputes them more often.
    pub const RECYCLE_SHARE: f32 = 0.25;

    /// The least cosine of a body's rotation for which its manifold is kept: 10°. With smaller cosines the
    /// small-angle bounds fail.
    pub const RECYCLE_COS: f32 = 0.985;

    /// The share of the allowed displacement up to which a contact is not updated. Larger lets separations
    /// drift: with this value, by a tenth of a millimetre.
    pub const CALM_SHARE: f32 = 0.5;

    // Deep overlap.
    /// Bodies placed into each other by more are pushed out gently. Facets overlapped by more always have a
    /// contact, over the facet or beside it. Ellipses that overlap by more are tested with other corners.
    /// Overlapping curves are moved this far apart to find closest points. Smaller lets heaps sink into
    /// themselves, pushes beside edges, and uses normals that are only rounding; larger lets placed bodies
    /// jump, and deep bodies fall through.
    pub const DEEP: f32 = 0.1;

    // Round bodies that rock.
    /// Bodies that turn by less in a step, in radians, keep the inertia of its start. Bodies that turn by
    /// less relative to each other keep the contact of its start. Larger leaves rocking undamped, and lets
    /// bodies gain spin in contacts; smaller computes more contacts, and slows down piles that creep.
    pub const STILL: f32 = 2.0e-3;

    /// Bodies that move by more than this share of their size in a step do not rock. The lowest point of a
    /// rim that runs farther in half a step is not predicted, since the disc tips over. Larger moves contacts
    /// of bodies that have yet to hit, and leaves no points under discs.
    pub const MOST_WAY: f32 = 0.5;

    // Inner edges of the ground. Lengths are in length units, speeds in length units per second.
    /// The height above a plane up to which a point is on the plane. Larger hides kerbs; smaller is below the
    /// rounding of positions some kilometres from the origin.
    pub const FLUSH: f32 = 2.5e-4;

    /// Walls are searched at this multiple of the height up to which a point is on a plane. Larger misses low
    /// walls; smaller takes edges of flush tiles for walls.
    pub const RISES: f32 = 4.0;

    /// Bodies slower than this do not slide over ground. Larger creates ghost collisions at low speed;
    /// smaller compares the manifolds of resting bodies.
    pub const MOVING: f32 = 0.02;

    /// Dynamic bodies slower than this are ground for others.
    pub const RESTING: f32 = 0.05;

    /// Dynamic bodies are ground only for bodies that move faster than this against them. Smaller takes
    /// contacts from bodies in heaps.
    pub const SLIDING: f32 = 0.25;
}

/// Conservative advancement of contacts within the step, of parts of composites, and of fast bodies after the
/// solver.
pub mod sweeps {
    /// Maximum number of rounds in which two shapes are advanced to their time of impact within the step.
    /// Shapes that need more rounds meet where they are after the last. Fewer stop bodies that pass by; more
    /// cost time.
    pub const MEETING_ROUNDS: usize = 24;

    /// The same for a part of a composite and for a fast body after the solver. Also the maximum number of
    /// rounds that move overlapping curves apart, and of halvings of an angle between an ellipse's normals.
    /// Deep overlaps take more rounds than shallow ones.
    pub const ROUNDS: usize = 40;

    /// Shapes that move past each other have met at this share of the distance that counts as touching.
    /// Larger stops bodies that pass by; smaller takes more rounds.
    pub const MET: f32 = 0.1;

    /// The allowed error of a turning body's contact, as a share of the body's size. Turning shapes have met
    /// at this share of the smaller shape's extent, at most at the touching distance. The lowest point of a
    /// rim may lag by this share of the radius before its contact is recomputed, and a contact point this
    /// close to it counts as the lowest point. Larger stops bodies that pass by, predicts other points, and
    /// lets coins rock for ever; smaller takes more rounds, and recomputes more contacts.
    pub const LAG: f32 = 0.02;

    /// Bodies that turn by more in a step, in radians, are predicted as if they turned by this much, and
    /// bodies that turn by more in a substep precess as if they turned by this much. Bodies that turn by more
    /// than half of it in a step are not swept past nearby shapes: a push at their predicted pose would add
    /// energy. Larger finds pairs that never touch, and makes Newton steps that do not converge; smaller
    /// misses hits of spinning rods.
    pub const MOST_TURN: f32 = 1.5;

    /// Number of chords of a slab's width that are evaluated for one advance. More advance farther, fewer
    /// cost less.
    pub const CHORDS: usize = 3;

    /// Points that close within this many steps are expected to push, and are watched for blows. The solver
    /// lets points close only as far as they may by the end of the first substep after the step. So a smaller
    /// value misses points, and a larger value stops bodies that pass by.
    pub const AHEAD: f32 = 2.0;

    /// Bodies that move by less than this share of the ball within them pass through nothing. Bodies that
    /// overlap by less at the end of the step are not put back, unless they turn and touch no other moving
    /// body: the solver pushes them out. A body deeper in a closed surface than this share of its half size
    /// is inside, and a shape that reaches to the other side of a face by less than this share of its extent
    /// is on one side. Larger lets bodies through thin walls, and lets bodies that sank in stay inside;
    /// smaller takes time from bodies, and pulls cones into faces.
    pub const CORE_SHARE: f32 = 0.5;

    /// Shapes with foreign parts are searched up to this many extents of the moving shape at once. Larger
    /// computes parts that are not met; smaller takes more rounds.
    pub const VIEW: f32 = 4.0;
}

/// Boxes around moving bodies, and the conditions for sleep.
pub mod rest {
    use crate::math::DIM;

    /// The time over which velocities are averaged, in seconds. Larger lets bodies sleep that have only begun
    /// to roll: at 0.1 s, below 0.4 m/s² with the usual rest speed and time; smaller keeps shaking bodies
    /// awake.
    pub const MEAN_TIME: f32 = 0.1;

    /// The growth of a fat box as a share of the extent, in addition to the displacement by rotation. Larger
    /// finds pairs that never touch: twice as much costs a pile of boxes in 3D a quarter; smaller enlarges
    /// boxes more often.
    pub const FAT_SHARE: f32 = 0.5 / (1 << DIM) as f32;
}

/// Rows, passes and free spin.
pub mod solver {
    // Free spin. Angles are in radians.
    /// Rotations up to this are small. Precession within a substep then uses one Newton step, which leaves an
    /// energy error below 1e-8; at 0.75 the error would be 1e-5. Trees of joints correct no larger angle in a
    /// substep, or bodies gain energy. Bodies that turn farther in a step do not rock. Smaller costs time.
    pub const SMALL_TURN: f32 = 0.25;

    /// The least rotation in a substep for which the spin axis moves. Larger stops slow precession; smaller
    /// costs time in bodies at rest.
    pub const MIN_TURN: f32 = 1.0e-5;

    /// A body turns far if the product of its ratio of moments and its squared rotation in a substep is above
    /// this: a box from about 6 rad/s on at 60 Hz. Larger lets such bodies gain energy in contacts; smaller
    /// slows down piles that tumble.
    pub const FAR_TURN: f32 = 0.005;

    // Friction and resistance.
    /// The lever of rolling resistance as a share of the smaller radius: at friction 0.6 a ball rolls as if
    /// up a slope of 0.6 %. For corners and edges the lever is a fifth of this share of the distance to the
    /// nearer centre of mass of a body that can turn. Larger holds round bodies on steeper slopes; smaller
    /// keeps them rocking in a pile.
    pub const ROLL_LEVER: f32 = 0.01;

    /// The maximum friction coefficient that rolling resistance uses. Larger holds balls on slopes whose
    /// friction is set high against sliding.
    pub const ROLL_FRICTION: f32 = 1.0;

    /// The weight by which spin weakens sliding friction, as a fourth power: 1.26⁴. A disc under even
    /// pressure has 1.5⁴; with that value a disc on several pieces slides too far.
    pub const SPUN: f32 = 2.5;

    // Overlap.
    /// A body with up to this number of deep contacts starts from all its impulses: about as many touch it in
    /// a full container. Larger lets crowds explode; smaller lets stacks sink.
    pub const WARM_CONTACTS: f32 = 8.0;

    // Masses.
    /// The share of an inverse mass below which the remainder is rounding: at a point of a body with locked
    /// axes, and in a row whose motion other rows already prevent. It is also the softness of rigid rows.
    /// Larger gives up motions that could be prevented.
    pub const NO_MASS: f32 = 1.0e-6;

    /// The least share of the inverse mass that is used if locked axes leave less. Smaller pushes bodies out
    /// sideways along normals that are almost along a locked axis.
    pub const MIN_USED_SHARE: f32 = 0.1;

    // Light bodies below heavy ones.
    /// The mass ratio from which the lighter of two bodies gets more mass, if it is loaded. An impulse of the
    /// heavy body above this many of its weights is a blow, not a load. Contacts of bodies with added mass
    /// push out at half the inverse of this ratio of the speed, or they would throw the heavy body up.
    /// Smaller changes ordinary stacks; larger leaves towers soft that could be stiff, and adds mass to
    /// bodies that are struck.
    pub const HEAVY: f32 = 8.0;

    /// The sag of a contact, as a share of the maximum, from which it presses its bodies. Contacts with less
    /// sag do not pass on the presence of a heavy body.
    pub const PRESSED: f32 = 0.1;

    /// The sag, as a share of the maximum, that remains for a body with added mass, to within a factor of
    /// two. Smaller adds more mass; larger lets towers sink deeper.
    pub const FULL_SAG: f32 = 0.6;

    /// Maximum number of doublings of a mass.
    pub const MAX_DOUBLINGS: u8 = 8;

    /// The number of steps with little load after which a mass is halved. Fewer shake a tower that rebounds;
    /// more leave added mass to unloaded bodies.
    pub const STEPS_TO_HALVE: u8 = 8;

    // Blows.
    /// The share of the blow speed from which a point is watched at the start of the step, since it gains
    /// speed within the step. Larger misses blows; smaller costs time.
    pub const WATCHED_SPEED: f32 = 0.5;

    /// Maximum number of rounds of blows in a substep, and of sweeps over a group of manifolds in a round.
    /// Fewer stop a chain of impacts sooner, as each round reaches one body further, and tilt bodies that
    /// land on many pieces.
    pub const BLOW_SWEEPS: usize = 96;

    /// Maximum number of manifold solutions in the blows of a substep, apart from a round of sweeps: 150
    /// manifolds may take all sweeps. Fewer leave more of a pile's landing to contacts; more take longer than
    /// the whole rest of a step.
    pub const BLOW_WORK: usize = 150 * BLOW_SWEEPS;

    /// In groups that bounce, sweeps end when they change velocities by less than this share of the fastest
    /// approach. Larger lets bodies bounce to other heights.
    pub const BOUNCE_TOLERANCE: f32 = 2.0e-6;

    /// The same for groups that do not bounce. Also, free spin whose energy changes by a greater share in a
    /// substep has not converged, and is left unchanged. Larger tilts bodies that fall flat, and accepts
    /// wrong spins.
    pub const CONVERGED: f32 = 1.0e-4;

    /// Number of sweeps in a round. In groups that bounce, the impulses of several manifolds with friction
    /// rise over the first round until they stop the approach. A round that reduces the least change by less
    /// than a hundredth is the last: a body is jammed between others that do not yield. Fewer favour the
    /// first manifold, and end sweeps that would still converge.
    pub const ROUND_OF_SWEEPS: usize = 8;

    /// Points that would touch within this many substeps are struck together with points that are due: if a
    /// body lands flat, rounding decides which points are due. A point is due if it would touch at most half
    /// as far beyond the substep, so a point that touches at the end of the substep is struck before the
    /// solve pass may stop it.
    pub const NEARLY: f32 = 1.01;

    /// Points that are apart by less than this share of the fade distance of friction touch, and take part in
    /// an impact.
    pub const TOUCHING: f32 = 0.05;

    // Joints.
    /// Damping ratio of rigid constraints.
    pub const RIGID_DAMPING: f32 = 2.0;

    /// The frequency of rigid constraints as a share of the substep rate, the highest that substeps resolve.
    /// Also the share of an error that a substep corrects if no constraint is soft.
    pub const RIGID_FREQUENCY: f32 = 0.25;

    /// The same for constraints that are solved directly.
    pub const DIRECT_FREQUENCY: f32 = 2.0;

    /// Maximum number of rounds in which limits of a tree act in a pass, and of alternations between trees of
    /// joints and contacts in a blow. Fewer let limits that are struck at once be passed, and leave joints
    /// that open at the blow.
    pub const JOINT_ROUNDS: usize = 8;

    /// The least number of joints of a tree. Fewer joints are solved as well one by one.
    pub const FEWEST: usize = 3;
}
