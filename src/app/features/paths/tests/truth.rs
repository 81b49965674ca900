//! The panel of a path says what is so: about outdated paths, proofs, digits, and coasts.

use std::sync::Arc;

use eframe::egui::Modifiers;
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::{GOAL, Window, row, shown, wait_for_paths, window_with_path};
use crate::app::features::paths::{PathCommand, Paths};
use crate::app::tests::tips::unexplained;
use crate::app::tests::{
    click, click_button, entries, move_to, notice, press, release, send, set, settings, type_into, wait_until,
};
use meshbrush_core::document::{PathCost, Setting};
use meshbrush_core::domain::{BoundaryTreatment, Domain, DomainShape, Region};
use meshbrush_core::path::{Solution, Weights};
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_mesh::geometry::{Rect, nearest_on_segment};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::format;

fn says(window: &Window, text: &str) -> bool {
    window.query_by_label_contains(text).is_some()
}

#[test]
fn a_path_with_an_error_is_not_called_up_to_date() {
    let mut window = window_with_path();
    assert!(says(&window, "Path and bound are up to date."));
    press(&mut window, GOAL, Modifiers::NONE);
    move_to(&mut window, dvec2(0.9, 1.05));
    release(&mut window, dvec2(0.9, 1.05));
    wait_until(&mut window, |window| shown(window)[0].problem.is_some());
    window.run();
    assert!(says(&window, "The path that is shown is outdated."));
    assert!(!says(&window, "up to date") && says(&window, "The figures are those of the outdated path."));
    let problem = shown(&window)[0].problem.clone().unwrap().to_string();
    let longest = problem.split([' ', '(', ')', ',']).map(str::len).max();
    assert!(longest < Some(13), "digits that nobody reads: {problem}");
}

#[test]
fn the_highest_risk_is_the_top_of_the_plot_and_the_interval_has_two_ends() {
    let window = window_with_path();
    let found = shown(&window)[0].found.as_ref().unwrap();
    let top = found.profile.iter().map(|sample| sample.risk).fold(0.0, f64::max);
    assert!(top >= found.solution.highest_risk);
    assert_eq!(row(&window, "Highest risk"), format::significant(top, 4));
    let interval = row(&window, "Least possible cost");
    let (lower, upper) = interval.split_once(" … ").unwrap();
    assert_ne!(lower, upper);
    let number = |text: &str| text.replace(',', "").parse::<f64>().unwrap();
    assert!(number(&row(&window, "Cost")) >= number(upper), "{} and {interval}", row(&window, "Cost"));
}

/// Puts another path in the place of the one that was shown before a proof.
fn exchange(window: &mut Window, former: Solution) {
    let paths = &mut window.state_mut().features.get_mut::<Paths>();
    paths.finder.set_former(0, former);
    window.run();
}

#[test]
fn a_proof_that_exchanges_the_path_says_so_and_the_former_one_can_be_kept() {
    let way = dvec2(0.12, 0.88);
    let former = {
        let mut window = window_with_path();
        click(&mut window, way, Modifiers::COMMAND);
        wait_for_paths(&mut window);
        shown(&window)[0].found.clone().unwrap().solution
    };
    for by_message in [true, false] {
        let mut window = window_with_path();
        assert!(!says(&window, "Path before the proof"));
        let places = settings(&window).paths.routes[0].clone();
        let cost = shown(&window)[0].found.as_ref().unwrap().solution.cost;
        let mut direct = former.clone();
        direct.stops = vec![0, former.points.len() - 1];
        exchange(&mut window, direct);
        let less = format::percent_above(1.0 - cost / former.cost);
        let text = format!("The proof of Path 1 found a path that costs {less} less, and shows that one.");
        assert_eq!(notice(&window), text);
        let gestures = entries(&window);
        match by_message {
            true => click_button(&mut window, "Keep the former"),
            false => click_button(&mut window, "Path before the proof"),
        }
        let kept = settings(&window).paths.routes[0].clone();
        assert_eq!((kept.len(), kept[0], kept[2]), (3, places[0], places[1]));
        assert!(kept[1].distance(way) < 0.1, "{}", kept[1]);
        assert_eq!(entries(&window), gestures + 1);
        send(&mut window, Command::from(EditCommand::Undo));
        assert_eq!(settings(&window).paths.routes[0], places);
    }
}

#[test]
fn on_a_coast_the_path_keeps_the_clearance_that_is_typed() {
    let mut window = window_with_path();
    let shortest = PathCost::Weighted(Weights { length: 1.0, risk: 0.0 });
    send(&mut window, Command::from(PathCommand::Cost(shortest)));
    // A cape on the straight way, which large triangles would cut.
    let cape = [dvec2(1.0, 0.0), dvec2(1.0, 0.1), dvec2(0.48, 0.52), dvec2(0.9, 0.0)];
    let ring = [dvec2(0.0, 0.0), cape[3], cape[2], cape[1], dvec2(1.0, 1.0), dvec2(0.0, 1.0)];
    let region = Arc::new(Region::new(&[vec![ring.to_vec()]], Rect::UNIT));
    set(
        &mut window,
        Setting::Domain(Domain { bounds: Rect::UNIT, shape: DomainShape::Region(region), projection: None }),
    );
    set(&mut window, Setting::Boundary(BoundaryTreatment::OnOutline { diameter: 0.1 }));
    wait_for_paths(&mut window);
    let from_tip = |window: &Window| {
        let points = &shown(window)[0].found.as_ref().unwrap().solution.points;
        let distance = |pair: &[DVec2]| cape[2].distance(nearest_on_segment(cape[2], [pair[0], pair[1]]));
        points.windows(2).map(distance).fold(f64::INFINITY, f64::min)
    };
    assert!((0.0..0.03).contains(&from_tip(&window)), "{}", from_tip(&window));
    type_into(&mut window, "Clearance", "0.1");
    assert_eq!(settings(&window).paths.clearance, 0.1);
    assert_eq!(unexplained(&window), [""; 0]);
    wait_for_paths(&mut window);
    assert!((0.1..0.13).contains(&from_tip(&window)), "{}", from_tip(&window));
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(settings(&window).paths.clearance, 0.0);
    wait_for_paths(&mut window);
    assert!(from_tip(&window) < 0.03, "{}", from_tip(&window));
    // Within the clearance the start is refused, and the sentence says how far it is.
    type_into(&mut window, "Clearance", "0.9");
    wait_until(&mut window, |window| shown(window)[0].problem.is_some());
    window.run();
    assert!(says(&window, "and the clearance of paths is 0.9."));
}

#[test]
fn a_speed_gives_the_time_and_a_projection_the_length_on_the_ellipsoid() {
    let mut window = window_with_path();
    assert!(!says(&window, "Speed"), "without a unit there is no time");
    set(&mut window, Setting::LengthUnit(LengthUnit::Kilometre));
    wait_for_paths(&mut window);
    type_into(&mut window, "Speed", "1");
    let found = |window: &Window| shown(window)[0].found.clone().unwrap();
    let minutes = found(&window).solution.length * 60.0 / 1.852;
    assert_eq!(row(&window, "Time"), format!("{minutes:.0} min"));
    assert_eq!(unexplained(&window), [""; 0]);
    assert_eq!(found(&window).length_on_the_ellipsoid(), None);
    // In this plane, lengths are 0.04 % shorter than on the ellipsoid.
    let projection = "+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m".parse().ok();
    set(&mut window, Setting::LengthUnit(LengthUnit::Metre));
    set(&mut window, Setting::Domain(Domain { projection, ..Domain::rectangle(Rect::UNIT) }));
    wait_for_paths(&mut window);
    let ratio = found(&window).length_on_the_ellipsoid().unwrap() / found(&window).solution.length;
    assert!((ratio * 0.9996 - 1.0).abs() < 1e-9, "{ratio}");
    assert_eq!(row(&window, "Time"), "0 min");
}

#[test]
fn what_lacks_a_path_names_the_key_that_works() {
    let mut window = window_with_path();
    send(&mut window, Command::from(PathCommand::DeleteAll));
    send(&mut window, Command::from(PathCommand::AddCorridor));
    let text = notice(&window);
    assert_eq!(text, "There is no path: set its start and goal with the path tool (P).");
}
