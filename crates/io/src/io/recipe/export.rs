//! A document as a recipe, with files beside it for what is long or has no form as text.

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::atomic::{Draft, obstacle, put_in_place};
use super::super::layers::{GridKeys, ListsInPlace, MOST_IN_PLACE, PaintKeys, SavedLayer};
use super::super::project::{self, Project};
use super::super::settings::{SavedKeepOut, SavedOutput, SavedSettings};
use super::super::{Meter, asc, geojson, shapes, threats};
use super::{MOST_BYTES, to_text, too_long};
use meshbrush_core::document::{KeepOut, Settings};
use meshbrush_core::domain::{MOST_CORNERS, Polygon, RegionError};
use meshbrush_core::layers::{
    DistanceLayer, Layer, Mask, PaintLayers, RasterLayer, RasterReading, RasterSource, ShapeList, Shapes,
    Threats,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;

/// The extension of polygons and shapes.
const GEOJSON: &str = "geojson";

/// A recipe and the files beside it that it names.
#[derive(Debug)]
pub struct RecipeFiles {
    /// The recipe is the last: it is put in place when the files are there.
    files: Vec<(PathBuf, ExportContent)>,
    /// Whether the document has a background picture, which recipes have no keys for.
    without_background: bool,
}

#[derive(Debug)]
enum ExportContent {
    Recipe(String),
    Polygons(Vec<Polygon>),
    Shapes(Shapes),
    Threats(Threats),
    Grid(Arc<RasterPyramid>, AtInfinity),
    Paint(Box<Project>),
}

/// The meaning of the value ∞ of a raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AtInfinity {
    /// The layer asks for nothing, as where there is no value.
    Nothing,
    /// The end of the layer's curve.
    EndOfCurve,
}

impl RecipeFiles {
    /// Returns the recipe of a document, at `path`. Files beside it are named after it and the layers:
    /// `coast.toml` has `coast-slopes.asc`. Blank paint layers, which ask for nothing, are left out.
    pub fn new(project: &Project, path: &Path) -> Self {
        Self::with_outputs(project, path, Vec::new())
    }

    /// Returns the recipe of a document as [`Self::new`] does, with the files that it asks for.
    pub fn with_outputs(project: &Project, path: &Path, output: Vec<SavedOutput>) -> Self {
        let mut plan = Plan::new(path);
        let Project { settings, paint } = project;
        let region = settings.domain.region().map(|region| {
            let polygons = ExportContent::Polygons(region.polygons().to_vec());
            plan.add("domain", GEOJSON, polygons)
        });
        let painted: Vec<Layer> = settings.layers.iter().filter(|l| is_painted(l, paint)).cloned().collect();
        let paint_file = (!painted.is_empty()).then(|| {
            let stored = ExportContent::Paint(Box::new(paint_project(settings, painted.clone(), paint)));
            plan.add("paint", project::ENDING, stored)
        });
        let mut layers = Vec::new();
        for layer in &settings.layers {
            match (layer.paints(), painted.iter().position(|other| other.id == layer.id)) {
                (None, _) => layers.push(plan.layer(layer)),
                (Some(quantity), Some(number)) => {
                    let there = unique_names(&painted).swap_remove(number);
                    let file = paint_file.clone().map(Into::into);
                    let keys = PaintKeys { quantity: quantity.into(), file, layer: Some(there) };
                    layers.push(SavedLayer { keys: keys.into(), ..plan.layer(layer) });
                }
                (Some(_), None) => {}
            }
        }
        let keep_out = settings.paths.keep_out.iter().map(|region| plan.keep_out(region)).collect();
        let region = region.as_deref().unwrap_or_default();
        let recipe = SavedSettings { output, ..SavedSettings::of(settings, region, layers, keep_out) };
        plan.files.push((path.to_owned(), ExportContent::Recipe(to_text(&recipe))));
        Self { files: plan.files, without_background: settings.background.is_some() }
    }

    /// Returns what of the document is in no recipe, as a sentence; none where nothing is left out.
    pub fn left_out(&self) -> Option<&'static str> {
        self.without_background.then_some(
            "Not saved in the recipe: the background picture. It does not change the mesh; a project keeps it.",
        )
    }

    /// Returns the files, the recipe last.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|(path, _)| path.as_path())
    }

    /// Writes all files, or none if that fails or is cancelled. Existing files are replaced, but for
    /// read-only ones.
    ///
    /// # Errors
    /// Fails with the errors of the file system, when the work was cancelled, and when a file is read-only or
    /// would be too large to be read.
    pub fn write(&self, meter: &Meter) -> io::Result<()> {
        for (path, content) in &self.files {
            let problem = obstacle(path).or_else(|| content.problem());
            if let Some(problem) = problem {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                return Err(io::Error::other(format!("{name}: {problem}")));
            }
        }
        let draft = |(path, content): &(PathBuf, ExportContent)| {
            Draft::write(path, meter, |out| content.write(&mut meter.count(out)))
        };
        let drafts: Vec<Draft> = self.files.iter().map(draft).collect::<io::Result<_>>()?;
        put_in_place(drafts, meter)
    }
}

impl ExportContent {
    /// Returns why it could not be read after it is written, as a sentence without its full stop.
    fn problem(&self) -> Option<String> {
        let problem = match self {
            Self::Recipe(text) => (text.len() as u64 > MOST_BYTES).then(too_long),
            Self::Shapes(list) => shapes::check(list.list()).err().map(|flaw| flaw.to_string()),
            Self::Polygons(polygons) => {
                let corners = polygons.iter().flatten().map(Vec::len).sum();
                let error = RegionError::TooManyCorners { corners };
                (corners > MOST_CORNERS).then(|| error.to_string())
            }
            Self::Threats(_) | Self::Grid(..) | Self::Paint(_) => None,
        };
        problem.map(|sentence| sentence.trim_end_matches('.').to_owned())
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Recipe(text) => out.write_all(text.as_bytes()),
            Self::Polygons(polygons) => geojson::write(out, polygons),
            Self::Shapes(list) => shapes::write(out, list.list()),
            Self::Threats(list) => threats::write(out, list.list()),
            Self::Grid(raster, infinity) => asc::write(out, &finite(raster.raster(), *infinity)),
            Self::Paint(project) => project::write(out, project),
        }
    }
}

/// Returns the raster without infinite values, which the format does not have.
fn finite(raster: &Raster, infinity: AtInfinity) -> Raster {
    let value = |&value: &f32| match infinity {
        AtInfinity::Nothing if value == f32::INFINITY => f32::NAN,
        _ if value.is_infinite() => f32::MAX.copysign(value),
        _ => value,
    };
    Raster::from_values(raster.bounds(), raster.size(), raster.values().iter().map(value).collect())
}

/// The files of a recipe, as they are found.
struct Plan {
    folder: PathBuf,
    stem: String,
    taken: BTreeSet<String>,
    grids: Vec<(Arc<RasterPyramid>, AtInfinity, String)>,
    files: Vec<(PathBuf, ExportContent)>,
}

impl Plan {
    fn new(path: &Path) -> Self {
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Self { folder, stem, taken: BTreeSet::new(), grids: Vec::new(), files: Vec::new() }
    }

    /// Adds a file, and returns its name.
    fn add(&mut self, what: &str, ending: &str, content: ExportContent) -> String {
        let word = file_word(what);
        let candidates = std::iter::once(word.clone()).chain((2..).map(|n| format!("{word}-{n}")));
        let mut names = candidates.map(|word| format!("{}-{word}.{ending}", self.stem));
        let name = names.find(|name| !self.taken.contains(name)).expect("there are names without end");
        self.taken.insert(name.clone());
        self.files.push((self.folder.join(&name), content));
        name
    }

    /// Returns a layer as the recipe has it, with its data in place or in files.
    fn layer(&mut self, layer: &Layer) -> SavedLayer {
        let file = self.list_file(layer);
        let mask_file =
            layer.mask.as_ref().and_then(|mask| self.mask_file(mask, &format!("{} mask", layer.name)));
        let in_place = ListsInPlace { data: file.is_none(), mask: mask_file.is_none() };
        let mut saved = SavedLayer::of(layer, file.map(Into::into), in_place);
        saved.shared.mask_file = mask_file.map(Into::into);
        if let (Some(source), Some(grid)) = (layer.kind.raster_source(), saved.keys.grid_mut()) {
            *grid = self.grid(layer, source);
        }
        saved
    }

    /// Returns the name of a file for the shapes or the threats of a layer, if they are too long for the
    /// recipe.
    fn list_file(&mut self, layer: &Layer) -> Option<String> {
        if let Some(threats) = layer.kind.get::<Threats>() {
            let is_long = threats.list().len() > MOST_IN_PLACE;
            return is_long.then(|| self.add(&layer.name, "csv", ExportContent::Threats(threats.clone())));
        }
        let shapes = layer.kind.get::<DistanceLayer>()?.to.shapes()?;
        let is_long = point_count(shapes.list()) > MOST_IN_PLACE;
        is_long.then(|| self.add(&layer.name, GEOJSON, ExportContent::Shapes(shapes.clone())))
    }

    /// Returns a keep-out region as the recipe has it, with its polygons in place or in a file.
    fn keep_out(&mut self, region: &KeepOut) -> SavedKeepOut {
        let in_place = SavedKeepOut::of(region);
        match self.mask_file(&region.mask, &format!("{} keep-out", region.name)) {
            Some(file) => SavedKeepOut { polygons: None, file: Some(file.into()), ..in_place },
            None => in_place,
        }
    }

    /// Returns the name of a file for the polygons of a mask, if they are too long for the recipe.
    fn mask_file(&mut self, mask: &Mask, what: &str) -> Option<String> {
        let is_long = mask.polygons().iter().flatten().flatten().count() > MOST_IN_PLACE;
        is_long.then(|| self.add(what, GEOJSON, ExportContent::Polygons(mask.polygons().to_vec())))
    }

    /// Returns the file of a layer's raster. Layers that read the same raster name the same file.
    fn grid(&mut self, layer: &Layer, source: &RasterSource) -> GridKeys {
        let infinity = match layer.kind.get() {
            Some(RasterLayer { reading: RasterReading::Curve(_), .. }) => AtInfinity::EndOfCurve,
            _ => AtInfinity::Nothing,
        };
        let is_same = |(raster, other, _): &&(Arc<RasterPyramid>, AtInfinity, String)| {
            Arc::ptr_eq(raster, &source.raster) && *other == infinity
        };
        let known = self.grids.iter().find(is_same).map(|(_, _, name)| name.clone());
        let name = known.unwrap_or_else(|| {
            let grid = ExportContent::Grid(source.raster.clone(), infinity);
            let name = self.add(&layer.name, "asc", grid);
            self.grids.push((source.raster.clone(), infinity, name.clone()));
            name
        });
        let raster = source.raster.raster();
        let Rect { min, max } = raster.bounds();
        let is_other = asc::bounds_as_written(raster) != raster.bounds();
        GridKeys { file: Some(name.into()), bounds: is_other.then_some([min.x, min.y, max.x, max.y]) }
    }
}

/// Returns a name as a part of a file name: lower-case letters, digits and hyphens.
fn file_word(name: &str) -> String {
    let parts = name.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty());
    let word = parts.collect::<Vec<_>>().join("-").to_lowercase();
    let word: String = word.chars().take(60).collect();
    if word.is_empty() { "layer".to_owned() } else { word }
}

fn point_count(list: &ShapeList) -> usize {
    let lines: usize = list.lines.iter().map(Vec::len).sum();
    list.points.len() + lines + list.polygons.iter().flatten().map(Vec::len).sum::<usize>()
}

fn is_painted(layer: &Layer, paint: &PaintLayers) -> bool {
    layer.paints().is_some() && paint.get(layer.id).is_some_and(|raster| !raster.is_blank())
}

/// Returns a project with the paint alone, on layers of different names.
fn paint_project(settings: &Settings, painted: Vec<Layer>, paint: &PaintLayers) -> Project {
    let names = unique_names(&painted);
    let layers = painted.into_iter().zip(names).map(|(layer, name)| Layer { name, mask: None, ..layer });
    let settings = Settings { layers: layers.collect(), background: None, ..settings.clone() };
    Project { settings, paint: paint.clone() }
}

/// Returns the names of layers, with numbers where they would be alike.
fn unique_names(layers: &[Layer]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for layer in layers {
        let numbered = (2..).map(|n| format!("{} {n}", layer.name));
        let mut candidates = std::iter::once(layer.name.clone()).chain(numbered);
        names.extend(candidates.find(|name| !names.contains(name)));
    }
    names
}
