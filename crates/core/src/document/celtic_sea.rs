//! The example of a coastal modeller: a sea with its depths, meshed in metres.
//!
//! The recipe `assets/celtic_sea.toml` describes the same document.

use std::sync::Arc;

use glam::{DVec2, dvec2};

use super::{PathPlan, Settings};
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain, NamedPolygon, OutlineOnEarth, Polygon};
use crate::earth::{Coordinates, GeographicExtent, ProjectionChoice, Reprojection, projected_polygons};
use crate::field::Transfer;
use crate::geometry::Rect;
use crate::layers::{
    DepthRule, DepthSizes, Depths, DistanceLayer, DistanceTo, Layer, LayerKind, PositiveDepth, RasterSource,
    StraitSearch, Straits,
};
use crate::mesh::Progress;
use crate::raster::{Raster, RasterPyramid, projected_raster};
use crate::text::LengthUnit;

/// What a sea chart has, by longitude and latitude.
#[derive(Clone, Debug)]
pub struct SeaChart {
    /// The sea, without its islands.
    pub sea: Vec<NamedPolygon>,
    /// Depths of water in metres, 0 on land.
    pub depths: Raster,
}

/// The rectangle in the plane, in metres: 14 × 14 squares of [`SPACING`].
const FRAME: [DVec2; 2] = [dvec2(-231_000.0, 5_295_000.0), dvec2(231_000.0, 5_757_000.0)];
const SPACING: f64 = 33_000.0;
/// A point of each named piece of the boundary, in the plane.
const NAMES: [(DVec2, &str); 16] = [
    (dvec2(-100_000.0, 5_295_000.0), "Bay of Biscay"),
    (dvec2(231_000.0, 5_600_000.0), "Eastern Channel"),
    (dvec2(-200_000.0, 5_757_000.0), "Irish Sea"),
    (dvec2(-231_000.0, 5_500_000.0), "Atlantic"),
    (dvec2(-121_996.8, 5_538_028.7), "Great Britain"),
    (dvec2(-93_656.7, 5_362_577.3), "France"),
    (dvec2(171_658.6, 5_619_659.1), "Isle of Wight"),
    (dvec2(107_973.0, 5_455_252.0), "Jersey"),
    (dvec2(72_412.2, 5_486_416.1), "Guernsey"),
    (dvec2(180_667.2, 5_631_621.3), "Hayling Island"),
    (dvec2(-113_741.5, 5_372_154.9), "Ushant"),
    (dvec2(93_670.3, 5_508_900.6), "Alderney"),
    (dvec2(-200_987.8, 5_534_570.5), "St Mary’s"),
    (dvec2(81_694.9, 5_476_023.9), "Sark"),
    (dvec2(-203_940.2, 5_538_635.1), "Tresco"),
    (dvec2(-82_407.0, 5_671_413.5), "Lundy"),
];
/// A ship from Saint-Malo to the Bristol Channel, and how far it stays from the shore.
const ROUTE: [DVec2; 2] = [dvec2(103_000.0, 5_402_000.0), dvec2(21_000.0, 5_686_000.0)];
const CLEARANCE: f64 = 5_000.0;
/// The names of the layers, from the bottom to the top.
const LAYERS: [&str; 4] = ["Long waves", "Slopes", "Along the coasts", "Straits"];
/// The minimum and the maximum width of a strait, in metres.
const STRAITS: [f64; 2] = [6000.0, 30_000.0];
/// Edges of the coasts along which straits are searched in one step.
const EDGES: usize = 256;

/// The work of making the document of the sea, in steps.
pub(super) struct Making {
    name: String,
    step: SeaStep,
}

/// What is done next, and what is there for it.
enum SeaStep {
    /// A plane is chosen for the sea.
    Choose(Box<SeaChart>),
    /// The sea is placed in that plane.
    Place(Box<(SeaChart, Reprojection)>),
    /// It is cut to the frame.
    Cut(Box<(Vec<Polygon>, Raster, Reprojection)>),
    /// The depths are projected.
    Project(Box<(Domain, Raster, Reprojection)>),
    /// Diameters are found that the slopes of the ground ask for.
    Slopes(Box<(Domain, RasterSource)>),
    /// The search for straits begins.
    Straits(Box<(Domain, [LayerKind; 3])>),
    /// Straits are searched.
    Search(Box<(Domain, [LayerKind; 3], StraitSearch)>),
    /// The document is made.
    Complete(Box<(Domain, [LayerKind; 4])>),
    Done,
}

impl Making {
    pub(super) fn new(name: &str, chart: SeaChart) -> Self {
        Self { name: name.into(), step: SeaStep::Choose(Box::new(chart)) }
    }

    /// Takes the next step. Returns the settings after the last one.
    pub(super) fn advance(&mut self) -> Option<Settings> {
        self.step = match std::mem::replace(&mut self.step, SeaStep::Done) {
            SeaStep::Choose(chart) => {
                let reprojection = plane_for(&chart.sea);
                SeaStep::Place(Box::new((*chart, reprojection)))
            }
            SeaStep::Place(work) => {
                let (SeaChart { sea, depths }, reprojection) = *work;
                let polygons: Vec<Polygon> = sea.into_iter().map(|named| named.polygon).collect();
                SeaStep::Cut(Box::new((projected_polygons(&polygons, &reprojection), depths, reprojection)))
            }
            SeaStep::Cut(work) => {
                let (polygons, depths, reprojection) = *work;
                let frame = Rect::new(FRAME[0], FRAME[1]);
                // The frame was chosen, so that it alone cuts the sea.
                let chosen = OutlineOnEarth::default();
                let domain = Domain::of_stored_polygons(polygons, frame, &chosen).expect("a valid outline");
                let domain = Domain { projection: Some(reprojection.to), ..domain };
                SeaStep::Project(Box::new((domain, depths, reprojection)))
            }
            SeaStep::Project(work) => {
                let (domain, depths, reprojection) = *work;
                let depths =
                    projected_raster(&depths, &reprojection, domain.bounds).expect("depths of the domain");
                let raster = Arc::new(RasterPyramid::new(depths));
                SeaStep::Slopes(Box::new((
                    domain,
                    RasterSource { name: "celtic_sea_depths.tif".into(), raster },
                )))
            }
            SeaStep::Slopes(work) => {
                let (domain, depths) = *work;
                let [waves, slopes] = depth_layers(&domain, &depths);
                SeaStep::Straits(Box::new((domain, [waves, slopes, along_coasts()])))
            }
            SeaStep::Straits(work) => {
                let (domain, kinds) = *work;
                let search = StraitSearch::new(&domain, &marks(), STRAITS);
                SeaStep::Search(Box::new((domain, kinds, search)))
            }
            SeaStep::Search(mut work) => match work.2.advance(EDGES) {
                Progress::More => SeaStep::Search(work),
                Progress::Done => {
                    let (domain, [waves, slopes, coasts], search) = *work;
                    let straits = LayerKind::Straits(Straits { across: 3.0, found: search.finish() });
                    SeaStep::Complete(Box::new((domain, [waves, slopes, coasts, straits])))
                }
            },
            SeaStep::Complete(work) => {
                let (domain, kinds) = *work;
                return Some(settings(&self.name, domain, kinds));
            }
            SeaStep::Done => return None,
        };
        None
    }
}

/// Returns the way into the plane that the program chooses for the sea.
fn plane_for(sea: &[NamedPolygon]) -> Reprojection {
    let rings = sea.iter().flat_map(|named| named.polygon.iter().map(Vec::as_slice));
    let extent = GeographicExtent::from_rings(rings).expect("polygons");
    let projection = ProjectionChoice::Automatic.projection(&extent).expect("a small part of the Earth");
    Reprojection { from: Coordinates::Geographic, to: projection }
}

/// Returns the names of the islands and coasts.
fn marks() -> BoundaryMarks {
    let names = NAMES.map(|(at, name)| (at, name.to_owned())).to_vec();
    BoundaryMarks { names, ..BoundaryMarks::default() }
}

fn settings(name: &str, domain: Domain, kinds: [LayerKind; 4]) -> Settings {
    let route = PathPlan { routes: vec![ROUTE.to_vec()], clearance: CLEARANCE, ..PathPlan::default() };
    let mut layers = Layer::stack(kinds);
    layers.iter_mut().zip(LAYERS).for_each(|(layer, name)| layer.name = name.into());
    Settings {
        unit: LengthUnit::Metre,
        spacing: SPACING,
        boundary: BoundaryTreatment::OnOutline { diameter: 2500.0 },
        boundary_marks: Arc::new(marks()),
        transfer: Transfer::between(1500.0, 24_000.0),
        layers,
        gradation: Some(0.25),
        paths: Arc::new(route.with_names(["Saint-Malo to Bristol".to_owned()])),
        ..Settings::for_domain(name.into(), domain)
    }
}

/// Returns the layers of long waves and of slopes.
fn depth_layers(domain: &Domain, depths: &RasterSource) -> [LayerKind; 2] {
    let depth = |rule, [from, to]: [f64; 2]| {
        let sizes = DepthSizes { positive: PositiveDepth::Down, offset: 0.0, between: [from, to], rule };
        Depths::new_in_plane(depths.clone(), sizes, domain.projection).into()
    };
    // A wave of half an hour, as from an earthquake.
    let waves = DepthRule::Wavelength { period: 1800.0, triangles: 5.0 };
    let slopes = DepthRule::Slope { triangles: 15.0, smoothing: 8000.0 };
    [depth(waves, DepthSizes::ALL_WATER), depth(slopes, [50.0, f64::INFINITY])]
}

fn along_coasts() -> LayerKind {
    DistanceLayer { to: DistanceTo::Coasts, at_zero: 2500.0, slope: 0.15, range: f64::INFINITY }.into()
}
