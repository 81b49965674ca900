//! Corners snap to lines and to the outline.

use eframe::egui::{Key, Modifiers};
use glam::{DVec2, dvec2};

use super::{draw, lines, tool, with_tool};
use crate::app::features::lines::{LineToolMode, LinesCommand};
use crate::app::tests::{
    Window, click, in_world, key, move_to, on_screen, painted_shapes, press, release, send, stroke,
};
use eframe::egui::{Shape, vec2};
use meshbrush_kit::kit::command::Command;
use meshbrush_mesh::geometry::nearest_on_segment;

const WALL: [DVec2; 2] = [dvec2(0.2, 0.3), dvec2(0.6, 0.47)];

/// Returns a place some points beside another one on the screen, in world units.
fn beside(window: &Window, place: DVec2, points: [f32; 2]) -> DVec2 {
    in_world(window, on_screen(window, place) + vec2(points[0], points[1]))
}

#[test]
fn a_corner_near_the_end_of_a_line_or_a_corner_of_the_outline_has_its_very_coordinates() {
    let mut window = with_tool(LineToolMode::Corners);
    draw(&mut window, &WALL);
    let wall = lines(&window)[0].points.clone();
    let (near_end, near_corner) =
        (beside(&window, wall[1], [4.0, -4.0]), beside(&window, DVec2::ZERO, [5.0, -4.0]));
    draw(&mut window, &[near_end, dvec2(0.8, 0.8), near_corner]);
    let joined = lines(&window)[1].points.clone();
    assert_eq!([joined[0], joined[2]], [wall[1], DVec2::ZERO], "equal bit for bit");
    assert_ne!(joined[0], near_end);
    // With Alt nothing snaps.
    for corner in [near_end, dvec2(0.9, 0.3)] {
        click(&mut window, corner, Modifiers::ALT);
    }
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(lines(&window)[2].points[0].distance(near_end) < 1e-6);
    // And without, where snapping is off.
    key(&mut window, Modifiers::NONE, Key::S);
    assert!(!tool(&window).snaps);
    draw(&mut window, &[near_end, dvec2(0.3, 0.8)]);
    assert!(lines(&window)[3].points[0].distance(near_end) < 1e-6);
}

#[test]
fn a_corner_near_a_segment_goes_to_its_nearest_point() {
    let mut window = with_tool(LineToolMode::Corners);
    draw(&mut window, &WALL);
    let wall = [lines(&window)[0].points[0], lines(&window)[0].points[1]];
    let near = beside(&window, wall[0].midpoint(wall[1]), [0.0, 5.0]);
    let near_side = beside(&window, dvec2(0.4, 0.0), [0.0, -5.0]);
    draw(&mut window, &[near, near_side]);
    let [on_wall, on_side] = [0, 1].map(|n| lines(&window)[1].points[n]);
    assert!(on_wall.distance(nearest_on_segment(near, wall)) < 1e-6, "{on_wall} {near}");
    assert!(on_side.y == 0.0 && (on_side.x - 0.4).abs() < 2e-3, "{on_side}");
    // Beyond the reach nothing happens.
    let far = beside(&window, wall[0].midpoint(wall[1]), [0.0, -14.0]);
    draw(&mut window, &[far, dvec2(0.9, 0.9)]);
    assert!(lines(&window)[2].points[0].distance(far) < 1e-6);
}

#[test]
fn a_mark_shows_where_the_corner_snaps() {
    let mut window = with_tool(LineToolMode::Corners);
    draw(&mut window, &WALL);
    send(&mut window, Command::from(LinesCommand::Select(None)));
    let corner = on_screen(&window, lines(&window)[0].points[1]);
    let squares = |window: &Window| {
        let shapes = painted_shapes(window.output());
        let is_mark = |shape: &&&Shape| match shape {
            Shape::Rect(rect) => rect.rect.center().distance(corner) < 0.5 && rect.rect.width() < 20.0,
            _ => false,
        };
        shapes.iter().filter(is_mark).count()
    };
    move_to(&mut window, dvec2(0.9, 0.9));
    assert_eq!(squares(&window), 0);
    let near = beside(&window, lines(&window)[0].points[1], [5.0, 3.0]);
    move_to(&mut window, near);
    assert_eq!(squares(&window), 2, "a square on a dark halo");
}

#[test]
fn a_dragged_corner_and_the_ends_of_a_line_by_free_hand_snap() {
    let mut window = with_tool(LineToolMode::Corners);
    draw(&mut window, &WALL);
    let wall = lines(&window)[0].points.clone();
    draw(&mut window, &[dvec2(0.7, 0.8), dvec2(0.9, 0.8)]);
    send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::Edit)));
    let near = beside(&window, wall[1], [-5.0, -2.0]);
    stroke(&mut window, dvec2(0.7, 0.8), near);
    assert_eq!(lines(&window)[1].points[0], wall[1]);
    send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::FreeHand)));
    let near = beside(&window, wall[0], [5.0, 2.0]);
    press(&mut window, near, Modifiers::NONE);
    for to in [dvec2(0.3, 0.6), dvec2(0.4, 0.7), dvec2(0.5, 0.9)] {
        move_to(&mut window, to);
    }
    release(&mut window, dvec2(0.5, 0.9));
    assert_eq!(lines(&window)[2].points[0], wall[0]);
}
