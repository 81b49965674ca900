//! The places of panels: the upper dock, and the tabs of the lower one.

/// The place of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Tab {
    /// The upper dock, which is always shown: the layers, and the selected layer.
    Layers,
    /// What the target diameter is made from: limits, curve, gradation, budgets.
    Size,
    /// The queried triangle, and points that are followed.
    Inspect,
    /// Paths through the mesh.
    Paths,
    /// How the mesh is made, and its figures.
    Mesh,
    /// The domain, its boundary, and what is behind it.
    Domain,
    /// The method of the report. The tab is shown only while one of its panels has something to show.
    Method,
}

impl Tab {
    /// The tabs of the lower dock, from the left.
    pub const LOWER: [Self; 6] =
        [Self::Size, Self::Inspect, Self::Paths, Self::Mesh, Self::Domain, Self::Method];

    /// Returns the name on the tab.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Layers => "Layers",
            Self::Size => "Size",
            Self::Inspect => "Inspect",
            Self::Paths => "Paths",
            Self::Mesh => "Mesh",
            Self::Domain => "Domain",
            Self::Method => "Method",
        }
    }

    /// Returns the tab of the lower dock with a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::LOWER.into_iter().find(|tab| tab.name() == name)
    }
}
