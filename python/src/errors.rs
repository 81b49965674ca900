//! Errors as the classes of the package.

use std::fmt::Display;

use meshbrush_core::field::formula::ParseError;
use meshbrush_io::io::recipe::LoadError;
use meshbrush_io::io::{FaultPart, Flaw, KeyFault, KeyStep, Mark, ReadError, TextValue};
use pyo3::BoundObject;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Returns an error of a class of the package.
fn error_of(class: &str, arguments: impl for<'py> IntoPyObject<'py, Target = PyTuple>) -> PyErr {
    Python::attach(|py| {
        let made = py.import("meshbrush._errors").and_then(|errors| {
            let arguments = arguments.into_pyobject(py).map_err(Into::into)?.into_bound();
            errors.getattr(class)?.call1(arguments)
        });
        made.map_or_else(|error| error, PyErr::from_value)
    })
}

/// Returns an error that is no fault of a file or a formula.
pub fn mesh_error(sentence: impl Display) -> PyErr {
    error_of("MeshError", (sentence.to_string(),))
}

/// Returns the error of a file that cannot be read or written.
pub fn file_error(sentence: impl Display) -> PyErr {
    error_of("FileError", (sentence.to_string(),))
}

/// Returns the error of a file with the number that the system has for it.
fn system_error(sentence: impl Display, errno: Option<i32>) -> PyErr {
    error_of("FileError", (sentence.to_string(), errno))
}

/// The number of the system for a file that is not there.
const NOT_THERE: i32 = 2;
/// Keys whose values name files.
const FILE_KEYS: [&str; 5] = ["region", "land", "open", "file", "mask_file"];

/// Returns whether a value names a file that is not there.
fn names_no_file(fault: &KeyFault) -> bool {
    let of_file = |step: &KeyStep| matches!(step, KeyStep::Key(key) if FILE_KEYS.contains(&&**key));
    fault.mark == Mark::Entry && fault.path.last().is_some_and(of_file)
}

/// Returns the error for a mistake in a formula. `position` counts characters.
fn formula_error(sentence: String, pointer: &str, formula: &str, position: usize) -> PyErr {
    let pointer = pointer.replace('\n', "\n    ");
    error_of("FormulaError", (format!("{sentence}\n    {pointer}"), formula.to_owned(), position))
}

/// Returns the error for a mistake in a formula with a name.
pub fn mistake_in(name: &str, formula: &str, mistake: &ParseError) -> PyErr {
    let position = formula[..mistake.span().start].chars().count();
    formula_error(format!("{name}: {mistake}"), mistake.pointer(), formula, position)
}

/// Returns the error for a value of a table that cannot be used. Of a formula it has the place of the
/// mistake.
pub fn fault_in(tables: &TextValue, fault: &KeyFault) -> PyErr {
    match fault.part.as_deref() {
        Some(FaultPart { pointer, position }) => {
            let formula = text_at(tables, &fault.path).unwrap_or_default();
            formula_error(without_table(fault).to_string(), pointer, formula, *position)
        }
        _ if names_no_file(fault) => system_error(without_table(fault), Some(NOT_THERE)),
        _ => mesh_error(without_table(fault)),
    }
}

/// Returns the fault without the name of its table, which nobody types in Python.
fn without_table(fault: &KeyFault) -> KeyFault {
    let is_table = |step: &KeyStep| matches!(step, KeyStep::Key(key) if matches!(&**key, "domain" | "mesh" | "limits" | "paths" | "layer"));
    let mut fault = fault.clone();
    if fault.path.len() > 1 && is_table(&fault.path[0]) {
        fault.path.remove(0);
    }
    fault
}

fn text_at<'a>(tables: &'a TextValue, path: &[KeyStep]) -> Option<&'a str> {
    let end = path.iter().try_fold(tables, |value, step| match (value, step) {
        (TextValue::Table(entries), KeyStep::Key(key)) => {
            entries.iter().find(|(known, _)| known == key).map(|(_, value)| value)
        }
        (TextValue::List(list), KeyStep::Index(index)) => list.get(*index),
        _ => None,
    })?;
    if let TextValue::Text(text) = end { Some(text) } else { None }
}

/// Returns the error for a file that is of no use.
pub fn read_error(error: &ReadError) -> PyErr {
    let errno = match &error.flaw {
        Flaw::Io(error) => error.raw_os_error(),
        _ => None,
    };
    system_error(error, errno)
}

/// Returns the error for settings that cannot be loaded.
pub fn load_error(tables: &TextValue, error: &LoadError) -> PyErr {
    match error {
        LoadError::Read(error) => read_error(error),
        LoadError::Value(fault) => fault_in(tables, fault),
        LoadError::Data(_) | LoadError::Coarse(_) | LoadError::Unsuited(_) => mesh_error(error),
    }
}
