//! A step made of the kernel's parts, in the engine's order, as an embedder without an ECS would write it.
#![expect(unsafe_code, reason = "the caller of `build_rows` answers for contacts and colours")]

mod constraints;

use super::dim::inverse_inertia;
use super::units;
use crate::kernel;
use kernel::bvh::{FoundPairs, Mover, Movers, PairMask, ProxyId, TreeKind, Trees};
use kernel::ccd::{SweepBuffers, SweepInput};
use kernel::contact::{
    Contact, ContactFlags, ContactManager, ContactTable, Frozen, NarrowPhaseInput, WorkerBuffers,
};
use kernel::data::BitSet;
use kernel::graph::{ColorGraph, Islands, SleepScan};
use kernel::math::{AxisLocks, InvInertia, Pose, Rot, Vector, WorldPose, WorldVector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::solver::{
    BodyRow, BodyRows, JointSolver, Limits, MassRow, Motion, RowInput, Solver, SubstepParams,
};
use kernel::table::{
    BodyKind, BodyTable, ColliderDef, ColliderFlags, ColliderTable, Combine, Fattening, Layers, Material,
    RestSpeed, Surface,
};
use kernel::thread_pool::ThreadPool;
use std::collections::BTreeSet;

/// The distance that counts as touching, in length units.
const TOLERANCE: f32 = 0.005;

fn phase<'a>(
    bodies: &'a BodyTable,
    colliders: &'a ColliderTable,
    dt: f32,
    recycle: bool,
    narrow: bool,
) -> NarrowPhaseInput<'a> {
    let unit = bodies.length_unit();
    NarrowPhaseInput {
        bodies,
        colliders,
        source: &(),
        dt,
        tolerance: TOLERANCE * unit,
        speculative: 0.02 * unit,
        recycle_distance: if recycle { 0.05 * unit } else { 0.0 },
        match_points: true,
        narrow,
    }
}

/// Writes a value at an index in the list, or appends it.
fn put<T>(list: &mut Vec<T>, id: u32, value: T) {
    match list.get_mut(id as usize) {
        Some(place) => *place = value,
        None => list.push(value),
    }
}

/// What the narrow phase does with a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The fat boxes do not overlap any more.
    Separated,
    /// The manifold followed the motion.
    Recycled,
    /// The manifold was computed anew.
    Recomputed,
}

/// A whole simulation.
#[derive(Clone)]
pub struct Sim {
    pub bodies: BodyTable,
    pub colliders: ColliderTable,
    pub contacts: ContactTable,
    pub colors: ColorGraph,
    pub islands: Islands,
    pub gravity: Vector,
    /// The length unit. Shapes, places, joints and, until the first step, velocities and gravity are given
    /// in such units.
    pub unit: f32,
    /// The density of bodies that are added.
    pub density: f32,
    pub dt: f32,
    pub substeps: u32,
    /// How joints are solved.
    pub joint_solver: JointSolver,
    pub sleeping: bool,
    pub recycle: bool,
    /// Whether the tables are checked after each step, where assertions are on.
    pub checked: bool,
    /// Whether contacts are solved.
    pub builds_rows: bool,
    /// Whether fast bodies are swept after the substeps.
    pub sweeps: bool,
    pub locks: Vec<AxisLocks>,
    /// Colliders whose pairs are refused, as by a hook that filters pairs.
    pub unpaired: Vec<u32>,
    /// Pairs of colliders that are refused.
    pub apart: BTreeSet<[u32; 2]>,
    /// Colliders whose contacts are dropped after each update, as by a hook that changes contacts.
    pub dropped: Vec<u32>,
    /// Number of steps so far.
    pub steps_done: usize,
    /// Number of stages that several workers shared in the last step.
    pub shared: usize,
    trees: Trees,
    proxies: Vec<(TreeKind, ProxyId)>,
    is_in_units: bool,
    pub masses: Vec<(f32, InvInertia)>,
    movers: Movers,
    solver: Solver,
    pool: ThreadPool,
    scratch: Vec<WorkerBuffers>,
    sweep_buffers: Vec<SweepBuffers>,
    is_narrow: bool,
    scan: SleepScan,
    listed: Vec<u32>,
    frames: Vec<WorldPose>,
    outgrown: BitSet,
    changed: BitSet,
}

impl Sim {
    pub fn new() -> Self {
        // Colours are shared from the first constraint on, although that does not pay: the tests compare
        // numbers of workers.
        let mut solver = Solver::default();
        solver.share_from(1);
        Self {
            bodies: BodyTable::default(),
            colliders: ColliderTable::default(),
            contacts: ContactTable::default(),
            colors: ColorGraph::new(),
            islands: Islands::new(),
            gravity: Vector::Y * -10.0,
            unit: 1.0,
            density: 1.0,
            dt: 1.0 / 60.0,
            substeps: 4,
            joint_solver: JointSolver::Auto,
            sleeping: false,
            recycle: true,
            checked: true,
            builds_rows: true,
            sweeps: true,
            locks: Vec::new(),
            unpaired: Vec::new(),
            apart: BTreeSet::new(),
            dropped: Vec::new(),
            steps_done: 0,
            shared: 0,
            trees: Trees::default(),
            proxies: Vec::new(),
            is_in_units: false,
            masses: Vec::new(),
            movers: Movers::default(),
            solver,
            pool: ThreadPool::default(),
            scratch: Vec::new(),
            sweep_buffers: Vec::new(),
            is_narrow: false,
            scan: SleepScan::new(),
            listed: Vec::new(),
            frames: Vec::new(),
            outgrown: BitSet::default(),
            changed: BitSet::default(),
        }
    }

    /// Uses four lanes, also if the CPU has eight.
    pub fn set_narrow(&mut self) {
        self.is_narrow = true;
        self.solver.set_narrow(true);
    }

    /// Sets the number of workers, the caller among them.
    pub fn set_workers(&mut self, workers: usize) {
        self.pool = ThreadPool::new(workers);
    }

    pub fn contact_manager(&mut self) -> ContactManager<'_> {
        ContactManager {
            bodies: &mut self.bodies,
            colliders: &mut self.colliders,
            contacts: &mut self.contacts,
            colors: &mut self.colors,
            islands: Some(&mut self.islands),
        }
    }

    /// Adds a body of one shape; its id is its collider's.
    pub fn add(&mut self, kind: BodyKind, shape: Shape, position: Vector, rotation: Rot) -> u32 {
        self.add_with(kind, shape, position, rotation, 0.6, 0.0)
    }

    pub fn add_with(
        &mut self,
        kind: BodyKind,
        shape: Shape,
        position: Vector,
        rotation: Rot,
        friction: f32,
        restitution: f32,
    ) -> u32 {
        self.add_flagged(kind, shape, position, rotation, [friction, restitution], ColliderFlags::default())
    }

    fn add_flagged(
        &mut self,
        kind: BodyKind,
        shape: Shape,
        position: Vector,
        rotation: Rot,
        [friction, restitution]: [f32; 2],
        flags: ColliderFlags,
    ) -> u32 {
        let shape = units::scaled_shape(&shape, self.unit);
        let mass = shape.mass_properties(self.density);
        let pose = WorldPose::new((position * self.unit).to_world(), rotation);
        let id = self.bodies.add(kind, mass.center, pose);
        self.bodies[id].rest_speed = RestSpeed { linear: 0.15 * self.unit, angular: 0.15 };
        put(&mut self.frames, id, pose);
        self.contact_manager().enter(id);
        let inverse = if mass.mass > 0.0 { 1.0 / mass.mass } else { 0.0 };
        put(&mut self.masses, id, (inverse, inverse_inertia(&mass)));
        put(&mut self.locks, id, AxisLocks::NONE);
        let surface = |coefficient| Surface { coefficient, rule: Combine::Average };
        let def = ColliderDef {
            shape,
            body: id,
            local: Pose::IDENTITY,
            material: Material { friction: surface(friction), restitution: surface(restitution) },
            facets: None,
            layers: Layers { memberships: 1, filters: u32::MAX },
            flags,
            margin: 0.0,
            speculative: f32::MAX,
        };
        let collider = self.colliders.add(def, pose, &mut self.bodies);
        assert_eq!(collider, id, "one collider a body");
        self.enter_tree(id, kind);
        id
    }

    /// Adds a body whose colliders are pieces at places. Each piece after the first takes the id of a body
    /// without colliders, so that ids of bodies stay those of their colliders.
    pub fn add_children(&mut self, kind: BodyKind, pieces: &[(Shape, Vector)], friction: f32) -> u32 {
        let (first, place) = &pieces[0];
        let id = self.add_with(kind, first.clone(), *place, Rot::IDENTITY, friction, 0.0);
        let pose = self.bodies.frame(id);
        for (shape, at) in &pieces[1..] {
            let unused = self.bodies.add(BodyKind::Static, Vector::ZERO, pose);
            put(&mut self.frames, unused, pose);
            self.contact_manager().enter(unused);
            let mass = self.masses[id as usize];
            put(&mut self.masses, unused, mass);
            put(&mut self.locks, unused, AxisLocks::NONE);
            let local = Pose::new((*at - *place) * self.unit, Rot::IDENTITY);
            let shape = units::scaled_shape(shape, self.unit);
            let def = ColliderDef { shape, local, ..self.colliders[id].def.clone() };
            let collider = self.colliders.add(def, pose.then(&local), &mut self.bodies);
            assert_eq!(collider, unused, "one collider an id");
            self.enter_tree(collider, kind);
        }
        id
    }

    fn enter_tree(&mut self, id: u32, kind: BodyKind) {
        let tree = match kind {
            BodyKind::Static => TreeKind::Static,
            BodyKind::Kinematic => TreeKind::Kinematic,
            BodyKind::Dynamic => TreeKind::Dynamic,
        };
        self.colliders.refresh(id, &self.bodies, self.fattening());
        let aabb = self.colliders.fat[id as usize];
        let proxy = self.trees[tree].insert(id, aabb);
        put(&mut self.proxies, id, (tree, proxy));
        self.movers.insert(Mover { id, kind: tree, mask: PairMask::solid(tree), aabb });
    }

    /// Adds a static body whose collider is a sensor.
    pub fn add_sensor(&mut self, shape: Shape, position: Vector) -> u32 {
        let flags = ColliderFlags { sensor: true, ..ColliderFlags::default() };
        self.add_flagged(BodyKind::Static, shape, position, Rot::IDENTITY, [0.6, 0.0], flags)
    }

    pub fn ball(&mut self, radius: f32, position: Vector) -> u32 {
        self.add(BodyKind::Dynamic, Shape::Ball(Ball { radius }), position, Rot::IDENTITY)
    }

    pub fn cuboid(&mut self, half: Vector, position: Vector) -> u32 {
        self.add(BodyKind::Dynamic, Shape::Cuboid(Cuboid { half }), position, Rot::IDENTITY)
    }

    /// Removes a body with its collider. Its id may be reused at once.
    pub fn remove(&mut self, id: u32) {
        self.contact_manager().destroy_of_collider(id);
        let (kind, proxy) = self.proxies[id as usize];
        self.trees[kind].remove(proxy);
        let others: Vec<Mover> = self.movers.list().iter().filter(|mover| mover.id != id).copied().collect();
        self.movers.clear();
        others.into_iter().for_each(|mover| _ = self.movers.insert(mover));
        self.colliders.remove(id, &mut self.bodies);
        self.contact_manager().leave(id);
        self.recycle_ids();
    }

    fn recycle_ids(&mut self) {
        self.bodies.ids.recycle();
        self.colliders.recycle_ids();
        self.contacts.recycle_ids();
    }

    /// Sets the mass of a body to that of a shape.
    pub fn weigh(&mut self, id: u32, shape: &Shape) {
        let mass = units::scaled_shape(shape, self.unit).mass_properties(self.density);
        self.masses[id as usize] = (1.0 / mass.mass, inverse_inertia(&mass));
    }

    /// Multiplies mass and inertia of a body.
    pub fn load(&mut self, id: u32, factor: f32) {
        let (inverse, inertia) = self.masses[id as usize];
        self.masses[id as usize] = (inverse / factor, inertia.scaled(1.0 / factor));
    }

    /// Sets the shape of a body, and its mass.
    pub fn reshape(&mut self, id: u32, shape: Shape) {
        self.weigh(id, &shape);
        let shape = units::scaled_shape(&shape, self.unit);
        let def = ColliderDef { shape, ..self.colliders[id].def.clone() };
        self.colliders.redefine(id, def, &mut self.bodies);
    }

    /// Has a body touch nothing.
    pub fn ghost(&mut self, id: u32) {
        let layers = Layers { memberships: 0, filters: 0 };
        let def = ColliderDef { layers, ..self.colliders[id].def.clone() };
        self.colliders.redefine(id, def, &mut self.bodies);
    }

    /// Has a body touch only those that are as they were added.
    pub fn meets_static_only(&mut self, id: u32) {
        let layers = Layers { memberships: 2, filters: 1 };
        let def = ColliderDef { layers, ..self.colliders[id].def.clone() };
        self.colliders.redefine(id, def, &mut self.bodies);
    }

    pub fn floor(&mut self) -> u32 {
        let half = Vector::ONE * 200.0;
        self.add(BodyKind::Static, Shape::Cuboid(Cuboid { half }), Vector::Y * -200.0, Rot::IDENTITY)
    }

    pub fn position(&self, id: u32) -> WorldVector {
        self.bodies.frame(id).position
    }

    pub fn fattening(&self) -> Fattening {
        Fattening { margin: 0.05 * self.unit, dt: self.dt }
    }

    fn params(&self) -> SubstepParams {
        let params = SubstepParams::new(self.dt, self.substeps).in_units_of(self.unit);
        SubstepParams { joints: self.joint_solver, ..params }
    }

    /// Builds rows from the colours of another simulation. Returns the number of shared stages.
    #[cfg(debug_assertions)]
    pub fn solve_colors_of(&mut self, other: &Self) -> usize {
        self.gather();
        let params = self.params();
        let input = RowInput { contacts: &self.contacts, bodies: &self.bodies, colliders: &self.colliders };
        // SAFETY: debug builds panic for colours that do not match.
        unsafe { self.solver.build_rows(&input, &other.colors, &params, &self.pool) };
        self.solver.shared_stages()
    }

    /// The rows of the bodies, to be filled.
    pub fn rows(&mut self) -> &mut BodyRows {
        self.gather();
        &mut self.solver.bodies
    }

    pub fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.step();
        }
    }

    /// Brings velocities and gravity from length units to the units of the world, once.
    pub fn enter_units(&mut self) {
        if core::mem::replace(&mut self.is_in_units, true) {
            return;
        }
        self.bodies.set_length_unit(self.unit);
        self.gravity = self.gravity * self.unit;
        for velocity in &mut self.bodies.velocities {
            velocity.linear = velocity.linear * self.unit;
        }
    }

    pub fn step(&mut self) {
        self.enter_units();
        self.steps_done += 1;
        self.recycle_ids();
        self.gather();
        // Threads are woken although that does not pay here.
        self.pool.wake();
        let fattening = self.fattening();
        self.colliders.refresh_pushed(&mut self.bodies, fattening, &mut self.outgrown);
        self.move_outgrown();
        let mut found = FoundPairs::default();
        found.find(&self.trees, &self.movers, self.contacts.pairs(), &self.pool);
        self.movers.clear();
        found.retain(|_, (a, b)| {
            let is_refused =
                [a, b].iter().any(|id| self.unpaired.contains(id)) || self.apart.contains(&[a, b]);
            let [first, second] = [a, b].map(|id| &self.colliders[id].def);
            !is_refused && first.body != second.body && first.layers.interacts_with(second.layers)
        });
        let left_out = self.contact_manager().left_out(found.pairs());
        for (place, &(a, b)) in found.pairs().iter().enumerate() {
            if left_out.contains(place as u32) {
                self.outgrown.insert(a);
            } else {
                self.contact_manager().create(a, b);
            }
        }
        self.narrow();
        let params = self.params();
        let input = RowInput { contacts: &self.contacts, bodies: &self.bodies, colliders: &self.colliders };
        self.pool.wake();
        if self.builds_rows {
            // SAFETY: contacts, colours and kinds of bodies are changed through one contact manager.
            unsafe { self.solver.build_rows(&input, &self.colors, &params, &self.pool) };
            self.shared = self.solver.shared_stages();
        }
        for _ in 0..self.substeps {
            self.solver.substep(&params, &self.pool);
        }
        if self.sweeps && self.builds_rows {
            let input = SweepInput {
                bodies: &self.bodies,
                colliders: &self.colliders,
                trees: &self.trees,
                contacts: &self.contacts,
                source: &(),
                tolerance: TOLERANCE * self.unit,
                dt: self.dt,
            };
            self.solver.stop_fast(&input, &self.listed, &mut self.sweep_buffers, &self.pool);
        }
        self.solver.restitute(&params, &self.pool);
        self.solver.store_impulses(&mut self.contacts, &self.pool);
        self.scatter();
        if self.sleeping {
            self.sleep();
        }
        if self.checked && cfg!(debug_assertions) {
            self.contact_manager().validate();
        }
    }

    fn gather(&mut self) {
        let kinematic = self.bodies.assign_rows(&mut self.listed);
        self.solver.begin_step(kinematic, self.listed.len() - kinematic);
        let rows = &mut self.solver.bodies;
        for (i, &id) in self.listed.iter().enumerate() {
            let row = i + 1;
            rows.set_at_rest(row);
            let velocity = self.bodies.velocities[id as usize];
            self.bodies.set_velocity(id, velocity);
            rows.rows[row] = BodyRow::new(velocity.linear, velocity.angular);
            if self.bodies[id].kind == BodyKind::Dynamic {
                let (mass, local) = self.masses[id as usize];
                let rotation = self.bodies.poses[id as usize].rotation;
                let locks = self.locks[id as usize];
                rows.masses[row] = MassRow::new(mass, local.rotated(rotation).locked(locks));
                rows.motions[row] = Motion { acceleration: self.gravity, ..Motion::FREE };
                rows.limit(row, Limits { locks, ..Limits::NONE });
                rows.spin(row, local, rotation);
            }
        }
    }

    /// The narrow phase's outcome for the contact of two bodies at their current poses, and the contact.
    pub fn look(&self, a: u32, b: u32) -> (Outcome, Contact) {
        let id = self.contacts.find(a, b).expect("they have a contact");
        let phase = phase(&self.bodies, &self.colliders, self.dt, self.recycle, self.is_narrow);
        let mut contacts = self.contacts.clone();
        contacts.update(&phase, &ThreadPool::new(1), &mut Vec::new(), &mut BitSet::new());
        let [before, after] = [&self.contacts, &contacts].map(|contacts| contacts.get(id));
        // A new manifold is of the present poses, or cannot be recycled.
        let origin = |contact: &Contact| {
            let Frozen { rotations, offset, prediction } = contact.frozen;
            (contact.flags.has(ContactFlags::FROZEN), contact.revisions, rotations, offset, prediction)
        };
        let outcome = if after.flags.has(ContactFlags::SEPARATED) {
            Outcome::Separated
        } else if origin(before) == origin(after) {
            Outcome::Recycled
        } else {
            Outcome::Recomputed
        };
        (outcome, after.clone())
    }

    fn narrow(&mut self) {
        let phase = phase(&self.bodies, &self.colliders, self.dt, self.recycle, self.is_narrow);
        self.changed.clear();
        self.pool.wake();
        self.contacts.update(&phase, &self.pool, &mut self.scratch, &mut self.changed);
        for &collider in &self.dropped {
            let contacts: Vec<u32> = self.contacts.of_collider(collider, &self.colliders).collect();
            let touches = |id: &u32| self.contacts.get(*id).flags.has(ContactFlags::TOUCHING);
            for id in contacts.into_iter().filter(touches).collect::<Vec<_>>() {
                self.contacts.change(id, core::iter::empty(), &mut self.changed);
            }
        }
        let changed = core::mem::take(&mut self.changed);
        self.contact_manager().apply(&changed, |_, _, _| {});
        self.changed = changed;
    }

    fn scatter(&mut self) {
        let lost = self.solver.finish(&mut self.bodies, &self.listed, &mut self.frames, self.dt, &self.pool);
        assert_eq!(lost, [], "nothing is lost");
        let fattening = self.fattening();
        let Self { colliders, listed, bodies, pool, outgrown, .. } = self;
        colliders.refresh_listed(listed, bodies, fattening, pool, outgrown);
        self.move_outgrown();
    }

    fn move_outgrown(&mut self) {
        let Self { outgrown, .. } = self;
        for id in outgrown.iter() {
            let (kind, proxy) = self.proxies[id as usize];
            let aabb = self.colliders.fat[id as usize];
            self.trees[kind].set(proxy, aabb);
            self.movers.insert(Mover { id, kind, mask: PairMask::solid(kind), aabb });
        }
        self.outgrown.clear();
    }

    fn sleep(&mut self) {
        let bodies = &self.bodies;
        self.scan.scan(&mut self.islands, 0.5, |body| Some(bodies[body].sleep_timer));
        for island in self.scan.splits() {
            self.islands.split(*island);
        }
        for island in self.scan.sleepers().to_vec() {
            self.contact_manager().sleep_island(island);
        }
    }

    /// Kinetic and potential energy of the dynamic bodies.
    pub fn energy(&self) -> f64 {
        let potential = |id: u32| {
            let p = self.bodies.poses[id as usize].center.to_local();
            -self.mass(id) * f64::from(self.gravity.dot(p))
        };
        self.bodies.awake_dynamic().map(|id| self.kinetic_energy(id) + potential(id)).sum()
    }

    /// The mass of a body, kg. Infinite for a shape without volume.
    pub fn mass(&self, id: u32) -> f64 {
        1.0 / f64::from(self.masses[id as usize].0)
    }

    /// The kinetic energy of a body with a mass, J.
    pub fn kinetic_energy(&self, id: u32) -> f64 {
        let (v, pose) = (self.bodies.velocities[id as usize], self.bodies.poses[id as usize]);
        let spin = super::dim::spin_energy(self.masses[id as usize].1, pose.rotation, v.angular);
        0.5 * self.mass(id) * f64::from(v.linear.length_squared()) + spin
    }
}
