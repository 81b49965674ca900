//! Routes for navigation programs: GPX 1.1.

use std::io::{self, Write};

use super::{Provenance, RouteOnEarth};
use meshbrush_mesh::text::xml_text;

/// Writes a route with its name; its places have names, too. Coordinates are WGS 84.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_gpx(out: &mut dyn Write, route: &RouteOnEarth<'_>, provenance: &Provenance) -> io::Result<()> {
    let creator = concat!("Meshbrush ", env!("CARGO_PKG_VERSION"));
    let [name, description] = [route.name, &provenance.line()].map(xml_text);
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(out, r#"<gpx version="1.1" creator="{creator}" xmlns="http://www.topografix.com/GPX/1/1">"#)?;
    writeln!(out, "<metadata><name>{name}</name><desc>{description}</desc></metadata>")?;
    writeln!(out, "<rte><name>{name}</name>")?;
    for point in &route.points {
        let [longitude, latitude] = point.at.to_array();
        write!(out, r#"<rtept lat="{latitude:.9}" lon="{longitude:.9}""#)?;
        match route.stop_name(point) {
            Some(stop) => writeln!(out, "><name>{stop}</name></rtept>")?,
            None => writeln!(out, "/>")?,
        }
    }
    writeln!(out, "</rte>\n</gpx>")
}
