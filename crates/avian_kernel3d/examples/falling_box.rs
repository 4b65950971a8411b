//! A box falls on a floor, without Bevy. Look at the order of the parts: contact, rows, substeps, poses.
//!
//! Pairs are found by hand here; `avian_kernel3d::bvh` finds them where there are many colliders.
//!
//! `cargo run -p avian_kernel3d --example falling_box`

#![expect(unsafe_code, reason = "the caller of `build_rows` answers for the tables")]

use avian_kernel3d::contact::{ContactTable, Link, NarrowPhaseInput};
use avian_kernel3d::data::BitSet;
use avian_kernel3d::graph::ColorGraph;
use avian_kernel3d::math::{Pose, Rot, Vector, WorldPose};
use avian_kernel3d::shape::{Cuboid, Shape};
use avian_kernel3d::solver::{BodyRow, MassRow, Motion, RowInput, Solver, SubstepParams};
use avian_kernel3d::table::{
    BodyKind, BodyTable, ColliderDef, ColliderFlags, ColliderTable, Combine, Fattening, Layers, Material,
    Surface,
};
use avian_kernel3d::thread_pool::ThreadPool;

const DT: f32 = 1.0 / 60.0;
const SUBSTEPS: u32 = 4;
const FATTENING: Fattening = Fattening { margin: 0.05, dt: DT };

/// Adds a body with one box; its id is the collider's, too.
fn add(bodies: &mut BodyTable, colliders: &mut ColliderTable, kind: BodyKind, half: Vector, y: f32) -> u32 {
    let pose = WorldPose::new((Vector::Y * y).to_world(), Rot::IDENTITY);
    let body = bodies.add(kind, Vector::ZERO, pose);
    let surface = Surface { coefficient: 0.5, rule: Combine::Average };
    let def = ColliderDef {
        shape: Shape::Cuboid(Cuboid { half }),
        body,
        local: Pose::IDENTITY,
        material: Material { friction: surface, restitution: Surface { coefficient: 0.0, ..surface } },
        layers: Layers { memberships: 1, filters: u32::MAX },
        flags: ColliderFlags::default(),
        margin: 0.0,
        speculative: f32::MAX,
    };
    let collider = colliders.add(def, pose, bodies);
    colliders.refresh(collider, bodies, FATTENING);
    collider
}

fn main() {
    let (mut bodies, mut colliders) = (BodyTable::default(), ColliderTable::default());
    let (mut contacts, mut colors, mut solver) =
        (ContactTable::default(), ColorGraph::new(), Solver::default());
    let pool = ThreadPool::new(2);
    let floor = add(&mut bodies, &mut colliders, BodyKind::Static, Vector { x: 10.0, y: 0.5, z: 10.0 }, -0.5);
    let half = Vector::ONE * 0.5;
    let falling = add(&mut bodies, &mut colliders, BodyKind::Dynamic, half, 3.0);
    let mass = Shape::Cuboid(Cuboid { half }).mass_properties(1.0);
    let (mut listed, mut frames, mut workers) = (Vec::new(), vec![WorldPose::default(); 2], Vec::new());
    let (mut changed, mut outgrown) = (BitSet::default(), BitSet::default());
    let params = SubstepParams::new(DT, SUBSTEPS);
    for step in 1..=90 {
        // A row for each body that moves.
        let kinematic = bodies.assign_rows(&mut listed);
        solver.begin_step(kinematic, listed.len() - kinematic);
        let velocity = bodies.velocities[falling as usize];
        solver.bodies.set_at_rest(1);
        solver.bodies.rows[1] = BodyRow::new(velocity.linear, velocity.angular);
        solver.bodies.masses[1] = MassRow::new(1.0 / mass.mass, mass.inertia.inverse());
        solver.bodies.motions[1] = Motion { acceleration: Vector::Y * -9.81, ..Motion::FREE };
        // A contact exists while the fat boxes overlap.
        let is_near = colliders.fat[floor as usize].overlaps(&colliders.fat[falling as usize]);
        let mut link = Link {
            bodies: &mut bodies,
            colliders: &mut colliders,
            contacts: &mut contacts,
            colors: &mut colors,
            islands: None,
        };
        if is_near && link.contacts.is_empty() {
            link.create(floor, falling);
        }
        let input = NarrowPhaseInput {
            bodies: link.bodies,
            colliders: link.colliders,
            source: &(),
            dt: DT,
            tolerance: 0.005,
            speculative: 0.02,
            recycle_distance: 0.05,
            match_points: true,
            narrow: false,
        };
        changed.clear();
        link.contacts.update(&input, &pool, &mut workers, &mut changed);
        link.apply(&changed, |_, _, _| {});
        let input = RowInput { contacts: &contacts, bodies: &bodies };
        // SAFETY: contacts, colours and bodies belong together: only `link` has changed them.
        unsafe { solver.build_rows(&input, &colors, &params, &pool) };
        (0..SUBSTEPS).for_each(|_| solver.substep(&params, &pool));
        solver.restitute(&params, &pool);
        solver.store_impulses(&mut contacts, &pool);
        let lost = solver.finish(&mut bodies, &listed, &mut frames, DT, &pool);
        assert!(lost.is_empty(), "all results are finite");
        colliders.refresh_listed(&listed, &bodies, FATTENING, &pool, &mut outgrown);
        if step % 10 == 0 {
            println!(
                "{:.2} s: {:.3} m",
                step as f32 * DT,
                bodies.poses[falling as usize].center.to_local().y
            );
        }
    }
}
