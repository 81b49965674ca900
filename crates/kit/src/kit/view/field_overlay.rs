//! What is drawn over the mesh.

use meshbrush_core::quality::QualityMeasure;

/// The field that is drawn over the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldOverlay {
    /// Nothing.
    None,
    /// Risk, from nothing to a warm tint.
    Risk,
    /// The level that h̄ asks for, in the level's colour.
    Target,
    /// The layer that decides h̄, in the layer's colour.
    Layer,
    /// The factor by which the mesh is finer than h̄ requires.
    Slack,
    /// The triangles that only compatibility asked for.
    Forced,
    /// How many edits ago each triangle came.
    Age,
    /// The depth of the water, as a shaded relief.
    Depth,
    /// How far the mesh is from the depths.
    DepthError,
    /// The height of surfaces, as a shaded relief.
    Surface,
    /// How far the mesh is from surfaces.
    SurfaceError,
    /// The smallest angle of each triangle.
    SmallestAngle,
    /// The largest angle of each triangle.
    LargestAngle,
    /// The ratio of the longest to the shortest edge of each triangle.
    EdgeRatio,
    /// The ratio of the longest edge of each triangle to h̄.
    TargetRatio,
    /// The largest time step of each triangle.
    TimeStep,
    /// The triangles at the nodes of each triangle.
    Valence,
    /// The shortest link between the cell of each triangle and its neighbours.
    LinkLength,
    /// How far links between cells are from crossing their edges at right angles.
    Orthogonality,
}

impl FieldOverlay {
    /// All of them, in the order of lists.
    pub const ALL: &[Self] = &[
        Self::None,
        Self::Risk,
        Self::Target,
        Self::Layer,
        Self::Slack,
        Self::Forced,
        Self::Age,
        Self::Depth,
        Self::DepthError,
        Self::Surface,
        Self::SurfaceError,
        Self::SmallestAngle,
        Self::LargestAngle,
        Self::EdgeRatio,
        Self::TargetRatio,
        Self::TimeStep,
        Self::Valence,
        Self::LinkLength,
        Self::Orthogonality,
    ];

    /// Returns the overlay of a measure.
    pub fn of_measure(measure: QualityMeasure) -> Self {
        match measure {
            QualityMeasure::SmallestAngle => Self::SmallestAngle,
            QualityMeasure::LargestAngle => Self::LargestAngle,
            QualityMeasure::EdgeRatio => Self::EdgeRatio,
            QualityMeasure::TargetRatio => Self::TargetRatio,
            QualityMeasure::TimeStep => Self::TimeStep,
            QualityMeasure::Valence => Self::Valence,
            QualityMeasure::LinkLength => Self::LinkLength,
            QualityMeasure::LinkCosine => Self::Orthogonality,
        }
    }

    /// Returns the name of the choice in the list of the panel.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "No overlay",
            Self::Risk => "Risk",
            Self::Target => "Target",
            Self::Layer => "Layer",
            Self::Slack => "Slack",
            Self::Forced => "Forced",
            Self::Age => "Age",
            Self::Depth => "Depth",
            Self::DepthError => "Depth error",
            Self::Surface => "Surface",
            Self::SurfaceError => "Surface error",
            Self::SmallestAngle => "Smallest angle",
            Self::LargestAngle => "Largest angle",
            Self::EdgeRatio => "Edge ratio",
            Self::TargetRatio => "Longest edge / h̄",
            Self::TimeStep => "Time step",
            Self::Valence => "Triangles at a node",
            Self::LinkLength => "Link length",
            Self::Orthogonality => "Orthogonality",
        }
    }

    /// Returns the title of its entry in menus and in the palette.
    pub fn title(self) -> &'static str {
        match self {
            Self::None => "No overlay",
            Self::Risk => "Overlay risk",
            Self::Target => "Overlay target",
            Self::Layer => "Overlay deciding layer",
            Self::Slack => "Overlay slack",
            Self::Forced => "Overlay forced triangles",
            Self::Age => "Overlay age of triangles",
            Self::Depth => "Overlay depth of water",
            Self::DepthError => "Overlay depth error of the mesh",
            Self::Surface => "Overlay surface as a relief",
            Self::SurfaceError => "Overlay surface error of the mesh",
            Self::SmallestAngle => "Overlay smallest angle",
            Self::LargestAngle => "Overlay largest angle",
            Self::EdgeRatio => "Overlay edge ratio",
            Self::TargetRatio => "Overlay longest edge / h̄",
            Self::TimeStep => "Overlay time step",
            Self::Valence => "Overlay triangles at a node",
            Self::LinkLength => "Overlay link length",
            Self::Orthogonality => "Overlay orthogonality",
        }
    }
}
