//! The list of all kinds of joints. Queries, filters and visitors are generated from it.

/// Defines the types and functions over all kinds of joints from one list of names and components.
macro_rules! joint_kinds {
    ($($name:ident: $joint:ident),+ $(,)?) => {
        /// Visits each kind of joint.
        pub(crate) fn each_kind(visitor: &mut impl $crate::dynamics::joints::kind::KindVisitor) {
            $(visitor.visit::<$joint>();)+
        }

        /// Registers each kind of joint for reflection.
        pub(crate) fn register_kinds(app: &mut bevy_app::App) {
            $(app.register_type::<$joint>();)+
        }

        /// All kinds of joints.
        pub(crate) type Kinds = ($($joint,)+);

        /// The filter for entities with a joint.
        pub(crate) type IsJoint = bevy_ecs::query::Or<($(bevy_ecs::query::With<$joint>,)+)>;

        /// The joint of an entity.
        #[derive(bevy_ecs::query::QueryData)]
        #[query_data(mutable)]
        pub(crate) struct AnyJoint {
            $($name: Option<&'static mut $joint>,)+
        }

        impl AnyJointItem<'_, '_> {
            /// The joint. If the entity temporarily has several joints, the first.
            pub(crate) fn joint(&mut self) -> Option<&mut dyn $crate::dynamics::joints::kind::JointMut> {
                $(if let Some(joint) = &mut self.$name {
                    return Some(joint);
                })+
                None
            }
        }

        /// Queries for joints that changed.
        #[derive(bevy_ecs::system::SystemParam)]
        pub(crate) struct ChangedJoints<'w, 's> {
            $($name: bevy_ecs::system::Query<
                'w,
                's,
                (bevy_ecs::entity::Entity, bevy_ecs::change_detection::Ref<'static, $joint>),
            >,)+
        }

        impl ChangedJoints<'_, '_> {
            /// Calls `found` with each entity whose joint changed.
            pub(crate) fn each(
                &self,
                since: $crate::scan::Since,
                mut found: impl FnMut(bevy_ecs::entity::Entity),
            ) {
                $($crate::dynamics::joints::changes::each_changed(&self.$name, since, &mut found);)+
            }
        }
    };
}

pub(super) use joint_kinds;
