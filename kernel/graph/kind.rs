//! The kinds of constraints between two bodies.

/// What kind a constraint is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ConstraintKind {
    /// A touching contact.
    Contact,
    /// A distance between two points.
    Distance,
}

impl ConstraintKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 2] = [Self::Contact, Self::Distance];
    /// How many kinds there are.
    pub const COUNT: usize = Self::ALL.len();
}

/// A constraint of any kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ConstraintId {
    /// The kind.
    pub kind: ConstraintKind,
    /// The id among those of the kind.
    pub id: u32,
}

impl ConstraintId {
    /// A contact.
    pub fn contact(id: u32) -> Self {
        Self { kind: ConstraintKind::Contact, id }
    }
}
