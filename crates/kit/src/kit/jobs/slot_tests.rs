use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use egui::Context;
use fastrand::Rng;

use super::succession::STILL;
use super::{JobKind, Jobs, Slot, Wanted};
use crate::kit::document_id::DocumentId;

fn patient_jobs() -> Jobs {
    let jobs = Jobs::new(&Context::default());
    jobs.wait_for_all();
    jobs
}

#[test]
fn what_panics_is_computed_once_and_gives_one_message() {
    let (jobs, runs) = (patient_jobs(), Arc::new(AtomicUsize::new(0)));
    let mut slot: Slot<u32, u32> = Slot::default();
    for _ in 0..5 {
        let runs = runs.clone();
        slot.start(
            7,
            move || {
                runs.fetch_add(1, Ordering::Relaxed);
                panic!("no value for seven")
            },
            &jobs,
        );
        assert!(!slot.take(&jobs) && slot.has(&7) && slot.last().is_none());
    }
    assert_eq!(runs.load(Ordering::Relaxed), 1);
    let problems = jobs.take_problems();
    assert!(problems.len() == 1 && problems[0].contains("(no value for seven)"), "{problems:?}");
    slot.start(8, || 80, &jobs);
    assert!(!slot.take(&jobs) && slot.last() == Some((&8, &80)));
}

#[test]
fn what_is_stopped_ends_before_anything_else_starts() {
    let jobs = patient_jobs();
    let mut slot: Slot<u32, u32> = Slot::default();
    for key in 0..50 {
        slot.start_wanted(key, endless, &jobs);
        slot.stop(&jobs);
        assert!(!slot.has(&key) && jobs.threads(JobKind::Compute) <= 1);
    }
    assert!(!slot.take(&jobs));
    jobs.wait_for_threads();
}

#[test]
fn what_was_computed_for_an_earlier_document_is_dropped() {
    let jobs = patient_jobs();
    let mut slot: Slot<u32, u32> = Slot::default();
    slot.start(1, || 10, &jobs);
    jobs.work_for(DocumentId::default().next());
    assert!(!slot.take(&jobs) && slot.last().is_none() && !slot.has(&1));
}

/// Goes on until nobody wants it any more.
fn endless(wanted: &Wanted) -> Option<u32> {
    while wanted.goes_on() {
        std::thread::yield_now();
    }
    None
}

fn wait_for(flag: &AtomicBool) {
    while !flag.load(Ordering::Relaxed) {
        std::thread::yield_now();
    }
}

#[test]
fn a_job_ends_for_a_newer_key_that_rests() {
    let jobs = Jobs::new(&Context::default());
    let mut slot: Slot<u32, u32> = Slot::default();
    slot.start_wanted(1, endless, &jobs);
    for (time, key, ends) in [
        (0.0, 2, false),
        (0.09, 3, false),
        (0.18, 1, false),
        (0.3, 3, false),
        (0.39, 3, false),
        (0.41, 3, true),
    ] {
        jobs.begin_frame(time);
        slot.want(&key, &jobs);
        assert_eq!(slot.is_ending(), ends, "at {time}");
    }
    jobs.wait_for_threads();
    jobs.begin_frame(0.5);
    assert!(!slot.take_ready(&jobs) && slot.last().is_none() && !slot.has(&1), "it may be tried again");
    slot.start(3, || 30, &jobs);
    jobs.wait_for_threads();
    jobs.begin_frame(0.6);
    assert!(!slot.take_ready(&jobs) && slot.last() == Some((&3, &30)));
}

#[test]
fn a_value_that_comes_although_its_job_was_to_end_is_shown() {
    let jobs = Jobs::new(&Context::default());
    let mut slot: Slot<u32, u32> = Slot::default();
    let [begun, may_end] = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
    let (begins, ends) = (begun.clone(), may_end.clone());
    let stubborn = move || {
        begins.store(true, Ordering::Relaxed);
        wait_for(&ends);
        10
    };
    slot.start(1, stubborn, &jobs);
    wait_for(&begun);
    slot.want(&2, &jobs);
    jobs.begin_frame(1.0);
    slot.want(&2, &jobs);
    assert!(slot.is_ending());
    may_end.store(true, Ordering::Relaxed);
    jobs.wait_for_threads();
    jobs.begin_frame(2.0);
    assert!(!slot.take_ready(&jobs) && slot.last() == Some((&1, &10)));
}

/// A slot whose key changes at certain times, with jobs that take as long as the test says on a clock that
/// the test turns.
struct Simulation {
    jobs: Jobs,
    slot: Slot<u32, u32>,
    /// When the running job is done, and how it is told so.
    done: Option<(f64, Arc<AtomicBool>)>,
    /// Seconds that a job takes.
    takes: f64,
}

impl Simulation {
    const FRAME: f64 = 1.0 / 60.0;

    fn new(takes: f64) -> Self {
        Self { jobs: Jobs::new(&Context::default()), slot: Slot::default(), done: None, takes }
    }

    /// A frame in which `key` is wanted. Returns the key whose value is shown then.
    fn frame(&mut self, time: f64, key: u32) -> Option<u32> {
        if let Some((_, finish)) = self.done.take_if(|(at, _)| *at <= time) {
            finish.store(true, Ordering::Relaxed);
            self.jobs.wait_for_threads();
        }
        self.jobs.begin_frame(time);
        self.slot.take_ready(&self.jobs);
        self.slot.want(&key, &self.jobs);
        if self.slot.is_ending() {
            self.done = None;
            self.jobs.wait_for_threads();
            self.jobs.begin_frame(time);
            self.slot.take_ready(&self.jobs);
        }
        if !self.slot.is_running() && !self.slot.has(&key) {
            let finish = Arc::new(AtomicBool::new(false));
            self.done = Some((time + self.takes, finish.clone()));
            let compute = move |wanted: &Wanted| {
                while wanted.goes_on() && !finish.load(Ordering::Relaxed) {
                    std::thread::yield_now();
                }
                finish.load(Ordering::Relaxed).then_some(key)
            };
            self.slot.start_wanted(key, compute, &self.jobs);
        }
        self.slot.last().map(|(key, _)| *key)
    }
}

#[test]
fn in_a_stroke_the_values_on_the_way_are_shown() {
    let mut simulation = Simulation::new(0.3);
    let mut shown = Vec::new();
    for frame in 0..180 {
        shown.extend(simulation.frame(f64::from(frame) * Simulation::FRAME, frame));
    }
    shown.dedup();
    assert_eq!(shown, [0, 18, 36, 54, 72, 90, 108, 126, 144], "each job ends, and the next one begins");
}

#[test]
fn however_keys_change_a_newer_value_comes_soon_and_the_last_one_sooner() {
    for seed in 0..60 {
        let mut random = Rng::with_seed(seed);
        let (takes, pause) = (2.0 * random.f64(), random.f64());
        let mut simulation = Simulation::new(takes);
        let (mut key, mut next, mut shown) = (0, 0.0, None);
        let (mut time, mut stale_since) = (0.0, 0.0);
        while time < 6.0 {
            if time >= next {
                (key, next) = (key + 1, time + pause * random.f64());
            }
            let now = simulation.frame(time, key);
            assert!(now >= shown, "seed {seed}: an older value is shown after a newer one");
            if now != shown || now == Some(key) {
                stale_since = time;
            }
            let longest = 2.0 * takes + 5.0 * Simulation::FRAME;
            assert!(time - stale_since <= longest, "seed {seed}: nothing newer within {longest} s at {time}");
            (shown, time) = (now, time + Simulation::FRAME);
        }
        let rests_since = time;
        while simulation.frame(time, key) != Some(key) {
            time += Simulation::FRAME;
        }
        let longest = (takes + STILL).max(2.0 * takes) + 5.0 * Simulation::FRAME;
        assert!(time - rests_since <= longest, "seed {seed}: the last value after {} s", time - rests_since);
    }
}

#[test]
fn what_rests_is_shown_after_one_computation() {
    let mut simulation = Simulation::new(1.0);
    let ends = |frame: u32| f64::from(frame) * Simulation::FRAME;
    simulation.frame(0.0, 1);
    let first = (1..).find(|&frame| simulation.frame(ends(frame), 2) == Some(2)).expect("it comes");
    let longest = 1.0 + STILL + 3.0 * Simulation::FRAME;
    assert!(ends(first) <= longest, "{} s: the job for the first key was waited for", ends(first));
}
