//! Sheets that change their volume.
//!
//! A law Ψ(I₁, I₂) of a body that keeps its volume becomes one of a body that resists the change of it with a bulk modulus κ:
//!
//! ```text
//! W = Ψ(Ī₁, Ī₂) + ½ κ (J₃ − 1)²,   J₃ = J λ₃                                     [MPa = mJ/mm³]
//! Ī₁ = J₃^(−⅔) I₁,   Ī₂ = J₃^(−4/3) I₂,   I₁ = tr C + λ₃²,   I₂ = J² + λ₃² tr C           [–]
//! ```
//!
//! C = FᵀF and J = det F are those of the plane. In plane stress the thickness follows from the free surface, and is condensed:
//!
//! ```text
//! P₃₃ = ∂W/∂λ₃ = 0,   ∂P/∂F = W_FF − W_F3 ⊗ W_F3 / W_33                                  [MPa]
//! ```
//!
//! In plane strain λ₃ = 1. At small strain E = 9 κ μ/(3 κ + μ) and ν = (3 κ − 2 μ)/(2 (3 κ + μ)); the law without volume
//! change is the limit κ → ∞ of the sheet in plane stress.
//!
//! Stresses are sums of terms that vanish at rest, and Ī₁ − 3 and Ī₂ − 3 are found from the deviator of C − I, so that no digit
//! is lost at strains of 1e-8.
//!
//! # References
//! P. J. Flory, Trans. Faraday Soc. 57, 829 (1961), doi:10.1039/TF9615700829;
//! J. C. Simo, R. L. Taylor, Comput. Methods Appl. Mech. Eng. 85, 273 (1991), doi:10.1016/0045-7825(91)90100-K

use std::sync::Arc;

use nalgebra::{Matrix4, SMatrix, SVector, Vector4};

use super::curve;
use super::invariants::{EnergyDerivatives, Invariants};
use super::law::{HyperelasticLaw, InvariantLaw, TensionResponse};
use super::sheet::{
    Gradient, Kinematics, PlaneState, SheetResponse, cofactor, cofactor_derivative,
};

mod strain;

use strain::BodyStrain;

/// How a material resists a change of its volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// κ in MPa.
    pub bulk_modulus: f64,
    /// What is known of the third direction.
    pub plane: PlaneState,
}

/// A law of invariants as a sheet that changes its volume.
#[derive(Clone, Debug)]
pub struct VolumetricSheet {
    law: Arc<dyn InvariantLaw>,
    volume: Volume,
}

impl Volume {
    /// The same in plane strain.
    #[must_use]
    pub fn in_plane_strain(self) -> Self {
        Self {
            plane: PlaneState::Strain,
            ..self
        }
    }

    /// A law of a body that keeps its volume with this resistance; `None` where it is no law of the invariants I₁ and I₂.
    pub fn of(self, law: Arc<dyn HyperelasticLaw>) -> Option<Arc<dyn HyperelasticLaw>> {
        Some(Arc::new(VolumetricSheet::new(law, self)?))
    }
}

/// κ in MPa of a shear modulus in MPa and Poisson's ratio ν < ½.
///
/// ```text
/// κ = 2 μ (1 + ν)/(3 (1 − 2 ν))
/// ```
pub fn bulk_modulus(shear_modulus: f64, poisson_ratio: f64) -> f64 {
    2.0 * shear_modulus * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio))
}

impl VolumetricSheet {
    /// A law of a body that keeps its volume with its resistance; `None` where it is no law of the invariants I₁ and I₂.
    pub fn new(law: Arc<dyn HyperelasticLaw>, volume: Volume) -> Option<Self> {
        let law = law.of_invariants()?;
        Some(Self { law, volume })
    }

    /// The state of the body in which the sheet's surfaces are as its plane state wants them.
    fn body<'a>(&self, kinematics: &'a Kinematics) -> Body<'a> {
        match self.volume.plane {
            PlaneState::Strain => self.at(kinematics, 0.0),
            PlaneState::Stress => self.at_free_surface(kinematics).0,
        }
    }

    /// The same with the second derivatives of W.
    fn body_with_curvatures<'a>(&self, kinematics: &'a Kinematics) -> (Body<'a>, Curvatures) {
        match self.volume.plane {
            PlaneState::Strain => self.at(kinematics, 0.0).with_curvatures(),
            PlaneState::Stress => self.at_free_surface(kinematics),
        }
    }

    fn at<'a>(&self, kinematics: &'a Kinematics, z: f64) -> Body<'a> {
        let strain = BodyStrain::new(kinematics, z);
        let derivatives = self.law.evaluate(strain.isochoric);
        Body::new(kinematics, strain, derivatives, self.volume.bulk_modulus)
    }

    /// P₃₃ = 0 by Newton's method in λ₃ − 1 within bounds that close in on it, from the thickness without volume change.
    ///
    /// P₃₃ is negative for a vanishing thickness and positive for a large one, so there is a root.
    fn at_free_surface<'a>(&self, kinematics: &'a Kinematics) -> (Body<'a>, Curvatures) {
        const MOST_STEPS: usize = 200;
        let [mut low, mut high] = [-1.0, f64::INFINITY];
        let mut z = -kinematics.area_change / kinematics.area_ratio();
        let (mut body, mut curvatures) = self.at(kinematics, z).with_curvatures();
        for _ in 0..MOST_STEPS {
            let p33 = body.stress[THICKNESS];
            let step = p33 / curvatures[(THICKNESS, THICKNESS)];
            if p33 == 0.0 || step.abs() <= 1e-15 * z.abs() {
                break;
            }
            if p33 < 0.0 {
                low = z;
            } else {
                high = z;
            }
            let newton = z - step;
            z = match newton > low && newton < high {
                true => newton,
                false if high.is_finite() => 0.5 * (low + high),
                false => 1.0 + 2.0 * z,
            };
            (body, curvatures) = self.at(kinematics, z).with_curvatures();
        }
        (body, curvatures)
    }
}

/// Derivatives by F₁₁, F₁₂, F₂₁, F₂₂ and λ₃.
type Slopes = SVector<f64, 5>;
type Curvatures = SMatrix<f64, 5, 5>;

/// The place of λ₃ among them.
const THICKNESS: usize = 4;

fn slopes(plane: Gradient, thickness: f64) -> Slopes {
    plane.push(thickness)
}

/// The body at one point: energy, stress, and what the tangent needs.
struct Body<'a> {
    kinematics: &'a Kinematics,
    strain: BodyStrain,
    derivatives: EnergyDerivatives,
    bulk_modulus: f64,
    energy: f64,
    /// ∂W/∂F and ∂W/∂λ₃ in MPa.
    stress: Slopes,
    /// ∂Ī₁, ∂Ī₂ and ∂J₃.
    slopes: [Slopes; 3],
}

impl<'a> Body<'a> {
    /// ```text
    /// ∂Ī₁ = J₃^(−⅔) (2 (F − λ₃ cof F) + r₁ λ₃ cof F),                    r₁ = ⅔ (3 (J₃ − 1) − (I₁ − 3))/J₃
    /// ∂Ī₂ = J₃^(−4/3) (2 (λ₃² (F − cof F) + (J − 1 + (λ₃ − 1)²) cof F) + r₂ λ₃ cof F),  r₂ = 4/3 (3 (J₃ − 1) − (I₂ − 3))/J₃
    /// ```
    fn new(
        kinematics: &'a Kinematics,
        strain: BodyStrain,
        derivatives: EnergyDerivatives,
        bulk_modulus: f64,
    ) -> Self {
        let (z, j, v) = (strain.z, kinematics.area_change, strain.volume_change);
        let (thickness, volume, trace) = (1.0 + z, 1.0 + v, strain.trace_change);
        let cofactor = cofactor(&kinematics.deformation_gradient);
        let distortion = &kinematics.distortion;
        let of_volume = slopes(thickness * cofactor, 1.0 + j);
        let [i1, i2] = strain.invariants;
        let first = 2.0 * slopes(distortion - z * cofactor, z - j)
            + 2.0 / 3.0 * (3.0 * v - i1) / volume * of_volume;
        let in_plane = thickness * thickness * distortion + (j + z * z) * cofactor;
        let second = 2.0 * slopes(in_plane, trace + 2.0 * z + trace * z - 2.0 * j)
            + 4.0 / 3.0 * (3.0 * v - i2) / volume * of_volume;
        let [a, b] = strain.scales();
        let slopes = [a * first, b * second, of_volume];
        Self {
            energy: derivatives.energy + 0.5 * bulk_modulus * v * v,
            stress: derivatives.d1 * slopes[0]
                + derivatives.d2 * slopes[1]
                + bulk_modulus * v * slopes[2],
            kinematics,
            strain,
            derivatives,
            bulk_modulus,
            slopes,
        }
    }

    /// P = ∂W/∂F in MPa.
    fn in_plane(&self) -> Gradient {
        self.stress.fixed_rows::<4>(0).into_owned()
    }

    /// The second derivatives of W.
    ///
    /// ```text
    /// ∂²Ī₁ = J₃^(−⅔) (∂²I₁ − ⅔ (∂I₁ ⊗ ∂J₃ + ∂J₃ ⊗ ∂I₁)/J₃ + 10/9 I₁ ∂J₃ ⊗ ∂J₃/J₃² − ⅔ I₁ ∂²J₃/J₃)
    /// ```
    ///
    /// and the same for Ī₂ with 4/3, 28/9 and 4/3.
    fn second_derivatives(&self) -> Curvatures {
        let w = &self.derivatives;
        let [g1, g2, gj] = &self.slopes;
        let mixed = g1 * g2.transpose();
        let volumes = gj * gj.transpose();
        let [i1, i2] = self.strain.invariants.map(|change| 3.0 + change);
        let [a, b] = self.strain.scales();
        let volume = 1.0 + self.strain.volume_change;
        let [by_1, by_2] = self.plain_slopes();
        let [of_1, of_2, of_volume] = self.plain_curvatures();
        let isochoric = |plain: &Slopes, curvatures: Curvatures, i: f64, exponent: f64| {
            let mixed = plain * gj.transpose();
            curvatures - (mixed + mixed.transpose()) * (exponent / volume)
                + volumes * (exponent * (exponent + 1.0) * i / (volume * volume))
                - of_volume * (exponent * i / volume)
        };
        g1 * g1.transpose() * w.d11
            + (mixed + mixed.transpose()) * w.d12
            + g2 * g2.transpose() * w.d22
            + isochoric(&by_1, of_1, i1, 2.0 / 3.0) * (w.d1 * a)
            + isochoric(&by_2, of_2, i2, 4.0 / 3.0) * (w.d2 * b)
            + volumes * self.bulk_modulus
            + of_volume * (self.bulk_modulus * self.strain.volume_change)
    }

    /// ∂I₁ and ∂I₂.
    fn plain_slopes(&self) -> [Slopes; 2] {
        let f = &self.kinematics.deformation_gradient;
        let thickness = 1.0 + self.strain.z;
        let area = self.kinematics.area_ratio() * cofactor(f);
        [
            2.0 * slopes(*f, thickness),
            2.0 * slopes(
                area + thickness * thickness * f,
                (2.0 + self.strain.trace_change) * thickness,
            ),
        ]
    }

    /// ∂²I₁, ∂²I₂ and ∂²J₃.
    fn plain_curvatures(&self) -> [Curvatures; 3] {
        let f = &self.kinematics.deformation_gradient;
        let thickness = 1.0 + self.strain.z;
        let cofactor = cofactor(f);
        let curvatures = |plane: Matrix4<f64>, mixed: Gradient, across: f64| {
            let mut all = Curvatures::zeros();
            all.fixed_view_mut::<4, 4>(0, 0).copy_from(&plane);
            all.fixed_view_mut::<4, 1>(0, THICKNESS).copy_from(&mixed);
            all.fixed_view_mut::<1, 4>(THICKNESS, 0)
                .copy_from(&mixed.transpose());
            all[(THICKNESS, THICKNESS)] = across;
            all
        };
        let second = cofactor * cofactor.transpose()
            + cofactor_derivative() * self.kinematics.area_ratio()
            + Matrix4::identity() * (thickness * thickness);
        [
            2.0 * Curvatures::identity(),
            2.0 * curvatures(second, 2.0 * thickness * f, 2.0 + self.strain.trace_change),
            curvatures(cofactor_derivative() * thickness, cofactor, 0.0),
        ]
    }

    fn with_curvatures(self) -> (Self, Curvatures) {
        let curvatures = self.second_derivatives();
        (self, curvatures)
    }
}

/// ∂²W/∂F², ∂²W/∂F∂λ₃ and ∂²W/∂λ₃².
fn parts(curvatures: &Curvatures) -> (Matrix4<f64>, Gradient, f64) {
    (
        curvatures.fixed_view::<4, 4>(0, 0).into_owned(),
        curvatures.fixed_view::<4, 1>(0, THICKNESS).into_owned(),
        curvatures[(THICKNESS, THICKNESS)],
    )
}

impl HyperelasticLaw for VolumetricSheet {
    fn stress(&self, kinematics: &Kinematics) -> (f64, Gradient) {
        let body = self.body(kinematics);
        (body.energy, body.in_plane())
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        let (body, curvatures) = self.body_with_curvatures(kinematics);
        let (plane, mixed, across) = parts(&curvatures);
        let tangent = match self.volume.plane {
            PlaneState::Stress => plane - mixed * (mixed / across).transpose(),
            PlaneState::Strain => plane,
        };
        SheetResponse {
            energy: body.energy,
            first_piola_kirchhoff_stress: body.in_plane(),
            // The sums are symmetric but for their last digit.
            tangent: 0.5 * (tangent + tangent.transpose()),
        }
    }

    fn tension(&self, _: [f64; 2], strain: f64) -> TensionResponse {
        curve::tension(&|kinematics| self.response(kinematics), strain)
    }

    fn volume_ratio(&self, kinematics: &Kinematics) -> f64 {
        1.0 + self.body(kinematics).strain.volume_change
    }

    fn thickness_gradient(&self, kinematics: &Kinematics) -> Gradient {
        match self.volume.plane {
            PlaneState::Stress => {
                let (_, mixed, across) = parts(&self.at_free_surface(kinematics).1);
                -mixed / across
            }
            PlaneState::Strain => Vector4::zeros(),
        }
    }

    fn thickness_stress(&self, kinematics: &Kinematics) -> f64 {
        match self.volume.plane {
            PlaneState::Stress => 0.0,
            PlaneState::Strain => self.body(kinematics).stress[THICKNESS] / kinematics.area_ratio(),
        }
    }

    fn plane_state(&self) -> PlaneState {
        self.volume.plane
    }

    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        Some(Arc::new(Self {
            law: Arc::clone(&self.law),
            volume: self.volume.in_plane_strain(),
        }))
    }

    /// μ₀ = 2 (Ψ₁ + Ψ₂) at rest.
    fn shear_modulus(&self) -> f64 {
        let rest = self.law.evaluate(Invariants {
            i1_minus_3: 0.0,
            i2_minus_3: 0.0,
        });
        2.0 * (rest.d1 + rest.d2)
    }
}
