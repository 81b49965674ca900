//! The grid of a quantity: its file, and the values of its classes.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use super::build::FinishedMesh;
use super::failure::Failure;
use meshbrush_core::layers::NodeMeans;
use meshbrush_io::io::layers::{QuantityGrid, RasterError, RasterFile};
use meshbrush_io::io::settings::SavedQuantityGrid;
use meshbrush_io::io::{ClassTable, Meter, class_table, exists};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::Grouped;

/// A grid that the nodes of files get values from.
#[derive(Clone, Debug)]
pub struct GridSource {
    file: RasterFile,
    /// The values of its classes, and their file.
    table: Option<(PathBuf, ClassTable)>,
    /// The grid in the plane of the mesh, once it was read. Clones share it.
    read: Arc<OnceLock<QuantityGrid>>,
}

impl PartialEq for GridSource {
    fn eq(&self, other: &Self) -> bool {
        (&self.file, &self.table) == (&other.file, &other.table)
    }
}

impl GridSource {
    /// Reads the table, and looks for the file of the grid.
    ///
    /// # Errors
    /// Fails with a sentence when there is no such file, it is no raster by its name, or the table is of no
    /// use.
    pub fn new(saved: &SavedQuantityGrid) -> Result<Self, String> {
        let SavedQuantityGrid { name, file: path, table } = saved;
        let named = |problem: String| format!("{}: {problem}", path.display());
        let file = RasterFile::named(path).map_err(named)?;
        if !exists(&file.on_disk()) {
            return Err(named("there is no such file.".to_owned()));
        }
        let read = |path: &PathBuf| Ok((path.clone(), class_table::read(path, name)?));
        let table = table.as_ref().map(read).transpose();
        let table = table.map_err(|error: meshbrush_io::io::ReadError| error.to_string())?;
        Ok(Self { file, table, read: Arc::default() })
    }

    /// Returns the files that it reads.
    pub fn files(&self) -> Vec<PathBuf> {
        let table = self.table.as_ref().map(|(file, _)| file.clone());
        std::iter::once(self.file.on_disk()).chain(table).collect()
    }

    /// Returns the values at the nodes of a mesh, for a quantity that is `called` so.
    ///
    /// # Errors
    /// Fails when the file is of no use, and when nodes are far from every pixel with a value.
    pub fn at_nodes(
        &self,
        called: &str,
        finished: &FinishedMesh,
        mesh: &Extract,
        notes: &mut Vec<String>,
    ) -> Result<Vec<f64>, Failure> {
        let file = self.file.path.display();
        let grid = self.grid(finished)?;
        let found = grid.at_nodes(mesh.view()).map_err(|error| {
            Failure::Work(format!("The {called}, of {file}: {error} Name a grid that covers the domain."))
        })?;
        let classes = self.table.as_ref().and_then(|(table, _)| grid.note(&self.file.path, table));
        notes.extend(classes);
        let NodeMeans { values, filled, farthest, pixels: _ } = found;
        if filled > 0 {
            notes.push(format!(
                "The {called}: {} of {} nodes are where {file} has no value; they have that of the nearest pixel, at most \
                 {farthest:.1} away.",
                Grouped(filled),
                Grouped(values.len()),
            ));
        }
        Ok(values)
    }

    /// Reads the grid the first time.
    fn grid(&self, finished: &FinishedMesh) -> Result<&QuantityGrid, Failure> {
        if let Some(grid) = self.read.get() {
            return Ok(grid);
        }
        let table = self.table.as_ref().map(|(_, table)| table.clone());
        let (bounds, plane) = (finished.domain().bounds, finished.plane());
        let grid = QuantityGrid::read(&self.file, table, bounds, plane, &Meter::default());
        let grid = grid.map_err(|error| match error {
            RasterError::Read(error) => Failure::Read(error),
            RasterError::Value(sentence) => Failure::Work(sentence),
        })?;
        Ok(self.read.get_or_init(|| grid))
    }
}
