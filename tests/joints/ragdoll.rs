//! Ragdolls: whole, calm, within their limits, and driven to a pose.

use super::*;
use crate::joints_dim::{anchors, bend, bone_turn, swing_beyond};

fn spawn(rig: &mut Rig, human: HumanRagdoll, at: Transform) -> Ragdoll {
    let ragdoll = human.spawn(&mut rig.app.world_mut().commands(), at);
    rig.app.world_mut().flush();
    ragdoll
}

/// How far the joint of a bone is open, in m.
fn gap(rig: &Rig, ragdoll: &Ragdoll, bone: Bone) -> Scalar {
    let (Some(joint), Some(parent)) = (ragdoll.joint(bone), bone.parent()) else { return 0.0 };
    let [anchor1, anchor2] = anchors(rig, joint);
    let at = |body: Entity, anchor: Vector| rig.place(body) + *rig.get::<Rotation>(body) * anchor;
    (at(ragdoll.bone(parent), anchor1) - at(ragdoll.bone(bone), anchor2)).length()
}

#[test]
fn a_ragdoll_weighs_what_it_should_and_stands_on_its_feet() {
    for (height, mass) in [(1.8, 75.0), (0.6, 12.0)] {
        let mut rig = Rig::new();
        let human = HumanRagdoll::default().with_height(height).with_mass(mass);
        let ragdoll = spawn(&mut rig, human, Transform::from_xyz(1.0, 2.0, 0.0));
        rig.step();
        let all: f32 =
            Bone::ALL.iter().map(|bone| rig.get::<ComputedMass>(ragdoll.bone(*bone)).value() as f32).sum();
        assert!((all - mass as f32).abs() < 1e-3 * mass as f32, "{all} kg");
        assert!(rig.app.world().get::<Ragdoll>(ragdoll.bone(Bone::Pelvis)) == Some(&ragdoll));
        let low = Bone::ALL.iter().map(|bone| rig.get::<ColliderAabb>(ragdoll.bone(*bone)).min.y);
        let high = Bone::ALL.iter().map(|bone| rig.get::<ColliderAabb>(ragdoll.bone(*bone)).max.y);
        let tall = high.fold(Scalar::MIN, Scalar::max) - low.fold(Scalar::MAX, Scalar::min);
        assert!((tall - height).abs() < 0.05 * height, "{tall} m");
        assert_eq!(ragdoll.entities().count(), 21);
        ragdoll.entities().collect::<Vec<_>>().into_iter().for_each(|entity| rig.despawn(entity));
        rig.step();
    }
}

#[test]
fn ragdolls_that_fall_stay_whole_and_fall_asleep() {
    let mut rig = Rig::new();
    rig.spawn((RigidBody::Static, Collider::half_space(Vector::Y), at(0.0, 0.0)));
    let ragdolls: Vec<Ragdoll> = (0..4)
        .map(|i| {
            let turn = Quat::from_rotation_z(0.7 * i as f32);
            let place = Transform::from_xyz(3.0 * i as f32, 1.5 + 0.8 * i as f32, 0.0).with_rotation(turn);
            spawn(&mut rig, HumanRagdoll::default(), place)
        })
        .collect();
    rig.steps(640);
    for (ragdoll, bone) in ragdolls.iter().flat_map(|ragdoll| Bone::ALL.map(|bone| (ragdoll, bone))) {
        let gap = gap(&rig, ragdoll, bone);
        assert!(gap < 0.01, "{bone:?}: {gap} m");
        let beyond = swing_beyond(&rig, ragdoll, bone);
        assert!(beyond < 0.035, "{bone:?}: {beyond} rad beyond its limit");
        let velocity = rig.get::<LinearVelocity>(ragdoll.bone(bone));
        assert!(rig.sleeps(ragdoll.bone(bone)), "{bone:?} is awake: {velocity:?}");
    }
}

#[test]
fn a_driven_ragdoll_takes_the_pose_that_is_set() {
    let mut rig = Rig::weightless();
    let motor = AngularMotor::new(MotorModel::SpringDamper { frequency: 3.0, damping_ratio: 1.0 });
    let ragdoll = spawn(&mut rig, HumanRagdoll::default().with_drive(motor), Transform::default());
    rig.steps(64);
    for bone in Bone::ALL {
        assert!(bone_turn(&rig, &ragdoll, bone) < 0.01, "{bone:?} keeps the pose of its spawn");
    }
    let bent = [(Bone::RightUpperArm, 1.0), (Bone::LeftForearm, 0.8), (Bone::RightThigh, 0.4)];
    let targets = bent.map(|(bone, angle)| (bone, bend(bone, angle)));
    let named = ragdoll.clone();
    let set = move |mut joints: RagdollJoints| {
        for (bone, target) in targets {
            joints.set_target(&named, bone, target);
        }
    };
    rig.app.add_systems(PreUpdate, set);
    rig.steps(192);
    for (bone, angle) in bent {
        let turn = bone_turn(&rig, &ragdoll, bone);
        assert!((turn - angle).abs() < 0.02, "{bone:?}: {turn} rad");
    }
}

#[test]
fn measures_that_are_no_measures_become_the_default() {
    let mut rig = Rig::new();
    for wrong in [0.0, -1.0, Scalar::NAN, Scalar::INFINITY] {
        let human = HumanRagdoll::default().with_height(wrong).with_mass(wrong);
        let ragdoll = spawn(&mut rig, human, Transform::from_xyz(0.0, 2.0, 0.0));
        rig.steps(2);
        let mass = rig.get::<ComputedMass>(ragdoll.bone(Bone::Pelvis)).value();
        assert!((mass as f32 - 0.142 * 75.0).abs() < 0.01, "{wrong}: {mass} kg");
        ragdoll.entities().collect::<Vec<_>>().into_iter().for_each(|entity| rig.despawn(entity));
    }
}
