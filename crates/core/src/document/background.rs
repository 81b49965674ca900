use std::fmt;
use std::sync::Arc;

use crate::geometry::Rect;

/// A picture in colour.
#[derive(Clone, PartialEq)]
pub struct Picture {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Red, green, blue and opacity of each pixel, not premultiplied; the top row first.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Most pixels of a background picture: 64 MB.
    pub const MOST_PIXELS: u64 = 16_000_000;
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [columns, rows] = self.size;
        write!(f, "Picture({columns} × {rows})")
    }
}

/// A picture behind the mesh, such as a map to trace. It does not change the mesh.
#[derive(Clone, Debug)]
pub struct Background {
    /// Name of the file, for a person.
    pub name: String,
    /// The picture.
    pub picture: Arc<Picture>,
    /// The rectangle that it covers, in world units.
    pub bounds: Rect,
    /// How strongly it shows through the fill of the mesh, 0 to 1.
    pub opacity: f64,
}

impl Background {
    /// The opacity of a new one.
    pub const DEFAULT_OPACITY: f64 = 0.5;
}

impl PartialEq for Background {
    /// Pictures that share their memory are not compared pixel by pixel.
    fn eq(&self, other: &Self) -> bool {
        let same = |a: &Arc<Picture>, b: &Arc<Picture>| Arc::ptr_eq(a, b) || a == b;
        self.name == other.name
            && self.bounds == other.bounds
            && self.opacity == other.opacity
            && same(&self.picture, &other.picture)
    }
}
