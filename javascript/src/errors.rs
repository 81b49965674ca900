//! Errors as sentences, which `index.js` throws.

use std::fmt::Display;

use meshbrush_core::build::BuildError;
use meshbrush_core::field::Formula;
use meshbrush_core::field::formula::ParseError;
use meshbrush_mesh::mesh::RefineError;
use meshbrush_mesh::text::Number;
use wasm_bindgen::JsError;

/// Returns an error with a sentence.
pub fn error(sentence: impl Display) -> JsError {
    JsError::new(&sentence.to_string())
}

/// Returns the error for a number that breaks a rule.
pub fn refused(key: &str, value: f64, rule: &str) -> JsError {
    error(format_args!("{key}: {} cannot be used: {rule}.", Number(value)))
}

/// Compiles a formula, as `parse` does.
///
/// # Errors
/// Fails with the lines that point at the mistake.
pub fn compiled(
    key: &str,
    text: &str,
    parse: fn(&str) -> Result<Formula, ParseError>,
) -> Result<Formula, JsError> {
    parse(text).map_err(|mistake| {
        let pointer = mistake.pointer().replace('\n', "\n    ");
        error(format_args!("{key}: {mistake}\n    {pointer}"))
    })
}

/// Returns why there is no mesh, with advice.
pub fn build_sentence(problem: &BuildError) -> String {
    let advice = match problem {
        BuildError::Refine(RefineError::TooManyTriangles { .. }) => " Raise hMin, or raise maxTriangles.",
        BuildError::Refine(RefineError::TooMuchMemory { .. }) => " Raise hMin, or raise maxMemory.",
        BuildError::Refine(RefineError::TooFine { .. }) => " Raise hMin, or mesh a smaller domain.",
        _ => "",
    };
    format!("{problem}{advice}")
}
