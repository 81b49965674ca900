//! Pictures in the colours of overlays, with their legends.

use std::sync::Arc;

use super::*;
use crate::colormap::overlay_palette::OverlayPalette;
use crate::render::furniture::{Legend, LegendBody};
use crate::render::overlay::{OverlayColors, PictureOverlay, measure_overlay};
use meshbrush_core::earth::Ground as GroundOfLengths;
use meshbrush_core::quality::{QualityMeasure, TriangleMeasures};
use meshbrush_mesh::mesh::TriangleId;

/// Returns colours that differ from each other and from those of levels.
fn distinct(count: usize) -> Vec<[u8; 4]> {
    (0..count).map(|n| [(17 + 37 * n % 200) as u8, (250 - n % 180) as u8, (3 * n % 90) as u8, 255]).collect()
}

fn of_triangles(legend: Legend, colors: Vec<[u8; 4]>) -> PictureOverlay {
    PictureOverlay { legend, neutral: [90, 90, 90, 255], colors: OverlayColors::Triangles(colors.into()) }
}

fn legends() -> Vec<Legend> {
    let texts = |texts: [&str; 3]| texts.map(str::to_owned);
    let colors = || (0..16).map(|n| [n, 0, 0, 255]);
    let name = |name: &str| ([1, 2, 3, 255], vec![name.to_owned()]);
    let numbers = |n: u8| ([n, 2, 3, 255], vec![n.to_string(), format!("{} km", 1.0 / f64::from(n + 1))]);
    vec![
        Legend::scale("Longest edge / h̄", colors(), texts(["≤ 0.5", "1", "≥ 2"]), "finer, coarser than h̄"),
        Legend::scale("Risk", colors(), texts(["0", "0.5", "1"]), ""),
        Legend::scale(
            "Depth",
            colors(),
            texts(["0", "1,234,567.8", "4,938,271.2 m"]),
            "isobaths every 100 m",
        ),
        Legend::rows("Deciding layer", ["Base", "Küste und Ästuar – größer", "Ω"].map(name)),
        Legend::rows("h̄ by level", (0..20).map(numbers)),
        Legend::missing("Depth", "no layer of depths"),
    ]
}

#[test]
fn legends_of_overlays_cover_nothing_and_are_not_cut_off() {
    let mesh = mesh(Rect::new(DVec2::ZERO, dvec2(30.0, 20.0)));
    for legend in legends() {
        for size in ["400", "1600", "1200x500", "600x1400", "160mm"] {
            let overlay = Some(of_triangles(legend.clone(), Vec::new()));
            let look = Look { overlay, ..look(size, plane(LengthUnit::Kilometre)) };
            let sheet = sheet_of(&look, &mesh);
            check(&sheet, &format!("{size}, {}", legend.title));
            let texts: Vec<String> = boxes(&sheet).into_iter().map(|(text, _)| text).collect();
            assert!(texts.contains(&legend.title), "{texts:?}");
            assert!(!texts.iter().any(|text| text.starts_with("Level,")), "no second legend");
            if let LegendBody::Scale(scale) = &legend.body {
                assert!(scale.ends.iter().all(|end| texts.contains(end)), "{texts:?}");
                let fills = sheet.marks.iter().filter(|mark| matches!(mark, SheetMark::Fill { .. }));
                assert_eq!(fills.count(), 16);
            }
        }
    }
}

#[test]
fn each_triangle_has_its_own_colour_in_both_formats_and_the_ground_keeps_its_own() {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap();
    let inside = |p: DVec2| p.x + p.y < 1.3;
    let mesh = Mesh::coarse_grid(&lattice, inside, &Limits::default()).unwrap();
    let extract = mesh.extract();
    let colors = distinct(extract.triangles().len());
    for ground in
        [PictureGround::White, PictureGround::Light, PictureGround::Dark, PictureGround::Transparent]
    {
        let overlay = Some(of_triangles(legends().remove(1), colors.clone()));
        let bare = Some(Furniture::NONE);
        let look =
            Look { overlay, ground, edges: false, furniture: bare, ..look("400", plane(LengthUnit::None)) };
        let image = look.draw(&mesh, &extract).unwrap();
        for (number, color) in colors.iter().enumerate() {
            let [a, b, c] = extract.view().world_corners(TriangleId::from_index(number));
            let middle = 400.0 * (a + b + c) / 3.0;
            assert_eq!(image.pixel(middle.x as u32, 399 - middle.y as u32), *color, "{number}");
        }
        assert_eq!(image.pixel(398, 1), ground.rgba(), "beyond the mesh");
        let svg = String::from_utf8(written(ExportFormat::Svg, &look, &mesh)).unwrap();
        for [r, g, b, _] in &colors {
            let fill = format!("fill=\"#{r:02x}{g:02x}{b:02x}\"");
            assert_eq!(svg.matches(&fill).count(), 1, "{fill}");
        }
        assert!(!svg.contains("id=\"level-"), "no levels");
    }
}

#[test]
fn colours_within_triangles_are_a_picture_below_the_edges_of_an_svg() {
    let mesh = mesh(Rect::new(DVec2::ZERO, dvec2(2.0, 1.0)));
    let halves = |bounds: Rect, [columns, rows]: [u32; 2]| -> Vec<[u8; 4]> {
        let x = |column: u32| bounds.min.x + bounds.size().x * (f64::from(column) + 0.5) / f64::from(columns);
        let color = |column| if x(column) < 0.9 { [200, 10, 10, 255] } else { [10, 10, 200, 255] };
        (0..rows).flat_map(|_| (0..columns).map(color)).collect()
    };
    let colors = OverlayColors::Pixels(Arc::new(halves));
    let overlay = Some(PictureOverlay { legend: legends().remove(1), neutral: [90, 90, 90, 255], colors });
    let look = Look { overlay, ..look("800", plane(LengthUnit::None)) };
    let sheet = sheet_of(&look, &mesh);
    let image = look.draw(&mesh, &mesh.extract()).unwrap();
    // Between edges.
    let at = |x: f64| {
        let [from, size] = [sheet.map_at, sheet.map_size].map(|pair| pair.map(f64::from));
        image.pixel((from[0] + 0.5 * x * size[0]) as u32, (from[1] + 0.53 * size[1]) as u32)
    };
    assert_eq!([at(0.85), at(0.95)], [[200, 10, 10, 255], [10, 10, 200, 255]]);
    let svg = String::from_utf8(written(ExportFormat::Svg, &look, &mesh)).unwrap();
    let picture = svg.find("<image ").expect("a picture");
    assert!(
        picture < svg.find("id=\"edges\"").unwrap() && svg.contains("xlink:href=\"data:image/png;base64,")
    );
    assert!(svg.contains("<title>Risk</title>") && !svg.contains("id=\"level-"));
}

#[test]
fn a_measure_has_the_colours_of_its_legend() {
    let mesh = mesh(Rect::UNIT);
    let (extract, ground) = (mesh.extract(), GroundOfLengths::default());
    let levels = LevelColors::new(Colormap::Viridis, Ground::Light, 12);
    let palette = OverlayPalette::new(Ground::Light, levels);
    let measures = TriangleMeasures::new(extract.view(), &ground);
    let time = |seconds: f64| format!("{seconds} s");
    let overlay = measure_overlay(&measures, QualityMeasure::SmallestAngle, &palette, time).unwrap();
    let OverlayColors::Triangles(colors) = &overlay.colors else { panic!("one colour each") };
    assert!(colors.iter().all(|color| *color == palette.neutral()), "all have 45°");
    assert_eq!(overlay.legend.title, "Smallest angle");
    let LegendBody::Scale(scale) = &overlay.legend.body else { panic!("a scale") };
    assert_eq!(scale.ends, ["≤ 15°", "30°", "≥ 45°"]);
    assert_ne!(scale.colors[0], scale.colors[15]);
    assert!(measure_overlay(&measures, QualityMeasure::TimeStep, &palette, time).is_none(), "no depths");
}
