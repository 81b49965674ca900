use std::sync::Arc;

use glam::{DVec2, dvec2};

use super::celtic_sea::{Making, SeaChart};
use super::{Document, PathPlan, Settings};
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain, NamedPolygon, Polygon};
use crate::field::{Formula, RefinementRule, Transfer};
use crate::geometry::Rect;
use crate::layers::{
    BandLayer, Combine, DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, Mask, Quantity, RasterLayer,
    RasterReading, RasterSource, ShapeList, Shapes, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource, Threat,
    ThreatLaw, Threats, ValueCurve,
};
use crate::paint::{Brush, Medium};
use crate::raster::{Raster, RasterPyramid};
use crate::text::LengthUnit;

/// A document that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Example {
    /// A few radar-like threats as painted risk.
    Threats,
    /// The mesh of Figure 1 of the report, by its own rule: 9,560 triangles.
    Diamond,
    /// The slope of a real terrain as risk.
    Terrain,
    /// The heights of a real terrain as a surface.
    Heights,
    /// A sea with its islands.
    Aegean,
    /// A sea with its depths, meshed in metres.
    CelticSea,
    /// Every kind of layer, on the terrain.
    Layers,
    /// A path of least cost between threats.
    Path,
}

impl Example {
    /// All examples. The window starts with the first.
    pub const ALL: [Self; 8] = [
        Self::Threats,
        Self::Diamond,
        Self::Terrain,
        Self::Heights,
        Self::Aegean,
        Self::CelticSea,
        Self::Layers,
        Self::Path,
    ];

    /// Returns the name for menus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Threats => "Radar threats",
            Self::Diamond => "The report's diamond",
            Self::Terrain => "Terrain slope",
            Self::Heights => "Terrain within an error",
            Self::Aegean => "Aegean Sea",
            Self::CelticSea => "Celtic Sea with depths",
            Self::Layers => "Layers on a terrain",
            Self::Path => "Threats and a path",
        }
    }

    /// Returns a sentence about it.
    pub fn about(self) -> &'static str {
        match self {
            Self::Threats => {
                "Painted risk: four radar sites and a valley between them. Paint more, or erase."
            }
            Self::Diamond => "Figure 1 of the report: a formula, by the report's vertex rule.",
            Self::Terrain => "Slope of the terrain at Jacksboro, from the SRTM elevation model, as risk.",
            Self::Heights => {
                "Heights of the same terrain: the smallest mesh within 20 m of them. Move the error, or take a point of the curve."
            }
            Self::Aegean => {
                "The sea between Greece and Turkey, fitted to the coast, with 65 islands as holes."
            }
            Self::CelticSea => {
                "A sea between Cornwall and Brittany in metres: sizes from depths, coasts and straits, and a ship's path."
            }
            Self::Layers => {
                "Slope, cliffs, a road, radio masts, paint and a floor: every kind of layer, with limited gradation."
            }
            Self::Path => "The path of least cost between seven threats. Drag its ends, or the threats.",
        }
    }

    /// Returns the document of an example that needs no data.
    ///
    /// # Panics
    /// Panics for the others.
    pub fn without_data(self) -> Document {
        self.document(&NoData)
    }

    /// Returns the document. Only examples that need data ask for it.
    pub fn document(self, data: &impl ExampleData) -> Document {
        let mut making = self.making(data);
        loop {
            if let Some(document) = making.advance() {
                return document;
            }
        }
    }

    /// Begins to make the document, in steps. Only examples that need data ask for it.
    pub fn making(self, data: &impl ExampleData) -> ExampleMaking {
        ExampleMaking(match self {
            Self::Threats => ExampleStep::Made(threats().into()),
            Self::Diamond => ExampleStep::Settled(diamond().into()),
            Self::Terrain => ExampleStep::Settled(terrain(data.slope()).into()),
            Self::Heights => ExampleStep::Settled(heights(data.heights()).into()),
            Self::Aegean => ExampleStep::Sea(data.sea()),
            Self::CelticSea => ExampleStep::Chart(Making::new(self.name(), data.chart()).into()),
            Self::Layers => ExampleStep::Slope(data.slope()),
            Self::Path => ExampleStep::Settled(path().into()),
        })
    }
}

/// The work of making the document of an example, in steps that take some ten milliseconds each.
pub struct ExampleMaking(ExampleStep);

/// What is done next, and what is there for it.
enum ExampleStep {
    Sea(Vec<NamedPolygon>),
    Coasts(Vec<NamedPolygon>, Box<Domain>),
    Slope(Raster),
    Chart(Box<Making>),
    Settled(Box<Settings>),
    Made(Box<Document>),
    Done,
}

impl ExampleMaking {
    /// Takes the next step. Returns the document after the last one.
    pub fn advance(&mut self) -> Option<Document> {
        self.0 = match std::mem::replace(&mut self.0, ExampleStep::Done) {
            ExampleStep::Sea(sea) => {
                let polygons: Vec<Polygon> = sea.iter().map(|named| named.polygon.clone()).collect();
                let domain = Domain::of_polygons(&polygons).expect("a valid outline");
                ExampleStep::Coasts(sea, domain.into())
            }
            ExampleStep::Coasts(sea, domain) => ExampleStep::Settled(aegean(&sea, *domain).into()),
            ExampleStep::Slope(slope) => ExampleStep::Made(layers(slope).into()),
            ExampleStep::Chart(mut making) => match making.advance() {
                Some(settings) => ExampleStep::Settled(settings.into()),
                None => ExampleStep::Chart(making),
            },
            ExampleStep::Settled(settings) => ExampleStep::Made(document(*settings).into()),
            ExampleStep::Made(document) => return Some(*document),
            ExampleStep::Done => return None,
        };
        None
    }
}

/// The data of examples. What an example needs must be there.
pub trait ExampleData {
    /// Returns the slope of a terrain as risk by pixel over its rectangle.
    fn slope(&self) -> Raster {
        panic!("the example needs a picture of slopes")
    }

    /// Returns the heights of a terrain, in metres, by pixel over its rectangle in degrees.
    fn heights(&self) -> Raster {
        panic!("the example needs heights")
    }

    /// Returns the polygons of the Aegean, in degrees.
    fn sea(&self) -> Vec<NamedPolygon> {
        panic!("the example needs the outline of a sea")
    }

    /// Returns the Celtic Sea with its depths.
    fn chart(&self) -> SeaChart {
        panic!("the example needs a sea chart")
    }
}

struct NoData;

impl ExampleData for NoData {}

fn document(settings: Settings) -> Document {
    Document::new(settings, None).expect("the examples are valid: a test opens each")
}

/// Figure 1 and Section 5.4, twenty times as large so that every coordinate is exact.
fn diamond() -> Settings {
    let formula = Formula::parse("if(abs(x) + abs(y) < 8, 0.25, 20)").expect("a valid formula");
    Settings {
        name: Example::Diamond.name().into(),
        domain: Domain::rectangle(Rect::around(DVec2::ZERO, 10.0)),
        spacing: 1.0,
        boundary: BoundaryTreatment::default_for(1.0),
        transfer: Transfer::between(0.02, 20.0),
        layers: Layer::default_stack(LayerKind::target(formula)),
        rule: RefinementRule::Vertex,
        ..Settings::default()
    }
}

/// Threats on a square of 100 km, and the path of an aircraft between them.
fn path() -> Settings {
    let threat = |x, y, range, peak| Threat { at: dvec2(x, y), range, peak, law: ThreatLaw::Radar };
    let threats = vec![
        threat(27.0, 38.0, 19.0, 1.0),
        threat(45.0, 70.0, 22.0, 0.9),
        threat(52.0, 22.0, 17.0, 1.0),
        threat(63.0, 47.0, 15.0, 0.8),
        threat(78.0, 74.0, 17.0, 1.0),
        threat(84.0, 27.0, 14.0, 0.9),
        threat(17.0, 78.0, 15.0, 0.7),
    ];
    let risk = LayerKind::Threats(Threats::new(threats).expect("valid threats"));
    let routes = vec![vec![dvec2(6.0, 12.0), dvec2(94.0, 88.0)]];
    Settings {
        name: Example::Path.name().into(),
        unit: LengthUnit::Kilometre,
        domain: Domain::rectangle(Rect::new(DVec2::ZERO, dvec2(100.0, 100.0))),
        spacing: 2.0,
        boundary: BoundaryTreatment::default_for(2.0),
        transfer: Transfer::between(0.5, 2.9),
        layers: Layer::default_stack(risk),
        paths: Arc::new(PathPlan { routes, ..PathPlan::default() }),
        ..Settings::default()
    }
}

fn source_of(slope: Raster) -> RasterSource {
    RasterSource { name: "jacksboro_slope.png".into(), raster: Arc::new(RasterPyramid::new(slope)) }
}

fn terrain(slope: Raster) -> Settings {
    let bounds = slope.bounds();
    let source = source_of(slope);
    let slope_as_risk = LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk });
    Settings {
        name: Example::Terrain.name().into(),
        unit: LengthUnit::Kilometre,
        domain: Domain::rectangle(bounds),
        spacing: bounds.size().max_element() / 24.0,
        boundary: BoundaryTreatment::default_for(bounds.size().max_element() / 24.0),
        transfer: Transfer { shape: 1.6, ..Transfer::between(0.05, 2.0) },
        layers: Layer::default_stack(slope_as_risk),
        ..Settings::default()
    }
}

/// The largest error of the example of heights, in metres.
const HEIGHT_ERROR: f64 = 20.0;

fn heights(heights: Raster) -> Settings {
    let bounds = heights.bounds();
    let raster = Arc::new(RasterPyramid::new(heights));
    let source = SurfaceSource::Raster(RasterSource { name: "jacksboro_heights.tif".into(), raster });
    let (goal, norm) = (SurfaceGoal::Within(HEIGHT_ERROR), SurfaceNorm::Largest);
    let surface = LayerKind::Surface(Surface { source, goal, norm });
    let settings = Settings {
        name: Example::Heights.name().into(),
        unit: LengthUnit::Degree,
        domain: Domain::rectangle(bounds),
        transfer: Transfer::between(1e-6, f64::MAX),
        ..Settings::default()
    };
    let settings = settings.with_nodes_on_samples(&surface);
    let mut layers = Layer::default_stack(surface);
    if let Some(heights) = layers.iter_mut().find(|layer| layer.kind.is::<Surface>()) {
        heights.name = "Heights".into();
    }
    Settings { layers, ..settings }
}

/// The road across the terrain, as shares of its sides, from the lower left.
const ROAD: [DVec2; 6] = [
    dvec2(0.04, 0.08),
    dvec2(0.31, 0.26),
    dvec2(0.44, 0.33),
    dvec2(0.52, 0.54),
    dvec2(0.84, 0.74),
    dvec2(0.96, 0.96),
];
/// The coarsely surveyed part of the terrain, as corners in shares of its sides.
const SURVEY: [DVec2; 4] = [dvec2(0.60, 0.05), dvec2(0.93, 0.05), dvec2(0.97, 0.33), dvec2(0.66, 0.42)];
/// A landing site, painted, as shares of the sides of the terrain.
const LANDING: [DVec2; 3] = [dvec2(0.62, 0.86), dvec2(0.68, 0.91), dvec2(0.76, 0.90)];

/// Returns every kind of layer, on the terrain.
fn layers(slope: Raster) -> Document {
    let bounds = slope.bounds();
    let at = |share: DVec2| bounds.min + share * bounds.size();
    let layers = layers_of_terrain(&source_of(slope), at);
    let transfer = Transfer { shape: 1.6, ..Transfer::between(0.06, 2.0) };
    let settings = Settings {
        unit: LengthUnit::Kilometre,
        spacing: bounds.size().max_element() / 16.0,
        transfer,
        layers,
        gradation: Some(0.4),
        ..Settings::for_domain(Example::Layers.name().into(), Domain::rectangle(bounds))
    };
    let mut document = document(settings);
    let medium = Medium::Risk(1.0);
    document.begin_stroke(Brush { medium, radius: 0.9, hardness: 0.5, strength: 0.9 });
    for share in LANDING {
        document.draw_to(at(share));
    }
    document.end_stroke();
    without_history(&document)
}

/// Returns the layers, from the bottom to the top; lengths in kilometres. `at` places a share of the sides.
fn layers_of_terrain(slope: &RasterSource, at: impl Fn(DVec2) -> DVec2) -> Vec<Layer> {
    let curve = ValueCurve::new(vec![[0.3, 2.0], [0.6, 1.0], [1.0, 0.5]]).expect("a valid curve");
    let reading = RasterReading::Curve(Arc::new(curve));
    let road = ShapeList { lines: vec![ROAD.map(&at).to_vec()], ..ShapeList::default() };
    let shapes = Shapes::new(road, false).expect("a valid line");
    let to = DistanceTo::Shapes { name: String::new(), shapes };
    let mast = |place, range, peak, law| Threat { at: at(place), range, peak, law };
    let masts = vec![
        mast(dvec2(0.19, 0.75), 2.8, 1.0, ThreatLaw::Radar),
        mast(dvec2(0.40, 0.70), 2.2, 0.85, ThreatLaw::Gaussian),
        mast(dvec2(0.86, 0.52), 2.0, 0.8, ThreatLaw::Disc),
    ];
    let floor = LayerKind::target(Formula::constant_of(0.7));
    let survey = Mask::new(&[vec![SURVEY.map(&at).to_vec()]]).expect("a valid polygon");
    let named = [
        ("Base", LayerKind::target(Formula::parse("1.4 + 0.6*sin(x/3)*cos(y/4)").expect("a valid formula"))),
        ("Slope", LayerKind::Raster(RasterLayer { source: slope.clone(), reading })),
        ("Cliffs", LayerKind::Band(BandLayer { source: slope.clone(), between: [0.97, 1.0], diameter: 0.3 })),
        ("Road", LayerKind::Distance(DistanceLayer { to, at_zero: 0.1, slope: 0.3, range: 3.0 })),
        ("Coarse survey", floor),
        ("Radio masts", LayerKind::Threats(Threats::new(masts).expect("valid threats"))),
        ("Landing site", LayerKind::paint(Quantity::Risk)),
    ];
    let layer = |(id, (name, kind)): (u32, (&str, LayerKind))| Layer::new(LayerId(id), name, kind);
    let mut layers: Vec<Layer> = (0..).zip(named).map(layer).collect();
    (layers[4].combine, layers[4].mask) = (Combine::Floor, Some(survey));
    layers
}

/// Radar sites (where, radius, hardness, strength), and a patrol route between them.
const SITES: [(DVec2, f64, f64, f64); 4] = [
    (dvec2(0.245, 0.765), 0.15, 0.05, 0.72),
    (dvec2(0.715, 0.735), 0.21, 0.12, 0.80),
    (dvec2(0.745, 0.745), 0.06, 0.20, 0.60),
    (dvec2(0.855, 0.225), 0.15, 0.10, 0.70),
];

/// Returns the sea at half a degree, the coast at a fiftieth.
fn aegean(sea: &[NamedPolygon], domain: Domain) -> Settings {
    let marks = BoundaryMarks::of_polygons(sea, &domain);
    let settings = Settings::for_domain(Example::Aegean.name().into(), domain);
    let boundary = BoundaryTreatment::OnOutline { diameter: 0.02 };
    let (unit, boundary_marks) = (LengthUnit::Degree, Arc::new(marks));
    Settings { unit, spacing: 0.5, boundary, boundary_marks, ..settings }
}

fn threats() -> Document {
    let mut document = document(Settings { name: Example::Threats.name().into(), ..Settings::default() });
    for (place, radius, hardness, strength) in SITES {
        document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius, hardness, strength });
        document.draw_to(place);
    }
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.06, hardness: 0.15, strength: 0.97 });
    for i in 0..=60 {
        let t = f64::from(i) / 60.0;
        let sway = libm::sin(t * 1.55 * std::f64::consts::PI);
        document.draw_to(dvec2(0.08 + 0.62 * t, 0.30 + 0.21 * sway));
    }
    document.end_stroke();
    without_history(&document)
}

/// Returns a document as it is, with nothing to undo.
fn without_history(document: &Document) -> Document {
    let (settings, paint) = (document.settings().clone(), document.paint().clone());
    Document::new(settings, Some(paint)).expect("the settings were valid before")
}
