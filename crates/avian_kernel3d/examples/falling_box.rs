//! A box falls on a floor, without Bevy. Look at the order of the parts: contact, rows, substeps, poses.
//!
//! The pair is found by hand here; `avian_kernel3d::bvh` finds pairs where there are many colliders.
//!
//! `cargo run -p avian_kernel3d --example falling_box`

#![expect(unsafe_code, reason = "the caller of `build_rows` answers for the tables")]

use avian_kernel3d::contact::{ContactManager, ContactTable, NarrowPhaseInput};
use avian_kernel3d::data::BitSet;
use avian_kernel3d::graph::ColorGraph;
use avian_kernel3d::math::{Rot, Vector, WorldPose};
use avian_kernel3d::shape::{Cuboid, Shape};
use avian_kernel3d::solver::{BodyRow, MassRow, Motion, RowInput, Solver, SubstepParams};
use avian_kernel3d::table::{BodyKind, BodyTable, ColliderDef, ColliderTable, Fattening};
use avian_kernel3d::thread_pool::ThreadPool;

fn main() {
    let (dt, pool, params) = (1.0 / 60.0, ThreadPool::new(2), SubstepParams::new(1.0 / 60.0, 4));
    let (mut bodies, mut colliders) = (BodyTable::default(), ColliderTable::default());
    let (mut contacts, mut colors, mut solver) =
        (ContactTable::default(), ColorGraph::new(), Solver::default());
    let (fattening, mut frames) = (Fattening { margin: 0.05, dt }, [WorldPose::default(); 2]);
    let (mut listed, mut buffers, mut changed) = (Vec::new(), Vec::new(), BitSet::new());
    let cuboid = |x, y, z| Shape::Cuboid(Cuboid { half: Vector { x, y, z } });
    let floor = (BodyKind::Static, cuboid(10.0, 0.5, 10.0), -0.5);
    for (kind, shape, y) in [floor, (BodyKind::Dynamic, cuboid(0.5, 0.5, 0.5), 3.0)] {
        let pose = WorldPose::new((Vector::Y * y).to_world(), Rot::IDENTITY);
        let body = bodies.add(kind, Vector::ZERO, pose);
        let collider = colliders.add(ColliderDef::new(shape, body), pose, &mut bodies);
        colliders.refresh(collider, &bodies, fattening);
    }
    let mass = colliders[1].def.shape.mass_properties(1.0);
    for step in 1..=90 {
        // The box is the only body that moves: it gets row 1.
        let kinematic = bodies.assign_rows(&mut listed);
        solver.begin_step(kinematic, listed.len() - kinematic);
        solver.bodies.rows[1] = BodyRow::new(bodies.velocities[1].linear, bodies.velocities[1].angular);
        solver.bodies.masses[1] = MassRow::new(1.0 / mass.mass, mass.inertia.inverse());
        solver.bodies.motions[1] = Motion { acceleration: Vector::Y * -9.81, ..Motion::FREE };
        // A contact exists from the first overlap of the enlarged boxes on.
        let mut manager = ContactManager {
            bodies: &mut bodies,
            colliders: &mut colliders,
            contacts: &mut contacts,
            colors: &mut colors,
            islands: None,
        };
        if manager.contacts.is_empty() && manager.colliders.fat[0].overlaps(&manager.colliders.fat[1]) {
            manager.create(0, 1);
        }
        changed.clear();
        let input = NarrowPhaseInput::new(manager.bodies, manager.colliders, &(), dt);
        manager.contacts.update(&input, &pool, &mut buffers, &mut changed);
        manager.apply(&changed, |_, _, _| {});
        let input = RowInput { contacts: &contacts, bodies: &bodies, colliders: &colliders };
        // SAFETY: contacts, colours and bodies belong together: only `manager` has changed them.
        unsafe { solver.build_rows(&input, &colors, &params, &pool) };
        (0..4).for_each(|_| solver.substep(&params, &pool));
        solver.restitute(&params, &pool);
        solver.store_impulses(&mut contacts, &pool);
        let lost = solver.finish(&mut bodies, &listed, &mut frames, dt, &pool);
        assert!(lost.is_empty(), "all results are finite");
        colliders.refresh_listed(&listed, &bodies, fattening, &pool, &mut BitSet::new());
        if step % 10 == 0 {
            println!("{:.2} s: {:.3} m", step as f32 * dt, bodies.poses[1].center.to_local().y);
        }
    }
}
