//! Pictures of the surface in space, before there is a mesh.

use clap::ValueEnum as _;

use super::args::{PictureView, SpaceArguments};
use super::build::FinishedMesh;
use super::failure::Failure;
use meshbrush_core::surface::HeightSource;
use meshbrush_io::io::KeyFault;
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::Number;
use meshbrush_render::render::space_look::SpaceLook;
use meshbrush_render::scene::{Light, NodeHeights, SpaceCamera, ViewDirection};

/// The view in space that is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequestedSpace {
    direction: ViewDirection,
    exaggeration: Option<f64>,
}

/// Why a number of a view cannot be used: its name, and the rule.
struct BadNumber(&'static str, String);

/// A number of a view in space without the view.
const ONLY_IN_SPACE: &str = "this is for views in space";

impl RequestedSpace {
    /// Returns the view that the arguments describe; `None` for the plan.
    ///
    /// # Errors
    /// Fails when a number is out of its range, or is given for the plan.
    pub fn new(typed: &SpaceArguments) -> Result<Option<Self>, Failure> {
        let SpaceArguments { view, azimuth, altitude, exaggeration } = *typed;
        let usage = |BadNumber(name, rule)| Failure::Usage(format!("--{name}: {rule}, with --view space."));
        Self::of(view == PictureView::Space, [azimuth, altitude, exaggeration]).map_err(usage)
    }

    /// Returns the view that an output of a recipe describes; `None` for the plan.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does, and for the name of another view.
    pub fn of_saved(saved: &SavedOutput) -> Result<Option<Self>, KeyFault> {
        let view = saved.view.as_deref().unwrap_or("plan");
        let view = PictureView::from_str(view, true)
            .map_err(|_| KeyFault::value("view", format!("“{view}” is no view; use plan or space.")))?;
        let numbers = [saved.azimuth, saved.altitude, saved.exaggeration];
        let fault = |BadNumber(name, rule)| KeyFault::value(name, format!("{rule}, with view = \"space\"."));
        Self::of(view == PictureView::Space, numbers).map_err(fault)
    }

    fn of(
        is_space: bool,
        [azimuth, altitude, exaggeration]: [Option<f64>; 3],
    ) -> Result<Option<Self>, BadNumber> {
        let given = [("azimuth", azimuth), ("altitude", altitude), ("exaggeration", exaggeration)];
        if !is_space {
            let number = given.into_iter().find(|(_, number)| number.is_some());
            return number.map_or(Ok(None), |(name, _)| Err(BadNumber(name, ONLY_IN_SPACE.into())));
        }
        let checked = |name, number: f64, is_valid: bool, rule: &str| match is_valid {
            true => Ok(number),
            false => Err(BadNumber(name, format!("{} is not {rule}", Number(number)))),
        };
        let default = ViewDirection::default();
        let [azimuth, altitude] = [azimuth.unwrap_or(default.azimuth), altitude.unwrap_or(default.altitude)];
        let azimuth = checked("azimuth", azimuth, azimuth.is_finite(), "an angle in degrees")?;
        let is_high = (5.0..=90.0).contains(&altitude);
        let altitude = checked("altitude", altitude, is_high, "an angle from 5 to 90 degrees")?;
        let is_factor = |factor: &f64| *factor > 0.0 && factor.is_finite();
        if let Some(factor) = exaggeration.filter(|factor| !is_factor(factor)) {
            checked("exaggeration", factor, false, "a positive factor")?;
        }
        Ok(Some(Self { direction: ViewDirection { azimuth, altitude }, exaggeration }))
    }

    /// Returns the view of a mesh as files get it.
    ///
    /// # Errors
    /// Fails when no node has a height.
    pub fn for_extract(&self, finished: &FinishedMesh, extract: &Extract) -> Result<SpaceLook, Failure> {
        let source = HeightSource::new(finished.built().surface.as_deref(), finished.layers());
        let heights = source.map(|source| source.at_nodes(extract.lattice(), extract.nodes()));
        let heights = heights.and_then(|heights| NodeHeights::new(&heights, &[]));
        let Some(heights) = heights else {
            return Err(Failure::Work(
                "A picture in space needs heights, and no layer has any: add a surface with --surface, or depths with \
                 --depth."
                    .into(),
            ));
        };
        let metre = SpaceCamera::metre_in(finished.unit());
        let seen = (self.direction, Light::default());
        Ok(SpaceLook::new(seen, self.exaggeration, metre, heights, extract.lattice()))
    }
}
