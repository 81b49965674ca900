//! The problem that is solved on the mesh. It does not change the mesh.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Deserializer, Error, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use crate::io::{KeyFault, KeyStep, Number};
use meshbrush_core::field::Formula;
use meshbrush_fem::fem::{BoundaryCondition, FemProblem, NamedCondition};

/// `[problem]`: −∇·(a∇u) + b·∇u + c u = f, with conditions by the name of a piece of the boundary.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedProblem {
    /// a; 1 where it is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diffusion: Option<SavedFormula>,
    /// b along x and y; none where it is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub convection: Option<[SavedFormula; 2]>,
    /// c; 0 where it is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reaction: Option<SavedFormula>,
    /// f; 0 where it is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<SavedFormula>,
    /// u on pieces of the boundary.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub dirichlet: BTreeMap<String, SavedFormula>,
    /// a ∂u/∂n on pieces of the boundary.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub neumann: BTreeMap<String, SavedFormula>,
    /// α and g of a ∂u/∂n + α u = g on pieces of the boundary.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub robin: BTreeMap<String, [SavedFormula; 2]>,
    /// A formula of the solution, where it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exact: Option<SavedFormula>,
}

/// A formula as a text, or a number.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedFormula(pub String);

impl SavedFormula {
    fn parsed(&self, key: impl Into<KeyStep>) -> Result<Formula, KeyFault> {
        Formula::parse(&self.0).map_err(|mistake| KeyFault::mistake(key, &self.0, 0, &mistake))
    }
}

impl SavedProblem {
    /// Returns whether nothing is said.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the problem with what `options` say in place of its own. A condition of the options replaces
    /// that of the same piece, of whatever kind.
    pub fn overridden_by(mut self, options: &Self) -> Self {
        let Self { diffusion, convection, reaction, source, dirichlet, neumann, robin, exact } =
            options.clone();
        let names = dirichlet.keys().chain(neumann.keys()).chain(robin.keys());
        for name in names {
            self.dirichlet.remove(name);
            self.neumann.remove(name);
            self.robin.remove(name);
        }
        self.dirichlet.extend(dirichlet);
        self.neumann.extend(neumann);
        self.robin.extend(robin);
        Self {
            diffusion: diffusion.or(self.diffusion),
            convection: convection.or(self.convection),
            reaction: reaction.or(self.reaction),
            source: source.or(self.source),
            exact: exact.or(self.exact),
            ..self
        }
    }

    /// Returns the problem.
    ///
    /// # Errors
    /// Fails for the first formula that has a mistake.
    pub fn problem(&self) -> Result<FemProblem, KeyFault> {
        let default = FemProblem::default();
        let parsed = |formula: &Option<SavedFormula>, key, default: Formula| {
            formula.as_ref().map_or(Ok(default), |formula| formula.parsed(key))
        };
        let along = |formulas: &[SavedFormula; 2]| Ok([formulas[0].parsed(0)?, formulas[1].parsed(1)?]);
        let mut conditions = Vec::new();
        let read = |name: &String, formula: &SavedFormula, kind: &'static str| {
            formula.parsed(name.clone()).map_err(|fault| fault.within(kind))
        };
        for (name, value) in &self.dirichlet {
            let condition = BoundaryCondition::Dirichlet(read(name, value, "dirichlet")?);
            conditions.push(NamedCondition { piece: name.clone(), condition });
        }
        for (name, flux) in &self.neumann {
            let condition = BoundaryCondition::Neumann(read(name, flux, "neumann")?);
            conditions.push(NamedCondition { piece: name.clone(), condition });
        }
        for (name, formulas) in &self.robin {
            let fault = |fault: KeyFault| fault.within(name.clone()).within("robin");
            let [transfer, flux] = along(formulas).map_err(fault)?;
            let condition = BoundaryCondition::Robin { transfer, flux };
            conditions.push(NamedCondition { piece: name.clone(), condition });
        }
        let convection = self.convection.as_ref().map(along).transpose();
        Ok(FemProblem {
            diffusion: parsed(&self.diffusion, "diffusion", default.diffusion)?,
            convection: convection.map_err(|fault| fault.within("convection"))?,
            reaction: parsed(&self.reaction, "reaction", default.reaction)?,
            source: parsed(&self.source, "source", default.source)?,
            conditions,
        })
    }

    /// Returns the formula of the solution, where there is one.
    ///
    /// # Errors
    /// Fails when it has a mistake.
    pub fn solution(&self) -> Result<Option<Formula>, KeyFault> {
        self.exact.as_ref().map(|exact| exact.parsed("exact")).transpose()
    }
}

impl Serialize for SavedFormula {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.0)
    }
}

impl<'de> Deserialize<'de> for SavedFormula {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(FormulaVisitor)
    }
}

struct FormulaVisitor;

impl Visitor<'_> for FormulaVisitor {
    type Value = SavedFormula;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a formula such as \"1 + x\", or a number")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<SavedFormula, E> {
        Ok(SavedFormula(text.to_owned()))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<SavedFormula, E> {
        Ok(SavedFormula(Number(number).to_string()))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<SavedFormula, E> {
        Ok(SavedFormula(number.to_string()))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<SavedFormula, E> {
        Ok(SavedFormula(number.to_string()))
    }
}
