use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use egui::{Event, RawInput};
use fastrand::Rng;

use super::*;

/// Goes on until nobody wants it any more.
fn endless(output: &Output<()>) {
    while output.is_wanted() {
        std::thread::yield_now();
    }
}

#[test]
fn a_frame_waits_for_all_its_jobs_together_no_longer_than_its_patience() {
    let jobs = Jobs::new(&Context::default());
    let running: Vec<Job<()>> =
        (0..JobKind::Compute.most()).map(|_| jobs.start(JobKind::Compute, endless)).collect();
    jobs.begin_frame(0.0);
    assert!(running.iter().all(|job| matches!(job.take(&jobs), Taken::Working)));
    assert_eq!(jobs.0.inbox.patience(), Duration::ZERO, "the jobs used up one patience together");
}

/// Sends values until nobody wants them any more, each as soon as the one before.
fn ceaseless(output: &Output<()>) {
    while output.send(()) {}
}

#[test]
fn three_receivers_of_values_that_never_end_leave_the_frame_when_its_time_is_over() {
    let jobs = Jobs::new(&Context::default());
    let running: Vec<Job<()>> = (0..3).map(|_| jobs.start(JobKind::Compute, ceaseless)).collect();
    let one_by_one = |job: &Job<()>| {
        let mut taken = 0;
        while matches!(job.take(&jobs), Taken::Value(())) {
            taken += 1;
            assert!(taken < 100_000_000, "the frame does not end");
        }
        taken
    };
    let mut totals = [0; 3];
    let mut frames = 0;
    // A thread may begin late: frames go on until each has given something.
    while totals.contains(&0) {
        jobs.begin_frame(0.0);
        totals.iter_mut().zip(&running).for_each(|(total, job)| *total += one_by_one(job));
        assert_eq!(jobs.0.inbox.patience(), Duration::ZERO, "the receivers use up one patience together");
        frames += 1;
    }
    assert!(frames > 0 && totals.iter().all(|&total| total > 0), "{frames} {totals:?}");
}

#[test]
fn values_that_a_frame_leaves_are_taken_by_the_next_one() {
    let jobs = Jobs::new(&Context::default());
    let job = jobs.start(JobKind::Compute, |output| (0..5).for_each(|n| _ = output.send(n)));
    jobs.wait_for_threads();
    let mut taken = Vec::new();
    for frame in 1.. {
        jobs.begin_frame(0.0);
        // No time is left: each frame takes one value.
        jobs.0.inbox.use_up_patience();
        let last = loop {
            match job.take(&jobs) {
                Taken::Value(value) => taken.push(value),
                last => break last,
            }
        };
        assert_eq!(taken.len(), frame.min(5), "a value for each frame");
        if matches!(last, Taken::Ended) {
            break;
        }
    }
    assert_eq!(taken, [0, 1, 2, 3, 4]);
}

#[test]
fn no_more_jobs_of_a_kind_run_at_once_than_it_has_threads() {
    let jobs = Jobs::new(&Context::default());
    jobs.wait_for_all();
    let (running, most) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
    let started: Vec<Job<usize>> = (0..100)
        .map(|number| {
            let (running, most) = (running.clone(), most.clone());
            jobs.start(JobKind::Compute, move |output| {
                most.fetch_max(running.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                std::thread::yield_now();
                running.fetch_sub(1, Ordering::SeqCst);
                output.send(number);
            })
        })
        .collect();
    for (number, job) in started.iter().enumerate() {
        assert!(matches!(job.take(&jobs), Taken::Value(value) if value == number));
        assert!(matches!(job.take(&jobs), Taken::Ended));
    }
    assert!((1..=JobKind::Compute.most()).contains(&most.load(Ordering::SeqCst)));
}

#[test]
fn a_job_that_nobody_wants_any_more_does_not_begin() {
    let jobs = Jobs::new(&Context::default());
    let holding: Vec<Job<()>> = (0..JobKind::Ask.most()).map(|_| jobs.start(JobKind::Ask, endless)).collect();
    let begun = Arc::new(AtomicUsize::new(0));
    let begins = begun.clone();
    drop(jobs.start(JobKind::Ask, move |_: &Output<()>| {
        begins.fetch_add(1, Ordering::SeqCst);
    }));
    drop(holding);
    jobs.wait_for_threads();
    assert_eq!(begun.load(Ordering::SeqCst), 0);
}

#[test]
fn a_window_that_is_closed_waits_for_writing_and_not_for_reading() {
    let jobs = Jobs::new(&Context::default());
    let _reading = jobs.start(JobKind::Read, endless);
    let writing = jobs.start(JobKind::Write, |output: &Output<u32>| {
        output.send(7);
    });
    // The reading never ends by itself: waiting for it would take an hour.
    jobs.wait_for_writing(Duration::from_secs(3600));
    assert!(matches!(writing.take_ready(), Taken::Value(7)));
}

/// Part of a context, as the graphics device of a window is.
struct PartOfContext(Arc<AtomicUsize>);

impl egui::Plugin for PartOfContext {
    fn debug_name(&self) -> &'static str {
        "part of a context"
    }
}

impl Drop for PartOfContext {
    fn drop(&mut self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn the_context_ends_with_the_window_while_a_job_still_runs() {
    let dropped = Arc::new(AtomicUsize::new(0));
    let ctx = Context::default();
    ctx.add_plugin(PartOfContext(dropped.clone()));
    let jobs = Jobs::new(&ctx);
    let (end, may_end) = std::sync::mpsc::channel::<()>();
    let (began, has_begun) = std::sync::mpsc::channel();
    let job = jobs.start(JobKind::Compute, move |output: &Output<()>| {
        began.send(()).expect("the test waits");
        let _ = may_end.recv();
        output.wake();
    });
    has_begun.recv().expect("the job begins");
    let queue = jobs.0.queue.clone();
    drop((job, jobs, ctx));
    let (dropped, running) = (dropped.load(Ordering::Relaxed), queue.running(JobKind::Compute));
    drop(end);
    queue.wait(JobKind::Compute, Duration::from_secs(60));
    assert_eq!((dropped, running), (1, 1), "contexts that ended, and jobs that ran at that moment");
}

#[test]
fn a_panic_of_each_kind_of_job_ends_it_and_gives_one_message_where_nobody_else_does() {
    let jobs = Jobs::new(&Context::default());
    jobs.wait_for_all();
    for kind in JobKind::ALL {
        let job = jobs.start(kind, |_: &Output<()>| panic!("a job of a test"));
        assert!(matches!(job.take(&jobs), Taken::Ended), "{kind:?}");
        let problems = jobs.take_problems();
        assert_eq!(
            problems.len(),
            usize::from(!matches!(kind, JobKind::Read | JobKind::Write)),
            "{problems:?}"
        );
    }
}

#[test]
fn values_of_each_job_come_in_their_order_whatever_the_order_of_the_jobs() {
    for seed in 0..20 {
        let (jobs, mut random) = (Jobs::new(&Context::default()), Rng::with_seed(seed));
        jobs.hold();
        let started: Vec<Job<u32>> = (0..5)
            .map(|_| jobs.start(JobKind::Compute, |output| (0..4).for_each(|value| _ = output.send(value))))
            .collect();
        jobs.wait_for_threads();
        jobs.begin_frame(0.0);
        assert!(started.iter().all(|job| matches!(job.take(&jobs), Taken::Working)), "nothing is delivered");
        let mut taken = [0; 5];
        while jobs.release(|count| random.usize(..count)) {
            for (job, next) in started.iter().zip(&mut taken) {
                if let Taken::Value(value) = job.take_ready() {
                    assert_eq!(value, *next, "seed {seed}");
                    *next += 1;
                }
            }
        }
        assert_eq!(taken, [4; 5], "seed {seed}");
        assert!(started.iter().all(|job| matches!(job.take_ready(), Taken::Ended)), "seed {seed}");
    }
}

fn work_for(time: Duration) {
    let began = Instant::now();
    while began.elapsed() <= time {
        std::hint::spin_loop();
    }
}

/// Work that takes longer than a frame has for it.
fn long_slice() {
    work_for(SHARE);
}

#[test]
fn without_threads_a_frame_does_one_long_slice_and_jobs_take_turns() {
    let jobs = Jobs::new(&Context::default());
    jobs.do_without_threads();
    let counts = |first: u32| {
        let slice = |next: &mut u32, output: &Output<u32>| {
            long_slice();
            output.send(*next);
            *next += 1;
            if *next % 10 == 3 { Progress::Done } else { Progress::More }
        };
        jobs.start_in_slices(JobKind::Compute, move || Some(first), slice)
    };
    let (one, other) = (counts(0), counts(10));
    assert!(matches!(one.take(&jobs), Taken::Working), "no frame waits");
    let mut order = Vec::new();
    for frame in 0..20 {
        jobs.begin_frame(f64::from(frame));
        let before = order.len();
        for job in [&one, &other] {
            while let Taken::Value(value) = job.take(&jobs) {
                order.push(value);
            }
        }
        assert!(order.len() <= before + 1, "frame {frame}: {order:?}");
    }
    assert_eq!(order, [0, 10, 1, 11, 2, 12]);
    assert!([one, other].iter().all(|job| matches!(job.take_ready(), Taken::Ended)));
}

#[test]
fn without_threads_long_work_waits_for_the_hand_to_rest_and_short_work_does_not() {
    let queue = Queue::default();
    queue.do_without_threads();
    let (done, here) = (Arc::new(AtomicUsize::new(0)), Location::caller());
    let long = || {
        let done = done.clone();
        queue.push(JobKind::Compute, here, move || {
            long_slice();
            std::thread::sleep(Duration::from_millis(40));
            done.fetch_add(1, Ordering::Relaxed);
            Turn::Done
        });
    };
    let run = |busy| queue.run_slice(&JobKind::IN_FRAMES, if busy { Allowed::Short } else { Allowed::All });
    long();
    assert_eq!(run(true), Ran::Slice, "how long it takes is not known yet");
    long();
    assert_eq!(run(true), Ran::Later);
    queue.push(JobKind::Compute, Location::caller(), || Turn::Done);
    assert_eq!((run(true), run(true)), (Ran::Slice, Ran::Later), "short work behind it goes on");
    assert_eq!(done.load(Ordering::Relaxed), 1);
    assert_eq!((run(false), run(false)), (Ran::Slice, Ran::Nothing));
    assert_eq!(done.load(Ordering::Relaxed), 2);
}

/// A job whose long slice comes sooner or later, as the solver does after a path with more or fewer steps.
#[test]
fn without_threads_a_long_slice_is_expected_anywhere_in_work_that_had_one() {
    let queue = Queue::default();
    queue.do_without_threads();
    let here = Location::caller();
    let work = |short: usize, longest_ms: u64, end: Turn| {
        let mut slice = 0;
        queue.push(JobKind::Compute, here, move || {
            slice += 1;
            if slice <= short {
                return Turn::More;
            }
            std::thread::sleep(Duration::from_millis(longest_ms));
            end
        });
    };
    let run = |busy| queue.run_slice(&JobKind::IN_FRAMES, if busy { Allowed::Short } else { Allowed::All });
    work(0, 60, Turn::Done);
    assert_eq!(run(true), Ran::Slice, "how long it takes is not known yet");
    work(3, 60, Turn::Done);
    assert_eq!(run(true), Ran::Later, "after three short slices, a long one");
    while run(false) == Ran::Slice {}
    let waits = |end: Turn| {
        work(0, 0, end);
        let is_later = run(true) == Ran::Later;
        while run(false) == Ran::Slice {}
        is_later
    };
    assert!((0..20).all(|_| waits(Turn::GivenUp)), "work that is given up says nothing");
    assert!(waits(Turn::Done) && waits(Turn::Done), "one run can be short by chance");
    assert!((0..20).any(|_| !waits(Turn::Done)), "work that stays short does not wait for ever");
}

#[test]
fn without_threads_short_work_is_done_together_files_first_and_dropped_work_not_at_all() {
    let jobs = Jobs::new(&Context::default());
    jobs.do_without_threads();
    let done = Arc::new(std::sync::Mutex::new(Vec::new()));
    let work = |kind: JobKind| {
        let done = done.clone();
        jobs.start(kind, move |_: &Output<()>| done.lock().unwrap().push(kind))
    };
    let _kept = [work(JobKind::Compute), work(JobKind::Read), work(JobKind::Write), work(JobKind::Journal)];
    drop(work(JobKind::Ask));
    jobs.begin_frame(0.0);
    assert_eq!(*done.lock().unwrap(), [JobKind::Read, JobKind::Write, JobKind::Compute]);
    // Work that is requested in a frame makes another one follow.
    let ctx = Context::default();
    let others = Jobs::new(&ctx);
    others.do_without_threads();
    for _ in 0..3 {
        ctx.run_ui(RawInput::default(), |_| {}).drop_without_applying_deltas();
    }
    assert!(!ctx.has_requested_repaint());
    let _job = others.start(JobKind::Compute, |_: &Output<()>| {});
    assert!(ctx.has_requested_repaint());
    // A window that is closed completes what is being written.
    let _writing = work(JobKind::Write);
    jobs.wait_for_writing(Duration::ZERO);
    assert_eq!(done.lock().unwrap().len(), 4);
}

/// Unsaved work is packed in slices: where drawing is slow, it is kept after few frames.
#[test]
fn without_threads_a_slow_frame_does_more_slices_while_the_hand_rests() {
    let slices_in_a_frame_after = |seconds: f64, events: Vec<Event>| {
        let ctx = Context::default();
        let jobs = Jobs::new(&ctx);
        jobs.do_without_threads();
        let done = Arc::new(AtomicUsize::new(0));
        let count = done.clone();
        let slice = move |_: &mut (), _: &Output<()>| {
            work_for(Duration::from_millis(3));
            count.fetch_add(1, Ordering::Relaxed);
            Progress::More
        };
        let _job = jobs.start_in_slices(JobKind::Write, || Some(()), slice);
        let frame = |time: f64, events| {
            let input = RawInput { time: Some(time), events, ..Default::default() };
            let before = done.load(Ordering::Relaxed);
            ctx.run_ui(input, |_| jobs.begin_frame(time)).drop_without_applying_deltas();
            done.load(Ordering::Relaxed) - before
        };
        frame(0.0, Vec::new());
        frame(seconds, events)
    };
    let moved = || vec![Event::PointerMoved(egui::pos2(5.0, 5.0))];
    assert!(slices_in_a_frame_after(0.016, Vec::new()) <= 3);
    assert!(slices_in_a_frame_after(0.3, moved()) <= 3);
    // Where other work of the machine delays a slice, a frame has no time for the next one.
    assert!((0..100).any(|_| slices_in_a_frame_after(0.3, Vec::new()) == 4));
}

#[test]
fn without_threads_a_window_that_is_closed_does_the_work_it_waits_for() {
    let jobs = Jobs::new(&Context::default());
    jobs.do_without_threads();
    let slice = |left: &mut u32, _: &Output<()>| {
        *left -= 1;
        if *left == 0 { Progress::Done } else { Progress::More }
    };
    let job = jobs.start_in_slices(JobKind::Write, || Some(5), slice);
    assert!(matches!(job.take_ready(), Taken::Working));
    jobs.wait_for_end(&job);
    assert!(matches!(job.take_ready(), Taken::Ended));
}
