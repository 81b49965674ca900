//! `.jsonl`: what was done to a document, with the mesh after each edit, to do it again and compare.
//!
//! Lines of JSON, to be read and compared by people as well:
//!
//! ```text
//! {"format":"Meshbrush recording","version":1,"written_by":"Meshbrush 0.1.0"}
//! {"start":{"settings":{…}},"gives":{"mesh":{"fingerprint":"…","triangles":1152}}}
//! {"edit":1,"title":"paint","does":{"stroke":{"layer":1,"medium":{"risk":0.8},…}},"gives":…}
//! {"edit":2,"title":"coarse spacing","does":{"set":{"settings":{"spacing":0.1}}},"gives":…}
//! {"edit":3,"title":"undo","does":"undo","gives":…}
//! ```
//!
//! - `settings` has the keys of `settings.json` in a project: all of them at the start, then those that
//!   change, with null for a key that is removed. The background picture is left out: it does not change the
//!   mesh.
//! - `polygons` beside it are those of the domain, where it has others than before.
//! - `pixels` beside it is a ZIP archive in base64: rasters and long lists of points that no line before has,
//!   at the start also paint.
//! - A point of the `path` of a stroke is x and y in world units, and size and strength of the brush there
//!   where they are not 1.
//! - An edit gives a `mesh`, or `no_mesh` and the reason.

pub mod gestures;
mod read;
mod replay;
mod saved;
mod write;

pub use read::{RecordingFile, from_bytes, read};
pub use replay::{Difference, Replayed};
pub use write::write;

/// The extension of recordings.
pub const ENDING: &str = "jsonl";

const FORMAT: &str = "Meshbrush recording";
/// The version that is written, and the newest that is read.
const VERSION: u64 = 1;

/// Most bytes of a file that is written or read.
const MOST_BYTES: u64 = 1 << 30;

/// Returns a sentence without its full stop about a recording that is longer than [`MOST_BYTES`].
fn too_long() -> String {
    format!("it is larger than {} MiB, the limit for a recording", MOST_BYTES >> 20)
}

/// Work on a mesh between two checks of the meter: some milliseconds.
const SLICE: usize = 1 << 16;
