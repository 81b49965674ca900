//! What a command meshes: a project, a recipe or what options say, with options in place of the values of a
//! file.

use std::fmt::Display;
use std::io::stdin;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::args::InputArguments;
use super::failure::Failure;
use super::lengths::LengthWithUnit;
use super::options;
use super::output::is_standard_stream;
use super::quantities::NamedQuantity;
use super::terminal::Terminal;
use meshbrush_core::build::MeshSpec;
use meshbrush_core::document::{PathPlan, Settings};
use meshbrush_core::domain::BoundaryMarks;
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::PaintLayers;
use meshbrush_io::io::geojson::{self, Outline};
use meshbrush_io::io::layers::SavedKind;
use meshbrush_io::io::recipe::{self, Loaded, Loading, Recipe};
use meshbrush_io::io::settings::{LoadingDefaults, SavedSettings, SavedTreatment};
use meshbrush_io::io::shape_format;
use meshbrush_io::io::shapes::{self, ShapeFile};
use meshbrush_io::io::{Meter, ReadError, project};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{CoarseError, Limits, MemoryLimit, bisection_edge_length};
use meshbrush_mesh::text::LengthUnit;

/// Most triangles unless `--max-triangles` or a file says otherwise.
const DEFAULT_BUDGET: usize = 50_000_000;

/// The file of domain and layers, if there is one, and the settings in the text.
#[derive(Debug)]
pub struct Input {
    /// A saved document, whose values [`Self::settings`] override.
    pub project: Option<PathBuf>,
    /// The recipe that domain and layers come from.
    pub recipe: Option<Recipe>,
    /// The settings in the options, in place of those of the recipe where there is one.
    pub settings: SavedSettings,
    /// Options whose lengths have a unit.
    lengths: Vec<LengthWithUnit>,
    /// What all sizes are multiplied by.
    scale: f64,
    /// Whether the notes on the files have been shown already.
    pub is_quiet: bool,
}

/// A mesh to make, and the texts about it.
pub struct ToMesh {
    /// The description of the mesh.
    pub spec: MeshSpec,
    /// The paint of its layers.
    pub paint: PaintLayers,
    /// Names of the boundary.
    pub marks: Arc<BoundaryMarks>,
    /// The unit of coordinates and lengths, where a file says it.
    pub unit: LengthUnit,
    /// The coordinates of exported files, unless others are asked for: those of the domain's file. They count
    /// only where the mesh is in the plane of a projection.
    pub coordinates: Coordinates,
    /// What coordinates of files are that do not name a known system.
    pub assumed: Option<Coordinates>,
    /// The paths of a project or a recipe.
    pub paths: Arc<PathPlan>,
    /// What all targets are multiplied by; the largest diameter at the outline is already.
    pub scale: f64,
}

impl Input {
    /// Checks the arguments one by one and against each other. Of the files only a recipe is read.
    ///
    /// # Errors
    /// Fails with a sentence that names the option, the value and the rule; and when a recipe cannot be read.
    pub fn new(typed: &InputArguments) -> Result<Self, Failure> {
        refuse_options_beside_a_file(typed)?;
        let options = options::settings(typed)?;
        let recipe = typed.recipe.as_deref().map(read_recipe).transpose()?;
        let settings = match &recipe {
            Some(recipe) => recipe.settings.clone().overridden_by(&options),
            None => options,
        };
        if settings.uses_scale() && settings.limits.h_min.is_none() {
            let problem =
                "Risk and images need --h-min, the target diameter where the risk is 1 or the image black";
            return Err(Failure::Usage(format!("{problem}. The size of the finest detail is a good start.")));
        }
        settings.limits.check().map_err(|fault| Failure::Usage(fault.full_sentence()))?;
        match &typed.boundary_diameter {
            // Of a project the domain is not known yet.
            Some(diameter) if typed.project.is_none() => {
                let has_outline = settings.domain.has_outline();
                check_boundary_diameter(diameter, has_outline, settings.domain.boundary)?;
            }
            _ => {}
        }
        let lengths = LengthWithUnit::all(typed);
        Ok(Self { project: typed.project.clone(), recipe, settings, lengths, scale: 1.0, is_quiet: false })
    }

    /// Returns the input with all sizes multiplied by a number.
    pub fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// Options that were given and change nothing, a sentence each.
    pub fn options_without_effect(&self, typed: &InputArguments) -> Vec<String> {
        // The layers and the domain of a project are not known yet.
        let is_known = self.project.is_none();
        let has_risk = self.settings.layer.iter().any(|layer| layer.keys.is_risk());
        let unused = [
            (is_known && typed.transfer_shape.is_some() && !has_risk)
                .then_some("--transfer-shape changes nothing without --risk or --risk-raster."),
            (is_known && typed.h_risk.is_some() && !has_risk)
                .then_some("--h-risk changes nothing without --risk or --risk-raster."),
            (is_known && typed.boundary.is_some() && !self.settings.domain.has_outline())
                .then_some("--boundary changes nothing without --region, --land or --inside."),
        ];
        unused.into_iter().flatten().map(str::to_owned).collect()
    }

    /// Checks that there are depths for a quantity that uses them, before anything is made. The layers of a
    /// project are not known yet.
    ///
    /// # Errors
    /// Fails with a sentence that names the quantity.
    pub fn check_depth_for(&self, quantity: Option<&NamedQuantity>) -> Result<(), Failure> {
        let has_depths = self.settings.layer.iter().any(|layer| layer.kind() == SavedKind::Depth);
        match quantity {
            Some(quantity) if self.project.is_none() && !has_depths => Err(quantity.without_depths()),
            _ => Ok(()),
        }
    }

    /// Returns whether the recipe or an option has lines along which the mesh shall have edges. Those of a
    /// project are not known before it is read.
    pub fn has_lines(&self) -> bool {
        !self.settings.line.is_empty()
    }

    /// Returns the files to read.
    pub fn files(&self) -> Vec<PathBuf> {
        let recipe = self.recipe.as_ref().map(|recipe| recipe.file().to_owned());
        self.settings.files().map(Path::to_owned).chain(self.project.clone()).chain(recipe).collect()
    }

    /// Reads the files.
    ///
    /// # Errors
    /// Fails when a file cannot be read or used, there is no coarse grid, or an option does not suit the
    /// file.
    pub fn read(&self, terminal: &mut Terminal) -> Result<ToMesh, Failure> {
        let (settings, paint, coordinates) = match &self.project {
            Some(path) => {
                let (settings, paint) = self.read_project(path, terminal)?;
                (settings, paint, Coordinates::Geographic)
            }
            None => {
                let Loaded { settings, paint, coordinates, notes, without_effect: _ } =
                    self.read_files(terminal)?;
                self.tell(&notes, terminal);
                (settings, paint, coordinates.unwrap_or(Coordinates::Geographic))
            }
        };
        self.lengths.iter().try_for_each(|length| length.check(settings.unit))?;
        let diameter = settings.boundary.diameter().map(|diameter| self.scale * diameter);
        let boundary =
            diameter.map_or(settings.boundary, |diameter| settings.boundary.with_diameter(diameter));
        let settings = Settings { boundary, ..settings };
        let limits = Limits {
            max_triangles: settings.max_triangles,
            max_level: settings.max_level,
            // The window keeps room for a second mesh; here there is one.
            max_memory: Some(MemoryLimit::for_one_mesh(settings.max_memory)),
        };
        let lattice = Lattice::covering(settings.domain.bounds, settings.spacing, limits.most_triangles());
        let lattice = lattice.map_err(CoarseError::from)?;
        let diameter = self.settings.domain.boundary_diameter;
        diameter.map_or(Ok(()), |diameter| check_resolvable(self.scale * *diameter, &lattice))?;
        let spec = settings.mesh_spec_on(lattice, limits);
        // What is said about parts counts for every domain; else only fitted meshes are cleaned.
        let spec = MeshSpec { cleaning: self.settings.cleaning(spec.cleaning), ..spec };
        let Settings { boundary_marks: marks, unit, paths, .. } = settings;
        let assumed = self.settings.domain.assumed().map_err(|fault| Failure::Usage(fault.to_string()))?;
        Ok(ToMesh { spec, paint, marks, unit, coordinates, assumed, paths, scale: self.scale })
    }

    fn read_project(&self, path: &Path, terminal: &mut Terminal) -> Result<(Settings, PaintLayers), Failure> {
        let (meter, reading) = (Meter::default(), format!("reading {}", path.display()));
        let document = terminal.while_metered(&reading, &meter, || project::read_metered(path, &meter))?;
        let options = &self.settings.domain;
        let has_outline = !document.settings().domain.is_whole();
        if let Some(diameter) = options.boundary_diameter {
            let stored = SavedTreatment::of(document.settings().boundary);
            check_boundary_diameter(*diameter, has_outline, Some(options.boundary.unwrap_or(stored)))?;
        } else if options.boundary.is_some() && !has_outline {
            let note = "--boundary changes nothing: the domain of the project is a rectangle.";
            self.tell(&[note.to_owned()], terminal);
        }
        let own = document.settings().clone();
        let cut = options.cut(own.domain.clone()).map(|domain| Settings { domain, ..own });
        let settings = cut.and_then(|settings| self.settings.override_settings(settings));
        let mut settings = settings.map_err(|fault| Failure::Usage(fault.to_string()))?;
        let loading = Loading::for_document(&meter);
        let notes = self.settings.open_boundary_of(&mut settings, &loading)?;
        self.tell(&notes, terminal);
        let (lines, notes) = self.settings.lines_for(&settings, &loading)?;
        self.tell(&notes, terminal);
        settings.lines = Arc::new(settings.lines.iter().cloned().chain(lines).collect());
        settings.transfer.checked()?;
        Ok((settings, document.paint().clone()))
    }

    /// Shows notes on the files, unless they have been shown already.
    fn tell(&self, notes: &[String], terminal: &mut Terminal) {
        notes.iter().filter(|_| !self.is_quiet).for_each(|note| terminal.note(note));
    }

    fn read_files(&self, terminal: &mut Terminal) -> Result<Loaded, Failure> {
        let meter = &Meter::default();
        let most_coarse = self.settings.mesh.max_triangles.unwrap_or(DEFAULT_BUDGET);
        // Without a memory budget, the mesh may take what its triangles take.
        let defaults = LoadingDefaults { most_coarse, max_triangles: DEFAULT_BUDGET, max_memory: usize::MAX };
        let loading =
            Loading { defaults, with_hidden: false, read_outline, read_land, ..Loading::for_document(meter) };
        Ok(terminal.while_metered("reading", meter, || self.settings.load_files("", &loading))?)
    }
}

/// Checks that a diameter at the outline makes sense.
///
/// # Errors
/// Fails when the domain has no outline, or nothing is refined along it.
fn check_boundary_diameter(
    diameter: impl Display,
    has_outline: bool,
    boundary: Option<SavedTreatment>,
) -> Result<(), Failure> {
    let problem = if !has_outline {
        "it is for the outline of a domain. Name a file with --region or a formula with --inside, or leave it out"
    } else if boundary == Some(SavedTreatment::Report) {
        "with --boundary report nothing is refined along the outline. Take --boundary fitted, or leave it out"
    } else {
        return Ok(());
    };
    Err(Failure::Usage(format!("--boundary-diameter {diameter}: {problem}.")))
}

/// Refuses the options on domain and layers beside a project or a recipe, which decide both.
fn refuse_options_beside_a_file(typed: &InputArguments) -> Result<(), Failure> {
    let (file, advice) = match (&typed.project, &typed.recipe) {
        (Some(file), _) => (
            format!("--project {}", file.display()),
            "Edit them in the window; or write the project as a recipe with `meshbrush recipe`, and edit that",
        ),
        (None, Some(file)) => (file.display().to_string(), "Edit the recipe"),
        (None, None) => return Ok(()),
    };
    let given = [
        ("--domain", typed.domain.is_some()),
        ("--inside", typed.inside.is_some()),
        ("--region", typed.region.is_some()),
        ("--land", typed.earth.land.is_some()),
        ("--bounds", typed.earth.bounds.is_some()),
        ("--projection", typed.earth.projection.is_some()),
        ("--crs", typed.earth.crs.is_some()),
        ("--target", !typed.target.is_empty()),
        ("--risk", !typed.risk.is_empty()),
        ("--target-raster", !typed.target_raster.is_empty()),
        ("--risk-raster", !typed.risk_raster.is_empty()),
        ("--threats", !typed.threats.is_empty()),
        ("--distance", !typed.distances.distance.is_empty()),
        ("--distance-to-piece", !typed.distances.distance_to_piece.is_empty()),
        ("--distance-to-type", !typed.distances.distance_to_type.is_empty()),
        ("--depth", !typed.water.depth.is_empty()),
        ("--straits", typed.water.straits.is_some()),
        ("--feature-size", typed.water.feature_size.is_some()),
        ("--line-sizes", typed.line_sizes.is_some()),
        ("--surface", !typed.surfaces.surface.is_empty()),
    ];
    let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) else { return Ok(()) };
    let rule = "domain and layers are those of the file, and other options override its settings";
    Err(Failure::Usage(format!("{option} cannot be used with {file}: {rule}. {advice}.")))
}

/// Reads a recipe.
fn read_recipe(path: &Path) -> Result<Recipe, Failure> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(recipe::ENDING)) {
        let file = path.display();
        return Err(Failure::Usage(format!(
            "{file}: a file without an option is a recipe, and its name ends with .toml. Name a project with \
             --project, and a domain with --region."
        )));
    }
    Ok(recipe::read(path)?)
}

/// Reads the polygons of a domain, from standard input where the file is `-`.
fn read_outline(path: &Path, meter: &Meter) -> Result<Outline, ReadError> {
    match is_standard_stream(path) {
        true => geojson::read_outline_from(stdin().lock(), Path::new("standard input")),
        false => shape_format::read_outline(path, meter),
    }
}

/// Reads land, from standard input where the file is `-`.
fn read_land(path: &Path, wanted: Option<Rect>, meter: &Meter) -> Result<ShapeFile, ReadError> {
    match is_standard_stream(path) {
        true => shapes::read_from(stdin().lock(), Path::new("standard input")),
        false => shape_format::read_own_shapes(path, wanted, meter),
    }
}

/// Refuses a diameter at the outline that the lattice cannot resolve: the refinement would fail wherever the
/// outline passes.
fn check_resolvable(diameter: f64, lattice: &Lattice) -> Result<(), Failure> {
    let level = lattice.deepest_level();
    let smallest = bisection_edge_length(lattice.spacing(), level);
    if diameter >= smallest {
        return Ok(());
    }
    Err(Failure::Work(format!(
        "--boundary-diameter {diameter:e}: below {smallest:.3e} (level {level}) nodes would leave the lattice. Raise it, or mesh a \
         smaller domain."
    )))
}
