/// The places of Gauss's rule with two points on a line, as shares of it. Both have half the weight, and the
/// rule is exact for cubic polynomials.
pub const GAUSS: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// Returns the mean of a function over a line by this rule. `value` is called with shares of the line.
pub fn gauss_mean(value: impl Fn(f64) -> f64) -> f64 {
    0.5 * GAUSS.into_iter().map(value).sum::<f64>()
}
