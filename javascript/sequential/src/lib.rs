//! What meshbrush uses of rayon, on one thread: a page has no others. Results are the same, as they are for
//! any number of threads.

use std::cmp::Ordering;
use std::iter::Sum;
use std::ops::Range;
use std::slice::{Chunks, ChunksMut, Iter, IterMut, Windows};
use std::vec::IntoIter;

/// The traits that give arrays and ranges their methods.
pub mod prelude {
    pub use super::{IntoParallelIterator, ParallelSlice, ParallelSliceMut};
}

/// Returns 1.
pub fn current_num_threads() -> usize {
    1
}

/// Does one after the other.
pub fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
    (first(), second())
}

/// Entries that rayon would give to several threads.
#[derive(Clone, Debug)]
pub struct Entries<I>(I);

/// What has entries.
pub trait IntoParallelIterator {
    /// An entry.
    type Item;
    /// The iterator of std over them.
    type Iter: Iterator<Item = Self::Item>;

    /// Returns the entries.
    fn into_par_iter(self) -> Entries<Self::Iter>;
}

impl<I: Iterator> IntoParallelIterator for Entries<I> {
    type Item = I::Item;
    type Iter = I;

    fn into_par_iter(self) -> Self {
        self
    }
}

impl<T> IntoParallelIterator for Vec<T> {
    type Item = T;
    type Iter = IntoIter<T>;

    fn into_par_iter(self) -> Entries<IntoIter<T>> {
        Entries(self.into_iter())
    }
}

impl<T> IntoParallelIterator for Range<T>
where
    Self: Iterator,
{
    type Item = <Self as Iterator>::Item;
    type Iter = Self;

    fn into_par_iter(self) -> Entries<Self> {
        Entries(self)
    }
}

macro_rules! borrowed {
    ($($array:ty),*) => {
        $(
            impl<'a, T> IntoParallelIterator for &'a $array {
                type Item = &'a T;
                type Iter = Iter<'a, T>;

                fn into_par_iter(self) -> Entries<Iter<'a, T>> {
                    Entries(self.iter())
                }
            }

            impl<'a, T> IntoParallelIterator for &'a mut $array {
                type Item = &'a mut T;
                type Iter = IterMut<'a, T>;

                fn into_par_iter(self) -> Entries<IterMut<'a, T>> {
                    Entries(self.iter_mut())
                }
            }
        )*
    };
}
borrowed!([T], Vec<T>);

/// Entries and parts of arrays.
pub trait ParallelSlice<T> {
    /// Returns the entries.
    fn par_iter(&self) -> Entries<Iter<'_, T>>;
    /// Returns parts of so many entries.
    fn par_chunks(&self, size: usize) -> Entries<Chunks<'_, T>>;
    /// Returns all runs of so many entries.
    fn par_windows(&self, size: usize) -> Entries<Windows<'_, T>>;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Entries<Iter<'_, T>> {
        Entries(self.iter())
    }

    fn par_chunks(&self, size: usize) -> Entries<Chunks<'_, T>> {
        Entries(self.chunks(size))
    }

    fn par_windows(&self, size: usize) -> Entries<Windows<'_, T>> {
        Entries(self.windows(size))
    }
}

/// Entries and parts of arrays that are changed.
pub trait ParallelSliceMut<T> {
    /// Returns the entries.
    fn par_iter_mut(&mut self) -> Entries<IterMut<'_, T>>;
    /// Returns parts of so many entries.
    fn par_chunks_mut(&mut self, size: usize) -> Entries<ChunksMut<'_, T>>;
    /// Sorts the entries.
    fn par_sort_unstable(&mut self)
    where
        T: Ord;
    /// Sorts the entries by keys.
    fn par_sort_unstable_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K);
    /// Sorts the entries by comparing them.
    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> std::cmp::Ordering);
}

impl<T> ParallelSliceMut<T> for [T] {
    fn par_iter_mut(&mut self) -> Entries<IterMut<'_, T>> {
        Entries(self.iter_mut())
    }

    fn par_chunks_mut(&mut self, size: usize) -> Entries<ChunksMut<'_, T>> {
        Entries(self.chunks_mut(size))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }

    fn par_sort_unstable_by_key<K: Ord>(&mut self, key: impl Fn(&T) -> K) {
        self.sort_unstable_by_key(key);
    }

    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> std::cmp::Ordering) {
        self.sort_unstable_by(compare);
    }
}

/// The methods have the names, and the meaning, that they have in rayon.
#[allow(missing_docs)]
impl<I: Iterator> Entries<I> {
    pub fn with_min_len(self, _: usize) -> Self {
        self
    }

    pub fn with_max_len(self, _: usize) -> Self {
        self
    }

    pub fn copied<'a, T: 'a + Copy>(self) -> Entries<impl Iterator<Item = T>>
    where
        I: Iterator<Item = &'a T>,
    {
        Entries(self.0.copied())
    }

    pub fn map<U>(self, act: impl FnMut(I::Item) -> U) -> Entries<impl Iterator<Item = U>> {
        Entries(self.0.map(act))
    }

    pub fn map_init<S, U>(
        self,
        mut init: impl FnMut() -> S,
        mut act: impl FnMut(&mut S, I::Item) -> U,
    ) -> Entries<impl Iterator<Item = U>> {
        let mut state = init();
        Entries(self.0.map(move |entry| act(&mut state, entry)))
    }

    pub fn filter(self, is_wanted: impl FnMut(&I::Item) -> bool) -> Entries<impl Iterator<Item = I::Item>> {
        Entries(self.0.filter(is_wanted))
    }

    pub fn filter_map<U>(self, act: impl FnMut(I::Item) -> Option<U>) -> Entries<impl Iterator<Item = U>> {
        Entries(self.0.filter_map(act))
    }

    pub fn flat_map_iter<U: IntoIterator>(
        self,
        act: impl FnMut(I::Item) -> U,
    ) -> Entries<impl Iterator<Item = U::Item>> {
        Entries(self.0.flat_map(act))
    }

    pub fn flatten_iter(self) -> Entries<impl Iterator<Item = <I::Item as IntoIterator>::Item>>
    where
        I::Item: IntoIterator,
    {
        Entries(self.0.flatten())
    }

    pub fn enumerate(self) -> Entries<impl Iterator<Item = (usize, I::Item)>> {
        Entries(self.0.enumerate())
    }

    pub fn zip<O: IntoParallelIterator>(self, other: O) -> Entries<impl Iterator<Item = (I::Item, O::Item)>> {
        Entries(self.0.zip(other.into_par_iter().0))
    }

    pub fn chain<O: IntoParallelIterator<Item = I::Item>>(
        self,
        other: O,
    ) -> Entries<impl Iterator<Item = I::Item>> {
        Entries(self.0.chain(other.into_par_iter().0))
    }

    pub fn step_by(self, step: usize) -> Entries<impl Iterator<Item = I::Item>> {
        Entries(self.0.step_by(step))
    }

    pub fn min_by(self, compare: impl FnMut(&I::Item, &I::Item) -> Ordering) -> Option<I::Item> {
        self.0.min_by(compare)
    }

    pub fn for_each(self, act: impl FnMut(I::Item)) {
        self.0.for_each(act);
    }

    pub fn try_for_each<E>(mut self, act: impl FnMut(I::Item) -> Result<(), E>) -> Result<(), E> {
        self.0.try_for_each(act)
    }

    pub fn reduce(
        self,
        identity: impl Fn() -> I::Item,
        join: impl FnMut(I::Item, I::Item) -> I::Item,
    ) -> I::Item {
        self.0.fold(identity(), join)
    }

    pub fn sum<S: Sum<I::Item>>(self) -> S {
        self.0.sum()
    }

    pub fn unzip<A, B, L: Default + Extend<A>, R: Default + Extend<B>>(self) -> (L, R)
    where
        I: Iterator<Item = (A, B)>,
    {
        self.0.unzip()
    }

    pub fn collect<C: FromEntries<I::Item>>(self) -> C {
        C::from_entries(self.0)
    }

    pub fn collect_into_vec(self, all: &mut Vec<I::Item>) {
        all.clear();
        self.0.for_each(|entry| all.push(entry));
    }
}

/// What entries are collected into. An iterator that hands its entries to a closure takes fewer bytes than
/// one that is asked for the next, and for how many remain.
pub trait FromEntries<T> {
    /// Collects the entries.
    fn from_entries(entries: impl Iterator<Item = T>) -> Self;
}

impl<T> FromEntries<T> for Vec<T> {
    fn from_entries(entries: impl Iterator<Item = T>) -> Self {
        let mut all = Self::new();
        entries.for_each(|entry| all.push(entry));
        all
    }
}

impl<T, E> FromEntries<Result<T, E>> for Result<Vec<T>, E> {
    fn from_entries(mut entries: impl Iterator<Item = Result<T, E>>) -> Self {
        let mut all = Vec::new();
        entries.try_for_each(|entry| entry.map(|entry| all.push(entry)))?;
        Ok(all)
    }
}
