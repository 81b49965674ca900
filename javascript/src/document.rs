//! A document: settings, layers and paint, and the mesh that follows it.

use std::cell::OnceCell;

use meshbrush_core::document::{Document, Follower, MeshChange, Settings, Stage};
use meshbrush_core::domain::DomainOnLattice;
use meshbrush_core::layers::SizeField;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::mesh::{Cleaning, CoarseError, Extract, Mesh, PatchedLocator};
use meshbrush_mesh::text::Grouped;
use wasm_bindgen::prelude::*;

use crate::errors::{build_sentence, error};
use crate::options::{Kept, kept, settings_of};
use crate::values::Table;

/// A document and its mesh.
#[wasm_bindgen]
pub struct Core {
    pub(crate) document: Document,
    /// Whether somebody said the smallest diameter, which risk needs.
    pub(crate) has_smallest: bool,
    /// What the options say about the parts that stay.
    pub(crate) kept: Kept,
    /// How it was before the current edit.
    before: Before,
    /// What keeps the mesh up to date, once there is one.
    follower: Option<Box<Follower>>,
    /// What was computed from the mesh as it is.
    pub(crate) derived: OnceCell<Derived>,
}

/// What an edit can change beside the document, and the state of the document.
#[derive(Clone, Copy, Default)]
struct Before {
    version: u64,
    has_smallest: bool,
    kept: Kept,
}

/// The mesh as files have it.
pub(crate) struct Derived {
    pub(crate) mesh: DerivedMesh,
    pub(crate) extract: Extract<'static>,
    /// Finds points in changed triangles, if some are changed.
    pub(crate) patched: Option<PatchedLocator>,
}

#[wasm_bindgen]
impl Core {
    /// Makes a document without layers from options. It has no mesh before `follow`.
    ///
    /// # Errors
    /// Fails for options that cannot be met.
    #[wasm_bindgen(constructor)]
    pub fn new(options: &JsValue) -> Result<Self, JsError> {
        let options = Table(options);
        Ok(Self {
            document: Document::new(settings_of(options)?, None).map_err(error)?,
            has_smallest: options.get("hMin").is_some(),
            kept: kept(options)?,
            before: Before::default(),
            follower: None,
            derived: OnceCell::new(),
        })
    }

    /// Notes how the document is, for `take_back`.
    #[wasm_bindgen(js_name = beginEdit)]
    pub fn begin_edit(&mut self) {
        let Self { has_smallest, kept, .. } = *self;
        self.before = Before { version: self.document.version(), has_smallest, kept };
    }

    /// Undoes the edits since `beginEdit`.
    #[wasm_bindgen(js_name = takeBack)]
    pub fn take_back(&mut self) {
        let Before { version, has_smallest, kept } = self.before;
        while self.document.version() > version && self.document.undo() {}
        (self.has_smallest, self.kept) = (has_smallest, kept);
    }

    /// Brings the mesh up to date with the document: where it is, or by another one. Returns whether it is
    /// another one.
    ///
    /// # Errors
    /// Fails where the document has no mesh. The edits since `beginEdit` are then undone.
    pub fn follow(&mut self) -> Result<bool, JsError> {
        let followed = self.brought_up_to_date();
        if followed.is_err() && self.follower.is_some() {
            self.take_back();
            // The former mesh was possible.
            self.brought_up_to_date().ok();
        }
        followed.map_err(error)
    }
}

impl Core {
    fn brought_up_to_date(&mut self) -> Result<bool, String> {
        self.derived.take();
        let is_other = match &mut self.follower {
            Some(follower) => {
                follower.take_change();
                follow(follower, &mut self.document)?;
                follower.take_change() == Some(MeshChange::Replaced)
            }
            none => {
                let follower =
                    Follower::new(&mut self.document).map_err(|problem| build_sentence(&problem))?;
                *none = Some(Box::new(follower));
                true
            }
        };
        let derived = self.newly_derived()?;
        self.derived.set(derived).ok();
        Ok(is_other)
    }

    fn newly_derived(&self) -> Result<Derived, String> {
        let mesh = self.mesh().ok_or("There is no mesh yet.")?;
        self.check_surface(mesh)?;
        let targets =
            self.follower.as_ref().and_then(|follower| follower.edge_targets(self.document.paint()));
        let derived = DerivedMesh::new(mesh, self.domain_on_lattice(), targets, &self.cleaning());
        if derived.patch().leaves_nothing_of(mesh) {
            return Err(CoarseError::EmptyDomain { spacing: mesh.lattice().spacing() }.to_string());
        }
        let extract = derived.extract(mesh).along_curve();
        let patch = derived.patch();
        let patched = (!patch.is_empty()).then(|| PatchedLocator::new(mesh, patch, &extract));
        Ok(Derived { mesh: derived, extract, patched })
    }

    /// Checks that the mesh has no more triangles than the surfaces allow, which coarse grid and sizes may
    /// need.
    fn check_surface(&self, mesh: &Mesh) -> Result<(), String> {
        let surface = self.follower.as_ref().and_then(|follower| follower.surface());
        match surface.and_then(|rule| rule.exceeded_count()) {
            None => Ok(()),
            Some(most) => Err(format!(
                "A mesh of at most {} triangles cannot be made: without the surface it has {} already. Ask for more, take a \
                 larger spacing, or ask for larger triangles elsewhere.",
                Grouped(most),
                Grouped(mesh.triangles().count())
            )),
        }
    }

    fn cleaning(&self) -> Cleaning {
        let settings = self.document.settings();
        let default = settings.derived_cleaning();
        // Of a fitted mesh, the settings have what was said, and an undo takes it back.
        if settings.is_fitted() { default } else { self.kept.cleaning(default) }
    }

    /// Returns the mesh, once there is one.
    pub(crate) fn mesh(&self) -> Option<&Mesh> {
        Some(self.follower.as_ref()?.mesh())
    }

    /// Returns h̄ of the mesh.
    pub(crate) fn field(&self) -> &SizeField {
        self.follower.as_ref().expect(NO_MESH).field()
    }

    fn domain_on_lattice(&self) -> &DomainOnLattice {
        self.follower.as_ref().expect(NO_MESH).domain()
    }

    /// Returns the settings.
    pub(crate) fn settings(&self) -> &Settings {
        self.document.settings()
    }

    /// Returns the mesh as files have it.
    pub(crate) fn derived(&self) -> &Derived {
        self.derived.get().expect(NO_MESH)
    }
}

/// `index.js` makes the mesh before it hands the object out.
const NO_MESH: &str = "the mesh was made";

/// Does the work of a follower until mesh and document agree.
fn follow(follower: &mut Follower, document: &mut Document) -> Result<(), String> {
    loop {
        match follower.advance(document, usize::MAX).map_err(|problem| build_sentence(&problem))? {
            Stage::InStep => return Ok(()),
            Stage::GaveUp(problem) => {
                return Err(problem.map_or_else(String::new, |problem| build_sentence(&problem)));
            }
            _ => {}
        }
    }
}
