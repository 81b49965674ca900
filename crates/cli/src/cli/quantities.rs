//! Named values at the nodes: `--quantity NAME=EXPR` and `--quantity-grid NAME=FILE`.

use std::path::PathBuf;

use glam::DVec2;

use super::args::QuantityArguments;
use super::build::FinishedMesh;
use super::failure::Failure;
use super::grid_source::GridSource;
use meshbrush_core::field::Formula;
use meshbrush_core::field::formula::ParseError;
use meshbrush_io::io::settings::SavedQuantityGrid;
use meshbrush_io::io::{DEPTH, NodeValues};
use meshbrush_mesh::mesh::Extract;

/// The name of a value that is given without one.
const DEFAULT_NAME: &str = "quantity";
/// Names that files use for other data.
const TAKEN: [&str; 3] = ["target_diameter", "boundary", "level"];

/// A value at the nodes, before there is a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedQuantity {
    name: String,
    source: QuantitySource,
}

/// Where the values come from.
#[derive(Clone, Debug, PartialEq)]
enum QuantitySource {
    Formula(Formula),
    Grid(GridSource),
}

/// Returns the values that are asked for, in their order.
///
/// # Errors
/// Fails when a formula or a name is wrong, or a name comes twice; with the number of the quantity, from 0.
pub fn parse_quantities(typed: &[String]) -> Result<Vec<NamedQuantity>, (usize, QuantityError)> {
    let mut quantities: Vec<NamedQuantity> = Vec::new();
    for (index, text) in typed.iter().enumerate() {
        let (name, expression) = split(text);
        check_name(name, &quantities).map_err(|error| (index, error))?;
        let formula = Formula::parse_of_size(expression).map_err(|mistake| (index, mistake.into()))?;
        quantities.push(NamedQuantity { name: name.to_owned(), source: QuantitySource::Formula(formula) });
    }
    Ok(quantities)
}

/// Refuses a name that files use otherwise, or another quantity has.
fn check_name(name: &str, others: &[NamedQuantity]) -> Result<(), QuantityError> {
    let is_taken = TAKEN.contains(&name) || others.iter().any(|other| other.name == name);
    if is_taken { Err(QuantityError::Name(name.to_owned())) } else { Ok(()) }
}

/// Returns the values that `--quantity`, `--quantity-grid` and `--quantity-table` ask for.
///
/// # Errors
/// Fails with a sentence that names the option, the value and the rule.
pub fn typed_quantities(typed: &QuantityArguments) -> Result<Vec<NamedQuantity>, Failure> {
    let parsed = parse_quantities(&typed.quantity);
    let mut quantities = parsed.map_err(|(index, error)| match error {
        QuantityError::Formula(mistake) => {
            let pointer = mistake.pointer().replace('\n', "\n    ");
            Failure::Usage(format!("--quantity: {mistake}\n    {pointer}"))
        }
        error => Failure::Usage(format!("--quantity {}: {error}", typed.quantity[index])),
    })?;
    let mut tables = Vec::new();
    for text in &typed.quantity_table {
        let (name, file) = named_file("--quantity-table", text, "manning=classes.csv")?;
        if tables.iter().any(|(other, _)| *other == name) {
            return Err(Failure::Usage(format!("--quantity-table {text}: {name} has a table already.")));
        }
        tables.push((name, file));
    }
    for text in &typed.quantity_grid {
        let (name, file) = named_file("--quantity-grid", text, "manning=landcover.tif")?;
        let place = tables.iter().position(|(of, _)| *of == name);
        let table = place.map(|place| tables.swap_remove(place).1);
        let grid = SavedQuantityGrid { name: name.to_owned(), file, table };
        let quantity = NamedQuantity::of_grid(&grid, &quantities);
        quantities
            .push(quantity.map_err(|error| Failure::Usage(format!("--quantity-grid {text}: {error}")))?);
    }
    match tables.first() {
        Some((name, table)) => Err(Failure::Usage(format!(
            "--quantity-table {name}={}: there is no grid of {name}. Name one with --quantity-grid {name}=FILE.",
            table.display()
        ))),
        None => Ok(quantities),
    }
}

/// Returns the name and the file of NAME=FILE.
fn named_file<'a>(option: &str, text: &'a str, example: &str) -> Result<(&'a str, PathBuf), Failure> {
    let pair = text.split_once('=').map(|(name, file)| (name.trim(), file.trim()));
    match pair.filter(|(name, file)| is_name(name) && !file.is_empty()) {
        Some((name, file)) => Ok((name, PathBuf::from(file))),
        None => Err(Failure::Usage(format!("{option} {text}: write NAME=FILE, as in {example}."))),
    }
}

/// Why a quantity cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum QuantityError {
    /// Files use the name for something else.
    #[error("the name {0} is taken. Give another one, as in depth=EXPR.")]
    Name(String),
    /// It is no name.
    #[error("“{0}” is no name: letters, digits and underscores make one, as in manning.")]
    NoName(String),
    /// The formula has a mistake.
    #[error(transparent)]
    Formula(#[from] ParseError),
    /// The file is no grid, or the table of classes is of no use.
    #[error("{0}")]
    File(String),
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
    /// Returns the values of a grid, beside `others`.
    ///
    /// # Errors
    /// Fails when the name is none or taken, there is no such file of a grid, or its table is of no use.
    pub fn of_grid(saved: &SavedQuantityGrid, others: &[Self]) -> Result<Self, QuantityError> {
        let name = saved.name.trim();
        if !is_name(name) {
            return Err(QuantityError::NoName(name.to_owned()));
        }
        check_name(name, others)?;
        let grid = GridSource::new(saved).map_err(QuantityError::File)?;
        Ok(Self { name: name.to_owned(), source: QuantitySource::Grid(grid) })
    }

    /// Returns its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns whether files take it for the depth.
    pub fn is_depth(&self) -> bool {
        self.name == DEPTH
    }

    /// Returns whether its formula uses the depth of layers.
    pub fn uses_depth(&self) -> bool {
        matches!(&self.source, QuantitySource::Formula(formula) if formula.uses_depth())
    }

    /// Returns the files that it reads.
    pub fn files(&self) -> Vec<PathBuf> {
        match &self.source {
            QuantitySource::Formula(_) => Vec::new(),
            QuantitySource::Grid(grid) => grid.files(),
        }
    }

    /// Returns what it is called in sentences.
    fn called(&self) -> String {
        if self.name == DEFAULT_NAME { "quantity".into() } else { format!("quantity {}", self.name) }
    }

    /// Returns the mistake of a formula that uses the depth where there is none.
    pub fn without_depths(&self) -> Failure {
        let formula = match &self.source {
            QuantitySource::Formula(formula) => format!(" is {}, and", formula.source().trim()),
            QuantitySource::Grid(_) => String::new(),
        };
        Failure::Usage(format!(
            "The {}{formula} `depth` in it is the depth of layers at a node, but no visible layer has depths. Name a grid \
             of them: on the command line with --depth, in a recipe in a layer of the kind \"depth\".",
            self.called(),
        ))
    }

    /// Returns the values at the nodes of a mesh, where layers have these `depths`, in metres; and adds to
    /// `notes` what a person should know about them.
    ///
    /// # Errors
    /// Fails when a node has no value, or none that is finite, the formula uses the depth and there is none,
    /// or the file of a grid is of no use.
    pub fn at_nodes(
        &self,
        finished: &FinishedMesh,
        mesh: &Extract,
        depths: Option<&[f64]>,
        notes: &mut Vec<String>,
    ) -> Result<NodeValues, Failure> {
        let values = match &self.source {
            QuantitySource::Formula(formula) => self.of_formula(formula, mesh, depths)?,
            QuantitySource::Grid(grid) => grid.at_nodes(&self.called(), finished, mesh, notes)?,
        };
        Ok(NodeValues { name: self.name.clone(), values })
    }

    fn of_formula(
        &self,
        formula: &Formula,
        mesh: &Extract,
        depths: Option<&[f64]>,
    ) -> Result<Vec<f64>, Failure> {
        if formula.uses_depth() && depths.is_none() {
            return Err(self.without_depths());
        }
        let value = |(node, p): (usize, DVec2)| {
            let value = match depths {
                Some(depths) => formula.eval_with_depth(p.x, p.y, depths[node]),
                None => formula.eval(p.x, p.y),
            };
            if value.is_finite() {
                return Ok(value);
            }
            Err(Failure::Work(format!(
                "The {} is {value} at x = {}, y = {}: files need a finite number at every node.",
                self.called(),
                p.x,
                p.y
            )))
        };
        mesh.world_nodes().enumerate().map(value).collect()
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
