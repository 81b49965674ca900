//! Metric lengths in documents in degrees. A degree of longitude is shorter the farther it is from the
//! equator, so that no number of degrees is a length in every direction: a sentence gives both.

use egui::{Context, Id};

use super::format;
use meshbrush_mesh::text::typed;

/// Kilometres of one degree of latitude, on the sphere with the area of the Earth.
pub const KM_PER_DEGREE: f64 = 111.195;

fn id() -> Id {
    Id::unique("latitude in the middle of the domain")
}

/// Says which latitude is in the middle of the domain from now on, in a document in degrees.
pub fn publish_latitude(ctx: &Context, latitude: Option<f64>) {
    ctx.data_mut(|data| data.insert_temp(id(), latitude));
}

/// Returns how many degrees a metric length that was typed is in the middle of the domain, as a sentence;
/// `None` for any other text, and near the poles.
pub(super) fn metric_in_degrees(ctx: &Context, text: &str) -> Option<String> {
    sentence(text, ctx.data(|data| data.get_temp::<Option<f64>>(id())).flatten()?)
}

fn sentence(text: &str, latitude: f64) -> Option<String> {
    if latitude.abs() > 89.0 {
        return None;
    }
    let text = text.trim();
    let is_plain = typed::number(text, "").is_ok();
    let degrees = typed::number(text, "km").ok().filter(|_| !is_plain)? / KM_PER_DEGREE;
    let [along_parallel, along_meridian] =
        [degrees / latitude.to_radians().cos(), degrees].map(|degrees| format::significant(degrees, 3));
    Some(format!(
        "In the middle of the domain {text} are about {along_parallel}° from west to east and {along_meridian}° from \
         south to north: type one of these."
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metric_length_is_given_in_degrees_in_both_directions() {
        let text = sentence("2 km", 60.0).unwrap();
        assert!(text.contains("2 km are about 0.0360° from west to east and 0.0180° from south"), "{text}");
        assert!(sentence("500 m", 0.0).unwrap().contains("0.00450° from west to east and 0.00450°"));
        for text in ["2", "much", "2 apples", "3°", "2k"] {
            assert_eq!(sentence(text, 40.0), None, "{text}");
        }
        assert_eq!(sentence("2 km", 89.5), None, "at a pole a degree of longitude has no length");
    }
}
