//! The text of the algorithms, to show which line is run.
//!
//! T and N are the arrays 𝒯 and 𝒩 of the report; v and n are the copies that its algorithms call V and N.

/// How the neighbours of the halves are found: one of the report's six routines.
///
/// k and O are those of the triangles before they are bisected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NeighbourCase {
    /// `UpdateNeighbours1`: (k, O, O_b) = (1, 0, 0) or (2, 1, 1).
    Pair1,
    /// `UpdateNeighbours2`: (1, 1, 0) or (2, 0, 1).
    Pair2,
    /// `UpdateNeighbours3`: (1, 0, 1) or (2, 1, 0).
    Pair3,
    /// `UpdateNeighbours4`: (1, 1, 1) or (2, 0, 0).
    Pair4,
    /// `UpdateBoundaryNeighbours1`: (k, O) = (1, 0) or (2, 1).
    Boundary1,
    /// `UpdateBoundaryNeighbours2`: (1, 1) or (2, 0).
    Boundary2,
}

impl NeighbourCase {
    /// Returns the case of a triangle with k and O(t), and of O(t_b) where it has a bisection neighbour.
    pub fn of(k: u8, orientation: u8, orientation_across: Option<u8>) -> Self {
        match (k, orientation, orientation_across) {
            (1, 0, Some(0)) | (2, 1, Some(1)) => Self::Pair1,
            (1, 1, Some(0)) | (2, 0, Some(1)) => Self::Pair2,
            (1, 0, Some(1)) | (2, 1, Some(0)) => Self::Pair3,
            (_, _, Some(_)) => Self::Pair4,
            (1, 0, None) | (2, 1, None) => Self::Boundary1,
            (_, _, None) => Self::Boundary2,
        }
    }

    /// Returns the algorithm that the case is.
    pub fn algorithm(self) -> Algorithm {
        match self {
            Self::Pair1 => Algorithm::UpdateNeighbours1,
            Self::Pair2 => Algorithm::UpdateNeighbours2,
            Self::Pair3 => Algorithm::UpdateNeighbours3,
            Self::Pair4 => Algorithm::UpdateNeighbours4,
            Self::Boundary1 => Algorithm::UpdateBoundaryNeighbours1,
            Self::Boundary2 => Algorithm::UpdateBoundaryNeighbours2,
        }
    }
}

/// An algorithm of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Algorithm {
    BisectTriangles,
    UpdateNeighbours1,
    RefineTriangle,
    BisectTrianglesInStack,
    RefineMesh,
    BisectBoundaryTriangle,
    UpdateNeighbours2,
    UpdateNeighbours3,
    UpdateNeighbours4,
    UpdateBoundaryNeighbours1,
    UpdateBoundaryNeighbours2,
    KeepByCentroid,
    FitToOutline,
    Clean,
}

impl Algorithm {
    /// All of them, in the order of their numbers, and then those that are not in the report.
    pub const ALL: [Self; 14] = [
        Self::BisectTriangles,
        Self::UpdateNeighbours1,
        Self::RefineTriangle,
        Self::BisectTrianglesInStack,
        Self::RefineMesh,
        Self::BisectBoundaryTriangle,
        Self::UpdateNeighbours2,
        Self::UpdateNeighbours3,
        Self::UpdateNeighbours4,
        Self::UpdateBoundaryNeighbours1,
        Self::UpdateBoundaryNeighbours2,
        Self::KeepByCentroid,
        Self::FitToOutline,
        Self::Clean,
    ];

    /// Returns the number in the report; `None` of one that is not in it.
    pub fn number(self) -> Option<u32> {
        Some(match self {
            Self::BisectTriangles => 8,
            Self::UpdateNeighbours1 => 9,
            Self::RefineTriangle => 10,
            Self::BisectTrianglesInStack => 11,
            Self::RefineMesh => 12,
            Self::BisectBoundaryTriangle => 19,
            Self::UpdateNeighbours2 => 21,
            Self::UpdateNeighbours3 => 22,
            Self::UpdateNeighbours4 => 23,
            Self::UpdateBoundaryNeighbours1 => 24,
            Self::UpdateBoundaryNeighbours2 => 25,
            Self::KeepByCentroid | Self::FitToOutline | Self::Clean => return None,
        })
    }

    /// Returns what it is in the report.
    pub fn title(self) -> String {
        self.number().map_or_else(|| "Not in the report".into(), |number| format!("Algorithm {number}"))
    }

    /// Returns the name, which is that in the report if it is there.
    pub fn name(self) -> &'static str {
        match self {
            Self::BisectTriangles => "BisectTriangles",
            Self::UpdateNeighbours1 => "UpdateNeighbours1",
            Self::RefineTriangle => "RefineTriangle",
            Self::BisectTrianglesInStack => "BisectTrianglesInStack",
            Self::RefineMesh => "RefineMesh",
            Self::BisectBoundaryTriangle => "BisectBoundaryTriangle",
            Self::UpdateNeighbours2 => "UpdateNeighbours2",
            Self::UpdateNeighbours3 => "UpdateNeighbours3",
            Self::UpdateNeighbours4 => "UpdateNeighbours4",
            Self::UpdateBoundaryNeighbours1 => "UpdateBoundaryNeighbours1",
            Self::UpdateBoundaryNeighbours2 => "UpdateBoundaryNeighbours2",
            Self::KeepByCentroid => "KeepByCentroid",
            Self::FitToOutline => "FitToOutline",
            Self::Clean => "Clean",
        }
    }

    /// Returns the lines; the first one is line 1.
    pub fn lines(self) -> &'static [&'static str] {
        match self {
            Self::BisectTriangles => &BISECT_TRIANGLES,
            Self::UpdateNeighbours1 => &UPDATE_NEIGHBOURS_1,
            Self::RefineTriangle => &REFINE_TRIANGLE,
            Self::BisectTrianglesInStack => &BISECT_TRIANGLES_IN_STACK,
            Self::RefineMesh => &REFINE_MESH,
            Self::BisectBoundaryTriangle => &BISECT_BOUNDARY_TRIANGLE,
            Self::UpdateNeighbours2 => &UPDATE_NEIGHBOURS_2,
            Self::UpdateNeighbours3 => &UPDATE_NEIGHBOURS_3,
            Self::UpdateNeighbours4 => &UPDATE_NEIGHBOURS_4,
            Self::UpdateBoundaryNeighbours1 => &UPDATE_BOUNDARY_NEIGHBOURS_1,
            Self::UpdateBoundaryNeighbours2 => &UPDATE_BOUNDARY_NEIGHBOURS_2,
            Self::KeepByCentroid => &KEEP_BY_CENTROID,
            Self::FitToOutline => &FIT_TO_OUTLINE,
            Self::Clean => &CLEAN,
        }
    }
}

const KEEP_BY_CENTROID: [&str; 2] = ["for each triangle t do", "    remove t unless its centroid is in Ω"];

const FIT_TO_OUTLINE: [&str; 15] = [
    "for each triangle t do",
    "    remove t unless a corner of t is in Ω",
    "for each node x at an edge that ∂Ω crosses near x do",
    "    move x to the nearest of these crossings",
    "for each edge that ∂Ω still crosses do",
    "    cut it there; remove what is outside Ω",
    "move the node next to each sharp corner of ∂Ω there",
    "while an angle is too small do",
    "    move its nodes back, half of the way each time",
    "halve edges that are longer than their target",
    "repeat 8 times",
    "    flip edges while that makes small angles larger",
    "    shift nodes while that makes small angles larger",
    "move nodes of the boundary beside ∂Ω onto it",
    "Clean()",
];

const CLEAN: [&str; 3] = [
    "repeat until nothing changes",
    "    remove parts that are not kept",
    "    remove triangles until no node joins two fans",
];

const REFINE_TRIANGLE: [&str; 10] = [
    "i_b ← T[i, 4]",
    "if i_b < 0 then",
    "    BisectBoundaryTriangle(i)",
    "    BisectTrianglesInStack()",
    "else if T[i, 8] = T[i_b, 8] then",
    "    BisectTriangles(i)",
    "    BisectTrianglesInStack()",
    "else",
    "    push i onto S_b",
    "    RefineTriangle(i_b)",
];

const BISECT_TRIANGLES_IN_STACK: [&str; 3] =
    ["while S_b is not empty do", "    j ← pop the top element from S_b", "    BisectTriangles(j)"];

const REFINE_MESH: [&str; 9] = [
    "initialise S_b",
    "δ ← 1 / ⌈1 / δ̄⌉",
    "i ← 1",
    "while i ≤ N_t do",
    "    while ℓ_b(δ, T[i, 8]) > h̄(i) do",
    "        RefineTriangle(i)",
    "    i ← i + 1",
    "N ← N[1 : N_x]",
    "T ← T[1 : N_t]",
];

const BISECT_TRIANGLES: [&str; 39] = [
    "CheckMemory()",
    "i_b ← T[i, 4]",
    "v ← T[i, 1 : 3]",
    "v_b ← T[i_b, 1 : 3]",
    "N_x ← N_x + 1",
    "k(i) ← 2 − (T[i, 8] mod 2)",
    "N[N_x] ← 0.5 (N[v[1]] + N[v[k + 1]])",
    "N_t ← N_t + 2",
    "O ← (T[i, 7] + 1) mod 2",
    "O_b ← (T[i_b, 7] + 1) mod 2",
    "T[i, 8] ← T[i, 8] + 1",
    "T[i_b, 8] ← T[i_b, 8] + 1",
    "if k(i) = 1 then",
    "    T[i, 1] ← v[1]",
    "    T[i, 2] ← N_x",
    "    T[i, 3] ← v[3]",
    "    T[i_b, 1] ← v_b[1]",
    "    T[i_b, 2] ← N_x",
    "    T[i_b, 3] ← v_b[3]",
    "    T[N_t − 1] ← (v[2], N_x, v[3], 0, 0, 0, O, T[i, 8])",
    "    T[N_t] ← (v_b[2], N_x, v_b[3], 0, 0, 0, O_b, T[i_b, 8])",
    "else",
    "    T[i, 1] ← v[1]",
    "    T[i, 2] ← v[2]",
    "    T[i, 3] ← N_x",
    "    T[i_b, 1] ← v_b[1]",
    "    T[i_b, 2] ← v_b[2]",
    "    T[i_b, 3] ← N_x",
    "    T[N_t − 1] ← (v[2], v[3], N_x, 0, 0, 0, T[i, 7], T[i, 8])",
    "    T[N_t] ← (v_b[2], v_b[3], N_x, 0, 0, 0, T[i_b, 7], T[i_b, 8])",
    "switch (k(i), T[i, 7], T[i_b, 7]) do",
    "    case (1, 0, 0) or (2, 1, 1)",
    "        UpdateNeighbours1(i)",
    "    case (1, 1, 0) or (2, 0, 1)",
    "        UpdateNeighbours2(i)",
    "    case (1, 0, 1) or (2, 1, 0)",
    "        UpdateNeighbours3(i)",
    "    otherwise",
    "        UpdateNeighbours4(i)",
];

const BISECT_BOUNDARY_TRIANGLE: [&str; 23] = [
    "CheckMemory()",
    "v ← T[i, 1 : 3]",
    "N_x ← N_x + 1",
    "k(i) ← 2 − (T[i, 8] mod 2)",
    "N[N_x] ← 0.5 (N[v[1]] + N[v[k + 1]])",
    "N_t ← N_t + 1",
    "O ← (T[i, 7] + 1) mod 2",
    "T[i, 8] ← T[i, 8] + 1",
    "if k = 1 then",
    "    T[i, 1] ← v[1]",
    "    T[i, 2] ← N_x",
    "    T[i, 3] ← v[3]",
    "    T[N_t] ← (v[2], N_x, v[3], 0, 0, 0, O, T[i, 8])",
    "else",
    "    T[i, 1] ← v[1]",
    "    T[i, 2] ← v[2]",
    "    T[i, 3] ← N_x",
    "    T[N_t] ← (v[2], v[3], N_x, 0, 0, 0, T[i, 7], T[i, 8])",
    "switch (k(i), T[i, 7]) do",
    "    case (1, 0) or (2, 1)",
    "        UpdateBoundaryNeighbours1(i)",
    "    otherwise",
    "        UpdateBoundaryNeighbours2(i)",
];

const UPDATE_NEIGHBOURS_1: [&str; 19] = [
    "ī ← N_t − 1",
    "ī_b ← N_t",
    "i_b ← T[i, 4]",
    "n ← T[i, 5 : 6]",
    "n_b ← T[i_b, 5 : 6]",
    "T[i, 4] ← n[1]",
    "T[i, 5] ← ī",
    "T[i, 6] ← ī_b",
    "T[i_b, 4] ← n_b[1]",
    "T[i_b, 5] ← ī_b",
    "T[i_b, 6] ← ī",
    "T[ī, 4] ← n[2]",
    "T[ī, 5] ← i_b",
    "T[ī, 6] ← i",
    "T[ī_b, 4] ← n_b[2]",
    "T[ī_b, 5] ← i",
    "T[ī_b, 6] ← i_b",
    "ReplaceTriangleNeighbour(n[2], i, ī)",
    "ReplaceTriangleNeighbour(n_b[2], i_b, ī_b)",
];

const UPDATE_NEIGHBOURS_2: [&str; 19] = [
    "ī ← N_t − 1",
    "ī_b ← N_t",
    "i_b ← T[i, 4]",
    "n ← T[i, 5 : 6]",
    "n_b ← T[i_b, 5 : 6]",
    "T[i, 4] ← n[2]",
    "T[i, 5] ← i_b",
    "T[i, 6] ← ī",
    "T[i_b, 4] ← n_b[1]",
    "T[i_b, 5] ← ī_b",
    "T[i_b, 6] ← i",
    "T[ī, 4] ← n[1]",
    "T[ī, 5] ← i",
    "T[ī, 6] ← ī_b",
    "T[ī_b, 4] ← n_b[2]",
    "T[ī_b, 5] ← ī",
    "T[ī_b, 6] ← i_b",
    "ReplaceTriangleNeighbour(n[1], i, ī)",
    "ReplaceTriangleNeighbour(n_b[2], i_b, ī_b)",
];

const UPDATE_NEIGHBOURS_3: [&str; 19] = [
    "ī ← N_t − 1",
    "ī_b ← N_t",
    "i_b ← T[i, 4]",
    "n ← T[i, 5 : 6]",
    "n_b ← T[i_b, 5 : 6]",
    "T[i, 4] ← n[1]",
    "T[i, 5] ← ī",
    "T[i, 6] ← i_b",
    "T[i_b, 4] ← n_b[2]",
    "T[i_b, 5] ← i",
    "T[i_b, 6] ← ī_b",
    "T[ī, 4] ← n[2]",
    "T[ī, 5] ← ī_b",
    "T[ī, 6] ← i",
    "T[ī_b, 4] ← n_b[1]",
    "T[ī_b, 5] ← i_b",
    "T[ī_b, 6] ← ī",
    "ReplaceTriangleNeighbour(n[2], i, ī)",
    "ReplaceTriangleNeighbour(n_b[1], i_b, ī_b)",
];

const UPDATE_NEIGHBOURS_4: [&str; 19] = [
    "ī ← N_t − 1",
    "ī_b ← N_t",
    "i_b ← T[i, 4]",
    "n ← T[i, 5 : 6]",
    "n_b ← T[i_b, 5 : 6]",
    "T[i, 4] ← n[2]",
    "T[i, 5] ← ī_b",
    "T[i, 6] ← ī",
    "T[i_b, 4] ← n_b[2]",
    "T[i_b, 5] ← ī",
    "T[i_b, 6] ← ī_b",
    "T[ī, 4] ← n[1]",
    "T[ī, 5] ← i",
    "T[ī, 6] ← i_b",
    "T[ī_b, 4] ← n_b[1]",
    "T[ī_b, 5] ← i_b",
    "T[ī_b, 6] ← i",
    "ReplaceTriangleNeighbour(n[1], i, ī)",
    "ReplaceTriangleNeighbour(n_b[1], i_b, ī_b)",
];

const UPDATE_BOUNDARY_NEIGHBOURS_1: [&str; 10] = [
    "ī ← N_t",
    "β ← T[i, 4]",
    "n ← T[i, 5 : 6]",
    "T[i, 4] ← n[1]",
    "T[i, 5] ← ī",
    "T[i, 6] ← β",
    "T[ī, 4] ← n[2]",
    "T[ī, 5] ← β",
    "T[ī, 6] ← i",
    "ReplaceTriangleNeighbour(n[2], i, ī)",
];

const UPDATE_BOUNDARY_NEIGHBOURS_2: [&str; 10] = [
    "ī ← N_t",
    "β ← T[i, 4]",
    "n ← T[i, 5 : 6]",
    "T[i, 4] ← n[2]",
    "T[i, 5] ← β",
    "T[i, 6] ← ī",
    "T[ī, 4] ← n[1]",
    "T[ī, 5] ← i",
    "T[ī, 6] ← β",
    "ReplaceTriangleNeighbour(n[1], i, ī)",
];
