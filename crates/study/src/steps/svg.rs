//! A step of the refinement as an SVG: the mesh with the numbers of triangles and nodes, the stack, and what
//! the step does.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::{LabelSize, Marked, NamedPlace, StepPart, StepPlayer, placed};
use crate::geometry::LatticePoint;

/// Width of the drawing, and its margin, in pixels.
const WIDTH: f64 = 1200.0;
const MARGIN: f64 = 30.0;
/// Height of a line of the caption.
const LINE: f64 = 30.0;
/// Size of the letters of a caption, and the minimum and the maximum size of a number.
const LETTERS: f64 = 20.0;
const NUMBERS: [f64; 2] = [6.0, 20.0];
/// Size of the letters of a name, and the mean width of one.
const NAME: f64 = 16.0;
const NAME_LETTER: f64 = 9.0;

/// Colours of the drawing.
#[derive(Clone, Copy, Debug)]
pub struct StepColors<'a> {
    /// Red, green, blue and opacity by level.
    pub levels: &'a [[u8; 4]; 64],
    /// Behind the mesh.
    pub background: [u8; 3],
    /// Letters of the caption.
    pub text: [u8; 3],
    /// Triangles on the stack, those with new neighbours or removed, and the bisection neighbour.
    pub parts: [[u8; 3]; 3],
}

/// Returns the file of a step beside `path`: `name-0042.svg`, with as many digits as `last` has, at least
/// four.
pub fn numbered(path: &Path, position: usize, last: usize) -> PathBuf {
    let digits = last.to_string().len().max(4);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-{position:0digits$}.svg"))
}

/// Writes the step that is shown.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, player: &StepPlayer, colors: &StepColors<'_>) -> io::Result<()> {
    let page = StepPage::of(player);
    let caption = caption(player);
    let height = page.height + MARGIN + LINE * (caption.len() as f64 + 0.5);
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" viewBox=\"0 0 {WIDTH} {height:.0}\" \
         font-family=\"sans-serif\" text-anchor=\"middle\" stroke-linejoin=\"round\">"
    )?;
    writeln!(out, "<title>{}</title>", caption[0])?;
    let background = Hex(colors.background);
    writeln!(out, "<rect width=\"{WIDTH}\" height=\"{height:.0}\" fill=\"{background}\"/>")?;
    write_triangles(out, player, &page, colors)?;
    let marked = player.marked();
    for Marked { corners, part, .. } in &marked {
        write_part(out, &page.corners(*corners), part_color(*part, colors))?;
    }
    write_moves(out, player, &page)?;
    write_nodes(out, player, &page)?;
    write_numbers(out, player, &page, &marked, colors)?;
    write_names(out, player, &page, &marked, colors)?;
    writeln!(out, "<g text-anchor=\"start\" font-size=\"{LETTERS}\" fill=\"{}\">", Hex(colors.text))?;
    for (row, text) in caption.iter().enumerate() {
        let y = page.height + MARGIN + LINE * row as f64;
        writeln!(out, "<text x=\"{MARGIN}\" y=\"{y:.0}\">{text}</text>")?;
    }
    writeln!(out, "</g>\n</svg>")
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

fn write_triangles(
    out: &mut impl Write,
    player: &StepPlayer,
    page: &StepPage,
    colors: &StepColors<'_>,
) -> io::Result<()> {
    writeln!(out, "<g id=\"triangles\" stroke=\"#000\" stroke-opacity=\"0.5\" stroke-width=\"1\">")?;
    for triangle in player.triangles() {
        let [r, g, b, _] = colors.levels[usize::from(triangle.level).min(63)];
        let points = Points(page.corners(triangle.corners(player.nodes())));
        writeln!(out, "<polygon points=\"{points}\" fill=\"{}\"/>", Hex([r, g, b]))?;
    }
    writeln!(out, "</g>")
}

fn write_part(out: &mut impl Write, corners: &[[f64; 2]; 3], color: [u8; 3]) -> io::Result<()> {
    let (points, color) = (Points(*corners), Hex(color));
    // Lines that cover small triangles would hide what they show.
    let width = (0.06 * shortest_edge(corners)).clamp(0.4, 2.5);
    let rim = 2.0 * width;
    writeln!(
        out,
        "<polygon points=\"{points}\" fill=\"{color}\" fill-opacity=\"0.25\" stroke=\"#000\" stroke-width=\"{rim:.1}\"/>\n\
         <polygon points=\"{points}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width:.1}\"/>"
    )
}

/// A line from the former place of each node that moved to the present one.
fn write_moves(out: &mut impl Write, player: &StepPlayer, page: &StepPage) -> io::Result<()> {
    writeln!(out, "<g id=\"moves\" stroke=\"#fff\" stroke-width=\"1.5\" fill=\"#fff\">")?;
    for [from, to] in player.moves() {
        let ([ax, ay], [bx, by]) = (page.place(from), page.place(to));
        writeln!(
            out,
            "<path d=\"M{ax:.1} {ay:.1}L{bx:.1} {by:.1}\"/><circle cx=\"{bx:.1}\" cy=\"{by:.1}\" r=\"2\" stroke=\"#000\" stroke-width=\"0.8\"/>"
        )?;
    }
    writeln!(out, "</g>")
}

fn write_nodes(out: &mut impl Write, player: &StepPlayer, page: &StepPage) -> io::Result<()> {
    let mut rooms = vec![f64::INFINITY; player.nodes().len()];
    for triangle in player.triangles() {
        let room = shortest_edge(&page.corners(triangle.corners(player.nodes())));
        for node in triangle.nodes {
            let known = &mut rooms[node as usize - 1];
            *known = known.min(room);
        }
    }
    // Their names have their numbers.
    for (place, _) in player.names().labels() {
        if let NamedPlace::Node(node) = place {
            rooms[node as usize - 1] = 0.0;
        }
    }
    writeln!(
        out,
        "<g id=\"nodes\" fill=\"#fff\" stroke=\"#000\" stroke-width=\"3\" paint-order=\"stroke\">"
    )?;
    for (index, (node, room)) in player.nodes().iter().zip(rooms).enumerate() {
        let size = (0.16 * room).min(NUMBERS[1]);
        if size < NUMBERS[0] || room.is_infinite() {
            continue;
        }
        let [x, y] = page.place(*node);
        writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.1}\" stroke-width=\"1\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"{size:.1}\">{}</text>",
            0.2 * size,
            x + 0.8 * size,
            y - 0.5 * size,
            index + 1
        )?;
    }
    writeln!(out, "</g>")
}

fn write_numbers(
    out: &mut impl Write,
    player: &StepPlayer,
    page: &StepPage,
    marked: &[Marked],
    colors: &StepColors<'_>,
) -> io::Result<()> {
    let named: Vec<NamedPlace> = player.names().labels().map(|(place, _)| place).collect();
    writeln!(
        out,
        "<g id=\"numbers\" stroke=\"#000\" stroke-width=\"3\" paint-order=\"stroke\" font-weight=\"bold\" \
         dominant-baseline=\"central\">"
    )?;
    for triangle in player.triangles() {
        let number = triangle.number;
        let corners = page.corners(triangle.corners(player.nodes()));
        let size = (0.22 * shortest_edge(&corners)).min(NUMBERS[1]);
        if size < NUMBERS[0] || named.contains(&NamedPlace::Triangle(number)) {
            continue;
        }
        let part = marked.iter().find(|one| one.number == number).map(|one| one.part);
        let color = Hex(part.map_or([0xdd; 3], |part| part_color(part, colors)));
        let [x, y] = middle(&corners);
        writeln!(
            out,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size:.1}\" fill=\"{color}\">{number}</text>"
        )?;
    }
    writeln!(out, "</g>")
}

/// The letters of the step with the numbers of what they stand for, beside it where it is too small.
fn write_names(
    out: &mut impl Write,
    player: &StepPlayer,
    page: &StepPage,
    marked: &[Marked],
    colors: &StepColors<'_>,
) -> io::Result<()> {
    let names: Vec<(NamedPlace, String)> = player.names().labels().collect();
    let corners: Vec<Vec<[f64; 2]>> = names
        .iter()
        .map(|(place, _)| player.points_of(*place).into_iter().map(|point| page.place(point)).collect())
        .collect();
    let label = |((_, text), corners): (&(NamedPlace, String), &Vec<[f64; 2]>)| {
        LabelSize::of(corners, [NAME_LETTER * text.chars().count() as f64, NAME])
    };
    let labels: Vec<LabelSize> = names.iter().zip(&corners).map(label).collect();
    let area = [[0.0; 2], [WIDTH, page.height]];
    writeln!(
        out,
        "<g id=\"names\" stroke=\"#000\" stroke-width=\"3\" paint-order=\"stroke\" font-weight=\"bold\" \
         font-size=\"{NAME}\" dominant-baseline=\"central\">"
    )?;
    for (((place, text), label), [x, y]) in names.iter().zip(&labels).zip(placed(&labels, area)) {
        let part = marked.iter().find(|one| NamedPlace::Triangle(one.number) == *place);
        let color = Hex(part.map_or([0xff; 3], |one| part_color(one.part, colors)));
        let [from_x, from_y] = label.at;
        if libm::hypot(x - from_x, y - from_y) > 0.5 * NAME {
            writeln!(
                out,
                "<path d=\"M{from_x:.1} {from_y:.1}L{x:.1} {y:.1}\" stroke=\"{color}\" stroke-width=\"1\"/>\
                 <circle cx=\"{from_x:.1}\" cy=\"{from_y:.1}\" r=\"3\" fill=\"{color}\" stroke-width=\"1\"/>"
            )?;
        }
        writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{color}\">{text}</text>")?;
    }
    writeln!(out, "</g>")
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
    height: f64,
}

impl StepPage {
    fn of(player: &StepPlayer) -> Self {
        let lattice = &player.recording().lattice;
        let size = lattice.bounds().size();
        let width = WIDTH - 2.0 * MARGIN;
        let height = width * size.y / size.x;
        let extent = lattice.extent();
        let scale = [width / f64::from(extent.x), height / f64::from(extent.y)];
        Self { scale, height: height + 2.0 * MARGIN }
    }

    fn place(&self, node: LatticePoint) -> [f64; 2] {
        [MARGIN + self.scale[0] * f64::from(node.x), self.height - MARGIN - self.scale[1] * f64::from(node.y)]
    }

    fn corners(&self, corners: [LatticePoint; 3]) -> [[f64; 2]; 3] {
        corners.map(|corner| self.place(corner))
    }
}

struct Hex([u8; 3]);

impl std::fmt::Display for Hex {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

struct Points([[f64; 2]; 3]);

impl std::fmt::Display for Points {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [[ax, ay], [bx, by], [cx, cy]] = self.0;
        write!(f, "{ax:.1},{ay:.1} {bx:.1},{by:.1} {cx:.1},{cy:.1}")
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
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

    fn drawn(player: &StepPlayer) -> String {
        let colors = StepColors {
            levels: &[[9, 9, 9, 255]; 64],
            background: [0; 3],
            text: [0xff; 3],
            parts: [[1, 1, 1], [2, 2, 2], [3, 3, 3]],
        };
        let mut out = Vec::new();
        write(&mut out, player, &colors).unwrap();
        String::from_utf8(out).unwrap()
    }

    /// Returns the part of a drawing between the tags of a group.
    fn group<'a>(drawing: &'a str, id: &str) -> &'a str {
        let from = drawing.find(&format!("<g id=\"{id}\"")).unwrap();
        &drawing[from..from + drawing[from..].find("</g>").unwrap()]
    }

    #[test]
    fn a_drawing_has_every_triangle_within_the_page_and_its_number() {
        let mut player = player();
        for position in [0, 5, player.len() / 2, player.len()] {
            player.go_to(position);
            let drawing = drawn(&player);
            let triangles = group(&drawing, "triangles");
            assert_eq!(triangles.matches("<polygon").count(), player.rows().len());
            // The area of all triangles is that of the page within its margins: 1140 by 570 pixels.
            let area: f64 =
                triangles.lines().filter_map(|line| line.split("points=\"").nth(1)).map(area_of).sum();
            assert!((area / (1140.0 * 570.0) - 1.0).abs() < 0.01, "{area}");
            let numbers = group(&drawing, "numbers");
            for group in [numbers, group(&drawing, "nodes")] {
                let sizes = group.split("font-size=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
                let mut sizes = sizes.map(|size| size.parse::<f64>().unwrap());
                assert!(sizes.all(|size| (NUMBERS[0]..=NUMBERS[1]).contains(&size)), "{group}");
            }
            assert!(numbers.contains(">1</text>") || group(&drawing, "names").contains("= 1</text>"));
            for (place, _) in player.names().labels() {
                let NamedPlace::Triangle(number) = place else { continue };
                assert!(!numbers.contains(&format!(">{number}</text>")), "its name has its number");
            }
            let named = group(&drawing, "names").matches("</text>").count();
            assert_eq!(named, player.names().labels().count());
            assert_eq!(drawing.matches("<g").count(), drawing.matches("</g>").count());
            assert!(drawing.contains(&format!("Step {position} of {}", player.len())));
            if let Some(step) = player.step() {
                assert!(drawing.contains(&step.sentence()));
            }
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

    fn area_of(points: &str) -> f64 {
        let points = points.split('"').next().unwrap();
        let corners: Vec<[f64; 2]> = points
            .split(' ')
            .map(|corner| {
                let (x, y) = corner.split_once(',').unwrap();
                let corner = [x.parse::<f64>().unwrap(), y.parse::<f64>().unwrap()];
                assert!(
                    (29.9..=1170.1).contains(&corner[0]) && (29.9..=600.1).contains(&corner[1]),
                    "{corner:?}"
                );
                corner
            })
            .collect();
        let [a, b, c] = corners[..] else { panic!("{points}") };
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
        assert!(drawing.contains("S_b: ") && drawing.contains("stroke=\"#ffffff\""));
        assert!(drawing.contains("stroke=\"#030303\""), "the bisection neighbour");
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
    }
}
