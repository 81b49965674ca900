//! The layers of a document, and strokes on them.

use meshbrush_core::document::Setting;
use meshbrush_core::layers::{Depths, Layer, LayerId};
use meshbrush_core::paint::{Brush, Medium, Mirror};
use meshbrush_io::io::layers::{SavedCombine, SavedKind, SavedLayer};
use meshbrush_io::io::recipe::{BesideLayer, LoadedLayer, Loading};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::points_of;
use crate::document::{Document, State, frame_of, lock};
use crate::errors::{fault_in, load_error, mesh_error};
use crate::values::{GivenData, GivenLength, given_of, text_value};
use crate::work::{Watching, run};

/// Paint of another project is not part of a layer.
const OTHER_PAINT: &str = "What another project has painted cannot be added to a document that is there. Open that project, or \
     read a recipe that names it.";

/// A layer as Python shows it: identifier, name, kind, whether it is visible and locked, and how it is
/// combined.
type LayerRow = (u32, String, &'static str, bool, bool, &'static str);

#[pymethods]
impl Document {
    /// Adds a layer on top, from a table with the keys of a recipe, and returns its identifier, with notes
    /// for a person.
    fn add_layer(
        &self,
        py: Python<'_>,
        table: &Bound<'_, PyDict>,
        given: Vec<(String, GivenData<'_>)>,
    ) -> PyResult<(u32, Vec<String>)> {
        let (frame, others) = self.with(py, |state| (frame_of(state), beside_layer(state)));
        let given = given_of(given, Some(frame))?;
        let table = text_value(table)?;
        let saved =
            SavedLayer::of_value(&table, &others, &given).map_err(|fault| fault_in(&table, &fault))?;
        let state = self.state.clone();
        let loaded = run(py, &Watching::QUIET, move |watch| {
            let loading = Loading { given, ..Loading::for_document(&watch.meter) };
            let (settings, assumed) = {
                let state = lock(&state);
                (state.document.settings().clone(), state.assumed)
            };
            saved.load_for(LayerId(0), &settings, assumed, &loading)
        })?;
        let LoadedLayer { layer, paint, notes } = loaded.map_err(|error| load_error(&table, &error))?;
        if paint.is_some() {
            return Err(mesh_error(OTHER_PAINT));
        }
        let id = self.with(py, |state| add(state, layer))?;
        Ok((id, notes))
    }

    /// The layers, from the bottom to the top.
    fn layers(&self, py: Python<'_>) -> Vec<LayerRow> {
        self.with(py, |state| state.document.settings().layers.iter().map(row_of).collect())
    }

    /// Removes a layer.
    fn remove_layer(&self, py: Python<'_>, id: u32) -> PyResult<()> {
        self.with(py, |state| {
            change_layer(state, id, |layers, place| {
                layers.remove(place);
            })
        })
    }

    /// Moves a layer to a place in the stack, counted from 0 at the bottom.
    fn move_layer(&self, py: Python<'_>, id: u32, place: usize) -> PyResult<()> {
        self.with(py, |state| {
            change_layer(state, id, |layers, from| {
                let layer = layers.remove(from);
                layers.insert(place.min(layers.len()), layer);
            })
        })
    }

    /// Changes what a table states of a layer: `name`, `visible`, `locked`, `combine`.
    fn change_layer(&self, py: Python<'_>, id: u32, table: &Bound<'_, PyDict>) -> PyResult<()> {
        let change = LayerChange::of(table)?;
        self.with(py, |state| change_layer(state, id, |layers, place| change.apply(&mut layers[place])))
    }

    /// Paints a line through points as one edit. `quantity` is "diameter", "risk" or "eraser". The radius of
    /// a stroke is a length on the Earth at its first point.
    #[expect(clippy::too_many_arguments, reason = "a brush, and where it goes")]
    fn paint(
        &self,
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        quantity: &str,
        value: GivenLength,
        change: &str,
        radius: GivenLength,
        hardness: f64,
        strength: f64,
        mirror: (Option<f64>, Option<f64>),
        continues: bool,
    ) -> PyResult<()> {
        let points = points_of(&points)?;
        if let Some(point) = points.iter().find(|point| !point.is_finite()) {
            return Err(mesh_error(format!("A stroke through {}, {} is impossible.", point.x, point.y)));
        }
        let domain_and_unit = |state: &mut State| {
            let settings = state.document.settings();
            (settings.domain.clone(), settings.unit)
        };
        let (domain, unit) = self.with(py, domain_and_unit);
        let value = value.in_unit("diameter", unit)?;
        let radius = radius.in_unit("radius", unit)?;
        if !(radius > 0.0 && radius.is_finite()) {
            let rule = "a radius is positive and finite";
            return Err(mesh_error(format!("radius: {radius} cannot be used: {rule}.")));
        }
        let radius = points.first().map_or(radius, |&first| domain.in_plane(radius, first));
        let medium = Medium::named(quantity, value, change).map_err(mesh_error)?;
        let brush = Brush { medium, radius, hardness, strength };
        let state = self.state.clone();
        let painted = run(py, &Watching::QUIET, move |watch| {
            let mut state = lock(&state);
            if matches!(brush.medium, Medium::Risk(_)) && !state.has_smallest {
                return Err("Risk needs h_min: the smallest target diameter, where the risk is 1.".to_owned());
            }
            if !(continues && state.document.stroke().is_some()) {
                state.document.layer_for_or_new(&brush.medium).map_err(|error| error.to_string())?;
                state.document.begin_mirrored_stroke(brush, Mirror { x: mirror.0, y: mirror.1 });
            }
            let unheard = points.iter().take_while(|_| !watch.is_cancelled());
            unheard.for_each(|&point| state.document.draw_to(point));
            Ok::<_, String>(())
        })?;
        painted.map_err(mesh_error)
    }

    /// Ends the current stroke: it becomes one edit, or was never drawn.
    fn end_stroke(&self, py: Python<'_>, keep: bool) {
        self.with(
            py,
            |state| if keep { state.document.end_stroke() } else { state.document.cancel_stroke() },
        );
    }
}

fn beside_layer(state: &State) -> BesideLayer {
    let layers = &state.document.settings().layers;
    let depths = layers.iter().any(|layer| layer.kind.is::<Depths>());
    BesideLayer { smallest: state.has_smallest, depths, unit: state.document.settings().unit }
}

/// Adds a layer on top of a document.
fn add(state: &mut State, mut layer: Layer) -> PyResult<u32> {
    let id = state.document.unused_layer_id();
    layer.id = id;
    let is_paint = layer.paints().is_some();
    change_layers(state, |layers| layers.push(layer))?;
    if is_paint {
        state.document.activate_layer(id);
    }
    Ok(id.0)
}

/// Changes the layers at the place of one of them.
fn change_layer(state: &mut State, id: u32, change: impl FnOnce(&mut Vec<Layer>, usize)) -> PyResult<()> {
    let place = state.document.settings().layers.iter().position(|layer| layer.id.0 == id);
    let place = place.ok_or_else(|| mesh_error("The layer is no longer in its document."))?;
    change_layers(state, |layers| change(layers, place))
}

fn change_layers(state: &mut State, change: impl FnOnce(&mut Vec<Layer>)) -> PyResult<()> {
    let mut layers = state.document.settings().layers.clone();
    change(&mut layers);
    state.document.end_gesture();
    let set = state.document.set(Setting::Layers(layers)).map_err(mesh_error);
    state.document.end_gesture();
    set
}

fn row_of(layer: &Layer) -> LayerRow {
    let kind = SavedKind::of(layer).word();
    let combine = match layer.combine.into() {
        SavedCombine::Finest => "finest",
        SavedCombine::Floor => "floor",
        SavedCombine::Replace => "replace",
    };
    (layer.id.0, layer.name.clone(), kind, layer.visible, layer.locked, combine)
}

/// What changes of a layer, read with the words of recipes.
struct LayerChange {
    name: Option<String>,
    visible: Option<bool>,
    locked: Option<bool>,
    combine: Option<SavedCombine>,
}

impl LayerChange {
    fn of(table: &Bound<'_, PyDict>) -> PyResult<Self> {
        let get = |key: &str| table.get_item(key);
        let words = [
            ("finest", SavedCombine::Finest),
            ("floor", SavedCombine::Floor),
            ("replace", SavedCombine::Replace),
        ];
        let combine = get("combine")?.map(|value| value.extract::<String>()).transpose()?;
        let combine = combine.map(|word| {
            let known = words.into_iter().find(|(known, _)| *known == word);
            known.map(|(_, combine)| combine).ok_or_else(|| {
                mesh_error(format!(
                    "combine: \"{word}\" is not possible here; write one of finest, floor, replace."
                ))
            })
        });
        Ok(Self {
            name: get("name")?.map(|value| value.extract()).transpose()?,
            visible: get("visible")?.map(|value| value.extract()).transpose()?,
            locked: get("locked")?.map(|value| value.extract()).transpose()?,
            combine: combine.transpose()?,
        })
    }

    fn apply(&self, layer: &mut Layer) {
        layer.name = self.name.clone().unwrap_or_else(|| layer.name.clone());
        layer.visible = self.visible.unwrap_or(layer.visible);
        layer.locked = self.locked.unwrap_or(layer.locked);
        layer.combine = self.combine.map_or(layer.combine, Into::into);
    }
}
