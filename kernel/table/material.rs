//! Coefficients of surfaces, and how the coefficients of two surfaces combine.

/// How two coefficients combine. Of two different rules the greater applies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Combine {
    /// (a + b) / 2.
    #[default]
    Average = 1,
    /// √(a b).
    GeometricMean = 2,
    /// The smaller one.
    Min = 3,
    /// a b.
    Multiply = 4,
    /// The larger one.
    Max = 5,
}

/// A coefficient and how it is combined with another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surface {
    /// The coefficient, at least 0.
    pub coefficient: f32,
    /// The combine rule.
    pub rule: Combine,
}

impl Surface {
    /// The combined coefficient of two surfaces.
    #[inline]
    pub fn mix(self, other: Self) -> f32 {
        let (a, b) = (self.coefficient, other.coefficient);
        match self.rule.max(other.rule) {
            Combine::Average => 0.5 * (a + b),
            Combine::GeometricMean => (a * b).sqrt(),
            Combine::Min => crate::math::min(a, b),
            Combine::Multiply => a * b,
            Combine::Max => crate::math::max(a, b),
        }
    }
}

/// Surface of a collider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Material {
    /// Coefficient of friction.
    pub friction: Surface,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: Surface,
}
