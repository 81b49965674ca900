//! What is known in the squares of a grid, and in larger squares.

/// Values in squares, row by row from the lowest.
#[derive(Debug)]
pub(super) struct SquareGrid<T> {
    columns: u32,
    values: Vec<T>,
}

impl<T: Copy> SquareGrid<T> {
    /// Returns the values of squares in `columns` columns.
    pub fn new(columns: u32, values: Vec<T>) -> Self {
        Self { columns, values }
    }

    /// Returns the value in the square that is number `place` along x and y.
    #[inline]
    pub fn at(&self, [column, row]: [u32; 2]) -> T {
        self.values[(row * self.columns + column) as usize]
    }

    /// Returns these squares, then those twice as wide, and so on up to one square. `join` makes the value of
    /// a square from those in it.
    pub fn pyramid(self, join: impl Fn(T, T) -> T) -> Vec<Self> {
        let mut all = vec![self];
        while let Some(last) = all.last().filter(|last| last.values.len() > 1) {
            let next = last.halved(&join);
            all.push(next);
        }
        all
    }

    fn halved(&self, join: impl Fn(T, T) -> T) -> Self {
        let rows = self.values.len() as u32 / self.columns;
        let joined = |[column, row]: [u32; 2]| {
            let parts = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [2 * column + x, 2 * row + y]);
            let inside = parts.into_iter().filter(|[x, y]| *x < self.columns && *y < rows);
            inside.map(|place| self.at(place)).reduce(&join).expect("the first part is inside")
        };
        let columns = self.columns.div_ceil(2);
        let places = (0..rows.div_ceil(2)).flat_map(|row| (0..columns).map(move |column| [column, row]));
        Self { columns, values: places.map(joined).collect() }
    }
}
