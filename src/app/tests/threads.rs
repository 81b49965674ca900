//! How many threads the window computes on.

use super::*;
use meshbrush_kit::kit::background::{Aim, Outcome};

/// Returns the threads of work on a file that starts now.
fn threads_of_a_file(window: &mut Window) -> String {
    let count = |_: &_| Outcome::Exported(format!("{} threads", rayon::current_num_threads()));
    window.state_mut().background.start(Aim::Export, FOLDER.as_ref(), count);
    step_until(window, |window| notice(window).contains("threads"));
    notice(window)
}

#[test]
fn fewer_threads_compute_files_and_the_same_mesh() {
    let mut window = window_of(TALL);
    set(&mut window, Setting::Spacing(0.05));
    let all = fingerprint(&window);
    open_section(&mut window, "Mesh");
    type_into(&mut window, "Threads", "1");
    assert_eq!(window.state().threads.count().get(), 1);
    assert_eq!(threads_of_a_file(&mut window), "1 threads");
    set(&mut window, Setting::Spacing(0.04));
    set(&mut window, Setting::Spacing(0.05));
    assert_eq!(fingerprint(&window), all);
    type_into(&mut window, "Threads", "100000");
    assert_eq!(window.state().threads.count().get(), rayon::current_num_threads(), "no more than there are");
}
