//! Sentences of the controls of the domain and its boundary, as [`tips`](super::tips) has them.

/// The sentences, by the name of the control.
pub(super) static SENTENCES: &[(&str, &str)] = &[
    (
        "Boundary treatment/On outline",
        "Moves nodes onto the outline, with all angles between 18.4° and 143.2°.",
    ),
    (
        "Boundary treatment/Fitted",
        "Keeps the triangles whose centroid is inside: the boundary is a staircase.",
    ),
    (
        "Boundary treatment/As in report",
        "Keeps coarse triangles with three corners inside: Appendix A of the report “Mesh Generation via Local Bisection Refinement of Triangulated Grids”.",
    ),
    ("Parts that stay/Largest part", "Only the largest connected part of the mesh stays."),
    ("Parts that stay/Large parts", "Connected parts with at least a given share of the area stay."),
    ("Parts that stay/All parts", "All connected parts of the mesh stay."),
    (
        "Keep pinched nodes",
        "Keeps triangles that meet others only in a node; most solvers do not accept them.",
    ),
    (
        "Improve triangles along it",
        "Slides nodes along the outline and adds some inside: angles of at least 25° where it allows them, no triangle with all nodes on it, at most 8 triangles at a node.",
    ),
    ("Unit", "What coordinates and lengths mean; numbers are not converted."),
    ("Left", "Smallest x of the domain, in the unit of the document."),
    ("Bottom", "Smallest y of the domain, in the unit of the document."),
    ("Right", "Largest x of the domain, in the unit of the document."),
    ("Top", "Largest y of the domain, in the unit of the document."),
    (
        "Open domain…",
        "Reads polygons from a file as the domain of a new document, and asks whether degrees are to be metres.",
    ),
    (
        "Add outline…",
        "Reads polygons from a GeoJSON file as the domain of this document, and keeps the paint.",
    ),
    ("Whole rectangle", "Makes the whole rectangle the domain."),
    ("What a click does/Select", "A click selects a piece of the boundary[; {select-or-split} switches]."),
    ("What a click does/Split", "A click ends a piece of the boundary there[; {select-or-split} switches]."),
    (
        "Along the frame",
        "Opens all of the boundary that lies on the rectangle around it, in the coordinates of its file.",
    ),
    ("In polygons…", "Opens all of the boundary that lies in the polygons of a file."),
    (
        "Open where deeper",
        "Opens all of the boundary where the water is deeper than this, by the layers of depths.",
    ),
    ("Join with next", "Makes one piece of this one and the next along the boundary."),
    ("Type", "What the piece is for coastal solvers: open, land or an inflow, and how land treats the flow."),
    (
        "Draw by",
        "What a press does: sets the next corner of a line, or begins a line by free hand, a rectangle or a circle, or sets an end of the deepest way; or it selects a line and moves its corners.",
    ),
    (
        "Snap",
        "Corners snap to ends, corners and segments of lines, and to the outline, within 8 points[; {snap-corners-of-lines} switches]. Alt does the opposite.",
    ),
    ("Draw lines", "Selects the line tool: click each corner of a line on the canvas."),
    ("Add lines…", "Reads lines and polygons from a file, along which the mesh that files get has edges."),
    ("Zoom to line", "Shows all of the selected line."),
    ("Delete line", "Deletes the selected line."),
    ("Delete all lines", "Deletes all lines of the document."),
];
