//! Numbers for nodes and triangles of a mesh: for all of them, or for few.

/// A number for some entries of an array.
pub(super) trait Numbers: Sync {
    /// Returns no numbers yet, for an array of this length.
    fn for_entries(count: usize) -> Self;
    /// Returns the number of an entry.
    fn get(&self, index: usize) -> Option<u32>;
    /// Gives an entry a number, and returns whether it had none.
    fn set(&mut self, index: usize, number: u32) -> bool;
}

/// Numbers plus one, so that the pages of entries without one are never touched.
impl Numbers for Vec<u32> {
    fn for_entries(count: usize) -> Self {
        vec![0; count]
    }

    #[inline]
    fn get(&self, index: usize) -> Option<u32> {
        self[index].checked_sub(1)
    }

    #[inline]
    fn set(&mut self, index: usize, number: u32) -> bool {
        std::mem::replace(&mut self[index], number + 1) == 0
    }
}

/// Entries of a page of [`Pages`].
const PAGE: usize = 128;

/// Numbers of few entries of a long array: only the pages that have some are kept. Entries near each other on
/// the plane are mostly near each other in the arrays of a mesh.
pub(super) struct Pages {
    /// For each page of the array, its place among those that are kept; 0 if it has no numbers.
    places: Vec<u32>,
    /// The pages, with numbers plus one. The first one stays empty.
    numbers: Vec<[u32; PAGE]>,
}

impl Numbers for Pages {
    fn for_entries(count: usize) -> Self {
        Self { places: vec![0; count.div_ceil(PAGE)], numbers: vec![[0; PAGE]] }
    }

    #[inline]
    fn get(&self, index: usize) -> Option<u32> {
        self.numbers[self.places[index / PAGE] as usize][index % PAGE].checked_sub(1)
    }

    #[inline]
    fn set(&mut self, index: usize, number: u32) -> bool {
        let place = &mut self.places[index / PAGE];
        if *place == 0 {
            *place = self.numbers.len() as u32;
            self.numbers.push([0; PAGE]);
        }
        std::mem::replace(&mut self.numbers[*place as usize][index % PAGE], number + 1) == 0
    }
}
