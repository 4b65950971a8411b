//! Free spin in 3D: the gyroscopic torque. There is none in 2D.

use avian::{math::Vector, prelude::*};
use bevy_ecs::prelude::*;
use scenes::scene::at;

use super::world::{Lab, assert_close};

/// A free body whose shape is a box.
struct Top {
    lab: Lab,
    body: Entity,
    /// The moments of inertia about its own axes.
    inertia: Vector,
}

impl Top {
    /// A box of this size and density 1 that spins at `spin` rad/s and never sleeps.
    fn new(size: [f32; 3], spin: Vector) -> Self {
        let mut lab = Lab::weightless();
        let body = lab.block(size, at(0.0, 0.0, 0.0));
        lab.insert(body, (AngularVelocity(spin), SleepingDisabled));
        let [x, y, z] = size.map(|side| side * side);
        let inertia = Vector::new(y + z, x + z, x + y) * size.iter().product::<f32>() / 12.0;
        Self { lab, body, inertia }
    }

    /// The angular velocity in the frame of the body.
    fn local_spin(&self) -> Vector {
        self.lab.get::<Rotation>(self.body).inverse() * self.lab.get::<AngularVelocity>(self.body).0
    }

    /// The angular momentum in the frame of the world.
    fn momentum(&self) -> Vector {
        self.lab.get::<Rotation>(self.body) * (self.inertia * self.local_spin())
    }

    fn energy(&self) -> f32 {
        let spin = self.local_spin();
        0.5 * spin.dot(self.inertia * spin)
    }
}

#[test]
fn a_free_disc_wobbles_at_its_rate() {
    // In the body's frame, the spin rotates about its axis of symmetry at (I₃ − I₁) / I₁ · ω₃.
    let mut top = Top::new([1.0, 0.2, 1.0], Vector::new(1.0, 4.0, 0.0));
    let (mut turned, mut last) = (0.0, top.local_spin());
    for _ in 0..600 {
        top.lab.steps(1);
        let now = top.local_spin();
        let (across, along) = (last.z * now.x - last.x * now.z, last.x * now.x + last.z * now.z);
        turned += across.atan2(along);
        last = now;
    }
    let rate = (top.inertia.y - top.inertia.x) / top.inertia.x * 4.0;
    assert_close(turned, rate * 10.0, 0.005, "wobble");
    assert_close(last.y, 4.0, 1e-3, "spin about the axis");
}

#[test]
fn what_spins_about_its_middle_axis_turns_over() {
    // Dzhanibekov's wing nut: a spin about the axis of the intermediate moment is unstable.
    let mut top = Top::new([0.4, 1.0, 2.0], Vector::new(0.01, 5.0, 0.0));
    let (mut sign, mut turns) = (1.0, 0);
    for _ in 0..1200 {
        top.lab.steps(1);
        if top.local_spin().y * sign < -4.0 {
            (sign, turns) = (-sign, turns + 1);
        }
    }
    assert!((3..=8).contains(&turns), "it turned over {turns} times in 20 s");
}

#[test]
fn free_spin_keeps_its_direction_and_gains_nothing() {
    let cases = [
        ([0.4, 1.0, 2.0], Vector::new(0.01, 5.0, 0.0), 0.9),
        ([1.0, 0.2, 1.0], Vector::new(1.0, 4.0, 0.0), 0.98),
        // So thin and fast that an explicit step would diverge. The implicit step damps what it
        // cannot resolve.
        ([0.02, 2.0, 0.02], Vector::new(100.0, 3.0, 0.0), 0.7),
        ([0.02, 2.0, 0.02], Vector::new(70.0, 70.0, 1.0), 0.0),
    ];
    for (size, spin, kept) in cases {
        let mut top = Top::new(size, spin);
        let (momentum, mut energy) = (top.momentum(), top.energy());
        for step in 0..1200 {
            top.lab.steps(1);
            let now = top.energy();
            assert!(now <= 1.0001 * energy, "{size:?} at {spin}: from {energy} to {now} J in step {step}");
            energy = energy.min(now);
        }
        let left = top.momentum().dot(momentum) / momentum.length_squared();
        assert!(left <= 1.0001 && left >= kept, "{size:?} at {spin}: {left} of the momentum is left");
        if kept > 0.0 {
            let across = top.momentum().normalize().cross(momentum.normalize()).length();
            assert!(across < 0.02, "{size:?} at {spin}: its momentum turned by {across} rad");
        }
    }
}
