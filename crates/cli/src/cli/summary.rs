//! The figures of the finished mesh, as text and as JSON.

use glam::DVec2;
use serde::Serialize;

use super::build::FinishedMesh;
use super::cut_strips::Suited;
use super::depths::{
    CourantSummary, DepthSlopeSummary, DepthSummary, HeightTimeStep, LeastDepth, TimeStepSummary,
};
use super::details::{
    LostIsland, LostPiece, MeshDetails, NewHole, PieceSummary, StraitSummary, SurfaceSummary,
};
use super::lines::LineSummary;
use super::partition::PartitionSummary;
use super::quality::QualitySummary;
use super::sequence::SequenceMesh;
use meshbrush_core::domain::{FitQuality, MeshBoundary, Region};
use meshbrush_core::earth::Ground;
use meshbrush_core::field::RefinementRule;
use meshbrush_core::outline::OutlineFit;
use meshbrush_mesh::mesh::{Extract, MeshStatistics, Removed, RemovedPart, Topology};
use meshbrush_mesh::text::{Grouped, LengthUnit};

/// The figures of a mesh; its JSON is the answer of `--json`.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// Number of triangles.
    pub triangles: usize,
    /// The unit of lengths and coordinates: "m", "km" or "degrees".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// Number of nodes.
    pub nodes: usize,
    /// The deepest level.
    pub max_level: usize,
    /// Triangles at each level, from 0.
    pub levels: Vec<usize>,
    /// The mesh's fingerprint, 32 hexadecimal digits: equal for equal meshes, in any order of triangles.
    pub hash: String,
    /// Seconds of refinement, without reading and writing.
    pub seconds: f64,
    /// The area of the mesh, in square world units, with a projection on the ellipsoid.
    pub area: f64,
    /// How the mesh renders the outline of a region.
    #[serde(flatten)]
    pub outline: Option<Outline>,
    /// How well the nodes of the boundary lie on the outline, where they are moved there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outline_nodes: Option<OutlineNodes>,
    /// How well the mesh fits the lines of the document.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lines: Vec<LineSummary>,
    /// The pieces of the boundary of which the mesh has edges.
    pub boundary: Option<Vec<PieceSummary>>,
    /// The pieces of the domain's boundary of which the mesh has no edge.
    pub lost_pieces: Option<Vec<LostPiece>>,
    /// Triangles of each edge-connected part, the largest first.
    pub part_triangles: Option<Vec<usize>>,
    /// Edges, areas, angles and gradation.
    pub statistics: Option<MeshStatistics>,
    /// How good the triangles are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quality: Option<QualitySummary>,
    /// How far the depths at the nodes are from the layers of depths, if there are any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<DepthSummary>,
    /// The Courant numbers of the edges, if a layer keeps them below a number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub courant: Option<CourantSummary>,
    /// The least depth in files, if one is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_depth: Option<LeastDepth>,
    /// How depths were smoothed to a slope, if that is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_slope: Option<DepthSlopeSummary>,
    /// The largest stable time step, if there are depths, and lengths are no degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_time_step: Option<TimeStepSummary>,
    /// How far the mesh is from surfaces, if a layer is one.
    #[serde(flatten)]
    pub surface: Option<SurfaceSummary>,
    /// The triangles across straits, if a layer asks for them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub straits: Option<StraitSummary>,
    /// The meshes of a sequence, each with every node of the one before, if several are asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sequence: Option<Vec<SequenceMesh>>,
    /// The parts for a solver on several processors, if they are asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub partition: Option<PartitionSummary>,
    /// What was done so that the mesh keeps the rules of a solver, if that was asked for.
    #[serde(flatten)]
    pub suited: Suited,
    /// Side δ of a coarse cell, in world units.
    pub spacing: f64,
    /// "vertex" or "area".
    pub rule: &'static str,
    /// Triangles left coarser than their target by `--max-level`.
    pub capped: usize,
    /// Broken invariants, if they were checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violations: Option<usize>,
    #[serde(skip)]
    diameters: Vec<f64>,
}

/// Nodes along the outline of a region.
#[derive(Clone, Debug, Serialize)]
pub struct OutlineNodes {
    /// Nodes of the boundary along the outline.
    pub boundary: usize,
    /// Number of these nodes that lie on the polygons.
    pub on_outline: usize,
    /// Largest distance of the others from the polygons, in world units.
    pub farthest: f64,
    /// Sharp corners of the polygons that are nodes.
    pub corners: usize,
    /// Of a domain by a formula: corners of its line, turning by more than 30°, at which there is no node.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missed_corners: Option<Vec<[f64; 2]>>,
}

impl OutlineNodes {
    fn of(finished: &FinishedMesh, extract: &Extract) -> Option<Self> {
        let OutlineFit { nodes, on_outline, farthest, corners } = finished.derived.fit()?;
        let domain = finished.domain();
        let line = domain.formula().and_then(|_| finished.outline());
        let missed = line.map(|line| line.missed_corners(extract).into_iter().map(Into::into).collect());
        let farthest = domain.longest_on_earth(farthest);
        Some(Self { boundary: nodes, on_outline, farthest, corners, missed_corners: missed })
    }

    fn for_people(&self) -> String {
        let off = match self.boundary - self.on_outline {
            0 => String::new(),
            _ => format!(", the others at most {} off", short(self.farthest)),
        };
        let missed = match self.missed_corners.as_deref() {
            None | Some([]) => String::new(),
            Some([first, others @ ..]) => format!(
                ", no node at {} of the line, the first at {}, {}",
                counted(1 + others.len(), "sharp corner"),
                short(first[0]),
                short(first[1])
            ),
        };
        format!(
            "{} of {} boundary nodes on the outline{off}{missed}\n",
            Grouped(self.on_outline),
            Grouped(self.boundary),
        )
    }
}

/// A region compared with its mesh. Lengths and areas are in world units, with a projection in metres on the
/// ellipsoid.
#[derive(Clone, Debug, Serialize)]
pub struct Outline {
    /// The area that the polygons cover.
    pub region_area: f64,
    /// Holes of the polygons.
    pub region_holes: usize,
    /// Holes of the mesh.
    pub holes: usize,
    /// Edge-connected parts of the mesh.
    pub parts: usize,
    /// The parts and pinches that were removed to clean the mesh.
    pub removed: RemovedSummary,
    /// The area that only one of mesh and polygons covers.
    pub misclassified_area: f64,
    /// Length of the boundary of the mesh.
    pub boundary_length: f64,
    /// Length of the outline of the polygons.
    pub outline_length: f64,
    /// Largest distance from the boundary of the mesh to the outline, and the place.
    pub farthest_from_outline: Option<(f64, [f64; 2])>,
    /// Largest distance from the outline to the boundary of the mesh, and the place.
    pub farthest_from_mesh: Option<(f64, [f64; 2])>,
    /// The holes of the polygons that lie wholly under triangles.
    pub lost_islands: Vec<LostIsland>,
    /// The holes of the mesh that the polygons do not have, such as inlets whose mouth it closes; the largest
    /// first.
    pub new_holes: Vec<NewHole>,
    /// Smallest angle of a triangle, in degrees.
    pub smallest_angle: f64,
    /// Largest angle of a triangle, in degrees.
    pub largest_angle: f64,
}

/// The parts and pinches that cleaning removed.
#[derive(Clone, Debug, Serialize)]
pub struct RemovedSummary {
    /// The parts, the largest first.
    pub parts: Vec<RemovedPartSummary>,
    /// Nodes that were pinches.
    pub pinches: usize,
    /// Triangles, of parts and at pinches.
    pub triangles: usize,
    /// The area of these triangles.
    pub area: f64,
}

/// A part that was removed.
#[derive(Clone, Debug, Serialize)]
pub struct RemovedPartSummary {
    /// A point in it.
    pub place: [f64; 2],
    /// Number of triangles of the part.
    pub triangles: usize,
    /// The area of the part.
    pub area: f64,
}

impl RemovedSummary {
    fn new(removed: &Removed, ground: &Ground) -> Self {
        // The parts are small compared with the Earth.
        let part = |part: &RemovedPart| RemovedPartSummary {
            place: part.place.into(),
            triangles: part.triangles,
            area: ground.area_around(part.area, part.place),
        };
        let Removed { parts, pinches, triangles, area: in_plane, .. } = removed;
        let removed: Vec<RemovedPartSummary> = parts.iter().map(part).collect();
        let at_pinches = in_plane - parts.iter().map(|part| part.area).sum::<f64>();
        let area = removed.iter().map(|part| part.area).sum::<f64>() + at_pinches;
        Self { parts: removed, pinches: *pinches, triangles: *triangles, area }
    }
}

impl Outline {
    fn of(
        finished: &FinishedMesh,
        extract: &Extract,
        region: &Region,
        boundary: Option<&MeshBoundary>,
    ) -> Self {
        let ground = finished.ground();
        let fit = FitQuality::of(extract, region, ground);
        let Topology { parts, holes, .. } = extract.topology();
        let placed = |farthest: Option<(f64, DVec2)>| farthest.map(|(distance, at)| (distance, at.into()));
        Self {
            region_area: fit.region_area,
            region_holes: region.hole_count(),
            holes,
            parts,
            removed: RemovedSummary::new(finished.derived.removed(), ground),
            misclassified_area: fit.misclassified_area,
            boundary_length: fit.boundary_length,
            outline_length: fit.outline_length,
            farthest_from_outline: placed(fit.farthest_from_outline),
            farthest_from_mesh: placed(fit.farthest_from_mesh),
            lost_islands: fit.lost_islands.iter().map(|&lost| LostIsland::new(lost, boundary)).collect(),
            new_holes: fit.new_holes.iter().copied().map(NewHole::from).collect(),
            smallest_angle: fit.smallest_angle,
            largest_angle: fit.largest_angle,
        }
    }

    fn for_people(&self, area: f64) -> String {
        let gained = area - self.region_area;
        let word = if gained < 0.0 { "less" } else { "more" };
        let percent = |share: f64| 100.0 * share / self.region_area;
        let Self { region_holes, parts, removed, .. } = self;
        let kept = region_holes - self.lost_islands.len();
        let distance = |farthest: Option<(f64, [f64; 2])>| match farthest {
            Some((distance, [x, y])) if distance > 0.0 => {
                format!("{} at {}, {}", short(distance), short(x), short(y))
            }
            _ => "0".to_owned(),
        };
        let mut text = format!(
            "area {}, {:.3} % {word} than the polygons' {}; {:.3} % misclassified\n\
             {} in {}, {kept} of {} kept; {}\n\
             boundary {} times as long as the outline; farthest from the outline {}, from the mesh {}\n",
            short(area),
            percent(gained.abs()),
            short(self.region_area),
            percent(self.misclassified_area),
            counted(self.holes, "hole"),
            counted(*parts, "part"),
            counted(*region_holes, "island"),
            angles(self.smallest_angle, self.largest_angle),
            short(self.boundary_length / self.outline_length),
            distance(self.farthest_from_outline),
            distance(self.farthest_from_mesh),
        );
        if let Some(NewHole { place: [x, y], area }) = self.new_holes.first() {
            text += &format!(
                "{} that the polygons do not have, the largest with area {} at {}, {}\n",
                counted(self.new_holes.len(), "hole"),
                short(*area),
                short(*x),
                short(*y),
            );
        }
        if removed.triangles > 0 {
            text += &format!(
                "removed {} in {} and at {}: {:.3} % of the area\n",
                counted(removed.triangles, "triangle"),
                counted(removed.parts.len(), "part"),
                counted(removed.pinches, "pinch"),
                percent(removed.area),
            );
        }
        text
    }
}

fn angles(smallest: f64, largest: f64) -> String {
    format!("angles {smallest:.1}° to {largest:.1}°")
}

/// Returns a number with its noun.
pub(super) fn counted(count: usize, noun: &str) -> String {
    let ending = match noun {
        _ if count == 1 => "",
        "pinch" => "es",
        _ => "s",
    };
    format!("{} {noun}{ending}", Grouped(count))
}

impl Summary {
    /// Returns the figures of a mesh, and of the extract that files get. `details` are wanted for JSON only.
    pub fn of(
        finished: &FinishedMesh,
        extract: &Extract,
        details: Option<&MeshDetails>,
        violations: Option<usize>,
    ) -> Self {
        let mesh = finished.mesh();
        let levels = extract.level_counts();
        let ground = finished.ground();
        let region = finished.outline();
        let boundary = details.map(|details| &details.boundary);
        let fit = match details {
            Some(details) => details.surface.clone(),
            None => finished.surface_fit(extract),
        };
        Self {
            triangles: extract.triangles().len(),
            unit: (finished.unit() != LengthUnit::None).then(|| finished.unit().name()),
            nodes: extract.nodes().len(),
            area: match ground.inverse_scale() {
                None if !extract.is_patched() => mesh.area(),
                _ => ground.mesh_area(extract),
            },
            outline_nodes: OutlineNodes::of(finished, extract),
            lines: finished.derived.line_fits().iter().map(|fit| LineSummary::of(fit, finished)).collect(),
            outline: region.map(|region| Outline::of(finished, extract, &region, boundary)),
            boundary: boundary.map(PieceSummary::of_present),
            lost_pieces: boundary.map(LostPiece::all),
            part_triangles: details.map(MeshDetails::part_triangles),
            statistics: details.and_then(|_| ground.statistics(extract)),
            quality: details.and_then(|details| details.quality.clone()),
            max_level: levels.len() - 1,
            hash: mesh.fingerprint().to_string(),
            seconds: finished.refinement.as_secs_f64(),
            depth: details.and_then(|details| details.depths.as_ref()).map(DepthSummary::from),
            courant: details.and_then(|details| details.courant).map(CourantSummary::from),
            largest_time_step: details.and_then(|details| details.largest_time_step),
            least_depth: details.and_then(|details| details.changed_depths.least),
            depth_slope: details.and_then(|details| details.changed_depths.slope).map(Into::into),
            surface: fit
                .as_ref()
                .zip(finished.built().surface.as_ref())
                .map(|(fit, rule)| SurfaceSummary::new(fit, rule.samples().count())),
            straits: details.and_then(|details| details.straits.clone()),
            sequence: None,
            partition: None,
            suited: Suited::default(),
            spacing: mesh.lattice().spacing(),
            rule: if finished.rule() == RefinementRule::Vertex { "vertex" } else { "area" },
            capped: finished.capped,
            violations,
            diameters: (0..levels.len()).map(|level| mesh.diameter(level as u32)).collect(),
            levels,
        }
    }

    /// Returns a few lines and a table of levels.
    pub fn for_people(&self) -> String {
        let mut text = format!(
            "{} triangles, {} nodes, levels 0 to {}, refined in {}\ncoarse spacing {}, {} rule\n\n",
            Grouped(self.triangles),
            Grouped(self.nodes),
            self.max_level,
            duration(self.seconds),
            self.spacing,
            self.rule,
        );
        if let Some(outline) = &self.outline {
            text.insert_str(text.len() - 1, &outline.for_people(self.area));
        }
        if let Some(SurfaceSummary { max_error, rms_error, gradient_error, worst: [x, y], .. }) = self.surface
        {
            let line = format!(
                "at most {} from the surface, at {}, {}; root mean square {}, of the gradient {}\n",
                short(max_error),
                short(x),
                short(y),
                short(rms_error),
                short(gradient_error)
            );
            text.insert_str(text.len() - 1, &line);
        }
        if let Some(nodes) = &self.outline_nodes {
            text.insert_str(text.len() - 1, &nodes.for_people());
        }
        for line in &self.lines {
            text.insert_str(text.len() - 1, &line.for_people());
        }
        if let Some(step) = &self.largest_time_step {
            text.insert_str(text.len() - 1, &step.for_people());
        }
        text += &format!("{:>5}  {:>12}  {:>13}\n", "level", "diameter", "triangles");
        for (level, (&count, diameter)) in self.levels.iter().zip(&self.diameters).enumerate() {
            text += &format!("{level:>5}  {:>12}  {:>13}\n", short(*diameter), Grouped(count));
        }
        text
    }
}

impl TimeStepSummary {
    fn for_people(&self) -> String {
        let at = |[x, y]: [f64; 2]| format!("at {}, {}", short(x), short(y));
        let by_height =
            |step: HeightTimeStep| format!("; {} s across triangles, {}", short(step.seconds), at(step.at));
        let by_height = self.by_height.map_or_else(String::new, by_height);
        format!("largest time step {} s along edges, {}{by_height}\n", short(self.seconds), at(self.at))
    }
}

/// Milliseconds or seconds.
fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}

/// Six significant digits, without zeros at the end.
fn short(length: f64) -> String {
    if !(1e-4..1e6).contains(&length.abs()) && length != 0.0 {
        return format!("{length:.5e}");
    }
    let decimals = (5.0 - length.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{length:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_shown_short() {
        for (length, shown) in [
            (1.0, "1"),
            (std::f64::consts::SQRT_2, "1.41421"),
            (0.015625, "0.015625"),
            (100.0, "100"),
            (353_553.39, "353553"),
            (1.0 / 65536.0, "1.52588e-5"),
        ] {
            assert_eq!(short(length), shown);
        }
    }
}
