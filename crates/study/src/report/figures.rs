//! The figures of the report and its experiment, as documents that show them, and its numbers beside those of
//! a mesh.

use std::sync::Arc;

use glam::{DVec2, dvec2};

use crate::document::{Document, Example, Settings};
use crate::domain::{BoundaryTreatment, Domain};
use crate::field::{Formula, RefinementRule, Transfer};
use crate::geometry::Rect;
use crate::layers::{Layer, LayerKind};
use crate::mesh::Mesh;
use crate::steps::{NamedPlace, Names, NeighbourCase, RecordedStep, ReportRow, StepAction, StepPlayer};
use crate::text::{Grouped, fixed, significant};

/// A figure of the report, or its experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportFigure {
    /// Figure 1: a mesh.
    Mesh,
    /// Figure 2: a coarse triangulation with its indices.
    CoarseGrid,
    /// Figure 3: the descendants of a bisected triangle.
    Descendants,
    /// Figure 4: neighbours before and after a bisection.
    Neighbours,
    /// Figure 5: running times.
    Times,
    /// Figure 6: the orientation test of point location.
    Orientation,
    /// Section 5.4: the experiment that Figure 5 shows.
    Experiment,
}

/// A number of the report beside ours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comparison {
    /// The quantity in words.
    pub what: String,
    /// The value in the report.
    pub report: String,
    /// The value in this program.
    pub ours: String,
}

impl Comparison {
    /// Creates a number of the report beside ours.
    pub fn new(what: impl Into<String>, report: impl Into<String>, ours: impl Into<String>) -> Self {
        Self { what: what.into(), report: report.into(), ours: ours.into() }
    }
}

/// Coarse cells along a side of the document for Figure 2, N_e.
const CELLS: u32 = 4;

impl ReportFigure {
    /// All of them, in the order of the report.
    pub const ALL: [Self; 7] = [
        Self::Mesh,
        Self::CoarseGrid,
        Self::Descendants,
        Self::Neighbours,
        Self::Times,
        Self::Orientation,
        Self::Experiment,
    ];

    /// Returns the name for menus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh => "Figure 1: a mesh",
            Self::CoarseGrid => "Figure 2: the coarse triangulation",
            Self::Descendants => "Figure 3: the halves of a triangle",
            Self::Neighbours => "Figure 4: neighbours of a bisected pair",
            Self::Times => "Figure 5: running times",
            Self::Orientation => "Figure 6: the orientation test",
            Self::Experiment => "Section 5.4: the experiment",
        }
    }

    /// Describes the figure in the report and its counterpart here.
    pub fn text(self) -> &'static str {
        match self {
            Self::Mesh => {
                "The report shows a mesh of the method: h̄ is small where |x| + |y| < 0.4, and large elsewhere. Here the square is \
                 twenty times as large, so that every coordinate is exact."
            }
            Self::CoarseGrid => {
                "The report shows a coarse triangulation with the indices of its nodes and triangles, and the grid spacing δ. The \
                 canvas numbers them in the same way."
            }
            Self::Descendants => {
                "The report shows the halves of a triangle with k = 1 and O = 0, and their vertices. The step on the canvas bisects \
                 such a triangle; a, b, c are its vertices, and d is the new node."
            }
            Self::Neighbours => {
                "The report shows the neighbours of two triangles before and after they are bisected together, for k = 1, O = 0 \
                 and O = 0. The meshes of this coarse grid have no such pair; the one on the canvas has 2, 1 and 1, which the \
                 same Algorithm 9 treats. Before it, t_i has the neighbours i_b, a, b, and t_i_b has i, c, d."
            }
            Self::Times => {
                "The report shows the running time over the number of triangles, both in proportion to the mesh of 9,560 \
                 triangles, and a line of best fit on logarithmic axes: its gradient is the exponent of a power law. This is \
                 measured on this machine now: on one thread, several runs in turn, the error bars from the least to the greatest."
            }
            Self::Orientation => {
                "The report shows the test whether a point d lies to the right of an edge (a, b): whether (d − b) × (a − b) is above \
                 0. Point location steps across such an edge until there is none. The canvas shows this walk from the square to the \
                 queried point, which is d, and the corners of its triangle; query others."
            }
            Self::Experiment => {
                "The report makes the mesh of Figure 1 for several sizes of h̄, with 9,560 to 2,113,944 triangles in up to 13 \
                 levels, and measures the time. The same meshes are made here."
            }
        }
    }

    /// Returns the document that shows it.
    pub fn document(self) -> Document {
        let settings = match self {
            Self::CoarseGrid => small("1", 1.0 / f64::from(CELLS), self),
            Self::Descendants => small("if(hypot(x - 0.5, y - 0.5) < 0.2, 0.15, 1)", 0.5, self),
            Self::Neighbours => Settings {
                rule: RefinementRule::Area,
                ..small("if(hypot(x - 0.5, y - 0.5) < 0.1, 0.4, 1)", 1.0 / 3.0, self)
            },
            Self::Mesh | Self::Times | Self::Orientation | Self::Experiment => {
                let diamond = Example::Diamond.without_data();
                Settings { name: self.name().into(), ..diamond.settings().clone() }
            }
        };
        Document::new(settings, None).expect("the documents of the figures are valid: a test opens each")
    }

    /// Returns whether it is shown as a step of the refinement.
    pub fn is_step(self) -> bool {
        matches!(self, Self::CoarseGrid | Self::Descendants | Self::Neighbours)
    }

    /// Returns whether it is about running times.
    pub fn is_about_time(self) -> bool {
        matches!(self, Self::Times | Self::Experiment)
    }

    /// Returns whether a step is the one that the figure shows. Figure 2 shows what is before all steps.
    pub fn shows(self, step: &RecordedStep) -> bool {
        match self {
            Self::Descendants => (step.k, step.orientation) == (1, 0) && step.action == StepAction::Bisect,
            Self::Neighbours => step.action == StepAction::UpdateNeighbours(NeighbourCase::Pair1),
            _ => false,
        }
    }

    /// Returns the point that is queried, in world units.
    pub fn query(self) -> Option<DVec2> {
        (self == Self::Orientation).then_some(dvec2(6.3, 0.88))
    }

    /// Returns the area that shows what the figure is about, in world units; `None` if that is the whole
    /// domain.
    pub fn area(self) -> Option<Rect> {
        match self {
            // The pair that is bisected, with room around it for the letters.
            Self::Descendants => Some(Rect::around(dvec2(0.625, 0.5), 0.3)),
            // The walk to the queried point, from where point location begins.
            Self::Orientation => Some(Rect::new(dvec2(5.9, -0.1), dvec2(7.1, 1.15))),
            _ => None,
        }
    }

    /// Returns the report's numbers beside those of the mesh, and of the walk to a queried point.
    pub fn compare_mesh(self, mesh: &Mesh, queried: Option<DVec2>) -> Vec<Comparison> {
        match self {
            Self::Mesh => {
                let side = mesh.lattice().bounds().size().x;
                let spacing = significant(mesh.lattice().spacing() / side, 2);
                vec![
                    Comparison::new("Triangles", "9,560", Grouped(mesh.triangle_count()).to_string()),
                    Comparison::new("δ, for a side of 1", "0.050", spacing),
                ]
            }
            Self::Orientation => queried.map_or_else(Vec::new, |point| walk(mesh, point)),
            _ => Vec::new(),
        }
    }

    /// Adds the letters by which the text of the figure names nodes and triangles of the step that is shown.
    pub fn add_letters(self, player: &StepPlayer, names: &mut Names) {
        let Some(step) = player.step().filter(|step| self.shows(step)) else { return };
        let before = |number: u32| {
            player.changes().iter().find(|change| change.number == number).and_then(|change| change.before)
        };
        match (self, before(step.triangle), step.across.and_then(before)) {
            (Self::Descendants, Some([a, b, c, ..]), _) => {
                for (node, letter) in [(a, "a"), (b, "b"), (c, "c")] {
                    names.add(NamedPlace::Node(node as u32), letter);
                }
                step.new_node.into_iter().for_each(|node| names.add(NamedPlace::Node(node), "d"));
            }
            (Self::Neighbours, Some(of_i), Some(of_b)) => {
                for (triangle, letter) in [(of_i[4], "a"), (of_i[5], "b"), (of_b[4], "c"), (of_b[5], "d")] {
                    let number = u32::try_from(triangle);
                    number.into_iter().for_each(|number| names.add(NamedPlace::Triangle(number), letter));
                }
            }
            _ => {}
        }
    }

    /// Returns the report's numbers beside those of the step that is shown; nothing if the figure shows
    /// another one.
    pub fn compare_step(self, player: &StepPlayer) -> Vec<Comparison> {
        let count = |count: usize| Grouped(count).to_string();
        match (self, player.step()) {
            (Self::CoarseGrid, None) => {
                let [nodes, triangles] = [(CELLS + 1).pow(2), 2 * CELLS.pow(2)];
                let stated = |rule: &str, number: u32| format!("{rule} = {number}");
                vec![
                    Comparison::new("N_e", "⌈1 / δ⌉", CELLS.to_string()),
                    Comparison::new("Nodes", stated("(N_e + 1)²", nodes), count(player.nodes().len())),
                    Comparison::new("Triangles", stated("2 N_e²", triangles), count(player.rows().len())),
                ]
            }
            (Self::Descendants, Some(step)) if self.shows(step) => descendants(player, step),
            (Self::Neighbours, Some(step)) if self.shows(step) => neighbours(player, step),
            _ => Vec::new(),
        }
    }
}

/// Returns a unit square with few triangles, by the vertex rule.
fn small(target: &str, spacing: f64, figure: ReportFigure) -> Settings {
    let domain = Domain::rectangle(Rect::UNIT);
    Settings {
        spacing,
        boundary: BoundaryTreatment::default_for(spacing),
        transfer: Transfer::between(0.01, 1.0),
        layers: Layer::default_stack(LayerKind::target(Formula::parse(target).expect("a valid formula"))),
        rule: RefinementRule::Vertex,
        boundary_marks: Arc::default(),
        ..Settings::for_domain(figure.name().into(), domain)
    }
}

/// Returns the walk of point location (Algorithm 15): its length, and the test for each edge of its last
/// triangle.
fn walk(mesh: &Mesh, point: DVec2) -> Vec<Comparison> {
    let path = mesh.walk_path(point);
    let Some(&last) = path.last() else { return Vec::new() };
    let deepest = mesh.level_counts().len().saturating_sub(1);
    let bound = 1_usize.checked_shl(deepest as u32).unwrap_or(usize::MAX);
    let report = format!("at most 2^{deepest} = {}", Grouped(bound));
    let mut rows = vec![Comparison::new("Steps of the walk", report, Grouped(path.len() - 1).to_string())];
    for (number, (b, a)) in mesh.triangle(last).edge_nodes().into_iter().enumerate() {
        let (a, b) = (mesh.world(a), mesh.world(b));
        let product = (point - b).perp_dot(a - b);
        let what = format!("Product at edge {}", number + 1);
        rows.push(Comparison::new(what, "not above 0", significant(product, 2)));
    }
    rows
}

/// Eqs. (17) and (18): vertices and orientations of the halves.
fn descendants(player: &StepPlayer, step: &RecordedStep) -> Vec<Comparison> {
    let changes = player.changes();
    let kept = changes.iter().find(|change| change.number == step.triangle);
    let (Some(kept), Some(d)) = (kept, step.new_node) else { return Vec::new() };
    let Some(before) = kept.before else { return Vec::new() };
    let [a, b, c, ..] = before;
    let d = d as i32;
    let Some(new) = changes.iter().find(|change| change.before.is_none() && change.after[0] == b) else {
        return Vec::new();
    };
    let vertices = |row: &ReportRow| triple([row[0], row[1], row[2]]);
    let stated = |letters: &str, numbers: [i32; 3]| format!("{letters} = {}", triple(numbers));
    vec![
        Comparison::new("V(t_i) before", "(a, b, c)", triple([a, b, c])),
        Comparison::new("V(t_i)", stated("(a, d, c)", [a, d, c]), vertices(&kept.after)),
        Comparison::new("V(t_i\u{304})", stated("(b, d, c)", [b, d, c]), vertices(&new.after)),
        Comparison::new("O(t_i), O(t_i\u{304})", "0, 1", format!("{}, {}", kept.after[6], new.after[6])),
    ]
}

/// Figure 4 and Algorithm 9: neighbours before and after.
fn neighbours(player: &StepPlayer, step: &RecordedStep) -> Vec<Comparison> {
    let Some(across) = step.across else { return Vec::new() };
    let before = |number: u32| {
        let change = player.changes().iter().find(|change| change.number == number)?;
        change.before.map(|row| [row[3], row[4], row[5]])
    };
    let (Some([_, a, b]), Some([_, c, d])) = (before(step.triangle), before(across)) else {
        return Vec::new();
    };
    let last = player.rows().len() as u32;
    let (new, new_across) = (last - 1, last);
    let number = |number: u32| number as i32;
    let [i, i_b, i_new, b_new] = [step.triangle, across, new, new_across].map(number);
    let after = |number: u32| {
        let row = player.rows()[number as usize - 1];
        triple([row[3], row[4], row[5]])
    };
    let row = |what: &str, of: u32, letters: &str, numbers: [i32; 3]| {
        Comparison::new(what, format!("{letters} = {}", triple(numbers)), after(of))
    };
    vec![
        row("N(t_i)", step.triangle, "(a, i\u{304}, i\u{304}_b)", [a, i_new, b_new]),
        row("N(t_i_b)", across, "(c, i\u{304}_b, i\u{304})", [c, b_new, i_new]),
        row("N(t_i\u{304})", new, "(b, i_b, i)", [b, i_b, i]),
        row("N(t_i\u{304}_b)", new_across, "(d, i, i_b)", [d, i, i_b]),
    ]
}

fn triple([a, b, c]: [i32; 3]) -> String {
    let number = |number: i32| fixed(f64::from(number), 0);
    format!("({}, {}, {})", number(a), number(b), number(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuiltMesh, MeshBuilder};
    use crate::mesh::Progress;
    use crate::steps::StepRecorder;

    fn built(figure: ReportFigure) -> BuiltMesh {
        let mut builder = MeshBuilder::new(figure.document().settings().mesh_spec().unwrap());
        while builder.advance(None, 1 << 16).unwrap() == Progress::More {}
        builder.finish()
    }

    /// Returns the steps of the document of a figure, before the first one.
    fn player(figure: ReportFigure) -> StepPlayer {
        let built = built(figure);
        let limits = figure.document().settings().limits();
        let coarse = Mesh::coarse_grid(built.mesh.lattice(), |_| true, &limits).unwrap();
        let mut recorder = StepRecorder::new(coarse, limits, 10_000);
        let mut criterion = built.criterion(None);
        while recorder.advance(|element| criterion.exceeds(element), 1000).unwrap() == Progress::More {}
        StepPlayer::new(Arc::new(recorder.finish()))
    }

    /// The part of the report's column after the letters is ours.
    fn assert_equal(rows: &[Comparison], count: usize) {
        assert_eq!(rows.len(), count, "{rows:?}");
        for row in rows.iter().filter(|row| row.report.contains(" = ")) {
            assert_eq!(row.report.rsplit(" = ").next(), Some(row.ours.as_str()), "{row:?}");
        }
    }

    #[test]
    fn figure_1_has_the_triangles_of_the_report() {
        let rows = ReportFigure::Mesh.compare_mesh(&built(ReportFigure::Mesh).mesh, None);
        assert!(rows.iter().all(|row| row.report == row.ours), "{rows:?}");
        assert_eq!(rows[0].ours, "9,560");
    }

    #[test]
    fn figure_2_is_the_coarse_triangulation_before_the_first_step() {
        let mut player = player(ReportFigure::CoarseGrid);
        assert_equal(&ReportFigure::CoarseGrid.compare_step(&player), 3);
        player.go_to(1);
        assert!(ReportFigure::CoarseGrid.compare_step(&player).is_empty());
    }

    #[test]
    fn figures_3_and_4_have_their_cases_with_the_numbers_of_the_report() {
        for (figure, count) in [(ReportFigure::Descendants, 4), (ReportFigure::Neighbours, 4)] {
            let mut player = player(figure);
            let steps = player.recording().steps().to_vec();
            let shown: Vec<usize> = (0..steps.len()).filter(|&at| figure.shows(&steps[at])).collect();
            assert!(!shown.is_empty(), "{figure:?}");
            for at in shown {
                player.go_to(at + 1);
                let rows = figure.compare_step(&player);
                assert_equal(&rows, count);
                let equal = |row: &Comparison| row.report == row.ours || row.report.contains('(');
                assert!(rows.iter().all(equal), "{rows:?}");
                let mut names = Names::default();
                figure.add_letters(&player, &mut names);
                let labels: Vec<String> = names.labels().map(|(_, label)| label).collect();
                let has =
                    |letter: &&str| labels.iter().any(|label| label.starts_with(&format!("{letter} = ")));
                assert!(["a", "b", "c", "d"].iter().all(has), "{labels:?}");
            }
            player.go_to(0);
            assert!(figure.compare_step(&player).is_empty());
        }
    }

    #[test]
    fn the_meshes_of_the_coarse_grid_have_no_pair_as_in_figure_4() {
        // Each pair of a level is bisected in the uniform mesh of the next one.
        let settings = small("0.03", 0.5, ReportFigure::Neighbours);
        let limits = settings.limits();
        let lattice = settings.mesh_spec().unwrap().lattice;
        let coarse = Mesh::coarse_grid(&lattice, |_| true, &limits).unwrap();
        let mut recorder = StepRecorder::new(coarse, limits, 20_000);
        while recorder.advance(|element| element.triangle.level() < 9, 1000).unwrap() == Progress::More {}
        let recording = recorder.finish();
        let pairs = |wanted: [u8; 3]| {
            let case = |step: &&RecordedStep| {
                step.action == StepAction::Bisect
                    && step.orientation_across.map(|across| [step.k, step.orientation, across])
                        == Some(wanted)
            };
            recording.steps().iter().filter(case).count()
        };
        assert!(pairs([2, 1, 1]) > 0 && pairs([1, 0, 1]) > 0 && pairs([1, 1, 0]) > 0);
        assert_eq!(pairs([1, 0, 0]), 0);
        assert_eq!(recording.steps().iter().map(|step| step.level).max(), Some(9));
    }

    #[test]
    fn figure_6_walks_and_ends_where_no_edge_has_the_point_to_the_right() {
        let mesh = built(ReportFigure::Orientation).mesh;
        let point = ReportFigure::Orientation.query();
        let rows = ReportFigure::Orientation.compare_mesh(&mesh, point);
        assert_eq!(rows.len(), 4);
        let steps: usize = rows[0].ours.parse().unwrap();
        assert!((5..=32).contains(&steps), "{rows:?}");
        assert_eq!(rows[0].report, "at most 2^5 = 32");
        assert!(rows[1..].iter().all(|row| row.ours.starts_with('−')), "{rows:?}");
        let area = ReportFigure::Orientation.area().unwrap();
        let corners = mesh.walk_path(point.unwrap()).into_iter().flat_map(|id| mesh.view().world_corners(id));
        assert!(corners.into_iter().all(|corner| area.contains(corner)), "the walk is in view");
        assert!(area.size().max_element() < 6.0 * 0.25, "its triangles are large enough for numbers");
        // From another triangle the point is to the right of an edge.
        let first = mesh.walk_path(point.unwrap())[0];
        let products = mesh.triangle(first).edge_nodes().map(|(b, a)| {
            let (a, b) = (mesh.world(a), mesh.world(b));
            (point.unwrap() - b).perp_dot(a - b)
        });
        assert!(products.iter().any(|product| *product > 0.0), "{products:?}");
    }

    #[test]
    fn every_figure_has_a_name_a_text_and_a_document() {
        for figure in ReportFigure::ALL {
            assert!(figure.text().ends_with('.') && !figure.name().is_empty());
            assert_eq!(figure.document().settings().name, figure.name());
        }
    }
}
