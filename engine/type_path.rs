//! Type paths of the engine's types in scenes and other files.
//!
//! A reflected type is named by its module path. If a file here is at another path than Avian's module, the
//! type has Avian's path. Files written for Avian then still name it.

/// Implements `TypePath` for a type whose module path differs from its file.
///
/// The type derives `Reflect` with `#[reflect(type_path = false)]`. The module is given without the crate
/// name, which differs between the dimensions.
macro_rules! type_path {
    ($type:ident, $module:literal) => {
        impl bevy_reflect::TypePath for $type {
            fn type_path() -> &'static str {
                concat!(env!("CARGO_CRATE_NAME"), "::", $module, "::", stringify!($type))
            }

            fn short_type_path() -> &'static str {
                stringify!($type)
            }

            fn type_ident() -> Option<&'static str> {
                Some(stringify!($type))
            }

            fn crate_name() -> Option<&'static str> {
                Some(env!("CARGO_CRATE_NAME"))
            }

            fn module_path() -> Option<&'static str> {
                Some(concat!(env!("CARGO_CRATE_NAME"), "::", $module))
            }
        }
    };
}

pub(crate) use type_path;
