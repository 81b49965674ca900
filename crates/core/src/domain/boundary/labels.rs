//! One label for each of the edges of a loop, so that neighbours rarely differ.

/// The labels that an edge of a loop may have.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    /// The labels, each with the cost of choosing it, in ascending order of the labels. At least one.
    pub(super) labels: Vec<(u32, f64)>,
    /// The cost if the next edge has another label.
    pub(super) change: f64,
}

/// Returns the labels of a closed loop with the least sum of costs, by dynamic programming; of equal sums,
/// the one with the lower labels. `start` is an edge with few labels, as each of them takes one pass over all
/// labels of all edges.
pub(super) fn cheapest_labels(choices: &[Choice], start: usize) -> Vec<u32> {
    let count = choices.len();
    let at = |n: usize| &choices[(start + n) % count];
    let mut best: Option<(f64, Vec<u32>)> = None;
    for first in 0..at(0).labels.len() {
        let (cost, path) = cheapest_path(&at, count, first);
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, path));
        }
    }
    let mut labels = best.map_or_else(Vec::new, |(_, path)| path);
    labels.rotate_right(start % count.max(1));
    labels
}

/// Returns the cheapest labels of a loop whose first edge has its label number `first`, and their cost.
fn cheapest_path<'a>(at: &impl Fn(usize) -> &'a Choice, count: usize, first: usize) -> (f64, Vec<u32>) {
    let first_label = at(0).labels[first].0;
    // For each edge and each of its labels, which label of the edge before is best.
    let mut before: Vec<Vec<usize>> = vec![Vec::new()];
    let mut costs: Vec<f64> = at(0).labels.iter().map(|_| f64::INFINITY).collect();
    costs[first] = at(0).labels[first].1;
    for n in 1..count {
        let (last, choice) = (at(n - 1), at(n));
        // The cheapest way with a change is one for all labels, and the only other way is without one.
        let changed = cheapest(costs.iter().map(|&cost| cost + last.change));
        let mut from = Vec::with_capacity(choice.labels.len());
        let mut next = Vec::with_capacity(choice.labels.len());
        for &(label, own) in &choice.labels {
            let same = last.labels.binary_search_by_key(&label, |&(other, _)| other);
            let unchanged = same.ok().map(|way| (way, costs[way]));
            let (way, cost) = cheaper(changed, unchanged);
            from.push(way);
            next.push(cost + own);
        }
        before.push(from);
        costs = next;
    }
    let last = at(count - 1);
    let closed =
        last.labels.iter().zip(&costs).map(|(&(label, _), &cost)| cost + change(last, label, first_label));
    let (mut way, cost) = cheapest(closed);
    let mut path = vec![0; count];
    for n in (0..count).rev() {
        path[n] = at(n).labels[way].0;
        way = before[n].get(way).copied().unwrap_or(0);
    }
    (cost, path)
}

fn change(choice: &Choice, label: u32, next: u32) -> f64 {
    if label == next { 0.0 } else { choice.change }
}

/// Returns the cheaper of two ways; of equal ones that with the lower place.
fn cheaper(a: (usize, f64), b: Option<(usize, f64)>) -> (usize, f64) {
    match b {
        Some((way, cost)) if (cost, way) < (a.1, a.0) => (way, cost),
        _ => a,
    }
}

/// Returns the least of some costs, and its place; of equal ones the first.
fn cheapest(costs: impl Iterator<Item = f64>) -> (usize, f64) {
    let least = |a: (usize, f64), b: (usize, f64)| if b.1 < a.1 { b } else { a };
    costs.enumerate().reduce(least).expect("an edge has a label")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the least sum over all labellings, and the first labelling that has it.
    fn by_trying_all(choices: &[Choice]) -> f64 {
        let all: usize = choices.iter().map(|choice| choice.labels.len()).product();
        let cost = |mut number: usize| {
            let picked: Vec<(u32, f64)> = choices
                .iter()
                .map(|choice| {
                    let label = choice.labels[number % choice.labels.len()];
                    number /= choice.labels.len();
                    label
                })
                .collect();
            sum(choices, &picked)
        };
        (0..all).map(cost).fold(f64::INFINITY, f64::min)
    }

    fn sum(choices: &[Choice], picked: &[(u32, f64)]) -> f64 {
        let next = picked.iter().cycle().skip(1);
        let changes = picked.iter().zip(next).zip(choices);
        let changes: f64 = changes.map(|((a, b), choice)| if a.0 == b.0 { 0.0 } else { choice.change }).sum();
        changes + picked.iter().map(|(_, cost)| cost).sum::<f64>()
    }

    #[test]
    fn the_cheapest_labels_are_found_wherever_the_loop_begins() {
        let mut random = fastrand::Rng::with_seed(11);
        for _ in 0..300 {
            let choices: Vec<Choice> = (0..random.usize(1..8))
                .map(|_| {
                    let all = (0..4).map(|label| (label, random.f64()));
                    let mut labels: Vec<(u32, f64)> = all.collect();
                    labels.retain(|_| random.bool());
                    labels.push((4, random.f64()));
                    Choice { labels, change: random.f64() }
                })
                .collect();
            let least = by_trying_all(&choices);
            for start in 0..choices.len() {
                let labels = cheapest_labels(&choices, start);
                let cost_of = |(choice, label): (&Choice, &u32)| {
                    *choice.labels.iter().find(|(other, _)| other == label).unwrap()
                };
                let picked: Vec<(u32, f64)> = choices.iter().zip(&labels).map(cost_of).collect();
                assert!(
                    (sum(&choices, &picked) - least).abs() < 1e-12,
                    "{choices:?} from {start}: {labels:?}"
                );
            }
        }
    }
}
