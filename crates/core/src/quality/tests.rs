//! The classes of histograms.

use super::QualityMeasure;
use super::bins::Classes;

#[test]
fn every_number_is_in_the_class_whose_bounds_hold_it() {
    for measure in QualityMeasure::ALL {
        let classes = Classes::of(measure, 0.7);
        let [first, _] = classes.bounds(0);
        for n in 1..4000 {
            let number = first + 0.031 * f64::from(n);
            let class = classes.of_number(number);
            let [from, to] = classes.bounds(class);
            let is_last = class + 1 == classes.count();
            let is_held = from <= number && (number <= to || is_last);
            assert!(is_held, "{measure:?} {number}: {from} to {to}");
        }
        for class in 1..classes.count() {
            assert_eq!(classes.bounds(class)[0], classes.bounds(class - 1)[1], "{measure:?}");
        }
    }
}

#[test]
fn numbers_on_a_bound_are_in_one_class_whatever_their_rounding() {
    for off in [1.0 - 1e-12, 1.0, 1.0 + 1e-12] {
        let class = |measure, number: f64| Classes::of(measure, 2.0).of_number(off * number);
        assert_eq!(class(QualityMeasure::SmallestAngle, 45.0), 9, "{off}");
        assert_eq!(class(QualityMeasure::SmallestAngle, 60.0), 11, "{off}");
        assert_eq!(class(QualityMeasure::LargestAngle, 60.0), 0, "{off}");
        assert_eq!(class(QualityMeasure::EdgeRatio, 1.0), 0, "{off}");
        // A triangle that is as long as h̄ is not above it.
        assert_eq!(class(QualityMeasure::TargetRatio, 1.0), 9, "{off}");
        assert_eq!(class(QualityMeasure::TimeStep, 2.0), 0, "{off}");
        assert_eq!(class(QualityMeasure::TimeStep, 16.0), 3, "{off}");
        assert_eq!(class(QualityMeasure::Valence, 8.0), 7, "{off}");
    }
    assert_eq!(Classes::of(QualityMeasure::Valence, 0.0).of_number(200.0), 11);
    assert_eq!(Classes::of(QualityMeasure::EdgeRatio, 0.0).of_number(1e300), 16);
}
