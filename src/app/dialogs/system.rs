//! The desktop's own file dialog.

use std::path::PathBuf;

use super::FileRequest;
use crate::io::project::ENDING;
use crate::render::export::ExportFormat;

/// Asks with the desktop's own dialog, and waits for the answer.
pub fn ask(request: FileRequest) -> Option<PathBuf> {
    let dialog = rfd::FileDialog::new().set_title(request.title());
    match request {
        FileRequest::Open => {
            dialog.add_filter("Projects, domains, pictures", &[ENDING, "geojson", "json", "png"]).pick_file()
        }
        FileRequest::Save => {
            dialog.add_filter("Projects", &[ENDING]).set_file_name(format!("mesh.{ENDING}")).save_file()
        }
        FileRequest::OpenImage => dialog.add_filter("Pictures", &["png"]).pick_file(),
        FileRequest::OpenDomain => dialog.add_filter("Polygons", &["geojson", "json"]).pick_file(),
        FileRequest::Export => dialog
            .add_filter("Meshes and pictures", &ExportFormat::endings().collect::<Vec<_>>())
            .set_file_name("mesh.vtu")
            .save_file(),
    }
}
