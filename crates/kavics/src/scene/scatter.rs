//! Scatter of strengths: a factor for each contact, by inverse distribution functions.

/// How a factor on the strengths is distributed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scatter {
    /// F(f) = 1 − exp(−(f/scale)^shape).
    Weibull {
        /// Shape, dimensionless.
        shape: f64,
        /// Scale, dimensionless.
        scale: f64,
    },
    /// Uniform between two limits.
    Uniform {
        /// Smallest factor.
        from: f64,
        /// Largest factor.
        to: f64,
    },
    /// ln f is normal about ln(median).
    Lognormal {
        /// Standard deviation of ln f.
        deviation: f64,
        /// Median of f.
        median: f64,
    },
}

impl Scatter {
    /// The factor below which a share `u` of all factors lies, 0 ≤ u < 1.
    ///
    /// Positive also at u = 0, where a strength would vanish: the share is taken as at least 2⁻⁵⁴.
    pub fn factor(self, u: f64) -> f64 {
        let u = u.max(0.5 * f64::EPSILON * 0.5);
        match self {
            Self::Weibull { shape, scale } => scale * libm::pow(-libm::log1p(-u), shape.recip()),
            Self::Uniform { from, to } => from + (to - from) * u,
            Self::Lognormal { deviation, median } => {
                median * libm::exp(deviation * normal_quantile(u))
            }
        }
    }
}

// Coefficients of Wichura (1988): A/B near the median, C/D and E/F in the tails.
#[expect(clippy::excessive_precision, reason = "digits as published")]
const A: [f64; 8] = [
    3.387_132_872_796_366_608_0,
    1.331_416_678_917_843_774_5e2,
    1.971_590_950_306_551_442_7e3,
    1.373_169_376_550_946_112_5e4,
    4.592_195_393_154_987_145_7e4,
    6.726_577_092_700_870_085_3e4,
    3.343_057_558_358_812_810_5e4,
    2.509_080_928_730_122_672_7e3,
];
#[expect(clippy::excessive_precision, reason = "digits as published")]
const B: [f64; 8] = [
    1.0,
    4.231_333_070_160_091_125_2e1,
    6.871_870_074_920_579_083_0e2,
    5.394_196_021_424_751_107_7e3,
    2.121_379_430_158_659_586_7e4,
    3.930_789_580_009_271_061_0e4,
    2.872_908_573_572_194_267_4e4,
    5.226_495_278_852_854_561_0e3,
];
#[expect(clippy::excessive_precision, reason = "digits as published")]
const C: [f64; 8] = [
    1.423_437_110_749_683_577_34,
    4.630_337_846_156_545_295_90,
    5.769_497_221_460_691_405_50,
    3.647_848_324_763_204_605_04,
    1.270_458_252_452_368_382_58,
    2.417_807_251_774_506_117_70e-1,
    2.272_384_498_926_918_458_33e-2,
    7.745_450_142_783_414_076_40e-4,
];
#[expect(clippy::excessive_precision, reason = "digits as published")]
const D: [f64; 8] = [
    1.0,
    2.053_191_626_637_758_821_87,
    1.676_384_830_183_803_849_40,
    6.897_673_349_851_000_045_50e-1,
    1.481_039_764_274_800_745_90e-1,
    1.519_866_656_361_645_719_66e-2,
    5.475_938_084_995_344_946_00e-4,
    1.050_750_071_644_416_843_24e-9,
];
#[expect(clippy::excessive_precision, reason = "digits as published")]
const E: [f64; 8] = [
    6.657_904_643_501_103_777_20,
    5.463_784_911_164_114_369_90,
    1.784_826_539_917_291_335_80,
    2.965_605_718_285_048_912_30e-1,
    2.653_218_952_657_612_309_30e-2,
    1.242_660_947_388_078_438_60e-3,
    2.711_555_568_743_487_578_15e-5,
    2.010_334_399_292_288_132_65e-7,
];
#[expect(clippy::excessive_precision, reason = "digits as published")]
const F: [f64; 8] = [
    1.0,
    5.998_322_065_558_879_376_90e-1,
    1.369_298_809_227_358_053_10e-1,
    1.487_536_129_085_061_485_25e-2,
    7.868_691_311_456_132_591_00e-4,
    1.846_318_317_510_054_681_80e-5,
    1.421_511_758_316_445_888_70e-7,
    2.044_263_103_389_939_785_64e-15,
];

fn polynomial(coefficients: [f64; 8], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The inverse of the standard normal distribution function, to about 1e-16: algorithm AS 241 (PPND16),
/// Wichura (1988), Applied Statistics 37, 477–484.
fn normal_quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * polynomial(A, r) / polynomial(B, r);
    }
    let r = (-libm::log(if q < 0.0 { p } else { 1.0 - p })).sqrt();
    let tail = if r <= 5.0 {
        polynomial(C, r - 1.6) / polynomial(D, r - 1.6)
    } else {
        polynomial(E, r - 5.0) / polynomial(F, r - 5.0)
    };
    if q < 0.0 { -tail } else { tail }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantile_inverts_the_normal_distribution() {
        // Φ(z) = erfc(−z/√2)/2.
        for z in [-8.0, -6.0, -3.0, -1.0, -0.2, 0.0, 0.7, 1.5, 2.5, 5.0] {
            let p = 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
            let tolerance = if z > 4.0 { 1e-8 } else { 1e-13 };
            assert!((normal_quantile(p) - z).abs() < tolerance, "{z}");
        }
    }

    #[test]
    fn medians_are_where_they_belong() {
        let weibull = Scatter::Weibull {
            shape: 5.0,
            scale: 2.0,
        };
        let share = 1.0 - libm::exp(-libm::pow(weibull.factor(0.5) / 2.0, 5.0));
        assert!((share - 0.5).abs() < 1e-15);
        let lognormal = Scatter::Lognormal {
            deviation: 0.3,
            median: 1.5,
        };
        assert!((lognormal.factor(0.5) - 1.5).abs() < 1e-15);
        let uniform = Scatter::Uniform { from: 0.5, to: 1.5 };
        assert_eq!(uniform.factor(0.25), 0.75);
    }

    #[test]
    fn a_factor_is_positive() {
        let weibull = Scatter::Weibull {
            shape: 2.0,
            scale: 1.0,
        };
        assert!(weibull.factor(0.0) > 0.0);
    }
}
