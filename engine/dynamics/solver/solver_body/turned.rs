//! In 3D the inertia of a body rotates with the body.

use super::{dim::locked_inertia, inertia::SolverBodyInertia};
use crate::{dynamics::rigid_body::mass_properties::components::ComputedAngularInertia, math::Quaternion};

impl SolverBodyInertia {
    /// Recomputes the inverse inertia of a body in world axes from its local inverse inertia and a rotation.
    pub fn update_effective_inv_angular_inertia(
        &mut self,
        computed_angular_inertia: &ComputedAngularInertia,
        rotation: Quaternion,
    ) {
        let locks = self.flags().locked_axes().to_kernel();
        self.inv_inertia = locked_inertia(computed_angular_inertia.rotated(rotation).inverse(), locks);
        self.update_flags();
    }
}
