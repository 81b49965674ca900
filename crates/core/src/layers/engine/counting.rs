//! Which layers of a stack are asked.

/// The layers that can count in a rectangle, by their numbers from the bottom of the stack.
///
/// A layer that asks for nothing in a rectangle, or for more than another one everywhere in it, does so in
/// all parts of the rectangle. So the parts need not ask it, and most parts ask one or two layers of a stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counting(u64);

impl Default for Counting {
    fn default() -> Self {
        Self::ALL
    }
}

impl Counting {
    /// All layers of any stack.
    pub const ALL: Self = Self(u64::MAX);

    /// Returns whether a layer can count. Beyond the first 64, all can.
    #[inline]
    pub fn has(self, number: usize) -> bool {
        number >= 64 || self.0 >> number & 1 == 1
    }

    /// These layers without one.
    pub fn without(self, number: usize) -> Self {
        if number < 64 { Self(self.0 & !(1 << number)) } else { self }
    }

    /// These layers without all others than some.
    pub fn only(self, numbers: impl IntoIterator<Item = usize>) -> Self {
        let numbers = numbers.into_iter().filter(|&number| number < 64);
        Self(self.0 & numbers.fold(0, |some, number| some | 1 << number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_left_out_one_by_one() {
        let some = Counting::ALL.without(3).without(63).without(64);
        let left: Vec<usize> = (0..70).filter(|&number| !some.has(number)).collect();
        assert_eq!(left, [3, 63]);
        let few = some.only([2, 3, 5, 66]);
        assert_eq!(
            (0..70).filter(|&number| few.has(number)).collect::<Vec<_>>(),
            [2, 5, 64, 65, 66, 67, 68, 69]
        );
    }
}
