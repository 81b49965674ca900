//! Files that come with the program: they are parts of it.

use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs};

macro_rules! files {
    ($folder:literal: $($file:literal)*) => {
        [$(($file, include_bytes!(concat!("../../../", $folder, $file)) as &[u8])),*]
    };
}

static EXAMPLES: [(&str, &[u8]); 5] = files!("assets/":
    "aegean_sea.geojson" "celtic_sea.geojson" "celtic_sea_depths.tif" "jacksboro_heights.tif" "jacksboro_slope.png");
static PICTURES: [(&str, &[u8]); 5] = files!("docs/manual/":
    "pictures/window.png" "pictures/how-it-works.png" "pictures/panel.png" "pictures/boundary.png" "pictures/triangle.png");

/// Returns a file of an example, or a picture as the manual names it. In a page it is here once it was
/// [fetched](fetch).
pub fn asset(name: &str) -> Option<&'static [u8]> {
    EXAMPLES.iter().chain(&PICTURES).find(|(known, _)| *known == name).map(|(_, bytes)| *bytes)
}

/// Fetches files, and sends the outcome: a desktop has them all.
pub fn fetch<T: Send + 'static>(
    _: Vec<&'static str>,
    outcome: impl FnOnce(Result<(), String>) -> T + Send + 'static,
    jobs: &Jobs,
) -> Job<T> {
    jobs.start(JobKind::Read, |output| _ = output.send(outcome(Ok(()))))
}
