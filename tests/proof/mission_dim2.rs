//! 2D snippets of Avian's announcements. `mission_dim3.rs` has those of 3D.

use avian::{math::Vector, prelude::*};
use bevy_math::{Vec2, primitives as shapes};

/// A ball of a radius.
pub const BALL: fn(f32) -> Collider = Collider::circle;
/// A square of a side.
pub const CUBE: fn(f32) -> Collider = |side| Collider::rectangle(side, side);

#[test]
fn twice_45_degrees_turn_x_to_exactly_y() {
    let rotation = Rotation::degrees(45.0);
    assert_eq!(rotation * rotation * Vec2::X, Vec2::Y);
    assert_eq!(Rotation::radians(core::f32::consts::FRAC_PI_4), rotation);
}

#[test]
fn every_primitive_is_a_collider() {
    let same = |a: Collider, b: Collider| {
        let bounds = |c: &Collider| c.shape().compute_local_aabb();
        let (a, b) = (bounds(&a), bounds(&b));
        assert!((a.mins - b.mins).length() < 1e-6 && (a.maxs - b.maxs).length() < 1e-6, "{a:?} is not {b:?}");
    };
    same(shapes::Circle::new(0.5).into(), Collider::circle(0.5));
    same(shapes::Ellipse::new(0.5, 0.3).into(), Collider::ellipse(0.5, 0.3));
    same(shapes::Rectangle::new(2.0, 1.0).into(), Collider::rectangle(2.0, 1.0));
    same(shapes::Capsule2d::new(0.3, 1.0).into(), Collider::capsule(0.3, 1.0));
    same(shapes::RegularPolygon::new(0.7, 6).into(), Collider::regular_polygon(0.7, 6));
    let (a, b, c) = (Vec2::ZERO, Vec2::X, Vec2::Y);
    same(shapes::Triangle2d::new(a, b, c).into(), Collider::triangle(a, b, c));
    same(shapes::Segment2d::new(a, b).into(), Collider::segment(a, b));
    let bounds = Collider::from(shapes::Rhombus::new(2.0, 1.0)).shape().compute_local_aabb();
    assert!((bounds.maxs - Vector::new(1.0, 0.5)).length() < 1e-6);
}

/// The snippets verbatim, except that items used from outside are public.
mod as_written {
    pub mod length_unit {
        use avian2d::prelude::*;
        use bevy::prelude::*;

        pub fn main() {
            App::new()
                .add_plugins((
                    DefaultPlugins,
                    // A 2D game with 10 pixels per meter
                    PhysicsPlugins::default().with_length_unit(10.0),
                ))
                .run();
        }
    }

    pub mod rotation {
        use avian2d::prelude::*;
        use bevy::prelude::*;

        pub fn main() {
            let rotation = Rotation::degrees(45.0);
            assert_eq!(rotation * rotation * Vec2::X, Vec2::Y);
        }
    }
}

#[test]
fn its_snippets_run_as_written() {
    // An app without a window is not closed by a user, so it exits after its first frame.
    bevy::app::TerminalCtrlCHandlerPlugin::gracefully_exit();
    as_written::length_unit::main();
    as_written::rotation::main();
}
