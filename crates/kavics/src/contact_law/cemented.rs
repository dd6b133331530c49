//! The bonded contact: normal force, shear force and moment. Bojtár & Bagi (1989), eqs. 20–21.

use super::{
    Cemented, ContactForce, ContactMemory, RelativeDisplacement, Response, Stiffness, shear,
};

impl Cemented {
    /// Force, tangent and secant at `v`:
    ///
    /// ```math
    /// N = k_n v_n + k_{n\varphi} v_\varphi,\quad T = k_t(v_n)\,v_t,\quad M = k_{n\varphi} v_n + k_m v_\varphi
    /// ```
    ///
    /// with the readings of the shear term in `shear.rs`; less what is lost where the bond softens (`softening.rs`).
    pub fn respond(
        &self,
        v: RelativeDisplacement,
        k: &Stiffness,
        memory: &ContactMemory,
    ) -> Response {
        let shear = shear::respond(self.reading, v, k, memory);
        let rotation = v.rotation - memory.rotation_origin;
        // Potential: the thrust's derivative by shear is the shear force's by opening.
        let thrust_by_shear = if shear.thrust == 0.0 {
            0.0
        } else {
            shear.coupling
        };
        let trial = Response {
            force: ContactForce {
                normal: k.normal * v.normal + k.coupling * rotation + shear.thrust,
                shear: shear.force,
                moment: k.coupling * v.normal + k.moment * rotation,
            },
            tangent: [
                [k.normal, thrust_by_shear, k.coupling],
                [shear.coupling, shear.tangent, 0.0],
                [k.coupling, 0.0, k.moment],
            ],
            secant: [
                [k.normal, 0.0, k.coupling],
                [0.0, shear.secant, 0.0],
                [k.coupling, 0.0, k.moment],
            ],
        };
        match &k.softening {
            Some(softening) => softening.soften(&trial, v, k, memory),
            None => trial,
        }
    }
}
