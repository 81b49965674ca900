//! What is drawn by hand: the domain, the mask of a layer, a keep-out region of paths, and the shapes to
//! which a layer measures the distance.
//!
//! A [`Drawing`] is the state of one of these parts. It is edited away from the document, on another thread
//! where that takes long, and comes back as a [`Setting`].

use std::sync::Arc;

use glam::DVec2;

use super::{KeepOut, PathPlan, Setting, Settings};
use crate::domain::{CutShape, Domain, RegionError, corners};
use crate::geometry::Rect;
use crate::layers::{DistanceLayer, DistanceTo, Layer, LayerId, Mask, ShapeList, Shapes, ShapesError};

/// The part of a document that is drawn by hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawnPart {
    /// The domain.
    Domain,
    /// The mask of a layer.
    Mask(LayerId),
    /// A keep-out region, by its number from 0. The number after the last one is a new region.
    KeepOut(usize),
    /// The shapes to which a layer measures the distance.
    Shapes(LayerId),
}

/// Something drawn by hand, in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum DrawnShape {
    /// The area of a stroke of the brush, or of a polygon.
    Area(CutShape),
    /// A polyline, among shapes only.
    Line(Vec<DVec2>),
    /// A point, among shapes only.
    Point(DVec2),
}

impl DrawnShape {
    /// Appends `next`, if both belong to one stroke of the brush. Returns whether it was appended.
    pub fn join(&mut self, next: &Self) -> bool {
        match (self, next) {
            (Self::Area(shape), Self::Area(next)) => shape.join(next),
            _ => false,
        }
    }
}

/// The state of a part of a document that is drawn by hand.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawing {
    /// The domain.
    Domain(Domain),
    /// An area.
    Area {
        /// The area; `None` while nothing is drawn.
        area: Option<Mask>,
        /// What an area is cut from while nothing is drawn, in world units: a layer without a mask counts
        /// everywhere.
        whole: Option<Rect>,
    },
    /// The shapes to which a distance is measured; `None` while nothing is drawn.
    Shapes(Option<Shapes>),
}

/// Why something cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawingError {
    /// The area is empty or too complex.
    #[error(transparent)]
    Region(#[from] RegionError),
    /// The shapes would be none, or are nowhere.
    #[error(transparent)]
    Shapes(#[from] ShapesError),
    /// A mask would cover nothing.
    #[error(
        "Nothing would be left of the mask, and a layer without a mask counts everywhere. Hide or delete the layer \
         where it should not count at all."
    )]
    NoMask,
}

impl Drawing {
    /// Returns the drawing with a shape added or cut away; `None` where that changes nothing, or is not
    /// possible for this part.
    ///
    /// # Errors
    /// Fails when an area is none or too complex, and when nothing would be left that a layer could have.
    pub fn edited(&self, shape: &DrawnShape, adds: bool) -> Result<Option<Self>, DrawingError> {
        match (self, shape) {
            (Self::Domain(domain), DrawnShape::Area(shape)) => {
                Ok(domain.reshaped(shape, adds).map(Self::Domain))
            }
            (Self::Area { area, whole }, DrawnShape::Area(shape)) => {
                let area = edited_area(area.as_ref(), *whole, shape, adds)?;
                Ok(Some(Self::Area { area, whole: *whole }))
            }
            (Self::Shapes(shapes), shape) => {
                let list = shapes.as_ref().map_or_else(ShapeList::default, |shapes| shapes.list().clone());
                let Some(list) = edited_shapes(list, shape, adds)? else { return Ok(None) };
                Ok(Some(Self::Shapes(Some(Shapes::new(list, true)?))))
            }
            (Self::Domain(_) | Self::Area { .. }, DrawnShape::Line(_) | DrawnShape::Point(_)) => Ok(None),
        }
    }
}

fn edited_area(
    area: Option<&Mask>,
    whole: Option<Rect>,
    shape: &CutShape,
    adds: bool,
) -> Result<Option<Mask>, DrawingError> {
    let left = match (area, whole) {
        (None, _) if adds => Some(Mask::of_shape(shape)?),
        (Some(area), _) if adds => Some(area.with(shape)?),
        (Some(area), _) => area.without(shape)?,
        (None, Some(whole)) => Mask::new(&[vec![corners(&whole)]])?.without(shape)?,
        (None, None) => None,
    };
    // A keep-out region of which nothing is left goes; a layer would count everywhere.
    if left.is_none() && whole.is_some() { Err(DrawingError::NoMask) } else { Ok(left) }
}

/// Returns shapes with one added, or with an area cut away; `None` for a line or a point to cut away.
fn edited_shapes(list: ShapeList, shape: &DrawnShape, adds: bool) -> Result<Option<ShapeList>, DrawingError> {
    let mut list = match shape {
        DrawnShape::Area(shape) if adds => return Ok(Some(list.with_area(shape)?)),
        DrawnShape::Area(shape) => return Ok(Some(list.without_area(shape)?)),
        DrawnShape::Line(_) | DrawnShape::Point(_) if !adds => return Ok(None),
        DrawnShape::Line(_) | DrawnShape::Point(_) => list,
    };
    match shape {
        DrawnShape::Line(line) => list.lines.push(line.clone()),
        DrawnShape::Point(point) => list.points.push(*point),
        DrawnShape::Area(_) => {}
    }
    Ok(Some(list))
}

impl DrawnPart {
    /// Returns the state of the part in a document; `None` where the document has no such part. A layer
    /// without shapes of its own has none to draw on.
    pub fn drawing(self, settings: &Settings) -> Option<Drawing> {
        match self {
            Self::Domain => Some(Drawing::Domain(settings.domain.clone())),
            Self::Mask(id) => {
                let area = settings.layer(id)?.mask.clone();
                Some(Drawing::Area { area, whole: Some(settings.domain.bounds) })
            }
            Self::KeepOut(number) => {
                let regions = &settings.paths.keep_out;
                let area = regions.get(number).map(|region| region.mask.clone());
                (number <= regions.len()).then_some(Drawing::Area { area, whole: None })
            }
            Self::Shapes(id) => match &settings.layer(id)?.kind.get::<DistanceLayer>()?.to {
                DistanceTo::Shapes { shapes, .. } => Some(Drawing::Shapes(Some(shapes.clone()))),
                _ => None,
            },
        }
    }

    /// Returns the setting that gives the part of a document another state; `None` where the document has no
    /// such part.
    pub fn setting(self, settings: &Settings, drawing: Drawing) -> Option<Setting> {
        match (self, drawing) {
            (Self::Domain, Drawing::Domain(domain)) => Some(Setting::Domain(domain)),
            (Self::Mask(id), Drawing::Area { area: mask, .. }) => {
                with_layer(settings, id, |layer| layer.mask = mask)
            }
            (Self::Shapes(id), Drawing::Shapes(Some(drawn))) => with_layer(settings, id, |layer| {
                if let Some(DistanceLayer { to: DistanceTo::Shapes { shapes, .. }, .. }) =
                    layer.kind.get_mut()
                {
                    *shapes = drawn;
                }
            }),
            (Self::KeepOut(number), Drawing::Area { area, .. }) => {
                let mut plan = (*settings.paths).clone();
                plan.draw_keep_out(number, area);
                Some(Setting::Paths(Arc::new(plan)))
            }
            _ => None,
        }
    }
}

/// Returns the layers of a document with one changed.
fn with_layer(settings: &Settings, id: LayerId, edit: impl FnOnce(&mut Layer)) -> Option<Setting> {
    let mut layers = settings.layers.clone();
    edit(layers.iter_mut().find(|layer| layer.id == id)?);
    Some(Setting::Layers(layers))
}

impl PathPlan {
    /// The name of a keep-out region drawn by hand.
    const DRAWN_REGION: &str = "drawn region";

    /// Gives a keep-out region another area, adds one, or removes one without an area.
    fn draw_keep_out(&mut self, number: usize, area: Option<Mask>) {
        let mut regions = self.keep_out.to_vec();
        match (regions.get_mut(number), area) {
            (Some(region), Some(mask)) => region.mask = mask,
            (Some(_), None) => _ = regions.remove(number),
            (None, Some(mask)) => regions.push(KeepOut { name: self.unused_region_name(), mask }),
            (None, None) => {}
        }
        self.keep_out = regions.into();
    }

    fn unused_region_name(&self) -> String {
        let is_used = |name: &str| self.keep_out.iter().any(|region| region.name == name);
        let mut numbered = (1..).map(|n| format!("{} {n}", Self::DRAWN_REGION));
        numbered.find(|name| !is_used(name)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use crate::layers::LayerKind;
    use glam::dvec2;

    use super::*;

    fn disc(x: f64, y: f64) -> DrawnShape {
        DrawnShape::Area(CutShape::Stroke { path: vec![dvec2(x, y)], radius: 0.1 })
    }

    fn everything() -> DrawnShape {
        DrawnShape::Area(CutShape::Ring(corners(&Rect::around(DVec2::splat(0.5), 2.0))))
    }

    /// Draws on a part of settings; `None` where that changes nothing.
    fn draw(
        settings: &mut Settings,
        part: DrawnPart,
        shape: &DrawnShape,
        adds: bool,
    ) -> Result<Option<()>, DrawingError> {
        let drawing = part.drawing(settings).expect("the document has the part");
        let Some(edited) = drawing.edited(shape, adds)? else { return Ok(None) };
        part.setting(settings, edited).expect("the part is there").apply(settings);
        Ok(Some(()))
    }

    #[test]
    fn a_mask_begins_with_what_is_added_or_with_the_frame_less_what_is_cut() {
        let part = DrawnPart::Mask(LayerId(1));
        let mut settings = Settings::default();
        draw(&mut settings, part, &disc(0.5, 0.5), true).unwrap().unwrap();
        let area = |settings: &Settings| settings.layers[1].mask.as_ref().unwrap().area();
        assert!((area(&settings) - 0.0314).abs() < 5e-4, "{}", area(&settings));
        assert_eq!(draw(&mut settings, part, &everything(), false), Err(DrawingError::NoMask));
        let mut settings = Settings::default();
        draw(&mut settings, part, &disc(0.5, 0.5), false).unwrap().unwrap();
        assert!((area(&settings) - (1.0 - 0.0314)).abs() < 5e-4, "{}", area(&settings));
        assert_eq!(settings.layers[0].mask, None, "other layers count as before");
        assert_eq!(draw(&mut settings, part, &DrawnShape::Point(DVec2::ONE), true), Ok(None));
        assert_eq!(DrawnPart::Mask(LayerId(77)).drawing(&settings), None);
    }

    #[test]
    fn keep_out_regions_are_added_changed_and_removed() {
        let mut settings = Settings::default();
        let names = |settings: &Settings| -> Vec<String> {
            settings.paths.keep_out.iter().map(|region| region.name.clone()).collect()
        };
        draw(&mut settings, DrawnPart::KeepOut(0), &disc(0.2, 0.2), true).unwrap();
        draw(&mut settings, DrawnPart::KeepOut(1), &disc(0.8, 0.2), true).unwrap();
        draw(&mut settings, DrawnPart::KeepOut(0), &disc(0.25, 0.2), true).unwrap();
        assert_eq!(names(&settings), ["drawn region 1", "drawn region 2"]);
        assert_eq!(settings.paths.keep_out[0].mask.polygons().len(), 1);
        assert_eq!(DrawnPart::KeepOut(3).drawing(&settings), None);
        draw(&mut settings, DrawnPart::KeepOut(0), &everything(), false).unwrap();
        assert_eq!(names(&settings), ["drawn region 2"]);
        draw(&mut settings, DrawnPart::KeepOut(1), &everything(), false).unwrap();
        assert_eq!(names(&settings), ["drawn region 2"], "nothing is cut from nothing");
        draw(&mut settings, DrawnPart::KeepOut(1), &disc(0.5, 0.5), true).unwrap();
        assert_eq!(names(&settings), ["drawn region 2", "drawn region 1"]);
    }

    #[test]
    fn shapes_are_areas_lines_and_points() {
        let mut settings = Settings::default();
        let point = ShapeList { points: vec![DVec2::ZERO], ..ShapeList::default() };
        let to = DistanceTo::Shapes { name: String::new(), shapes: Shapes::new(point, true).unwrap() };
        let kind = LayerKind::distance_to(to, &settings.transfer, 0.3);
        settings.layers.push(Layer::new(LayerId(7), "Distance", kind));
        let part = DrawnPart::Shapes(LayerId(7));
        assert_eq!(DrawnPart::Shapes(LayerId(0)).drawing(&settings), None);
        let line = DrawnShape::Line(vec![dvec2(0.0, 0.5), dvec2(1.0, 0.5)]);
        for (shape, adds) in [(&line, true), (&DrawnShape::Point(DVec2::ONE), true), (&disc(0.5, 0.5), true)]
        {
            draw(&mut settings, part, shape, adds).unwrap().unwrap();
        }
        assert_eq!(draw(&mut settings, part, &line, false), Ok(None), "a line cuts nothing");
        draw(&mut settings, part, &disc(0.5, 0.5), false).unwrap().unwrap();
        let Some(Drawing::Shapes(Some(shapes))) = part.drawing(&settings) else { panic!("it has shapes") };
        let ShapeList { points, lines, polygons } = shapes.list();
        assert_eq!((points.len(), lines.len(), polygons.len()), (2, 2, 0));
        let nothing = draw(&mut settings, part, &everything(), false);
        assert_eq!(nothing, Err(DrawingError::Shapes(ShapesError::Empty)));
    }
}
