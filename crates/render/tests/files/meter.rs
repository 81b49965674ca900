//! Readers and writers report their progress, and leave the old files untouched when cancelled.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use meshbrush_core::document::{Example, ExampleData};
use meshbrush_core::domain::{MeshBoundary, NamedPolygon};
use meshbrush_core::layers::{Layer, LayerKind, RasterLayer, RasterReading, RasterSource};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::png::{Behind, read_metered as read_png};
use meshbrush_io::io::project::{self, Project};
use meshbrush_io::io::{
    CellShape, GridPlace, JoinedCells, MeshData, MeshFormat, Meter, Provenance, asc, geojson, geotiff,
    netcdf, npy, shapes, stl, vtu, write_file_metered,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

const CANCELLED: &str = "it was cancelled";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("meter").join(name);
    let _ = fs::remove_dir_all(&folder); // absent at the first run
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entry = |entry: io::Result<fs::DirEntry>| {
        let entry = entry.unwrap();
        (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
    };
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(entry).collect();
    files.sort();
    files
}

/// Returns a mesh with enough triangles for several blocks in every format.
fn mesh() -> (Mesh, Vec<f64>) {
    let limits = Limits::default();
    let mut mesh =
        Mesh::coarse_grid(&Lattice::covering(Rect::UNIT, 0.05, 1_000_000).unwrap(), |_| true, &limits)
            .unwrap();
    mesh.refine(&limits, |element| element.diameter() > 0.01).unwrap();
    let targets = vec![0.01; mesh.raw_nodes().len()];
    (mesh, targets)
}

/// Boundary and parts of a mesh, for its data.
struct Details(MeshBoundary, Vec<u32>, JoinedCells, Provenance);

impl Details {
    fn of(mesh: &Mesh) -> Self {
        let (boundary, parts) = (MeshBoundary::from_mesh(&mesh.extract()), mesh.extract().part_numbers());
        Self(boundary, parts, JoinedCells::default(), Provenance::default())
    }

    fn data<'a>(&'a self, targets: &'a [f64]) -> MeshData<'a> {
        let Self(boundary, parts, joined, provenance) = self;
        MeshData {
            target_diameter: targets,
            quantities: &[],
            heights: None,
            boundary,
            lines: &[],
            parts,
            cells: CellShape::Triangles,
            joined,
            parts_for: None,
            provenance,
        }
    }
}

struct Sea(Vec<NamedPolygon>);

impl ExampleData for Sea {
    fn sea(&self) -> Vec<NamedPolygon> {
        self.0.clone()
    }
}

/// Returns a project with a picture, polygons and paint, each larger than a block.
fn large_project() -> Project {
    let sea = fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/aegean_sea.geojson")).unwrap();
    let sea = geojson::read_named_from(&sea[..], Path::new("sea")).unwrap();
    let mut project = Project::of(&Example::Aegean.document(&Sea(sea)));
    let values = (0..500 * 400).map(|n| (n % 997) as f32 / 997.0).collect();
    let raster = Arc::new(RasterPyramid::new(Raster::from_values(Rect::UNIT, [500, 400], values)));
    let source = RasterSource { name: "noise.png".into(), raster };
    project.settings.layers =
        Layer::default_stack(LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk }));
    project
}

/// Returns a grid larger than a block.
fn grid_file(folder: &Path) -> PathBuf {
    let file = folder.join("grid.asc");
    let values = (0..200 * 200).map(|n| n as f32).collect();
    let mut text = Vec::new();
    asc::write(&mut text, &Raster::from_values(Rect::UNIT, [200, 200], values)).unwrap();
    fs::write(&file, text).unwrap();
    file
}

/// An output that cancels the meter after `after` bytes.
struct Cancelling<'a, W> {
    inner: W,
    meter: &'a Meter,
    after: usize,
}

impl<W: Write> Write for Cancelling<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.after = self.after.saturating_sub(written);
        if self.after == 0 {
            self.meter.cancel();
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

#[test]
fn a_meter_with_a_total_ends_at_it() {
    let folder = folder("whole");
    let (mesh, targets) = mesh();
    let details = Details::of(&mesh);
    for format in MeshFormat::all() {
        let ending = format.ending();
        let meter = Meter::default();
        let written = format.write(
            &folder.join("mesh").with_extension(ending),
            &mesh.extract(),
            &details.data(&targets),
            &meter,
        );
        let bytes: u64 = written.unwrap().iter().map(|path| fs::metadata(path).unwrap().len()).sum();
        match ending {
            "vtu" => assert_eq!(meter.total(), Some(meter.done())),
            "stl" | "nc" => assert_eq!((meter.done(), meter.total()), (bytes, Some(bytes)), "{ending}"),
            _ => assert_eq!((meter.done(), meter.total()), (bytes, None), "{ending}"),
        }
        assert!(meter.done() > 1 << 17, "{ending}: {}", meter.done());
    }
    assert_eq!(stl::bytes(&mesh.extract()), fs::metadata(folder.join("mesh.stl")).unwrap().len());

    let (file, meter) = (folder.join("a.meshbrush"), Meter::default());
    write_file_metered(&file, &meter, |out| project::write_metered(out, &large_project(), &meter)).unwrap();
    assert_eq!(meter.total(), Some(meter.done()));
    assert!(meter.done() > 500 * 400 * 4, "the picture is in it");
    let meter = Meter::default();
    project::read_metered(&file, &meter).unwrap();
    let (done, total) = (meter.done(), meter.total().unwrap());
    assert_eq!(total, 2 * fs::metadata(&file).unwrap().len());
    // The names and sizes of the parts are read, but not unpacked.
    assert!(done < total && total - done < 1000, "{done} of {total}");

    // One meter counts one file after another.
    geojson::read_named_metered(Path::new("../../assets/aegean_sea.geojson"), &meter).unwrap();
    assert_eq!(meter.total(), Some(meter.done()));
    shapes::read(Path::new("../../assets/aegean_sea.geojson"), &meter).unwrap();
    assert_eq!(meter.total(), Some(meter.done()));
    let grid = grid_file(&folder);
    asc::read_metered(&grid, &meter).unwrap();
    let bytes = fs::metadata(&grid).unwrap().len();
    assert_eq!((meter.done(), meter.total()), (bytes, Some(bytes)));
    read_png(Path::new("../../assets/jacksboro_slope.png"), Rect::UNIT, Behind::Black, &meter).unwrap();
    assert_eq!(meter.total(), Some(meter.done()));
}

#[test]
fn a_cancelled_read_is_an_error() {
    let folder = folder("read");
    let file = folder.join("a.meshbrush");
    write_file_metered(&file, &Meter::default(), |out| project::write(out, &large_project())).unwrap();
    let grid = grid_file(&folder);
    let array = folder.join("array.npy");
    fs::write(&array, b"\x93NUMPY\x01\0").unwrap();
    let meter = Meter::default();
    meter.cancel();
    let bad = [
        asc::read_metered(&grid, &meter).err(),
        geotiff::read(&grid, &meter).err(),
        netcdf::read_grid(&array, &GridPlace::default(), &meter).err(),
        npy::read(&array, Rect::UNIT, &meter).err(),
        shapes::read(Path::new("../../assets/aegean_sea.geojson"), &meter).err(),
        geojson::read_named_metered(Path::new("../../assets/aegean_sea.geojson"), &meter).err(),
        read_png(Path::new("../../assets/jacksboro_slope.png"), Rect::UNIT, Behind::Black, &meter).err(),
        project::read_metered(&file, &meter).err(),
    ];
    for error in bad {
        let error = error.expect("it was cancelled").to_string();
        assert!(error.contains(CANCELLED), "{error}");
    }
}

#[test]
fn a_cancelled_export_leaves_the_old_files() {
    let folder = folder("export");
    let (mesh, targets) = mesh();
    let details = Details::of(&mesh);
    let mesh = mesh.extract();
    for file in MeshFormat::all()
        .flat_map(|format| format.files(&folder.join("mesh").with_extension(format.ending())))
    {
        fs::write(&file, format!("old {}", file.display())).unwrap();
    }
    let before = files(&folder);
    for format in MeshFormat::all() {
        let ending = format.ending();
        let meter = Meter::default();
        meter.cancel();
        let path = folder.join("mesh").with_extension(ending);
        let error = format.write(&path, &mesh, &details.data(&targets), &meter).unwrap_err();
        assert_eq!(error.to_string(), CANCELLED);
        assert_eq!(files(&folder), before, "{ending}");
    }
    // In the middle of the second pass.
    let meter = Meter::default();
    let path = folder.join("mesh.vtu");
    let error = write_file_metered(&path, &meter, |out| {
        let mut out = Cancelling { inner: out, meter: &meter, after: 5000 };
        vtu::write_metered(&mut out, &mesh, &details.data(&targets), &meter)
    });
    assert_eq!(error.unwrap_err().to_string(), CANCELLED);
    assert!(meter.done() > meter.total().unwrap() / 2 && meter.done() < meter.total().unwrap());
    assert_eq!(files(&folder), before);
}

#[test]
fn a_cancelled_save_leaves_the_old_file() {
    let folder = folder("save");
    let file = folder.join("a.meshbrush");
    let project = large_project();
    fs::write(&file, "an old project").unwrap();
    let before = files(&folder);
    // Cancel before the first part, and between the two parts.
    for after in [0, 1] {
        let meter = Meter::default();
        if after == 0 {
            meter.cancel();
        }
        let error = write_file_metered(&file, &meter, |out| {
            project::write_metered(&mut Cancelling { inner: out, meter: &meter, after }, &project, &meter)
        });
        assert_eq!(error.unwrap_err().to_string(), CANCELLED);
        assert_eq!(files(&folder), before);
    }
}
