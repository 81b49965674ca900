/// Disjoint sets of numbers.
#[derive(Clone, Debug)]
pub(super) struct Forest {
    /// Roots point to themselves, and never to a higher number.
    parents: Vec<u32>,
}

impl Forest {
    pub(super) fn new(count: usize) -> Self {
        Self { parents: (0..count as u32).collect() }
    }

    pub(super) fn is_root(&self, n: usize) -> bool {
        self.parents[n] as usize == n
    }

    pub(super) fn root(&mut self, mut n: usize) -> usize {
        while !self.is_root(n) {
            // Halves the way for the next time.
            self.parents[n] = self.parents[self.parents[n] as usize];
            n = self.parents[n] as usize;
        }
        n
    }

    pub(super) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = a.min(b) as u32;
    }
}
