use std::sync::Arc;

use glam::{DVec2, dvec2};

use super::{Document, Settings};
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain, NamedPolygon};
use crate::field::{Formula, RefinementRule, Transfer};
use crate::geometry::Rect;
use crate::layers::{Layer, LayerKind, RasterReading, RasterSource};
use crate::mesh::Cleaning;
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
    /// A sea with its islands.
    Aegean,
}

impl Example {
    /// All examples. The window starts with the first.
    pub const ALL: [Self; 4] = [Self::Threats, Self::Diamond, Self::Terrain, Self::Aegean];

    /// Name for menus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Threats => "Radar threats",
            Self::Diamond => "The report's diamond",
            Self::Terrain => "Terrain slope",
            Self::Aegean => "Aegean Sea",
        }
    }

    /// A sentence about it.
    pub fn about(self) -> &'static str {
        match self {
            Self::Threats => {
                "Painted risk: four radar sites and a valley between them. Paint more, or erase."
            }
            Self::Diamond => "Figure 1 of the report: a formula, by the report's vertex rule.",
            Self::Terrain => "Slope of the terrain at Jacksboro, from the SRTM elevation model, as risk.",
            Self::Aegean => {
                "The sea between Greece and Turkey, fitted to the coast, with 65 islands as holes."
            }
        }
    }

    /// The document. `slope` decodes the picture of the terrain, risk by pixel over its rectangle; `sea`
    /// reads the polygons of the Aegean in degrees. Only the examples that need them call these.
    pub fn document(
        self,
        slope: impl FnOnce() -> Raster,
        sea: impl FnOnce() -> Vec<NamedPolygon>,
    ) -> Document {
        match self {
            Self::Threats => threats(),
            Self::Diamond => document(diamond()),
            Self::Terrain => document(terrain(slope())),
            Self::Aegean => document(aegean(&sea())),
        }
    }
}

fn document(settings: Settings) -> Document {
    Document::new(settings, None).expect("the examples are valid: a test opens each")
}

/// Figure 1 and Section 5.4, twenty times as large so that every coordinate is exact.
fn diamond() -> Settings {
    let formula = Formula::parse("if(abs(x) + abs(y) < 8, 0.25, 20)").expect("a valid formula");
    Settings {
        name: Example::Diamond.name().into(),
        unit: LengthUnit::None,
        background: None,
        domain: Domain::rectangle(Rect::around(DVec2::ZERO, 10.0)),
        spacing: 1.0,
        boundary: BoundaryTreatment::usual(1.0),
        cleaning: Cleaning::FOR_SOLVERS,
        boundary_marks: Arc::default(),
        transfer: Transfer { h_min: 0.02, h_max: 20.0, shape: 1.0 },
        layers: Layer::usual(LayerKind::target(formula)),
        gradation: None,
        rule: RefinementRule::Vertex,
        max_triangles: Settings::MAX_TRIANGLES,
        max_memory: Settings::MAX_MEMORY,
    }
}

fn terrain(slope: Raster) -> Settings {
    let bounds = slope.bounds();
    let source =
        RasterSource { name: "jacksboro_slope.png".into(), raster: Arc::new(RasterPyramid::new(slope)) };
    let slope_as_risk = LayerKind::Raster { source, reading: RasterReading::Risk };
    Settings {
        name: Example::Terrain.name().into(),
        unit: LengthUnit::Kilometre,
        background: None,
        domain: Domain::rectangle(bounds),
        spacing: bounds.size().max_element() / 24.0,
        boundary: BoundaryTreatment::usual(bounds.size().max_element() / 24.0),
        cleaning: Cleaning::FOR_SOLVERS,
        boundary_marks: Arc::default(),
        transfer: Transfer { h_min: 0.05, h_max: 2.0, shape: 1.6 },
        layers: Layer::usual(slope_as_risk),
        gradation: None,
        rule: RefinementRule::Area,
        max_triangles: Settings::MAX_TRIANGLES,
        max_memory: Settings::MAX_MEMORY,
    }
}

/// Radar sites (where, radius, hardness, strength), and a patrol route between them.
const SITES: [(DVec2, f64, f64, f64); 4] = [
    (dvec2(0.245, 0.765), 0.15, 0.05, 0.72),
    (dvec2(0.715, 0.735), 0.21, 0.12, 0.80),
    (dvec2(0.745, 0.745), 0.06, 0.20, 0.60),
    (dvec2(0.855, 0.225), 0.15, 0.10, 0.70),
];

/// The sea at half a degree, the coast at a fiftieth.
fn aegean(sea: &[NamedPolygon]) -> Settings {
    let (domain, marks) = BoundaryMarks::domain_of(sea).expect("a valid outline");
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
    let (settings, paint) = (document.settings().clone(), document.paint().clone());
    // Opened as it is, with nothing to undo.
    Document::new(settings, Some(paint)).expect("the settings were valid before")
}
