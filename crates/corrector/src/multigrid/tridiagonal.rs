//! Tridiagonal systems of 2 × 2 blocks, symmetric and positive definite, many side by side.
//!
//! ```text
//! Eᵀₖ₋₁ δₖ₋₁ + Dₖ δₖ + Eₖ δₖ₊₁ = rₖ
//! Sₖ = Dₖ − Eᵀₖ₋₁ Sₖ₋₁⁻¹ Eₖ₋₁,   yₖ = Sₖ⁻¹ (rₖ − Eᵀₖ₋₁ yₖ₋₁),   δₖ = yₖ − Sₖ⁻¹ Eₖ δₖ₊₁
//! ```

use pulp::NullaryFnOnce;

use super::vector::VECTOR;

/// Systems that are solved side by side.
pub const LANES: usize = VECTOR;
/// Numbers kept of each position: the three of Dₖ or Sₖ⁻¹, and the four of Eₖ, row by row.
pub const FACTOR: usize = 7 * LANES;
/// Numbers of a position's right-hand side, and of its solution.
pub const PAIR: usize = 2 * LANES;

type Lanes = [f32; LANES];

/// Sₖ⁻¹ in place of Dₖ.
pub struct Factorise<'a> {
    pub factors: &'a mut [f32],
}

impl NullaryFnOnce for Factorise<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let mut before: Option<[Lanes; 7]> = None;
        for numbers in self.factors.chunks_exact_mut(FACTOR) {
            let mut block: [Lanes; 7] = split(numbers);
            for lane in 0..LANES {
                if let Some([p, q, r, a, b, c, d]) = &before {
                    // S⁻¹ E by columns, then Eᵀ of it.
                    let first = [
                        p[lane] * a[lane] + q[lane] * c[lane],
                        q[lane] * a[lane] + r[lane] * c[lane],
                    ];
                    let second = [
                        p[lane] * b[lane] + q[lane] * d[lane],
                        q[lane] * b[lane] + r[lane] * d[lane],
                    ];
                    block[0][lane] -= a[lane] * first[0] + c[lane] * first[1];
                    block[1][lane] -= a[lane] * second[0] + c[lane] * second[1];
                    block[2][lane] -= b[lane] * second[0] + d[lane] * second[1];
                }
                let [a, b, c] = [block[0][lane], block[1][lane], block[2][lane]];
                let determinant = a * c - b * b;
                // Positions beside the grid have no stiffness.
                let inverse = if determinant == 0.0 {
                    0.0
                } else {
                    1.0 / determinant
                };
                block[0][lane] = c * inverse;
                block[1][lane] = -b * inverse;
                block[2][lane] = a * inverse;
            }
            for (target, block) in numbers.chunks_exact_mut(LANES).zip(&block) {
                target.copy_from_slice(block);
            }
            before = Some(block);
        }
    }
}

#[inline(always)]
fn split<const N: usize>(numbers: &[f32]) -> [Lanes; N] {
    let mut lanes = [[0.0; LANES]; N];
    for (lanes, numbers) in lanes.iter_mut().zip(numbers.chunks_exact(LANES)) {
        lanes.copy_from_slice(numbers);
    }
    lanes
}

/// δ in place of r.
#[inline(always)]
pub fn substitute(factors: &[f32], corrections: &mut [f32]) {
    let mut from_before = [[0.0; LANES]; 2];
    let positions = factors
        .chunks_exact(FACTOR)
        .zip(corrections.chunks_exact_mut(PAIR));
    for (factors, pair) in positions {
        let [p, q, r, a, b, c, d]: [Lanes; 7] = split(factors);
        let (first, second) = pair.split_at_mut(LANES);
        for lane in 0..LANES {
            let x = first[lane] - from_before[0][lane];
            let y = second[lane] - from_before[1][lane];
            first[lane] = p[lane] * x + q[lane] * y;
            second[lane] = q[lane] * x + r[lane] * y;
            from_before[0][lane] = a[lane] * first[lane] + c[lane] * second[lane];
            from_before[1][lane] = b[lane] * first[lane] + d[lane] * second[lane];
        }
    }
    let mut after = [[0.0; LANES]; 2];
    let positions = factors
        .chunks_exact(FACTOR)
        .zip(corrections.chunks_exact_mut(PAIR));
    for (factors, pair) in positions.rev() {
        let [p, q, r, a, b, c, d]: [Lanes; 7] = split(factors);
        let (first, second) = pair.split_at_mut(LANES);
        for lane in 0..LANES {
            let x = a[lane] * after[0][lane] + b[lane] * after[1][lane];
            let y = c[lane] * after[0][lane] + d[lane] * after[1][lane];
            first[lane] -= p[lane] * x + q[lane] * y;
            second[lane] -= q[lane] * x + r[lane] * y;
        }
        after[0].copy_from_slice(first);
        after[1].copy_from_slice(second);
    }
}
