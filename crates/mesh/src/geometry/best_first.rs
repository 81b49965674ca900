use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The parts of a region that are still to be searched, the one with the lowest bound first.
///
/// Branch and bound looks for a least value: each part has a bound below which it has no value, and is
/// divided when its turn comes. As the part with the lowest bound is always the next, no value of the
/// region is below that bound, and a search that stops there has looked at the fewest parts that its bounds
/// allow.
///
/// The order depends on the bounds and on the order of the calls alone: of parts with equal bounds, the one
/// that was added last is the next.
///
/// ```text
///   +-------+---+---+      5: not looked at any more once a value of at most 5 is known
///   |       | 3 | 4 |
///   |   5   +---+---+      2: the next to be divided; no value anywhere is below 2
///   |       | 2 | 7 |
///   +-------+---+---+
/// ```
#[derive(Clone, Debug)]
pub struct BestFirst<T> {
    heap: BinaryHeap<OpenPart<T>>,
    added: u32,
}

#[derive(Clone, Debug)]
struct OpenPart<T> {
    bound: f64,
    number: u32,
    part: T,
}

impl<T> Default for BestFirst<T> {
    fn default() -> Self {
        Self { heap: BinaryHeap::new(), added: 0 }
    }
}

impl<T> BestFirst<T> {
    /// Adds a part in which no value is below `bound`.
    pub fn push(&mut self, bound: f64, part: T) {
        self.added = self.added.wrapping_add(1);
        self.heap.push(OpenPart { bound, number: self.added, part });
    }

    /// Takes the part with the lowest bound. No value of all parts is below that bound.
    pub fn pop(&mut self) -> Option<(f64, T)> {
        self.heap.pop().map(|OpenPart { bound, part, .. }| (bound, part))
    }

    /// Returns the parts that are left with their bounds, in no particular order.
    pub fn into_parts(self) -> impl Iterator<Item = (f64, T)> {
        self.heap.into_iter().map(|OpenPart { bound, part, .. }| (bound, part))
    }

    /// Returns the number of parts that are left.
    pub fn len(&self) -> usize {
        self.heap.len()
    }

    /// Returns whether no part is left.
    pub fn is_empty(&self) -> bool {
        self.heap.is_empty()
    }
}

impl<T> Ord for OpenPart<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        // The heap takes the greatest.
        other.bound.total_cmp(&self.bound).then(self.number.cmp(&other.number))
    }
}

impl<T> PartialOrd for OpenPart<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for OpenPart<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for OpenPart<T> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_bound_comes_first_and_of_equal_ones_the_latest() {
        let mut parts = BestFirst::default();
        for (bound, name) in [(2.0, 'a'), (1.0, 'b'), (f64::INFINITY, 'c'), (1.0, 'd'), (-0.5, 'e')] {
            parts.push(bound, name);
        }
        assert_eq!(parts.len(), 5);
        let mut left: Vec<char> = parts.clone().into_parts().map(|(_, name)| name).collect();
        left.sort_unstable();
        assert_eq!(left, ['a', 'b', 'c', 'd', 'e']);
        let order: String = std::iter::from_fn(|| parts.pop()).map(|(_, name)| name).collect();
        assert_eq!(order, "edbac");
        assert!(parts.is_empty());
    }
}
