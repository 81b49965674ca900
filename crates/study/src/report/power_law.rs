//! A power law through points: the straight line through their logarithms.

/// y = factor · x^exponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The value at x = 1.
    pub factor: f64,
    /// The gradient on logarithmic axes.
    pub exponent: f64,
    /// The exponent lies within this distance in 95 % of all samples whose logarithms scatter evenly;
    /// infinite with two points.
    pub uncertainty: f64,
}

/// The quantiles of Student's t-distribution for 95 % on both sides, by degrees of freedom from 1 on; beyond
/// the table it is that of the normal distribution, 1.96, within 0.3 %.
const STUDENT: [f64; 12] =
    [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179];

impl PowerLaw {
    /// Fits a power law by least squares of the logarithms. `None` unless there are two different x, and all
    /// coordinates are positive.
    pub fn fitted(points: &[[f64; 2]]) -> Option<Self> {
        let points: Vec<[f64; 2]> = points.iter().map(|point| point.map(libm::log)).collect();
        let count = points.len() as f64;
        let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
        let [x, y] = [mean(0), mean(1)];
        let sum = |f: &dyn Fn(f64, f64) -> f64| points.iter().map(|&[px, py]| f(px - x, py - y)).sum::<f64>();
        let spread = sum(&|dx, _| dx * dx);
        let exponent = sum(&|dx, dy| dx * dy) / spread;
        let squares = sum(&|dx, dy| (dy - exponent * dx) * (dy - exponent * dx));
        let freedom = points.len().saturating_sub(2);
        let uncertainty = match freedom.checked_sub(1) {
            None => f64::INFINITY,
            Some(row) => {
                let student = STUDENT.get(row).copied().unwrap_or(1.96);
                student * (squares / (freedom as f64 * spread)).sqrt()
            }
        };
        exponent.is_finite().then(|| Self { factor: libm::exp(y - exponent * x), exponent, uncertainty })
    }

    /// Returns the value at an x.
    pub fn at(&self, x: f64) -> f64 {
        self.factor * libm::pow(x, self.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(exponent: f64) -> Vec<[f64; 2]> {
        (0..9).map(|i| libm::pow(2.0, f64::from(i))).map(|x| [x, 3.0 * libm::pow(x, exponent)]).collect()
    }

    #[test]
    fn a_power_law_is_found_exactly() {
        for exponent in [0.5, 1.0, 1.01, 2.4] {
            let law = PowerLaw::fitted(&series(exponent)).unwrap();
            assert!((law.exponent - exponent).abs() < 1e-12 && law.uncertainty < 1e-7, "{law:?}");
            assert!(
                (law.factor - 3.0).abs() < 1e-12
                    && (law.at(4.0) / series(exponent)[2][1] - 1.0).abs() < 1e-12
            );
        }
    }

    #[test]
    fn by_the_normal_equations_of_the_logarithms() {
        let points = [[0.0, 1.0], [1.0, 1.0], [2.0, 4.0]].map(|point| point.map(libm::exp));
        let law = PowerLaw::fitted(&points).unwrap();
        // Gradient 1.5; the residuals 0.5, −1, 0.5 have the squares 1.5; 12.706 √(1.5 / 2).
        assert!((law.exponent - 1.5).abs() < 1e-12, "{law:?}");
        assert!((law.uncertainty - 12.706 * 0.75_f64.sqrt()).abs() < 1e-9, "{law:?}");
    }

    /// One size on a loaded machine: the straight line through the points themselves, which was drawn before,
    /// follows the largest size alone.
    #[test]
    fn an_outlier_widens_the_uncertainty_so_that_it_contains_the_exponent() {
        for outlier in 0..9 {
            let mut points = series(1.01);
            points[outlier][1] *= 2.4;
            let law = PowerLaw::fitted(&points).unwrap();
            assert!((law.exponent - 1.01).abs() < law.uncertainty, "{outlier}: {law:?}");
            assert!((0.1..0.5).contains(&law.uncertainty) && (law.exponent - 1.01).abs() < 0.2, "{law:?}");
        }
    }

    #[test]
    fn too_few_or_impossible_points_have_no_power_law() {
        assert_eq!(PowerLaw::fitted(&[]), None);
        assert_eq!(PowerLaw::fitted(&[[2.0, 1.0]]), None);
        assert_eq!(PowerLaw::fitted(&[[2.0, 1.0], [2.0, 3.0]]), None);
        assert_eq!(PowerLaw::fitted(&[[1.0, 1.0], [2.0, 0.0]]), None);
        assert!(PowerLaw::fitted(&[[1.0, 1.0], [2.0, 2.0]]).unwrap().uncertainty.is_infinite());
    }
}
