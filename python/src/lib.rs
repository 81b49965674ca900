//! The module `meshbrush._core` for Python: what the package `meshbrush` cannot do in Python itself.
//!
//! Tables of options and layers come as dictionaries with the keys of a recipe, and are read and checked by
//! the code that reads recipes. Long work runs on a thread of its own while the calling thread looks for
//! signals, so that Ctrl+C is heard at once, and no lock is held meanwhile.

mod answers;
mod arrays;
mod change;
mod document;
mod errors;
mod layers;
mod locate;
mod mesh;
mod path;
mod rules;
mod solve;
mod values;
mod work;

use std::ffi::OsString;
use std::io::Write;

use pyo3::prelude::*;

/// Runs the command line. The first argument is the program's name. Returns the exit status.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| {
        let status = meshbrush_cli::cli::status_of(arguments, None);
        // Nobody flushes the standard output of Rust when Python ends.
        let _ = std::io::stdout().flush();
        status
    })
}

#[pymodule]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::change::Change;
    #[pymodule_export]
    use crate::document::Document;
    #[pymodule_export]
    use crate::main;
    #[pymodule_export]
    use crate::mesh::Mesh;
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "the name of the convention")]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::work::note_process();
        Ok(())
    }
}
