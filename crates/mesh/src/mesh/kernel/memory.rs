//! Memory of large arrays, and the behaviour when the system has no more memory. Room for an array is
//! reserved once; the system provides the pages, large ones if possible, when they are first written.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::Write;
use std::mem::MaybeUninit;
use std::sync::atomic::{AtomicIsize, AtomicUsize, Ordering};

use super::{LimitError, Mesh};

/// A large page, in bytes. Arrays that fit one grow by doubling, in memory that the allocator has at hand.
const PAGE: usize = 2 << 20;

impl Mesh {
    /// Makes room for at least `more` further triangles and as many nodes, and never for more than `most`
    /// triangles unless `more` requires it. Returns the number of triangles that fit before this must be
    /// called again.
    ///
    /// # Errors
    /// Fails when the system has no more memory.
    ///
    /// A large mesh reserves all it may ever need in one step: untouched memory costs nothing, and the arrays
    /// never move again. With large pages this takes a third off the time to build two million triangles.
    #[cold]
    pub(in crate::mesh) fn make_room(&mut self, more: usize, most: usize) -> Result<usize, LimitError> {
        try_make_room(&mut self.triangles, more, most)?;
        // A bisection makes one node, and one or two triangles.
        try_make_room(&mut self.nodes, more, most)?;
        try_make_room(&mut self.triangle_at, more, most)?;
        let room_for_nodes = self.nodes.capacity().min(self.triangle_at.capacity()) - self.nodes.len();
        Ok(self.triangles.capacity().min(self.triangles.len() + room_for_nodes))
    }
}

impl Mesh {
    /// Returns to the system the memory that a larger mesh has left behind, but keeps room to double.
    #[cold]
    pub(in crate::mesh) fn give_memory_back(&mut self) {
        self.triangles.shrink_to(2 * self.triangles.len());
        self.nodes.shrink_to(2 * self.nodes.len());
        self.triangle_at.shrink_to(2 * self.triangle_at.len());
    }

    /// Returns the memory that nodes and triangles take, in bytes: 38 for each triangle, more where the mesh
    /// was larger a while ago. What is reserved and was never touched does not count.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.triangles) + size_of_val(&*self.nodes) + size_of_val(&*self.triangle_at)
    }
}

/// Makes room as [`try_make_room`] does, and ends the program where the system has no more memory.
pub(in crate::mesh) fn make_room<T>(array: &mut Vec<T>, more: usize, most: usize) {
    if try_make_room(array, more, most).is_err() {
        array.reserve(more);
    }
}

/// Makes room for `more` further entries, and where the array is large at once for `most` in all.
///
/// # Errors
/// Fails when the system has no more memory.
pub(in crate::mesh) fn try_make_room<T>(
    array: &mut Vec<T>,
    more: usize,
    most: usize,
) -> Result<(), LimitError> {
    if array.capacity() - array.len() >= more {
        return Ok(());
    }
    let (size, most) = (size_of::<T>(), most.max(array.len() + more));
    // Windows charges for a reservation as if it were used, and WebAssembly takes the memory at once.
    if !cfg!(any(windows, target_family = "wasm")) && size * 2 * (array.len() + more) > PAGE {
        // The system may refuse to promise that much: ask for less, down to doubling.
        let mut wanted = most;
        while wanted > 2 * array.len() + more {
            if may_fail(|| array.try_reserve_exact(wanted - array.len())).is_ok() {
                advise_large_pages(array);
                return Ok(());
            }
            wanted /= 4;
        }
    }
    let bytes = size * (array.len() + more);
    may_fail(|| array.try_reserve(more)).map_err(|_| LimitError::OutOfMemory { bytes })
}

thread_local! {
    /// Whether the caller handles a lack of memory itself.
    static MAY_FAIL: Cell<bool> = const { Cell::new(false) };
}

/// Runs `reserve`, which handles a lack of memory itself.
fn may_fail<T>(reserve: impl FnOnce() -> T) -> T {
    MAY_FAIL.set(true);
    let result = reserve();
    MAY_FAIL.set(false);
    result
}

/// The allocator of the program: that of the system. When the system has no more memory, it ends the program
/// with a sentence and exit status 1, where Rust would abort by default.
#[derive(Debug)]
pub struct ProgramAllocator;

/// Most bytes in use at a time, where there is a limit.
static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);
/// Bytes in use, where there is a limit; memory from before it counts as negative when it is freed.
static USED: AtomicIsize = AtomicIsize::new(0);

/// Whether there is a limit: without one, nothing is counted.
#[inline]
fn is_limited() -> bool {
    LIMIT.load(Ordering::Relaxed) != usize::MAX
}

/// Notes that more is used, where that is within the limit.
fn take(bytes: usize) -> bool {
    let used = USED.fetch_add(bytes as isize, Ordering::Relaxed) + bytes as isize;
    let is_within = used <= LIMIT.load(Ordering::Relaxed) as isize;
    if !is_within {
        free(bytes);
    }
    is_within
}

fn free(bytes: usize) {
    USED.fetch_sub(bytes as isize, Ordering::Relaxed);
}

impl ProgramAllocator {
    /// Limits the memory of this process from now on, in bytes. Beyond the limit, the program behaves as if
    /// the system had no more memory.
    pub fn limit(bytes: usize) {
        USED.store(0, Ordering::Relaxed);
        LIMIT.store(bytes.min(isize::MAX as usize), Ordering::Relaxed);
    }

    /// Makes large arrays return to the system when they are freed. Once some were freed, the allocator of
    /// GNU/Linux would keep those of up to 32 MiB: a quarter of the memory of the program after a path
    /// through two million triangles.
    pub fn give_large_arrays_back() {
        // SAFETY: this only sets the size from which the allocator maps pages for an allocation of its own.
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        #[allow(unsafe_code, reason = "a setting of the allocator has no safe interface")]
        unsafe {
            libc::mallopt(libc::M_MMAP_THRESHOLD, 4 * PAGE as i32)
        };
    }
}

impl ProgramAllocator {
    /// Returns memory that was freed to the system, where the allocator keeps it otherwise. Takes some
    /// milliseconds for each gigabyte.
    pub fn return_freed_memory() {
        // SAFETY: this only returns pages that no allocation uses.
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        #[allow(unsafe_code, reason = "the allocator has no safe interface")]
        unsafe {
            libc::malloc_trim(0)
        };
    }
}

// SAFETY: calls are passed on to the allocator of the system unchanged, and so are its results; or the answer
// is null, as when the system has no memory.
#[allow(unsafe_code, reason = "an allocator has no safe interface")]
unsafe impl GlobalAlloc for ProgramAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the rules of this function, which are those of the system's.
        given(layout.size(), || unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        given(layout.size(), || unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        let new = given(size, || unsafe { System.realloc(place, layout, size) });
        if is_limited() && !new.is_null() {
            free(layout.size());
        }
        new
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        if is_limited() {
            free(layout.size());
        }
        // SAFETY: as above.
        unsafe { System.dealloc(place, layout) }
    }
}

/// Returns the memory that the system gives, within the limit. If it is null and no caller handles that, this
/// ends the program with a message.
#[inline]
fn given(bytes: usize, ask: impl FnOnce() -> *mut u8) -> *mut u8 {
    let place = if is_limited() && !take(bytes) { std::ptr::null_mut() } else { ask() };
    if place.is_null() && !MAY_FAIL.get() {
        end_without_memory(bytes);
    }
    place
}

/// Ends the program. Nothing here allocates.
#[cold]
fn end_without_memory(bytes: usize) -> ! {
    let limit = LIMIT.swap(usize::MAX, Ordering::Relaxed);
    if limit != usize::MAX {
        let _ = writeln!(
            std::io::stderr(),
            "meshbrush: This takes more than {} MB of memory, which is the limit here.",
            limit / 1_000_000
        );
        std::process::exit(1)
    }
    let _ = writeln!(
        std::io::stderr(),
        "meshbrush: Memory ran out: the system has no {bytes} bytes more. Make the mesh coarser, allow fewer triangles or less \
         memory for it, or close other programs. Files that were being written are unchanged."
    );
    std::process::exit(1)
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

/// A part of the room behind an array, to be filled from its beginning.
pub(in crate::mesh) struct SpareRoom<'a, T> {
    slots: &'a mut [MaybeUninit<T>],
    filled: usize,
}

impl<T: Copy> SpareRoom<'_, T> {
    /// Fills the next places.
    ///
    /// # Panics
    /// Panics when there is less room.
    pub(in crate::mesh) fn extend(&mut self, values: impl ExactSizeIterator<Item = T>) {
        let count = values.len();
        let places = &mut self.slots[self.filled..self.filled + count];
        let written = places.iter_mut().zip(values).map(|(place, value)| place.write(value)).count();
        assert_eq!(written, count, "the iterator has as many values as it says");
        self.filled += count;
    }
}

/// Appends pieces of the given lengths to an array. `fill` gets the entries that are there already and the
/// pieces; it must fill all of them, in any order and on any threads: memory that was not touched before is
/// then mapped by all of them.
///
/// # Panics
/// Panics when a piece is not full in the end.
pub(in crate::mesh) fn append_pieces<T: Copy>(
    array: &mut Vec<T>,
    lengths: impl Iterator<Item = usize> + Clone,
    fill: impl FnOnce(&mut [T], &mut [SpareRoom<T>]),
) {
    let total = lengths.clone().sum();
    array.reserve(total);
    let (present, room) = present_and_room(array);
    let mut room = &mut room[..total];
    let mut pieces = Vec::new();
    for length in lengths {
        let (slots, rest) = room.split_at_mut(length);
        pieces.push(SpareRoom { slots, filled: 0 });
        room = rest;
    }
    assert!(room.is_empty(), "the lengths are the same each time");
    fill(present, &mut pieces);
    assert!(pieces.iter().all(|piece| piece.filled == piece.slots.len()), "all pieces are full");
    let length = array.len() + total;
    // SAFETY: the pieces were the first `total` places of the room behind the array, without gaps, and each
    // is full: `filled` counts places that were written, in order. The room is at least so long.
    #[allow(unsafe_code, reason = "a safe append would write all of it twice, on one thread")]
    unsafe {
        array.set_len(length);
    }
}

/// Returns the entries of an array and the room behind them.
fn present_and_room<T>(array: &mut Vec<T>) -> (&mut [T], &mut [MaybeUninit<T>]) {
    let (length, capacity, start) = (array.len(), array.capacity(), array.as_mut_ptr());
    // SAFETY: both slices lie in the one allocation of `array`, which is borrowed exclusively as long as they
    // live, and they do not overlap. The first `length` entries are initialized; the others need not be.
    #[allow(unsafe_code, reason = "Vec::split_at_spare_mut is not stable")]
    unsafe {
        let room = std::slice::from_raw_parts_mut(start.add(length).cast(), capacity - length);
        (std::slice::from_raw_parts_mut(start, length), room)
    }
}
