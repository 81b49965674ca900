//! Pictures with furniture, measured.

mod overlays;
mod space;

use std::f64::consts::PI;

use glam::{DVec2, dvec2};

use super::export::ExportFormat;
use super::furniture::{Furniture, Sheet, SheetMark};
use super::look::{Look, MapPlace};
use super::picture_size::{PictureGround, PictureSize};
use crate::colormap::{Colormap, Ground, LevelColors};
use meshbrush_core::earth::{DegreeStyle, Projection};
use meshbrush_io::io::{MeshSource, Meter, Provenance};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};
use meshbrush_mesh::text::LengthUnit;

/// Axes of the ellipsoid WGS 84, and the radius of a sphere with its mean curvature, in metres.
const SEMI_MAJOR: f64 = 6_378_137.0;
const ECCENTRICITY: f64 = 0.081_819_190_842_621_5;
const RADIUS: f64 = 6_371_008.8;

fn mesh(bounds: Rect) -> Mesh {
    let lattice = Lattice::covering(bounds, bounds.size().min_element() / 4.0, 1_000_000).unwrap();
    Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap()
}

fn look(size: &str, place: MapPlace) -> Look {
    Look {
        size: PictureSize::parse(size, None).unwrap(),
        edges: true,
        ground: PictureGround::White,
        level_colors: LevelColors::new(Colormap::Viridis, Ground::Light, 12),
        north: place.projection.map(|_| DVec2::Y),
        furniture: Some(Furniture::ALL),
        place,
        space: None,
        overlay: None,
    }
}

fn plane(unit: LengthUnit) -> MapPlace {
    MapPlace { projection: None, unit, degrees: Some(DegreeStyle::Decimal) }
}

fn mercator() -> MapPlace {
    let projection: Projection = "+proj=merc +lon_0=0".parse().unwrap();
    MapPlace { projection: Some(projection), unit: LengthUnit::Metre, degrees: Some(DegreeStyle::Decimal) }
}

/// Returns the plane of Mercator's projection, in metres: its own formulas.
fn on_mercator(longitude: f64, latitude: f64) -> DVec2 {
    let [longitude, latitude] = [longitude, latitude].map(f64::to_radians);
    let flattened = ECCENTRICITY * latitude.sin();
    let factor = ((1.0 - flattened) / (1.0 + flattened)).powf(0.5 * ECCENTRICITY);
    SEMI_MAJOR * dvec2(longitude, ((0.25 * PI + 0.5 * latitude).tan() * factor).ln())
}

fn sheet_of(look: &Look, mesh: &Mesh) -> Sheet {
    look.sheet(mesh, &mesh.extract()).unwrap().unwrap()
}

fn boxes(sheet: &Sheet) -> Vec<(String, [DVec2; 2])> {
    let place = |mark: &SheetMark| match mark {
        SheetMark::Text { text, .. } => Some((text.clone(), mark.text_box()?)),
        SheetMark::Fill { corners, color } => Some((format!("{color:?}"), *corners)),
        SheetMark::Line { .. } => None,
    };
    sheet.marks.iter().filter_map(place).collect()
}

fn overlap([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    a.x < d.x && c.x < b.x && a.y < d.y && c.y < b.y
}

#[test]
fn nothing_overlaps_and_nothing_is_cut_off() {
    let sides = [dvec2(10.0, 10.0), dvec2(90.0, 10.0), dvec2(3.0, 20.0)];
    let places =
        [plane(LengthUnit::None), plane(LengthUnit::Kilometre), plane(LengthUnit::Degree), mercator()];
    let sizes = ["300", "800", "1600", "4000", "800x300", "500x1400", "160mm", "80x120mm"];
    for (side, place) in sides.iter().flat_map(|side| places.iter().map(move |place| (*side, *place))) {
        let scale = if place.projection.is_some() { 20_000.0 } else { 1.0 };
        let from = dvec2(-1.0, 40.0);
        let mesh = mesh(Rect::new(scale * from, scale * (from + side)));
        for size in sizes {
            for n in 1..16 {
                let [legend, axes, bar, north] = [1, 2, 4, 8].map(|bit| n & bit != 0);
                let furniture = Furniture { legend, axes, scale: bar, north };
                let look = Look { furniture: Some(furniture), ..look(size, place) };
                let Ok(sheet) = look.sheet(&mesh, &mesh.extract()) else {
                    // Only pictures with a side below 100 pixels may be refused here.
                    let bare = look.bare_size(mesh.lattice());
                    assert!(bare.iter().min().unwrap() < &100, "{size}, {side}, {furniture}");
                    continue;
                };
                check(&sheet.unwrap(), &format!("{size}, {side}, {place:?}, {furniture}"));
            }
        }
    }
}

fn check(sheet: &Sheet, what: &str) {
    let at = DVec2::from(sheet.map_at.map(f64::from));
    let map = [at, at + DVec2::from(sheet.map_size.map(f64::from))];
    let end = DVec2::from(sheet.size.map(f64::from));
    let boxes = boxes(sheet);
    for (index, (name, place)) in boxes.iter().enumerate() {
        assert!(place[0].cmpge(DVec2::ZERO).all() && place[1].cmple(end).all(), "{what}: {name} {place:?}");
        assert!(!overlap(*place, map), "{what}: {name} covers the map");
        for (other, beside) in &boxes[..index] {
            assert!(!overlap(*place, *beside), "{what}: {name} and {other}");
        }
    }
    assert!(map[1].cmple(end).all(), "{what}");
}

/// Returns the middle of the text that says this.
fn middle(sheet: &Sheet, text: &str) -> DVec2 {
    let found: Vec<_> = boxes(sheet).into_iter().filter(|(name, _)| name == text).collect();
    assert_eq!(found.len(), 1, "{text}");
    0.5 * (found[0].1[0] + found[0].1[1])
}

#[test]
fn labels_stand_at_their_coordinates() {
    let mesh_of = |min, max| mesh(Rect::new(min, max));
    // A side of the map has its coordinates evenly.
    let even = mesh_of(dvec2(100.0, 7.0), dvec2(140.0, 27.0));
    let sheet = sheet_of(&look("1600", plane(LengthUnit::Kilometre)), &even);
    let across = |x: f64| f64::from(sheet.map_at[0]) + x * f64::from(sheet.map_size[0]);
    let down = |y: f64| f64::from(sheet.map_at[1]) + y * f64::from(sheet.map_size[1]);
    assert!((middle(&sheet, "120").x - across(0.5)).abs() < 1.0);
    assert!((middle(&sheet, "105").x - across(0.125)).abs() < 1.0);
    assert!((middle(&sheet, "22").y - down(0.25)).abs() < 1.0);
    assert!(boxes(&sheet).iter().any(|(text, _)| text == "x in km"));
    // In Mercator's plane meridians are even, and parallels are not.
    let (low, high) = (on_mercator(-7.0, 47.0), on_mercator(1.0, 52.0));
    let sheet = sheet_of(&look("1600", mercator()), &mesh_of(low, high));
    let px = f64::from(sheet.map_size[0]) / (high.x - low.x);
    for (text, longitude) in [("4° W", -4.0), ("0°", 0.0)] {
        let x = f64::from(sheet.map_at[0]) + px * (on_mercator(longitude, 50.0).x - low.x);
        assert!((middle(&sheet, text).x - x).abs() < 1.5, "{text}: {} {x}", middle(&sheet, text));
    }
    for (text, latitude) in [("48° N", 48.0), ("51° N", 51.0)] {
        let from_top = f64::from(sheet.map_size[1]) - px * (on_mercator(0.0, latitude).y - low.y);
        let y = f64::from(sheet.map_at[1]) + from_top;
        assert!((middle(&sheet, text).y - y).abs() < 1.5, "{text}: {} {y}", middle(&sheet, text));
    }
}

/// Returns the length of the bar in pixels, and what it says, in metres or in the unit of the plane.
fn bar(sheet: &Sheet) -> (f64, f64) {
    let length = sheet.marks.iter().find_map(|mark| match mark {
        SheetMark::Line { points, .. } if points.len() == 4 => {
            let [_, from, to, _] = points[..] else { return None };
            (from.y == to.y).then_some(to.x - from.x)
        }
        _ => None,
    });
    let said = boxes(sheet).into_iter().find_map(|(text, _)| {
        let (number, unit) = text.split_once(' ')?;
        let number: f64 = number.replace(',', "").parse().ok()?;
        match unit {
            "m" => Some(number),
            "km" => Some(1000.0 * number),
            _ => None,
        }
    });
    (length.unwrap(), said.unwrap())
}

fn haversine([a, b]: [DVec2; 2]) -> f64 {
    let [a, b] = [a, b].map(|at| dvec2(at.x.to_radians(), at.y.to_radians()));
    let half = 0.5 * (b - a);
    let chord = half.y.sin().powi(2) + a.y.cos() * b.y.cos() * half.x.sin().powi(2);
    2.0 * RADIUS * chord.sqrt().asin()
}

#[test]
fn the_scale_bar_has_the_length_that_it_says() {
    let sheet = sheet_of(
        &look("900", plane(LengthUnit::Kilometre)),
        &mesh(Rect::new(DVec2::ZERO, dvec2(40.0, 30.0))),
    );
    let (px, metres) = bar(&sheet);
    assert!((px * 40_000.0 / f64::from(sheet.map_size[0]) / metres - 1.0).abs() < 0.005);
    for latitude in [-20.0, 5.0, 45.0, 60.0] {
        // In degrees and in Mercator's plane, the middle has this latitude.
        let bounds = Rect::new(dvec2(9.0, latitude - 2.0), dvec2(14.0, latitude + 2.0));
        let degrees = sheet_of(&look("1600", plane(LengthUnit::Degree)), &mesh(bounds));
        let half = on_mercator(0.0, latitude);
        let (low, high) = (on_mercator(9.0, 0.0), on_mercator(14.0, 0.0));
        let bounds = Rect::new(dvec2(low.x, half.y - 200_000.0), dvec2(high.x, half.y + 200_000.0));
        let projected = sheet_of(&look("1600", mercator()), &mesh(bounds));
        for sheet in [degrees, projected] {
            let (px, metres) = bar(&sheet);
            let along = 5.0 * px / f64::from(sheet.map_size[0]);
            let ground = haversine([dvec2(0.0, latitude), dvec2(along, latitude)]);
            assert!((ground / metres - 1.0).abs() < 0.005, "{latitude}°: {ground} m, said {metres}");
        }
    }
}

fn written(format: ExportFormat, look: &Look, mesh: &Mesh) -> Vec<u8> {
    let mut out = Vec::new();
    let provenance = Provenance::new(MeshSource::Document("test"), mesh.fingerprint(), "x, y");
    let of_mesh = (mesh, &mesh.extract());
    format.write_path_to(&mut out, of_mesh, &[], look, &provenance, &Meter::default()).unwrap();
    out
}

#[test]
fn png_has_its_density_its_size_and_a_transparent_ground() {
    let mesh = mesh(Rect::new(DVec2::ZERO, dvec2(4.0, 3.0)));
    let paper = PictureSize::parse("80x90mm", Some(254.0)).unwrap();
    for furniture in [None, Some(Furniture::ALL)] {
        let look = Look {
            ground: PictureGround::Transparent,
            size: paper,
            furniture,
            ..look("1", plane(LengthUnit::None))
        };
        let file = written(ExportFormat::Png, &look, &mesh);
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        let info = reader.info();
        let density = info.pixel_dims.unwrap();
        assert_eq!((info.width, info.height, density.xppu, density.yppu), (800, 900, 10_000, 10_000));
        assert_eq!(density.unit, png::Unit::Meter);
        assert_eq!(bytes[..4], [0; 4], "the corner");
        let [x, y] = [400, 400];
        assert_eq!(bytes[4 * (800 * y + x) + 3], 0xff, "the mesh");
        // A dark text on nothing stays dark where it covers a pixel in part.
        let is_light =
            |pixel: &[u8]| (1..0xff).contains(&pixel[3]) && pixel[..3].iter().all(|&value| value > 0xa0);
        assert!(!bytes.chunks_exact(4).any(is_light));
    }
    let plain = written(ExportFormat::Png, &look("400", plane(LengthUnit::None)), &mesh);
    assert!(png::Decoder::new(std::io::Cursor::new(plain)).read_info().unwrap().info().pixel_dims.is_none());
}

#[test]
fn svg_has_texts_as_outlines_and_its_size_on_paper() {
    let mesh = mesh(Rect::new(DVec2::ZERO, dvec2(4.0, 3.0)));
    let size = PictureSize::parse("160mm", Some(254.0)).unwrap();
    let look = Look { size, ..look("1", plane(LengthUnit::Kilometre)) };
    let svg = String::from_utf8(written(ExportFormat::Svg, &look, &mesh)).unwrap();
    assert!(svg.contains(" width=\"160mm\" height=\""), "{}", &svg[..200]);
    assert!(svg.contains("viewBox=\"0 0 1600 "), "{}", &svg[..200]);
    for word in ["paint-order", "style", "<text", "class=", "clip", "NaN", "inf"] {
        assert!(!svg.contains(word), "{word}");
    }
    assert!(svg.contains("<title>x in km</title><path"));
    let sheet = sheet_of(&look, &mesh);
    assert_eq!(
        svg.matches("<g><title>").count(),
        boxes(&sheet).iter().filter(|(name, _)| !name.starts_with('[')).count()
    );
    let transparent = Look { ground: PictureGround::Transparent, ..look };
    let svg = String::from_utf8(written(ExportFormat::Svg, &transparent, &mesh)).unwrap();
    assert!(!svg.contains("<rect"));
}

#[test]
fn a_picture_that_is_too_small_says_so() {
    let mesh = mesh(Rect::UNIT);
    let look = look("60", plane(LengthUnit::None));
    let refused = look.draw(&mesh, &mesh.extract()).unwrap_err().to_string();
    assert!(refused.starts_with("a picture 60 pixels wide has no room for legend, axes, scale"), "{refused}");
    let bare = Look { furniture: Some(Furniture::NONE), ..look };
    assert_eq!(bare.draw(&mesh, &mesh.extract()).unwrap().size, [60, 60]);
}

#[test]
fn furniture_that_was_named_and_cannot_be_is_said() {
    let north = Furniture { north: true, ..Furniture::NONE };
    let named = |furniture, place| Look { furniture: Some(furniture), ..look("400", place) };
    let said = named(north, plane(LengthUnit::Metre)).missing_furniture();
    assert!(said.is_some_and(|said| said.contains("does not lie on the Earth")), "{said:?}");
    for place in [mercator(), plane(LengthUnit::Degree)] {
        assert_eq!(named(north, place).missing_furniture(), None);
    }
    assert_eq!(named(Furniture::ALL, plane(LengthUnit::Metre)).missing_furniture(), None);
    let axes = Furniture { axes: true, ..Furniture::NONE };
    assert_eq!(named(axes, plane(LengthUnit::Metre)).missing_furniture(), None);
}
