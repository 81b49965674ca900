//! Certificates of paths: what proves their lower bounds, as numbers that other programs can check.

use std::io::{self, Write};

use glam::DVec2;
use serde::Serialize;

use super::Provenance;
use meshbrush_core::document::PathCost;
use meshbrush_core::domain::{Domain, Polygon};
use meshbrush_core::layers::Mask;
use meshbrush_core::path::{DualFunction, LegProof};

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

/// Writes a certificate as JSON. Numbers have all digits: a reader gets the same numbers.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut dyn Write, path: &CertifiedPath<'_>, provenance: &Provenance) -> io::Result<()> {
    let file = File::new(path, provenance);
    serde_json::to_writer(&mut *out, &file)?;
    writeln!(out)
}

#[derive(Serialize)]
struct File<'a> {
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

impl<'a> File<'a> {
    fn new(path: &CertifiedPath<'a>, provenance: &Provenance) -> Self {
        let CertifiedPath { proofs, cost, domain, keep_out, clearance, lower, upper } = *path;
        let origin = provenance.entries().map(|(key, text)| (key.to_owned(), text.into())).collect();
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
            origin,
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
