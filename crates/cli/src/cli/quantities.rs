//! Named values at the nodes: `--quantity NAME=EXPR`.

use glam::DVec2;

use super::failure::Failure;
use meshbrush_core::field::Formula;
use meshbrush_core::field::formula::ParseError;
use meshbrush_io::io::{DEPTH, NodeValues};
use meshbrush_mesh::mesh::Extract;

/// The name of a value that is given without one.
const DEFAULT_NAME: &str = "quantity";
/// Names that files use for other data.
const TAKEN: [&str; 3] = ["target_diameter", "boundary", "level"];

/// A value at the nodes, before there is a mesh.
#[derive(Clone, Debug)]
pub struct NamedQuantity {
    name: String,
    formula: Formula,
}

/// Returns the values that are asked for, in their order.
///
/// # Errors
/// Fails when a formula or a name is wrong, or a name comes twice; with the number of the quantity, from 0.
pub fn parse_quantities(typed: &[String]) -> Result<Vec<NamedQuantity>, (usize, QuantityError)> {
    let mut quantities: Vec<NamedQuantity> = Vec::new();
    for (index, text) in typed.iter().enumerate() {
        let (name, expression) = split(text);
        if TAKEN.contains(&name) || quantities.iter().any(|other| other.name == name) {
            return Err((index, QuantityError::Name(name.to_owned())));
        }
        let formula = Formula::parse(expression).map_err(|mistake| (index, mistake.into()))?;
        quantities.push(NamedQuantity { name: name.to_owned(), formula });
    }
    Ok(quantities)
}

/// Returns the values that `--quantity` asks for.
///
/// # Errors
/// Fails with a sentence that names the option, the value and the rule.
pub fn typed_quantities(typed: &[String]) -> Result<Vec<NamedQuantity>, Failure> {
    parse_quantities(typed).map_err(|(index, error)| match error {
        QuantityError::Name(_) => Failure::Usage(format!("--quantity {}: {error}", typed[index])),
        QuantityError::Formula(mistake) => {
            let pointer = mistake.pointer().replace('\n', "\n    ");
            Failure::Usage(format!("--quantity: {mistake}\n    {pointer}"))
        }
    })
}

/// Why a quantity cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum QuantityError {
    /// Files use the name for something else.
    #[error("the name {0} is taken. Give another one, as in depth=EXPR.")]
    Name(String),
    /// The formula has a mistake.
    #[error(transparent)]
    Formula(#[from] ParseError),
}

/// Returns the formula of a quantity with a name, or the whole text without one: its end in any case.
pub fn expression(text: &str) -> &str {
    split(text).1
}

/// Returns the name and formula. A comparison (`==`) is part of the formula.
fn split(text: &str) -> (&str, &str) {
    if let Some((name, expression)) = text.split_once('=')
        && !expression.starts_with('=')
        && is_name(name.trim())
    {
        return (name.trim(), expression);
    }
    (DEFAULT_NAME, text)
}

/// Letters, digits and underscores, not beginning with a digit: what all formats can hold.
fn is_name(text: &str) -> bool {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.chars().all(is_word) && text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

impl NamedQuantity {
    /// Returns whether files take it for the depth.
    pub fn is_depth(&self) -> bool {
        self.name == DEPTH
    }

    /// Returns the values at the nodes of a mesh.
    ///
    /// # Errors
    /// Fails when one is not finite.
    pub fn at_nodes(&self, mesh: &Extract) -> Result<NodeValues, Failure> {
        let Self { name, formula } = self;
        let value = |p: DVec2| {
            let value = formula.eval(p.x, p.y);
            if value.is_finite() {
                return Ok(value);
            }
            let called = if name == DEFAULT_NAME { "quantity".into() } else { format!("quantity {name}") };
            Err(Failure::Work(format!(
                "The {called} is {value} at x = {}, y = {}: files need a finite number at every node.",
                p.x, p.y
            )))
        };
        let values = mesh.world_nodes().map(value).collect::<Result<_, _>>()?;
        Ok(NodeValues { name: name.clone(), values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_comes_before_one_equals_sign() {
        for (text, name, expression) in [
            ("x*y", "quantity", "x*y"),
            ("depth=x*y", "depth", "x*y"),
            ("n_2 = 3", "n_2", " 3"),
            ("x == y", "quantity", "x == y"),
            ("x <= y", "quantity", "x <= y"),
            ("depth=x == y", "depth", "x == y"),
            ("2a=x", "quantity", "2a=x"),
        ] {
            assert_eq!(split(text), (name, expression), "{text}");
        }
    }
}
