//! The error of meshes against the number of their triangles, as a plot.

use crate::build::ErrorCurves;
use crate::layers::SurfaceNorm;
use crate::plot::{Axis, Mark, Plot, Scale, Series};
use crate::report::PowerLaw;
use crate::surface::CurvePoint;
use crate::text::{Grouped, fixed, significant};

/// The factor between the numbers of triangles of the points of a curve that its rate is taken from: the last
/// ones before triangles resolve single samples.
const RATE_SPAN: f64 = 10.0;
/// Least samples for each triangle there.
const SAMPLES_PER_TRIANGLE: f64 = 8.0;
/// Share of the largest error of a curve below which one is rounding.
const LEAST_SHARE: f64 = 1e-6;
/// Least points that have a rate.
const LEAST_POINTS: usize = 3;

/// Returns the words for an error by a norm.
pub fn name_of_error(norm: SurfaceNorm) -> &'static str {
    match norm {
        SurfaceNorm::Largest => "largest error",
        SurfaceNorm::RootMeanSquare => "root mean square error",
        SurfaceNorm::Gradient => "root mean square error of the gradient",
    }
}

/// Returns the plot of curves, with the mesh of a document as `here`. The points of the first series are
/// [`ErrorCurves::least`] without an error of 0.
pub fn error_plot(curves: &ErrorCurves, here: Option<CurvePoint>) -> Plot {
    let least = shown(&curves.least);
    let name = match curves.norm {
        SurfaceNorm::Largest => "Smallest mesh",
        SurfaceNorm::RootMeanSquare | SurfaceNorm::Gradient => "Adaptive mesh",
    };
    let mut series = vec![Series::new(name, Mark::Line, least.clone())];
    series.push(Series::new("Uniform mesh", Mark::Line, shown(&curves.uniform)));
    series.extend(best_rate(&least, curves.samples, curves.norm));
    series
        .extend(curves.others.map(|point| Series::new("Without the surface", Mark::Points, shown(&[point]))));
    series.extend(here.map(|point| Series::new("This mesh", Mark::Points, shown(&[point]))));
    Plot {
        title: "Error against triangles".into(),
        x: Axis::new("triangles", Scale::Logarithmic),
        y: Axis::new(name_of_error(curves.norm), Scale::Logarithmic),
        series,
        note: note(curves, here),
    }
}

/// Returns the points of a curve that logarithmic axes show, without errors that are rounding.
fn shown(points: &[CurvePoint]) -> Vec<[f64; 2]> {
    let largest =
        points.iter().map(|point| point.error).filter(|error| error.is_finite()).fold(0.0, f64::max);
    let is_shown = |point: &&CurvePoint| point.error.is_finite() && point.error > LEAST_SHARE * largest;
    points.iter().filter(is_shown).map(|point| [point.triangles as f64, point.error]).collect()
}

/// Returns a line of the best rate that is possible, below the last points of a curve.
fn best_rate(points: &[[f64; 2]], samples: usize, norm: SurfaceNorm) -> Option<Series> {
    let counting = |point: &&[f64; 2]| point[0] <= samples as f64 / SAMPLES_PER_TRIANGLE;
    let &[triangles, error] = points.iter().rev().find(counting)?;
    let from = (triangles / RATE_SPAN).max(points[0][0]);
    let at = |x: f64| [x, 0.7 * error * libm::pow(x / triangles, norm.best_rate())];
    let name = format!("Rate {}", fixed(norm.best_rate(), 1));
    (from < triangles).then(|| Series::new(name, Mark::Line, vec![at(from), at(triangles)]))
}

/// Returns the power of the number of triangles by which the error falls over the last points of a curve that
/// count, with its uncertainty.
fn rate(points: &[[f64; 2]], samples: usize) -> Option<String> {
    let most = points.last()?[0].min(samples as f64 / SAMPLES_PER_TRIANGLE);
    let last: Vec<_> = points
        .iter()
        .copied()
        .filter(|[triangles, _]| *triangles * RATE_SPAN >= most && *triangles <= most)
        .collect();
    let law = PowerLaw::fitted(&last).filter(|_| last.len() >= LEAST_POINTS)?;
    let exponent = fixed(law.exponent, 2);
    Some(if law.uncertainty.is_finite() {
        format!("{exponent} ± {}", fixed(law.uncertainty, 2))
    } else {
        exponent
    })
}

fn note(curves: &ErrorCurves, here: Option<CurvePoint>) -> String {
    let mut sentences = Vec::new();
    let rates = [&curves.least, &curves.uniform].map(|points| rate(&shown(points), curves.samples));
    let best = fixed(curves.norm.best_rate(), 1);
    match rates {
        [Some(least), Some(uniform)] => {
            sentences.push(format!("Rate {least}, uniform {uniform}; best possible {best}."));
        }
        [Some(least), None] => sentences.push(format!("Rate {least}; best possible {best}.")),
        [None, _] => {}
    }
    if let Some((here, uniform)) = here.and_then(|here| Some((here, uniform_of(curves, here.error)?))) {
        let ratio = uniform.triangles as f64 / here.triangles.max(1) as f64;
        sentences.push(format!(
            "A uniform mesh of the error of this one has {} triangles, {} times as many.",
            Grouped(uniform.triangles),
            significant(ratio, 3)
        ));
    }
    sentences.join(" ")
}

/// Returns the coarsest uniform mesh that is within an error, if it is on the curve.
pub fn uniform_of(curves: &ErrorCurves, error: f64) -> Option<CurvePoint> {
    curves.uniform.iter().copied().find(|point| point.error <= error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(rate: f64) -> Vec<CurvePoint> {
        let point = |n: i32| (2_usize << n, 8.0 * libm::pow(2.0, rate * f64::from(n)));
        (0..14).map(point).map(|(triangles, error)| CurvePoint { triangles, error }).collect()
    }

    #[test]
    fn rates_are_those_of_the_curves_and_the_uniform_mesh_is_the_first_within_the_error() {
        let mut curves = ErrorCurves {
            least: curve(-1.0),
            uniform: curve(-0.5),
            samples: 1 << 30,
            ..ErrorCurves::default()
        };
        curves.least.push(CurvePoint { triangles: 1 << 20, error: 0.0 });
        let here = CurvePoint { triangles: 64, error: 0.25 };
        let plot = error_plot(&curves, Some(here));
        assert_eq!(
            plot.note,
            "Rate −1.00 ± 0.00, uniform −0.50 ± 0.00; best possible −1.0. A uniform mesh of the error of this one has \
             2,048 triangles, 32.0 times as many."
        );
        assert_eq!(plot.series[0].points.len(), 14, "an error of 0 has no place");
        let names: Vec<_> = plot.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["Smallest mesh", "Uniform mesh", "Rate −1.0", "This mesh"]);
    }

    #[test]
    fn short_curves_have_no_rate() {
        let one = CurvePoint { triangles: 2, error: 1.0 };
        let curves =
            ErrorCurves { least: vec![one], uniform: vec![one], samples: 1000, ..ErrorCurves::default() };
        let plot = error_plot(&curves, None);
        assert!(plot.note.is_empty() && plot.series.len() == 2);
    }
}
