//! After any edits the mesh is the one made from scratch, wherever the follower is stopped between them.
//!
//! `MESHBRUSH_LONG=300` tries 10⁵ edits instead of a few hundred, and `MESHBRUSH_SEED=17` begins with
//! the 17th document, as a failure names it.

use crate::operations::{Choices, Driver, Operation, Scale, domains, run_bytes};
use crate::runs::{prints_table, runs, seeds};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::BoundaryTreatment;
use meshbrush_core::field::Transfer;
use meshbrush_mesh::mesh::Fingerprint;

impl Choices for fastrand::Rng {
    fn below(&mut self, count: usize) -> usize {
        self.usize(..count)
    }

    fn share(&mut self) -> f64 {
        self.f64()
    }
}

/// Edits of one document: paint piles up until strokes change nothing any more.
const EDITS_OF_A_DOCUMENT: usize = 60;

const SMALL: Scale = Scale { diameter: 0.02, smallest: 0.02, triangles: 1000 };

/// Counts of what was seen, so that the test does not pass because nothing happens.
#[derive(Default)]
struct Seen {
    edits: usize,
    changes_within: usize,
    compared: usize,
    priced: usize,
}

/// Edits a document: one to three edits between two slices of the follower, which is stopped anywhere.
/// Returns the settings and the mesh at each rest.
fn edit(seed: u64, scale: Scale, seen: &mut Seen) -> Vec<(Settings, Fingerprint)> {
    let mut random = fastrand::Rng::with_seed(seed);
    let transfer = Transfer::between(scale.smallest, Settings::default().transfer.h_max);
    let domain = domains()[random.usize(..4)].clone();
    let boundary = BoundaryTreatment::OnOutline { diameter: 2.0 * scale.diameter };
    let max_triangles = 100 * scale.triangles;
    let settings =
        Settings { domain, spacing: 0.2, transfer, boundary, max_triangles, ..Settings::default() };
    let mut driver = Driver::new(settings);
    let mut edits = 0;
    while edits < EDITS_OF_A_DOCUMENT {
        for _ in 0..random.usize(1..4) {
            let operation = Operation::choose(&mut random, scale);
            if prints_table() {
                eprintln!("{edits}: {operation:.0?}");
            }
            driver.apply(operation);
            edits += 1;
        }
        if random.bool() {
            // A large step now and then, as small ones would never get to the end of anything.
            for _ in 0..random.usize(1..20) {
                let most = [3, 100, 3000][random.usize(..3)];
                driver.advance(random.usize(1..=most));
            }
        } else {
            driver.settle();
        }
    }
    driver.settle();
    seen.edits += edits;
    seen.changes_within += driver.changes_within;
    seen.compared += driver.compared;
    seen.priced += driver.priced;
    driver.rests
}

/// The same edits, followed in the same slices by several numbers of threads. What cannot be met is taken
/// back when that is found, which may be before or after the next edit: only equal documents are compared.
#[test]
fn the_mesh_does_not_depend_on_the_number_of_threads() {
    let pools = [1, 2, 3, 8]
        .map(|threads| (threads, rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()));
    let (mut equal, mut all) = (0, 0);
    for seed in seeds(2) {
        let [(_, alone), others @ ..] = &pools;
        let expected = alone.install(|| edit(seed, SMALL, &mut Seen::default()));
        for (threads, pool) in others {
            let found = pool.install(|| edit(seed, SMALL, &mut Seen::default()));
            for (place, (found, expected)) in found.iter().zip(&expected).enumerate() {
                all += 1;
                if found.0 == expected.0 {
                    assert_eq!(found.1, expected.1, "document {seed}, rest {place}, {threads} threads");
                    equal += 1;
                }
            }
        }
    }
    eprintln!("{equal} of {all} meshes compared");
    assert!(equal > 15 && 10 * equal > 9 * all, "{equal} of {all}");
}

fn run(scale: Scale, default: u64) {
    let edits = runs(default) as usize;
    let mut seen = Seen::default();
    for seed in seeds(1).start.. {
        eprintln!("document {seed}");
        _ = edit(seed, scale, &mut seen);
        if seen.edits >= edits {
            break;
        }
    }
    let Seen { edits, changes_within, compared, priced } = seen;
    assert!(
        changes_within > edits / 10 && compared > edits / 8,
        "of {edits} edits, {changes_within} slices changed the mesh in place, and {compared} meshes were compared"
    );
    assert!(2 * priced > compared, "of {compared} meshes, {priced} prices were compared");
}

#[test]
fn the_mesh_after_any_edits_is_the_one_made_from_scratch() {
    run(SMALL, 360);
}

#[test]
fn edits_of_a_thousand_millionth_of_the_domain_are_seen() {
    run(Scale { diameter: 0.02, smallest: 1e-9, triangles: 1000 }, 60);
}

/// A curve that is lower between the values of two pixels than at both kept the search for the least h̄ busy
/// along the line between them, and its limit made h̄ another for a triangle than for those in it.
#[test]
fn a_curve_that_is_lowest_between_two_pixels_is_decided_at_their_line() {
    edit(234, SMALL, &mut Seen::default());
}

/// The rim of a mask and the outline of the domain lie on one line, along which the search stayed until its
/// limit: a sliver beside it was found for a triangle, and not for the one around it.
#[test]
fn a_sliver_beside_a_line_of_two_layers_is_found_for_triangles_of_all_sizes() {
    edit(5166, SMALL, &mut Seen::default());
}

/// Runs the edits of `fuzz/` on a few bytes.
#[test]
fn edits_from_bytes_hold_what_random_edits_do() {
    let mut random = fastrand::Rng::with_seed(13);
    for _ in 0..100 {
        let bytes: Vec<u8> = (0..random.usize(..300)).map(|_| random.u8(..)).collect();
        run_bytes(&bytes);
    }
}
