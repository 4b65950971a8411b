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
    /// How much less an axis may separate than the best one, or than when it was found, and be kept. Larger keeps worse
    /// axes; smaller searches more often.
    pub const AXIS_SLACK: f32 = 0.005;

    /// By how much more edges must separate than faces to be the axis, and ten times what faces of B must beat faces of A
    /// by. Smaller lets resting contacts flip between axes; larger takes faces that are deeper than edges.
    pub const PREFER_FACES: f32 = 0.002;

    /// How far beyond a face, clipped points still count as over it, and how far the nearest point may be from an axis
    /// that counts as exact. Larger has points in the air; smaller drops the corners of equal boxes on each other by
    /// rounding.
    pub const MARGIN: f32 = 1.0e-3;

    /// The sine below which edges of polyhedra have no common normal. Larger misses axes of nearly parallel edges; smaller
    /// has normals of rounding.
    pub const PARALLEL: f32 = 0.005;

    /// A vertex behind a facet, inside of a side by this many depths, proves the face to be the best axis. Smaller is
    /// wrong for axes 2 atan(1 / REACH) from the reverse of the normal; larger proves less and costs time.
    pub const REACH: f32 = 10.0;

    /// The least cosine to a normal of a face that faces that way. Larger leaves faces out that bodies lie in; smaller
    /// takes sides for faces.
    pub const FACING: f32 = 0.5;

    /// The sine up to which a direction counts as along a plane, and the slope up to which it counts as level. Larger
    /// takes leaning sides for level ones; smaller decides by rounding.
    pub const SIDEWAYS: f32 = 0.05;

    // Which points are kept.
    /// The share of the best score from which on the first candidate is taken. Larger lets points change from step to
    /// step; smaller keeps worse ones.
    pub const ABOUT_EQUAL: f32 = 0.952;

    /// Points are equally deep within this share of the patch's size. Smaller makes the choice flicker; larger leaves the
    /// deepest point out.
    pub const DEEPER: f32 = 1.0e-3;

    /// Of several faces, a point this share of the patch's size above the deepest one is in the air. Larger drops one end
    /// of an edge that a body leans on; smaller makes the choice flicker.
    pub const HIGH: f32 = 0.02;

    /// The share of its worth that is left of a point in the air. Larger drops points that bear; smaller drops those that
    /// the body falls on.
    pub const IN_THE_AIR: f32 = 0.5;

    /// What adds less than this share of the whole size, or of its square, adds nothing. Smaller keeps points on a line;
    /// larger drops corners of slender patches.
    pub const FLAT: f64 = 1.0e-6;

    // Round shapes.
    /// The sine below which capsules have no common normal across both. Smaller has normals of rounding; larger misses
    /// crossing capsules.
    pub const PARALLEL_LINES: f32 = 1.0e-3;

    /// Capsules with a larger sine between them touch in a point, however short they are. Larger has lines where they
    /// cross.
    pub const LINE_SINE: f32 = 0.2;

    /// Capsules touch along a line while the direction between their axes turns by less along it, in radians. Smaller lets
    /// resting capsules rock; larger gives crossing ones two points.
    pub const LINE_TURN: f32 = 0.1;

    /// A hundred times the rounding of numbers: nearer points, as a share of their largest number, have no direction,
    /// triangles with a corner of a smaller sine no normal, and platforms that turn by less, in radians, do not turn their
    /// contacts. Larger takes fallback normals too early, and tilts what slides on platforms; smaller takes normals of
    /// rounding.
    pub const ROUNDING: f32 = 2.0e-5;

    /// Frusta roll on their side or edge if the sine between axis and normal is larger, else they stand. Larger brakes
    /// rolling on edges; smaller lets standing ones roll.
    pub const ROLLING: f32 = 0.3;

    /// Lines and circles with a smaller sine to a line or plane lie along it. Larger has points in the air; smaller gives
    /// cylinders that lie a single point.
    pub const LEVEL_SINE: f32 = 0.02;

    /// Circles with a larger sine between them touch at their lowest points only. Larger has crossings far above the
    /// contact.
    pub const CROSSED: f32 = 0.1;

    /// Points of a full circle stay where they are until the lowest one is this share of the radius below them. Larger
    /// lets discs sink on one side; smaller turns points with every rock.
    pub const LOWEST: f32 = 2.0e-4;

    /// Facets overlapped by more have a contact in any case, over them or beside. Larger lets what is deep fall through;
    /// smaller pushes beside edges.
    pub const DEEP: f32 = 0.05;

    /// Overlapping curves are moved this far apart to find closest points. Larger finds other features; smaller has
    /// normals of rounding.
    pub const APART: f32 = 0.03;

    /// Most rounds of that. Deep overlaps take more than shallow ones.
    pub const APART_ROUNDS: usize = 32;

    /// A round of moving apart that separates less is the last. Larger stops at worse axes; smaller takes more rounds.
    pub const GAIN: f32 = 1.0e-5;

    /// The share of the depth to which the least depth of deep overlaps is known. Larger pushes out along worse normals;
    /// smaller takes more corners.
    pub const DEPTH_ACCURACY: f64 = 0.01;

    /// A point within this share of the radius of a rim's lowest place is that place. Larger leads other points; smaller
    /// misses it.
    pub const AT_RIM: f32 = 0.05;

    /// The lowest point of a rim may lag by this share of the radius before its contact is computed anew. Larger lets
    /// coins rock for ever; smaller computes more.
    pub const RIM_LAG: f32 = 0.02;

    /// A disc that leans by a smaller sine has no lowest point. Smaller leads points by rounding.
    pub const RIM_LEVEL: f32 = 1.0e-4;

    /// A lowest point that runs farther in half a step, as a share of the radius, is not led: the disc tips over. Larger
    /// leaves nothing under it.
    pub const RIM_RUN: f32 = 0.5;

    /// How many directions of a turn are tried for two ellipses. Fewer miss the best one, more cost time.
    pub const DIRECTIONS: usize = 16;

    /// How often an angle between these is halved. Fewer leave the normal off by more than rounding.
    pub const HALVINGS: usize = 20;

    /// The ratio of half sizes of the flattest ellipse whose normals are tried. At 0 all would be across it.
    pub const FLATTEST: f32 = 1.0e-4;

    /// Ellipses that overlap by more than this share have other corners tried. Larger keeps worse normals; smaller costs
    /// time.
    pub const DEEP_ELLIPSE: f32 = 0.02;

    /// Features of two segments are equally near within this share; the first one wins. Smaller lets parallel capsules
    /// flip.
    pub const SAME_DISTANCE: f32 = 1.0e-4;

    /// Offsets along an edge below this share of both lengths are 0. Smaller decides by rounding.
    pub const ALIGNED: f32 = 1.0e-6;

    // Parts of composites.
    /// The cosine from which on normals are one, and their manifolds are merged: 2°. Smaller merges slopes; larger solves
    /// a plane several times.
    pub const SAME_NORMAL: f32 = 0.9994;

    /// The same of round shapes, as a squared angle: points move with the normal. Larger brakes what rolls over seams.
    pub const SAME_ROUND_NORMAL: f32 = 1.0e-8;

    /// Curved contacts are merged if their radii differ by less than this share.
    pub const SAME_RADIUS: f32 = 0.02;

    /// Points closer than this share of a manifold's size are one, and lines that are side by side over less of the
    /// shorter one have one point. Larger loses corners; smaller solves points twice.
    pub const SAME_POINT: f32 = 0.01;

    /// Points up to this share of a facet's size inside of its border are on it. Larger takes inner points for those of an
    /// edge; smaller misses edges.
    pub const ON_BORDER: f32 = 0.02;

    /// Normals that lean over a border by less are the facet's own, in radians. Larger brakes sliding bodies; rounding is
    /// a tenth of it.
    pub const LEAN: f32 = 1.0e-3;

    /// A shape is on one side of a face if it reaches to the other side by less than this share of its extent. Larger
    /// turns bodies over that reach under a facet; smaller pulls cones into faces.
    pub const ON_ONE_SIDE: f32 = 0.25;

    /// The cosine below which normals differ: 8°. Larger doubts rounding; smaller misses edges that poke into walls.
    pub const TURNED: f32 = 0.99;

    /// A face is deeper than what was found from this share of the prediction on. Smaller is rounding.
    pub const DEEPER_FACE: f32 = 0.005;

    /// Rounding and clipping of the depth of a corner that pokes into a seam, as a share of the prediction. Smaller drops
    /// the wall there.
    pub const POKE: f32 = 0.25;

    /// The least cosine between a face and the side of a corner that pokes into it.
    pub const MOST_LEAN: f32 = 0.25;

    /// What is deeper in a closed surface than this share of its own half size is inside of it. Larger pushes out what
    /// lies inside; smaller keeps what sank in from outside.
    pub const INSIDE: f32 = 0.5;
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

    /// The same of round ones, as a share of both radii. Larger keeps capsules rocking in a pile.
    pub const ROUND_SHARE: f32 = 0.005;

    /// The least cosine of a body's turn while its manifold is kept: 10°. With smaller ones the bounds of small angles
    /// fail.
    pub const RECYCLE_COS: f32 = 0.985;

    /// The share of that way up to which a contact is not looked at. Larger lets separations drift: with this, by a tenth
    /// of a millimetre.
    pub const CALM_SHARE: f32 = 0.5;

    // Deep overlap.
    /// Bodies that were placed into one another by more are pushed out gently. Smaller lets heaps sink into themselves;
    /// larger lets placed bodies jump.
    pub const DEEP: f32 = 0.1;

    /// Deep overlap stays deep down to this. Larger has springs push out the rest, and rows of bodies fly apart.
    pub const NO_LONGER_DEEP: f32 = 0.01;

    // Round bodies that rock.
    /// Bodies that turn by less in a step, in radians, keep their inertia through it, and if they do so against each other
    /// the contact of its start. Larger leaves rocking without damping, and lets bodies gain spin in contacts; smaller
    /// computes more contacts, and slows down piles that creep.
    pub const STILL: f32 = 2.0e-3;

    /// Bodies that turn by more, in radians, do not rock. Larger moves contacts of what has yet to hit.
    pub const MOST_ROCKING: f32 = 0.25;

    /// Nor do those that move by more than this.
    pub const MOST_WAY: f32 = 0.5;

    // Inner edges of the ground. Lengths are in length units, speeds in these per second.
    /// How far above a plane a point may be that is on it. Larger hides kerbs; smaller is below the rounding of positions
    /// some kilometres from the origin.
    pub const FLUSH: f32 = 2.5e-4;

    /// How far below a plane the collider may reach besides the depth of its contact there. Larger hides pits from concave
    /// colliders; smaller has ghosts where bodies tip.
    pub const BELOW: f32 = 0.005;

    /// At how many times the height that counts as on a plane a wall is looked for. Larger misses low walls; smaller takes
    /// edges of flush tiles for walls.
    pub const RISES: f32 = 4.0;

    /// Normals closer than this hold the same, as a squared angle: 0.2°. Larger merges slopes; smaller compares planes
    /// with themselves.
    pub const PARALLEL: f32 = 1.2e-5;

    /// Bodies slower than this slide over nothing. Larger has ghosts at low speed; smaller compares what rests.
    pub const MOVING: f32 = 0.02;

    /// Dynamic bodies slower than this are ground.
    pub const RESTING: f32 = 0.05;

    /// And for those only that move faster than this against them. Smaller takes contacts from bodies in heaps.
    pub const SLIDING: f32 = 0.25;
}

/// Conservative advancement, of contacts within the step, of parts, and of fast bodies after the solver.
pub mod sweeps {
    /// Most steps in which two shapes are advanced to where they meet within the step. What takes more meets where it then
    /// is. Fewer stop bodies that pass by; more cost time.
    pub const MEETING_ROUNDS: usize = 24;

    /// The same for a part of a composite.
    pub const PART_ROUNDS: usize = 16;

    /// The same for a fast body after the solver.
    pub const STOP_ROUNDS: usize = 40;

    /// Shapes that move past each other have met at this share of the distance that counts as touching. Larger stops
    /// bodies that pass by; smaller takes more rounds.
    pub const MET: f32 = 0.1;

    /// Shapes that turn have met at this share of the smaller one's reach, and no farther than touching. Larger stops what
    /// passes by; smaller takes more rounds.
    pub const MET_TURNING: f32 = 0.02;

    /// Bodies that turn by more in the step, in radians, are not swept past what they are near to. Larger gives energy to
    /// what is pushed where it comes to; smaller stops bodies that pass by.
    pub const MOST_STRAIGHT_TURN: f32 = 0.75;

    /// Bodies that turn by more in a step, in radians, are predicted as if they turned by this. Larger finds pairs that
    /// never touch; smaller misses what spinning rods hit.
    pub const MOST_TURN: f32 = 1.5;

    /// Chords of a slab's width that are drawn for one advance. More advance farther, fewer cost less.
    pub const CHORDS: usize = 3;

    /// Points push that close within this many steps. The solver lets points close no further than they may by the end of
    /// the first substep after the step, so that fewer miss points, and more stop bodies that pass by.
    pub const AHEAD: f32 = 2.0;

    /// Bodies that move by less than this share of the ball within them are not swept, and those that overlap by less when
    /// the step ends are not put back: the solver pushes them out. Larger lets them through thin walls; smaller takes time
    /// from bodies.
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
    /// The most turn within a substep for which precession is integrated; bodies that turn farther precess as if they
    /// turned by this. Larger has Newton steps that do not converge.
    pub const MAX_TURN: f32 = 1.0;

    /// The most turn within a substep for which one Newton step is used. It leaves an energy error below 1e-8 a substep;
    /// at 0.75 it would be 1e-5. Smaller costs time.
    pub const SMALL_TURN: f32 = 0.25;

    /// The least turn within a substep for which the spin axis moves. Larger stops slow precession; smaller costs time in
    /// bodies at rest.
    pub const MIN_TURN: f32 = 1.0e-5;

    /// The most relative change of energy in a substep of free spin; with more, Newton's method has not converged, and the
    /// spin is left as it is. Larger takes wrong spins.
    pub const MAX_ENERGY_ERROR: f32 = 1.0e-4;

    /// The number of substeps of a step that is assumed where bodies that turn far are told apart.
    pub const STEP_SUBSTEPS: f32 = 4.0;

    /// The least product of the ratio of moments and the squared turn of a step for which a body turns far: a box from
    /// about 6 rad/s on at 60 Hz. Larger lets such bodies gain energy in contacts; smaller slows down piles that tumble.
    pub const FAR_TURN: f32 = 0.08;

    // Friction and resistance.
    /// The lever of rolling resistance as a share of the smaller radius: at friction 0.6 a ball rolls as if up a slope of
    /// 0.6 %. Larger holds round bodies on steeper slopes; smaller keeps them rocking in a pile.
    pub const ROLL_LEVER: f32 = 0.01;

    /// The same of torsional friction of a contact in one point: a patch that holds against rolling by a lever holds
    /// against spin by about twice that. Smaller lets balls spin on the spot.
    pub const SPIN_LEVER: f32 = 2.0 * ROLL_LEVER;

    /// Both for corners and edges, as a share of their distance from the nearer centre of mass of a body that can turn.
    pub const CORNER_LEVER: f32 = 0.002;

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
}
