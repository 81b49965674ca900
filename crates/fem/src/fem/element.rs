//! Coefficients and integrals of single triangles.

use glam::DVec2;
use rayon::prelude::*;

use super::fem_error::FemError;
use super::fem_mesh::FemMesh;
use super::problem::{FemProblem, Values};

/// The shape of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementShape {
    /// Gradients of the three hat functions in the plane, per world unit.
    pub gradients: [DVec2; 3],
    /// The area in square world units.
    pub area: f64,
    /// Lengths of unit steps along x and y.
    pub metric: [f64; 2],
}

impl ElementShape {
    pub fn of(mesh: &FemMesh, triangle: usize) -> Self {
        let corners = mesh.triangle(triangle);
        let edges = [0, 1, 2].map(|k| corners[(k + 2) % 3] - corners[(k + 1) % 3]);
        let doubled = edges[0].perp_dot(edges[1]);
        let gradients = edges.map(|edge| edge.perp() / doubled);
        Self { gradients, area: 0.5 * doubled, metric: mesh.metric_of(triangle) }
    }

    /// Returns the area: square world units, or square metres.
    pub fn measure(&self) -> f64 {
        self.area * self.metric[0] * self.metric[1]
    }

    /// Returns the integral of ∇v·∇w, for gradients per world unit.
    #[inline]
    pub fn energy(&self, v: DVec2, w: DVec2) -> f64 {
        let [x, y] = self.metric;
        self.area * (y / x * (v.x * w.x) + x / y * (v.y * w.y))
    }

    /// Returns the flux through edges in the plane for a gradient per world unit and a diffusion of 1.
    #[inline]
    pub fn stretched(&self, gradient: DVec2) -> DVec2 {
        let [x, y] = self.metric;
        DVec2::new(y / x * gradient.x, x / y * gradient.y)
    }

    /// Returns the product of two fluxes per unit of area in the plane, for a diffusion of 1.
    #[inline]
    pub fn flux_product(&self, v: DVec2, w: DVec2) -> f64 {
        let [x, y] = self.metric;
        x / y * (v.x * w.x) + y / x * (v.y * w.y)
    }

    /// Returns the gradient of a linear function, per world unit.
    #[inline]
    pub fn gradient(&self, values: [f64; 3]) -> DVec2 {
        let [a, b, c] = self.gradients;
        values[0] * a + values[1] * b + values[2] * c
    }

    /// Returns the integral of b·∇u.
    #[inline]
    pub fn drift(&self, convection: DVec2, gradient: DVec2) -> f64 {
        let [x, y] = self.metric;
        self.area * (y * (convection.x * gradient.x) + x * (convection.y * gradient.y))
    }

    /// Returns the longest edge.
    pub fn diameter(&self, corners: [DVec2; 3]) -> f64 {
        let [x, y] = self.metric;
        let length = |k: usize| {
            let step = corners[(k + 1) % 3] - corners[k];
            DVec2::new(x * step.x, y * step.y).length()
        };
        length(0).max(length(1)).max(length(2))
    }
}

/// The coefficients of a problem in a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementData {
    /// a at the middle.
    pub diffusion: f64,
    /// c at the middle.
    pub reaction: f64,
    /// b at the middle.
    pub convection: DVec2,
    /// Integrals of the source times each hat function, by a rule that is exact for polynomials of degree 2.
    pub loads: [f64; 3],
}

/// Barycentric coordinates of the points of the rule: each has 2/3 at one corner and 1/6 at the others.
const NEAR: f64 = 2.0 / 3.0;
const FAR: f64 = 1.0 / 6.0;

/// Evaluates the coefficients in all triangles.
///
/// # Errors
/// Fails where one is not finite, the diffusion is not positive, or the reaction negative.
pub(crate) fn element_data(mesh: &FemMesh, problem: &FemProblem) -> Result<Vec<ElementData>, FemError> {
    let formulas = Formulas::of(problem);
    let data: Vec<ElementData> =
        (0..mesh.triangle_count()).into_par_iter().map(|triangle| formulas.data(mesh, triangle)).collect();
    let fault = data.par_iter().enumerate().find_first(|(_, data)| !data.is_proper());
    match fault {
        Some((triangle, _)) => Err(formulas.fault(mesh, triangle)),
        None => Ok(data),
    }
}

impl ElementData {
    fn is_proper(&self) -> bool {
        let is_finite = self.loads.iter().all(|load| load.is_finite()) && self.convection.is_finite();
        is_finite
            && self.diffusion > 0.0
            && self.diffusion.is_finite()
            && self.reaction >= 0.0
            && self.reaction.is_finite()
    }
}

struct Formulas<'a> {
    diffusion: Values<'a>,
    reaction: Values<'a>,
    source: Values<'a>,
    convection: Option<[Values<'a>; 2]>,
}

impl<'a> Formulas<'a> {
    fn of(problem: &'a FemProblem) -> Self {
        Self {
            diffusion: Values::of(&problem.diffusion),
            reaction: Values::of(&problem.reaction),
            source: Values::of(&problem.source),
            convection: problem.convection.as_ref().map(|along| along.each_ref().map(Values::of)),
        }
    }

    fn convection_at(&self, place: DVec2) -> DVec2 {
        self.convection.as_ref().map_or(DVec2::ZERO, |[x, y]| DVec2::new(x.at(place), y.at(place)))
    }

    fn data(&self, mesh: &FemMesh, triangle: usize) -> ElementData {
        let shape = ElementShape::of(mesh, triangle);
        let middle = mesh.middle(triangle);
        let third = shape.measure() / 3.0;
        let loads = match self.source.constant() {
            Some(source) => [third * source; 3],
            None => {
                let values = points_of_rule(mesh.triangle(triangle)).map(|point| self.source.at(point));
                loads_of(values, third)
            }
        };
        ElementData {
            diffusion: self.diffusion.at(middle),
            reaction: self.reaction.at(middle),
            convection: self.convection_at(middle),
            loads,
        }
    }

    /// Returns what is wrong in a triangle.
    fn fault(&self, mesh: &FemMesh, triangle: usize) -> FemError {
        let place = mesh.middle(triangle);
        let points = points_of_rule(mesh.triangle(triangle)).map(|point| (point, self.source.at(point)));
        let source = points.into_iter().find(|(_, value)| !value.is_finite());
        let [diffusion, reaction] = [self.diffusion.at(place), self.reaction.at(place)];
        let along = self.convection_at(place);
        let convection = [along.x, along.y].into_iter().find(|value| !value.is_finite());
        let not_finite = |what, place, value| FemError::NotFinite { what, place, value };
        if !diffusion.is_finite() {
            not_finite("diffusion", place, diffusion)
        } else if diffusion <= 0.0 {
            FemError::Diffusion { place, value: diffusion }
        } else if !reaction.is_finite() {
            not_finite("reaction", place, reaction)
        } else if reaction < 0.0 {
            FemError::Negative { what: "reaction", place, value: reaction }
        } else if let Some(value) = convection {
            not_finite("convection", place, value)
        } else if let Some((place, value)) = source {
            not_finite("source", place, value)
        } else {
            not_finite("source", place, f64::INFINITY) // its integral overflows
        }
    }
}

/// Returns the points of the rule in a triangle.
pub(crate) fn points_of_rule([a, b, c]: [DVec2; 3]) -> [DVec2; 3] {
    [NEAR * a + FAR * (b + c), NEAR * b + FAR * (c + a), NEAR * c + FAR * (a + b)]
}

/// Returns the integrals of a function times each hat function, from its values at the points of the rule.
pub(crate) fn loads_of(values: [f64; 3], third: f64) -> [f64; 3] {
    let sum = values[0] + values[1] + values[2];
    values.map(|value| third * (NEAR * value + FAR * (sum - value)))
}
