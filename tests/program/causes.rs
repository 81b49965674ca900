//! Why triangles are there: the stated cause, replayed alone from the coarse grid, makes the triangle.
//!
//! `MESHBRUSH_TABLE=1` prints the shares.

use std::process::Command;

use crate::runs::{prints_table, runs};
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{
    Layer, LayerKind, PaintLayers, SizeField, SizeFieldSpec, Threat, ThreatLaw, Threats,
};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Cause, Limits, Mesh, TreeTriangle, TriangleId};
use serde_json::Value;

/// A mesh with holes, its coarse grid, and the field it satisfies.
struct Case {
    coarse: Mesh,
    mesh: Mesh,
    field: SizeField,
}

impl Case {
    fn random(seed: u64) -> Self {
        let mut random = Rng::with_seed(seed);
        let lattice = Lattice::covering(Rect::UNIT, [0.2, 0.11][random.usize(..2)], 1000).unwrap();
        let hole = dvec2(random.f64(), random.f64());
        let keeps = |center: DVec2| center.distance(hole) > 0.2;
        let coarse = Mesh::coarse_grid(&lattice, keeps, &Limits::default()).unwrap();
        let transfer = Transfer::between(0.002 + 0.01 * random.f64(), 0.5);
        let gradation = random.bool().then(|| 0.2 + random.f64());
        let layers = Layer::stack([disc(&mut random), threats(&mut random), strip(&mut random)]);
        let spec =
            SizeFieldSpec { layers, transfer, unasked: 0.5, outline: None, gradation, projection: None };
        let field = SizeField::new(spec, &lattice);
        let mut mesh = coarse.clone();
        mesh.refine(&Limits::default(), |element| field.exceeds(PaintLayers::blank(), element)).unwrap();
        Self { coarse, mesh, field }
    }

    fn exceeds(&self, triangle: &TreeTriangle) -> bool {
        self.field.asks_for_more(PaintLayers::blank(), triangle.corners(), triangle.level())
    }

    /// Returns the coarse grid, refined until a triangle and its halves would be there, and no further.
    fn replayed(&self, required_by: &TreeTriangle) -> Mesh {
        let mut mesh = self.coarse.clone();
        let [a, b, c] = required_by.corners().map(LatticePoint::as_dvec2);
        let inner = 0.5 * a + 0.25 * (b + c);
        mesh.refine(&Limits::default(), |element| {
            element.triangle.level() <= required_by.level() && contains(element.corners, inner)
        })
        .unwrap();
        mesh
    }
}

fn disc(random: &mut Rng) -> LayerKind {
    let [x, y, r] = [random.f64(), random.f64(), 0.1 * random.f64()];
    let text = format!("if(hypot(x - {x}, y - {y}) < {r}, {}, inf)", 0.01 + 0.02 * random.f64());
    LayerKind::target(Formula::parse(&text).unwrap())
}

fn strip(random: &mut Rng) -> LayerKind {
    let at = random.f64();
    LayerKind::target(Formula::parse(&format!("0.004 + 0.7 * abs(x + 0.3 * y - {at})")).unwrap())
}

fn threats(random: &mut Rng) -> LayerKind {
    let mut threat = || Threat {
        at: dvec2(random.f64(), random.f64()),
        range: 0.02 + 0.2 * random.f64(),
        peak: random.f64(),
        law: ThreatLaw::Radar,
    };
    let list = (0..5).map(|_| threat()).collect();
    Threats::new(list).unwrap().into()
}

/// Returns whether a point lies in a triangle, by areas.
fn contains([a, b, c]: [LatticePoint; 3], point: DVec2) -> bool {
    let [a, b, c] = [a, b, c].map(LatticePoint::as_dvec2);
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| (to - from).perp_dot(point - from));
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}

/// Returns the corners, in no order.
fn sorted(corners: [LatticePoint; 3]) -> [[u32; 2]; 3] {
    let mut corners = corners.map(|c| [c.x, c.y]);
    corners.sort_unstable();
    corners
}

fn has_triangle(mesh: &Mesh, triangle: &TreeTriangle) -> bool {
    let wanted = sorted(triangle.corners());
    let [a, b, c] = triangle.corners().map(LatticePoint::as_dvec2);
    let inner = 0.5 * a + 0.25 * (b + c);
    // It is there, or has been bisected: then its leaves lie in it and are deeper.
    (0..mesh.raw_triangle_count()).map(TriangleId::from_index).any(|id| {
        let corners = mesh.triangle(id).vertices.map(|node| mesh.node(node));
        sorted(corners) == wanted
            || (mesh.triangle(id).level() > triangle.level() && contains(corners, inner))
    })
}

#[test]
fn the_stated_cause_alone_makes_the_triangle() {
    let wanted: usize = runs(600) as usize;
    let (mut own, mut forced, mut longest) = (0, 0, 0);
    for seed in 0.. {
        let case = Case::random(seed);
        let mut random = Rng::with_seed(seed);
        for _ in 0..20 {
            let id = TriangleId::from_index(random.usize(..case.mesh.raw_triangle_count()));
            let triangle = TreeTriangle::from_mesh(&case.mesh, id);
            let cause = case.mesh.cause_of(&triangle, |one| case.exceeds(one));
            match &cause {
                Cause::Coarse => assert_eq!(triangle.level(), 0),
                Cause::OwnRule { parent } => {
                    assert!(case.exceeds(parent));
                    own += 1;
                }
                Cause::Compatibility { chain } => {
                    assert!(case.exceeds(&chain[0]), "seed {seed}, {id:?}");
                    assert!(!case.exceeds(chain.last().unwrap()), "it would be its own cause");
                    let levels: Vec<_> = chain.iter().map(TreeTriangle::level).collect();
                    assert!(levels.is_sorted_by(|a, b| a >= b) && levels[0] >= triangle.level() - 1);
                    forced += 1;
                    longest = longest.max(chain.len());
                }
                other => panic!("{other:?}"),
            }
            if let Some(required_by) = cause.required_by() {
                assert!(
                    has_triangle(&case.replayed(required_by), &triangle),
                    "seed {seed}, {id:?}: {cause:?}"
                );
            }
        }
        if own + forced >= wanted {
            break;
        }
    }
    if prints_table() {
        eprintln!("own rule {own}, compatibility {forced}, longest chain {longest}");
    }
    assert!(own > wanted / 4 && forced > wanted / 20 && longest > 3, "{own} {forced} {longest}");
}

#[test]
fn the_tree_of_a_mesh_is_walked_up_and_down() {
    let case = Case::random(3);
    let mesh = &case.mesh;
    for index in 0..mesh.raw_triangle_count() {
        let id = TriangleId::from_index(index);
        let triangle = TreeTriangle::from_mesh(mesh, id);
        assert_eq!(mesh.entry_of(&triangle), Some(id));
        assert!(!mesh.is_bisected(&triangle));
        let Some(parent) = triangle.parent(mesh.lattice()) else { continue };
        assert!(mesh.is_bisected(&parent) && mesh.entry_of(&parent).is_none());
        let sibling = triangle.sibling(mesh.lattice()).unwrap();
        assert!(parent.children().iter().any(|child| child.is_same(&sibling)));
        assert!(!sibling.is_same(&triangle));
        assert_eq!(triangle.ancestors(mesh.lattice()).len(), triangle.level() as usize);
        // Two siblings of one level fill the parent: their leaves are found there.
        assert!(mesh.is_bisected(&sibling) || mesh.entry_of(&sibling).is_some());
    }
}

/// What `meshbrush why` prints, or the status and the error.
fn why(arguments: &[&str]) -> Result<String, (Option<i32>, String)> {
    let run = Command::new(env!("CARGO_BIN_EXE_meshbrush")).arg("why").args(arguments).output().unwrap();
    let [out, err] = [run.stdout, run.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    if run.status.success() { Ok(out) } else { Err((run.status.code(), err)) }
}

/// Fine in a small disc only, so that most triangles around it are there for compatibility.
const DISC: [&str; 6] =
    ["--spacing", "0.1", "--rule", "area", "--target", "if(hypot(x-0.3,y-0.5)<0.002,0.001,1)"];

#[test]
fn the_command_line_names_the_layer_and_the_place() {
    let own = why(&[&["0.3,0.5"][..], &DISC].concat()).unwrap();
    assert!(own.contains("exceeds its target.\nThe least target diameter in it is at (0.30"), "{own}");
    assert!(own.contains("the layer “Formula” asks for 0.001"), "{own}");
    let forced = why(&[&["0.27,0.46"][..], &DISC].concat()).unwrap();
    assert!(forced.contains("It was bisected to keep the mesh compatible."), "{forced}");
    assert!(forced.contains("A triangle of level 1"), "{forced}");
    assert_eq!(
        why(&["0.9,0.9", "--target", "1"]).unwrap().lines().last().unwrap(),
        "It is a triangle of the coarse grid: no bisection made it."
    );
    let carried = why(&[&["0.27,0.46", "--gradation", "0.2"][..], &DISC].concat()).unwrap();
    assert!(carried.contains("the gradation carries it there."), "{carried}");
}

#[test]
fn the_chain_of_the_command_line_goes_level_by_level_to_the_parent() {
    let text = why(&[&["0.27,0.46", "--json"][..], &DISC].concat()).unwrap();
    let answer: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(answer["cause"], "compatibility");
    let levels: Vec<u64> =
        answer["chain"].as_array().unwrap().iter().map(|link| link["level"].as_u64().unwrap()).collect();
    assert!(levels.is_sorted_by(|a, b| a - 1 == *b || a == b), "{levels:?}");
    assert_eq!(*levels.last().unwrap(), answer["level"].as_u64().unwrap() - 1);
    assert_eq!(answer["demand"]["layer"], "Formula");
    assert!((answer["demand"]["target"].as_f64().unwrap() - 0.001).abs() < 1e-9);
    let first = &answer["chain"][0];
    assert!(first["diameter"].as_f64().unwrap() > 0.001);
}

#[test]
fn the_command_line_refuses_points_outside() {
    assert_eq!(
        why(&["7,7"]).unwrap_err(),
        (Some(1), "meshbrush: No triangle is at 7,7: the domain goes from 0,0 to 1,1.\n".into())
    );
    let (status, error) = why(&["-1,inf"]).unwrap_err();
    assert_eq!(status, Some(2));
    assert!(error.contains("is no point. Write two numbers and a comma"), "{error}");
    let (_, hole) = why(&["0.5,0.5", "--inside", "hypot(x-0.5,y-0.5) > 0.3"]).unwrap_err();
    assert!(hole.contains("in a hole of the domain"), "{hole}");
}
