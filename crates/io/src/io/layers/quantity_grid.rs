//! Grids of values for the nodes of files, such as Manning's n, or of classes with a table of their values.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::super::{ClassTable, DocumentPlane, Meter, Number};
use super::{RasterError, RasterFile, RasterFrame, RasterLoader};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{NoNodeValue, NodeMeans};
use meshbrush_core::raster::{Raster, RasterPyramid, RasterValues, Resampling};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::MeshView;
use meshbrush_mesh::text::Grouped;

/// Most classes that a sentence names.
const NAMED_CLASSES: usize = 5;

/// A grid in the plane of a domain, and what its pixels mean.
#[derive(Clone, Debug)]
pub struct QuantityGrid {
    raster: Arc<RasterPyramid>,
    table: Option<ClassTable>,
    /// The classes in the rectangle of the domain that the table lacks, with their pixels.
    lacking: BTreeMap<u32, usize>,
}

impl QuantityGrid {
    /// Reads a grid of any format for a domain with these `bounds`, projected to its plane where it is in
    /// other coordinates. With a `table` its pixels are classes: they are never mixed, and the table has
    /// their values. Classes that it lacks count as pixels without a value.
    ///
    /// # Errors
    /// Fails when the file is no raster, or of no use.
    pub fn read(
        file: &RasterFile,
        table: Option<ClassTable>,
        bounds: Rect,
        plane: Option<DocumentPlane>,
        meter: &Meter,
    ) -> Result<Self, RasterError> {
        let frame = RasterFrame {
            domain: bounds,
            wanted: Some(bounds),
            plane,
            // It is for diameters.
            transfer: Transfer::between(1.0, 1.0),
            resampling: if table.is_some() { Resampling::Nearest } else { Resampling::Linear },
        };
        let raster = RasterLoader::new(meter).load(file, RasterValues::Any, &frame)?.raster;
        let lacking = table
            .as_ref()
            .map_or_else(BTreeMap::new, |table| lacking_classes(raster.raster(), table, &bounds));
        let raster = match &table {
            Some(table) if !lacking.is_empty() => Arc::new(RasterPyramid::new(known(raster.raster(), table))),
            _ => raster,
        };
        Ok(Self { raster, table, lacking })
    }

    /// Returns the values at the nodes of a mesh: the means over their cells.
    ///
    /// # Errors
    /// Fails when nodes are far from every pixel with a value.
    pub fn at_nodes(&self, mesh: MeshView) -> Result<NodeMeans, NoNodeValue> {
        let raster = self.raster.raster();
        match &self.table {
            // Pixels of other classes have no value.
            Some(table) => NodeMeans::of(mesh, raster, Some(&|class| table.value(class).unwrap_or(f64::NAN))),
            None => NodeMeans::of(mesh, raster, None),
        }
    }

    /// Returns what a person should know about the classes that the table lacks; `file` and `table` are their
    /// names.
    pub fn note(&self, file: &Path, table: &Path) -> Option<String> {
        if self.lacking.is_empty() {
            return None;
        }
        let classes = self.lacking.len();
        let named = self.lacking.keys().take(NAMED_CLASSES);
        let mut named: Vec<String> =
            named.map(|bits| Number(f64::from(f32::from_bits(*bits))).to_string()).collect();
        if classes > NAMED_CLASSES {
            named.push("…".to_owned());
        }
        let noun = if classes == 1 { "class" } else { "classes" };
        Some(format!(
            "{} lacks {classes} {noun} of {} ({}): {} pixels in the rectangle of the domain count as pixels without a value.",
            table.display(),
            file.display(),
            named.join(", "),
            Grouped(self.lacking.values().sum()),
        ))
    }
}

/// Returns the classes in a rectangle that a table lacks, as bits, with the number of their pixels.
fn lacking_classes(raster: &Raster, table: &ClassTable, area: &Rect) -> BTreeMap<u32, usize> {
    let mut lacking = BTreeMap::new();
    for row in raster.rows(raster.pixels_touching(area)) {
        for class in row.iter().filter(|class| !class.is_nan() && table.value(**class).is_none()) {
            *lacking.entry(class.to_bits()).or_default() += 1;
        }
    }
    lacking
}

/// Returns a raster of classes in which only those of a table are left.
fn known(raster: &Raster, table: &ClassTable) -> Raster {
    let class = |&class: &f32| if table.value(class).is_some() { class } else { f32::NAN };
    Raster::from_values(raster.bounds(), raster.size(), raster.values().iter().map(class).collect())
}
