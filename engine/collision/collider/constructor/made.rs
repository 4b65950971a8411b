//! What becomes of a constructor.

use crate::collision::collider::{Collider, ColliderError};

/// The result of an attempt to make a collider.
pub(super) enum Made {
    /// It is made.
    Collider(Collider),
    /// It cannot be made: why, to be told, and the constructor is given up.
    Never(String),
    /// Its mesh is being loaded.
    #[cfg(feature = "collider-from-mesh")]
    Later,
    /// It lacks something that the app has to add: what, to be told once.
    #[cfg(feature = "collider-from-mesh")]
    Lacks(&'static str),
}

impl From<Result<Collider, ColliderError>> for Made {
    fn from(result: Result<Collider, ColliderError>) -> Self {
        match result {
            Ok(collider) => Self::Collider(collider),
            Err(error) => Self::Never(error.to_string()),
        }
    }
}
