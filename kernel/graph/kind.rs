//! The kinds of constraints between two bodies.

/// Kind of a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ConstraintKind {
    /// A touching contact.
    Contact,
    /// A joint.
    Joint,
    /// A constraint of the embedder.
    Custom,
}

impl ConstraintKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Contact, Self::Joint, Self::Custom];
    /// The number of kinds.
    pub const COUNT: usize = Self::ALL.len();
}

/// A constraint of any kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ConstraintId {
    /// The kind.
    pub kind: ConstraintKind,
    /// The id within the kind.
    pub id: u32,
}

impl ConstraintId {
    /// A contact by its id.
    pub fn contact(id: u32) -> Self {
        Self { kind: ConstraintKind::Contact, id }
    }
}
