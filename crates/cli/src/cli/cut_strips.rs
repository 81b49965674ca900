//! Meshes of a sea without the strips in which its frame runs along a coast: `mesh --cut-strips-for` and
//! `check --cut-strips`.

use serde::Serialize;

use super::build::{FinishedMesh, build};
use super::failure::Failure;
use super::input::Input;
use super::repair::{RepairSummary, build_for};
use super::terminal::Terminal;
use meshbrush_io::io::recipe;
use meshbrush_io::io::settings::{SavedDomain, SavedRing, SavedSettings};
use meshbrush_io::io::solver_rules::{BrokenPlace, Solver, StripCutting};
use meshbrush_mesh::text::{Grouped, Number};

/// What was cut off a domain for a solver.
#[derive(Clone, Debug, Serialize)]
pub struct CutSummary {
    /// The word of the solver.
    #[serde(rename = "for")]
    solver: &'static str,
    /// The strips that were cut off.
    strips: usize,
    /// The rings around them, as the key of the same name in a recipe has them.
    cut_off: Vec<SavedRing>,
    /// The strips that are left.
    left: Vec<LeftStrip>,
    #[serde(skip)]
    name: &'static str,
    #[serde(skip)]
    as_recipe: String,
}

/// A strip that is left.
#[derive(Clone, Debug, Serialize)]
struct LeftStrip {
    /// In the plane of the mesh.
    place: [f64; 2],
    sentence: String,
}

/// What was done so that a mesh suits a solver.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Suited {
    /// What was cut off the domain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut_strips: Option<CutSummary>,
    /// Which triangles were bisected once more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repaired: Option<RepairSummary>,
}

/// Builds the mesh of an input: without strips along the frame, if the first solver is named, and then
/// repaired, if the second one is. Beside each solver is the option that names it. The rings are added to
/// those of the input.
///
/// # Errors
/// Fails when a solver takes strips as they are, a file cannot be used, or no mesh can be made.
pub fn build_suited(
    input: &mut Input,
    [(cut_for, cut_option), (repair_for, repair_option)]: [(Option<Solver>, &str); 2],
    terminal: &mut Terminal,
) -> Result<(FinishedMesh, Suited), Failure> {
    let cut = cut_for.map(|solver| cut_strips(input, solver, cut_option, terminal)).transpose()?;
    match cut {
        Some((finished, cut)) if repair_for.is_none() => {
            Ok((finished, Suited { cut_strips: Some(cut), repaired: None }))
        }
        cut => {
            let (finished, repaired) =
                build_for(input, repair_for.map(|solver| (solver, repair_option)), terminal)?;
            Ok((finished, Suited { cut_strips: cut.map(|(_, cut)| cut), repaired }))
        }
    }
}

impl Suited {
    /// Tells what was done.
    pub fn told(self, terminal: &mut Terminal) -> Self {
        let cut = self.cut_strips.as_ref().map(CutSummary::for_people);
        let repaired = self.repaired.as_ref().map(RepairSummary::for_people);
        cut.iter().chain(&repaired).for_each(|sentence| terminal.note(sentence));
        self
    }
}

/// Cuts the strips off the domain of an input, and returns its mesh.
fn cut_strips(
    input: &mut Input,
    solver: Solver,
    option: &str,
    terminal: &mut Terminal,
) -> Result<(FinishedMesh, CutSummary), Failure> {
    let name = solver.name();
    let mut cutting = StripCutting::new(solver).ok_or_else(|| {
        Failure::Usage(format!(
            "{option}: {name} has no rule on strips between an open boundary and a coast. Leave it out."
        ))
    })?;
    let own = input.settings.domain.cut_off.clone();
    loop {
        let finished = build(input, terminal)?;
        // What is said about the files was said by now.
        input.is_quiet = true;
        if !cutting.look(&finished.extract_as_made(), finished.domain(), finished.marks()) {
            let summary = CutSummary::new(solver, &cutting, &input.settings.domain.cut_off);
            return Ok((finished, summary));
        }
        input.settings.domain.cut_off = own.iter().chain(cutting.rings()).cloned().collect();
    }
}

impl CutSummary {
    fn new(solver: Solver, cutting: &StripCutting, cut_off: &[SavedRing]) -> Self {
        let domain = SavedDomain { cut_off: cut_off.to_vec(), ..SavedDomain::default() };
        let recipe = recipe::to_text(&SavedSettings { domain, ..SavedSettings::default() });
        let start = recipe.find("cut_off").unwrap_or(recipe.len());
        let left =
            |found: &BrokenPlace| LeftStrip { place: found.place.into(), sentence: found.sentence.clone() };
        Self {
            solver: solver.word(),
            strips: cutting.cut(),
            cut_off: cutting.rings().to_vec(),
            left: cutting.left().iter().map(left).collect(),
            name: solver.name(),
            as_recipe: recipe[start..].to_owned(),
        }
    }

    /// Returns sentences: how many strips were cut off, and which are left.
    pub fn for_people(&self) -> String {
        let strips = match self.strips {
            0 => "no strip was".to_owned(),
            1 => "1 strip was".to_owned(),
            count => format!("{} strips were", Grouped(count)),
        };
        let left: Vec<String> = self.left.iter().map(LeftStrip::in_words).collect();
        format!("For {} {strips} cut off along the frame.{}", self.name, left.concat())
    }

    /// Returns the same sentences, and where something was cut off the key of a recipe that has all rings.
    pub fn with_recipe(&self) -> String {
        let sentences = self.for_people();
        match self.cut_off.is_empty() {
            true => format!("\n{sentences}\n"),
            false => format!(
                "\n{sentences}\nIn the table [domain] of a recipe, this key cuts it off:\n\n{}",
                self.as_recipe
            ),
        }
    }
}

impl LeftStrip {
    fn in_words(&self) -> String {
        let [x, y] = self.place.map(Number);
        format!(" At x = {x}, y = {y} one is left: {}", self.sentence)
    }
}
