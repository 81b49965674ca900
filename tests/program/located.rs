//! The table of points in the mesh of a document, which the window writes of its pins, beside the output of
//! `meshbrush locate` for the saved document.

use std::path::Path;
use std::process::Command;
use std::{fs, io};

use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, Settings, Stage};
use meshbrush_core::domain::{BoundaryTreatment, CutShape, Domain, corners};
use meshbrush_core::field::{RefinementRule, Transfer};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_io::io::located::write_of_document;
use meshbrush_io::io::project::{self, Project};
use meshbrush_io::io::{Meter, Number};
use meshbrush_mesh::geometry::Rect;

/// Paints or erases at random.
fn paint(document: &mut Document, random: &mut fastrand::Rng) {
    let media = [Medium::Risk(1.0), Medium::Diameter(0.03, DiameterChange::Finer), Medium::Eraser];
    let medium = media[random.usize(..3)];
    let (radius, strength) = (0.01 + 0.04 * random.f64(), random.f64());
    document.begin_stroke(Brush { medium, radius, hardness: random.f64(), strength });
    let start = dvec2(random.f64(), random.f64());
    document.draw_to(start);
    document.draw_to(start + 0.1 * dvec2(random.f64(), random.f64()));
    document.end_stroke();
}

/// Meshes of a few thousand triangles.
fn coarse_settings() -> Settings {
    let transfer = Transfer::between(0.03, Settings::default().transfer.h_max);
    Settings { transfer, spacing: 0.25, ..Settings::default() }
}

fn settle(follower: &mut Follower, document: &mut Document) {
    while follower.advance(document, 997).unwrap() != Stage::InStep {}
}

/// Inside triangles, on nodes and edges of the coarse grid, and beyond the domain.
fn points(random: &mut fastrand::Rng) -> Vec<DVec2> {
    let somewhere = (0..200).map(|_| dvec2(random.f64(), random.f64()));
    let special = [dvec2(0.5, 0.5), dvec2(0.0, 1.0), dvec2(0.375, 0.25), dvec2(2.0, 0.1), dvec2(0.2, -1e-9)];
    somewhere.chain(special).collect()
}

fn table(document: &Document, points: &[DVec2]) -> String {
    let mut table = Vec::new();
    let (settings, paint) = (document.settings(), document.paint());
    write_of_document(&mut table, settings, paint, points, &Meter::default()).unwrap();
    String::from_utf8(table).unwrap()
}

/// What the program prints for the saved document.
fn printed(name: &str, document: &Document, points: &[DVec2]) -> String {
    let folder =
        Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("located-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let mut file = fs::File::create(folder.join("edited.meshbrush")).unwrap();
    project::write(&mut file, &Project::of(document)).unwrap();
    let row = |p: &DVec2| format!("{},{}\n", Number(p.x), Number(p.y));
    let rows: String = points.iter().map(row).collect();
    fs::write(folder.join("points.csv"), format!("x,y\n{rows}")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshbrush"));
    command.current_dir(&folder).args("locate --project edited.meshbrush --points points.csv".split(' '));
    let ran = command.output().unwrap();
    fs::remove_dir_all(&folder).unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    String::from_utf8(ran.stdout).unwrap()
}

#[test]
fn after_a_thousand_strokes_the_table_is_what_the_command_line_prints() {
    let mut random = fastrand::Rng::with_seed(23);
    let mut document = Document::new(coarse_settings(), None).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    let points = points(&mut random);
    for stroke in 0..1000 {
        if stroke % 100 == 0 {
            // Paint piles up until strokes change nothing any more.
            document.clear_paint();
        }
        paint(&mut document, &mut random);
        if random.u32(..10) == 0 {
            settle(&mut follower, &mut document);
        }
    }
    settle(&mut follower, &mut document);
    let ours = table(&document, &points);
    assert_eq!(ours.lines().count(), points.len() + 1);
    assert!(ours == printed("strokes", &document, &points), "the tables differ");
    // The mesh that was edited in place has the same triangles there, at other places of its arrays.
    for (row, point) in ours.lines().skip(1).zip(&points).take(200) {
        let columns: Vec<&str> = row.split(',').collect();
        let id = follower.mesh().locate(*point).triangle().unwrap();
        assert_eq!(columns[4], follower.mesh().triangle(id).level().to_string(), "{row}");
    }
}

#[test]
fn along_an_outline_the_table_is_what_the_command_line_prints() {
    let mut random = fastrand::Rng::with_seed(24);
    let hole = CutShape::Ring(corners(&Rect::around(dvec2(0.55, 0.45), 0.21)));
    let domain = Domain::rectangle(Rect::UNIT).reshaped(&hole, false).unwrap();
    for (boundary, rule) in [
        (BoundaryTreatment::OnOutline { diameter: 0.04 }, RefinementRule::Area),
        (BoundaryTreatment::Fitted { diameter: 0.04 }, RefinementRule::Vertex),
    ] {
        let settings = Settings { domain: domain.clone(), boundary, rule, ..coarse_settings() };
        let mut document = Document::new(settings, None).unwrap();
        for _ in 0..40 {
            paint(&mut document, &mut random);
        }
        let points = points(&mut random);
        let ours = table(&document, &points);
        assert!(ours.contains(",outside,,,") && ours.contains(",inside,"), "{ours}");
        assert_eq!(ours, printed("outline", &document, &points));
    }
}

#[test]
fn a_cancelled_table_is_not_written() {
    let document = Document::new(Settings::default(), None).unwrap();
    let meter = Meter::default();
    meter.cancel();
    let (settings, paint) = (document.settings(), document.paint());
    let written = write_of_document(&mut io::sink(), settings, paint, &[DVec2::ZERO], &meter);
    assert!(written.is_err());
}
