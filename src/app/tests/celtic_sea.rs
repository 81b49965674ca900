//! The example of a sea with its depths.

use std::collections::BTreeSet;
use std::path::Path;

use super::{send, settings, triangles, window};
use crate::app::files;
use meshbrush_core::document::{Example, Settings};
use meshbrush_core::domain::{BoundaryKind, BoundaryPieces};
use meshbrush_core::layers::NodeDepths;
use meshbrush_io::io::{Meter, recipe};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::view::FieldOverlay;

#[test]
fn the_recipe_of_the_celtic_sea_is_the_example() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/celtic_sea.toml");
    let opened = recipe::open(&file, &Meter::default()).unwrap().document;
    let example = files::example(Example::CelticSea);
    let name = example.settings().name.clone();
    let recipe = Settings { name, ..opened.settings().clone() };
    for (of_recipe, of_example) in recipe.layers.iter().zip(&example.settings().layers) {
        assert!(of_recipe == of_example, "the layer {} differs", of_example.name);
    }
    assert_eq!(recipe.boundary_marks, example.settings().boundary_marks);
    assert!(recipe == *example.settings(), "other settings differ");
}

#[test]
fn every_piece_of_the_boundary_of_the_celtic_sea_has_a_name() {
    let example = files::example(Example::CelticSea);
    let Settings { domain, boundary_marks, .. } = example.settings();
    let pieces = BoundaryPieces::of_domain(domain, boundary_marks).unwrap();
    let given: BTreeSet<&str> = boundary_marks.names.iter().map(|(_, name)| name.as_str()).collect();
    let shown: BTreeSet<&str> = pieces.list().iter().map(|piece| piece.name.as_str()).collect();
    assert_eq!(shown, given);
    let open = pieces.list().iter().filter(|piece| piece.kind == BoundaryKind::Open);
    assert_eq!(open.count(), 4);
}

#[test]
fn the_celtic_sea_opens_with_its_depths_and_ends_them_with_the_next_example() {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::OpenExample(Example::CelticSea)));
    assert_eq!(window.state().view().overlay, FieldOverlay::Depth);
    assert!((20_000..150_000).contains(&triangles(&window)), "{}", triangles(&window));
    let mesh = window.state().session().mesh();
    let depths = NodeDepths::of(&settings(&window).layers, mesh.extract().view()).unwrap().unwrap();
    let deepest = depths.depths.iter().copied().fold(0.0, f64::max);
    assert!((150.0..300.0).contains(&deepest), "{deepest} m in the south-west");
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Threats)));
    assert_eq!(window.state().view().overlay, FieldOverlay::None);
}
