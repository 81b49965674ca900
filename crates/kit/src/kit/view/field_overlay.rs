//! What is drawn over the mesh.

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
    ];

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
        }
    }
}
