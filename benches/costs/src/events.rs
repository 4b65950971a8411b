//! Collision events.

use avian3d::{prelude::*, schedule::StepTimes};
use bevy::{ecs::system::SystemState, prelude::*};

use crate::world::{boxes, in_turn, median, time};

/// Measures events of pairs that stay, and of pairs that begin and end to touch in each step.
pub fn measure() {
    stay();
    nobody_listens();
    flip();
}

/// Number of touching pairs. From here on the engine stores what `Collisions` shows.
fn touching(app: &mut App) -> usize {
    let mut state = SystemState::<Collisions>::new(app.world_mut());
    let collisions = state.get(app.world_mut()).expect("collisions are there");
    collisions.iter().count()
}

/// Pairs that touch all the time.
fn stay() {
    let mut plain = boxes(5_100, |_| (), || ());
    let mut all = boxes(5_100, |_| (), || (CollisionEventsEnabled, CollidingEntities::default()));
    let times = time([&mut plain, &mut all]);
    let pairs = [&mut plain, &mut all].map(touching);
    let [plain, all] = times;
    println!(
        "events: {pairs:?} touching pairs, a frame where nobody listens {plain:.3}, all listen {:+.3}",
        all - plain
    );
}

/// The share of events in a step without any.
fn nobody_listens() {
    let (mut send, mut link, mut step) = (Vec::new(), Vec::new(), Vec::new());
    let mut app = boxes(5_100, |_| (), || ());
    app.world().resource::<StepTimes>().total();
    in_turn([&mut app], |_, app| {
        app.update();
        let times = app.world().resource::<StepTimes>();
        let part = |name| {
            let part = times.parts().find(|(part, _)| *part == name);
            part.expect("it is a stage").1.as_secs_f64() * 1e3
        };
        send.push(part("SendEvents"));
        link.push(part("LinkContacts"));
        step.push(times.total().as_secs_f64() * 1e3);
    });
    let [send, link, step] = [send, link, step].map(median);
    println!(
        "events: if nobody listens, {send:.4} to send and {link:.4} to link contacts of a step of {step:.3}, {:.2} %",
        100.0 * (send + link) / step
    );
}

/// Boxes that leave the floor in one step and come back in the next.
fn flip() {
    fn flip(mut boxes: Query<&mut Position, With<CollisionMargin>>, mut up: Local<bool>) {
        *up = !*up;
        boxes.iter_mut().for_each(|mut position| position.0.y = if *up { 2.0 } else { 0.5 });
    }
    let system = |app: &mut App| {
        app.add_systems(Update, flip.before(PhysicsSystems::First));
    };
    let mut plain = boxes(1_000, system, || CollisionMargin(0.0));
    let mut all = boxes(1_000, system, || (CollisionMargin(0.0), CollisionEventsEnabled));
    let [plain, all] = time([&mut plain, &mut all]);
    println!(
        "events: 1,000 boxes leave the floor and come back, nobody listens {plain:.3}, all listen {:+.3}",
        all - plain
    );
}
