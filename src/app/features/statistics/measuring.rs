//! What is measured of a mesh.

use std::sync::Arc;

use glam::DVec2;

use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::domain::{Domain, DomainOnLattice};
use meshbrush_core::field::RefinementRule;
use meshbrush_core::layers::{Layer, NodeDepths, PaintLayers, SizeField, Straits};
use meshbrush_core::quality::{MeshQuality, QualityCount, TriangleMeasures};
use meshbrush_core::surface::SurfaceRule;
use meshbrush_kit::kit::jobs::Wanted;
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::{Extract, Mesh, MeshStatistics, TriangleId};
use meshbrush_mesh::text::LengthUnit;

/// The figures of a mesh as files get it.
pub struct Measured {
    /// Edges, areas, angles and gradation; `None` without triangles.
    pub statistics: Option<MeshStatistics>,
    /// The middle of a triangle at each place of [`Self::edges_at`].
    pub beside_edges: [Option<DVec2>; 3],
    /// How good the triangles are.
    pub quality: MeshQuality,
    /// Why there are no time steps, where there are none.
    pub no_time_step: Option<NoTimeStep>,
    /// The width of the narrowest strait and its middle, where a layer knows it.
    pub narrowest_strait: Option<(f64, DVec2)>,
    /// Area in square world units.
    pub area: f64,
    /// Nodes.
    pub nodes: usize,
    /// Triangles of each connected part, the part with the largest area first.
    pub part_sizes: Vec<usize>,
    /// The fingerprint of the mesh that was refined, as the command line prints it.
    pub fingerprint: String,
    /// The triangles of that mesh which exceed their target, or `None` where h̄ cannot be evaluated.
    pub too_coarse: Option<Vec<TriangleId>>,
}

/// Why a mesh has no time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoTimeStep {
    /// No visible layer has depths, or none has one everywhere.
    NoDepths,
    /// Lengths are degrees.
    Degrees,
}

impl NoTimeStep {
    /// Returns the reason in a few words.
    pub fn reason(self) -> &'static str {
        match self {
            Self::NoDepths => "no layer of depths",
            Self::Degrees => "lengths are degrees",
        }
    }
}

/// The mesh to be measured, with what it is compared with.
pub struct Measuring {
    /// The mesh with its nodes on the outline, where there is one.
    derived: Option<Arc<Extract<'static>>>,
    mesh: Arc<Mesh>,
    domain: DomainOnLattice,
    in_world: Domain,
    field: Arc<SizeField>,
    layers: Vec<Layer>,
    unit: LengthUnit,
    rule: RefinementRule,
    paint: PaintLayers,
    surface: Option<Arc<SurfaceRule>>,
}

impl Measuring {
    /// Takes the mesh as it is.
    pub fn of(session: &Session) -> Self {
        let (follower, document) = (session.follower(), session.document());
        let settings = document.settings();
        Self {
            derived: session.derived().map(|derived| derived.shared_extract()),
            mesh: follower.shared_mesh(),
            domain: follower.domain().clone(),
            in_world: settings.domain.clone(),
            field: follower.shared_field(),
            layers: settings.layers.clone(),
            unit: settings.unit,
            rule: follower.settings().rule,
            paint: document.paint().clone(),
            surface: follower.surface().cloned(),
        }
    }

    /// Measures it; `None` where nobody wants the figures any more.
    pub fn run(mut self, wanted: &Wanted) -> Option<Measured> {
        let extract = self.derived.take();
        let extract = extract.unwrap_or_else(|| Arc::new(self.mesh.extract().into_owned()));
        let go_on = || wanted.goes_on().then_some(());
        go_on()?;
        let ground = self.in_world.ground();
        let statistics = ground.statistics(&extract);
        go_on()?;
        let depths = NodeDepths::of(&self.layers, extract.view()).and_then(Result::ok);
        let depths = depths.map(|NodeDepths { depths, .. }| depths);
        go_on()?;
        let mut measures = TriangleMeasures::new(extract.view(), &ground)
            .with_target(&self.field, &self.paint)
            .with_links(self.unit);
        if let Some(depths) = &depths {
            measures = measures.with_depths(depths, self.unit);
        }
        let mut count = QualityCount::default();
        let quality = loop {
            go_on()?;
            if let Some(quality) = count.advance(&measures) {
                break quality;
            }
        };
        let (area, part_sizes) = (ground.mesh_area(&extract), extract.part_sizes());
        go_on()?;
        let narrowest_strait = self.narrowest_strait();
        go_on()?;
        let fingerprint = self.mesh.fingerprint().to_string();
        go_on()?;
        let mut criterion = RefinementCriterion::new(&self.domain, &self.field, self.rule, Some(&self.paint))
            .with_surface(self.surface.as_deref());
        Some(Measured {
            beside_edges: statistics.map_or([None; 3], |statistics| beside(&extract, edges_at(&statistics))),
            statistics,
            quality,
            no_time_step: match (&depths, self.unit) {
                (_, LengthUnit::Degree) => Some(NoTimeStep::Degrees),
                (None, _) => Some(NoTimeStep::NoDepths),
                (Some(_), _) => None,
            },
            narrowest_strait,
            area,
            nodes: extract.nodes().len(),
            part_sizes,
            fingerprint,
            too_coarse: self.mesh.unsatisfied(|element| criterion.exceeds(element)).ok(),
        })
    }

    /// Returns the width and the middle of the narrowest strait that the uppermost visible layer of straits
    /// has found.
    fn narrowest_strait(&self) -> Option<(f64, DVec2)> {
        let mut visible = self.layers.iter().rev().filter(|layer| layer.visible);
        let straits: &Straits = visible.find_map(|layer| layer.kind.get())?;
        let narrowest = straits.found.narrowest(&self.in_world)?;
        Some((self.in_world.on_earth(narrowest.width, narrowest.center), narrowest.center))
    }
}

/// Returns the middles of the shortest edge, the longest edge and the one with the largest gradation.
pub fn edges_at(statistics: &MeshStatistics) -> [DVec2; 3] {
    [statistics.shortest_edge_at, statistics.longest_edge_at, statistics.size_ratio_at]
}

/// Returns the middle of a triangle at each of these middles of edges.
fn beside(extract: &Extract, middles: [DVec2; 3]) -> [Option<DVec2>; 3] {
    let mut found = [None; 3];
    for triangle in extract.triangles() {
        let corners = triangle.edge_nodes().map(|(from, _)| extract.world(from));
        let of_edges =
            triangle.edge_nodes().map(|(from, to)| 0.5 * (extract.world(from) + extract.world(to)));
        for (found, middle) in found.iter_mut().zip(middles) {
            if found.is_none() && of_edges.contains(&middle) {
                *found = Some(corners.iter().sum::<DVec2>() / 3.0);
            }
        }
    }
    found
}
