//! The problem that options and recipe describe.

use std::collections::BTreeMap;

use super::args::ProblemArguments;
use super::failure::Failure;
use super::options::parse_formula;
use meshbrush_core::field::Formula;
use meshbrush_fem::fem::FemProblem;
use meshbrush_io::io::settings::{SavedFormula, SavedProblem};

/// Returns the problem of a recipe with what options say in place of its own, and the formula of its
/// solution, if there is one.
///
/// # Errors
/// Fails with a sentence that names the option, the value and the rule.
pub fn problem(
    typed: &ProblemArguments,
    of_recipe: &SavedProblem,
) -> Result<(FemProblem, Option<Formula>), Failure> {
    let formula = |option: &str, text: &Option<String>| {
        let checked = |text: &String| parse_formula(option, text).map(|_| SavedFormula(text.clone()));
        text.as_ref().map(checked).transpose()
    };
    let along = typed.convection.as_ref().map(|texts| {
        texts.iter().try_for_each(|text| parse_formula("--convection", text).map(|_| ()))?;
        let formula = |n: usize| SavedFormula(texts.get(n).cloned().unwrap_or_default());
        Ok::<_, Failure>([formula(0), formula(1)])
    });
    let options = SavedProblem {
        diffusion: formula("--diffusion", &typed.diffusion)?,
        convection: along.transpose()?,
        reaction: formula("--reaction", &typed.reaction)?,
        source: formula("--source", &typed.source)?,
        dirichlet: by_piece("--dirichlet", &typed.dirichlet, |text| one("--dirichlet", text))?,
        neumann: by_piece("--neumann", &typed.neumann, |text| one("--neumann", text))?,
        robin: by_piece("--robin", &typed.robin, two)?,
        exact: formula("--exact", &typed.exact)?,
    };
    let saved = of_recipe.clone().overridden_by(&options);
    let fault = |fault: meshbrush_io::io::KeyFault| Failure::Usage(fault.full_sentence());
    Ok((saved.problem().map_err(fault)?, saved.solution().map_err(fault)?))
}

/// Reads `NAME=…` of an option that may be repeated, each name once.
fn by_piece<T>(
    option: &str,
    typed: &[String],
    value: impl Fn(&str) -> Result<T, Failure>,
) -> Result<BTreeMap<String, T>, Failure> {
    let mut pieces = BTreeMap::new();
    for text in typed {
        let named = text.split_once('=').map(|(name, rest)| (name.trim(), rest));
        let Some((name, rest)) = named.filter(|(name, rest)| !name.is_empty() && !rest.starts_with('='))
        else {
            let problem =
                format!("{option} {text}: write the name of a piece of the boundary before the formula");
            return Err(Failure::Usage(format!("{problem}, as in 'all=0' or 'open west=1 + y'.")));
        };
        if pieces.insert(name.to_owned(), value(rest)?).is_some() {
            return Err(Failure::Usage(format!("{option} {text}: “{name}” has one already. Leave one out.")));
        }
    }
    Ok(pieces)
}

fn one(option: &str, text: &str) -> Result<SavedFormula, Failure> {
    parse_formula(option, text).map(|_| SavedFormula(text.trim().to_owned()))
}

fn two(text: &str) -> Result<[SavedFormula; 2], Failure> {
    let Some((transfer, flux)) = text.split_once(';') else {
        return Err(Failure::Usage(format!(
            "--robin …={text}: write α and g with a semicolon between them, as in 'coast=2;1 + x'."
        )));
    };
    Ok([one("--robin", transfer)?, one("--robin", flux)?])
}
