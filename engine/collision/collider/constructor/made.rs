//! The outcome of a constructor.

use crate::collision::collider::{Collider, ColliderError};

/// The result of an attempt to make a collider.
pub(super) enum Made {
    /// The collider was made.
    Collider(Collider),
    /// The collider cannot be made. The text is the reported reason, and the constructor is removed.
    Never(String),
    /// Its mesh is being loaded.
    #[cfg(feature = "collider-from-mesh")]
    Later,
    /// The entity lacks something that the app has to add. The text is reported once.
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
