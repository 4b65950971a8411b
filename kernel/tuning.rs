//! What tunes the kernel: every length, speed, angle, share and count by which contacts, manifolds, sweeps, rest and the solver
//! decide, with its meaning and what breaks when it is larger or smaller.
//!
//! Shares are of a length of the pair itself, mostly the smaller shape's extent. Lengths and speeds that are not are in length
//! units, so that the scale of the world does not matter. Angles are in radians, or given by their cosine or sine.
//!
//! Not here: numbers of the user, laws of physics and geometry, limits of floats, and sizes of blocks and buffers, which change
//! speed or memory only.

/// Contact points of two shapes. Shares are of the smaller shape's extent, if nothing else is said.
pub mod manifold {
    // Which axis separates two shapes.
    /// By how much what was found may be worse, and is kept: an axis that separates less than the best one, or than when it
    /// was found; and manifolds of round bodies that move by this share of both radii. Larger keeps worse axes, and capsules
    /// rocking in a pile; smaller searches more often.
    pub const KEPT: f32 = 0.005;

    /// The accuracy of points. Clipped points count as over a face up to this far beyond it; the nearest point of an exact axis
    /// is this near to it; points of a patch are equally deep within it. Edges must separate by twice as much more than faces
    /// to be the axis, and faces of B by a fifth more than faces of A. Leans below this sine move points by less: such normals
    /// at a border are the facet's own, and such capsules have no common normal across both. Larger has points in the air, and
    /// takes faces that are deeper than edges; smaller drops the corners of equal boxes on each other by rounding, and lets
    /// resting contacts flip between axes.
    pub const MARGIN: f32 = 1.0e-3;

    /// The sine below which edges of polyhedra have no common normal, and the angle below which normals hold the same: 0.2°.
    /// Larger misses axes of nearly parallel edges, and merges slopes; smaller has normals of rounding, and compares planes with
    /// themselves.
    pub const PARALLEL: f32 = 0.003_464_102;

    /// A vertex behind a facet, inside of a side by this many depths, proves the face to be the best axis. Smaller is
    /// wrong for axes 2 atan(1 / REACH) from the reverse of the normal; larger proves less and costs time.
    pub const REACH: f32 = 10.0;

    /// The least cosine to a normal of a face that faces that way. Larger leaves faces out that bodies lie in; smaller
    /// takes sides for faces.
    pub const FACING: f32 = 0.5;

    /// The sine up to which a direction is along a plane or a line, and the slope up to which it is level. Larger takes leaning
    /// sides for level ones, and has points in the air; smaller decides by rounding, and gives cylinders that lie a single point.
    pub const SIDEWAYS: f32 = 0.05;

    // Which points are kept.
    /// The share of the best score from which on the first candidate is taken. Larger lets points change from step to
    /// step; smaller keeps worse ones.
    pub const ABOUT_EQUAL: f32 = 0.952;

    /// Of several faces, a point this share of the patch's size above the deepest one is in the air. Larger drops one end
    /// of an edge that a body leans on; smaller makes the choice flicker.
    pub const HIGH: f32 = 0.02;

    /// The share of its worth that is left of a point in the air. Larger drops points that bear; smaller drops those that
    /// the body falls on.
    pub const IN_THE_AIR: f32 = 0.5;

    /// What adds less than this share of the whole size, or of its square, adds nothing, and offsets along an edge below this
    /// share of both lengths are 0. Smaller keeps points on a line; larger drops corners of slender patches.
    pub const FLAT: f64 = 1.0e-6;

    // Round shapes.
    /// Capsules with a larger sine between them touch in a point, however short they are. Larger has lines where they
    /// cross.
    pub const LINE_SINE: f32 = 0.2;

    /// A hundred times the rounding of numbers: nearer points, as a share of their largest number, have no direction, triangles
    /// with a corner of a smaller sine no normal, and rounds of moving apart that separate less are the last. Platforms that turn
    /// by less, in radians, do not turn their contacts. Larger takes fallback normals too early, and tilts what slides on
    /// platforms; smaller takes normals of rounding, and more rounds.
    pub const ROUNDING: f32 = 2.0e-5;

    /// Frusta roll on their side or edge if the sine between axis and normal is larger, else they stand. Larger brakes
    /// rolling on edges; smaller lets standing ones roll.
    pub const ROLLING: f32 = 0.3;

    /// Circles with a larger sine between them touch at their lowest points only, and capsules touch along a line while the
    /// direction between their axes turns by less along it, in radians. Larger has crossings far above the contact, and two
    /// points where capsules cross; smaller lets resting capsules rock.
    pub const CROSSED: f32 = 0.1;

    // Parts of composites.
    /// The cosine from which on normals are one, and their manifolds are merged: 2°. Smaller merges slopes; larger solves
    /// a plane several times.
    pub const SAME_NORMAL: f32 = 0.9994;

    /// Differences between round shapes that count as none: of normals and slopes in radians, of distances and of an ellipse's
    /// axes as a share. The four points of a standing disc are kept until the lowest point is twice this share of the radius
    /// below them. Larger brakes what rolls over seams, and lets discs sink on one side; smaller moves points by rounding, and
    /// lets parallel capsules flip.
    pub const ALIKE: f32 = 1.0e-4;

    /// The share of a size that makes no difference. Points of a manifold, and radii of curved contacts, that are closer are the
    /// same; lines that are side by side over less have one point; a face is deeper than what it replaces from this share of the
    /// prediction on; depths of deep overlaps are known to it; deep overlap stays deep down to it; a limit of a tree of joints
    /// acts if it would be passed by this share of the tolerance in a step, for angles of as many radians. Larger loses corners, pushes out along worse normals,
    /// and has springs push out the rest of deep overlap, so that rows of bodies fly apart; smaller solves points twice.
    pub const SAME: f32 = 0.01;

    /// Points up to this share of a facet's size inside of its border are on it. Larger takes inner points for those of an
    /// edge; smaller misses edges.
    pub const ON_BORDER: f32 = 0.02;

    /// The cosine below which normals differ: 8°. Larger doubts rounding; smaller misses edges that poke into walls.
    pub const TURNED: f32 = 0.99;

    /// Rounding and clipping of the depth of a corner that pokes into a seam, as a share of the prediction. Smaller drops
    /// the wall there.
    pub const POKE: f32 = 0.25;
}

/// Contacts from step to step. Shares are of the smaller side's reach, if nothing else is said.
pub mod contact {
    // What continues a contact.
    /// The cosine from which on a normal is that of the same face: 25°. Larger loses impulses of bodies that turn, and has
    /// contacts for sides far from the ground; smaller hands impulses to other faces, and lets bodies that tip over slap
    /// down.
    pub const SAME_FACE: f32 = 0.9;

    /// Bodies may move by this much while their manifold is kept. Larger makes contacts of small bodies lag; smaller
    /// recomputes them more often.
    pub const RECYCLE_SHARE: f32 = 0.25;

    /// The least cosine of a body's turn while its manifold is kept: 10°. With smaller ones the bounds of small angles
    /// fail.
    pub const RECYCLE_COS: f32 = 0.985;

    /// The share of that way up to which a contact is not looked at. Larger lets separations drift: with this, by a tenth
    /// of a millimetre.
    pub const CALM_SHARE: f32 = 0.5;

    // Deep overlap.
    /// Bodies that were placed into one another by more are pushed out gently. Facets overlapped by more have a contact in any
    /// case, over them or beside; ellipses have other corners tried; and overlapping curves are moved this far apart to find
    /// closest points. Smaller lets heaps sink into themselves, pushes beside edges, and has normals of rounding; larger lets
    /// placed bodies jump, and what is deep fall through.
    pub const DEEP: f32 = 0.1;

    // Round bodies that rock.
    /// Bodies that turn by less in a step, in radians, keep their inertia through it, and if they do so against each other
    /// the contact of its start. Larger leaves rocking without damping, and lets bodies gain spin in contacts; smaller
    /// computes more contacts, and slows down piles that creep.
    pub const STILL: f32 = 2.0e-3;

    /// Bodies that move by more than this share of their size in a step do not rock, and the lowest point of a rim that runs
    /// farther in half a step is not led, as the disc tips over. Larger moves contacts of what has yet to hit, and leaves
    /// nothing under discs.
    pub const MOST_WAY: f32 = 0.5;

    // Inner edges of the ground. Lengths are in length units, speeds in these per second.
    /// How far above a plane a point may be that is on it. Larger hides kerbs; smaller is below the rounding of positions
    /// some kilometres from the origin.
    pub const FLUSH: f32 = 2.5e-4;

    /// At how many times the height that counts as on a plane a wall is looked for. Larger misses low walls; smaller takes
    /// edges of flush tiles for walls.
    pub const RISES: f32 = 4.0;

    /// Bodies slower than this slide over nothing. Larger has ghosts at low speed; smaller compares what rests.
    pub const MOVING: f32 = 0.02;

    /// Dynamic bodies slower than this are ground.
    pub const RESTING: f32 = 0.05;

    /// And for those only that move faster than this against them. Smaller takes contacts from bodies in heaps.
    pub const SLIDING: f32 = 0.25;
}

/// Conservative advancement, of contacts within the step, of parts, and of fast bodies after the solver.
pub mod sweeps {
    /// Most steps in which two shapes are advanced to where they meet within the step. What takes more meets where it then is.
    /// Fewer stop bodies that pass by; more cost time.
    pub const MEETING_ROUNDS: usize = 24;

    /// The same for a part of a composite and for a fast body after the solver; and most moves apart of overlapping curves, and
    /// halvings of an angle between an ellipse's normals. Deep overlaps take more than shallow ones.
    pub const ROUNDS: usize = 40;

    /// Shapes that move past each other have met at this share of the distance that counts as touching. Larger stops
    /// bodies that pass by; smaller takes more rounds.
    pub const MET: f32 = 0.1;

    /// How far the contact of what turns may be off, as a share of its size: shapes that turn have met at this share of the
    /// smaller one's reach, and no farther than touching; the lowest place of a rim may lag by this share of the radius before
    /// its contact is computed anew, and a point as near to it is that place. Larger stops what passes by, leads other points,
    /// and lets coins rock for ever; smaller takes more rounds, and computes more.
    pub const LAG: f32 = 0.02;

    /// Bodies that turn by more in a step, in radians, are predicted as if they turned by this, and in a substep precess so.
    /// Those that turn by more than half of it in a step are not swept past what they are near to: that gives energy to what is
    /// pushed where it comes to. Larger finds pairs that never touch, and has Newton steps that do not converge; smaller misses
    /// what spinning rods hit.
    pub const MOST_TURN: f32 = 1.5;

    /// Chords of a slab's width that are drawn for one advance. More advance farther, fewer cost less.
    pub const CHORDS: usize = 3;

    /// Points push that close within this many steps, and are watched for blows. The solver lets points close no further than
    /// they may by the end of the first substep after the step, so that fewer miss points, and more stop bodies that pass by.
    pub const AHEAD: f32 = 2.0;

    /// Bodies that move by less than this share of the ball within them get past nothing, and those that overlap by less when
    /// the step ends are not put back, unless they turn alone: the solver pushes them out. What is deeper in a closed surface
    /// than this share of its half size is inside of it, and a shape that reaches to the other side of a face by less than this
    /// share of its extent is on one side.
    /// Larger lets bodies through thin walls, and what sank in stay inside; smaller takes time from bodies, and pulls cones into
    /// faces.
    pub const CORE_SHARE: f32 = 0.5;

    /// Shapes with foreign parts are looked at up to this many extents of the moving one at once. Larger computes parts
    /// that are not met; smaller takes more rounds.
    pub const VIEW: f32 = 4.0;
}

/// Boxes around moving bodies, and when they sleep.
pub mod rest {
    use crate::math::DIM;

    /// The time over which velocities are averaged, in seconds. Larger lets bodies sleep that have only begun to roll: at
    /// 0.1 s, below 0.4 m/s² with the usual rest speed and time; smaller keeps what shakes awake.
    pub const MEAN_TIME: f32 = 0.1;

    /// How much a fat box may grow, as a share of the extent and the displacement by turning. Larger finds pairs that
    /// never touch: twice as much costs a pile of boxes in 3D a quarter; smaller enlarges boxes more often.
    pub const FAT_SHARE: f32 = 0.5 / (1 << DIM) as f32;
}

/// Rows, passes and free spin.
pub mod solver {
    // Free spin. Angles are in radians.
    /// Turns up to this are small. Within a substep one Newton step is used for precession: it leaves an energy error below
    /// 1e-8; at 0.75 it would be 1e-5. Trees of joints take back no more in a substep, or bodies gain energy. Bodies that turn
    /// farther in a step do not rock. Smaller costs time.
    pub const SMALL_TURN: f32 = 0.25;

    /// The least turn within a substep for which the spin axis moves. Larger stops slow precession; smaller costs time in
    /// bodies at rest.
    pub const MIN_TURN: f32 = 1.0e-5;

    /// The least product of the ratio of moments and the squared turn of a substep for which a body turns far: a box from
    /// about 6 rad/s on at 60 Hz. Larger lets such bodies gain energy in contacts; smaller slows down piles that tumble.
    pub const FAR_TURN: f32 = 0.005;

    // Friction and resistance.
    /// The lever of rolling resistance as a share of the smaller radius: at friction 0.6 a ball rolls as if up a slope of
    /// 0.6 %. For corners and edges a fifth of it is a share of their distance from the nearer centre of mass of a body that
    /// can turn. Larger holds round bodies on steeper slopes; smaller keeps them rocking in a pile.
    pub const ROLL_LEVER: f32 = 0.01;

    /// Rolling resistance takes friction coefficients for at most this. Larger holds balls on slopes whose friction is set
    /// high against sliding.
    pub const ROLL_FRICTION: f32 = 1.0;

    /// By how much spin weakens sliding friction, as a fourth power: 1.26⁴. A disc under even pressure has 1.5⁴; with
    /// that, one on several pieces slides too far.
    pub const SPUN: f32 = 2.5;

    // Overlap.
    /// Up to this number of deep contacts a body starts from all its impulses: about as many touch it in a full container.
    /// Larger lets crowds explode; smaller lets stacks sink.
    pub const WARM_CONTACTS: f32 = 8.0;

    // Masses.
    /// The share of an inverse mass below which it is rounding: of a point that locked axes leave, of a row whose motion
    /// others hold already, and the softness of what is not soft. Larger lets what could be held go.
    pub const NO_MASS: f32 = 1.0e-6;

    /// The least share of the inverse mass that is used where locked axes leave less. Smaller pushes bodies out sideways
    /// along normals that are almost along a locked axis.
    pub const MIN_USED_SHARE: f32 = 0.1;

    // Light bodies below heavy ones.
    /// The ratio of masses from which the lighter of two bodies gets more mass, if it is loaded. An impulse of the heavy body of
    /// more than this many weights is a blow and no load; and contacts of bodies with more mass push out at half of the inverse
    /// share of the speed, or they throw the heavy one up. Smaller changes ordinary stacks; larger leaves towers soft that could
    /// be stiff, and gives mass to what is struck.
    pub const HEAVY: f32 = 8.0;

    /// The sag of a contact, as a share of the greatest, from which it presses its bodies. Contacts below it do not pass on
    /// that there is a heavy body.
    pub const PRESSED: f32 = 0.1;

    /// The sag, as a share of the greatest, that is left to a body with more mass, to within a factor of two. Smaller adds
    /// more mass; larger lets towers sink deeper.
    pub const FULL_SAG: f32 = 0.6;

    /// The most doublings of a mass.
    pub const MAX_DOUBLINGS: u8 = 8;

    /// The steps with little load after which a mass is halved. Fewer shake a tower that rebounds; more leave mass to what
    /// is unloaded.
    pub const STEPS_TO_HALVE: u8 = 8;

    // Blows.
    /// The share of the speed of a blow from which a point is watched at the start of the step: it gains speed within the
    /// step. Larger misses blows; smaller costs time.
    pub const WATCHED_SPEED: f32 = 0.5;

    /// Most rounds of blows in a substep, and most sweeps over a group of manifolds in a round. Fewer stop a chain of impacts
    /// sooner, as each round reaches one body further, and tilt what lands on many pieces.
    pub const BLOW_SWEEPS: usize = 96;

    /// Most solutions of manifolds in the blows of a substep, apart from a round of sweeps: 150 manifolds may take all sweeps.
    /// Fewer leave more of a pile's landing to contacts; more take longer than all the rest of a step.
    pub const BLOW_WORK: usize = 150 * BLOW_SWEEPS;

    /// Sweeps end when they change velocities by less than this share of the fastest approach, where something bounces.
    /// Larger lets bodies bounce to other heights.
    pub const BOUNCE_TOLERANCE: f32 = 2.0e-6;

    /// The same where nothing bounces; and free spin has not converged, and is left as it is, if its energy changes by a greater
    /// share in a substep. Larger tilts what falls flat, and takes wrong spins.
    pub const CONVERGED: f32 = 1.0e-4;

    /// Sweeps come in rounds of this many. Over the first, impulses of several manifolds with friction rise to what stops the
    /// approach, where they are returned. A round that makes the least change smaller by less than a hundredth is the last: a
    /// body is jammed between others that do not yield. Fewer favour the first manifold, and end sweeps that would still
    /// converge.
    pub const ROUND_OF_SWEEPS: usize = 8;

    /// Points that would touch within this many substeps are struck together with those that are due: of what lands flat,
    /// rounding decides which points are. Due is what would touch half as far beyond the substep: what touches at its end is
    /// struck before the solve pass may stop it.
    pub const NEARLY: f32 = 1.01;

    /// Points that are apart by less than this share of the fade of friction take part in an impact: they touch.
    pub const TOUCHING: f32 = 0.05;

    // Joints.
    /// Damping ratio of what is rigid.
    pub const RIGID_DAMPING: f32 = 2.0;

    /// The share of the rate of the substeps that is the frequency of what is rigid, the highest that they resolve; and the
    /// share of an error that is taken back in a substep where nothing is soft.
    pub const RIGID_FREQUENCY: f32 = 0.25;

    /// The same for what is solved directly.
    pub const DIRECT_FREQUENCY: f32 = 2.0;

    /// Most rounds over which limits of a tree act in a pass, and most turns between trees of joints and contacts in a
    /// blow. Fewer let limits that are struck at once be passed, and leave joints that open at the blow.
    pub const JOINT_ROUNDS: usize = 8;

    /// The fewest joints of a tree. Fewer are solved as well one by one.
    pub const FEWEST: usize = 3;
}
