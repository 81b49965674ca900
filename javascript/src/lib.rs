//! The core without a window, for JavaScript: what `index.js` cannot do itself.
//!
//! Options and layers come as objects, whose keys `index.js` has looked at, with arrays in the place of
//! files. `index.js` is the interface that people see, and `index.d.ts` its types.

mod brush;
mod document;
mod edits;
mod errors;
mod kinds;
mod locate;
mod mesh;
mod options;
mod rasters;
mod values;
