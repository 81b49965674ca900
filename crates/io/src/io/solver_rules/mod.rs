//! The rules by which solvers refuse, drop or double what a mesh file holds, and the places that break them.
//!
//! A file that opens is not a file that runs. Each rule is a row of [`RULES`]: its name, the solvers that
//! keep it, where it comes from, what helps, and a function from the mesh as a file of the solver has it
//! ([`WrittenMesh`]) to places. Rules look at nothing but what is in the file, so they see what the solver
//! will see: angles are those of the coordinates that are written, and open nodes those that are marked.

mod angles;
mod boundary;
mod flow_links;
mod nodes;
mod repair;
mod solver;
mod strip_cutting;
mod strips;
#[cfg(test)]
mod tests;
mod written_mesh;

use glam::DVec2;
use meshbrush_core::domain::{BoundaryMarks, Domain, MeshBoundary};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::Grouped;

use super::{CellShape, JoinedCells, MeshData, Provenance};

pub use repair::{Repaired, repaired};
pub use solver::{Solver, UnknownSolver};
pub use strip_cutting::StripCutting;
pub use written_mesh::{WrittenMesh, WrittenString};

use Solver::{Adcirc, Delft3dFm, Fvcom, Mike, Modflow, Schism, Swan, Telemac};

/// A place at which a mesh breaks a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct BrokenPlace {
    /// The place, in the coordinates of the file: a node, or the middle of a triangle or of an edge.
    pub place: DVec2,
    /// What is there, with its numbers.
    pub sentence: String,
    /// The triangles of the file that can mend it by being bisected; none where
    /// that would not help.
    pub mended_in: Vec<usize>,
}

impl BrokenPlace {
    /// Returns a place that smaller triangles would not mend.
    pub(super) fn new(place: DVec2, sentence: String) -> Self {
        Self { place, sentence, mended_in: Vec::new() }
    }

    /// Returns the place, which is mended where these triangles are bisected.
    pub(super) fn mended_in(self, triangles: Vec<usize>) -> Self {
        Self { mended_in: triangles, ..self }
    }
}

/// How much a rule matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The solver refuses the mesh, changes it, or advises against it.
    Violation,
    /// It runs, and a person should know.
    Note,
}

/// A rule of solvers.
#[derive(Debug)]
pub struct SolverRule {
    /// Its name in lists and in JSON: letters and underscores.
    pub name: &'static str,
    /// The solvers that have it.
    pub solvers: &'static [Solver],
    /// Where it comes from: a program, and a file of its source where one is known.
    pub source: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// Whether it looks at the strings of the boundary, which one that touches itself does not have.
    pub needs_strings: bool,
    /// Whether smaller triangles can mend a place that breaks it, [`BrokenPlace::mended_in`].
    pub is_mended_by_size: bool,
    /// What a person can do.
    pub remedy: &'static str,
    /// Returns the places that break it, in the order of triangles, nodes or strings.
    pub find: fn(&WrittenMesh) -> Vec<BrokenPlace>,
}

/// The rules, those of all solvers first.
pub static RULES: [SolverRule; 20] = [
    SolverRule {
        name: "clockwise_triangle",
        solvers: &Solver::ALL,
        source: "the formats of all solvers",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "This is a mistake of the program: please report it, with the recipe.",
        find: nodes::clockwise_triangles,
    },
    SolverRule {
        name: "repeated_node",
        solvers: &Solver::ALL,
        source: "the formats of all solvers",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "This is a mistake of the program, or places are too close for the coordinates of the file: write the \
                 plane (--out-crs plane).",
        find: nodes::repeated_nodes,
    },
    SolverRule {
        name: "node_without_triangle",
        solvers: &Solver::ALL,
        source: "the formats of all solvers",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "This is a mistake of the program: please report it, with the recipe.",
        find: nodes::lone_nodes,
    },
    SolverRule {
        name: "boundaries_that_touch",
        solvers: &Solver::ALL,
        source: "the formats of all solvers: two boundary edges at each node of the boundary",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Have such nodes removed (without --keep-pinches), put nodes on the outline, or choose smaller triangles there.",
        find: boundary::touching,
    },
    SolverRule {
        name: "open_node_twice",
        solvers: &[Adcirc],
        source: "ADCIRC gwce.F",
        severity: Severity::Violation,
        needs_strings: true,
        is_mended_by_size: false,
        remedy: "Write the open pieces that meet as one string: the tide is added up over the list of open nodes.",
        find: boundary::open_nodes_twice,
    },
    SolverRule {
        name: "short_open_string",
        solvers: &[Adcirc, Schism],
        source: "ADCIRC, SCHISM: an open boundary has an edge",
        severity: Severity::Violation,
        needs_strings: true,
        is_mended_by_size: true,
        remedy: "Choose smaller triangles there, or join the piece with its neighbour.",
        find: boundary::short_open_strings,
    },
    SolverRule {
        name: "boundary_of_two_nodes",
        solvers: &[Adcirc],
        source: "ASGS checkAdcircMesh",
        severity: Severity::Violation,
        needs_strings: true,
        is_mended_by_size: true,
        remedy: "Choose smaller triangles there, or join the piece with its neighbour.",
        find: boundary::strings_of_two_nodes,
    },
    SolverRule {
        name: "open_piece_without_edge",
        solvers: &[Fvcom, Mike, Telemac],
        source: "FVCOM, MIKE, TELEMAC: an edge is open if both its nodes are",
        severity: Severity::Violation,
        needs_strings: true,
        is_mended_by_size: true,
        remedy: "Choose smaller triangles there, or join the piece with its neighbour.",
        find: boundary::lost_open_pieces,
    },
    SolverRule {
        name: "two_open_nodes_and_shore",
        solvers: &[Fvcom],
        source: "FVCOM tge.F",
        severity: Severity::Violation,
        needs_strings: true,
        is_mended_by_size: true,
        remedy: "Choose smaller triangles there, or move the end of the open piece: at corners, and where the frame runs \
                 along a coast, a triangle needs an inner node.",
        find: boundary::two_open_nodes_and_shore,
    },
    SolverRule {
        name: "overconstrained_triangle",
        solvers: &[Telemac],
        source: "TELEMAC-2D: overconstrained triangles",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: true,
        remedy: "Choose smaller triangles there: a triangle needs a node that is not on the boundary.",
        find: boundary::overconstrained,
    },
    SolverRule {
        name: "strip_along_frame",
        solvers: &[Adcirc, Schism, Fvcom, Telemac, Delft3dFm, Mike],
        source: "runs of ADCIRC with advection and of FVCOM, which became unstable there",
        severity: Severity::Note,
        needs_strings: true,
        is_mended_by_size: false,
        remedy: "Cut the strip off (--cut-strips, `cut_off` in a recipe), or choose smaller triangles there.",
        find: strips::strips_along_frame,
    },
    SolverRule {
        name: "obtuse_angle",
        solvers: &[Swan],
        source: "SWAN SwanCheckGrid.ftn90",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Angles are those of the coordinates in the file: a mesh that was made in metres is written in them by \
                 --out-crs plane. Or choose smaller triangles there.",
        find: angles::obtuse,
    },
    SolverRule {
        name: "cells_at_node",
        solvers: &[Swan],
        source: "SWAN SwanCheckGrid.ftn90",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Choose smaller triangles there.",
        find: nodes::cells_at_nodes,
    },
    SolverRule {
        name: "short_flow_link",
        solvers: &[Delft3dFm],
        source: "D-Flow FM flow_geominit.f90",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "No water crosses such a link: write squares (without --cells triangles), or choose smaller triangles there.",
        find: flow_links::short,
    },
    SolverRule {
        name: "skewed_flow_link",
        solvers: &[Delft3dFm],
        source: "D-Flow FM flow_geominit.f90",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Choose smaller triangles there, or orthogonalize the mesh there in RGFGRID.",
        find: flow_links::skewed,
    },
    SolverRule {
        name: "island_like_cell",
        solvers: &[Delft3dFm],
        source: "MeshKernel, D-Flow FM: a face has at most 6 edges",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: true,
        remedy: "Choose smaller triangles there, so that the island has at least 7 edges, or leave it out.",
        find: boundary::islands_like_cells,
    },
    SolverRule {
        name: "connection_of_no_length",
        solvers: &[Modflow],
        source: "MODFLOW 6 DisvGeom.f90: conductance is divided by the distances of both centres from the edge",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Write squares (without --cells triangles), or choose smaller triangles there.",
        find: flow_links::without_length,
    },
    SolverRule {
        name: "oblique_connection",
        solvers: &[Modflow],
        source: "MODFLOW 6, control volumes: a connection crosses its edge at a right angle",
        severity: Severity::Note,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Choose smaller triangles there, or have MODFLOW correct the flow (XT3D).",
        find: flow_links::oblique,
    },
    SolverRule {
        name: "cell_without_thickness",
        solvers: &[Modflow],
        source: "MODFLOW 6 DISV: the bottom of a cell is below its top, which is 0",
        severity: Severity::Violation,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Write a least depth (--least-depth 1), or the surface as the top (--surface).",
        find: nodes::cells_without_thickness,
    },
    SolverRule {
        name: "dry_node",
        solvers: &[Adcirc, Schism],
        source: "depths in the file: at 0 and less a node is dry",
        severity: Severity::Note,
        needs_strings: false,
        is_mended_by_size: false,
        remedy: "Write a least depth (--least-depth 3), or leave it to the wetting and drying of the solver.",
        find: nodes::dry_nodes,
    },
];

/// A rule that a mesh breaks, and where.
#[derive(Debug)]
pub struct BrokenRule {
    /// The rule.
    pub rule: &'static SolverRule,
    /// The places, one at least.
    pub found: Vec<BrokenPlace>,
}

impl BrokenRule {
    /// Returns a sentence: how many places break the rule, where it comes from, and what helps.
    pub fn in_words(&self, solver: Solver) -> String {
        let SolverRule { source, remedy, .. } = self.rule;
        let places = match self.found.len() {
            1 => "1 place breaks".to_owned(),
            places => format!("{} places break", Grouped(places)),
        };
        format!("{places} the rule “{}” of {} ({source}). {remedy}", self.rule.title(), solver.name())
    }
}

impl SolverRule {
    /// Returns its name in sentences.
    pub fn title(&self) -> String {
        self.name.replace('_', " ")
    }
}

/// Returns the rules of a solver.
pub fn rules_of(solver: Solver) -> impl Iterator<Item = &'static SolverRule> {
    RULES.iter().filter(move |rule| rule.solvers.contains(&solver))
}

/// Returns the rules of a solver that a mesh breaks, with the places.
pub fn broken_rules(mesh: &WrittenMesh, solver: Solver) -> Vec<BrokenRule> {
    broken_among(rules_of(solver), mesh)
}

/// Returns those of some rules that a mesh breaks, with the places.
fn broken_among(rules: impl Iterator<Item = &'static SolverRule>, mesh: &WrittenMesh) -> Vec<BrokenRule> {
    let broken = rules.map(|rule| BrokenRule { rule, found: (rule.find)(mesh) });
    broken.filter(|broken| !broken.found.is_empty()).collect()
}

/// Returns a mesh as a solver gets it, in the plane and without values at its nodes: as much as rules on the
/// boundary need.
fn plain_mesh(extract: &Extract, domain: &Domain, marks: &BoundaryMarks, solver: Solver) -> WrittenMesh {
    let data = MeshData {
        target_diameter: &[],
        quantities: &[],
        heights: None,
        boundary: &MeshBoundary::new(extract, domain, marks),
        lines: &[],
        parts: &[],
        cells: CellShape::Triangles,
        joined: &JoinedCells::default(),
        parts_for: None,
        provenance: &Provenance::default(),
    };
    WrittenMesh::of(extract, &data, solver)
}
