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

/// Entries of a page of [`Pages`], and pages of a chapter.
const PAGE: usize = 128;

/// Numbers of few entries of a long array: only the pages that have some are kept. Entries near each other on
/// the plane are mostly near each other in the arrays of a mesh.
///
/// ```text
///   chapters   0 0 2 0 1 …            for each 16,384 entries, the place of their pages
///                  └──▶ 0 0 5 0 …     for each 128 entries, the place of their numbers
///                           └──▶ …
/// ```
///
/// So there is little to clear before the first number, even where a mesh has millions of triangles: an
/// update of a coast makes a hundred such tables.
pub(super) struct Pages {
    /// For each chapter of the array, its place in `places`; 0 if it has no numbers.
    chapters: Vec<u32>,
    /// For each page of a chapter, its place in `numbers`; 0 if it has none. The first chapter stays empty.
    places: Vec<[u32; PAGE]>,
    /// The pages, with numbers plus one. The first one stays empty.
    numbers: Vec<[u32; PAGE]>,
}

/// Returns the chapter of an entry, its page in the chapter, and its place in the page.
#[inline]
fn position(index: usize) -> [usize; 3] {
    [index / (PAGE * PAGE), index / PAGE % PAGE, index % PAGE]
}

/// Returns the place of a new page if there is none yet.
#[inline]
fn place_in(pages: &mut Vec<[u32; PAGE]>, place: &mut u32) -> usize {
    if *place == 0 {
        *place = pages.len() as u32;
        pages.push([0; PAGE]);
    }
    *place as usize
}

impl Numbers for Pages {
    fn for_entries(count: usize) -> Self {
        let chapters = vec![0; count.div_ceil(PAGE * PAGE)];
        Self { chapters, places: vec![[0; PAGE]], numbers: vec![[0; PAGE]] }
    }

    #[inline]
    fn get(&self, index: usize) -> Option<u32> {
        let [chapter, page, place] = position(index);
        let pages = &self.places[self.chapters[chapter] as usize];
        self.numbers[pages[page] as usize][place].checked_sub(1)
    }

    #[inline]
    fn set(&mut self, index: usize, number: u32) -> bool {
        let [chapter, page, place] = position(index);
        let pages = place_in(&mut self.places, &mut self.chapters[chapter]);
        let page = place_in(&mut self.numbers, &mut self.places[pages][page]);
        std::mem::replace(&mut self.numbers[page][place], number + 1) == 0
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn pages_keep_the_numbers_of_a_table() {
        let mut random = fastrand::Rng::with_seed(2611);
        for count in [1, PAGE, PAGE * PAGE + 1, 5 * PAGE * PAGE] {
            let (mut pages, mut table) = (Pages::for_entries(count), BTreeMap::new());
            for _ in 0..2000 {
                // Some at the edges of pages and chapters.
                let near = [0, PAGE, PAGE * PAGE, count][random.usize(..4)];
                let index = if random.bool() {
                    random.usize(..count)
                } else {
                    near.saturating_sub(random.usize(..3))
                };
                let index = index.min(count - 1);
                assert_eq!(pages.get(index), table.get(&index).copied(), "{index} of {count}");
                let number = random.u32(..u32::MAX - 1);
                assert_eq!(
                    pages.set(index, number),
                    table.insert(index, number).is_none(),
                    "{index} of {count}"
                );
            }
            assert!((0..count).all(|index| pages.get(index) == table.get(&index).copied()), "{count}");
        }
    }
}
