//! The core against a plain fixed-point closure, on random fields and domains: the mesh is canonical.

use crate::closure;
use closure::{Point, Triangle};
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{
    Element, Fingerprint, InvalidTarget, Limits, Mesh, Progress, Refiner, fingerprint_of,
};

/// A domain, a coarse grid and a rule, at random.
struct Case {
    bounds: Rect,
    spacing: f64,
    hole: Hole,
    field: Field,
}

/// The parts left out of the rectangle, by grid node (column, row) of `cells`.
#[derive(Debug)]
enum Hole {
    Nothing,
    /// The lower left and the upper right corner: each takes away one triangle, and puts a diagonal on the
    /// boundary.
    CornerTriangles,
    /// Two nodes on opposite sides of another one: of the six triangles there, two stay, and only touch.
    Touching([i64; 2]),
    /// Nodes at random, one in `one_in`.
    Scattered {
        seed: u64,
        one_in: u64,
    },
    /// A disc about the middle: radius in cells.
    Disc(f64),
}

impl Hole {
    fn random(random: &mut Rng) -> Self {
        match random.u32(0..6) {
            0 | 1 => Self::Nothing,
            2 => Self::CornerTriangles,
            3 => Self::Touching([random.i64(1..4), random.i64(1..4)]),
            4 => Self::Scattered { seed: random.u64(..), one_in: random.u64(8..20) },
            _ => Self::Disc(random.f64() * 2.5),
        }
    }

    fn keeps(&self, cells: [i64; 2], column: i64, row: i64) -> bool {
        match *self {
            Self::Nothing => true,
            Self::CornerTriangles => [column, row] != [0, 0] && [column, row] != cells,
            Self::Touching([x, y]) => [column, row] != [x - 1, y] && [column, row] != [x + 1, y],
            Self::Scattered { seed, one_in } => {
                Rng::with_seed(seed ^ (column as u64) << 32 ^ row as u64).u64(0..one_in) != 0
            }
            Self::Disc(radius) => {
                let middle = dvec2(cells[0] as f64, cells[1] as f64) / 2.0;
                (dvec2(column as f64, row as f64) - middle).length() >= radius
            }
        }
    }
}

/// A target diameter over the plane, in world units.
enum Field {
    /// Finer towards each point: `finest` there, growing by `slope` with the distance.
    Points { at: Vec<DVec2>, finest: f64, slope: f64 },
    /// `inside` where |n · x − c| ≤ `half_width`, with the vertex rule: a thin strip may pass between the
    /// nodes.
    Strip { normal: DVec2, c: f64, half_width: f64, inside: f64 },
    /// The strip with the area rule: it counts wherever the closed triangle meets it.
    StripArea { normal: DVec2, c: f64, half_width: f64, inside: f64 },
    /// Waves.
    Formula { k: DVec2, low: f64, high: f64 },
}

impl Field {
    fn random(random: &mut Rng, bounds: Rect, spacing: f64) -> Self {
        let place = |random: &mut Rng| bounds.min + bounds.size() * dvec2(random.f64(), random.f64());
        let normal = DVec2::from_angle(random.f64() * 7.0);
        let c = normal.dot(place(random));
        let half_width = spacing * random.f64() * 0.2;
        let inside = spacing * (0.04 + 0.4 * random.f64());
        match random.u32(0..4) {
            0 => {
                let at = (0..random.usize(1..4)).map(|_| place(random)).collect();
                let finest = spacing * 0.001 * 300f64.powf(random.f64());
                Self::Points { at, finest, slope: 0.1 + random.f64() }
            }
            1 => Self::Strip { normal, c, half_width, inside },
            2 => Self::StripArea { normal, c, half_width, inside },
            _ => {
                let k = dvec2(random.f64(), random.f64()) * 9.0 / spacing;
                Self::Formula { k, low: inside, high: spacing * (0.5 + 2.0 * random.f64()) }
            }
        }
    }

    /// Eq. (13), for a triangle with the given diameter and corners.
    fn exceeds(&self, diameter: f64, corners: [DVec2; 3]) -> bool {
        match self {
            Self::StripArea { normal, c, half_width, inside } => {
                let distances = corners.map(|x| normal.dot(x) - c);
                let meets = distances.iter().any(|d| *d <= *half_width)
                    && distances.iter().any(|d| *d >= -*half_width);
                meets && diameter > *inside
            }
            _ => corners.iter().any(|&x| diameter > self.target(x)),
        }
    }

    fn target(&self, x: DVec2) -> f64 {
        match self {
            Self::Points { at, finest, slope } => {
                at.iter().map(|p| finest + slope * p.distance(x)).fold(f64::INFINITY, f64::min)
            }
            Self::Strip { normal, c, half_width, inside }
            | Self::StripArea { normal, c, half_width, inside } => {
                if (normal.dot(x) - c).abs() <= *half_width { *inside } else { f64::INFINITY }
            }
            Self::Formula { k, low, high } => {
                let wave = 0.5 + 0.5 * (k.x * x.x).sin() * (k.y * x.y).cos();
                low + wave * (high - low)
            }
        }
    }
}

impl Case {
    fn random(seed: u64) -> Self {
        let mut random = Rng::with_seed(seed);
        let size = dvec2(0.2 + random.f64(), 0.2 + random.f64()) * 10f64.powi(random.i32(-3..6));
        let corner = size * dvec2(random.f64() - 0.5, random.f64() - 0.5) * 100.0;
        let size = if random.bool() { DVec2::splat(size.x) } else { size };
        let bounds = Rect::new(corner, corner + size);
        let spacing = size.max_element() / random.f64().mul_add(6.0, 3.0);
        let (hole, field) = (Hole::random(&mut random), Field::random(&mut random, bounds, spacing));
        Self { bounds, spacing, hole, field }
    }

    fn coarse_mesh(&self) -> Option<Mesh> {
        // The grid is known to the domain test only through the places of its nodes.
        let lattice = Lattice::covering(self.bounds, self.spacing, 1_000_000).unwrap();
        let cells = lattice.cells().map(i64::from);
        let contains = |p: DVec2| {
            let relative = (p - self.bounds.min) / self.bounds.size();
            let [column, row] =
                [relative.x * cells[0] as f64, relative.y * cells[1] as f64].map(|x| x.round() as i64);
            self.hole.keeps(cells, column, row)
        };
        Mesh::coarse_grid(&lattice, contains, &Limits::default()).ok()
    }

    fn rule(&self) -> impl Fn(&Element) -> Result<bool, InvalidTarget> {
        |element| Ok(self.field.exceeds(element.diameter(), element.world_corners()))
    }

    /// Computes the mesh by the plain closure, with its own map to the world and its own Eq. (1).
    fn closure(&self, mesh: &Mesh) -> Vec<Triangle> {
        let cells = mesh.lattice().cells().map(i64::from);
        let cell = i64::from(mesh.lattice().cell_steps());
        let step = self.bounds.size() / dvec2(cells[0] as f64, cells[1] as f64) / cell as f64;
        let side = (step * cell as f64).max_element();
        let world = |min: f64, max: f64, step: f64, x: i64, cells: i64| {
            if x == cells * cell { max } else { min + x as f64 * step }
        };
        let world = |[x, y]: Point| {
            let (min, max) = (self.bounds.min, self.bounds.max);
            dvec2(world(min.x, max.x, step.x, x, cells[0]), world(min.y, max.y, step.y, y, cells[1]))
        };
        closure::refine(closure::coarse(cells[0], cells[1], cell, |x, y| self.hole.keeps(cells, x, y)), |t| {
            let level = closure::level(cell, t) as i32;
            let diameter =
                side * 2f64.powi(-(level / 2)) * if level % 2 == 0 { std::f64::consts::SQRT_2 } else { 1.0 };
            self.field.exceeds(diameter, t.map(world))
        })
    }
}

fn triangles_of(mesh: &Mesh) -> Vec<Triangle> {
    let point = |p: LatticePoint| [i64::from(p.x), i64::from(p.y)];
    closure::set_of(mesh.raw_triangles().iter().map(|t| t.vertices.map(|v| point(mesh.node(v)))))
}

fn fingerprint(triangles: &[Triangle]) -> Fingerprint {
    fingerprint_of(triangles.iter().map(|t| t.map(|[x, y]| LatticePoint::new(x as u32, y as u32))))
}

#[test]
fn every_mesh_is_the_smallest_conforming_refinement() {
    let (mut meshes, mut with_holes, mut deepest, mut total) = (0, 0, 0, 0);
    for seed in 0..300 {
        let case = Case::random(seed);
        let Some(mut mesh) = case.coarse_mesh() else { continue };
        mesh.refine(&Limits::default(), case.rule()).unwrap();
        let expected = closure::set_of(case.closure(&mesh));
        assert!(triangles_of(&mesh) == expected, "seed {seed}");
        assert_eq!(mesh.fingerprint(), fingerprint(&expected), "seed {seed}");
        assert_eq!(mesh.violations(), [], "seed {seed}");
        assert_eq!(mesh.unsatisfied(case.rule()).unwrap(), [], "seed {seed}");
        meshes += 1;
        with_holes += usize::from(!matches!(case.hole, Hole::Nothing));
        deepest = deepest.max(mesh.level_counts().len() - 1);
        total += expected.len();
    }
    // The generator does its work.
    assert!(meshes >= 200 && with_holes >= 100, "{meshes} meshes, {with_holes} with holes");
    assert!(deepest >= 15 && total / meshes > 500, "deepest level {deepest}, {total} triangles");
}

#[test]
fn slices_of_any_length_give_the_same_mesh() {
    for seed in 1000..1060 {
        let case = Case::random(seed);
        let Some(coarse) = case.coarse_mesh() else { continue };
        let mut whole = coarse.clone();
        whole.refine(&Limits::default(), case.rule()).unwrap();
        let mut random = Rng::with_seed(seed);
        let mut mesh = coarse;
        let mut refiner = Refiner::new(&mesh, Limits::default());
        let mut slices = 0;
        while refiner.advance(&mut mesh, case.rule(), random.usize(1..300)).unwrap() == Progress::More {
            slices += 1;
            if slices % 8 == 1 {
                assert_eq!(mesh.violations(), [], "seed {seed}: conforming after every slice");
            }
        }
        assert_eq!(mesh.fingerprint(), whole.fingerprint(), "seed {seed}");
    }
}

#[test]
fn calls_in_any_order_give_the_same_mesh() {
    for seed in 2000..2040 {
        let case = Case::random(seed);
        let Some(coarse) = case.coarse_mesh() else { continue };
        let mut whole = coarse.clone();
        whole.refine(&Limits::default(), case.rule()).unwrap();
        let mut random = Rng::with_seed(seed);
        let mut mesh = coarse;
        loop {
            let unsatisfied = mesh.unsatisfied(case.rule()).unwrap();
            if unsatisfied.is_empty() {
                break;
            }
            // Bisecting one triangle may change others: each is asked again before its turn.
            for _ in 0..unsatisfied.len().div_ceil(2) {
                let id = unsatisfied[random.usize(..unsatisfied.len())];
                let corners = mesh.world_corners(id);
                if case.field.exceeds(mesh.diameter(mesh.triangle(id).level()), corners) {
                    mesh.refine_triangle(id);
                }
            }
        }
        assert_eq!(mesh.fingerprint(), whole.fingerprint(), "seed {seed}");
    }
}
