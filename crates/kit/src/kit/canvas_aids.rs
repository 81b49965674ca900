//! The aids to orientation on the canvas.

/// An aid to orientation on the canvas, which can be switched off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanvasAid {
    /// Ticks with coordinates along its sides.
    Coordinates,
    /// Meridians and parallels, in documents on the Earth.
    Graticule,
    /// The scale bar.
    ScaleBar,
    /// The legend of the levels.
    Levels,
    /// Contour lines of h̄.
    Contours,
    /// The walk of point location to the queried point.
    Walk,
    /// Handles at the corners of the background picture.
    PictureCorners,
    /// Why the queried triangle is there.
    Cause,
}

/// Which of them are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanvasAids {
    /// Ticks with coordinates along the sides of the canvas.
    pub coordinates: bool,
    /// Meridians and parallels, in documents on the Earth.
    pub graticule: bool,
    /// The scale bar.
    pub scale_bar: bool,
    /// The legend of the levels.
    pub levels: bool,
    /// Contour lines of h̄ where one level ends and the next begins.
    pub contours: bool,
    /// The walk of point location to the queried point.
    pub walk: bool,
    /// Handles at the corners of the background picture.
    pub picture_corners: bool,
    /// Why the queried triangle is there: the chain of triangles, and the place that decides.
    pub cause: bool,
}

impl Default for CanvasAids {
    fn default() -> Self {
        Self {
            coordinates: true,
            graticule: false,
            scale_bar: true,
            levels: true,
            contours: false,
            walk: true,
            picture_corners: false,
            cause: true,
        }
    }
}

impl CanvasAids {
    /// Shows or hides one of them.
    pub fn toggle(&mut self, aid: CanvasAid) {
        let shown = match aid {
            CanvasAid::Coordinates => &mut self.coordinates,
            CanvasAid::Graticule => &mut self.graticule,
            CanvasAid::ScaleBar => &mut self.scale_bar,
            CanvasAid::Levels => &mut self.levels,
            CanvasAid::Contours => &mut self.contours,
            CanvasAid::Walk => &mut self.walk,
            CanvasAid::PictureCorners => &mut self.picture_corners,
            CanvasAid::Cause => &mut self.cause,
        };
        *shown = !*shown;
    }
}
