//! The keys and words of `settings.json` are those of its version.

use std::fmt::Write;

use super::VERSION;
use super::settings::Saved;

/// Texts in which one key or word, `qqqq`, is unknown, beside the place that it stands in.
const PLACES: [(&str, &str); 33] = [
    ("", r#"{"qqqq":1}"#),
    ("unit", r#"{"unit":"qqqq"}"#),
    ("background", r#"{"background":{"qqqq":1}}"#),
    ("domain", r#"{"domain":{"qqqq":1}}"#),
    ("domain.cuts", r#"{"domain":{"cuts":[{"qqqq":1}]}}"#),
    ("domain.shape", r#"{"domain":{"shape":"qqqq"}}"#),
    ("boundary", r#"{"boundary":"qqqq"}"#),
    ("cleaning", r#"{"cleaning":{"qqqq":1}}"#),
    ("cleaning.parts", r#"{"cleaning":{"parts":"qqqq"}}"#),
    ("boundary_marks", r#"{"boundary_marks":{"qqqq":1}}"#),
    ("boundary_marks.names", r#"{"boundary_marks":{"names":[{"qqqq":1}]}}"#),
    ("boundary_marks.types", r#"{"boundary_marks":{"types":[{"qqqq":1}]}}"#),
    ("boundary_marks.types.type", r#"{"boundary_marks":{"types":[{"type":"qqqq"}]}}"#),
    ("paths", r#"{"paths":{"qqqq":1}}"#),
    ("paths.cost", r#"{"paths":{"cost":"qqqq"}}"#),
    ("paths.cost.weights", r#"{"paths":{"cost":{"weights":{"qqqq":1}}}}"#),
    ("paths.keep_out", r#"{"paths":{"keep_out":[{"qqqq":1}]}}"#),
    ("transfer", r#"{"transfer":{"qqqq":1}}"#),
    ("rule", r#"{"rule":"qqqq"}"#),
    ("layers", r#"{"layers":[{"qqqq":1}]}"#),
    ("layers.raster", r#"{"layers":[{"raster":{"qqqq":1}}]}"#),
    ("layers.layer", r#"{"layers":[{"layer":{"qqqq":1}}]}"#),
    ("layers.layer.kind", r#"{"layers":[{"layer":{"kind":"qqqq"}}]}"#),
    ("layers.layer.combine", r#"{"layers":[{"layer":{"combine":"qqqq"}}]}"#),
    ("layers.layer.quantity", r#"{"layers":[{"layer":{"quantity":"qqqq"}}]}"#),
    ("layers.layer.norm", r#"{"layers":[{"layer":{"norm":"qqqq"}}]}"#),
    ("layers.layer.to", r#"{"layers":[{"layer":{"to":"qqqq"}}]}"#),
    ("layers.layer.types", r#"{"layers":[{"layer":{"types":["qqqq"]}}]}"#),
    ("layers.layer.positive", r#"{"layers":[{"layer":{"positive":"qqqq"}}]}"#),
    ("layers.layer.size", r#"{"layers":[{"layer":{"size":"qqqq"}}]}"#),
    ("layers.layer.threats", r#"{"layers":[{"layer":{"threats":[{"qqqq":1}]}}]}"#),
    ("layers.layer.threats.law", r#"{"layers":[{"layer":{"threats":[{"law":"qqqq"}]}}]}"#),
    ("layers.layer.shapes", r#"{"layers":[{"layer":{"shapes":[{"qqqq":1}]}}]}"#),
];

/// The keys of the present version. If they change, raise [`VERSION`]: otherwise an older program says that a
/// key is unknown, in place of "written by a newer program".
const KEYS_OF_VERSION: (u64, &str) = (12, KEYS);

const KEYS: &str = "\
: format version written_by name unit background domain boundary cleaning boundary_marks pins pins_part \
    paths spacing transfer layers gradation rule max_triangles max_memory max_level
unit: none m km degrees
background: name part bounds opacity
domain: bounds shape polygons projection cuts
domain.cuts: rect coordinates eastward
domain.shape: whole formula polygons
boundary: report fitted_with_diameter on_outline_with_diameter
cleaning: parts keep_pinches
cleaning.parts: all largest with_share
boundary_marks: splits names types
boundary_marks.names: at name
boundary_marks.types: at type
boundary_marks.types.type: open land no-slip land natural land inflow no-slip inflow natural inflow
paths: routes names cost keep_out clearance
paths.cost: weights formula
paths.cost.weights: length risk
paths.keep_out: name polygons part
transfer: h_min h_risk h_max shape
rule: vertex area
layers: id layer raster shapes threats mask
layers.raster: part bounds columns rows
layers.layer: kind name visible locked combine mask mask_file quantity formula file layer bounds as \
    curve threats to pieces types shapes width at_zero slope range between diameter positive offset size depth_from depth_to \
    period triangles smoothing time_step courant across width_from width_to norm within at_most
layers.layer.kind: paint formula raster threats distance corridor band depth straits feature-size surface
layers.layer.combine: finest floor replace
layers.layer.quantity: risk diameter error
layers.layer.norm: max l2 h1
layers.layer.to: outline coasts
layers.layer.types: open land no-slip land natural land inflow no-slip inflow natural inflow
layers.layer.positive: up down
layers.layer.size: nothing wavelength slope courant
layers.layer.threats: x y range peak law
layers.layer.threats.law: radar gaussian disc
layers.layer.shapes: point line polygon
";

#[test]
fn a_new_key_comes_with_a_new_version() {
    let mut keys = String::new();
    for (place, text) in PLACES {
        let error = serde_json::from_str::<Saved>(text).err().expect("no version has this").to_string();
        let (_, known) = error.split_once("expected").unwrap_or_else(|| panic!("{place}: {error}"));
        let known: Vec<&str> = known.split('`').skip(1).step_by(2).collect();
        writeln!(keys, "{place}: {}", known.join(" ")).expect("a string takes any text");
    }
    assert_eq!((VERSION, keys.as_str()), KEYS_OF_VERSION, "raise the version, and put the new list here");
}
