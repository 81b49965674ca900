//! Room for large arrays: reserved once, taken as it is touched, in large pages.

use super::Mesh;

/// A large page, in bytes. Arrays that fit one grow by doubling, in memory that the allocator has at hand.
const PAGE: usize = 2 << 20;

impl Mesh {
    /// Makes room for at least `more` further triangles and as many nodes, and never for more than `most`
    /// triangles unless `more` asks for it. Returns how many triangles there can be before this must be
    /// called again.
    ///
    /// A large mesh reserves all it may ever need in one step: untouched memory costs nothing, and the arrays
    /// never move again. With large pages this takes a third off the time to build two million triangles.
    #[cold]
    pub(in crate::mesh) fn make_room(&mut self, more: usize, most: usize) -> usize {
        make_room(&mut self.triangles, more, most);
        // A bisection makes one node, and one or two triangles.
        make_room(&mut self.nodes, more, most);
        make_room(&mut self.triangle_at, more, most);
        let room_for_nodes = self.nodes.capacity().min(self.triangle_at.capacity()) - self.nodes.len();
        self.triangles.capacity().min(self.triangles.len() + room_for_nodes)
    }
}

impl Mesh {
    /// Gives the memory back that a larger mesh has left behind, but for room to double.
    #[cold]
    pub(in crate::mesh) fn give_memory_back(&mut self) {
        self.triangles.shrink_to(2 * self.triangles.len());
        self.nodes.shrink_to(2 * self.nodes.len());
        self.triangle_at.shrink_to(2 * self.triangle_at.len());
    }

    /// Memory that nodes and triangles take, in bytes: 38 for each triangle, more where the mesh was larger a
    /// while ago. What is reserved and was never touched does not count.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.triangles) + size_of_val(&*self.nodes) + size_of_val(&*self.triangle_at)
    }
}

/// Makes room for `more` further entries, and where the array is large at once for `most` in all.
pub(in crate::mesh) fn make_room<T>(array: &mut Vec<T>, more: usize, most: usize) {
    if array.capacity() - array.len() >= more {
        return;
    }
    let (size, most) = (size_of::<T>(), most.max(array.len() + more));
    // Windows charges for a reservation as if it were used.
    if cfg!(windows) || size * 2 * (array.len() + more) <= PAGE {
        array.reserve(more);
        return;
    }
    // The system may refuse to promise so much: ask for less, down to doubling.
    let mut wanted = most;
    while wanted > 2 * array.len() + more {
        if array.try_reserve_exact(wanted - array.len()).is_ok() {
            advise_large_pages(array);
            return;
        }
        wanted /= 4;
    }
    array.reserve(more);
}

/// Asks the system to back the array with pages of 2 MiB: five hundred times fewer page faults and misses of
/// the address cache. Advice only: nothing depends on whether it is taken.
#[cfg(any(target_os = "linux", target_os = "android"))]
fn advise_large_pages<T>(array: &mut Vec<T>) {
    let start = array.as_mut_ptr() as usize;
    let end = start + array.capacity() * size_of::<T>();
    let (first, last) = (start.next_multiple_of(PAGE), end / PAGE * PAGE);
    if first < last {
        // SAFETY: the range lies within the one allocation of `array`, which is borrowed exclusively, and
        // MADV_HUGEPAGE leaves the contents of memory as they are.
        #[allow(unsafe_code, reason = "advice on pages has no safe interface")]
        unsafe {
            libc::madvise(first as *mut libc::c_void, last - first, libc::MADV_HUGEPAGE)
        };
    }
}

#[cfg(not(any(target_os = "linux", target_os = "android")))]
fn advise_large_pages<T>(_array: &mut Vec<T>) {}
