//! The solvers whose rules are known.

use std::fmt;
use std::str::FromStr;

use meshbrush_core::domain::BoundaryType;

/// A solver that meshes are written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Solver {
    /// ADCIRC.
    Adcirc,
    /// SCHISM.
    Schism,
    /// SWAN, by itself.
    Swan,
    /// TELEMAC-2D.
    Telemac,
    /// FVCOM.
    Fvcom,
    /// WAVEWATCH III.
    Ww3,
    /// Delft3D-FM.
    Delft3dFm,
    /// MIKE 21 and MIKE 3 FM.
    Mike,
    /// MODFLOW 6.
    Modflow,
}

impl Solver {
    /// All of them, in the order of lists.
    pub const ALL: [Self; 9] = [
        Self::Adcirc,
        Self::Schism,
        Self::Swan,
        Self::Telemac,
        Self::Fvcom,
        Self::Ww3,
        Self::Delft3dFm,
        Self::Mike,
        Self::Modflow,
    ];

    /// Returns the solver that reads a format of this name; `None` for a format of many programs.
    pub fn of_format(name: &str) -> Option<Self> {
        match name {
            "fort14" => Some(Self::Adcirc),
            "gr3" | "ll" => Some(Self::Schism),
            "slf" => Some(Self::Telemac),
            "fvcom" => Some(Self::Fvcom),
            "ww3" => Some(Self::Ww3),
            "ugrid" => Some(Self::Delft3dFm),
            "mesh" => Some(Self::Mike),
            "disv" => Some(Self::Modflow),
            _ => None,
        }
    }

    /// Returns the word for it on the command line and in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Adcirc => "adcirc",
            Self::Schism => "schism",
            Self::Swan => "swan",
            Self::Telemac => "telemac",
            Self::Fvcom => "fvcom",
            Self::Ww3 => "ww3",
            Self::Delft3dFm => "delft3dfm",
            Self::Mike => "mike",
            Self::Modflow => "modflow",
        }
    }

    /// Returns its name in sentences.
    pub fn name(self) -> &'static str {
        match self {
            Self::Adcirc => "ADCIRC",
            Self::Schism => "SCHISM",
            Self::Swan => "SWAN",
            Self::Telemac => "TELEMAC",
            Self::Fvcom => "FVCOM",
            Self::Ww3 => "WAVEWATCH III",
            Self::Delft3dFm => "Delft3D-FM",
            Self::Mike => "MIKE",
            Self::Modflow => "MODFLOW",
        }
    }

    /// Returns which types of the boundary are open in its files.
    pub(super) fn is_open(self) -> fn(BoundaryType) -> bool {
        match self {
            Self::Schism | Self::Telemac | Self::Mike => BoundaryType::lets_water_through,
            _ => BoundaryType::is_open,
        }
    }

    /// Returns whether its files have quadrilaterals unless triangles are asked for.
    pub(super) fn wants_squares(self) -> bool {
        matches!(self, Self::Delft3dFm | Self::Modflow)
    }

    /// Returns whether open pieces that meet are one string in its files.
    pub(super) fn joins_open(self) -> bool {
        matches!(self, Self::Adcirc | Self::Swan)
    }
}

/// The error for a word that names no solver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownSolver(pub String);

impl fmt::Display for UnknownSolver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "“{}” is no solver whose rules are known; choose one of", self.0)?;
        Solver::ALL.iter().try_for_each(|solver| write!(f, " {}", solver.word()))
    }
}

impl std::error::Error for UnknownSolver {}

impl FromStr for Solver {
    type Err = UnknownSolver;

    fn from_str(text: &str) -> Result<Self, UnknownSolver> {
        let word = text.to_ascii_lowercase();
        let found = Self::ALL.into_iter().find(|solver| solver.word() == word);
        found.ok_or_else(|| UnknownSolver(text.to_owned()))
    }
}
