//! A step of the refinement as a drawing: the mesh with the numbers of triangles and nodes, the stack, and
//! what the step does.

use std::path::{Path, PathBuf};

use super::{LabelRoom, LabelSize, MOST_AVOIDED, Marked, NamedPlace, Names, StepPart, StepPlayer, placed};
use crate::drawing::{Drawing, DrawingGroup, Letters, TextStyle, Weight, opaque, wrapped};
use crate::geometry::LatticePoint;

/// Width of the drawing, the greatest height of the mesh, and the margin around it, in pixels.
const WIDTH: f64 = 1200.0;
const MOST_HEIGHT: f64 = 1600.0;
const MARGIN: f64 = 30.0;
/// Height of a line of the caption.
const LINE: f64 = 30.0;
/// Size of the letters of a caption, and the minimum and the maximum size of a number.
const LETTERS: f64 = 20.0;
const NUMBERS: [f64; 2] = [6.0, 20.0];
/// Size of the letters of a name.
const NAME: f64 = 16.0;
/// Opacity of edges, and of the colour over a triangle of the step.
const EDGE: u8 = 0x80;
const PART: u8 = 0x40;
/// What separates bright letters and lines from the colour of any level, on either ground.
const HALO: [u8; 3] = [0; 3];
const WHITE: [u8; 3] = [0xff; 3];

/// Colours of the drawing.
#[derive(Clone, Copy, Debug)]
pub struct StepColors<'a> {
    /// Red, green, blue and opacity by level.
    pub levels: &'a [[u8; 4]; 64],
    /// Behind the mesh.
    pub background: [u8; 3],
    /// Letters of the caption.
    pub text: [u8; 3],
    /// Numbers of nodes and of triangles that the step is not about, and their halo.
    pub numbers: [[u8; 3]; 2],
    /// Triangles on the stack, those with new neighbours or removed, and the bisection neighbour.
    pub parts: [[u8; 3]; 3],
}

/// Returns the file of a step beside `path`: `name-0042.svg`, with as many digits as `last` has, at least
/// four, and the ending of `path`.
pub fn numbered(path: &Path, position: usize, last: usize) -> PathBuf {
    let digits = last.to_string().len().max(4);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().unwrap_or_else(|| "svg".as_ref()).to_string_lossy();
    path.with_file_name(format!("{stem}-{position:0digits$}.{ending}"))
}

/// Returns a drawing of the step that is shown, with the letters `names` of triangles and nodes.
pub fn drawing(
    player: &StepPlayer,
    names: &Names,
    letters: &dyn Letters,
    colors: &StepColors<'_>,
) -> Drawing {
    let page = StepPage::of(player);
    let marked = player.marked();
    let caption = caption(player);
    let title = caption[0].clone();
    let caption = caption_lines(&caption, letters, colors);
    let height = page.height + LINE * (caption.len() as f64 + 0.5);
    let labels = Labels::new(player, names, &page, &marked, colors, letters);
    let mut groups = vec![
        triangles(player, &page, colors),
        parts(&marked, &page, colors),
        moves(player, &page),
        labels.dots(),
        labels.leaders(),
    ];
    groups.extend(labels.texts(letters));
    groups.push(caption_group(&caption, page.height, letters, colors));
    Drawing { size: [WIDTH, height], title, ground: colors.background, groups }
}

/// Which step, what it does, its algorithm, and the stack.
fn caption(player: &StepPlayer) -> Vec<String> {
    let stack = player.stack_in_words();
    let place = format!("Step {} of {}", player.position(), player.len());
    let Some(step) = player.step() else {
        return vec![format!("{place}: the coarse grid"), format!("S_b: {stack}")];
    };
    let (algorithm, lines) = step.lines();
    let lines = if lines.len() == 1 {
        format!("line {}", lines.start)
    } else {
        format!("lines {} to {}", lines.start, lines.end - 1)
    };
    let mut text = vec![
        format!("{place}: {}", step.sentence()),
        format!("{}: {}, {lines}", algorithm.title(), algorithm.name()),
    ];
    if step.triangle > 0 {
        let (i, level, k, o) = (step.triangle, step.level, step.k, step.orientation);
        text.push(format!("i = {i}, L = {level}, k = {k}, O = {o}; S_b: {stack}"));
    }
    text
}

fn caption_style(colors: &StepColors<'_>) -> TextStyle {
    TextStyle { size: LETTERS, weight: Weight::Regular, color: colors.text, halo: None }
}

fn caption_lines(caption: &[String], letters: &dyn Letters, colors: &StepColors<'_>) -> Vec<String> {
    let style = caption_style(colors);
    caption.iter().flat_map(|text| wrapped(letters, text, WIDTH - 2.0 * MARGIN, &style)).collect()
}

fn caption_group(lines: &[String], top: f64, letters: &dyn Letters, colors: &StepColors<'_>) -> DrawingGroup {
    let mut group = DrawingGroup::new("caption");
    for (row, text) in lines.iter().enumerate() {
        let at = [MARGIN, top + LINE * (row as f64 + 0.5)];
        group.text(letters, text, at, &caption_style(colors));
    }
    group
}

fn triangles(player: &StepPlayer, page: &StepPage, colors: &StepColors<'_>) -> DrawingGroup {
    let mut group = DrawingGroup::new("triangles");
    for triangle in player.triangles() {
        let [r, g, b, _] = colors.levels[usize::from(triangle.level).min(63)];
        let corners = page.corners(triangle.corners(player.nodes()));
        group.polygon(&corners, Some([r, g, b, 0xff]), Some(([0, 0, 0, EDGE], 1.0)));
    }
    group
}

fn parts(marked: &[Marked], page: &StepPage, colors: &StepColors<'_>) -> DrawingGroup {
    let mut group = DrawingGroup::new("parts");
    for Marked { corners, part, .. } in marked {
        let (corners, [r, g, b]) = (page.corners(*corners), part_color(*part, colors));
        // Lines that cover small triangles would hide what they show.
        let width = (0.06 * shortest_edge(&corners)).clamp(0.4, 2.5);
        group.polygon(&corners, Some([r, g, b, PART]), Some((opaque(HALO), 2.0 * width)));
        group.polygon(&corners, None, Some(([r, g, b, 0xff], width)));
    }
    group
}

/// A line from the former place of each node that moved to the present one.
fn moves(player: &StepPlayer, page: &StepPage) -> DrawingGroup {
    let mut group = DrawingGroup::new("moves");
    for [from, to] in player.moves() {
        let [from, to] = [page.place(from), page.place(to)];
        group.line(&[from, to], opaque(WHITE), 1.5);
        group.disc(to, 2.0, opaque(WHITE), (opaque(HALO), 0.8));
    }
    group
}

/// A name or a number.
struct Label {
    /// The group of the drawing.
    group: &'static str,
    text: String,
    style: TextStyle,
    /// The radius of the dot of a node.
    dot: Option<f64>,
    size: LabelSize,
    /// The place of its middle, where there is room for it.
    middle: Option<[f64; 2]>,
}

/// The names and numbers of a drawing: what matters most comes first.
struct Labels(Vec<Label>);

impl Labels {
    fn new(
        player: &StepPlayer,
        names: &Names,
        page: &StepPage,
        marked: &[Marked],
        colors: &StepColors<'_>,
        letters: &dyn Letters,
    ) -> Self {
        let named: Vec<NamedPlace> = names.labels().map(|(place, _)| place).collect();
        let mut labels = name_labels(player, names, page, marked, colors, letters);
        let mut numbers = triangle_labels(player, &named, page, marked, colors, letters);
        numbers.extend(node_labels(player, &named, page, colors, letters));
        // Those of the step before the others.
        numbers.sort_by_key(|(is_of_step, _)| !is_of_step);
        labels.extend(numbers.into_iter().map(|(_, label)| label));
        let sizes: Vec<LabelSize> = labels.iter().map(|label| label.size).collect();
        let is_about = |one: &&Marked| !matches!(one.part, StepPart::Waiting | StepPart::Removed);
        let avoided: Vec<_> = marked
            .iter()
            .rev()
            .filter(is_about)
            .take(MOST_AVOIDED)
            .map(|one| page.corners(one.corners))
            .collect();
        let area = [[0.0; 2], [WIDTH, page.height]];
        let middles = placed(&sizes, &LabelRoom { area, obstacles: &[], avoided: &avoided });
        labels.iter_mut().zip(middles).for_each(|(label, middle)| label.middle = middle);
        Self(labels)
    }

    fn drawn(&self) -> impl Iterator<Item = (&Label, [f64; 2])> {
        self.0.iter().filter_map(|label| Some((label, label.middle?)))
    }

    fn dots(&self) -> DrawingGroup {
        let mut group = DrawingGroup::new("dots");
        for (label, _) in self.drawn() {
            if let Some(radius) = label.dot {
                group.disc(label.size.at, radius, opaque(WHITE), (opaque(HALO), 1.0));
            }
        }
        group
    }

    fn leaders(&self) -> DrawingGroup {
        let mut group = DrawingGroup::new("leaders");
        for (label, middle) in self.drawn() {
            if let Some(end) = label.size.leader(middle) {
                for (color, width) in [(HALO, 3.0), (label.style.color, 1.2)] {
                    group.line(&[label.size.at, end], opaque(color), width);
                }
                group.disc(label.size.at, 2.5, opaque(label.style.color), (opaque(HALO), 1.0));
            }
        }
        group
    }

    fn texts(&self, letters: &dyn Letters) -> [DrawingGroup; 3] {
        ["nodes", "numbers", "names"].map(|name| {
            let mut group = DrawingGroup::new(name);
            for (label, middle) in self.drawn().filter(|(label, _)| label.group == name) {
                group.centered(letters, &label.text, middle, &label.style);
            }
            group
        })
    }
}

fn label_style(size: f64, color: [u8; 3]) -> TextStyle {
    TextStyle { size, weight: Weight::SemiBold, color, halo: Some(HALO) }
}

fn number_style(size: f64, colors: &StepColors<'_>) -> TextStyle {
    let [color, halo] = colors.numbers;
    TextStyle { size, weight: Weight::SemiBold, color, halo: Some(halo) }
}

/// The letters of the step with the numbers of what they stand for, beside it where it is too small.
fn name_labels(
    player: &StepPlayer,
    names: &Names,
    page: &StepPage,
    marked: &[Marked],
    colors: &StepColors<'_>,
    letters: &dyn Letters,
) -> Vec<Label> {
    let label = |(place, text): (NamedPlace, String)| {
        let corners: Vec<_> = player.points_of(place).into_iter().map(|point| page.place(point)).collect();
        let part = marked.iter().find(|one| NamedPlace::Triangle(one.number) == place);
        let style = label_style(NAME, part.map_or(WHITE, |one| part_color(one.part, colors)));
        let size = LabelSize::of(&corners, style.room(letters, &text));
        let dot = (corners.len() == 1).then_some(3.5);
        Label { group: "names", text, style, dot, size, middle: None }
    };
    names.labels().map(label).collect()
}

/// Numbers of triangles, and whether the step is about them.
fn triangle_labels(
    player: &StepPlayer,
    named: &[NamedPlace],
    page: &StepPage,
    marked: &[Marked],
    colors: &StepColors<'_>,
    letters: &dyn Letters,
) -> Vec<(bool, Label)> {
    let label = |triangle: super::StepTriangle| {
        let number = triangle.number;
        let corners = page.corners(triangle.corners(player.nodes()));
        let size = (0.22 * shortest_edge(&corners)).min(NUMBERS[1]);
        if size < NUMBERS[0] || named.contains(&NamedPlace::Triangle(number)) {
            return None;
        }
        let part = marked.iter().find(|one| one.number == number).map(|one| one.part);
        let style = match part {
            Some(part) => label_style(size, part_color(part, colors)),
            None => number_style(size, colors),
        };
        let text = number.to_string();
        let size = LabelSize::fixed(middle(&corners), style.room(letters, &text));
        Some((part.is_some(), Label { group: "numbers", text, style, dot: None, size, middle: None }))
    };
    player.triangles().filter_map(label).collect()
}

/// Numbers of nodes, and whether the step is about a triangle there.
fn node_labels(
    player: &StepPlayer,
    named: &[NamedPlace],
    page: &StepPage,
    colors: &StepColors<'_>,
    letters: &dyn Letters,
) -> Vec<(bool, Label)> {
    let mut rooms = vec![f64::INFINITY; player.nodes().len()];
    for triangle in player.triangles() {
        let room = shortest_edge(&page.corners(triangle.corners(player.nodes())));
        for node in triangle.nodes {
            let known = &mut rooms[node as usize - 1];
            *known = known.min(room);
        }
    }
    let label = |(index, (node, room)): (usize, (&LatticePoint, f64))| {
        let number = index as u32 + 1;
        let size = (0.16 * room).min(NUMBERS[1]);
        if size < NUMBERS[0] || room.is_infinite() || named.contains(&NamedPlace::Node(number)) {
            return None;
        }
        let (style, text) = (number_style(size, colors), number.to_string());
        let place = LabelSize::beside(page.place(*node), style.room(letters, &text));
        let dot = Some(0.2 * size);
        Some((false, Label { group: "nodes", text, style, dot, size: place, middle: None }))
    };
    player.nodes().iter().zip(rooms).enumerate().filter_map(label).collect()
}

/// Returns the mean of some points.
fn middle(points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64)
}

fn part_color(part: StepPart, colors: &StepColors<'_>) -> [u8; 3] {
    match part {
        StepPart::Waiting => colors.parts[0],
        StepPart::Relinked | StepPart::Removed => colors.parts[1],
        StepPart::Across => colors.parts[2],
        StepPart::Current => [0xff; 3],
    }
}

fn shortest_edge(corners: &[[f64; 2]; 3]) -> f64 {
    let length = |i: usize, j: usize| {
        let [dx, dy] = [0, 1].map(|axis| corners[i][axis] - corners[j][axis]);
        (dx * dx + dy * dy).sqrt()
    };
    length(0, 1).min(length(1, 2)).min(length(2, 0))
}

/// The position of the lattice on the page.
struct StepPage {
    scale: [f64; 2],
    left: f64,
    /// Of the mesh with the margins above and below it.
    height: f64,
}

impl StepPage {
    fn of(player: &StepPlayer) -> Self {
        let lattice = &player.recording().lattice;
        let (size, extent) = (lattice.bounds().size(), lattice.extent());
        let most = WIDTH - 2.0 * MARGIN;
        let scale = (most / size.x).min(MOST_HEIGHT / size.y);
        let [width, height] = [scale * size.x, scale * size.y];
        let scale = [width / f64::from(extent.x), height / f64::from(extent.y)];
        Self { scale, left: 0.5 * (WIDTH - width), height: height + 2.0 * MARGIN }
    }

    fn place(&self, node: LatticePoint) -> [f64; 2] {
        let [x, y] = [self.scale[0] * f64::from(node.x), self.scale[1] * f64::from(node.y)];
        [self.left + x, self.height - MARGIN - y]
    }

    fn corners(&self, corners: [LatticePoint; 3]) -> [[f64; 2]; 3] {
        corners.map(|corner| self.place(corner))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::drawing::{BoxLetters, DrawnShape, OutlinePart};
    use crate::steps::StepRecorder;
    use meshbrush_mesh::geometry::{Lattice, Rect};
    use meshbrush_mesh::mesh::{Limits, Mesh, Progress};

    fn player() -> StepPlayer {
        let bounds = Rect::new(glam::dvec2(0.0, 0.0), glam::dvec2(2.0, 1.0));
        let lattice = Lattice::covering(bounds, 0.5, 1000).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let mut recorder = StepRecorder::new(mesh, Limits::default(), 1000);
        let corner = |element: &meshbrush_mesh::mesh::Element<'_>| {
            element.triangle.level() < 6 && element.corners.iter().any(|c| c.x == 0 && c.y == 0)
        };
        while recorder.advance(corner, 100).unwrap() == Progress::More {}
        StepPlayer::new(Arc::new(recorder.finish()))
    }

    fn drawn(player: &StepPlayer) -> Drawing {
        let colors = StepColors {
            levels: &[[9, 9, 9, 255]; 64],
            background: [0; 3],
            text: [0xff; 3],
            numbers: [[0xdd; 3], [0; 3]],
            parts: [[1, 1, 1], [2, 2, 2], [3, 3, 3]],
        };
        drawing(player, &player.names(), &BoxLetters, &colors)
    }

    fn group<'a>(drawing: &'a Drawing, name: &str) -> &'a DrawingGroup {
        drawing.groups.iter().find(|group| group.name == name).unwrap()
    }

    fn texts(group: &DrawingGroup) -> Vec<&str> {
        group.texts.iter().map(|(text, _)| text.as_str()).collect()
    }

    /// Returns the points of a shape without curves.
    fn points(shape: &DrawnShape) -> Vec<[f64; 2]> {
        let point = |part: &OutlinePart| match *part {
            OutlinePart::Move(at) | OutlinePart::Line(at) => Some(at),
            _ => None,
        };
        shape.parts.iter().filter_map(point).collect()
    }

    #[test]
    fn a_drawing_has_every_triangle_within_the_page_and_the_numbers() {
        let mut player = player();
        for position in [0, 5, player.len() / 2, player.len()] {
            player.go_to(position);
            let drawing = drawn(&player);
            let triangles = group(&drawing, "triangles");
            assert_eq!(triangles.shapes.len(), player.rows().len());
            // The area of all triangles is that of the page within its margins: 1140 by 570 pixels.
            let area: f64 = triangles.shapes.iter().map(|shape| area_of(&points(shape))).sum();
            assert!((area / (1140.0 * 570.0) - 1.0).abs() < 0.01, "{area}");
            let (numbers, names) = (texts(group(&drawing, "numbers")), texts(group(&drawing, "names")));
            assert!(numbers.contains(&"1") || names.iter().any(|name| name.ends_with("= 1")));
            assert!(numbers.len() > 3 && group(&drawing, "nodes").texts.len() > 3);
            for (place, text) in player.names().labels() {
                assert!(names.contains(&text.as_str()), "{text} has room");
                let NamedPlace::Triangle(number) = place else { continue };
                assert!(!numbers.contains(&number.to_string().as_str()), "its name has its number");
            }
            let caption = texts(group(&drawing, "caption")).join(" ");
            assert!(caption.contains(&format!("Step {position} of {}", player.len())));
            if let Some(step) = player.step() {
                assert!(caption.contains(&step.sentence()), "{caption}");
            }
        }
    }

    #[test]
    fn no_text_covers_another_and_all_are_on_the_page() {
        let mut player = player();
        for position in 0..=player.len() {
            player.go_to(position);
            let drawing = drawn(&player);
            let mut boxes: Vec<(&str, [f64; 4])> = Vec::new();
            for group in &drawing.groups {
                for (text, shapes) in &group.texts {
                    let all = group.shapes[shapes.clone()].iter().flat_map(points);
                    let [left, top, right, bottom] = all.fold(
                        [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY],
                        |[l, t, r, b], [x, y]| [l.min(x), t.min(y), r.max(x), b.max(y)],
                    );
                    let is_on_page = left >= 0.0 && top >= 0.0 && right <= WIDTH && bottom <= drawing.size[1];
                    assert!(is_on_page, "{text} at step {position}");
                    for (other, [l, t, r, b]) in &boxes {
                        let covers = left < *r && *l < right && top < *b && *t < bottom;
                        assert!(!covers, "{text} and {other} at step {position}");
                    }
                    boxes.push((text, [left, top, right, bottom]));
                }
            }
            assert!(boxes.len() > 10);
        }
    }

    #[test]
    fn a_caption_has_the_line_of_a_step_or_the_lines() {
        let mut player = player();
        let mut seen = [0, 0];
        for position in 1..=player.len() {
            player.go_to(position);
            let lines = player.step().unwrap().lines().1;
            let text = match lines.len() {
                1 => format!(", line {}", lines.start),
                _ => format!(", lines {} to {}", lines.start, lines.end - 1),
            };
            assert!(caption(&player)[1].ends_with(&text), "{text}: {:?}", caption(&player));
            seen[usize::from(lines.len() > 1)] += 1;
        }
        assert!(seen.iter().all(|&count| count > 0), "{seen:?}");
    }

    fn area_of(corners: &[[f64; 2]]) -> f64 {
        for [x, y] in corners {
            assert!((29.9..=1170.1).contains(x) && (29.9..=600.1).contains(y), "{x}, {y}");
        }
        let [a, b, c] = corners[..] else { panic!("{corners:?}") };
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    }

    #[test]
    fn the_stack_and_the_pair_have_their_colours() {
        let mut player = player();
        let steps = player.recording().steps().to_vec();
        let waits = |position: &usize| {
            let mut player = player.clone();
            player.go_to(*position);
            !player.stack().is_empty() && player.step().is_some_and(|step| step.across.is_some())
        };
        let position = (1..=steps.len()).find(waits).expect("a triangle that waits");
        player.go_to(position);
        let drawing = drawn(&player);
        assert!(texts(group(&drawing, "caption")).join(" ").contains("S_b: "));
        let lines: Vec<[u8; 4]> =
            group(&drawing, "parts").shapes.iter().filter_map(|shape| Some(shape.line?.0)).collect();
        assert!(lines.contains(&[0xff; 4]), "the triangle of the step");
        assert!(lines.contains(&[3, 3, 3, 0xff]), "the bisection neighbour");
    }

    #[test]
    fn a_tall_domain_is_drawn_smaller_in_the_middle() {
        let bounds = Rect::new(glam::dvec2(0.0, 0.0), glam::dvec2(1.0, 8.0));
        let lattice = Lattice::covering(bounds, 1.0, 1000).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let recording = StepRecorder::new(mesh, Limits::default(), 1000).finish();
        let drawing = drawn(&StepPlayer::new(Arc::new(recording)));
        assert!(drawing.size[1] < 1800.0, "{:?}", drawing.size);
        let all: Vec<f64> =
            group(&drawing, "triangles").shapes.iter().flat_map(points).map(|[x, _]| x).collect();
        let (left, right) =
            all.iter().fold((WIDTH, 0.0_f64), |(left, right), x| (left.min(*x), right.max(*x)));
        assert!((right - left - 200.0).abs() < 0.5 && (left + right - WIDTH).abs() < 0.5, "{left} {right}");
    }

    #[test]
    fn the_shortest_edge_is_found_from_any_corner() {
        let corners = [[1.0, 1.0], [5.0, 1.0], [5.0, 4.0]];
        for first in 0..3 {
            let turned = [0, 1, 2].map(|n| corners[(first + n) % 3]);
            assert_eq!(shortest_edge(&turned), 3.0);
        }
    }

    #[test]
    fn files_are_numbered_in_the_order_of_the_steps() {
        let path = Path::new("folder/mesh.svg");
        assert_eq!(numbered(path, 42, 900), Path::new("folder/mesh-0042.svg"));
        assert_eq!(numbered(path, 7, 123_456), Path::new("folder/mesh-000007.svg"));
        assert_eq!(numbered(Path::new("mesh"), 7, 10), Path::new("mesh-0007.svg"));
        assert_eq!(numbered(Path::new("mesh.png"), 7, 10), Path::new("mesh-0007.png"));
    }
}
