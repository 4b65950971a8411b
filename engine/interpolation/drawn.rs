//! Keeps physics independent of the eased transforms that are drawn between ticks.
//!
//! Easing overwrites `Transform`, which physics also reads. Before the first tick of a frame, the values of
//! the last tick are restored where the `Transform` still has the bits that easing wrote. All other values
//! were written by the app: they are kept, and easing restarts from them. This is decided for each axis of
//! translation and scale, and for the rotation as a whole. For example, sorting sprites by `z` or pulsing a
//! scale moves no body.

use bevy_app::{App, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_ecs::{
    entity_disabling::Disabled,
    prelude::*,
    query::{Allow, QueryData},
    schedule::{NodeId, SystemKey},
    system::SystemChangeTick,
};
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use bevy_transform_interpolation::{
    LastEasingTick, RotationEasingState, ScaleEasingState, TransformEasingSystems, TranslationEasingState,
};

/// The transforms of an eased entity.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(super) struct Eased {
    /// The transform after the last tick, including later writes of the app.
    tick: Transform,
    /// The transform that easing wrote. Equal to `tick` if nothing is eased.
    drawn: Transform,
}

/// Adds the systems, given the systems of the easing plugin. The easing systems are private, so their own
/// sets order them.
pub(super) fn add_systems(app: &mut App, easing: &[SystemKey]) {
    // Registration fails only if the requirement exists already.
    let _ = app.try_register_required_components::<TranslationEasingState, Eased>();
    let _ = app.try_register_required_components::<RotationEasingState, Eased>();
    let _ = app.try_register_required_components::<ScaleEasingState, Eased>();
    let mut put_back = put_back
        .after(RunFixedMainLoopSystems::BeforeFixedMainLoop)
        .before(RunFixedMainLoopSystems::FixedMainLoop);
    let note_tick = note_tick
        .after(RunFixedMainLoopSystems::FixedMainLoop)
        .before(RunFixedMainLoopSystems::AfterFixedMainLoop);
    // In the set, so that a write by a system ordered after the set counts as a write of the app.
    let mut note_drawn = note_drawn.in_set(TransformEasingSystems::Ease);
    if let Some(graph) = app.get_schedule(RunFixedMainLoop).map(Schedule::graph) {
        let ease = graph.system_sets.get_key(TransformEasingSystems::Ease.intern());
        let eases = |key| {
            ease.is_some_and(|set| graph.hierarchy().contains_edge(NodeId::Set(set), NodeId::System(key)))
        };
        for (key, system, _) in graph.systems.iter() {
            for own_set in system.default_system_sets() {
                if easing.contains(&key) {
                    put_back = put_back.before(own_set);
                }
                if eases(key) {
                    note_drawn = note_drawn.after(own_set);
                }
            }
        }
    }
    app.add_observer(put_back_removed).add_systems(RunFixedMainLoop, (put_back, note_tick, note_drawn));
}

/// An eased entity.
#[derive(QueryData)]
#[query_data(mutable)]
struct Drawn {
    transform: &'static mut Transform,
    eased: &'static Eased,
    translation: Option<&'static mut TranslationEasingState>,
    rotation: Option<&'static mut RotationEasingState>,
    scale: Option<&'static mut ScaleEasingState>,
}

impl DrawnItem<'_, '_> {
    /// Restores the transform of the last tick, as described in the module.
    fn put_back(mut self) {
        let Eased { tick, drawn } = self.eased;
        let mut now = *self.transform;
        if let Some(mut state) = self.translation {
            let TranslationEasingState { start, end } = &mut *state;
            put_back_axes(&mut now.translation, tick.translation, drawn.translation, [start, end]);
        }
        if let Some(mut state) = self.rotation {
            if now.rotation.to_array().map(f32::to_bits) == drawn.rotation.to_array().map(f32::to_bits) {
                now.rotation = tick.rotation;
            } else {
                (state.start, state.end) = (None, None);
            }
        }
        if let Some(mut state) = self.scale {
            let ScaleEasingState { start, end } = &mut *state;
            put_back_axes(&mut now.scale, tick.scale, drawn.scale, [start, end]);
        }
        self.transform.set_if_neq(now);
    }
}

/// Restores the tick's values on axes that still have the drawn bits. On the other axes, both ends of easing
/// become the app's value.
fn put_back_axes(now: &mut Vec3, tick: Vec3, drawn: Vec3, mut ends: [&mut Option<Vec3>; 2]) {
    for axis in 0..3 {
        if now[axis].to_bits() == drawn[axis].to_bits() {
            now[axis] = tick[axis];
        } else {
            ends.iter_mut().filter_map(|end| end.as_mut()).for_each(|end| end[axis] = now[axis]);
        }
    }
}

/// Restores transforms before the ticks of a frame.
fn put_back(
    mut eased: Query<Drawn, Allow<Disabled>>,
    last: Option<ResMut<LastEasingTick>>,
    system: SystemChangeTick,
) {
    eased.par_iter_mut().for_each(DrawnItem::put_back);
    // Easing stops for transforms that changed since this tick, whatever their new value.
    if let Some(mut last) = last {
        **last = system.this_run();
    }
}

/// Restores the transform of an entity that loses easing.
fn put_back_removed(removed: On<Remove, Eased>, mut eased: Query<Drawn, Allow<Disabled>>) {
    if let Ok(drawn) = eased.get_mut(removed.event_target()) {
        drawn.put_back();
    }
}

/// Records the transforms after the last tick.
fn note_tick(mut eased: Query<(&Transform, &mut Eased)>) {
    eased.par_iter_mut().for_each(|(transform, mut eased)| eased.tick = *transform);
}

/// Records the transforms that easing wrote. Axes that do not move keep their exact values.
fn note_drawn(
    mut eased: Query<(
        &mut Transform,
        &mut Eased,
        Option<&TranslationEasingState>,
        Option<&RotationEasingState>,
        Option<&ScaleEasingState>,
    )>,
) {
    eased.par_iter_mut().for_each(|(mut transform, mut eased, translation, rotation, scale)| {
        let mut drawn = *transform;
        if let Some(state) = translation {
            keep_still(&mut drawn.translation, state.start, state.end);
        }
        if let Some(state) = scale {
            keep_still(&mut drawn.scale, state.start, state.end);
        }
        if let Some(RotationEasingState { start: Some(start), end: Some(end) }) = rotation
            && start == end
        {
            drawn.rotation = *end;
        }
        transform.set_if_neq(drawn);
        eased.drawn = *transform;
    });
}

/// Undoes the effect of easing on axes with equal ends: rounding, and with velocities a curve.
fn keep_still(drawn: &mut Vec3, start: Option<Vec3>, end: Option<Vec3>) {
    let (Some(start), Some(end)) = (start, end) else { return };
    for axis in (0..3).filter(|&axis| start[axis] == end[axis]) {
        drawn[axis] = end[axis];
    }
}
