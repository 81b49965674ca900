//! Tooltips: one sentence for each control, beside the panel that it is in.

use super::shown_keys::with_keys;
use super::{brush_tips, domain_tips, layer_tips, picture_tips, space_tips};
use egui::{Rect, RectAlign, Response, Tooltip, Ui, pos2};

/// Points at an edge of the window within which a panel counts as being at that edge.
const EDGE: f32 = 2.0;

/// The sentences of controls that have no unit or number in it, by the name of the control. The name of a
/// choice is that of its group and its own. A key is written as the id of its entry in braces, and what to
/// leave out where there is none, in brackets: `[; {undo}]`.
static SENTENCES: &[(&str, &str)] = &[
    ("Open background…", "Reads a picture to show behind the mesh; a world file beside it says where."),
    ("Tab/Size", "The target diameter: its limits, the curve from risk, gradation and budgets."),
    ("Tab/Inspect", "The queried triangle, pins, and why the triangle is in the mesh."),
    ("Tab/Paths", "Paths of least cost, other paths beside them, and what paths cost."),
    ("Tab/Mesh", "Levels, statistics, fit to the outline, plots, and how the mesh is made."),
    ("Tab/Domain", "The outline, the unit, the bounds, the pieces of the boundary and the background."),
    ("Tab/Method", "The figures of the report, and the walk of point location."),
    ("View options", "Edges, aids to orientation, colours and theme."),
    ("Overlays", "What the canvas shows in place of the colours of levels."),
    ("More options", "Options of the tool that are rarely needed, or that have no room on the strip."),
    ("Copy values", "Copies all values of the queried triangle[; {copy-the-values-of-the-triangle}]."),
    ("Overlay/No overlay", "Shows the levels of the mesh alone."),
    ("Overlay/Risk", "Shows the risk over the mesh, from 0 to 1[; {overlay-risk}]."),
    ("Overlay/Target", "Shows the level that h̄ asks for[; {overlay-target}]."),
    ("Overlay/Layer", "Shows which layer decides h̄, in the colour of the layer."),
    ("Overlay/Slack", "Shows where the mesh is finer than h̄ asks for, as the factor h̄ / h."),
    ("Overlay/Forced", "Shows the triangles that only compatibility asked for."),
    ("Overlay/Age", "Shows how many edits ago each triangle came."),
    (
        "Overlay/Depth",
        "Shows the depth of the water, from layers of depths, as a shaded relief with isobaths.",
    ),
    (
        "Overlay/Depth error",
        "Shows where depths that are linear over triangles are deeper or shallower than the grids.",
    ),
    ("Overlay/Surface", "Shows the height of surfaces as a shaded relief with contour lines."),
    ("Overlay/Surface error", "Shows where the mesh is higher (red) or lower (blue) than surfaces."),
    ("Overlay/Smallest angle", "Shows the smallest angle of each triangle: slivers are red."),
    ("Overlay/Largest angle", "Shows the largest angle of each triangle: obtuse ones are red."),
    (
        "Overlay/Edge ratio",
        "Shows the ratio of the longest to the shortest edge of each triangle: long thin ones are red.",
    ),
    (
        "Overlay/Longest edge / h̄",
        "Shows the ratio of the longest edge of each triangle to h̄ at its middle: red above 1, blue below 1.",
    ),
    (
        "Overlay/Time step",
        "Shows which triangles decide the time step of a solver: in red those where a wave needs least time along an edge.",
    ),
    (
        "Overlay/Triangles at a node",
        "Shows the most triangles at a corner of each triangle: 10 and more are red, which some solvers refuse.",
    ),
    (
        "Overlay/Link length",
        "Shows the shortest link between the centres of cells, by their size, with squares as Delft3D-FM gets them: red is removed.",
    ),
    (
        "Overlay/Orthogonality",
        "Shows the largest cosine between a link of Delft3D-FM and the edge that it crosses: 0 is orthogonal, red is refused.",
    ),
    ("Solver", "The solver whose rules the mesh is checked by, as its file would have it."),
    ("Colours/Viridis", "Violet over green to yellow; safe for colour-blind people."),
    ("Colours/Magma", "Black over purple and orange to pale yellow."),
    ("Colours/Cividis", "Navy to yellow; looks nearly the same with and without red-green blindness."),
    ("Colours/Turbo", "Blue over green to red, with many steps that can be told apart."),
    ("Colours/Greys", "Dark to light grey, for print."),
    (
        "Lower the smallest diameter",
        "Lowers h_min to the painted diameter, in the unit of the document; the risk curve stays.",
    ),
    (
        "Lower it and the risk curve",
        "Lowers h_min and h_risk to the painted diameter: layers of risk get finer, too.",
    ),
    ("Not now", "Keeps the smallest diameter; what was painted below it stays in the layer. Esc."),
    ("Keep the mesh", "Takes the edit back; the mesh stays as it is. Esc."),
    ("Apply anyway", "Lets the mesh have as many triangles as the edit needs, up to the budgets."),
    ("Keep the former", "Leads the path along the one before the proof, by a place in between."),
    ("h_max", "Target diameter at risk 0, in the unit of the document."),
    ("h_risk", "Target diameter at risk 1, in the unit of the document; at least h_min."),
    (
        "Curve shape",
        "Bends the curve between h_max and h_risk: its exponent, without a unit. Right-click for its default.",
    ),
    ("Layer", "Selects the layer. Drag it to another place; a double click[ or {rename-layer}] renames it."),
    ("Layer/visible", "Shows or hides the layer[ ({layer-is-visible})]; a hidden layer asks for nothing."),
    ("Layer/locked", "Locks or unlocks the layer; a locked layer cannot be painted on or changed."),
    ("New name of the layer", "Enter gives the layer this name, Escape keeps the old one."),
    ("Add layer", "Adds a layer above the selected one."),
    ("Duplicate layer", "Adds a copy of the selected layer above it, with its paint."),
    ("Delete layer", "Removes the selected layer."),
    ("Move layer up", "Moves the selected layer above the next one."),
    ("Move layer down", "Moves the selected layer below the next one."),
    (
        "Limit gradation",
        "Limits how fast h̄ may change with the distance, so that fine triangles pass gradually into coarse ones.",
    ),
    (
        "How the layer combines/Finest",
        "The smaller diameter counts: this layer can only make the mesh finer.",
    ),
    (
        "How the layer combines/Floor",
        "The larger diameter counts: nothing below this layer gets finer than it says.",
    ),
    (
        "How the layer combines/Replace",
        "This layer alone counts, wherever it asks for anything; the layers below do not.",
    ),
    ("Clear this layer", "Removes all paint of this layer."),
    ("Draw mask", "Selects the region tool: what you draw on the canvas is where the layer counts."),
    ("Draw shapes", "Selects the region tool: what you draw on the canvas joins the shapes of the layer."),
    ("Draw keep-out region", "Selects the region tool: paths stay out of what you draw on the canvas."),
    ("Mask from file…", "Reads polygons from a GeoJSON file: the layer counts only inside them."),
    ("Remove mask", "Removes the mask, so that the layer counts everywhere."),
    ("Add threat", "Adds a threat in the middle of the view, like the selected one."),
    (
        "Delete threat",
        "Removes the selected threat[; {delete-the-selected-threat} does so too while the tool Threats is selected].",
    ),
    ("Open table…", "Reads the threats of this layer from a table, in place of those that it has."),
    (
        "Save table…",
        "Writes the threats of this layer as a table with the columns x, y, range, peak and law.",
    ),
    (
        "How the risk falls/Radar",
        "At the distance r from a threat of range R: the peak up to r = R/2, then the peak × ((R/r)⁴ − 1) / 15, 0 from r = R.",
    ),
    (
        "How the risk falls/Gaussian",
        "At the distance r from a threat of range R: the peak × (e^(−4.5 (r/R)²) − e^(−4.5)) / (1 − e^(−4.5)), 0 from r = R.",
    ),
    (
        "How the risk falls/Disc",
        "At the distance r from a threat of range R: the peak up to r = 3R/4, then the peak × t² (3 − 2t) with t = 4 (1 − r/R), 0 from r = R.",
    ),
    ("Fine at low", "Makes the curve fine at the least values, and coarse at the greatest."),
    ("Fine near 0", "Makes the curve fine at the values nearest to 0, as in shallow water or at a shore."),
    ("Fine at high", "Makes the curve fine at the greatest values, and coarse at the least."),
    (
        "Only bisections",
        "The next and the previous step, and playing, go from bisection to bisection, then from one stage on the outline to another.",
    ),
    ("Add knot", "Adds a knot halfway between the two that are furthest apart; it changes no diameter."),
    (
        "Open shapes…",
        "Reads points, lines and polygons from a GeoJSON file, to measure the distance to them.",
    ),
    (
        "Show on the canvas",
        "Draws the triangles that led to the queried one, and a cross where the least target diameter is.",
    ),
    ("Parent", "Shows the triangle that this one is half of[; {go-to-the-parent-triangle}]."),
    ("Sibling", "Shows the other half of the parent[; {go-to-the-sibling}]."),
    ("First half", "Shows the first half of a bisected triangle[; {go-to-the-first-half}]."),
    ("Second half", "Shows the second half of a bisected triangle[; {go-to-the-second-half}]."),
    (
        "Coarse triangle",
        "Shows the triangle of the coarse grid that this one is part of[; {go-to-the-coarse-triangle}].",
    ),
    ("Queried triangle", "Shows the queried triangle again[; {go-back-to-the-queried-triangle}]."),
    ("Node of the triangle/No node", "Shows no node."),
    ("Node of the triangle/Apex", "Shows the node at the right angle, the newest one of the triangle."),
    ("Node of the triangle/End 1", "Shows the node at the first end of the bisection edge."),
    ("Node of the triangle/End 2", "Shows the node at the second end of the bisection edge."),
    (
        "Decided by",
        "What decides h̄ at the point: a layer, or the smallest or largest diameter of the document.",
    ),
    (
        "Through gradation from",
        "The place whose small diameter limits h̄ here, as h̄ may change no faster than the gradation.",
    ),
    (
        "Drag corners on the canvas",
        "Shows handles at two corners of the picture, which place and scale it over the domain.",
    ),
    ("Refinement rule/Area rule", "A triangle obeys h̄ everywhere inside it."),
    (
        "Refinement rule/Vertex rule",
        "A triangle obeys h̄ at its three corners only: Eq. (12) of the report “Mesh Generation via Local Bisection Refinement of Triangulated Grids”.",
    ),
    (
        "Cut with",
        "What cuts the domain: a brush, an outline by free hand, a polygon, a rectangle, a circle; Fill takes whole holes and parts. Frame draws the rectangle that the coarse grid covers.",
    ),
    ("What is drawn/Mask", "Draws the area in which the selected layer counts."),
    ("What is drawn/Keep out", "Draws a region that paths stay out of."),
    ("What is drawn/Shapes", "Draws shapes to which the selected layer, or a new one, measures."),
    (
        "Draw with",
        "A round brush, an outline by free hand, a polygon whose corners you click, a rectangle, a circle; Fill takes whole holes and parts. Among shapes also lines and points.",
    ),
    ("Add or cut/Add", "What you draw is added[; {cut-from-the-region} switches]."),
    ("Add or cut/Cut", "What you draw is cut away[; {cut-from-the-region} switches]."),
    ("Draw on", "The keep-out region that is drawn on, or a new one."),
    ("Add or remove/Remove", "The domain tool removes area[; {add-to-the-domain} switches]."),
    ("Add or remove/Add", "The domain tool adds area[; {add-to-the-domain} switches]."),
    ("Edges", "Draws the edges of the triangles[; {edges} switches]."),
    ("Coordinates", "Draws the coordinates along two sides of the canvas, in the unit of the document."),
    ("Graticule", "Draws meridians and parallels with their degrees, in documents on the Earth."),
    ("Levels", "Shows the levels of the mesh in their colours on the canvas, with diameters and counts."),
    ("Scale bar", "Draws a bar whose length on the canvas is written on it, in the unit of the document."),
    (
        "Contours of h̄",
        "Draws lines along which h̄ is the same, with their length in the unit of the document.",
    ),
    ("Theme/Dark", "Light text on a dark window."),
    ("Theme/Light", "Dark text on a light window."),
    ("Theme/Desktop", "Dark or light, as the desktop is set."),
    ("Plot", "Which figures of the mesh, or which times, are plotted[; {show-the-plots} opens this panel]."),
    (
        "Deepest level",
        "The finest mesh that is measured: the report goes to level 13 with 2,113,944 triangles.",
    ),
    ("Runs", "How often each mesh is made, in turn with the others; the least time counts."),
    (
        "Measure",
        "Makes the meshes of Section 5.4 of the report, and plots the time that they take on this machine.",
    ),
    ("Export plot…", "Writes the plot as a drawing (.svg) or as a table (.csv)."),
    ("Copy numbers", "Copies the numbers of the plot as a table."),
    ("Measuring", "Which run is made, and which of its meshes."),
    ("Cancel measuring", "Ends the measuring; what was measured so far stays."),
    ("Close the figure", "Closes the figure of the report; its document stays open."),
    ("Copy the comparison", "Copies what the report shows, and its numbers beside those here."),
    ("What paths cost/Weights", "A unit of length costs λ + κ · risk."),
    ("What paths cost/Formula", "A unit of length costs what a formula of x, y and risk says."),
    ("Corridor", "Shades all places on paths that cost little more than the best."),
    ("Alternatives", "Lists and draws the next best paths that differ substantially from the best."),
    ("Searching", "How many alternatives were found, and after how many the search ends."),
    ("Cancel search", "Ends the search for alternatives; those that were found stay."),
    (
        "Front",
        "Plots length against risk of the best paths, from the shortest to the safest; a click takes one.",
    ),
    ("Finding paths", "How many paths of the front were found."),
    ("Cancel front", "Ends the work on the front; what was found stays."),
    ("Shorter path", "Takes the weights of the next shorter path of the front."),
    ("Safer path", "Takes the weights of the next safer path of the front."),
    ("Prove within", "How narrow the proved interval around the least possible cost becomes."),
    ("Swap start and goal", "Lets the path go the other way."),
    (
        "Delete place",
        "Removes the selected place in between, or the path of a selected start or goal[; {delete-the-selected-place-of-a-path} does so too].",
    ),
    ("Delete all paths", "Removes all paths of the document."),
    (
        "Take the current path again",
        "Moves the corridor to the paths as they are now; it never moves by itself.",
    ),
    (
        "Add keep-out region…",
        "Reads polygons from a GeoJSON file: paths stay out of them from then on, and so does the proof.",
    ),
    (
        "Export path…",
        "Writes the path as .geojson, as a table (.csv), or as a picture with the mesh (.svg, .png).",
    ),
    ("Use the layer's mask", "Keeps paths out of the polygons of the selected layer's mask."),
    ("Remove keep-out region", "Lets paths through this region again."),
    (
        "Pin",
        "Marks the point and follows its triangle and values through every edit[; {pin-the-queried-point}].",
    ),
    (
        "Pin the query",
        "Marks the queried point and follows its triangle and values[; {pin-the-queried-point}].",
    ),
    (
        "Delete pin",
        "Removes the selected pin[; {delete-the-selected-pin} does so too while the query tool is selected].",
    ),
    ("Delete all pins", "Removes all pins of the document."),
    (
        "Copy table",
        "Copies the pins as the table that “meshbrush locate” prints for the saved document, with h̄ as the value.",
    ),
    (
        "Export table…",
        "Writes the pins as the table that “meshbrush locate” prints for the saved document, with h̄ as the value.",
    ),
    (
        "Walk",
        "Steps from triangle to triangle in which point location finds the point; their mean over 1,000 points of this mesh, and the report's bound 2^M_L.",
    ),
    (
        "Show the walk",
        "Draws the walk of point location from the triangle of the bucket to the queried point.",
    ),
    ("Show all levels", "Shows the hidden levels again."),
    ("Quantity/h̄", "The inspector interpolates the target diameter."),
    ("Quantity/Risk", "The inspector interpolates the risk, from 0 to 1."),
    ("Brush", "Paints risk or a target diameter."),
    ("Eraser", "Takes paint away, and the mesh coarsens."),
    ("Query", "Shows the triangle that you click and its neighbours."),
    ("Domain", "Adds area to the domain or removes it."),
    ("Line", "Draws lines along which the mesh has edges, and moves their corners."),
    ("Threats", "Places threats on the selected layer of threats, moves them and changes their ranges."),
    ("Boundary", "Names, splits and joins the pieces of the boundary, and sets their types for solvers."),
    ("Pan", "Moves the view."),
    ("Undo", "Takes back the last gesture."),
    ("Redo", "Does the last undone gesture again."),
    ("Fit domain", "Shows the whole domain."),
    (
        "h̄ · level",
        "What one stroke asks for where nothing is painted; in the mode Lower: what it leaves of risk 1.",
    ),
    ("Coarse grid", "Cells of the grid that bisection starts from: columns and rows."),
    ("Memory in use", "Memory that this document and its mesh take."),
    ("Kind", "What the piece bounds: outside, a hole, or an edge of the domain."),
    ("Length", "Length of the piece, in the unit of the document."),
    ("Marker in files", "The number that files give the edges of this piece."),
    ("Pixels", "Columns and rows of the picture."),
    ("Corners", "Corners of all polygons of the domain."),
    ("Picture", "The file of the picture behind the mesh."),
    ("Mesh", "The figures appear when the mesh is complete."),
    ("Triangles", "Triangles of the mesh, as files get it."),
    ("Nodes", "Nodes of the mesh, as files get it."),
    ("Area", "Area of all triangles."),
    ("Angles", "The smallest and the largest angle of all triangles."),
    (
        "Fingerprint",
        "Equal for equal meshes; the command line prints it as “hash”. A click copies it to the clipboard.",
    ),
    (
        "Level · orientation",
        "How often bisection made it; and the order of the report. Here and in files v₁ v₂ v₃ are anticlockwise.",
    ),
    ("Diameter", "The longest edge of the triangle, in the unit of the document."),
    ("Point", "The x and y that you clicked, in the unit of the document."),
    ("Lies", "Where in the triangle the point is."),
    ("ζ₁ ζ₂ ζ₃", "Barycentric coordinates of the point: its weights for v₁, v₂ and v₃, which add up to 1."),
    ("At v₁ v₂ v₃", "The values at the vertices."),
    ("Interpolated", "The value at the point, interpolated linearly from the vertices."),
    ("True (difference)", "The value of the field at the point, and by how much the interpolation differs."),
    ("Leave the steps", "Shows the mesh of the document again; Escape does so too."),
    ("First step", "Goes back to the coarse grid."),
    ("Previous step", "Takes the last step back."),
    ("Play the steps", "Goes forwards by itself, until the end."),
    ("Pause the steps", "Stops at this step."),
    ("Next step", "Runs the next step."),
    ("Last step", "Goes to the end of the refinement."),
    ("From step", "The first step to be exported; 0 is the coarse grid."),
    ("To step", "The last step to be exported."),
    (
        "Export steps…",
        "Writes a drawing of each of these steps as SVG or PNG, by the ending of the name, to a file with its number.",
    ),
    ("Ground of the drawings/On dark", "Draws the steps on a dark ground."),
    ("Ground of the drawings/On light", "Draws the steps on a light ground, as for paper."),
    ("Step", "How many steps are done. Drag to go to any of them."),
    ("Steps per second/1", "Plays 1 step in a second."),
    ("Steps per second/3", "Plays 3 steps in a second."),
    ("Steps per second/10", "Plays 10 steps in a second."),
    ("Steps per second/30", "Plays 30 steps in a second."),
    ("Steps per second/300", "Plays 300 steps in a second."),
    (
        "Nodes on outline",
        "Nodes of the boundary that lie on the outline. The others would make an angle too small, or an edge longer than its target.",
    ),
    ("Islands kept", "Islands of the outline that are no part of the mesh."),
    ("Net area", "Area of the mesh without that of the outline."),
    ("Misclassified", "Area that only the mesh or only the outline covers."),
    ("Largest part removed", "Triangles of the largest part that was removed. A click goes there."),
];

/// Returns the sentence for a control, or an empty text.
pub fn sentence(name: &str) -> &'static str {
    let all = SENTENCES
        .iter()
        .chain(domain_tips::SENTENCES)
        .chain(layer_tips::SENTENCES)
        .chain(brush_tips::SENTENCES)
        .chain(picture_tips::SENTENCES)
        .chain(space_tips::SENTENCES);
    all.into_iter().find(|(known, _)| *known == name).map_or("", |(_, text)| text)
}

/// Adds a sentence to a control, for the pointer and for screen readers.
///
/// It appears beside the panel that the control is in, so that it covers no other control.
pub fn explain(ui: &Ui, response: Response, text: &str) -> Response {
    explain_with(ui, response, text, |ui| drop(ui.label(with_keys(ui.ctx(), text).into_owned())))
}

/// Explains a widget as [`explain`] does, also with entries in place of their keys, with `contents` in the
/// tooltip at the pointer.
pub fn explain_with(ui: &Ui, response: Response, text: &str, contents: impl FnOnce(&mut Ui)) -> Response {
    if text.is_empty() {
        return response;
    }
    let text = &*with_keys(ui.ctx(), text);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(text));
    // A dialog that has opened since covers the control.
    if !ui.memory(|memory| memory.allows_interaction(response.layer_id)) {
        return response;
    }
    let mut tooltip = Tooltip::for_enabled(&response);
    if let Some((beside, align)) = place(ui.clip_rect(), ui.ctx().content_rect(), response.rect) {
        tooltip.popup = tooltip.popup.anchor(beside).align(align).gap(8.0);
    }
    tooltip.show(contents);
    response
}

/// Returns the place of the tooltip or a message of a control at `rect`, if its panel is at the left or right
/// edge of the window.
pub(super) fn place(panel: Rect, window: Rect, rect: Rect) -> Option<(Rect, RectAlign)> {
    let at_right = panel.right() > window.right() - EDGE && panel.left() > window.center().x;
    let at_left = panel.left() < window.left() + EDGE && panel.right() < window.center().x;
    let row = |x: f32| Rect::from_min_max(pos2(x, rect.top()), pos2(x, rect.bottom()));
    match (at_left, at_right) {
        (false, true) => Some((row(panel.left()), RectAlign::LEFT_START)),
        (true, false) => Some((row(panel.right()), RectAlign::RIGHT_START)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tooltips_are_beside_the_panel_and_not_over_it() {
        let window = Rect::from_min_max(pos2(0.0, 0.0), pos2(1000.0, 600.0));
        let panel = Rect::from_min_max(pos2(680.0, 36.0), pos2(1000.0, 570.0));
        let control = Rect::from_min_max(pos2(700.0, 100.0), pos2(980.0, 124.0));
        let (beside, align) = place(panel, window, control).unwrap();
        assert_eq!((beside.left(), align), (680.0, RectAlign::LEFT_START));
        let strip = Rect::from_min_max(pos2(0.0, 36.0), pos2(52.0, 570.0));
        let (beside, align) = place(strip, window, control).unwrap();
        assert_eq!((beside.left(), align), (52.0, RectAlign::RIGHT_START));
        assert!(place(window, window, control).is_none());
    }

    #[test]
    fn every_sentence_ends_with_a_full_stop_and_every_name_occurs_once() {
        let all: Vec<_> = SENTENCES
            .iter()
            .chain(domain_tips::SENTENCES)
            .chain(layer_tips::SENTENCES)
            .chain(brush_tips::SENTENCES)
            .chain(picture_tips::SENTENCES)
            .chain(space_tips::SENTENCES)
            .collect();
        for (number, (name, text)) in all.iter().enumerate() {
            assert!(text.ends_with('.'), "{name}: {text}");
            assert!(all[..number].iter().all(|(other, _)| other != name), "{name}");
        }
    }
}
