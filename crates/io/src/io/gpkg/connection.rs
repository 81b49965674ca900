//! Opens databases of strangers: what a file makes SQLite do is limited in steps, in the length of values,
//! and in memory.
//!
//! A table of a GeoPackage can be a view, whose query the file decides. Honest views are read as tables are.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rusqlite::config::DbConfig;
use rusqlite::ffi::ErrorCode;
use rusqlite::limits::Limit;
use rusqlite::{Connection, OpenFlags};

use crate::io::disk::File;
use crate::io::error::{Flaw, PlacedFlaw};
use crate::io::{Cancelled, Meter};
use meshbrush_mesh::text::excerpt;

/// Steps of the machine of SQLite between two looks at the limits.
const STEPS: i32 = 1000;
/// Most steps for a file, and as many more for each byte of it. A row of a table takes about ten.
const MOST_STEPS: u64 = 30_000_000;
const STEPS_OF_A_BYTE: u64 = 10;
/// Most bytes of a value: the corners of the largest shape, in four dimensions.
const LONGEST_VALUE: i32 = 64 << 20;
/// Most memory of all open databases.
const MOST_MEMORY: u64 = 256 << 20;

/// A database that is open for reading.
pub(super) struct Database {
    pub(super) connection: Connection,
    /// The size of the file in bytes.
    pub(super) bytes: u64,
    meter: Meter,
}

impl Database {
    /// Opens a file.
    ///
    /// # Errors
    /// Fails when the file cannot be read, or is no database.
    pub(super) fn open(path: &Path, meter: &Meter) -> Result<Self, PlacedFlaw> {
        let bytes = File::open(path)?.length()?;
        let mut database = Self { connection: connect(path)?, bytes, meter: meter.clone() };
        database.limit().map_err(|error| database.flaw(error))?;
        Ok(database)
    }

    /// Sets the limits.
    fn limit(&mut self) -> rusqlite::Result<()> {
        let connection = &mut self.connection;
        connection.set_limit(Limit::SQLITE_LIMIT_LENGTH, LONGEST_VALUE)?;
        connection.set_limit(Limit::SQLITE_LIMIT_ATTACHED, 0)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_DEFENSIVE, true)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false)?;
        let most = MOST_STEPS + STEPS_OF_A_BYTE * self.bytes;
        let (steps, meter) = (Arc::new(AtomicU64::new(0)), self.meter.clone());
        let is_over = move || {
            let done = steps.fetch_add(STEPS as u64, Ordering::Relaxed);
            meter.is_cancelled() || done > most
        };
        connection.progress_handler(STEPS, Some(is_over))?;
        // What a query sorts stays in memory, which is limited.
        connection.execute_batch(&format!(
            "PRAGMA query_only = ON; PRAGMA temp_store = MEMORY; PRAGMA hard_heap_limit = {MOST_MEMORY};"
        ))
    }

    /// Returns an error of SQLite as a sentence, without the query.
    pub(super) fn flaw(&self, error: rusqlite::Error) -> PlacedFlaw {
        let problem = match error.sqlite_error_code() {
            Some(ErrorCode::OperationInterrupted) if self.meter.is_cancelled() => {
                return Flaw::from(Cancelled).into();
            }
            Some(ErrorCode::OperationInterrupted) => {
                "its tables take too long to read: one of them may be a view with an endless query".to_owned()
            }
            Some(ErrorCode::TooBig) => format!("a value in it has more than {} MiB", LONGEST_VALUE >> 20),
            Some(ErrorCode::OutOfMemory) => {
                format!("a query of it takes more than {} MiB of memory", MOST_MEMORY >> 20)
            }
            _ => format!("this is not a GeoPackage that can be read ({})", excerpt(200, &message(error))),
        };
        Flaw::Syntax(format!("{problem}. Export the layer again.")).into()
    }
}

/// Returns the message of an error without the query that it is about.
fn message(error: rusqlite::Error) -> String {
    match error {
        rusqlite::Error::SqlInputError { msg, .. } => msg,
        other => other.to_string(),
    }
}

/// Opens a file without limits. Where another program has left changes beside it, they count.
fn connect(path: &Path) -> Result<Connection, PlacedFlaw> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let refused =
        |error| Flaw::Syntax(format!("this database cannot be opened ({}).", excerpt(200, &message(error))));
    if let (false, Some(address)) = (has_changes(path), immutable(path)) {
        // No files appear beside it, and its folder need not be writable.
        let connection = Connection::open_with_flags(address, flags | OpenFlags::SQLITE_OPEN_URI);
        return Ok(connection.map_err(refused)?);
    }
    let connection = Connection::open_with_flags(path, flags).map_err(refused)?;
    let can_read = |connection: &Connection| {
        connection.query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get::<_, i64>(0)).is_ok()
    };
    if can_read(&connection) {
        return Ok(connection);
    }
    // SQLite needs a file beside it to read the changes, and the folder may not be writable.
    let problem = "another program has left changes beside this database (-wal or -journal), and they cannot be read in this \
                   folder. Copy all its files into one that can be written.";
    Err(Flaw::Syntax(problem.into()).into())
}

/// Returns the path of a file of changes beside a database.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(ending);
    name.into()
}

/// Returns whether a program that writes the file has left changes beside it.
fn has_changes(path: &Path) -> bool {
    ["-wal", "-journal"]
        .iter()
        .any(|ending| beside(path, ending).metadata().is_ok_and(|found| found.len() > 0))
}

/// Returns the address of a file that does not change. Some paths of Windows have none.
fn immutable(path: &Path) -> Option<String> {
    let path = std::path::absolute(path).ok()?;
    let mut address = String::from("file:");
    for &byte in path.as_os_str().as_encoded_bytes() {
        match byte {
            b'\\' if cfg!(windows) => address.push('/'),
            b'/' | b'.' | b'-' | b'_' | b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' => {
                address.push(char::from(byte))
            }
            byte => address += &format!("%{byte:02x}"),
        }
    }
    let is_drive = cfg!(windows) && !address.starts_with("file:/");
    let address = if is_drive { address.replacen("file:", "file:/", 1) } else { address };
    (!address.starts_with("file://")).then(|| address + "?immutable=1")
}
