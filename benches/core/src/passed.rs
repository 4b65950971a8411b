//! Counts the bullets that went through something static, which the state at the end does not show.

use crate::{
    scene::Scene,
    world::{Body, Dimension, Kind, State},
};

/// How far inside something static, in metres, a bullet's centre counts as having passed its surface. No
/// engine leaves one that bounced so deep.
const DEEP: f32 = 0.1;
/// Boxes wider than this, in metres, are tested against every path.
const WIDE: f32 = 10.0;

/// The inside of something static.
struct Inside<D: Dimension> {
    low: D::Vec,
    high: D::Vec,
}

/// Follows the centres of a scene's bullets. A path is straight within a step. Static bodies count as their
/// bounding boxes, which those of upright boxes are.
pub(crate) struct Passed<D: Dimension> {
    /// By the low end in x.
    narrow: Vec<Inside<D>>,
    wide: Vec<Inside<D>>,
    /// Number, centre, and whether it has passed something.
    bullets: Vec<(usize, D::Vec, bool)>,
}

impl<D: Dimension> Passed<D> {
    pub(crate) fn new(scene: &Scene<D>) -> Self {
        let solid = scene.bodies.iter().filter(|body| body.kind == Kind::Static).flat_map(insides);
        let (wide, mut narrow): (Vec<_>, Vec<_>) =
            solid.partition(|inside| inside.high.as_ref()[0] - inside.low.as_ref()[0] > WIDE);
        narrow.sort_by(|a, b| a.low.as_ref()[0].total_cmp(&b.low.as_ref()[0]));
        let bullets = scene.bodies.iter().enumerate().filter(|(_, body)| body.bullet);
        Self { narrow, wide, bullets: bullets.map(|(index, body)| (index, body.pos, false)).collect() }
    }

    /// Takes the state after a step.
    pub(crate) fn look(&mut self, states: &[State<D>]) {
        for (index, before, passed) in &mut self.bullets {
            let now = states[*index].pos;
            let (a, b) = (before.as_ref()[0], now.as_ref()[0]);
            let first = self.narrow.partition_point(|inside| inside.low.as_ref()[0] < a.min(b) - WIDE);
            let near = self.narrow[first..].iter().take_while(|inside| inside.low.as_ref()[0] <= a.max(b));
            *passed |= near.chain(&self.wide).any(|inside| inside.is_crossed(before, &now));
            *before = now;
        }
    }

    /// How many bullets have passed something.
    pub(crate) fn count(&self) -> usize {
        self.bullets.iter().filter(|(.., passed)| *passed).count()
    }
}

/// The boxes around a body's shapes, less the skin. What is thinner has no inside.
fn insides<D: Dimension>(body: &Body<D>) -> impl Iterator<Item = Inside<D>> {
    let pose = D::pose(body.pos, body.turn);
    body.parts.iter().filter_map(move |part| {
        let at = pose * D::pose(part.pos, part.turn);
        let (mut low, mut high) = D::bounds(&D::solid(&part.shape), &at);
        low.as_mut().iter_mut().for_each(|x| *x += DEEP);
        high.as_mut().iter_mut().for_each(|x| *x -= DEEP);
        low.as_ref().iter().zip(high.as_ref()).all(|(low, high)| low < high).then_some(Inside { low, high })
    })
}

impl<D: Dimension> Inside<D> {
    /// Whether a straight path has a point in the box: it is in the slabs of all axes at the same time.
    fn is_crossed(&self, from: &D::Vec, to: &D::Vec) -> bool {
        let (mut enter, mut leave) = (0.0_f32, 1.0_f32);
        let (low, high) = (self.low.as_ref(), self.high.as_ref());
        for (axis, (from, to)) in from.as_ref().iter().zip(to.as_ref()).enumerate() {
            let way = to - from;
            if way == 0.0 {
                if *from < low[axis] || *from > high[axis] {
                    return false;
                }
                continue;
            }
            let (a, b) = ((low[axis] - from) / way, (high[axis] - from) / way);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter <= leave
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        dim2::{Body2, Shape2},
        scene::Plan,
        world::State,
    };

    /// Whether a bullet that moves from one point to another passes a box of 2 m at the origin.
    fn passes(from: [f32; 2], to: [f32; 2]) -> bool {
        let mut scene = Scene::new("a box", Plan::steps(1));
        scene.bodies.push(Body2::fixed([0.0; 2], Shape2::Box(1.0, 1.0)));
        scene.bodies.push(Body2 { bullet: true, ..Body2::dynamic(from, Shape2::Circle(0.05)) });
        let mut passed = Passed::new(&scene);
        let still = |pos| State { pos, turn: 0.0, vel: [0.0; 2] };
        passed.look(&[still([0.0; 2]), still(to)]);
        passed.count() == 1
    }

    #[test]
    fn through_the_box_and_into_it_count() {
        assert!(passes([-5.0, 0.0], [5.0, 0.0]));
        assert!(passes([-2.0, 0.3], [0.0, 0.0]));
        assert!(passes([0.5, 60.0], [0.5, -60.0]));
    }

    #[test]
    fn what_touches_or_misses_does_not_count() {
        assert!(!passes([-5.0, 0.0], [-0.95, 0.0]));
        assert!(!passes([-5.0, 0.0], [-5.0, 0.0]));
        assert!(!passes([-3.0, 0.0], [0.0, 3.0]));
    }
}
