//! Settings of debug rendering.

use bevy_color::{Color, palettes::css};
use bevy_ecs::prelude::*;
use bevy_gizmos::config::GizmoConfigGroup;
use bevy_reflect::prelude::*;

use crate::math::{Scalar, Vector};

/// The settings of [`PhysicsDebugPlugin`](super::PhysicsDebugPlugin), a group of gizmos. A field that is
/// `None` is not drawn.
///
/// Change the settings in the `GizmoConfigStore`, or insert them when the app is built. The config of the
/// group enables or disables all drawing, and has the width of lines.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::prelude::*;
/// # use bevy_color::Color;
/// # use bevy_ecs::prelude::*;
/// # use bevy_gizmos::prelude::*;
/// fn build(app: &mut App) {
///     app.add_plugins(PhysicsDebugPlugin).insert_gizmo_config(
///         PhysicsGizmos::default().with_aabb_color(Color::WHITE).without_axes(),
///         GizmoConfig::default(),
///     );
/// }
///
/// fn toggle(mut store: ResMut<GizmoConfigStore>) {
///     let (config, _gizmos) = store.config_mut::<PhysicsGizmos>();
///     config.enabled = !config.enabled;
/// }
/// ```
///
/// Lengths are in metres, and are multiplied by the [`PhysicsLengthUnit`](crate::prelude::PhysicsLengthUnit).
#[derive(Reflect, GizmoConfigGroup)]
pub struct PhysicsGizmos {
    /// Lengths of the axes drawn at the centre of mass of bodies. 0.5 by default.
    pub axis_lengths: Option<Vector>,
    /// Color of the bounding boxes of colliders. Not drawn by default.
    pub aabb_color: Option<Color>,
    /// Color of the outlines of colliders. Orange by default. The next three fields replace it for their
    /// kinds of colliders, so that by default only colliders of dynamic bodies have it.
    pub collider_color: Option<Color>,
    /// Color of the outlines on kinematic bodies, instead of [`collider_color`](Self::collider_color).
    /// Blue by default.
    pub kinematic_color: Option<Color>,
    /// Color of the outlines on static bodies, and of colliders without a body. Gray by default.
    pub static_color: Option<Color>,
    /// Color of the outlines of sensors, on any kind of body. Green by default.
    pub sensor_color: Option<Color>,
    /// Factors of hue, saturation, lightness and alpha for colors of sleeping bodies. `[1.0, 1.0, 0.4, 1.0]`
    /// by default: they are darker.
    pub sleeping_color_multiplier: Option<[f32; 4]>,
    /// Color of contact points. Not drawn by default.
    pub contact_point_color: Option<Color>,
    /// Color of contact normals. Not drawn by default.
    pub contact_normal_color: Option<Color>,
    /// Length of contact normals.
    pub contact_normal_scale: ContactGizmoScale,
    /// Maximum length of normals drawn with [`ContactGizmoScale::Scaled`]. 1 by default: the load of a large
    /// body would extend beyond the picture.
    pub max_contact_normal_length: Option<Scalar>,
    /// Color of the lines from bodies to the anchors of joints. Pink by default.
    pub joint_anchor_color: Option<Color>,
    /// Color of the lines between the anchors of joints. Red by default.
    pub joint_separation_color: Option<Color>,
    /// Color of the rays of ray casters. Red by default.
    pub raycast_color: Option<Color>,
    /// Color of the hit points of ray casters. Yellow by default.
    pub raycast_point_color: Option<Color>,
    /// Color of the hit normals of ray casters. Pink by default.
    pub raycast_normal_color: Option<Color>,
    /// Color of the path of shape casters. Red by default.
    pub shapecast_color: Option<Color>,
    /// Color of the shapes of shape casters, at the origin and at hits. Light blue by default.
    pub shapecast_shape_color: Option<Color>,
    /// Color of the hit points of shape casters. Yellow by default.
    pub shapecast_point_color: Option<Color>,
    /// Color of the hit normals of shape casters. Pink by default.
    pub shapecast_normal_color: Option<Color>,
    /// Color of the boxes around simulation islands. Not drawn by default.
    pub island_color: Option<Color>,
    /// Color of the boxes of the collider trees. Not drawn by default.
    pub collider_tree_color: Option<Color>,
    /// Whether the meshes of bodies and colliders are hidden. False by default.
    pub hide_meshes: bool,
}

/// The length of a drawn contact normal.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
pub enum ContactGizmoScale {
    /// The same for all, in metres.
    Constant(Scalar),
    /// In metres per newton of the contact's force.
    Scaled(Scalar),
}

impl Default for ContactGizmoScale {
    fn default() -> Self {
        Self::Scaled(0.025)
    }
}

const AXES: Vector = Vector::splat(0.5);
const SLEEPING: [f32; 4] = [1.0, 1.0, 0.4, 1.0];

impl Default for PhysicsGizmos {
    fn default() -> Self {
        Self {
            axis_lengths: Some(AXES),
            collider_color: Some(css::ORANGE.into()),
            kinematic_color: Some(css::CORNFLOWER_BLUE.into()),
            static_color: Some(css::GRAY.into()),
            sensor_color: Some(css::LIMEGREEN.into()),
            sleeping_color_multiplier: Some(SLEEPING),
            joint_anchor_color: Some(css::PINK.into()),
            joint_separation_color: Some(css::RED.into()),
            raycast_color: Some(css::RED.into()),
            raycast_point_color: Some(css::YELLOW.into()),
            raycast_normal_color: Some(css::PINK.into()),
            shapecast_color: Some(css::RED.into()),
            shapecast_shape_color: Some(Color::srgb(0.4, 0.6, 1.0)),
            shapecast_point_color: Some(css::YELLOW.into()),
            shapecast_normal_color: Some(css::PINK.into()),
            ..Self::none()
        }
    }
}

impl PhysicsGizmos {
    /// Draws everything, and hides meshes.
    pub fn all() -> Self {
        Self {
            aabb_color: Some(Color::srgb(0.8, 0.8, 0.8)),
            contact_point_color: Some(css::LIGHT_CYAN.into()),
            contact_normal_color: Some(css::RED.into()),
            island_color: Some(css::LIGHT_GREEN.into()),
            collider_tree_color: Some(Color::srgb(0.35, 0.4, 0.6)),
            hide_meshes: true,
            ..Self::default()
        }
    }

    /// Draws nothing.
    pub fn none() -> Self {
        Self {
            axis_lengths: None,
            aabb_color: None,
            collider_color: None,
            kinematic_color: None,
            static_color: None,
            sensor_color: None,
            sleeping_color_multiplier: None,
            contact_point_color: None,
            contact_normal_color: None,
            contact_normal_scale: ContactGizmoScale::default(),
            max_contact_normal_length: Some(1.0),
            joint_anchor_color: None,
            joint_separation_color: None,
            raycast_color: None,
            raycast_point_color: None,
            raycast_normal_color: None,
            shapecast_color: None,
            shapecast_shape_color: None,
            shapecast_point_color: None,
            shapecast_normal_color: None,
            island_color: None,
            collider_tree_color: None,
            hide_meshes: false,
        }
    }

    /// Draws only the axes of bodies.
    pub fn axes(axis_lengths: Vector) -> Self {
        Self::none().with_axes(axis_lengths)
    }

    /// Draws only bounding boxes.
    pub fn aabbs(color: Color) -> Self {
        Self::none().with_aabb_color(color)
    }

    /// Draws only the outlines of colliders.
    pub fn colliders(color: Color) -> Self {
        Self::none().with_collider_color(color)
    }

    /// Draws only contact points.
    pub fn contact_points(color: Color) -> Self {
        Self::none().with_contact_point_color(color)
    }

    /// Draws only contact normals.
    pub fn contact_normals(color: Color) -> Self {
        Self::none().with_contact_normal_color(color)
    }

    /// Draws only joints.
    pub fn joints(anchor_color: Option<Color>, separation_color: Option<Color>) -> Self {
        Self { joint_anchor_color: anchor_color, joint_separation_color: separation_color, ..Self::none() }
    }

    /// Draws axes of these lengths.
    pub fn with_axes(mut self, axis_lengths: Vector) -> Self {
        self.axis_lengths = Some(axis_lengths);
        self
    }

    /// Draws bounding boxes.
    pub fn with_aabb_color(mut self, color: Color) -> Self {
        self.aabb_color = Some(color);
        self
    }

    /// Draws the outlines of all colliders in one color.
    pub fn with_collider_color(self, color: Color) -> Self {
        Self { collider_color: Some(color), ..self }.with_kind_colors(None, None, None)
    }

    /// Sets the colors of outlines on kinematic bodies, on static bodies and of sensors. `None` uses the
    /// color of all other colliders.
    pub fn with_kind_colors(
        mut self,
        kinematic: Option<Color>,
        fixed: Option<Color>,
        sensor: Option<Color>,
    ) -> Self {
        self.kinematic_color = kinematic;
        self.static_color = fixed;
        self.sensor_color = sensor;
        self
    }

    /// Sets the factors for colors of sleeping bodies.
    pub fn with_sleeping_color_multiplier(mut self, color_multiplier: [f32; 4]) -> Self {
        self.sleeping_color_multiplier = Some(color_multiplier);
        self
    }

    /// Draws contact points.
    pub fn with_contact_point_color(mut self, color: Color) -> Self {
        self.contact_point_color = Some(color);
        self
    }

    /// Draws contact normals.
    pub fn with_contact_normal_color(mut self, color: Color) -> Self {
        self.contact_normal_color = Some(color);
        self
    }

    /// Sets the length of contact normals.
    pub fn with_contact_normal_scale(mut self, scale: ContactGizmoScale) -> Self {
        self.contact_normal_scale = scale;
        self
    }

    /// Sets the maximum length of normals scaled by force, in metres. `None` is no limit.
    pub fn with_max_contact_normal_length(mut self, length: Option<Scalar>) -> Self {
        self.max_contact_normal_length = length;
        self
    }

    /// The default with these colors of joints. Not a method, as in Avian 0.7.
    pub fn with_joint_colors(anchor_color: Option<Color>, separation_color: Option<Color>) -> Self {
        Self { joint_anchor_color: anchor_color, joint_separation_color: separation_color, ..Self::default() }
    }

    /// Sets the colors of ray casters.
    pub fn with_raycast_colors(
        mut self,
        ray: Option<Color>,
        hit_point: Option<Color>,
        hit_normal: Option<Color>,
    ) -> Self {
        self.raycast_color = ray;
        self.raycast_point_color = hit_point;
        self.raycast_normal_color = hit_normal;
        self
    }

    /// Sets the colors of shape casters.
    pub fn with_shapecast_colors(
        mut self,
        ray: Option<Color>,
        shape: Option<Color>,
        hit_point: Option<Color>,
        hit_normal: Option<Color>,
    ) -> Self {
        self.shapecast_color = ray;
        self.shapecast_shape_color = shape;
        self.shapecast_point_color = hit_point;
        self.shapecast_normal_color = hit_normal;
        self
    }

    /// Shows or hides meshes.
    pub fn with_mesh_visibility(mut self, is_visible: bool) -> Self {
        self.hide_meshes = !is_visible;
        self
    }

    /// Draws no axes.
    pub fn without_axes(mut self) -> Self {
        self.axis_lengths = None;
        self
    }

    /// Draws no bounding boxes.
    pub fn without_aabbs(mut self) -> Self {
        self.aabb_color = None;
        self
    }

    /// Draws no outlines of colliders.
    pub fn without_colliders(mut self) -> Self {
        self.collider_color = None;
        self
    }

    /// Draws no contact points.
    pub fn without_contact_points(mut self) -> Self {
        self.contact_point_color = None;
        self
    }

    /// Draws no contact normals.
    pub fn without_contact_normals(mut self) -> Self {
        self.contact_normal_color = None;
        self
    }

    /// Draws no joints.
    pub fn without_joints(mut self) -> Self {
        self.joint_anchor_color = None;
        self.joint_separation_color = None;
        self
    }

    /// Draws no ray casters.
    pub fn without_raycasts(self) -> Self {
        self.with_raycast_colors(None, None, None)
    }

    /// Draws no shape casters.
    pub fn without_shapecasts(self) -> Self {
        self.with_shapecast_colors(None, None, None, None)
    }
}

/// The drawing of one body or collider, instead of [`PhysicsGizmos`].
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_color::Color;
/// # use bevy_ecs::prelude::*;
/// fn setup(mut commands: Commands) {
///     commands.spawn((
///         RigidBody::Dynamic,
///         Collider::default(),
///         DebugRender::default().with_collider_color(Color::srgb(0.0, 1.0, 0.0)).without_axes(),
///     ));
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Debug, Default, PartialEq)]
pub struct DebugRender {
    /// Lengths of the axes drawn at the centre of mass. 0.5 by default.
    pub axis_lengths: Option<Vector>,
    /// Color of the bounding box. Not drawn by default.
    pub aabb_color: Option<Color>,
    /// Color of the outline. Orange by default.
    pub collider_color: Option<Color>,
    /// Factors of hue, saturation, lightness and alpha while the body sleeps.
    /// `[1.0, 1.0, 0.4, 1.0]` by default.
    pub sleeping_color_multiplier: Option<[f32; 4]>,
    /// Whether the mesh of the entity is hidden. False by default.
    pub hide_mesh: bool,
}

impl Default for DebugRender {
    fn default() -> Self {
        Self {
            axis_lengths: Some(AXES),
            aabb_color: None,
            collider_color: Some(css::ORANGE.into()),
            sleeping_color_multiplier: Some(SLEEPING),
            hide_mesh: false,
        }
    }
}

impl DebugRender {
    /// Draws everything, and hides the mesh.
    pub fn all() -> Self {
        Self { aabb_color: Some(Color::srgb(0.8, 0.8, 0.8)), hide_mesh: true, ..Self::default() }
    }

    /// Draws nothing.
    pub fn none() -> Self {
        Self {
            axis_lengths: None,
            aabb_color: None,
            collider_color: None,
            sleeping_color_multiplier: None,
            hide_mesh: false,
        }
    }

    /// Draws only the axes.
    pub fn axes(axis_lengths: Vector) -> Self {
        Self::none().with_axes(axis_lengths)
    }

    /// Draws only the bounding box.
    pub fn aabb(color: Color) -> Self {
        Self::none().with_aabb_color(color)
    }

    /// Draws only the outline.
    pub fn collider(color: Color) -> Self {
        Self::none().with_collider_color(color)
    }

    /// Draws axes of these lengths.
    pub fn with_axes(mut self, axis_lengths: Vector) -> Self {
        self.axis_lengths = Some(axis_lengths);
        self
    }

    /// Draws the bounding box.
    pub fn with_aabb_color(mut self, color: Color) -> Self {
        self.aabb_color = Some(color);
        self
    }

    /// Draws the outline.
    pub fn with_collider_color(mut self, color: Color) -> Self {
        self.collider_color = Some(color);
        self
    }

    /// Sets the factors for colors while the body sleeps.
    pub fn with_sleeping_color_multiplier(mut self, color_multiplier: [f32; 4]) -> Self {
        self.sleeping_color_multiplier = Some(color_multiplier);
        self
    }

    /// Shows or hides the mesh.
    pub fn with_mesh_visibility(mut self, is_visible: bool) -> Self {
        self.hide_mesh = !is_visible;
        self
    }

    /// Draws no axes.
    pub fn without_axes(mut self) -> Self {
        self.axis_lengths = None;
        self
    }

    /// Draws no bounding box.
    pub fn without_aabb(mut self) -> Self {
        self.aabb_color = None;
        self
    }

    /// Draws no outline.
    pub fn without_collider(mut self) -> Self {
        self.collider_color = None;
        self
    }
}
