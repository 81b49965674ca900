//! What a document is that begins with a grid: its unit, its plane, and what its layers lack.

use std::fs;
use std::path::PathBuf;

use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::depth::begin_contour;
use crate::app::tests::{
    TALL, Window, active, folder, notice, send, settings, step_until, triangles, wait_for_notice, wait_until,
    window_of,
};
use meshbrush_core::document::Setting;
use meshbrush_core::domain::BoundaryPieces;
use meshbrush_core::layers::{DepthRule, Depths};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, LayerCommand};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

const LONLAT: &str = r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],
    PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]"#;
const UTM: &str = r#"PROJCS["WGS 84 / UTM zone 30N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],
    PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],
    PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",-3],PARAMETER["scale_factor",0.9996],
    PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],AUTHORITY["EPSG","32630"]]"#;

/// Writes a grid of 20 × 20 pixels whose water becomes deeper to the east, beside what its coordinates are.
fn grid(test: &str, [left, bottom]: [f64; 2], side: f64, system: Option<&str>) -> PathBuf {
    let file = folder("app-ground", test).join("depths.asc");
    let row: Vec<String> = (0..20).map(|column| (5 - 10 * column).to_string()).collect();
    let header =
        format!("ncols 20\nnrows 20\nxllcorner {left}\nyllcorner {bottom}\ncellsize {}\n", side / 20.0);
    fs::write(&file, header + &format!("{}\n", row.join(" ")).repeat(20)).unwrap();
    if let Some(system) = system {
        fs::write(file.with_extension("prj"), system).unwrap();
    }
    file
}

fn rule(window: &Window) -> DepthRule {
    let Some(depths) = active(window).kind.get::<Depths>() else { panic!("depths: {:?}", active(window)) };
    depths.sizes().rule
}

/// Returns a window whose new document began with a grid, and what was said.
fn begun_with(command: LayerCommand) -> (Window, String) {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    // For one frame: while the mesh follows, news fades.
    window.state_mut().send(Command::from(command));
    window.step();
    step_until(&mut window, |window| !notice(window).is_empty());
    let said = notice(&window);
    wait_until(&mut window, |window| active(window).name == "depths.asc");
    (window, said)
}

#[test]
fn depths_in_degrees_begin_a_document_in_metres_and_ask_for_sizes() {
    for (test, system) in [("stated", Some(LONLAT)), ("unstated", None)] {
        let file = grid(test, [-6.0, 48.0], 2.0, system);
        let (window, said) = begun_with(LayerCommand::OpenDepth(file));
        let Some(plane) = settings(&window).domain.projection else { panic!("{test}: {said}") };
        assert_eq!(
            (settings(&window).unit, rule(&window)),
            (LengthUnit::Metre, DepthRule::DEFAULT_WAVELENGTH)
        );
        assert!(
            said.contains("takes the extent of depths.asc") && said.contains("the document is in metres"),
            "{said}"
        );
        let size = settings(&window).domain.bounds.size();
        assert!(size.x > 1.4e5 && size.x < 1.6e5 && size.y > 2.2e5 && size.y < 2.3e5, "{test}: {size}");
        // The pixels lie where the file says.
        let depth = |lon: f64, lat: f64| {
            let source = active(&window).kind.raster_source().unwrap();
            source.raster.raster().linear_at(plane.plane_from_geographic(dvec2(lon, lat))).unwrap()
        };
        assert!((depth(-5.0, 49.0) + 90.0).abs() < 6.0, "{test}: {}", depth(-5.0, 49.0));
        assert!((depth(-4.5, 48.5) + 140.0).abs() < 6.0, "{test}: {}", depth(-4.5, 48.5));
        assert!(triangles(&window) > 300, "{test}: the depths are asked for sizes: {}", triangles(&window));
    }
}

#[test]
fn other_layers_of_a_grid_in_degrees_keep_its_pixels_and_have_its_unit() {
    let opens: [fn(PathBuf) -> LayerCommand; 3] =
        [LayerCommand::OpenSurface, LayerCommand::OpenValues, LayerCommand::OpenBand];
    for (number, open) in opens.into_iter().enumerate() {
        let file = grid(&format!("other-{number}"), [-6.0, 48.0], 2.0, Some(LONLAT));
        let (window, said) = begun_with(open(file));
        assert_eq!(
            (settings(&window).unit, settings(&window).domain.projection),
            (LengthUnit::Degree, None),
            "{said}"
        );
        let raster = active(&window).kind.raster_source().unwrap().raster.clone();
        assert_eq!(raster.raster().bounds(), Rect::new(dvec2(-6.0, 48.0), dvec2(-4.0, 50.0)));
    }
    let (window, _) = begun_with(LayerCommand::OpenSurface(grid("plain", [0.0, 0.0], 2.0, None)));
    assert_eq!(settings(&window).unit, LengthUnit::None, "nobody says that these are degrees");
}

#[test]
fn a_grid_in_a_plane_begins_a_document_in_that_plane() {
    for open in [LayerCommand::OpenDepth as fn(PathBuf) -> LayerCommand, LayerCommand::OpenSurface] {
        let file = grid("utm", [400_000.0, 5_400_000.0], 40_000.0, Some(UTM));
        let (window, said) = begun_with(open(file));
        assert_eq!(settings(&window).unit, LengthUnit::Metre, "{said}");
        let plane = settings(&window).domain.projection.expect("the file names its plane");
        assert_eq!(plane.kind().name(), "transverse Mercator");
        assert!((settings(&window).domain.bounds.size().x - 40_000.0).abs() < 4_000.0);
    }
}

#[test]
fn depths_that_are_too_wide_for_a_plane_say_what_they_lack() {
    let file = grid("wide", [-180.0, -90.0], 180.0, Some(LONLAT));
    let (window, said) = begun_with(LayerCommand::OpenDepth(file));
    assert_eq!((settings(&window).unit, rule(&window)), (LengthUnit::Degree, DepthRule::Nothing));
    for part in ["too wide", "asks for no sizes", "in degrees", "“Domain in metres”"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn depths_in_a_document_without_metres_say_what_they_lack() {
    let file = grid("degrees", [0.0, 0.0], 1.0, Some(LONLAT));
    for unit in [LengthUnit::None, LengthUnit::Degree] {
        let mut window = window_of(TALL);
        send(&mut window, Command::from(EditCommand::Set(Setting::LengthUnit(unit))));
        send(&mut window, Command::from(LayerCommand::OpenDepth(file.clone())));
        wait_until(&mut window, |window| active(window).kind.is::<Depths>());
        let said = wait_for_notice(&mut window);
        assert!(said.contains("asks for no sizes") && said.contains("“Depth of water”"), "{unit:?}: {said}");
        assert_eq!(rule(&window), DepthRule::Nothing);
    }
}

#[test]
fn the_way_to_metres_that_an_error_names_is_in_the_window() {
    let (mut window, _) = begun_with(LayerCommand::OpenDepth(grid("unit", [1e5, 1e5], 2e4, None)));
    assert_eq!(rule(&window), DepthRule::DEFAULT_WAVELENGTH);
    send(&mut window, Command::from(EditCommand::Set(Setting::LengthUnit(LengthUnit::Degree))));
    let problem = wait_for_notice(&mut window);
    assert!(problem.contains("“Domain in metres”") && problem.contains("in the window"), "{problem}");
    assert_eq!(settings(&window).unit, LengthUnit::None);
    let titles = crate::app::features::ROWS.iter().flat_map(|row| row.roles).map(|role| role.title);
    let titles: Vec<&str> = titles.collect();
    assert!(titles.contains(&"Domain in metres") && titles.contains(&"Depth of water"), "{titles:?}");
    assert!(window.query_by_label_contains("need a document in metres").is_none());
}

/// Returns the pieces of the boundary once the contour of the selected layer is the domain.
fn pieces_of_contour(window: &mut Window) -> BoundaryPieces {
    let before = settings(window).domain.clone();
    begin_contour(window);
    step_until(window, |window| settings(window).domain != before);
    assert_eq!(notice(window), "The domain was replaced: it is the contour of depths.asc.");
    let settings = settings(window);
    BoundaryPieces::of_domain(&settings.domain, &settings.boundary_marks).unwrap()
}

#[test]
fn the_sea_of_a_grid_in_degrees_stays_open_in_metres() {
    for (test, place) in
        [("contour", [-6.0, 48.0]), ("contour-north", [10.0, 74.0]), ("contour-south", [60.0, -70.0])]
    {
        let (mut window, _) = begun_with(LayerCommand::OpenDepth(grid(test, place, 2.0, Some(LONLAT))));
        let pieces = pieces_of_contour(&mut window);
        let names: Vec<&str> = pieces.list().iter().map(|piece| piece.name.as_str()).collect();
        assert_eq!(names, ["open south", "open east", "open north", "mainland"], "{test}");
        // The shore is between the first columns.
        let plane = settings(&window).domain.projection.unwrap();
        let shore = plane.geographic_from_plane(pieces.list()[3].middle());
        assert!((shore.x - place[0] - 0.1).abs() < 0.06, "{test}: {shore}");
    }
}

#[test]
fn a_contour_without_an_open_side_is_told() {
    let file = grid("lake", [0.0, 0.0], 1.0, None);
    let rows = ["9 9 9 9 9", "9 9 -5 9 9", "9 -5 -5 -5 9", "9 9 -5 9 9", "9 9 9 9 9"];
    let header = "ncols 5\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 0.2\n";
    fs::write(&file, header.to_owned() + &rows.join("\n")).unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::from(LayerCommand::OpenDepth(file)));
    wait_until(&mut window, |window| active(window).kind.is::<Depths>());
    begin_contour(&mut window);
    step_until(&mut window, |window| notice(window).contains("Nothing of its boundary is open"));
}
