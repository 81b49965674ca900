//! Paths on the Earth: `.gpx` and `.kml`, read by a parser of its own and drawn as navigation programs do;
//! lengths and times.

use std::f64::consts::FRAC_PI_4;
use std::fs;

use crate::earth::on_the_ellipsoid;
use crate::folder::Folder;
use glam::{DVec2, DVec3, dvec2, dvec3};
use meshbrush_core::earth::Projection;
use serde_json::Value;

const RADIUS: f64 = 6_371_000.0;
const PLANE: &str = "+proj=tmerc +lon_0=20 +k_0=1 +ellps=WGS84 +units=m";
/// A sea of 900 km by 700 km with an island, in the plane.
const SEA: &str = "[[[-450e3,6200e3],[450e3,6200e3],[450e3,6900e3],[-450e3,6900e3],[-450e3,6200e3]],\
    [[-50e3,6400e3],[20e3,6650e3],[60e3,6380e3],[-50e3,6400e3]]]";
const ROUTE: &str = "--from -400e3,6500e3 --via 100e3,6750e3 --to 420e3,6300e3 --spacing 50e3";

/// An element, with its attributes as they are written and its text without that of others in it.
#[derive(Debug)]
struct Element {
    name: String,
    attributes: String,
    text: String,
    depth: usize,
}

impl Element {
    fn attribute(&self, name: &str) -> f64 {
        let start = self.attributes.find(&format!("{name}=\"")).expect(name) + name.len() + 2;
        self.attributes[start..].split('"').next().unwrap().parse().unwrap()
    }
}

/// Reads XML without comments, and checks that every element ends within the one that it begins in.
fn elements(xml: &str) -> Vec<Element> {
    let mut rest = xml.strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>").expect("a declaration");
    let (mut all, mut open): (Vec<Element>, Vec<usize>) = (Vec::new(), Vec::new());
    while let Some(start) = rest.find('<') {
        let (text, tag) = (&rest[..start], &rest[start + 1..]);
        if let Some(&last) = open.last() {
            let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
            all[last].text.push_str(&text);
        }
        let end = tag.find('>').expect("a tag ends");
        let (tag, after) = (&tag[..end], &tag[end + 1..]);
        rest = after;
        if let Some(name) = tag.strip_prefix('/') {
            let closed = open.pop().expect("an element that began");
            assert_eq!(all[closed].name, name);
            continue;
        }
        let (tag, is_empty) = tag.strip_suffix('/').map_or((tag, false), |tag| (tag, true));
        let (name, attributes) = tag.split_once(' ').unwrap_or((tag, ""));
        let [name, attributes] = [name, attributes].map(str::to_owned);
        all.push(Element { name, attributes, text: String::new(), depth: open.len() });
        if !is_empty {
            open.push(all.len() - 1);
        }
    }
    assert!(open.is_empty() && rest.trim().is_empty());
    all
}

fn in_space(at: DVec2) -> DVec3 {
    let [east, north] = at.to_array().map(f64::to_radians);
    dvec3(north.cos() * east.cos(), north.cos() * east.sin(), north.sin())
}

/// A place on the great circle between two others.
fn on_great_circle(a: DVec2, b: DVec2, share: f64) -> DVec2 {
    let at = in_space(a).lerp(in_space(b), share).normalize();
    dvec2(at.y.atan2(at.x).to_degrees(), at.z.asin().to_degrees())
}

/// A place on the line of one course between two others: straight on a map of Mercator's projection.
fn on_one_course(a: DVec2, b: DVec2, share: f64) -> DVec2 {
    let up = |at: DVec2| (FRAC_PI_4 + at.y.to_radians() / 2.0).tan().ln();
    let height = up(a) + share * (up(b) - up(a));
    let east = (b.x - a.x + 540.0).rem_euclid(360.0) - 180.0;
    dvec2(a.x + share * east, (2.0 * height.exp().atan()).to_degrees() - 90.0)
}

fn to_line(p: DVec2, line: &[DVec2]) -> f64 {
    let to_piece = |pair: &[DVec2]| {
        let along = pair[1] - pair[0];
        let share = ((p - pair[0]).dot(along) / along.length_squared().max(1e-300)).clamp(0.0, 1.0);
        p.distance(pair[0] + share * along)
    };
    line.windows(2).map(to_piece).fold(f64::INFINITY, f64::min)
}

/// Checks that drawn lines between the points of a route stay within 2 m of a line. `place` says where a
/// longitude and latitude is in metres.
fn assert_is_drawn_along(route: &[DVec2], line: &[DVec2], place: impl Fn(DVec2) -> DVec2) {
    let mut farthest = 0.0_f64;
    for pair in route.windows(2) {
        for n in 0..=20 {
            for drawn in [on_great_circle, on_one_course] {
                farthest = farthest.max(to_line(place(drawn(pair[0], pair[1], f64::from(n) / 20.0)), line));
            }
        }
    }
    assert!(farthest < 2.0, "{farthest} m");
    assert!(farthest > 0.2, "more points than are needed: {farthest} m");
}

fn points(answer: &Value) -> Vec<DVec2> {
    let point = |point: &Value| dvec2(point[0].as_f64().unwrap(), point[1].as_f64().unwrap());
    answer["points"].as_array().unwrap().iter().map(point).collect()
}

fn gpx(folder: &Folder, file: &str) -> (Vec<Element>, Vec<DVec2>) {
    let all = elements(&fs::read_to_string(folder.0.join(file)).unwrap());
    let places = all.iter().filter(|element| element.name == "rtept");
    let route = places.map(|place| dvec2(place.attribute("lon"), place.attribute("lat"))).collect();
    (all, route)
}

fn kml(folder: &Folder, file: &str) -> Vec<DVec2> {
    let all = elements(&fs::read_to_string(folder.0.join(file)).unwrap());
    assert!(all[0].name == "kml" && all[0].attributes.contains("http://www.opengis.net/kml/2.2"));
    let line = all.iter().find(|element| element.name == "coordinates").expect("a line");
    let places = line.text.split_whitespace().map(|place| {
        let (longitude, latitude) = place.split_once(',').unwrap();
        dvec2(longitude.parse().unwrap(), latitude.parse().unwrap())
    });
    places.collect()
}

fn write_sea(folder: &Folder) {
    let text = format!("{{\"type\":\"Polygon\",\"coordinates\":{SEA}}}");
    fs::write(folder.0.join("sea.geojson"), text).unwrap();
}

#[test]
fn routes_follow_the_path_within_the_stated_distance() {
    let folder = Folder::new("routes");
    write_sea(&folder);
    let line = format!("--region sea.geojson --projection '{PLANE}' {ROUTE} -o a.gpx -o a.kml");
    let points = points(&folder.json("path", line));
    let projection: Projection = PLANE.parse().unwrap();
    let (all, route) = gpx(&folder, "a.gpx");
    assert_is_drawn_along(&route, &points, |at| projection.plane_from_geographic(at));
    // Geodesics are bent in the plane, and are polylines there.
    assert!(route.len() >= points.len() && points.len() < 300, "{} {}", route.len(), points.len());
    assert!(route.len() < 500, "{}", route.len());
    assert_eq!(kml(&folder, "a.kml"), route);
    assert!(all[0].name == "gpx" && all[0].attributes.contains("http://www.topografix.com/GPX/1/1"));
    let named = |depth: usize| {
        let names = all.iter().filter(move |element| element.name == "name" && element.depth == depth);
        names.map(|element| element.text.clone()).collect::<Vec<_>>()
    };
    assert_eq!(named(2), ["Path", "Path"], "of the file and of the route");
    assert_eq!(named(3), ["Start", "Via 1", "Goal"]);
    for (n, place) in [dvec2(-400e3, 6500e3), dvec2(420e3, 6300e3)].into_iter().enumerate() {
        let end = [route[0], route[route.len() - 1]][n];
        assert!(projection.plane_from_geographic(end).distance(place) < 1e-3);
    }
    let meaning = all.iter().find(|element| element.name == "desc").unwrap();
    assert!(meaning.text.contains("coordinates: longitude, latitude in degrees; meshed in +proj=tmerc"));
}

#[test]
fn a_document_in_degrees_has_routes_with_the_name_of_the_path() {
    let folder = Folder::new("degrees");
    // Across the antimeridian, where longitudes go on beyond 180°.
    let recipe = "[domain]\nbounds = [170, -20, 190, -10]\nunit = \"degrees\"\n[mesh]\nspacing = 2\n\
        [paths]\nroutes = [[[172, -18], [188, -12]], [[171, -11], [189, -19]]]\nnames = [\"\", \"A <&> B\"]\n";
    fs::write(folder.0.join("fiji.toml"), recipe).unwrap();
    let points = points(&folder.json("path", "fiji.toml --route 2 -o b.gpx -o b.kml"));
    let (all, route) = gpx(&folder, "b.gpx");
    assert!(all.iter().any(|element| element.name == "name" && element.text == "A <&> B"));
    assert!(route.iter().all(|at| at.x.abs() <= 180.0) && route.iter().any(|at| at.x < 0.0));
    // In metres, about: that the scale of another parallel differs by some per cent does not matter.
    let scale = RADIUS.to_radians() * dvec2(15.0_f64.to_radians().cos(), 1.0);
    let shifted: Vec<DVec2> = points.iter().map(|&at| scale * at).collect();
    let place = |at: DVec2| scale * dvec2(if at.x < 0.0 { at.x + 360.0 } else { at.x }, at.y);
    assert_is_drawn_along(&route, &shifted, place);
    assert_eq!(kml(&folder, "b.kml"), route);
}

#[test]
fn a_route_needs_a_place_on_the_earth() {
    let folder = Folder::new("no-earth");
    for file in ["a.gpx", "a.kml"] {
        let line = format!("path --from 0.1,0.1 --to 0.9,0.9 --spacing 0.25 -o {file}");
        let ran = folder.run(line);
        let expected = format!("-o {file}: GPX and KML have longitudes and latitudes");
        assert!(ran.status == 2 && ran.err.contains(&expected), "{}", ran.err);
        assert!(!folder.0.join(file).exists());
    }
}

/// The length of a line in metres, by pieces of the plane of 1 km at most.
fn length_by_pieces(line: &[DVec2], geographic: impl Fn(DVec2) -> DVec2, longest: f64) -> f64 {
    let piece = |pair: &[DVec2]| {
        let count = (pair[0].distance(pair[1]) / longest).ceil().max(1.0);
        let place = |n: u32| geographic(pair[0].lerp(pair[1], f64::from(n) / count)).to_array();
        (0..count as u32).map(|n| on_the_ellipsoid(place(n), place(n + 1))).sum::<f64>()
    };
    line.windows(2).map(piece).sum()
}

#[test]
fn lengths_and_times_are_those_on_the_ellipsoid() {
    let folder = Folder::new("lengths");
    write_sea(&folder);
    let line = format!("--region sea.geojson --projection '{PLANE}' {ROUTE} --speed '12 kn'");
    let answer = folder.json("path", format!("{line} -o c.csv -o c.geojson"));
    let number = |name: &str| answer[name].as_f64().unwrap_or_else(|| panic!("{name}"));
    let projection: Projection = PLANE.parse().unwrap();
    let expected = length_by_pieces(&points(&answer), |at| projection.geographic_from_plane(at), 1e3);
    assert!((number("length") / expected - 1.0).abs() < 1e-9, "{} {expected}", number("length"));
    let stretched = number("length_in_plane") / number("length") - 1.0;
    assert!(
        (2e-4..3e-3).contains(&stretched),
        "up to 400 km from the meridian that is true to scale: {stretched}"
    );
    assert!((number("travel_seconds") - expected / (12.0 * 1852.0 / 3600.0)).abs() < 1e-3);
    let table = fs::read_to_string(folder.0.join("c.csv")).unwrap();
    let last: f64 = table.lines().last().unwrap().split(',').nth(2).unwrap().parse().unwrap();
    assert!((last / expected - 1.0).abs() < 1e-9);
    let text = fs::read_to_string(folder.0.join("c.geojson")).unwrap();
    let feature: Value = serde_json::from_str(&text).unwrap();
    for name in ["length", "length_in_plane", "travel_seconds", "cost"] {
        assert_eq!(feature["properties"][name], answer[name], "{name}");
    }
    let ran = folder.run(format!("path {line}"));
    let minutes = (number("travel_seconds") / 60.0).round() as u32;
    let time = format!(" m on the ellipsoid, {} h {} min on the way, ", minutes / 60, minutes % 60);
    assert!(ran.out.contains(&time), "{} {time}", ran.out);
}

#[test]
fn a_time_needs_metres() {
    let folder = Folder::new("times");
    let recipe = |unit: &str| {
        let text = format!(
            "[domain]\nbounds = [0, 40, 20, 60]\nunit = \"{unit}\"\n[mesh]\nspacing = 5\n\
            [paths]\nroutes = [[[2, 42], [18, 58]]]\n"
        );
        fs::write(folder.0.join("r.toml"), text).unwrap();
    };
    for (unit, metres) in
        [("m", 512.0_f64.sqrt()), ("km", 512e3_f64.sqrt() * 1e3_f64.sqrt()), ("degrees", 0.0)]
    {
        recipe(unit);
        let answer = folder.json("path", "r.toml --speed '10 m/s'");
        let expected = match unit {
            "degrees" => length_by_pieces(&points(&answer), |at| at, 0.002),
            _ => metres,
        };
        let seconds = answer["travel_seconds"].as_f64().unwrap();
        assert!((10.0 * seconds / expected - 1.0).abs() < 1e-9, "{unit}: {seconds} {expected}");
        assert!((answer["length"].as_f64().unwrap() - 512.0_f64.sqrt()).abs() < 1e-9);
    }
    recipe("none");
    for (options, message) in [
        ("--speed '10 m/s'", "--speed 10 m/s: the time of a path needs lengths in metres"),
        ("--speed 10", "--speed: 10 is no speed: write a number above 0 with its unit"),
    ] {
        let ran = folder.run(format!("path r.toml {options}"));
        assert!(ran.status == 2 && ran.err.contains(message), "{}", ran.err);
    }
}
