//! The options on what to mesh, as the tables of settings.

use std::path::{Path, PathBuf};

use glam::DVec2;

use super::args::{BoundaryArgument, EarthArguments, InputArguments};
use super::failure::Failure;
use super::lengths::LengthWithUnit;
use meshbrush_core::field::Formula;
use meshbrush_io::io::layers::{
    FeatureSizeKeys, FormulaKeys, GridKeys, LineSizeKeys, RasterKeys, ReadingKeys, SavedKind, SavedLayer,
    SavedQuantity, StraitKeys, ThreatKeys, WidthKeys,
};
use meshbrush_io::io::lengths::{GroundArea, GroundLength, METRES, SavedLength};
use meshbrush_io::io::settings::{
    SavedDomain, SavedLimits, SavedLine, SavedMesh, SavedOpen, SavedOpenings, SavedParts, SavedSettings,
    SavedTreatment,
};
use meshbrush_io::io::{KeyFault, KeyStep};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Length, LengthUnit};

/// Returns the settings that the options state; every value is checked on its own.
///
/// # Errors
/// Fails with a sentence that names the option, the value and the rule.
pub fn settings(typed: &InputArguments) -> Result<SavedSettings, Failure> {
    let EarthArguments { projection: plane, crs, bounds, land, sea, .. } = &typed.earth;
    let of_region = [("--projection", plane), ("--crs", crs), ("--bounds", bounds)];
    if let (Some((option, Some(value))), None) =
        (of_region.iter().find(|(_, value)| value.is_some()), typed.outline_file())
    {
        return Err(Failure::Usage(format!(
            "{option} {value}: it is for the coordinates of a region. Name the file with --region or --land, or leave it out."
        )));
    }
    let layers = layers(typed)?;
    let region = region(typed, &layers)?;
    let projection = projection(typed)?;
    let settings = SavedSettings {
        domain: SavedDomain {
            bounds: match bounds {
                Some(text) => Some(parse_bounds(text)?),
                None => typed.domain.as_deref().map(parse_domain).transpose()?,
            },
            land: land.clone(),
            sea: sea.as_deref().map(parse_sea).transpose()?,
            inside: typed.inside.clone(),
            region,
            outside_nodata: typed.water.outside_nodata,
            open: openings(&typed.earth.open)?,
            contour: typed.water.contour,
            positive: typed.water.contour.and(typed.water.depth_positive).map(Into::into),
            smallest_island: typed.water.smallest_island.map(GroundArea),
            smallest_inlet: typed.water.smallest_inlet.map(GroundLength),
            crs: typed.earth.crs.clone(),
            projection,
            boundary: typed.boundary.map(Into::into),
            boundary_diameter: value(&typed.boundary_diameter),
            parts: typed.parts.as_deref().map(parts).transpose()?,
            keep_pinches: typed.keep_pinches.then_some(true),
            improve_boundary: typed.improve_boundary.then_some(true),
            ..SavedDomain::default()
        },
        mesh: SavedMesh {
            spacing: value(&typed.spacing),
            rule: typed.rule.map(|rule| meshbrush_core::field::RefinementRule::from(rule).into()),
            max_triangles: typed.max_triangles,
            max_level: typed.max_level,
            max_memory: typed.max_memory.clone(),
        },
        limits: SavedLimits {
            h_min: value(&typed.h_min),
            h_risk: value(&typed.h_risk),
            h_max: value(&typed.h_max),
            shape: typed.transfer_shape,
            gradation: typed.gradation,
        },
        layer: layers.iter().map(|(_, layer)| layer.clone()).collect(),
        line: typed.lines.iter().map(|file| SavedLine::of_file(file)).collect(),
        ..SavedSettings::default()
    };
    settings.check().map_err(|fault| refused(&fault, typed, &layers))?;
    Ok(settings)
}

/// Returns where the boundary is open.
fn openings(typed: &[String]) -> Result<SavedOpenings, Failure> {
    let entries = typed.iter().map(|text| SavedOpen::parse(text));
    let entries = entries.collect::<Result<_, _>>();
    entries.map(SavedOpenings).map_err(|problem| Failure::Usage(format!("--open: {problem}")))
}

/// Returns the projection: lengths in metres need a plane in metres.
fn projection(typed: &InputArguments) -> Result<Option<String>, Failure> {
    let lengths = LengthWithUnit::all(typed);
    let is_metric = lengths.iter().any(LengthWithUnit::is_metric) && typed.outline_file().is_some();
    let projection = typed.earth.projection.clone().or(is_metric.then(|| METRES.to_owned()));
    if projection.as_ref().is_some_and(|word| word != "none") {
        lengths.iter().try_for_each(|length| length.check(LengthUnit::Metre))?;
    }
    Ok(projection)
}

/// Returns the number of a length.
fn value(length: &Option<Length>) -> Option<SavedLength> {
    length.as_ref().map(|length| length.value.into())
}

/// Returns the file of the region: with --outside-nodata alone, the grid of the highest surface.
fn region(typed: &InputArguments, layers: &[(String, SavedLayer)]) -> Result<Option<PathBuf>, Failure> {
    if typed.region.is_some() || !typed.water.outside_nodata || typed.recipe.is_some() {
        return Ok(typed.region.clone());
    }
    let mut surfaces = layers.iter().rev().filter(|(_, layer)| layer.kind() == SavedKind::Surface);
    let file = surfaces.find_map(|(_, layer)| layer.keys.file().map(Path::to_owned));
    let problem = "--outside-nodata needs a grid whose values make the domain: name it with --region, or with --surface";
    file.map(Some).ok_or_else(|| Failure::Usage(format!("{problem}.")))
}

/// Returns the layers of the options, each of which takes the finest, from the bottom of the stack to its
/// top, each with its option as typed.
fn layers(typed: &InputArguments) -> Result<Vec<(String, SavedLayer)>, Failure> {
    let (diameter, risk) = (SavedQuantity::Diameter, SavedQuantity::Risk);
    let mut layers: Vec<(String, SavedLayer)> = Vec::new();
    for (option, texts, quantity) in [("--target", &typed.target, diameter), ("--risk", &typed.risk, risk)] {
        layers.extend(texts.iter().map(|text| {
            let formula =
                Length::with_unit(text).map_or_else(|| text.clone(), |length| length.value.to_string());
            (option.to_owned(), FormulaKeys { quantity, formula }.into())
        }));
    }
    let with_file = |option: &str, path: &Path| format!("{option} {}", path.display());
    for (option, paths, quantity) in [
        ("--target-raster", &typed.target_raster, diameter),
        ("--risk-raster", &typed.risk_raster, risk),
        ("--error-raster", &typed.surfaces.error_raster, SavedQuantity::Error),
    ] {
        layers.extend(paths.iter().map(|path| {
            let grid = GridKeys { file: Some(path.clone()), bounds: None };
            let reading = ReadingKeys { read_as: Some(quantity), curve: None };
            (with_file(option, path), RasterKeys { grid, reading }.into())
        }));
    }
    layers.extend(typed.threats.iter().map(|path| {
        let keys = ThreatKeys { file: Some(path.clone()), threats: None };
        (with_file("--threats", path), keys.into())
    }));
    layers.extend(typed.distances.layers(typed.h_min.as_ref())?);
    layers.extend(typed.water.depth_layers());
    let water = &typed.water;
    let straits = WaterWidths {
        option: "--straits",
        across: water.straits,
        widest: value(&water.widest_strait),
        widest_option: "--widest-strait",
    };
    let feature_size = WaterWidths {
        option: "--feature-size",
        across: water.feature_size,
        widest: value(&water.widest_feature),
        widest_option: "--widest-feature",
    };
    let straits = straits.keys(typed)?;
    layers.extend(straits.map(|(option, widths)| (option, StraitKeys(widths).into())));
    let feature_size = feature_size.keys(typed)?;
    layers.extend(feature_size.map(|(option, widths)| (option, FeatureSizeKeys(widths).into())));
    layers.extend(
        typed.line_sizes.map(|across| (format!("--line-sizes {across}"), LineSizeKeys { across }.into())),
    );
    layers.extend(typed.surfaces.layers());
    Ok(layers)
}

/// An option on the width of water.
struct WaterWidths {
    option: &'static str,
    /// Triangles across, if the option is given.
    across: Option<f64>,
    widest: Option<SavedLength>,
    widest_option: &'static str,
}

impl WaterWidths {
    /// Returns the option as typed, and the keys of its layer, if it is given.
    fn keys(&self, typed: &InputArguments) -> Result<Option<(String, WidthKeys)>, Failure> {
        let Self { option, across, widest, widest_option } = *self;
        let (Some(across), Some(h_min)) = (across, value(&typed.h_min)) else { return Ok(None) };
        let widest = widest.or(value(&typed.h_max).map(|h_max| SavedLength(across * *h_max)));
        let width_to = widest.ok_or_else(|| {
            let problem = format!("the widest water is not known. Give it with {widest_option}, or --h-max");
            Failure::Usage(format!("{option} {across}: {problem}."))
        })?;
        Ok(Some((
            format!("{option} {across}"),
            WidthKeys { across, width_from: SavedLength(across * *h_min), width_to },
        )))
    }
}

/// Returns the sentence for a value that cannot be used, with its option.
fn refused(fault: &KeyFault, typed: &InputArguments, layers: &[(String, SavedLayer)]) -> Failure {
    let with = |option: &str, value: Option<String>| match (value, &fault.given) {
        (Some(value), Some(_)) => format!("{option} {value}"),
        _ => option.to_owned(),
    };
    let length = |option: &str, value: Option<&Length>| with(option, value.map(Length::to_string));
    let option = match &fault.path[..] {
        [KeyStep::Key(table), KeyStep::Index(layer), KeyStep::Key(key), ..] if table == "layer" => {
            match &**key {
                "at_zero" => length(
                    "--distance-at-zero",
                    typed.distances.distance_at_zero.as_ref().or(typed.h_min.as_ref()),
                ),
                "slope" => {
                    with("--distance-slope", typed.distances.distance_slope.map(|slope| slope.to_string()))
                }
                "range" => length("--distance-range", typed.distances.distance_range.as_ref()),
                "width_to" if layers[*layer].1.kind() == SavedKind::Straits => {
                    length("--widest-strait", typed.water.widest_strait.as_ref())
                }
                "within" => with("--max-error", typed.surfaces.max_error.map(|error| error.to_string())),
                "at_most" => with("--at-most", typed.surfaces.at_most.map(|count| count.to_string())),
                "width_to" => length("--widest-feature", typed.water.widest_feature.as_ref()),
                _ => layers[*layer].0.clone(),
            }
        }
        [_, KeyStep::Key(key), ..] => match &**key {
            "inside" => "--inside".to_owned(),
            "bounds" if typed.earth.bounds.is_some() => "--bounds".to_owned(),
            "land" => "--land".to_owned(),
            "sea" => "--sea".to_owned(),
            "projection" => "--projection".to_owned(),
            "crs" => "--crs".to_owned(),
            "contour" => "--contour".to_owned(),
            "smallest_island" => "--smallest-island".to_owned(),
            "smallest_inlet" => "--smallest-inlet".to_owned(),
            "outside_nodata" => "--outside-nodata".to_owned(),
            "boundary_diameter" => length("--boundary-diameter", typed.boundary_diameter.as_ref()),
            "spacing" => length("--spacing", typed.spacing.as_ref()),
            "h_min" => length("--h-min", typed.h_min.as_ref()),
            "h_risk" if fault.given.is_some() => length("--h-risk", typed.h_risk.as_ref()),
            "gradation" => "--gradation".to_owned(),
            "max_triangles" => format!("--max-triangles {}", typed.max_triangles.unwrap_or_default()),
            "max_memory" => format!("--max-memory {}", typed.max_memory.as_deref().unwrap_or_default()),
            "h_max" if fault.given.is_some() => length("--h-max", typed.h_max.as_ref()),
            // The sentences about the curve name its numbers.
            _ => return Failure::Usage(fault.full_sentence()),
        },
        _ => return Failure::Usage(fault.to_string()),
    };
    let pointer = fault.part.as_ref().map(|part| format!("\n    {}", part.pointer.replace('\n', "\n    ")));
    Failure::Usage(format!("{option}: {}{}", fault.sentence, pointer.unwrap_or_default()))
}

/// Returns the parts of the mesh that stay.
fn parts(text: &str) -> Result<SavedParts, Failure> {
    match text {
        "all" => Ok(SavedParts::All),
        "largest" => Ok(SavedParts::Largest),
        share => match share.parse() {
            Ok(share) if (0.0..=1.0).contains(&share) => Ok(SavedParts::Share(share)),
            _ => Err(Failure::Usage(format!(
                "--parts {share}: write largest, all, or a share of the area from 0 to 1, as in 0.01."
            ))),
        },
    }
}

/// Compiles a formula.
///
/// # Errors
/// Fails with the mistake and, on separate lines, the formula and carets under the mistake.
pub fn parse_formula(option: &str, text: &str) -> Result<Formula, Failure> {
    Formula::parse(text).map_err(|mistake| {
        let pointer = mistake.pointer().replace('\n', "\n    ");
        Failure::Usage(format!("{option}: {mistake}\n    {pointer}"))
    })
}

/// Returns numbers that are written with commas between.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    numbers.ok()?.try_into().ok()
}

fn parse_domain(text: &str) -> Result<[f64; 4], Failure> {
    let Some([x0, y0, x1, y1]) = numbers(text) else {
        let problem = format!("--domain {text}: write four numbers with commas between, X0,Y0,X1,Y1");
        return Err(Failure::Usage(format!("{problem}, as in 0,0,1,1.")));
    };
    let domain = Rect::new(DVec2::new(x0, y0), DVec2::new(x1, y1));
    if !domain.is_proper() {
        return Err(Failure::Usage(format!("--domain {text}: write x0,y0,x1,y1 with {}.", Rect::PROPER)));
    }
    Ok([x0, y0, x1, y1])
}

/// Returns west, south, east and north.
fn parse_bounds(text: &str) -> Result<[f64; 4], Failure> {
    let problem = format!("--bounds {text}: write west, south, east and north with commas between");
    numbers(text).ok_or_else(|| Failure::Usage(format!("{problem}, as in -6,47,-2,49.")))
}

/// Returns a place in the sea.
fn parse_sea(text: &str) -> Result<[f64; 2], Failure> {
    let problem = format!("--sea {text}: write the two coordinates of a place with a comma between");
    numbers(text).ok_or_else(|| Failure::Usage(format!("{problem}, as in -5,48.")))
}

impl From<BoundaryArgument> for SavedTreatment {
    fn from(typed: BoundaryArgument) -> Self {
        match typed {
            BoundaryArgument::Report => Self::Report,
            BoundaryArgument::Fitted => Self::Fitted,
            BoundaryArgument::Outline => Self::Outline,
        }
    }
}
