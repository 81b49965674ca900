//! The files that the options and a recipe ask for.

use std::path::PathBuf;

use super::args::MeshArguments;
use super::build::FinishedMesh;
use super::depths::{ChangedDepths, DepthChanges};
use super::details::MeshDetails;
use super::exported_mesh::ExportedMesh;
use super::failure::Failure;
use super::line_notes::line_notes;
use super::output::{Output, RequestedLook};
use super::output_coordinates::OutputCoordinates;
use super::output_keys::{check_use, depth_changes_of, quantities_of};
use super::quantities::{NamedQuantity, typed_quantities};
use super::space_look::RequestedSpace;
use super::terminal::Terminal;
use meshbrush_core::cells::{LARGEST_COSINE, LEAST_SHARE, LinkFigures};
use meshbrush_io::io::recipe::Recipe;
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_io::io::solver_rules::Solver;
use meshbrush_io::io::{
    CellShape, Interruption, JoinedCells, KeyFault, MeshData, Meter, NodeValues, SURFACE, UnknownCells,
    joined_cells, joined_links,
};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::{Grouped, digits};
use meshbrush_render::render::Image;
use meshbrush_render::render::export::{ExportFormat, NO_SVG_IN_SPACE};
use meshbrush_render::render::look::Look;

/// Most files that one command writes.
const MOST_FILES: usize = 1000;
/// Most quantities of a file: each takes a number for each node.
const MOST_QUANTITIES: usize = 100;

/// Why a file cannot have quadrilaterals.
const TRIANGLES_ONLY: &str =
    "has triangles only; .nc, .disv, .gr3, .ll, .2dm, .mesh, .vtu and .msh have quadrilaterals.";

/// Files with one look and the same values at the nodes.
#[derive(Clone, Debug)]
pub struct RequestedFiles {
    /// The files.
    pub outputs: Vec<Output>,
    look: RequestedLook,
    quantities: Vec<NamedQuantity>,
    /// How their depths are changed.
    depth_changes: DepthChanges,
    /// Whether keys of an output ask for that, and no option.
    changes_by_keys: bool,
    /// Whether the third coordinate is 0, and not the height of a surface.
    is_flat: bool,
    /// The cells of formats that can have quadrilaterals.
    cells: CellShape,
    /// The parts for a solver on several processors.
    parts_for: Option<u32>,
}

/// Refuses too many values of an option.
fn check_count(option: &str, what: &str, count: usize, most: usize) -> Result<(), Failure> {
    match count > most {
        true => Err(Failure::Usage(format!("{option} names {count} {what}, and the limit is {most}."))),
        false => Ok(()),
    }
}

impl RequestedFiles {
    /// Returns the files that the options request.
    ///
    /// # Errors
    /// Fails with a sentence that names the option, the value and the rule.
    pub fn of_options(typed: &MeshArguments) -> Result<Self, Failure> {
        check_count("-o", "files", typed.output.len(), MOST_FILES)?;
        let further = &typed.quantities;
        let count = further.quantity.len() + further.quantity_grid.len();
        check_count("--quantity", "quantities", count, MOST_QUANTITIES)?;
        let look = RequestedLook::new(&typed.picture)?.in_space(RequestedSpace::new(&typed.space)?);
        let quantities = typed_quantities(further)?;
        let format = typed.format.as_deref();
        let output = |path: &PathBuf| Output::new(path, format, typed.binary);
        let outputs = typed.output.iter().map(output).collect::<Result<Vec<_>, _>>()?;
        if let Some(sentence) = look.levels_only() {
            return Err(Failure::Usage(format!("--color-by with --view space: {sentence}")));
        }
        if look.is_in_space() && outputs.iter().any(Output::is_vector_picture) {
            return Err(Failure::Usage(format!("--view space: {NO_SVG_IN_SPACE}.")));
        }
        let cells = typed.cells.unwrap_or_default();
        if let Some(output) = outputs.iter().find(|output| !output.can_have(cells)) {
            return Err(Failure::Usage(format!("--cells squares: {} {TRIANGLES_ONLY}", output.name())));
        }
        Ok(Self {
            outputs,
            look,
            quantities,
            depth_changes: typed.depths.into(),
            changes_by_keys: false,
            is_flat: typed.flat,
            cells,
            parts_for: None,
        })
    }

    /// Returns the files that a recipe requests, in its order.
    ///
    /// # Errors
    /// Fails with the line and column of a value that cannot be used.
    pub fn of_recipe(recipe: &Recipe) -> Result<Vec<Self>, Failure> {
        check_count("The recipe", "outputs", recipe.settings.output.len(), MOST_FILES)?;
        let files = |(index, output): (usize, &SavedOutput)| {
            Self::of_output(output).map_err(|fault| recipe.output_error(index, fault).into())
        };
        recipe.settings.output.iter().enumerate().map(files).collect()
    }

    fn of_output(saved: &SavedOutput) -> Result<Self, KeyFault> {
        let path = &saved.file;
        ExportFormat::from_path(path).map_err(|error| KeyFault::value("file", error.to_string()))?;
        let file = Output::new(path, None, saved.binary);
        Self::of_checked(saved, file.map_err(|failure| KeyFault::value("file", failure.to_string()))?)
    }

    fn of_checked(saved: &SavedOutput, file: Output) -> Result<Self, KeyFault> {
        check_use(saved, &file)?;
        let look = RequestedLook::of_saved(saved)?;
        if look.is_in_space() && file.is_vector_picture() {
            return Err(KeyFault::value("view", format!("{NO_SVG_IN_SPACE}.")));
        }
        let count = saved.quantities.len() + saved.grids.len();
        check_count("The output", "quantities", count, MOST_QUANTITIES)
            .map_err(|failure| KeyFault::value("quantities", failure.to_string()))?;
        let quantities = quantities_of(saved)?;
        let depth_changes = depth_changes_of(saved)?;
        let cells = saved.cells.as_deref().map(str::parse).transpose();
        let cells = cells.map_err(|error: UnknownCells| KeyFault::value("cells", error.to_string()))?;
        let cells = cells.unwrap_or_default();
        if !file.can_have(cells) {
            return Err(KeyFault::value("cells", format!("the file {TRIANGLES_ONLY}")));
        }
        Ok(Self {
            outputs: vec![file],
            look,
            quantities,
            depth_changes,
            changes_by_keys: !depth_changes.is_empty(),
            is_flat: saved.flat,
            cells,
            parts_for: None,
        })
    }

    /// Returns the same with a number in the name of each file.
    pub fn numbered(&self, number: u32) -> Self {
        let outputs = self.outputs.iter().map(|output| output.numbered(number)).collect();
        Self { outputs, quantities: self.quantities.clone(), ..*self }
    }

    /// Returns the same with the mesh in so many parts.
    pub fn divided(self, parts_for: Option<u32>) -> Self {
        Self { parts_for, ..self }
    }

    /// Returns the same with depths that are changed as options say; what they leave open is as it was.
    pub fn with_depth_changes(self, by_options: DepthChanges) -> Self {
        Self { depth_changes: by_options.or(self.depth_changes), ..self }
    }

    /// Returns how the depths are changed, if they are.
    pub fn depth_changes(&self) -> Option<DepthChanges> {
        Some(self.depth_changes).filter(|changes| !changes.is_empty())
    }

    /// Returns the cells of formats that can have quadrilaterals.
    pub fn cells(&self) -> CellShape {
        self.cells
    }

    /// Returns the quantity that is the depth, if one is and a file has it.
    pub fn depth(&self) -> Option<&NamedQuantity> {
        self.quantities.iter().find(|quantity| quantity.is_depth())
    }

    /// Returns the first quantity that uses the depth of layers, if one does.
    pub fn of_depth(&self) -> Option<&NamedQuantity> {
        self.quantities.iter().find(|quantity| quantity.uses_depth())
    }

    /// Checks before the work whether the files can be written, with those of lines where there are some, and
    /// have the quantities that their names ask for.
    ///
    /// # Errors
    /// Fails with a sentence about the first file that cannot be written.
    pub fn check_places(&self, inputs: &[PathBuf], has_lines: bool) -> Result<(), Failure> {
        let has_attributes = self.quantities.iter().any(|of| !of.is_depth() && of.name() != SURFACE);
        self.outputs.iter().try_for_each(|output| {
            output.in_place_of_depth(self.quantities.iter().map(NamedQuantity::name))?;
            output.check_places(inputs, [has_attributes, has_lines])
        })
    }

    /// Returns a sentence for each file that has no place for some of the values at the nodes. Of SCHISM each
    /// quantity has a file of its own.
    fn lost_quantities(&self, values: &[NodeValues]) -> impl Iterator<Item = String> {
        let names: Vec<&str> = values.iter().map(|of| &*of.name).filter(|name| *name != SURFACE).collect();
        self.outputs.iter().filter_map(move |output| {
            let has_place = |(number, name): &(usize, &str)| {
                let is_beside = |other: &&Output| output.is_for_schism() && other.is_for_schism();
                let mut places = self.outputs.iter().filter(is_beside).chain([output]);
                places.any(|place| place.has_quantity(*number, name))
            };
            let numbered = names.iter().copied().enumerate();
            let lost: Vec<&str> = numbered.filter(|of| !has_place(of)).map(|(_, name)| name).collect();
            let first = lost.first()?;
            let advice = match output.is_for_schism() {
                true => format!(" SCHISM reads each from a file of its name: -o {first}.gr3."),
                false => String::new(),
            };
            Some(format!("{} has no place for {}.{advice}", output.name(), lost.join(", ")))
        })
    }

    /// Returns the files that quantities read.
    pub fn read_files(&self) -> impl Iterator<Item = PathBuf> {
        self.quantities.iter().flat_map(NamedQuantity::files)
    }

    /// Returns whether a file has values at the nodes.
    pub fn wants_node_data(&self) -> bool {
        self.outputs.iter().any(Output::wants_node_data)
    }
}

/// Writes files, and says which.
///
/// # Errors
/// Fails when a quantity is not finite somewhere, or a file cannot be written.
pub fn write_files(
    requested: &[RequestedFiles],
    finished: &FinishedMesh,
    extract: &Extract,
    details: &MeshDetails,
    coordinates: OutputCoordinates,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let mut outputs = requested.iter().flat_map(|files| &files.outputs);
    let target_diameter = match outputs.any(Output::has_targets) {
        true => {
            let (what, meter) = ("target diameters at nodes", Meter::default());
            let targets = terminal.while_metered(what, &meter, || finished.target_at_nodes(extract, &meter));
            let mut targets = targets.expect("nobody cancels this meter");
            targets.iter_mut().for_each(|target| *target *= details.target_factor);
            targets
        }
        false => Vec::new(),
    };
    let interruption = Interruption::listen().map_err(|error| Failure::Work(format!("{error}.")))?;
    let provenance = &details.provenance;
    let target_diameter = &target_diameter[..];
    let exported = ExportedMesh { finished, extract, details, provenance, coordinates, target_diameter };
    let placed = exported.in_coordinates()?;
    let placed = placed.as_ref().unwrap_or(extract);
    let mut quantity_notes = details.quantity_notes.clone();
    for files in requested {
        let look = files.look_for(finished, extract)?;
        if files.outputs.iter().any(Output::is_picture) {
            look.missing_furniture().iter().for_each(|note| terminal.note(note));
        }
        let (quantities, changed) = files.values_at_nodes(&exported, Vec::new(), &mut quantity_notes)?;
        quantity_notes.extend(files.lost_quantities(&quantities));
        quantity_notes.extend(files.idle_changes(changed));
        let provenance = &changed.said_in(details.provenance.clone());
        let data = MeshData {
            cells: files.cells,
            parts_for: files.parts_for,
            provenance,
            ..exported.data(&quantities, files.is_flat)
        };
        quantity_notes.extend(line_notes(&files.outputs, &exported, placed, &data));
        for output in &files.outputs {
            let meter = interruption.meter();
            let write = || exported.write(output, placed, &data, &look, &meter);
            let written = terminal.while_metered(&format!("writing {}", output.name()), &meter, write);
            interruption.end_program();
            for path in written? {
                terminal.say(&format!("wrote {}{}", path.display(), output.caption(&look)));
            }
            if output.has_squares(files.cells) {
                terminal.say(&links_in_words(output, placed, &data));
            }
        }
    }
    quantity_notes.extend(requested.iter().find_map(|files| files.closed_note(details)));
    tell_new(&quantity_notes, details.quantity_notes.len(), terminal);
    Ok(())
}

/// Tells notes after the first ones, which were told already, each once.
fn tell_new(notes: &[String], told: usize, terminal: &mut Terminal) {
    let new = (told..notes.len()).filter(|&number| !notes[..number].contains(&notes[number]));
    new.for_each(|number| terminal.note(&notes[number]));
}

/// Returns a sentence about the cells of a file with quadrilaterals, and about the links between them.
fn links_in_words(output: &Output, mesh: &Extract, data: &MeshData) -> String {
    let cells = joined_cells(mesh, data);
    let LinkFigures { links, short, skewed, not_orthogonal, .. } = joined_links(mesh, data);
    let joined = cells.joined_count();
    let share = 100.0 * not_orthogonal as f64 / links.max(1) as f64;
    let too_short = match output.solver() {
        Some(Solver::Delft3dFm) => "are too short for Delft3D-FM".to_owned(),
        _ => format!("are shorter than {} of the width of their cells", digits(LEAST_SHARE, 2)),
    };
    format!(
        "{} has {} quadrilaterals and {} triangles. Of {} links between them {} {too_short}, {} cross their edge with a \
         cosine above {LARGEST_COSINE}, and {} % with one above 0.02.",
        output.name(),
        Grouped(joined),
        Grouped(cells.list().len() - joined),
        Grouped(links),
        Grouped(short),
        Grouped(skewed),
        digits(share, 2),
    )
}

impl RequestedFiles {
    /// Returns a sentence for a person where a file for a coastal solver has no open boundary.
    pub fn closed_note(&self, details: &MeshDetails) -> Option<String> {
        let output = self.outputs.iter().find(|output| output.has_open_boundary())?;
        let note = details.boundary.pieces().closed_note()?;
        Some(format!("{}: {note}", output.name()))
    }

    /// Returns the look of its pictures of a mesh as files get it.
    ///
    /// # Errors
    /// Fails when they are in space, and no node has a height.
    pub fn look_for(&self, finished: &FinishedMesh, extract: &Extract) -> Result<Look, Failure> {
        if self.outputs.iter().any(Output::is_picture) {
            return self.look.for_extract(finished, extract);
        }
        Ok(self.look.for_mesh(finished))
    }

    /// Returns the picture of a mesh as files get it.
    ///
    /// # Errors
    /// Fails as [`Self::look_for`] does, and when the picture is too small for what stands around its map.
    pub fn picture_of(&self, finished: &FinishedMesh, extract: &Extract) -> Result<Image, Failure> {
        let look = self.look_for(finished, extract)?;
        look.draw(finished.mesh(), extract).map_err(|error| Failure::Work(format!("Not drawn: {error}.")))
    }

    /// Returns the one file that the keys of a recipe's output request, in the format of this name where one
    /// is given.
    ///
    /// # Errors
    /// Fails for the first value that cannot be used.
    pub fn of_keys(saved: &SavedOutput, format: Option<&str>) -> Result<Self, KeyFault> {
        let fault = |failure: Failure| KeyFault::value("file", failure.to_string());
        let file = Output::new(&saved.file, format, saved.binary).map_err(fault)?;
        Self::of_checked(saved, file)
    }

    /// Writes files with `values` at the nodes beside what was requested, and returns their names. What a
    /// person should know about quantities is added to `notes`.
    ///
    /// # Errors
    /// Fails when a quantity is not finite somewhere, a file cannot be written, or the work was cancelled.
    pub fn write(
        &self,
        exported: &ExportedMesh,
        values: Vec<NodeValues>,
        notes: &mut Vec<String>,
        meter: &Meter,
    ) -> Result<Vec<PathBuf>, Failure> {
        let placed = exported.in_coordinates()?;
        let placed = placed.as_ref().unwrap_or(exported.extract);
        let (quantities, changed) = self.values_at_nodes(exported, values, notes)?;
        let look = self.look_for(exported.finished, exported.extract)?;
        let provenance = &changed.said_in(exported.provenance.clone());
        // Those of the details can be in other coordinates.
        let joined = &JoinedCells::default();
        let data =
            MeshData { cells: self.cells, joined, provenance, ..exported.data(&quantities, self.is_flat) };
        notes.extend(self.lost_quantities(&quantities));
        notes.extend(line_notes(&self.outputs, exported, placed, &data));
        notes.extend(self.idle_changes(changed));
        let write = |output: &Output| exported.write(output, placed, &data, &look, meter);
        Ok(self.outputs.iter().map(write).collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Returns a sentence where keys ask for other depths, and the file has none.
    fn idle_changes(&self, changed: ChangedDepths) -> Option<String> {
        let DepthChanges { least, slope } = self.depth_changes;
        let is_idle = self.changes_by_keys && (least.is_some(), slope.is_some()) != changed.kinds();
        let name = self.outputs.first().filter(|_| is_idle)?.name();
        Some(format!(
            "{name} has no depths, so its least_depth and depth_slope change nothing. Add a layer of depths, or a \
             quantity called depth."
        ))
    }

    /// Returns the values at the nodes: those given, the quantities, and the depths and surfaces of layers,
    /// unless one of them is called so; and what was changed of the depths.
    fn values_at_nodes(
        &self,
        exported: &ExportedMesh,
        values: Vec<NodeValues>,
        notes: &mut Vec<String>,
    ) -> Result<(Vec<NodeValues>, ChangedDepths), Failure> {
        match self.wants_node_data() {
            true => exported.values_at_nodes(&self.quantities, values, self.depth_changes, notes),
            false => Ok(Default::default()),
        }
    }
}
