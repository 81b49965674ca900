//! Why the queried triangle is in the mesh, and the way through the bisection tree.

use eframe::egui::{RichText, Ui};
use glam::DVec2;

use super::TreeStep;
use crate::app::features::inspection::{ExploreCommand, InspectCommand, Inspector};
use meshbrush_core::explain::{Explanation, NodeFacts, Words};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::view::CanvasAid;
use meshbrush_kit::kit::{FrameState, Panel, Tab, remark};
use meshbrush_mesh::mesh::{Mesh, TreeTriangle, bisection_edge_length};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{
    Chip, Icon, Section, ValueRow, chips, empty_state, format, segmented, toggle_row,
};

/// The cause of the queried triangle, and its place in the tree.
pub static WHY: Panel = Panel { name: "why", tab: Tab::Inspect, place: 3, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Why this triangle").reveal(WHY.is_revealed(state)).show(ui, |ui| {
        let (Some(explanation), Some(shown)) = (
            state.feature::<Inspector>().explore.explanation(),
            state.feature::<Inspector>().explore.shown(),
        ) else {
            let text = if state.readout.is_some() {
                "The explanation appears when the mesh is complete."
            } else {
                "Query a triangle: what asked for it appears here."
            };
            return empty_state(ui, Icon::QUERY, "No explanation", text);
        };
        sentences(ui, state, explanation);
        chain_chips(ui, state, commands);
        let mut drawn = state.view.aids.cause;
        if toggle_row(ui, "Show on the canvas", &mut drawn).changed() {
            commands.push(Command::from(ViewCommand::ToggleAid(CanvasAid::Cause)));
        }
        ui.add_space(6.0);
        path_chips(ui, state, commands);
        triangle_rows(ui, state, shown);
        node_rows(ui, state, commands);
    });
}

fn sentences(ui: &mut Ui, state: &FrameState<'_>, explanation: &Explanation) {
    let follower = state.session.follower();
    let words = Words {
        mesh: follower.mesh(),
        edge_lengths: follower.field().edge_lengths(),
        layers: &follower.settings().layers,
        unit: state.unit(),
    };
    for sentence in words.sentences(explanation) {
        ui.label(RichText::new(sentence).font(font::body()).color(tokens(ui).text));
        ui.add_space(3.0);
    }
}

/// The triangles from the one that exceeds its target to the parent. A click goes to one.
fn chain_chips(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let chain = state.feature::<Inspector>().explore.chain();
    if chain.is_empty() {
        return;
    }
    remark(ui, "From the triangle that required it to its parent, by level:");
    let accent = tokens(ui).accent;
    let faint = tokens(ui).faint;
    let here = state.feature::<Inspector>().explore.link();
    chips(ui, |ui| {
        for (place, link) in chain.iter().enumerate() {
            let text = link.level().to_string();
            let name = format!("Triangle {} of the chain", place + 1);
            let color = if here == Some(place) { accent } else { faint };
            let help = "Shows this triangle of the chain; its number is its level.";
            if Chip::new(color, &text, &name).help(help).show(ui).clicked() {
                step(TreeStep::Link(place), commands);
            }
        }
    });
    ui.add_space(4.0);
}

/// The way from the coarse triangle down to the queried one. A click goes to a triangle on it.
fn path_chips(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let path = state.feature::<Inspector>().explore.path_down(state.session.mesh());
    let (Some(shown), false) = (state.feature::<Inspector>().explore.shown(), path.is_empty()) else {
        return;
    };
    remark(ui, "Down the bisection tree, by level:");
    let (accent, faint) = (tokens(ui).accent, tokens(ui).faint);
    chips(ui, |ui| {
        for ancestor in &path {
            let level = ancestor.level();
            let color = if ancestor.is_same(shown) { accent } else { faint };
            let name = format!("Ancestor of level {level}");
            let help = "Shows the triangle of this level that the queried one is a part of.";
            if Chip::new(color, &level.to_string(), &name).help(help).show(ui).clicked() {
                step(TreeStep::Ancestor(level), commands);
            }
        }
    });
    ui.add_space(4.0);
}

fn step(step: TreeStep, commands: &mut Vec<Command>) {
    commands.push(Command::from(InspectCommand::Explore(ExploreCommand::Step(step))));
}

/// Level, size and state of the shown triangle.
fn triangle_rows(ui: &mut Ui, state: &FrameState<'_>, shown: &TreeTriangle) {
    let mesh = state.session.mesh();
    let diameter = bisection_edge_length(mesh.lattice().spacing(), shown.level());
    let title =
        if state.feature::<Inspector>().explore.is_away() { "Shown triangle" } else { "Queried triangle" };
    let level = format!("level {}", shown.level());
    ValueRow::new(title, &level).help("The triangle of the bisection tree that is shown.").show(ui);
    let help = "The length of its bisection edge, in the unit of the document.";
    ValueRow::new("Its diameter", &format::length(diameter, state.unit())).help(help).show(ui);
    let (text, help) = match (mesh.is_bisected(shown), mesh.entry_of(shown)) {
        (true, _) => ("was bisected", "Its halves, or parts of them, are in the mesh."),
        (_, Some(_)) => ("in the mesh", "No bisection has divided it."),
        _ => ("not in the mesh", "It would come into being by a bisection."),
    };
    ValueRow::new("State", text).help(help).show(ui);
}

/// The node at a corner of the shown triangle.
fn node_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    let before = state.feature::<Inspector>().explore.corner();
    let mut corner = before;
    let choices = [(None, "No node"), (Some(0), "Apex"), (Some(1), "End 1"), (Some(2), "End 2")];
    if segmented(ui, "Node of the triangle", &mut corner, &choices).changed() {
        commands.push(Command::from(InspectCommand::Explore(ExploreCommand::ShowCorner(corner))));
    }
    let mesh = state.session.mesh();
    let Some(node) = state.feature::<Inspector>().explore.node(mesh) else { return };
    ui.add_space(4.0);
    for (label, value, help) in node_values(state, mesh, &node) {
        ValueRow::new(label, &value).help(help).show(ui);
    }
}

fn node_values(
    state: &FrameState<'_>,
    mesh: &Mesh,
    node: &NodeFacts,
) -> Vec<(&'static str, String, &'static str)> {
    let world = |at| mesh.lattice().world_from_lattice(at);
    let place = |at: DVec2| state.place_text(at).values.join(" ");
    let at = world(node.at);
    let paint = state.session.document().paint();
    let target = state.session.follower().field().target_at(paint, at);
    let mut rows = vec![
        ("Node at", place(at), "The x and y of the node, in the unit of the document."),
        ("Adjacent nodes", node.adjacent.len().to_string(), "Nodes that share an edge with it."),
        (
            "h at the node",
            format::length(node.diameter, state.unit()),
            "Distance to the farthest adjacent node.",
        ),
        ("h̄ at the node", format::length(target, state.unit()), "The target diameter at the node."),
    ];
    match node.parents {
        Some([from, to]) => {
            rows.push(("First parent node", place(world(from)), PARENT_HELP));
            rows.push(("Second parent node", place(world(to)), PARENT_HELP));
        }
        None => rows.push(("Parent nodes", "none: a coarse node".into(), PARENT_HELP)),
    }
    let help = "Nodes whose bisection needed this node; they go before it does.";
    rows.push(("Dependent nodes", node.dependents.len().to_string(), help));
    rows
}

const PARENT_HELP: &str = "The node came into being in the middle between its parent nodes.";
