//! Axes of views in space, by the formulas of a parallel projection.

use super::*;
use crate::render::furniture::SheetMark;
use crate::render::space_look::SpaceLook;
use crate::scene::{Light, NodeHeights, ViewDirection};

/// A surface that rises from 100 to 300 along both axes.
const HEIGHTS: [f64; 2] = [100.0, 300.0];

fn in_space(size: &str, place: MapPlace, mesh: &Mesh, direction: ViewDirection, factor: f64) -> Look {
    let bounds = mesh.lattice().bounds();
    let extract = mesh.extract();
    let heights: Vec<Option<f64>> = extract
        .world_nodes()
        .map(|at| {
            let share = (at - bounds.min) / bounds.size();
            Some(HEIGHTS[0] + 0.5 * (share.x + share.y) * (HEIGHTS[1] - HEIGHTS[0]))
        })
        .collect();
    let heights = NodeHeights::new(&heights, &[]).unwrap();
    let space = SpaceLook::new((direction, Light::default()), Some(factor), 1.0, heights, mesh.lattice());
    Look { space: Some(space), ..look(size, place) }
}

/// Returns a direction of the world in the picture, up to a factor: y grows downwards.
fn projected(ViewDirection { azimuth, altitude }: ViewDirection, by: [f64; 3]) -> DVec2 {
    let (azimuth, altitude) = (azimuth.to_radians(), altitude.to_radians());
    let right = by[0] * azimuth.cos() - by[1] * azimuth.sin();
    let away = by[0] * azimuth.sin() + by[1] * azimuth.cos();
    dvec2(right, -(altitude.sin() * away + altitude.cos() * by[2]))
}

fn lines(sheet: &Sheet) -> Vec<[DVec2; 2]> {
    let line = |mark: &SheetMark| match mark {
        SheetMark::Line { points, .. } => <[DVec2; 2]>::try_from(&points[..]).ok(),
        _ => None,
    };
    sheet.marks.iter().filter_map(line).collect()
}

fn directions() -> impl Iterator<Item = ViewDirection> {
    let azimuths = [0.0, 20.0, 90.0, 135.0, 200.0, 310.0];
    azimuths
        .into_iter()
        .flat_map(|azimuth| [5.0, 40.0, 75.0, 90.0].map(|altitude| ViewDirection { azimuth, altitude }))
}

#[test]
fn axes_lie_on_the_edges_of_the_box_with_numbers_at_their_places() {
    let bounds = Rect::new(dvec2(100.0, 7.0), dvec2(140.0, 27.0));
    let mesh = mesh(bounds);
    let factor = 0.05;
    for direction in directions() {
        let look = in_space("1600", plane(LengthUnit::Kilometre), &mesh, direction, factor);
        let sheet = sheet_of(&look, &mesh);
        let found = lines(&sheet);
        let rise = factor * (HEIGHTS[1] - HEIGHTS[0]);
        let sides = [[40.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, rise]].map(|by| projected(direction, by));
        // One scale for all edges.
        let scale = found[0][0].distance(found[0][1]) / sides[0].length();
        let mut axes = 0;
        for side in sides {
            let is_edge = |line: &&[DVec2; 2]| {
                let along = line[1] - line[0];
                (along - scale * side).length() < 0.5 && side.length() * scale > 10.0
            };
            axes += usize::from(found.iter().any(|line| is_edge(&line)));
        }
        let is_upright = direction.altitude < 80.0;
        assert_eq!(axes, if is_upright { 3 } else { 2 }, "{direction:?}");
        let texts: Vec<String> = boxes(&sheet).into_iter().map(|(text, _)| text).collect();
        assert!(texts.contains(&"x in km".to_owned()) && texts.contains(&"y in km".to_owned()), "{texts:?}");
        assert_eq!(texts.contains(&"Heights × 0.05".to_owned()), is_upright, "{texts:?}");
        // A tick begins on its axis, at the share of its number.
        let x_axis = found.iter().find(|line| (line[1] - line[0] - scale * sides[0]).length() < 0.5).unwrap();
        let at = x_axis[0].lerp(x_axis[1], (120.0 - 100.0) / 40.0);
        assert!(found.iter().any(|line| line[0].distance(at) < 0.1), "{direction:?}: no tick at 120");
        assert!(texts.contains(&"120".to_owned()), "{direction:?}: {texts:?}");
    }
}

#[test]
fn labels_in_space_cover_no_other_and_are_not_cut_off() {
    let sides = [dvec2(10.0, 10.0), dvec2(90.0, 10.0), dvec2(3.0, 20.0)];
    let places = [plane(LengthUnit::None), plane(LengthUnit::Degree), mercator()];
    for (side, place) in sides.iter().flat_map(|side| places.iter().map(move |place| (*side, *place))) {
        let scale = if place.projection.is_some() { 20_000.0 } else { 1.0 };
        let from = dvec2(-1.0, 40.0);
        let mesh = mesh(Rect::new(scale * from, scale * (from + side)));
        let factor = 0.125 * scale * side.max_element() / (HEIGHTS[1] - HEIGHTS[0]);
        for direction in directions() {
            for size in ["400", "1600", "800x500", "160mm"] {
                let look = in_space(size, place, &mesh, direction, factor);
                let sheet = sheet_of(&look, &mesh);
                let (end, boxes) = (DVec2::from(sheet.size.map(f64::from)), boxes(&sheet));
                for (index, (name, at)) in boxes.iter().enumerate() {
                    let what = format!("{size}, {side}, {direction:?}: {name} {at:?}");
                    assert!(at[0].cmpge(DVec2::ZERO).all() && at[1].cmple(end).all(), "{what}");
                    for (other, beside) in &boxes[..index] {
                        assert!(!overlap(*at, *beside), "{what} and {other}");
                    }
                }
                assert!(look.missing_furniture().is_none());
            }
        }
    }
}

#[test]
fn meridians_cross_the_edges_of_the_box_in_space() {
    let (low, high) = (on_mercator(-7.0, 47.0), on_mercator(1.0, 52.0));
    let mesh = mesh(Rect::new(low, high));
    let direction = ViewDirection { azimuth: 20.0, altitude: 40.0 };
    let sheet = sheet_of(&in_space("1600", mercator(), &mesh, direction, 400.0), &mesh);
    let found = lines(&sheet);
    for (axis, text, share) in [
        (0, "4° W", (on_mercator(-4.0, 50.0).x - low.x) / (high.x - low.x)),
        (1, "50° N", (on_mercator(0.0, 50.0).y - low.y) / (high.y - low.y)),
    ] {
        let size = high - low;
        let along = projected(direction, if axis == 0 { [size.x, 0.0, 0.0] } else { [0.0, size.y, 0.0] });
        let is_axis =
            |line: &&[DVec2; 2]| (line[1] - line[0]).normalize().dot(along.normalize()) > 1.0 - 1e-9;
        let edge =
            found.iter().filter(is_axis).max_by(|a, b| a[0].distance(a[1]).total_cmp(&b[0].distance(b[1])));
        let at = edge.map(|edge| edge[0].lerp(edge[1], share)).unwrap();
        assert!(found.iter().any(|line| line[0].distance(at) < 0.5), "{text}");
        assert!(boxes(&sheet).iter().any(|(label, _)| label == text), "{text}");
    }
}

#[test]
#[ignore = "writes pictures for a look, into the folder PICTURES"]
fn pictures_in_space_for_a_look() {
    let folder = std::path::PathBuf::from(std::env::var_os("PICTURES").unwrap());
    let mesh = mesh(Rect::new(dvec2(100.0, 7.0), dvec2(140.0, 27.0)));
    for (n, direction) in directions().enumerate() {
        let look = in_space("1200", plane(LengthUnit::Kilometre), &mesh, direction, 0.05);
        std::fs::write(folder.join(format!("space-{n}.png")), written_png(&look, &mesh)).unwrap();
    }
}

fn written_png(look: &Look, mesh: &Mesh) -> Vec<u8> {
    let image = look.draw(mesh, &mesh.extract()).unwrap();
    let mut file = Vec::new();
    meshbrush_io::io::png::write(&mut file, image.size, &image.rgba).unwrap();
    file
}
