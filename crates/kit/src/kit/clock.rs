//! The clock of the window: that of the system, and in a browser that of the browser.

pub use web_time::{Duration, Instant, SystemTime, UNIX_EPOCH};
