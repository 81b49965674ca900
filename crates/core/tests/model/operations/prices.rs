//! The price of a stroke against what it then costs, between edits of any kind.

use glam::dvec2;
use meshbrush_core::document::{Document, Follower, Price, Pricer};
use meshbrush_core::paint::{Brush, DiameterChange, Medium, Mirror, StrokePlan};
use meshbrush_mesh::mesh::Progress;

/// Returns the plan of a stroke by its number: of all kinds of brushes, at places that fill the square.
fn plan(number: usize) -> StrokePlan {
    let diameter = |change| Medium::Diameter(0.03, change);
    let media = [
        Medium::Risk(1.0),
        diameter(DiameterChange::Finer),
        Medium::Eraser,
        diameter(DiameterChange::Any),
        diameter(DiameterChange::Coarser),
        Medium::Error(1e-3),
    ];
    let share = |step: f64| (number as f64 * step).fract();
    let radius = 0.01 + 0.08 * share(0.367);
    let brush = Brush { medium: media[number % media.len()], radius, hardness: share(0.29), strength: 1.0 };
    let from = dvec2(share(0.618), share(0.414));
    let to = if number.is_multiple_of(3) { from + 0.05 * dvec2(1.0, share(0.7)) } else { from };
    StrokePlan { brush, mirror: Mirror::default(), from, to }
}

/// Prices two strokes with a pricer that has answered before, and paints the second one on copies of a
/// document and of the follower that is in step with it. Returns whether the price could be compared.
pub fn check_price(pricer: &mut Pricer, number: usize, document: &Document, follower: &Follower) -> bool {
    let plan = plan(number);
    // The pointer was elsewhere before, perhaps not until the price was known.
    let before = plan.from + [0.02, 0.12, -0.2][number % 3];
    let brush = Brush { medium: Medium::Diameter(0.02, DiameterChange::Finer), ..plan.brush };
    pricer.ask(Some(StrokePlan::click(brush, before)), document, follower);
    for _ in 0..[1, 3, 1_000][number / 3 % 3] {
        if pricer.advance(document, follower, 1 << (4 + number % 10)) == Progress::Done {
            break;
        }
    }
    pricer.ask(Some(plan), document, follower);
    while pricer.advance(document, follower, 1 << (5 + number % 9)) == Progress::More {}
    let expected = match pricer.price() {
        Some(Price::Change(change)) => change,
        Some(Price::Nothing(_)) => 0,
        _ => return false,
    };

    let (mut document, mut follower) = (document.clone(), follower.clone());
    let before = follower.mesh().triangle_count() as i64;
    document.begin_stroke(plan.brush);
    [plan.from, plan.to].into_iter().for_each(|point| document.draw_to(point));
    document.end_stroke();
    loop {
        match follower.advance(&mut document, 10_000) {
            Ok(stage) if stage.is_settled() => break,
            Ok(_) => {}
            // Nothing is said of a mesh that does not fit the budget.
            Err(_) => return false,
        }
    }
    assert_eq!(follower.mesh().triangle_count() as i64 - before, expected, "stroke {number}: {plan:?}");
    true
}
