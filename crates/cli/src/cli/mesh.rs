//! `meshbrush mesh`: build, check, write, summarise.

use std::io::Write;

use super::args::{DepthArguments, MeshArguments};
use super::build::FinishedMesh;
use super::cut_strips::build_suited;
use super::depths::{ChangedDepths, LeastDepth};
use super::details::{DetailUses, MeshDetails, StraitSummary, provenance};
use super::failure::Failure;
use super::input::Input;
use super::output::Output;
use super::output_coordinates::OutputCoordinates;
use super::partition;
use super::requested_files::RequestedFiles;
use super::sequence::{self, SequenceStart};
use super::standard_output;
use super::summary::Summary;
use super::terminal::Terminal;
use meshbrush_core::layers::{CourantFit, DepthSlope, SurfaceNorm};
use meshbrush_core::surface::SampleCount;
use meshbrush_io::io::ThirdCoordinate;
use meshbrush_mesh::mesh::{Extract, TriangleId};
use meshbrush_mesh::text::{Grouped, digits};

/// How many broken invariants are printed one by one; the rest are counted.
const SHOWN_VIOLATIONS: usize = 20;

/// Runs the command. `line` is how it was typed, and `out` is standard output.
///
/// # Errors
/// Fails with the reason, when the arguments make no sense or the work failed.
pub fn run(
    typed: &MeshArguments,
    line: &str,
    out: &mut dyn Write,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let mut input = Input::new(&typed.input)?.scaled(checked_scale(typed)?);
    let by_options = RequestedFiles::of_options(typed)?;
    check_stdout(typed, &by_options.outputs)?;
    note_without_effect(typed, &input, &by_options.outputs, terminal);
    let files = all_files(typed, &input, by_options)?;
    input.check_depth_for(files.iter().find_map(RequestedFiles::of_depth))?;
    let named = [(typed.cut_strips_for, "--cut-strips-for"), (typed.repair_for, "--repair-for")];
    let (finished, suited) = build_suited(&mut input, named, terminal)?;
    let writes = files.iter().any(|files| !files.outputs.is_empty());
    let wants_details = typed.json || writes;
    let extract = if wants_details { finished.extract() } else { finished.extract_as_made() };
    let coordinates = coordinates_in_files(typed, &files, &finished);
    let violations = match typed.checks {
        true => Some(report_violations(&finished, &extract, finished.max_level(), terminal)?),
        false => None,
    };
    let node_data = files.iter().any(RequestedFiles::wants_node_data);
    let given_depth = files.iter().find_map(RequestedFiles::depth);
    let depth_changes = files.iter().find_map(RequestedFiles::depth_changes).unwrap_or_default();
    let uses = DetailUses { json: typed.json, node_data, given_depth, depth_changes };
    let (details, mut summary) = terminal.while_working("measuring the mesh", || {
        let details =
            wants_details.then(|| MeshDetails::of(&finished, &extract, line, &input, coordinates, uses));
        let details = details.transpose()?;
        let summary = Summary::of(&finished, &extract, details.as_ref(), violations);
        Ok::<_, Failure>((details, summary))
    })?;
    if !typed.json {
        terminal.say(&summary.for_people());
    }
    summary.suited = suited.told(terminal);
    note_changed_depths(typed.depths, details.as_ref(), terminal);
    note_shortcomings(&input, &finished, &extract, details.as_ref(), terminal);
    let origin = || provenance(&finished, line, &input, OutputCoordinates::Plane);
    typed.curve.write((&finished, &extract), details.as_ref(), origin, terminal)?;
    let of_mesh = (&finished, &extract);
    summary.partition =
        partition::write(typed.parts_for, &files, of_mesh, details.as_ref(), coordinates, terminal)?;
    if let Some(details) = details.filter(|_| writes) {
        let start = SequenceStart { finished: &finished, extract: &extract, files: &files, coordinates };
        summary.sequence = start.write(typed.sequence, details, uses, terminal)?;
    }
    if typed.json {
        let json = serde_json::to_string(&summary).map_err(|e| Failure::Print(e.into()))?;
        writeln!(out, "{json}").and_then(|()| out.flush()).map_err(Failure::Print)?;
    }
    match violations {
        Some(broken) if broken > 0 => Err(Failure::Work(format!(
            "The mesh breaks {} rules. Please report this, with the command.",
            Grouped(broken)
        ))),
        _ => Ok(()),
    }
}

/// Returns the files of the recipe and of the options, which can be written.
fn all_files(
    typed: &MeshArguments,
    input: &Input,
    by_options: RequestedFiles,
) -> Result<Vec<RequestedFiles>, Failure> {
    let mut files = input.recipe.as_ref().map(RequestedFiles::of_recipe).transpose()?.unwrap_or_default();
    files.push(by_options);
    let by_options =
        |files: RequestedFiles| files.divided(typed.parts_for).with_depth_changes(typed.depths.into());
    let files: Vec<RequestedFiles> = files.into_iter().map(by_options).collect();
    let all: Vec<Output> = files.iter().flat_map(|files| files.outputs.clone()).collect();
    partition::check(typed, &all)?;
    let inputs: Vec<_> =
        input.files().into_iter().chain(files.iter().flat_map(RequestedFiles::read_files)).collect();
    let first_files = sequence::first_files(typed, files.clone())?;
    let has_lines = input.has_lines();
    first_files.iter().try_for_each(|files| files.check_places(&inputs, has_lines))?;
    typed.curve.check(&inputs)?;
    Ok(files)
}

/// Returns the coordinates in files: those that are asked for, the plane where all formats need lengths, or
/// else those of the domain's file.
fn coordinates_in_files(
    typed: &MeshArguments,
    files: &[RequestedFiles],
    finished: &FinishedMesh,
) -> OutputCoordinates {
    let mut outputs = files.iter().flat_map(|files| &files.outputs).peekable();
    let need_lengths = outputs.peek().is_some() && outputs.all(Output::needs_lengths);
    let usual = || if need_lengths { OutputCoordinates::Plane } else { finished.coordinates().into() };
    typed.out_crs.unwrap_or_else(usual)
}

/// Returns what all sizes are multiplied by.
fn checked_scale(typed: &MeshArguments) -> Result<f64, Failure> {
    match typed.scale {
        Some(scale) if typed.curve.certificate.is_some() => Err(Failure::Usage(format!(
            "--scale {scale}: a certificate states the targets of the layers themselves. Leave one of them out, or \
             change the sizes in the document."
        ))),
        scale => Ok(scale.unwrap_or(1.0)),
    }
}

/// Tells the user what the mesh does not keep.
fn note_shortcomings(
    input: &Input,
    finished: &FinishedMesh,
    extract: &Extract,
    details: Option<&MeshDetails>,
    terminal: &mut Terminal,
) {
    note_capped(finished, terminal);
    note_filled(details, terminal);
    details.into_iter().flat_map(|details| &details.quantity_notes).for_each(|note| terminal.note(note));
    note_courant(details, terminal);
    note_straits(finished, extract, details, terminal);
    note_far_from_surface(finished, extract, details, terminal);
    note_idle_marks(input, finished, extract, terminal);
}

/// Tells the user when triangles are coarser than asked for, because of the level cap.
pub fn note_capped(finished: &FinishedMesh, terminal: &mut Terminal) {
    if finished.capped > 0 {
        let count = Grouped(finished.capped);
        terminal.note(&format!("--max-level left {count} triangles coarser than their target."));
    }
}

/// Tells the user which nodes have a depth from elsewhere.
fn note_filled(details: Option<&MeshDetails>, terminal: &mut Terminal) {
    let Some(depths) = details.and_then(|details| details.depths.as_ref()) else { return };
    if depths.filled > 0 {
        let (filled, nodes) = (Grouped(depths.filled), Grouped(depths.depths.len()));
        terminal.note(&format!(
            "{filled} of {nodes} nodes are where no raster of depths has a value; they have that of the nearest pixel, at \
             most {:.1} away.",
            depths.farthest
        ));
    }
}

/// Tells the user how depths differ from those of layers or of a quantity, or that nothing has depths.
fn note_changed_depths(asked: DepthArguments, details: Option<&MeshDetails>, terminal: &mut Terminal) {
    let ChangedDepths { least, slope } = details.map(|details| details.changed_depths).unwrap_or_default();
    for (option, is_idle) in [
        ("--least-depth", asked.least_depth.is_some() && least.is_none()),
        ("--depth-slope", asked.depth_slope.is_some() && slope.is_none()),
    ] {
        if is_idle {
            terminal.note(&format!(
                "{option} changes nothing: nothing is written with depths (--depth, or --quantity depth=EXPR)."
            ));
        }
    }
    if let Some(LeastDepth { depth, raised: raised @ 1.. }) = least {
        let nodes = Grouped(raised);
        terminal
            .note(&format!("{nodes} nodes are less than {depth} m deep, and are written with {depth} m."));
    }
    if let Some(slope) = slope {
        terminal.note(&slope_in_words(slope));
    }
}

/// Returns a sentence about depths that were smoothed, and one about dry nodes.
fn slope_in_words(slope: DepthSlope) -> String {
    let DepthSlope { limit, before, changed, largest, at, more_water, dry, .. } = slope;
    let dry = match dry {
        0 => String::new(),
        dry => format!(
            " {} nodes are dry (a depth of 0 or less): their edges have no r-factor, and stay; --least-depth makes them wet.",
            Grouped(dry)
        ),
    };
    if changed == 0 {
        return format!("No edge has an r-factor above {limit}: depths are written as they are.{dry}");
    }
    let way = if largest > 0.0 { "deeper" } else { "shallower" };
    format!(
        "The largest r-factor of an edge was {}, and is {limit} now: {} nodes have another depth, the largest change is {} m \
         ({way}), at x = {}, y = {}, and there is {} % more water.{dry}",
        digits(before, 3),
        Grouped(changed),
        digits(largest.abs(), 3),
        at.x,
        at.y,
        digits(100.0 * more_water, 2),
    )
}

/// Tells the user how many edges exceed the Courant number of a layer.
fn note_courant(details: Option<&MeshDetails>, terminal: &mut Terminal) {
    let Some(fit) = details.and_then(|details| details.courant).filter(|fit| fit.above > 0) else { return };
    let CourantFit { limit, time_step, edges, above, largest, at } = fit;
    terminal.note(&format!(
        "{} of {} edges have a Courant number above {limit} with the time step {time_step} s; the largest is {largest:.3}, \
         at x = {}, y = {}. Neighbours that must fit together, nodes on the outline and steep bottoms make edges shorter \
         than the layer asks for. The largest time step that keeps {limit} everywhere is {:.3} s.",
        Grouped(above),
        Grouped(edges),
        at.x,
        at.y,
        time_step * limit / largest,
    ));
}

/// Tells the user that straits have fewer triangles than a layer asks for.
fn note_straits(
    finished: &FinishedMesh,
    extract: &Extract,
    details: Option<&MeshDetails>,
    terminal: &mut Terminal,
) {
    let counted = details.and_then(|details| details.straits.clone());
    let counted = counted.or_else(|| StraitSummary::of(finished.layers(), extract, finished.domain()));
    let smallest = finished.smallest_diameter();
    if let Some(sentence) = counted.and_then(|counted| counted.sentence(smallest)) {
        terminal.note(&sentence);
    }
}

/// Share by which sums of the same numbers may differ.
const ROUNDING: f64 = 1e-12;

/// Tells the user where the mesh is farther from a surface than asked for, and which nodes have no height.
fn note_far_from_surface(
    finished: &FinishedMesh,
    extract: &Extract,
    details: Option<&MeshDetails>,
    terminal: &mut Terminal,
) {
    let Some(fit) = details.and_then(|details| details.surface.as_ref()) else { return };
    let without = fit.heights.iter().filter(|height| height.is_none()).count();
    if without > 0 {
        terminal.note(&format!(
            "{} of {} nodes are more than 64 pixels from every value of the surface; in files they have the mean \
             height of the nodes around them.",
            Grouped(without),
            Grouped(fit.heights.len())
        ));
    }
    let rule = finished.built().surface.as_ref();
    if let Some(count) = rule.map(|rule| rule.samples().count()).filter(|count| count.missing > 0) {
        let SampleCount { known, missing } = count;
        terminal.note(&format!(
            "{} of {} samples of the surface in the domain, {:.2} %, have no value: they are left out. --outside-nodata \
             takes their area out of the domain.",
            Grouped(missing),
            Grouped(known + missing),
            100.0 * count.missing_share()
        ));
    }
    let asked = |norm| rule.and_then(|rule| rule.error_of(norm));
    if asked(SurfaceNorm::Largest).is_some() && rule.is_some_and(|rule| fit.largest > rule.largest_allowed())
    {
        let reason = match extract.is_patched() {
            true => "nodes were moved onto the outline, or the surface jumps",
            false => "the surface jumps there, and no mesh is closer",
        };
        terminal.note(&format!(
            "The mesh is {} from the surface at x = {}, y = {}: {reason}.",
            fit.largest, fit.at.x, fit.at.y
        ));
    }
    for (norm, name) in [
        (SurfaceNorm::RootMeanSquare, "difference from the surface"),
        (SurfaceNorm::Gradient, "difference of its gradient from that of the surface"),
    ] {
        // Sums in another order differ by less.
        if let Some(asked) = asked(norm).filter(|asked| fit.error(norm) > asked * (1.0 + ROUNDING)) {
            terminal.note(&format!(
                "The mesh has a root mean square {name} of {}, and {asked} was to be reached: nodes were moved onto the \
                 outline, or no triangle can be bisected further.",
                fit.error(norm)
            ));
        }
    }
}

/// Tells the user about names, types and splits of a recipe that have no effect on the boundary of a formula,
/// which is that of the mesh. For other domains that was said when the recipe was read.
fn note_idle_marks(input: &Input, finished: &FinishedMesh, extract: &Extract, terminal: &mut Terminal) {
    if input.settings.domain.has_marks() && finished.domain().formula().is_some() {
        let notes = finished.boundary(extract).pieces().idle_marks(finished.marks());
        notes.iter().for_each(|note| terminal.note(note));
    }
}

/// Checks every invariant, prints the violations, and returns their number.
fn report_violations(
    finished: &FinishedMesh,
    extract: &Extract,
    max_level: Option<u32>,
    terminal: &mut Terminal,
) -> Result<usize, Failure> {
    let mesh = finished.mesh();
    // Triangles at the level cap count as satisfied.
    let below_cap = |id: &TriangleId| max_level.is_none_or(|cap| mesh.triangle(*id).level() < cap);
    let (broken, unsatisfied, in_derived) = terminal.while_working("checking the mesh", || {
        (mesh.violations(), finished.unsatisfied(), finished.derived.violations(extract))
    });
    for violation in broken.iter().take(SHOWN_VIOLATIONS) {
        terminal.say(&format!("check: {violation}"));
    }
    let too_coarse = unsatisfied?.iter().filter(|id| below_cap(id)).count();
    if too_coarse > 0 {
        let count = Grouped(too_coarse);
        terminal.say(&format!("check: {count} triangles exceed their target diameter (Eq. 14)"));
    }
    for violation in in_derived.iter().take(SHOWN_VIOLATIONS) {
        terminal.say(&format!("check: {violation}"));
    }
    let count = broken.len() + in_derived.len() + too_coarse;
    if count == 0 {
        terminal.say("check: every invariant of the mesh holds");
    }
    Ok(count)
}

/// Names the options that change nothing.
fn note_without_effect(typed: &MeshArguments, input: &Input, outputs: &[Output], terminal: &mut Terminal) {
    let mut notes = input.options_without_effect(&typed.input);
    if !typed.quantities.quantity.is_empty() && !outputs.iter().any(Output::wants_node_data) {
        notes.push("--quantity changes nothing: no file with data is written (-o).".into());
    }
    if !typed.quantities.quantity_grid.is_empty() && !outputs.iter().any(Output::wants_node_data) {
        notes.push("--quantity-grid changes nothing: no file with data is written (-o).".into());
    }
    if typed.format.is_some() && !outputs.iter().any(Output::is_named) {
        notes.push("--format changes nothing: the endings of the files (-o) choose their formats.".into());
    }
    let has_heights = |output: &Output| output.third_coordinate() != ThirdCoordinate::None;
    if typed.flat && !outputs.iter().any(has_heights) {
        notes.push("--flat changes nothing: no file with heights is written (-o).".into());
    }
    if typed.binary && !outputs.iter().any(Output::is_binary) {
        notes.push(
            "--binary changes nothing: no .msh is written (-o), and other formats have one form.".into(),
        );
    }
    let differs = typed.picture.differs_from_default() || typed.space.differs_from_default();
    if differs && !outputs.iter().any(Output::is_picture) {
        notes.push("The options on pictures change nothing: no .svg or .png is written (-o).".into());
    }
    notes.iter().for_each(|note| terminal.note(note));
}

/// Standard output is for one result.
fn check_stdout(typed: &MeshArguments, outputs: &[Output]) -> Result<(), Failure> {
    let results = outputs.iter().filter(|output| output.is_stdout()).count() + usize::from(typed.json);
    if results > 1 {
        let problem = "-o - and --json both print on standard output, and -o - can be there once";
        return Err(Failure::Usage(format!("{problem}. Write all but one to files.")));
    }
    if results > 0 { standard_output::check().map_err(Failure::Print) } else { Ok(()) }
}
