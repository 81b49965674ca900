use std::path::Path;
use std::sync::Arc;

use super::*;
use glam::DVec2;

use crate::io::lengths::TextContext;
use crate::io::{KeyFault, TextValue};
use meshbrush_core::layers::{
    BandLayer, Combine, DepthRule, DepthSizes, Depths, DistanceLayer, FormulaLayer, Layer, LayerId,
    LayerKind, Mask, PositiveDepth, Quantity, ShapeList, Shapes, Threat, ThreatLaw, Threats,
};
use meshbrush_core::raster::{Raster, RasterPyramid, RasterValues};
use meshbrush_mesh::geometry::Rect;

fn saved(json: &str) -> SavedLayer {
    serde_json::from_str(json).unwrap_or_else(|error| panic!("{json}: {error}"))
}

fn checked(json: &str) -> Result<SavedLayer, String> {
    let table: TextValue = serde_json::from_str(json).unwrap_or_else(|error| panic!("{json}: {error}"));
    let layer = SavedLayer::of_table(table, &TextContext::default());
    let layer = layer.and_then(|layer| layer.check(Stored::InFiles).map(|()| layer));
    layer.map_err(|fault| fault.to_string())
}

fn loaded(json: &str) -> LayerKind {
    checked(json).unwrap().load(LayerId(0), &mut InMemory).unwrap().kind
}

#[test]
fn every_kind_is_read_from_its_keys() {
    let full = r#"{ "kind": "formula", "quantity": "risk", "formula": "x", "name": "Storm", "visible": false,
        "locked": true, "combine": "replace", "mask": [[[[0, 0], [4, 0], [4, 3], [0, 0]]]] }"#;
    let layer = saved(full);
    assert_eq!((layer.shown_name(), layer.shared.visible, layer.shared.locked), ("Storm", false, true));
    assert_eq!(layer.shared.combine, SavedCombine::Replace);
    let polygons = layer.mask_in_place().unwrap().unwrap();
    assert_eq!(polygons[0][0].len(), 3, "the repeated first point is removed");
    for (json, expected) in [
        (r#"{ "kind": "paint", "quantity": "diameter" }"#, "Paint(PaintLayer { quantity: Diameter })"),
        (
            r#"{ "kind": "distance", "to": "outline", "at_zero": 0.1, "slope": 0.2 }"#,
            "Distance(DistanceLayer { to: Outline, at_zero: 0.1, slope: 0.2, range: inf })",
        ),
        (
            r#"{ "kind": "distance", "to": "coasts", "at_zero": 0.1, "slope": 0.2 }"#,
            "Distance(DistanceLayer { to: Coasts, at_zero: 0.1, slope: 0.2, range: inf })",
        ),
        (
            r#"{ "kind": "distance", "pieces": ["Rock"], "types": ["land", "no-slip inflow"], "at_zero": 0.1, "slope": 0.2, "range": 5 }"#,
            "Distance(DistanceLayer { to: Pieces(PieceChoice { names: [\"Rock\"], types: [Land, NoSlipInflow] }), at_zero: 0.1, slope: 0.2, range: 5.0 })",
        ),
    ] {
        assert_eq!(format!("{:?}", loaded(json)), expected, "{json}");
    }
    let threats = loaded(r#"{ "kind": "threats", "threats": [{ "x": 1, "y": 2, "range": 3 }] }"#);
    let threat = Threat { at: DVec2::new(1.0, 2.0), range: 3.0, peak: 1.0, law: ThreatLaw::Radar };
    assert_eq!(threats.get::<Threats>().unwrap().list(), [threat]);
    let json =
        r#"{ "kind": "distance", "shapes": [{ "point": [1, 2] }], "at_zero": 0.1, "slope": 0, "range": 5 }"#;
    let to_shapes = loaded(json);
    let shapes = to_shapes.get::<DistanceLayer>().unwrap().to.shapes().unwrap();
    assert_eq!(shapes.list(), &ShapeList { points: vec![DVec2::new(1.0, 2.0)], ..ShapeList::default() });
    let band = loaded(r#"{ "kind": "band", "file": "depth.asc", "between": [-20, 0], "diameter": 0.5 }"#);
    let band = band.get::<BandLayer>().unwrap();
    assert_eq!((&*band.source.name, band.between, band.diameter), ("depth.asc", [-20.0, 0.0], 0.5));
    let nothing = DepthSizes {
        positive: PositiveDepth::Up,
        offset: 0.0,
        between: [0.0, f64::INFINITY],
        rule: DepthRule::Nothing,
    };
    let depths = loaded(r#"{ "kind": "depth", "file": "depth.asc" }"#);
    assert_eq!(depths.get::<Depths>().unwrap().sizes(), &nothing);
    let depths = loaded(
        r#"{ "kind": "depth", "file": "d.asc", "positive": "down", "size": "wavelength", "period": 10,
            "triangles": 8, "offset": -1.5, "depth_to": 50 }"#,
    );
    let expected = DepthSizes {
        positive: PositiveDepth::Down,
        offset: -1.5,
        between: [0.0, 50.0],
        rule: DepthRule::Wavelength { period: 10.0, triangles: 8.0 },
    };
    assert_eq!(depths.get::<Depths>().unwrap().sizes(), &expected);
}

#[test]
fn a_layer_is_saved_as_it_was_read() {
    for json in [
        r#"{"name":"A","kind":"formula","visible":false,"locked":true,"combine":"floor","quantity":"diameter","formula":"x"}"#,
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
        (r#"{ "kind": "lines", "across": 0 }"#, "across: 0 cannot be used"),
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

/// A text of each kind, with all keys that it can have at a time.
const FULL: [&str; 15] = [
    r#"{"kind":"paint","quantity":"risk","file":"a.meshbrush","layer":"Storm"}"#,
    r#"{"kind":"formula","quantity":"risk","formula":"x"}"#,
    r#"{"kind":"raster","file":"a.asc","bounds":[0.0,0.0,1.0,2.0],"as":"risk"}"#,
    r#"{"kind":"raster","file":"a.asc","bounds":[0.0,0.0,1.0,2.0],"curve":[[0.0,1.0]]}"#,
    r#"{"kind":"threats","threats":[{"x":1.0,"y":2.0,"range":3.0,"peak":0.5,"law":"disc"}]}"#,
    r#"{"kind":"distance","to":"outline","at_zero":0.1,"slope":0.2,"range":3.0}"#,
    r#"{"kind":"distance","pieces":["Rock"],"types":["land"],"at_zero":0.1,"slope":0.2}"#,
    r#"{"kind":"corridor","shapes":[{"line":[[0.0,0.0],[1.0,1.0]]}],"width":0.3,"at_zero":0.1,"slope":0.2}"#,
    r#"{"kind":"band","file":"a.asc","bounds":[0.0,0.0,1.0,2.0],"between":[0.0,1.0],"diameter":2.0}"#,
    r#"{"kind":"depth","file":"a.asc","positive":"up","offset":1.0,"size":"slope","triangles":8.0,"smoothing":2.0,"depth_from":1.0,"depth_to":9.0}"#,
    r#"{"kind":"depth","file":"a.asc","size":"courant","time_step":1.0,"courant":0.7}"#,
    r#"{"kind":"straits","across":3.0,"width_from":1.0,"width_to":2.0}"#,
    r#"{"kind":"feature-size","across":3.0,"width_from":1.0,"width_to":2.0}"#,
    r#"{"kind":"lines","across":2.0}"#,
    r#"{"kind":"surface","formula":"x","within":0.1,"norm":"l2"}"#,
];

/// Each kind refuses the keys of the others, and names those of its own.
#[test]
fn the_kinds_and_their_keys_agree() {
    let all: Vec<&str> = SavedKind::ALL.iter().flat_map(|kind| kind.keys()).collect();
    for text in FULL {
        let layer = checked(text).unwrap_or_else(|message| panic!("{text}: {message}"));
        assert_eq!(serde_json::to_string(&layer).unwrap(), text);
        let own = layer.kind().keys();
        for key in all.iter().filter(|key| !own.contains(key)) {
            let message = checked(&text.replacen('{', &format!("{{\"{key}\":1,"), 1)).unwrap_err();
            let word = layer.kind().word();
            let expected = format!("{key}: a layer of the kind \"{word}\" has no `{key}`; its own keys are ");
            assert!(message.starts_with(&expected), "{message}");
        }
    }
    let kinds = FULL.map(|text| checked(text).unwrap().kind().word());
    assert!(SavedKind::ALL.iter().all(|kind| kinds.contains(&kind.word())));
}

#[test]
fn advice_on_an_unknown_key_names_only_keys_of_its_kind() {
    let sentence = |kind: &str, key: &str| {
        let json = format!(r#"{{ "kind": "{kind}", "{key}": 1 }}"#);
        checked(&json).unwrap_err()
    };
    let raster = sentence("raster", "boundz");
    assert!(raster.starts_with("boundz: there is no key `boundz` here"), "{raster}");
    assert!(raster.ends_with("did you mean `bounds`?"), "{raster}");
    let formula = sentence("formula", "boundz");
    let keys = "name, kind, visible, locked, combine, mask, mask_file, quantity, formula.";
    assert!(formula.ends_with(&format!("the keys here are {keys}")), "{formula}");
    for kind in SavedKind::ALL {
        for key in kind.keys() {
            let wrong = sentence(kind.word(), &format!("{key}z"));
            let Some((_, advice)) = wrong.split_once("did you mean `") else { continue };
            let advice = advice.trim_end_matches("`?");
            assert!(kind.keys().contains(&advice) || keys.contains(advice), "{kind:?}: {advice}");
        }
    }
}

#[test]
fn a_layer_of_a_stack_is_saved() {
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
    let json = serde_json::to_string(&SavedLayer::of(&layer, None, ListsInPlace::ALL)).unwrap();
    let expected = r#"{"name":"Open sea","kind":"formula","visible":false,"locked":true,"combine":"floor","quantity":"diameter","formula":"x + 1"}"#;
    assert_eq!(json, expected);
    assert_eq!(saved(&json).load(layer.id, &mut InMemory).unwrap(), layer);
}

/// Layers that have all data in place.
struct InMemory;

impl LayerData for InMemory {
    type Error = Fault;

    const STORED: Stored = Stored::InFiles;

    fn raster(&mut self, _: &LayerOrigin, _: &GridKeys, _: RasterValues) -> Result<LoadedRaster, Fault> {
        let raster = Raster::from_values(Rect::UNIT, [2, 2], vec![0.0, 1.0, 2.0, 3.0]);
        Ok(Arc::new(RasterPyramid::new(raster)).into())
    }

    fn threats(&mut self, _: &LayerOrigin) -> Result<Threats, Fault> {
        unreachable!("threats are in place")
    }

    fn shapes(&mut self, _: &LayerOrigin) -> Result<Shapes, Fault> {
        unreachable!("shapes are in place")
    }

    fn mask(&mut self, _: &LayerOrigin, _: &Path) -> Result<Mask, Fault> {
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
        let again = SavedLayer::of(&layer, None, ListsInPlace::ALL).load(LayerId(7), &mut InMemory).unwrap();
        assert_eq!(again, layer, "{json}");
    }
}
