//! Measures the final state of a world, with parry's contact query on the scene's shapes for every engine.

use std::collections::HashSet;

use crate::{
    measure::Quality,
    scene::Scene,
    world::{Dimension, Group, Kind, State, distance},
};

/// A shape at its final pose.
struct Item<D: Dimension> {
    body: usize,
    pose: D::Pose,
    solid: D::Solid,
    low: D::Vec,
    high: D::Vec,
}

/// Shapes wider than this, in metres, would make a plain sweep quadratic: they are swept against
/// everything once.
const WIDE: f32 = 10.0;

/// Measures the final state.
pub(crate) fn judge<D: Dimension>(scene: &Scene<D>, states: &[State<D>], awake: usize) -> Quality {
    let mut quality = Quality { awake, ..Default::default() };
    let mut items = Vec::new();
    for (index, (body, state)) in scene.bodies.iter().zip(states).enumerate() {
        let numbers = state.pos.as_ref().iter().chain(state.vel.as_ref());
        if !(numbers.clone().all(|x| x.is_finite()) && D::is_finite(state.turn)) {
            quality.not_finite += 1;
            continue;
        }
        if body.kind == Kind::Dynamic {
            judge_motion(scene, state, &mut quality);
        }
        if scene.watch == Some(index) {
            quality.drift = Some(distance::<D>(state.pos, body.pos));
        }
        let pose = D::pose(state.pos, state.turn);
        items.extend(body.parts.iter().map(|part| {
            let (pose, solid) = (pose * D::pose(part.pos, part.turn), D::solid(&part.shape));
            let (low, high) = D::bounds(&solid, &pose);
            Item { body: index, pose, solid, low, high }
        }));
    }
    quality.mean_speed /= quality.dynamic.max(1) as f32;
    judge_overlap(scene, items, &mut quality);
    for joint in &scene.joints {
        let at = |body: usize, local| D::point(&D::pose(states[body].pos, states[body].turn), local);
        let error = distance::<D>(at(joint.a, joint.anchor_a), at(joint.b, joint.anchor_b));
        quality.max_joint_error = quality.max_joint_error.max(error);
    }
    quality
}

fn judge_motion<D: Dimension>(scene: &Scene<D>, state: &State<D>, quality: &mut Quality) {
    let speed = distance::<D>(state.vel, D::ZERO);
    quality.max_speed = quality.max_speed.max(speed);
    quality.mean_speed += speed;
    let (low, high) = (scene.bounds.0.as_ref(), scene.bounds.1.as_ref());
    let inside = state.pos.as_ref().iter().zip(low).zip(high).all(|((x, low), high)| low <= x && x <= high);
    quality.escaped += usize::from(!inside);
    quality.dynamic += 1;
}

/// Sweeps along x.
fn judge_overlap<D: Dimension>(scene: &Scene<D>, mut items: Vec<Item<D>>, quality: &mut Quality) {
    let x = |v: &D::Vec| v.as_ref()[0];
    items.sort_by(|a, b| x(&a.low).total_cmp(&x(&b.low)));
    let joined: HashSet<(usize, usize)> = scene.joints.iter().map(|j| (j.a.min(j.b), j.a.max(j.b))).collect();
    let mut depths = Vec::new();
    let mut test = |a: &Item<D>, b: &Item<D>| {
        let pair = (a.body.min(b.body), a.body.max(b.body));
        if may_touch(scene, pair) && boxes_meet(a, b) && !joined.contains(&pair) {
            depths.push(D::depth((&a.solid, &a.pose), (&b.solid, &b.pose)));
        }
    };
    let (wide, narrow): (Vec<_>, Vec<_>) = items.iter().partition(|i| x(&i.high) - x(&i.low) > WIDE);
    for (index, a) in narrow.iter().enumerate() {
        narrow[index + 1..].iter().take_while(|b| x(&b.low) <= x(&a.high)).for_each(|b| test(a, b));
    }
    for (index, a) in wide.iter().enumerate() {
        narrow.iter().chain(&wide[index + 1..]).for_each(|b| test(a, b));
    }
    depths.retain(|depth| *depth > 0.0);
    quality.overlaps = depths.len();
    quality.max_overlap = depths.iter().copied().fold(0.0, f32::max);
    let sum = depths.iter().fold(0.0, |sum, depth| sum + *depth as f64);
    quality.mean_overlap = (sum / depths.len().max(1) as f64) as f32;
}

fn may_touch<D: Dimension>(scene: &Scene<D>, (a, b): (usize, usize)) -> bool {
    let (first, second) = (&scene.bodies[a], &scene.bodies[b]);
    let moves = first.kind == Kind::Dynamic || second.kind == Kind::Dynamic;
    let apart = first.group == Group::NotEachOther && second.group == Group::NotEachOther;
    a != b && moves && !apart
}

fn boxes_meet<D: Dimension>(a: &Item<D>, b: &Item<D>) -> bool {
    let below = |low: &D::Vec, high: &D::Vec| low.as_ref().iter().zip(high.as_ref()).all(|(l, h)| l <= h);
    below(&a.low, &b.high) && below(&b.low, &a.high)
}
