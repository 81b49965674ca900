//! Domains on the Earth, meshed in the plane of a projection. Lengths on the ellipsoid are computed here from
//! points in space, and not with the projections of the program.

use crate::folder::Folder;

/// Half the equatorial axis in metres, and the eccentricity squared, of WGS 84.
const A: f64 = 6_378_137.0;
const E2: f64 = 6.694_379_990_141_317e-3;

/// Returns the place in space of a longitude and latitude on the ellipsoid, in metres.
fn in_space([longitude, latitude]: [f64; 2]) -> [f64; 3] {
    let [longitude, latitude] = [longitude, latitude].map(f64::to_radians);
    let across = A / (1.0 - E2 * latitude.sin().powi(2)).sqrt();
    let from_axis = across * latitude.cos();
    [from_axis * longitude.cos(), from_axis * longitude.sin(), across * (1.0 - E2) * latitude.sin()]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

/// Returns the length of the geodesic between two points that are near each other. The straight line through
/// the Earth is shorter by s³ / 24 R², and R is at least 6,335 km anywhere.
pub fn on_the_ellipsoid(a: [f64; 2], b: [f64; 2]) -> f64 {
    let chord = distance(in_space(a), in_space(b));
    chord + chord.powi(3) / (24.0 * 6.335e6_f64.powi(2))
}

/// Returns the angles of a triangle of points in space, in degrees.
fn angles(points: [[f64; 3]; 3]) -> [f64; 3] {
    let side = |i: usize, j: usize| distance(points[i], points[j]);
    [[0, 1, 2], [1, 2, 0], [2, 0, 1]].map(|[i, j, k]| {
        let (a, b, c) = (side(j, k), side(i, j), side(i, k));
        ((b * b + c * c - a * a) / (2.0 * b * c)).acos().to_degrees()
    })
}

struct Coast {
    name: &'static str,
    /// Longitude and latitude, and half the width in degrees of latitude.
    at: [f64; 2],
    size: f64,
}

/// Ten coasts between 75° S and 80° N, two of them over the antimeridian.
const COASTS: [Coast; 10] = [
    Coast { name: "Ross Sea", at: [178.0, -73.0], size: 2.0 },
    Coast { name: "Magellan", at: [-70.5, -53.0], size: 2.5 },
    Coast { name: "Tasmania", at: [147.0, -42.0], size: 2.0 },
    Coast { name: "Fiji", at: [179.5, -17.5], size: 2.0 },
    Coast { name: "Gabon", at: [9.0, -0.5], size: 2.0 },
    Coast { name: "Florida", at: [-81.0, 25.0], size: 3.0 },
    Coast { name: "Sea of Japan", at: [134.0, 39.0], size: 4.0 },
    Coast { name: "Baltic", at: [20.0, 59.0], size: 4.0 },
    Coast { name: "Iceland", at: [-19.0, 65.0], size: 3.0 },
    Coast { name: "Svalbard", at: [18.0, 78.5], size: 1.5 },
];

impl Coast {
    /// Returns a rough ring of longitudes from −180 to 180 and latitudes.
    fn ring(&self, random: &mut fastrand::Rng) -> Vec<[f64; 2]> {
        let corner = |n: u32, random: &mut fastrand::Rng| {
            let angle = std::f64::consts::TAU * f64::from(n) / 60.0;
            let radius = self.size * (0.6 + 0.4 * random.f64());
            let latitude = self.at[1] + radius * angle.sin();
            let longitude = self.at[0] + radius * angle.cos() / latitude.to_radians().cos();
            [(longitude + 180.0).rem_euclid(360.0) - 180.0, latitude]
        };
        (0..60).map(|n| corner(n, random)).collect()
    }
}

fn polygon(rings: &[Vec<[f64; 2]>]) -> String {
    serde_json::json!({ "type": "Polygon", "coordinates": rings }).to_string()
}

/// Returns the longitudes and latitudes of the nodes, and the triangles, of a mesh in files.
fn mesh_in(folder: &Folder, name: &str) -> (Vec<[f64; 2]>, Vec<[usize; 3]>) {
    let rows = |ending: &str| -> Vec<Vec<f64>> {
        let numbers = |line: &str| line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        let text = folder.read(&format!("{name}.{ending}"));
        text.lines().skip(1).filter(|line| !line.starts_with('#')).map(numbers).collect()
    };
    let nodes = rows("node").iter().map(|row| [row[1], row[2]]).collect();
    let triangles = rows("ele").iter().map(|row| [1, 2, 3].map(|n| row[n] as usize - 1)).collect();
    (nodes, triangles)
}

#[test]
fn no_edge_is_longer_on_the_ellipsoid_than_its_target() {
    let folder = Folder::new("earth-edges");
    let mut random = fastrand::Rng::with_seed(11);
    let (mut edges, mut longest) = (0, 0.0_f64);
    for coast in &COASTS {
        folder.file("coast.geojson", polygon(&[coast.ring(&mut random)]));
        for projection in ["auto", "merc", "tmerc", "stere", "lcc"] {
            let command = format!(
                "mesh --region coast.geojson --projection {projection} --boundary fitted --spacing 60000 \
                 --target 9000 --boundary-diameter 9000"
            );
            let ran = folder.run(format!("{command} -o m.node"));
            if ran.status != 0 {
                // Only this coast lies on both sides of the equator.
                assert!(
                    coast.name == "Gabon" && ran.err.contains("both sides of the equator"),
                    "{}",
                    ran.err
                );
                continue;
            }
            assert_eq!(folder.run(format!("{command} --out-crs plane -o p.node")).status, 0);
            let ((nodes, triangles), (in_plane, _)) = (mesh_in(&folder, "m"), mesh_in(&folder, "p"));
            assert!(triangles.len() > 1000, "{}: {}", coast.name, triangles.len());
            for triangle in &triangles {
                let corners = triangle.map(|node| nodes[node]);
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    let length = on_the_ellipsoid(corners[a], corners[b]);
                    assert!(length <= 9000.0, "{} in {projection}: {length} m", coast.name);
                    longest = longest.max(length);
                    edges += 1;
                }
                let plane = triangle.map(|node| [in_plane[node][0], in_plane[node][1], 0.0]);
                let (here, there) = (angles(corners.map(in_space)), angles(plane));
                let off = (0..3).map(|i| (here[i] - there[i]).abs()).fold(0.0, f64::max);
                assert!(off < 0.2, "{} in {projection}: {off}° from the angles of the plane", coast.name);
            }
        }
    }
    eprintln!("{edges} edges, the longest {longest} m of 9000");
    assert!(longest > 8000.0);
}

#[test]
fn a_sea_that_is_cut_at_the_antimeridian_is_one() {
    let folder = Folder::new("earth-antimeridian");
    let half = |west: f64, east: f64| vec![[west, -19.0], [east, -19.0], [east, -15.0], [west, -15.0]];
    let halves = [half(176.0, 180.0), half(-180.0, -177.5)];
    let polygons: Vec<_> = halves.iter().map(|ring| vec![ring.clone()]).collect();
    let text = serde_json::json!({ "type": "MultiPolygon", "coordinates": polygons }).to_string();
    folder.file("cut.geojson", text);
    folder.file("whole.geojson", polygon(&[half(176.0, -177.5)]));
    let mesh = |file: &str| {
        let input = format!("--region {file} --projection auto --spacing 50000 --boundary fitted");
        folder.json("mesh", format!("{input} --target 20000"))
    };
    let (cut, whole) = (mesh("cut.geojson"), mesh("whole.geojson"));
    assert_eq!(cut["parts"], 1);
    assert_eq!(cut["triangles"], whole["triangles"]);
}

#[test]
fn a_continent_around_a_pole_is_meshed() {
    let folder = Folder::new("earth-pole");
    let mut ring: Vec<[f64; 2]> = (-180..=180).map(|longitude| [f64::from(longitude), -70.0]).collect();
    ring.extend([[180.0, -90.0], [-180.0, -90.0]]);
    folder.file("ice.geojson", polygon(&[ring]));
    let summary = folder.json("mesh", "--region ice.geojson --projection auto --spacing 400000");
    // The cap of a sphere of the same surface, drawn at most 1.07 times as large.
    let cap = std::f64::consts::TAU * 6_371_007.0_f64.powi(2) * (1.0 - 70.0_f64.to_radians().sin());
    let area = summary["region_area"].as_f64().unwrap();
    assert!((1.0..1.08).contains(&(area / cap)), "{area} of {cap}");
}

/// A rectangle as GeoJSON: west, south, east and north.
fn frame([west, south, east, north]: [f64; 4]) -> String {
    polygon(&[vec![[west, south], [east, south], [east, north], [west, north]]])
}

#[test]
fn what_cannot_be_projected_is_refused_with_the_reason() {
    let folder = Folder::new("earth-refused");
    folder.file("globe.geojson", frame([-180.0, -75.0, 180.0, 75.0]));
    folder.file("plane.geojson", frame([0.0, 0.0, 5000.0, 3000.0]));
    folder.file("far.geojson", frame([0.0, 0.0, 5.0, 84.0]));
    folder.file("depth.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n");
    folder.file("utm.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 50\ncellsize 1\n1 2\n");
    folder.file("utm.prj", "PROJCS[\"UTM 31N\",GEOGCS[\"ED50\"],UNIT[\"metre\",1]]");
    folder.file("web.geojson", frame([1e5, 6e6, 2e5, 6.1e6]));
    folder.file("sea.geojson", frame([0.0, 50.0, 5.0, 54.0]));
    for (arguments, sentence) in [
        ("--region globe.geojson --projection auto", "goes all around the Earth"),
        ("--region plane.geojson --projection auto", "not longitudes from −180° to 180° and latitudes"),
        ("--region far.geojson --projection merc", "times is the limit"),
        ("--region sea.geojson --projection mercator", "one of auto, metres, merc, tmerc, stere and lcc"),
        ("--region sea.geojson --projection +proj=merc+lat_ts=89", "is not a projection of this program"),
        ("--projection auto", "--projection auto: it is for the coordinates of a region"),
        ("--crs EPSG:32631", "--crs EPSG:32631: it is for the coordinates of a region"),
        ("--region sea.geojson --crs EPSG:27700", "--crs: “EPSG:27700” is not a coordinate system"),
        ("--region sea.geojson --projection EPSG:3857", "it does not keep angles on the ellipsoid"),
        ("--region sea.geojson --projection EPSG:27700", "its code is not known here"),
        ("--region sea.geojson --projection EPSG:4326", "it does not keep angles on the ellipsoid"),
        ("--region web.geojson --projection auto", "or a code such as --crs EPSG:32633"),
        ("--region sea.geojson --out-crs EPSG:32631 -o a.msh", "not in the plane of a projection"),
        ("--region sea.geojson --projection auto --target-raster depth.asc", "covers nothing of the domain"),
        (
            "--region sea.geojson --projection auto --target-raster utm.asc",
            "are in “UTM 31N”, and the document",
        ),
    ] {
        let ran = folder.run(format!("mesh {arguments}"));
        assert_ne!(ran.status, 0, "{arguments}");
        assert!(ran.err.contains(sentence), "{arguments}: {}", ran.err);
    }
}

/// A recipe that a projected document was written to makes the same mesh, and so does one in the plane.
#[test]
fn files_in_the_plane_make_the_same_mesh() {
    let folder = Folder::new("earth-plane");
    let mut random = fastrand::Rng::with_seed(3);
    folder.file("coast.geojson", polygon(&[COASTS[7].ring(&mut random)]));
    let by_degrees = folder.json(
        "mesh",
        "--region coast.geojson --projection lcc --spacing 60000 --target 20000 --out-crs plane -o a.node",
    );
    let (nodes, _) = mesh_in(&folder, "a");
    assert!(nodes.iter().any(|node| node[0].abs() > 1e5), "metres");
    // A format for degrees is for one of the two.
    let in_degrees = "mesh --region coast.geojson --projection lcc --spacing 60000 -o a.ll -o a.msh";
    assert_eq!(folder.run(in_degrees).status, 0);
    assert!(
        folder.read("a.msh").contains("coordinates: longitude, latitude in degrees; meshed in +proj=lcc")
    );
    let refused = folder.run(format!("{in_degrees} --out-crs plane"));
    assert!(refused.status != 0 && refused.err.contains("hgrid.gr3"), "{}", refused.err);
    folder.file(
        "coast.toml",
        "[domain]\nregion = \"coast.geojson\"\nprojection = \"lcc\"\n[mesh]\nspacing = 60000\n\
         [[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"20000\"\n",
    );
    let by_recipe = folder.json("mesh", "coast.toml");
    assert_eq!(by_recipe["hash"], by_degrees["hash"]);
}

#[test]
fn keep_out_regions_in_degrees_lie_in_the_plane_of_the_domain() {
    let folder = Folder::new("earth-keep-out");
    folder.file("sea.geojson", frame([0.0, 50.0, 5.0, 54.0]));
    folder.file("zone.geojson", frame([2.2, 51.8, 2.8, 52.2]));
    // The middle of the domain is the origin of the plane.
    let path = "--region sea.geojson --projection lcc --boundary-diameter 20000 --spacing 40000 --target 5000 \
                --from -100000,0 --to 100000,0";
    let length = |options: &str| folder.json("path", format!("{path} {options}"))["length"].as_f64().unwrap();
    let (straight, around) = (length(""), length("--keep-out zone.geojson"));
    assert!((straight - 200_000.0).abs() < 1.0 && around > 204_000.0, "{straight} m and {around} m");
    // So do those in the system that an option says for all files that name none.
    folder.file("utm.geojson", frame([440_000.0, 6_430_000.0, 560_000.0, 6_540_000.0]));
    folder.file("zone-utm.geojson", frame([490_000.0, 6_475_000.0, 510_000.0, 6_495_000.0]));
    let path = "--region utm.geojson --crs EPSG:32633 --projection lcc --boundary-diameter 4000 --spacing 8000 \
                --target 2000 --from 14.3°,58.5° --to 15.7°,58.5°";
    let length = |options: &str| folder.json("path", format!("{path} {options}"))["length"].as_f64().unwrap();
    let (straight, around) = (length(""), length("--keep-out zone-utm.geojson"));
    assert!(around > 1.01 * straight, "{straight} m and {around} m");
}

/// Diameters of 2 km west of 2° W and of 20 km east of there, in pixels of a tenth of a degree.
#[test]
fn a_raster_in_degrees_lies_where_it_does_on_the_earth() {
    let folder = Folder::new("earth-raster");
    let frame = [[-4.0, 58.0], [0.0, 58.0], [0.0, 60.0], [-4.0, 60.0]];
    folder.file("sea.geojson", polygon(&[frame.to_vec()]));
    for (file, west) in [("depth.asc", -4.0), ("turned.asc", 356.0)] {
        let row: Vec<&str> = (0..40).map(|column| if column < 20 { "2000" } else { "20000" }).collect();
        let rows = vec![row.join(" "); 20].join("\n");
        let header = format!("ncols 40\nnrows 20\nxllcorner {west}\nyllcorner 58\ncellsize 0.1\n");
        folder.file(file, header + &rows);
    }
    for projection in ["merc", "tmerc", "lcc", "stere"] {
        let input =
            format!("--region sea.geojson --projection {projection} --boundary fitted --spacing 60000");
        let summary = folder.json("mesh", format!("{input} --target-raster depth.asc -o m.node"));
        let (nodes, triangles) = mesh_in(&folder, "m");
        let (mut fine, mut coarse) = (0, 0);
        for triangle in &triangles {
            let corners = triangle.map(|node| nodes[node]);
            let lengths = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| on_the_ellipsoid(corners[a], corners[b]));
            let longest = lengths.into_iter().fold(0.0, f64::max);
            // Values between pixels are linear: 2 km up to the middle of the last pixel, 2.05° W.
            if corners.iter().any(|at| at[0] < -2.06 && at[0] > -3.99) {
                assert!(longest <= 2000.0, "{projection}: {longest} m at {corners:?}");
                fine += 1;
            } else {
                coarse += usize::from(longest > 10_000.0);
            }
        }
        assert!(fine > 10_000 && coarse > 100, "{projection}: {fine} and {coarse}");
        let turned = folder.json("mesh", format!("{input} --target-raster turned.asc"));
        assert_eq!(turned["hash"], summary["hash"], "{projection}");
    }
}

/// ArcGIS's text for EPSG:32633, without the code.
const UTM_33: &str = r#"PROJCS["WGS_1984_UTM_Zone_33N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",
    SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],
    PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],
    PARAMETER["Central_Meridian",15.0],PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],
    UNIT["Meter",1.0]]"#;

/// The same sea in degrees and in a zone of UTM, where the sizes are too. The coordinates are PROJ's.
#[test]
fn files_of_a_zone_of_utm_lie_where_they_do_on_the_earth() {
    let folder = Folder::new("earth-utm");
    let in_degrees = [[14.0, 58.0], [16.0, 58.0], [16.0, 59.0], [14.0, 59.0]];
    let in_utm = [
        [440_892.105, 6_429_147.611],
        [559_107.895, 6_429_147.611],
        [557_450.941, 6_540_481.779],
        [442_549.059, 6_540_481.779],
    ];
    folder.file("degrees.geojson", polygon(&[in_degrees.to_vec()]));
    folder.file("utm.geojson", polygon(&[in_utm.to_vec()]));
    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32633"}},"type":"#;
    folder.file("named.geojson", polygon(&[in_utm.to_vec()]).replacen("\"type\":", crs, 1));
    let row: Vec<&str> = (0..24).map(|column| if column < 12 { "2000" } else { "9000" }).collect();
    let header = "ncols 24\nnrows 24\nxllcorner 435000\nyllcorner 6425000\ncellsize 5000\n";
    folder.file("size.asc", header.to_owned() + &vec![row.join(" "); 24].join("\n"));
    folder.file("size.prj", UTM_33);
    for region in ["degrees.geojson", "utm.geojson --crs EPSG:32633", "named.geojson"] {
        for projection in ["lcc", "EPSG:32633", "EPSG:3034"] {
            let case = format!("--region {region} --projection {projection}");
            let options =
                "--boundary fitted --spacing 20000 --target-raster size.asc -o m.node --out-crs lonlat";
            folder.json("mesh", format!("{case} {options}"));
            let (nodes, _) = mesh_in(&folder, "m");
            let ends = |axis: usize| {
                let values = nodes.iter().map(|at| at[axis]);
                values.fold([180.0_f64, -180.0], |[least, greatest], v| [least.min(v), greatest.max(v)])
            };
            for (axis, ends_of_frame) in [[14.0, 16.0], [58.0, 59.0]].into_iter().enumerate() {
                let off =
                    ends(axis).iter().zip(ends_of_frame).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // A straight side in UTM bulges by 0.012° to the north.
                assert!(off < 0.02, "{case}: {off}° along axis {axis}");
            }
            // Fine up to x = 492.5 km, which is 14.87° E here.
            let [fine, coarse] = [[14.0, 14.8], [15.0, 15.8]]
                .map(|[west, east]| nodes.iter().filter(|at| at[0] > west && at[0] < east).count());
            assert!(fine > 8 * coarse && coarse > 50, "{case}: {fine} and {coarse}");
        }
    }
    // Files are in the system that is asked for, or in that of the region.
    for (region, corners, tolerance) in [
        ("degrees.geojson --out-crs EPSG:32633", in_utm, 0.01),
        ("named.geojson", in_utm, 0.01),
        ("degrees.geojson", in_degrees, 1e-7),
    ] {
        folder.json("mesh", format!("--region {region} --projection lcc --spacing 20000 -o m.node"));
        let (nodes, _) = mesh_in(&folder, "m");
        // The southern corners are those of the frame, which always are nodes.
        for corner in &corners[..2] {
            let distances = nodes.iter().map(|at| (at[0] - corner[0]).hypot(at[1] - corner[1]));
            assert!(distances.fold(f64::MAX, f64::min) < tolerance, "{region}: {corner:?}");
        }
    }
}

/// Lengths with a unit need no other option: the region is meshed in metres.
#[test]
fn a_length_with_a_unit_puts_a_region_into_metres() {
    let folder = Folder::new("earth-units");
    folder.file("sea.geojson", frame([14.0, 58.0, 16.0, 59.0]));
    folder.file("utm.geojson", frame([440_000.0, 6_430_000.0, 560_000.0, 6_540_000.0]));
    folder.file("local.geojson", frame([0.0, 0.0, 5_000.0, 3_000.0]));
    let hash = |options: &str| folder.json("mesh", options)["hash"].as_str().unwrap().to_owned();
    let by_numbers = hash("--region sea.geojson --projection auto --spacing 37040 --target 4000");
    assert_eq!(hash("--region sea.geojson --spacing '20 nmi' --target '4 km'"), by_numbers);
    // A plane in metres that is known stays as it is.
    let own = "--region utm.geojson --crs EPSG:32633 --projection EPSG:32633 --spacing 20000";
    assert_eq!(hash("--region utm.geojson --crs EPSG:32633 --spacing 20km"), hash(own));
    for (options, sentence) in [
        ("--region local.geojson --spacing 1km", "so they cannot be projected. Say what they are: --crs"),
        (
            "--spacing 0.1km",
            "--spacing 0.1km: lengths of this domain are plain numbers. Name a region on the Earth",
        ),
        (
            "--region sea.geojson --projection none --h-min 2km",
            "--h-min 2km: lengths of this domain are in degrees",
        ),
        (
            "--region sea.geojson --projection auto --spacing 0.1°",
            "--spacing 0.1°: lengths of this domain are in metres",
        ),
        ("--region sea.geojson --spacing 2apples", "“apples” cannot be converted to m"),
        ("--region sea.geojson --spacing much", "“much” is not a number"),
    ] {
        let ran = folder.run(format!("mesh {options}"));
        assert!(ran.status != 0 && ran.err.contains(sentence), "{options}: {}", ran.err);
    }
    assert_eq!(folder.run("mesh --region sea.geojson --spacing 0.1°").status, 0);
}

/// A ship goes around a cape in the north of a chart in Mercator, where lengths are drawn much longer than in
/// the south.
#[test]
fn a_ship_keeps_its_clearance_on_the_earth() {
    let folder = Folder::new("earth-ship");
    let cape = [20.5, 65.3];
    let ring = [[18.0, 58.0], [23.0, 58.0], [23.0, 66.0], [20.6, 66.0], cape, [20.4, 66.0], [18.0, 66.0]];
    folder.file("sea.geojson", polygon(&[ring.to_vec()]));
    let ship = "--region sea.geojson --projection merc --spacing 60000 --target 15000 --from 18.9°,65.7° \
                --to 22.1°,65.7°";
    let route = |options: &str| -> Vec<[f64; 2]> {
        folder.json("path", format!("{ship} {options} -o ship.gpx"));
        let text = folder.read("ship.gpx");
        let number = |point: &str, key: &str| {
            point.split_once(key).unwrap().1.split('"').next().unwrap().parse().unwrap()
        };
        let points = text.split("<rtept ").skip(1);
        points.map(|point| [number(point, "lon=\""), number(point, "lat=\"")]).collect()
    };
    let nearest = |route: &[[f64; 2]]| {
        let share = |n: u32| f64::from(n) / 100.0;
        let along = route.windows(2).flat_map(|ends| {
            (0..=100)
                .map(move |n| [0, 1].map(|axis| ends[0][axis] + share(n) * (ends[1][axis] - ends[0][axis])))
        });
        along.map(|at| on_the_ellipsoid(at, cape)).fold(f64::MAX, f64::min)
    };
    let close = route("");
    assert!(on_the_ellipsoid(close[0], [18.9, 65.7]) < 1e-3, "{:?}", close[0]);
    assert!(nearest(&close) < 4_000.0, "{} m", nearest(&close));
    let wide = nearest(&route("--clearance 10km"));
    assert!((10_000.0..14_000.0).contains(&wide), "{wide} m");
    for (options, sentence) in [
        ("--clearance 1°", "--clearance 1°: lengths of this domain are in metres"),
        ("--clearance 90km", "and the clearance of paths is 90000"),
    ] {
        let ran = folder.run(format!("path {ship} {options}"));
        assert!(ran.status != 0 && ran.err.contains(sentence), "{options}: {}", ran.err);
    }
    let plain = folder.run("path --target 0.1 --from 24°,37° --to 25°,37°");
    assert!(plain.err.contains("24°,37°: the coordinates of this domain are no longitudes"), "{}", plain.err);
    let mixed = folder.run("path --target 0.1 --from 24°,37 --to 25°,37°");
    assert!(mixed.err.contains("“24°,37” is no point"), "{}", mixed.err);
}

/// Bounds beside a region or land are in the coordinates of the file: of a box of 10° × 8° with an island of
/// 1° × 1°, one of 4° × 2° around the island is left.
#[test]
fn bounds_are_in_the_coordinates_of_the_file() {
    let folder = Folder::new("earth-bounds");
    let rectangle = |[w, s, e, n]: [f64; 4]| vec![[w, s], [e, s], [e, n], [w, n], [w, s]];
    let island = rectangle([-5.5, 47.5, -4.5, 48.5]);
    folder.file("sea.geojson", polygon(&[rectangle([-10.0, 44.0, -0.5, 52.0]), island.clone()]));
    folder.file("land.geojson", polygon(&[island]));
    let recipe =
        |rest: &str| format!("[domain]\nbounds = [-6, 47, -2, 49]\n{rest}\n[mesh]\nspacing = 0.25\n");
    let area = |text: &str| -> f64 {
        folder.file("r.toml", text);
        let found = folder.json("mesh", "r.toml");
        let kinds: Vec<&str> = found["boundary"]
            .as_array()
            .unwrap()
            .iter()
            .map(|piece| piece["type"].as_str().unwrap())
            .collect();
        assert_eq!(kinds, ["open", "open", "open", "open", "land"], "{text}");
        found["region_area"].as_f64().unwrap()
    };
    for domain in [r#"region = "sea.geojson""#, r#"land = "land.geojson""#] {
        assert!((area(&recipe(domain)) - 7.0).abs() < 1e-6, "{domain}");
        let projected = recipe(&format!("{domain}\nprojection = \"auto\"")).replace("0.25", "\"20 km\"");
        let in_metres = area(&projected);
        assert!((in_metres / 5.808e10 - 1.0).abs() < 2e-3, "{domain}: {in_metres}");
    }
    let refused = |text: &str, part: &str| {
        folder.file("r.toml", text);
        let ran = folder.run("mesh r.toml");
        assert!(ran.status != 0 && ran.err.contains(part), "{part}: {}", ran.err);
    };
    refused(
        "[domain]\nregion = \"sea.geojson\"\nbounds = [20, 47, 22, 49]\nprojection = \"auto\"\n",
        "none of its polygons lies in the bounds 20, 47 to 22, 49",
    );
    refused(
        "[domain]\nland = \"land.geojson\"\nbounds = [5e5, 5e6, 6e5, 6e6]\n",
        "are no longitudes and latitudes",
    );
    refused("[domain]\nland = \"land.geojson\"\ninside = \"x\"\n", "by `land` or by `inside`, not by both");
    refused("[domain]\nsea = [1, 2]\n", "this is a place in the sea beside land");
}

/// A grid of longitudes and latitudes that makes the domain gives its unit, so that sizes in metres are
/// refused.
#[test]
fn a_domain_from_grids_has_their_unit() {
    let folder = Folder::new("earth-grid-unit");
    let grid = "ncols 3\nnrows 2\nxllcorner 5\nyllcorner 50\ncellsize 0.5\n-10 -20 -30\n-10 -20 -30\n";
    let degrees = r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],UNIT["degree",0.0174532925199433]]"#;
    folder.file("plain.asc", grid);
    folder.file("degrees.asc", grid);
    folder.file("degrees.prj", degrees);
    let unit = |options: &str| folder.json("mesh", options)["unit"].clone();
    assert_eq!(unit("--surface degrees.asc --max-error 5"), "degrees");
    assert_ne!(unit("--surface plain.asc --max-error 5"), "degrees");
    let ran = folder.run("mesh --depth degrees.asc --per-wavelength 20 --period 600");
    assert!(ran.status != 0 && ran.err.contains("lengths of the domain are in degrees"), "{}", ran.err);
}

/// Bounds beside a grid of longitudes and latitudes may also be metres in the plane of a projection.
#[test]
fn bounds_of_a_contour_may_be_in_the_plane_of_the_mesh() {
    let folder = Folder::new("earth-contour-bounds");
    let row = "-10 -20 -30 -40\n";
    folder.file(
        "sea.asc",
        format!("ncols 4\nnrows 4\nxllcorner 5\nyllcorner 50\ncellsize 0.5\n{}", row.repeat(4)),
    );
    let plane = "+proj=merc +lon_0=6 +ellps=WGS84 +units=m";
    let recipe = |bounds: &str| {
        let domain =
            format!("region = \"sea.asc\"\ncontour = 0\ncrs = \"lonlat\"\nprojection = \"{plane}\"\n");
        folder.file("r.toml", format!("[domain]\n{domain}bounds = {bounds}\n[mesh]\nspacing = \"10 km\"\n"));
        folder.json("mesh", "r.toml")["region_area"].as_f64().unwrap()
    };
    // At 50.5° N, a length in this plane is 1.571 times that on the ellipsoid.
    let in_plane = recipe("[-20000, 6480000, 20000, 6520000]");
    assert!((in_plane / 1.6e9 * 1.571 * 1.571 - 1.0).abs() < 1e-2, "{in_plane}");
    let width = on_the_ellipsoid([5.5, 51.0], [6.5, 51.0]);
    let height = on_the_ellipsoid([5.5, 50.5], [5.5, 51.5]);
    let in_degrees = recipe("[5.5, 50.5, 6.5, 51.5]");
    assert!((in_degrees / (width * height) - 1.0).abs() < 1e-2, "{in_degrees}");
}
