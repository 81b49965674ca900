//! Formulas: compiled and evaluated, or refused with a pointer to the mistake.

#![no_main]

use meshbrush_core::field::Formula;

/// Coordinates at which functions are most likely to fail.
const ODD: [f64; 8] = [0.0, -0.0, 1.0, -2.5, 1e300, 5e-324, f64::INFINITY, f64::NAN];

libfuzzer_sys::fuzz_target!(|text: &str| match Formula::parse(text) {
    Ok(formula) => {
        let again = Formula::parse(formula.source()).expect("a formula's source is a formula");
        for (x, y) in ODD.iter().flat_map(|&x| ODD.map(|y| (x, y))) {
            assert_eq!(formula.eval(x, y).to_bits(), again.eval(x, y).to_bits());
            if let Some(constant) = formula.constant() {
                assert!(formula.eval(x, y) == constant || constant.is_nan());
            }
        }
    }
    Err(mistake) => {
        let span = mistake.span();
        assert!(
            text.is_char_boundary(span.start) && text.is_char_boundary(span.end) && span.start <= span.end
        );
        assert!(!mistake.to_string().is_empty() && mistake.pointer().contains('^'));
    }
});
