//! The kinds of layers, as `io/layers` has those of a recipe.

use std::sync::Arc;

use glam::DVec2;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryType, PieceChoice};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    BandLayer, Combine, DepthRule, DepthSizes, Depths, DistanceLayer, DistanceTo, FeatureSize, FormulaLayer,
    Layer, LayerId, LayerKind, Mask, MedialAxis, MedialBalls, PositiveDepth, Quantity, RasterLayer,
    RasterReading, Shapes, Straits, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource, Threat, ThreatLaw,
    Threats, ValueCurve,
};
use meshbrush_core::raster::RasterValues;
use meshbrush_mesh::mesh::MOST_TRIANGLES;
use wasm_bindgen::prelude::*;

use crate::errors::{compiled, error};
use crate::rasters::source_of;
use crate::values::{Table, entries, points_of, shapes_of};

/// How layers are combined, and the words for it.
pub const COMBINE: [(&str, Combine); 3] =
    [("finest", Combine::Finest), ("floor", Combine::Floor), ("replace", Combine::Replace)];

const QUANTITIES: [(&str, Quantity); 3] =
    [("diameter", Quantity::Diameter), ("risk", Quantity::Risk), ("error", Quantity::Error)];

/// Returns the layer that a table states, for a document with some settings.
///
/// # Errors
/// Fails for values that cannot be used, with the name of the layer.
pub fn layer_of(
    table: Table<'_>,
    id: LayerId,
    settings: &Settings,
    has_smallest: bool,
) -> Result<Layer, JsError> {
    let kind = kind_of(table, settings)?;
    let mask = table.get("mask").map(|shapes| shapes_of(&shapes)).transpose()?;
    let mask = mask.map(|shapes| Mask::new(&shapes.polygons)).transpose();
    let layer = Layer {
        id,
        name: table.text("name")?.unwrap_or_else(|| kind.label().to_owned()),
        visible: table.flag("visible").unwrap_or(true),
        locked: table.flag("locked").unwrap_or(false),
        combine: table.word("combine", &COMBINE)?.unwrap_or(Combine::Finest),
        mask: mask.map_err(|problem| error(format_args!("The mask cannot be used. {problem}")))?,
        kind,
    };
    if layer.is_of_risk() && !has_smallest {
        return Err(error("Risk needs hMin: the smallest target diameter, where the risk is 1."));
    }
    if layer.follows_outline() {
        let region = settings.domain.as_region().ok_or_else(|| {
            error("There is no distance to the outline of a domain that is given by a formula. Give the domain by polygons.")
        })?;
        Shapes::outline(&region).map_err(error)?;
    }
    Ok(layer)
}

fn kind_of(table: Table<'_>, settings: &Settings) -> Result<LayerKind, JsError> {
    let domain = settings.domain.bounds;
    Ok(match &*table.text("kind")?.unwrap_or_default() {
        "formula" => {
            let quantity = table.word("quantity", &QUANTITIES)?.unwrap_or(Quantity::Diameter);
            let parse = if quantity == Quantity::Diameter { Formula::parse_of_size } else { Formula::parse };
            let text = table.needed("formula", table.text("formula")?)?;
            LayerKind::Formula(FormulaLayer { quantity, formula: compiled("formula", &text, parse)? })
        }
        "raster" => {
            let reading = match (table.word("as", &QUANTITIES)?, table.numbers("curve")) {
                (Some(Quantity::Risk), None) => RasterReading::Risk,
                (Some(Quantity::Diameter), None) => RasterReading::Diameter,
                (Some(Quantity::Error), None) => RasterReading::Error,
                (None, Some(knots)) => {
                    let knots = points_of(&knots, "Points of a curve")?.into_iter().map(<[f64; 2]>::from);
                    RasterReading::Curve(Arc::new(ValueCurve::new(knots.collect()).map_err(error)?))
                }
                _ => {
                    return Err(error(
                        "A raster needs what its values mean: as: \"risk\", as: \"diameter\", as: \"error\", or a curve, as in \
                         curve: [[0, 0.1], [50, 2]].",
                    ));
                }
            };
            LayerKind::Raster(RasterLayer { source: source_of(table, domain, (&reading).into())?, reading })
        }
        "band" => {
            let between @ [least, greatest] = table.needed("between", table.several("between")?)?;
            if !(least <= greatest && least.is_finite() && greatest.is_finite()) {
                return Err(error("between: write two finite numbers, the least value first."));
            }
            let diameter = table.needed("diameter", table.length("diameter")?)?;
            LayerKind::Band(BandLayer {
                source: source_of(table, domain, RasterValues::Any)?,
                between,
                diameter,
            })
        }
        "depth" => {
            LayerKind::Depth(Depths::new(source_of(table, domain, RasterValues::Any)?, depth_sizes(table)?))
        }
        "surface" => surface_of(table, settings)?,
        "threats" => threats_of(table)?,
        "distance" => grown(table, distance_to(table)?)?,
        "corridor" => {
            let width = table.needed("width", table.length("width")?)?;
            grown(table, DistanceTo::Corridor { lines: shapes_in(table, "along")?, width })?
        }
        "straits" => {
            let (across, between) = across_widths(table)?;
            LayerKind::Straits(Straits { across, found: MedialBalls::unknown(between) })
        }
        "featureSize" => {
            let (across, between) = across_widths(table)?;
            LayerKind::FeatureSize(FeatureSize { across, found: MedialAxis::unknown(between) })
        }
        _ => LayerKind::paint(table.word("quantity", &QUANTITIES)?.unwrap_or(Quantity::Diameter)),
    })
}

fn surface_of(table: Table<'_>, settings: &Settings) -> Result<LayerKind, JsError> {
    let norms =
        [("max", SurfaceNorm::Largest), ("l2", SurfaceNorm::RootMeanSquare), ("h1", SurfaceNorm::Gradient)];
    let goal = match (table.number("within")?, table.count("atMost", 1, MOST_TRIANGLES)?) {
        (Some(error), None) => SurfaceGoal::Within(error),
        (None, Some(triangles)) => SurfaceGoal::AtMost(triangles),
        _ => {
            return Err(error(
                "A surface needs one of within, the largest error, and atMost, the most triangles.",
            ));
        }
    };
    let source = match table.text("formula")? {
        Some(text) => SurfaceSource::Formula(compiled("formula", &text, Formula::parse)?),
        None => SurfaceSource::Raster(source_of(table, settings.domain.bounds, RasterValues::Any)?),
    };
    Ok(LayerKind::Surface(Surface { source, goal, norm: table.word("norm", &norms)?.unwrap_or_default() }))
}

fn threats_of(table: Table<'_>) -> Result<LayerKind, JsError> {
    let laws = ThreatLaw::ALL.map(|(law, name)| (name, law));
    let threat = |value: JsValue| -> Result<Threat, JsError> {
        let table = Table(&value);
        let number = |key: &str| table.needed(key, table.number(key)?);
        Ok(Threat {
            at: DVec2::new(number("x")?, number("y")?),
            range: number("range")?,
            peak: table.number("peak")?.unwrap_or(1.0),
            law: table.word("law", &laws)?.unwrap_or_default(),
        })
    };
    let list = entries(table.get("threats")).map(threat).collect::<Result<_, _>>()?;
    let threats = Threats::new(list).map_err(|(number, problem)| {
        error(format_args!("The threat {} cannot be used. {problem}", number + 1))
    })?;
    Ok(LayerKind::Threats(threats))
}

fn distance_to(table: Table<'_>) -> Result<DistanceTo, JsError> {
    if let Some(word) = table.get("to").and_then(|to| to.as_string()) {
        return match &*word {
            "outline" => Ok(DistanceTo::Outline),
            "coasts" => Ok(DistanceTo::Coasts),
            _ => Err(error(format_args!(
                "to: \"{word}\" is not possible here; write one of outline, coasts, or give shapes."
            ))),
        };
    }
    if table.get("to").is_some() {
        return Ok(DistanceTo::Shapes { name: String::new(), shapes: shapes_in(table, "to")? });
    }
    let of_word = |word: &String| {
        let known = BoundaryType::from_word(word);
        known.ok_or_else(|| error(format_args!("types: \"{word}\" is no type of a piece of the boundary.")))
    };
    let types: Vec<BoundaryType> = table.texts("types").iter().map(of_word).collect::<Result<_, _>>()?;
    let names = table.texts("pieces");
    if names.is_empty() && types.is_empty() {
        return Err(error(
            "A distance needs to: \"outline\" or to: \"coasts\", shapes, or the pieces or types of the boundary.",
        ));
    }
    Ok(DistanceTo::Pieces(PieceChoice { names, types }))
}

fn shapes_in(table: Table<'_>, key: &str) -> Result<Shapes, JsError> {
    let shapes = table.needed(key, table.get(key))?;
    Shapes::new(shapes_of(&shapes)?, true).map_err(|problem| error(format_args!("{key}: {problem}")))
}

fn grown(table: Table<'_>, to: DistanceTo) -> Result<LayerKind, JsError> {
    let at_zero = table.needed("atZero", table.length("atZero")?)?;
    let rule = "the growth by unit of distance must be 0 or more, and finite";
    let slope = table.needed("slope", table.number_where("slope", |slope| slope >= 0.0, rule)?)?;
    Ok(LayerKind::Distance(DistanceLayer {
        to,
        at_zero,
        slope,
        range: table.length("range")?.unwrap_or(f64::INFINITY),
    }))
}

/// Returns the number of triangles across water, and the least and the greatest width of it.
fn across_widths(table: Table<'_>) -> Result<(f64, [f64; 2]), JsError> {
    let rule = "a number of triangles must be 1 or more, and finite";
    let across = table.needed("across", table.number_where("across", |across| across >= 1.0, rule)?)?;
    let from = table.needed("widthFrom", table.length("widthFrom")?)?;
    let to = table.number_where("widthTo", |to| to > from, "it must be above widthFrom")?;
    Ok((across, [from, table.needed("widthTo", to)?]))
}

fn depth_sizes(table: Table<'_>) -> Result<DepthSizes, JsError> {
    let positive = |key: &str| {
        table.needed(key, table.number_where(key, |value| value > 0.0, "it must be positive and finite")?)
    };
    let rule = match table.text("size")?.as_deref().unwrap_or("nothing") {
        "nothing" => DepthRule::Nothing,
        "wavelength" => {
            DepthRule::Wavelength { period: positive("period")?, triangles: positive("triangles")? }
        }
        "slope" => DepthRule::Slope {
            triangles: positive("triangles")?,
            smoothing: table.length("smoothing")?.unwrap_or(0.0),
        },
        "courant" => DepthRule::Courant { time_step: positive("timeStep")?, number: positive("courant")? },
        word => {
            let known = "write one of nothing, wavelength, slope, courant";
            return Err(error(format_args!("size: \"{word}\" is not possible here; {known}.")));
        }
    };
    let rule_of_least = "a depth must be 0 or more, and finite";
    let least = table.number_where("depthFrom", |depth| depth >= 0.0, rule_of_least)?.unwrap_or(0.0);
    let greatest = table.number_where("depthTo", |depth| depth > least, "it must be above depthFrom")?;
    Ok(DepthSizes {
        positive: table
            .word("positive", &[("up", PositiveDepth::Up), ("down", PositiveDepth::Down)])?
            .unwrap_or(PositiveDepth::Up),
        offset: table.number_where("offset", |_| true, "it must be finite")?.unwrap_or(0.0),
        between: [least, greatest.unwrap_or(f64::INFINITY)],
        rule,
    })
}
