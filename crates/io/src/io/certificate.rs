//! Certificates: what proves the lower bounds of paths and the bounds of solutions, and which bisections of a
//! mesh an error forces, as numbers that other programs can check.

use std::io::{self, Write};

use glam::DVec2;
use serde::Serialize;

use super::Provenance;
use meshbrush_core::document::PathCost;
use meshbrush_core::domain::{Domain, Polygon};
use meshbrush_core::explain::{Bisections, Witness};
use meshbrush_core::layers::Mask;
use meshbrush_core::path::{DualFunction, LegProof};
use meshbrush_fem::fem::BoundProof;
use meshbrush_mesh::geometry::{Lattice, LatticePoint};
use meshbrush_mesh::mesh::TreeTriangle;

/// What the numbers prove, for a reader of the file.
const ABOUT: &str = "For each leg, v is continuous and quadratic on each triangle, with a value at each node and \
    at the middle of each edge. With the leg's scale, |grad(scale v)| <= minorant <= cost at all points, so no \
    path in the domain costs less than scale (v(goal) - v(start)). A triangle has six values: at its corners 0, \
    1, 2, which are also its nodes, then at the middles of its edges 1-2, 2-0, 0-1. Its minorant is affine, with \
    three values at its corners.";

/// What the certificate of a path is about.
#[derive(Clone, Copy, Debug)]
pub struct CertifiedPath<'a> {
    /// What is proved, leg by leg.
    pub proofs: &'a [LegProof],
    /// What a unit of length costs: on the Earth, a metre on the ellipsoid.
    pub cost: &'a PathCost,
    /// The domain that paths stay in.
    pub domain: &'a Domain,
    /// The regions that they stay out of.
    pub keep_out: &'a [Mask],
    /// How far paths stay from the outline and from keep-out regions, in the plane, in world units.
    pub clearance: f64,
    /// No path costs less.
    pub lower: f64,
    /// The path costs no more.
    pub upper: f64,
}

/// Writes the certificate of a path as JSON. Numbers have all digits: a reader gets the same numbers.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_path(out: &mut dyn Write, path: &CertifiedPath<'_>, provenance: &Provenance) -> io::Result<()> {
    let file = CertificateFile::new(path, provenance);
    serde_json::to_writer(&mut *out, &file)?;
    writeln!(out)
}

/// What the numbers of a mesh show, for a reader of the file.
const ABOUT_MESH: &str = "Triangles of the bisection forest, each its apex, where the right angle is, and the ends \
    of its bisection edge, in lattice steps. A demand names a triangle that must be bisected: there the surface is \
    farther from the triangle than is allowed, or it is larger than its target or the diameter of the outline. With \
    a triangle its parent and its mirror image across the bisection edge must be bisected. If that gives all \
    bisected triangles, no conforming mesh of the forest that meets all demands is smaller.";

/// Writes which bisections of a mesh are asked for, as JSON: from that anybody can find that all others are
/// forced.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_mesh(
    out: &mut dyn Write,
    bisections: &Bisections,
    lattice: &Lattice,
    provenance: &Provenance,
) -> io::Result<()> {
    serde_json::to_writer(&mut *out, &MeshFile::new(bisections, lattice, provenance))?;
    writeln!(out)
}

/// What the numbers of a solution prove, for a reader of the file.
const ABOUT_SOLUTION: &str = "-div(a grad u) = f with u given on the boundary, linear along each of its edges; a and \
    f are numbers in each triangle. v is continuous and linear in each triangle, with a value at each node. out[t][k] \
    flows out of triangle t through the edge opposite its corner k: that is a flux s, linear in each triangle, with \
    div s = f but for rounding. So the root of the integral of a |grad(u - v)|^2 is at most that of |s + a grad v|^2 \
    / a, plus what rounding leaves of f - div s times the width of the domain / pi, and both are at most bound.";

/// Writes what proves the bound of a solution, as JSON. Numbers have all digits.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_solution(out: &mut dyn Write, proof: &BoundProof, provenance: &Provenance) -> io::Result<()> {
    let BoundProof { nodes, triangles, diffusion, source, values, fluxes, bound } = proof;
    let file = SolutionFile {
        format: "Meshbrush solution certificate",
        version: 1,
        about: ABOUT_SOLUTION,
        origin: origin(provenance),
        bound: *bound,
        nodes,
        triangles,
        a: diffusion,
        f: source,
        v: values,
        out: fluxes,
    };
    serde_json::to_writer(&mut *out, &file)?;
    writeln!(out)
}

#[derive(Serialize)]
struct SolutionFile<'a> {
    format: &'static str,
    version: u32,
    about: &'static str,
    origin: serde_json::Map<String, serde_json::Value>,
    bound: f64,
    nodes: &'a [[f64; 2]],
    triangles: &'a [[u32; 3]],
    a: &'a [f64],
    f: &'a [f64],
    v: &'a [f64],
    out: &'a [[f64; 3]],
}

type Corners = [[u32; 2]; 3];

#[derive(Serialize)]
struct MeshFile {
    format: &'static str,
    version: u32,
    about: &'static str,
    origin: serde_json::Map<String, serde_json::Value>,
    /// The position of the lattice point 0, 0, in world units.
    lattice_origin: [f64; 2],
    /// A lattice step along x and y, in world units.
    lattice_step: [f64; 2],
    coarse: Vec<Corners>,
    triangles: Vec<Corners>,
    demands: Vec<DemandOfFile>,
}

#[derive(Serialize)]
struct DemandOfFile {
    triangle: Corners,
    #[serde(flatten)]
    why: Why,
}

#[derive(Serialize)]
#[serde(tag = "by", rename_all = "snake_case")]
enum Why {
    Outline,
    Target { at: [f64; 2], target: f64 },
    Surface { at: [f64; 2], error: f64, most: f64 },
}

impl MeshFile {
    fn new(bisections: &Bisections, lattice: &Lattice, provenance: &Provenance) -> Self {
        let Bisections { coarse, leaves, asked } = bisections;
        let all = |triangles: &[TreeTriangle]| triangles.iter().map(corners).collect();
        let demand = |(triangle, witness): &(TreeTriangle, Witness)| {
            let why = match *witness {
                Witness::Outline => Why::Outline,
                Witness::Target { at, target } => Why::Target { at: at.to_array(), target },
                Witness::Surface(demand) => {
                    Why::Surface { at: demand.at.to_array(), error: demand.error, most: demand.most }
                }
            };
            DemandOfFile { triangle: corners(triangle), why }
        };
        Self {
            format: "Meshbrush mesh certificate",
            version: 1,
            about: ABOUT_MESH,
            origin: origin(provenance),
            lattice_origin: lattice.world_from_lattice(LatticePoint::new(0, 0)).to_array(),
            lattice_step: lattice.step().to_array(),
            coarse: all(coarse),
            triangles: all(leaves),
            demands: asked.iter().map(demand).collect(),
        }
    }
}

fn corners(triangle: &TreeTriangle) -> Corners {
    triangle.corners().map(|corner| [corner.x, corner.y])
}

fn origin(provenance: &Provenance) -> serde_json::Map<String, serde_json::Value> {
    provenance.entries().map(|(key, text)| (key.to_owned(), text.into())).collect()
}

#[derive(Serialize)]
struct CertificateFile<'a> {
    format: &'static str,
    version: u32,
    about: &'static str,
    origin: serde_json::Map<String, serde_json::Value>,
    /// A formula of x, y and risk; none on the Earth, where the scale of the projection counts as well.
    cost: Option<String>,
    /// The corners [x, y] of the domain's rectangle. Paths may follow its sides.
    bounds: [[f64; 2]; 2],
    /// Polygons that the domain consists of within its bounds, each an outer ring and holes; none for all.
    domain: Option<Vec<Vec<Vec<[f64; 2]>>>>,
    /// The condition for the points of the domain, where a formula gives them.
    inside: Option<String>,
    keep_out: Vec<Vec<Vec<[f64; 2]>>>,
    clearance: f64,
    lower: f64,
    upper: f64,
    legs: Vec<LegOfFile<'a>>,
}

#[derive(Serialize)]
struct LegOfFile<'a> {
    path: Vec<[f64; 2]>,
    lower: f64,
    upper: f64,
    scale: f64,
    nodes: Vec<[f64; 2]>,
    values: &'a [f64],
    triangles: &'a [[u32; 6]],
    minorants: &'a [[f64; 3]],
}

impl<'a> CertificateFile<'a> {
    fn new(path: &CertifiedPath<'a>, provenance: &Provenance) -> Self {
        let CertifiedPath { proofs, cost, domain, keep_out, clearance, lower, upper } = *path;
        let is_flat = domain.ground().inverse_scale().is_none();
        let formula = || match cost {
            PathCost::Weighted(weights) => format!("{} + {}*risk", weights.length, weights.risk),
            PathCost::Formula(formula) => formula.to_string(),
        };
        let region = domain.region().map(|region| rings(region.polygons()));
        Self {
            format: "Meshbrush path certificate",
            version: 1,
            about: ABOUT,
            origin: origin(provenance),
            cost: is_flat.then(formula),
            bounds: [domain.bounds.min, domain.bounds.max].map(|corner| corner.to_array()),
            domain: region,
            inside: domain.formula().map(ToString::to_string),
            keep_out: keep_out.iter().flat_map(|mask| rings(mask.polygons())).collect(),
            clearance,
            lower,
            upper,
            legs: proofs.iter().map(LegOfFile::new).collect(),
        }
    }
}

impl<'a> LegOfFile<'a> {
    fn new(proof: &'a LegProof) -> Self {
        let LegProof { path, lower, upper, dual } = proof;
        let (path, lower, upper) = (points(path), *lower, *upper);
        match dual.as_deref() {
            Some(DualFunction { nodes, values, triangles, minorants, scale }) => {
                let (scale, nodes) = (*scale, points(nodes));
                Self { path, lower, upper, scale, nodes, values, triangles, minorants }
            }
            None => {
                let (nodes, values, triangles, minorants) = (Vec::new(), &[][..], &[][..], &[][..]);
                Self { path, lower, upper, scale: 0.0, nodes, values, triangles, minorants }
            }
        }
    }
}

fn rings(polygons: &[Polygon]) -> Vec<Vec<Vec<[f64; 2]>>> {
    polygons.iter().map(|polygon| polygon.iter().map(|ring| points(ring)).collect()).collect()
}

fn points(points: &[DVec2]) -> Vec<[f64; 2]> {
    points.iter().map(|point| point.to_array()).collect()
}
