use std::path::Path;

use super::*;
use crate::io::KeyFault;
use meshbrush_core::layers::{LayerId, Mask, Shapes, Threats};

fn saved(json: &str) -> SavedLayer {
    serde_json::from_str(json).unwrap_or_else(|error| panic!("{json}: {error}"))
}

fn checked(json: &str) -> Result<CheckedKind, String> {
    saved(json).checked(Stored::InFiles).map_err(|fault| fault.to_string())
}

#[test]
fn every_kind_is_read_from_its_keys() {
    let full = r#"{ "kind": "formula", "quantity": "risk", "formula": "x", "name": "Storm", "visible": false,
        "locked": true, "combine": "replace", "mask": [[[[0, 0], [4, 0], [4, 3], [0, 0]]]] }"#;
    let layer = saved(full);
    assert_eq!((layer.shown_name(), layer.visible, layer.locked), ("Storm", false, true));
    assert_eq!(layer.combine, SavedCombine::Replace);
    let polygons = layer.mask_in_place().unwrap().unwrap();
    assert_eq!(polygons[0][0].len(), 3, "the repeated first point is removed");
    for (json, expected) in [
        (
            r#"{ "kind": "paint", "quantity": "diameter" }"#,
            "Complete(Paint(PaintLayer { quantity: Diameter }))",
        ),
        (
            r#"{ "kind": "threats", "threats": [{ "x": 1, "y": 2, "range": 3 }] }"#,
            "Threats(Some([Threat { at: DVec2(1.0, 2.0), range: 3.0, peak: 1.0, law: Radar }]))",
        ),
        (r#"{ "kind": "threats", "file": "a.csv" }"#, "Threats(None)"),
        (
            r#"{ "kind": "distance", "to": "outline", "at_zero": 0.1, "slope": 0.2 }"#,
            "Distance(Boundary(Outline), Growth { at_zero: 0.1, slope: 0.2, range: inf })",
        ),
        (
            r#"{ "kind": "distance", "to": "coasts", "at_zero": 0.1, "slope": 0.2 }"#,
            "Distance(Boundary(Coasts), Growth { at_zero: 0.1, slope: 0.2, range: inf })",
        ),
        (
            r#"{ "kind": "distance", "pieces": ["Rock"], "types": ["land", "no-slip inflow"], "at_zero": 0.1, "slope": 0.2 }"#,
            "Distance(Boundary(Pieces(PieceChoice { names: [\"Rock\"], types: [Land, NoSlipInflow] })), Growth { at_zero: 0.1, slope: 0.2, range: inf })",
        ),
        (
            r#"{ "kind": "distance", "shapes": [{ "point": [1, 2] }], "at_zero": 0.1, "slope": 0, "range": 5 }"#,
            "Distance(InPlace(ShapeList { points: [DVec2(1.0, 2.0)], lines: [], polygons: [] }), Growth { at_zero: 0.1, slope: 0.0, range: 5.0 })",
        ),
        (
            r#"{ "kind": "band", "file": "depth.asc", "between": [-20, 0], "diameter": 0.5 }"#,
            "Band([-20.0, 0.0], 0.5)",
        ),
        (
            r#"{ "kind": "depth", "file": "depth.asc" }"#,
            "Depth(DepthSizes { positive: Up, offset: 0.0, between: [0.0, inf], rule: Nothing })",
        ),
        (
            r#"{ "kind": "depth", "file": "d.asc", "positive": "down", "size": "wavelength", "period": 10, "triangles": 8,
                 "offset": -1.5, "depth_to": 50 }"#,
            "Depth(DepthSizes { positive: Down, offset: -1.5, between: [0.0, 50.0], rule: Wavelength { period: 10.0, triangles: 8.0 } })",
        ),
    ] {
        assert_eq!(format!("{:?}", checked(json).unwrap()), expected, "{json}");
    }
}

#[test]
fn a_layer_is_saved_as_it_was_read() {
    for json in [
        r#"{"kind":"formula","name":"A","visible":false,"locked":true,"combine":"floor","quantity":"diameter","formula":"x"}"#,
        r#"{"kind":"threats","mask_file":"m.geojson","threats":[{"x":1.0,"y":2.0,"range":3.0,"peak":0.5,"law":"disc"}]}"#,
        r#"{"kind":"raster","file":"r.png","bounds":[0.0,0.0,1.0,2.0],"as":"risk"}"#,
        r#"{"kind":"distance","to":"outline","at_zero":0.1,"slope":0.2,"range":3.0}"#,
        r#"{"kind":"distance","pieces":["Rock"],"types":["land"],"at_zero":0.1,"slope":0.2}"#,
        r#"{"kind":"distance","types":["open"],"at_zero":0.1,"slope":0.2}"#,
        r#"{"kind":"distance","shapes":[{"line":[[0.0,0.0],[1.0,1.0]]},{"polygon":[[[0.0,0.0],[1.0,0.0],[0.0,1.0]]]}],"at_zero":0.1,"slope":0.2}"#,
    ] {
        assert_eq!(serde_json::to_string(&saved(json)).unwrap(), json);
    }
}

#[test]
fn values_that_cannot_be_used_are_named_with_their_key() {
    for (json, expected) in [
        (r#"{ "kind": "paint" }"#, "kind: a layer of the kind \"paint\" needs `quantity`."),
        (
            r#"{ "kind": "paint", "quantity": "risk", "slope": 1 }"#,
            "slope: a layer of the kind \"paint\" has no `slope`",
        ),
        (
            r#"{ "kind": "formula", "quantity": "risk", "formula": "x", "norm": "l2" }"#,
            "norm: a layer of the kind \"formula\" has no `norm`; its own keys are quantity, formula. Kinds with `norm`: surface.",
        ),
        (r#"{ "kind": "formula", "quantity": "risk", "formula": "sqr(x)" }"#, "formula: There is no `sqr`"),
        (r#"{ "kind": "raster", "file": "a.jpg", "as": "risk" }"#, "file: a raster ends in .png"),
        (
            r#"{ "kind": "raster", "file": "a.asc" }"#,
            "kind: a layer of the kind \"raster\" says what its values mean",
        ),
        (
            r#"{ "kind": "raster", "file": "a.asc", "as": "risk", "curve": [[0, 1]] }"#,
            "curve: a raster has `as` or",
        ),
        (
            r#"{ "kind": "raster", "file": "a.asc", "curve": [[0, 1], [0, 2]] }"#,
            "curve 2: the values of a curve must ascend",
        ),
        (r#"{ "kind": "raster", "file": "a.asc", "curve": [[0, 1], [1, 0]] }"#, "curve 2: 0 cannot be used"),
        (r#"{ "kind": "raster", "file": "a.asc", "curve": [] }"#, "curve: a curve needs one pair"),
        (
            r#"{ "kind": "raster", "file": "a.png", "as": "risk", "bounds": [0, 0, 0, 1] }"#,
            "bounds: these are no rectangle",
        ),
        (
            r#"{ "kind": "threats", "threats": [{ "x": 0, "y": 0, "range": 0 }] }"#,
            "threats 1, range: A threat has the range 0",
        ),
        (
            r#"{ "kind": "threats", "threats": [{ "x": 0, "y": 0, "range": 1, "peak": 2 }] }"#,
            "threats 1, peak: A threat has the peak 2",
        ),
        (r#"{ "kind": "threats" }"#, "kind: a layer of the kind \"threats\" needs `file`"),
        (
            r#"{ "kind": "distance", "at_zero": 1, "slope": 0 }"#,
            "kind: a layer of the kind \"distance\" needs to",
        ),
        (
            r#"{ "kind": "distance", "to": "outline", "types": ["land"], "at_zero": 1, "slope": 0 }"#,
            "types: a distance has one of",
        ),
        (
            r#"{ "kind": "distance", "to": "outline", "file": "a", "at_zero": 1, "slope": 0 }"#,
            "to: a distance has one of",
        ),
        (
            r#"{ "kind": "distance", "to": "outline", "at_zero": 0, "slope": 0 }"#,
            "at_zero: 0 cannot be used: a length",
        ),
        (r#"{ "kind": "distance", "to": "outline", "at_zero": 1, "slope": -1 }"#, "slope: -1 cannot be used"),
        (
            r#"{ "kind": "distance", "shapes": [{ "line": [[0, 0]] }], "at_zero": 1, "slope": 1 }"#,
            "shapes 1: a line needs 2 points",
        ),
        (
            r#"{ "kind": "band", "file": "a.asc", "between": [1, 0], "diameter": 1 }"#,
            "between: write two finite numbers",
        ),
        (
            r#"{ "kind": "depth", "file": "a.asc", "size": "slope" }"#,
            "kind: a layer of the kind \"depth\" needs `triangles`",
        ),
        (
            r#"{ "kind": "depth", "file": "a.asc", "size": "courant", "time_step": 1, "courant": 1, "period": 1 }"#,
            "period: depths with size = \"courant\" have no `period`",
        ),
        (
            r#"{ "kind": "feature-size", "across": 3, "width_from": 2, "width_to": 1 }"#,
            "width_to: 1 cannot be used",
        ),
        (r#"{ "kind": "straits", "across": 0, "width_from": 1, "width_to": 2 }"#, "across: 0 cannot be used"),
        (
            r#"{ "kind": "straits", "across": 4, "width_from": 3, "width_to": 2 }"#,
            "width_to: 2 cannot be used",
        ),
        (
            r#"{ "kind": "depth", "file": "a.asc", "depth_from": 9, "depth_to": 3 }"#,
            "depth_to: 3 cannot be used",
        ),
        (r#"{ "kind": "paint", "quantity": "risk", "mask": [] }"#, "mask: a mask needs a polygon"),
        (
            r#"{ "kind": "paint", "quantity": "risk", "mask": [[[[0, 0], [1, 0]]]] }"#,
            "mask 1: a ring needs 3 points",
        ),
        (
            r#"{ "kind": "paint", "quantity": "risk", "mask": [[[[0, 0], [1, 0], [1, 1]]]], "mask_file": "a" }"#,
            "mask_file: a layer has",
        ),
    ] {
        let message = checked(json).unwrap_err();
        assert!(message.starts_with(expected), "{json} gave {message}");
    }
}

/// Every key of every kind is a key of the table, and each kind refuses the keys of the others.
#[test]
fn the_kinds_and_their_keys_agree() {
    use super::SavedKind::*;
    let all =
        [Paint, Formula, Raster, Threats, Distance, Corridor, Band, Depth, Straits, FeatureSize, Surface];
    let value = |key: &str| match key {
        "quantity" | "as" => r#""risk""#,
        "formula" => r#""x""#,
        "to" => r#""outline""#,
        "bounds" => "[0, 0, 1, 1]",
        "curve" => "[[0, 1]]",
        "threats" | "shapes" => "[]",
        "between" => "[0, 1]",
        "positive" => r#""up""#,
        "size" => r#""slope""#,
        "norm" => r#""l2""#,
        "file" | "layer" => r#""a""#,
        "pieces" => r#"["a"]"#,
        "types" => r#"["land"]"#,
        _ => "1",
    };
    for key in all.iter().flat_map(|kind| kind.keys()) {
        for kind in all {
            let json = format!(r#"{{ "kind": "{}", "{key}": {} }}"#, kind.word(), value(key));
            assert_eq!(saved(&json).given().collect::<Vec<_>>(), [*key]);
            let refused = checked(&json).is_err_and(|message| message.contains(&format!("has no `{key}`")));
            assert_eq!(refused, !kind.keys().contains(key), "{json}");
        }
    }
}

#[test]
fn a_layer_of_a_stack_is_saved() {
    use meshbrush_core::layers::{Combine, FormulaLayer, Layer, LayerKind, Quantity};
    let formula = meshbrush_core::field::Formula::parse("x + 1").unwrap();
    let kind = LayerKind::Formula(FormulaLayer { quantity: Quantity::Diameter, formula });
    let layer = Layer {
        mask: None,
        id: LayerId(3),
        name: "Open sea".into(),
        visible: false,
        locked: true,
        combine: Combine::Floor,
        kind,
    };
    let json = serde_json::to_string(&SavedLayer::of(&layer, None)).unwrap();
    let expected = r#"{"kind":"formula","name":"Open sea","visible":false,"locked":true,"combine":"floor","quantity":"diameter","formula":"x + 1"}"#;
    assert_eq!(json, expected);
    assert_eq!(saved(&json).load(layer.id, &mut InMemory).unwrap(), layer);
}

/// Layers that have all data in place.
struct InMemory;

impl LayerData for InMemory {
    type Error = Fault;

    const STORED: Stored = Stored::InFiles;

    fn raster(&mut self, _: &SavedLayer) -> Result<LoadedRaster, Fault> {
        unreachable!("no layer has a raster")
    }

    fn threats(&mut self, _: &SavedLayer) -> Result<Threats, Fault> {
        unreachable!("threats are in place")
    }

    fn shapes(&mut self, _: &SavedLayer) -> Result<Shapes, Fault> {
        unreachable!("shapes are in place")
    }

    fn mask(&mut self, _: &SavedLayer, _: &Path) -> Result<Mask, Fault> {
        unreachable!("masks are in place")
    }
}

#[derive(Debug)]
struct Fault(#[allow(dead_code)] String);

impl From<KeyFault> for Fault {
    fn from(fault: KeyFault) -> Self {
        Self(fault.to_string())
    }
}

impl From<TextError> for Fault {
    fn from(error: TextError) -> Self {
        Self(error.to_string())
    }
}

/// Whatever a layer of a stack has in place is there again when its text is read.
#[test]
fn a_layer_is_the_same_when_its_text_is_read() {
    for json in [
        r#"{"kind":"formula","name":"A","visible":false,"locked":true,"combine":"floor","quantity":"diameter","formula":"x"}"#,
        r#"{"kind":"threats","name":"T","mask":[[[[0,0],[4,0],[4,3]]]],"threats":[{"x":1,"y":2,"range":3,"peak":0.5,"law":"disc"}]}"#,
        r#"{"kind":"distance","name":"D","to":"outline","at_zero":0.1,"slope":0.2,"range":3}"#,
        r#"{"kind":"distance","name":"S","shapes":[{"line":[[0,0],[1,1]]},{"polygon":[[[0,0],[1,0],[0,1]]]}],"at_zero":0.1,"slope":0.2}"#,
        r#"{"kind":"corridor","name":"C","shapes":[{"line":[[0,0],[1,1]]}],"width":0.3,"at_zero":0.1,"slope":0.2}"#,
        r#"{"kind":"paint","name":"P","quantity":"risk"}"#,
    ] {
        let layer = saved(json).load(LayerId(7), &mut InMemory).unwrap();
        let again = SavedLayer::of(&layer, None).load(LayerId(7), &mut InMemory).unwrap();
        assert_eq!(again, layer, "{json}");
    }
}
