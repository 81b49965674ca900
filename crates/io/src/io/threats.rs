//! Threats as a table with columns `x`, `y`, `range` and `peak`, and perhaps `law`.

use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;

use glam::DVec2;

use super::disk::File;
use super::error::PlacedFlaw;
use super::table::{Columns, Rows};
use super::{Flaw, Meter, Number, ReadError};
use meshbrush_core::earth::Projection;
use meshbrush_core::layers::{Threat, ThreatError, ThreatLaw};
use meshbrush_mesh::text::excerpt;

/// Names of the columns, in lower case; the last may be missing.
const NAMES: [&[&str]; 5] =
    [&["x", "lon", "lng", "long", "longitude"], &["y", "lat", "latitude"], &["range"], &["peak"], &["law"]];

/// Reads threats in the order of their rows. Places and ranges are in world units, peaks are risks from 0
/// to 1.
///
/// The header names the columns, in any order and case. `lon` and `lat` stand for `x` and `y`; in the plane
/// of a `projection` they are longitudes and latitudes in degrees. Other columns are ignored. Without a
/// header, a table of numbers has x, y, range and peak in this order. The law is `radar`, `gaussian` or
/// `disc`; without one it is `radar`. Numbers and separators are as in [`points::read`](super::points::read).
/// The meter counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, its header lacks a column, or a field is not valid, with the line and
/// the column; and when the work was cancelled.
pub fn read(path: &Path, projection: Option<Projection>, meter: &Meter) -> Result<Vec<Threat>, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from).and_then(|file| {
        meter.expect(file.length()?);
        parse(BufReader::new(meter.count(file)), projection)
    });
    read.map_err(|flaw| flaw.in_file(path))
}

/// Reads threats as [`read`] does, from any input, such as bytes. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_from(input: impl BufRead, name: &Path) -> Result<Vec<Threat>, ReadError> {
    parse(input, None).map_err(|flaw| flaw.in_file(name))
}

fn parse(source: impl BufRead, projection: Option<Projection>) -> Result<Vec<Threat>, PlacedFlaw> {
    let mut rows = Rows::new(source);
    let Columns { places, are_named } = rows.read_columns(NAMES, 4)?;
    let [Some(x), Some(y), Some(range), Some(peak), law] = places else {
        unreachable!("these columns are required");
    };
    let projection = projection.filter(|_| are_named && rows.is_longitude(x));
    let mut threats = Vec::new();
    while rows.advance()? {
        let at = DVec2::new(rows.number(x, "x")?, rows.number(y, "y")?);
        let at = projection.filter(|_| at.is_finite()).map_or(at, |plane| plane.plane_from_geographic(at));
        let (range, peak) = (rows.number(range, "range")?, rows.number(peak, "peak")?);
        let name = law.and_then(|law| rows.field(law)).filter(|name| !name.is_empty());
        let law =
            name.map_or(Ok(ThreatLaw::default()), |name| law_named(name).map_err(|flaw| flaw.at(rows.line)))?;
        let threat = Threat { at, range, peak, law };
        threat.check().map_err(|error| Flaw::Syntax(sentence(error)).at(rows.line))?;
        threats.push(threat);
    }
    Ok(threats)
}

fn law_named(name: &str) -> Result<ThreatLaw, Flaw> {
    let found = ThreatLaw::ALL.iter().find(|(_, known)| name.eq_ignore_ascii_case(known));
    found.map(|&(law, _)| law).ok_or_else(|| {
        let known = ThreatLaw::ALL.map(|(_, name)| name).join(", ");
        Flaw::Syntax(format!("law is `{}`, and the laws are {known}.", excerpt(40, name)))
    })
}

/// Returns the mistake in a row, with the name of the column.
fn sentence(error: ThreatError) -> String {
    match error {
        ThreatError::Place { x, y } => format!("x and y are {x} and {y}, and they must be finite numbers."),
        ThreatError::Range(range) => {
            format!(
                "range is {range}, and it must be a finite number above 0. To have no risk, set peak to 0."
            )
        }
        ThreatError::Peak(peak) => format!("peak is {peak}, and it must be a risk from 0 to 1."),
    }
}

/// Writes threats as [`read`] reads them, bit for bit.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut dyn Write, threats: &[Threat]) -> io::Result<()> {
    writeln!(out, "x,y,range,peak,law")?;
    for Threat { at, range, peak, law } in threats {
        let (x, y, range, peak) = (Number(at.x), Number(at.y), Number(*range), Number(*peak));
        writeln!(out, "{x},{y},{range},{peak},{}", law.name())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    fn parsed(text: &str) -> Result<Vec<Threat>, String> {
        parse(text.as_bytes(), None).map_err(|e| format!("{}: {}", e.place, e.flaw))
    }

    #[test]
    fn columns_may_be_in_any_order_and_the_law_may_be_missing() {
        let radar = Threat { at: dvec2(1.0, 2.0), range: 3.0, peak: 0.5, law: ThreatLaw::Radar };
        let disc = Threat { law: ThreatLaw::Disc, ..radar };
        for (text, expected) in [
            ("x,y,range,peak\n1,2,3,0.5\n", radar),
            ("Peak;name;LAW;range;y;x\n0,5;SA-6;Disc;3;2;1\n", disc),
            ("lon,lat,range,peak,law\n1,2,3,.5,\n", radar),
            ("x\ty\trange\tpeak\tlaw\r\n1\t2\t3\t0.5\tDISC", disc),
            ("x,y,range,peak,law\n1,2,3,0.5\n", radar),
        ] {
            assert_eq!(parsed(text), Ok(vec![expected]), "{text}");
        }
        assert_eq!(parsed("x,y,range,peak\n"), Ok(vec![]));
    }

    #[test]
    fn errors_name_line_and_column() {
        for (text, expected) in [
            ("", ": there is no header; the first line must name the columns x, y, range and peak."),
            (
                "x,y,range\n1,2,3\n",
                ", line 1: the header is `x,y,range`, and it must name the columns x, y, range and peak.",
            ),
            (
                "x,y,range,peak,Peak\n",
                ", line 1: the header has `peak` and `Peak`, each of which could be peak.",
            ),
            ("x,y,range,peak\n\n1,2,3\n", ", line 3: there is no peak."),
            ("x,y,range,peak\n1,2,far,1\n", ", line 2: range is `far`, which is not a number."),
            ("x,y,range,peak\n1,2,0,1\n", ", line 2: range is 0, and it must be"),
            ("x,y,range,peak\n1,2,3,80\n", ", line 2: peak is 80, and it must be a risk from 0 to 1."),
            ("x,y,range,peak\n1,2,3,nan\n", ", line 2: peak is NaN"),
            ("x,y,range,peak\n1,inf,3,1\n", ", line 2: x and y are 1 and inf"),
            (
                "x,y,range,peak,law\n1,2,3,1,sonar\n",
                ", line 2: law is `sonar`, and the laws are radar, gaussian, disc.",
            ),
        ] {
            let message = parsed(text).unwrap_err();
            assert!(message.starts_with(expected), "{text:?} gave {message}");
        }
    }

    #[test]
    fn what_is_written_is_read_bit_for_bit() {
        let mut random = fastrand::Rng::with_seed(61);
        let one = |_| Threat {
            at: 1e5 * dvec2(random.f64() - 0.5, random.f64()),
            range: 1e-3 + random.f64(),
            peak: random.f64(),
            law: ThreatLaw::ALL[random.usize(..3)].0,
        };
        let threats: Vec<Threat> = (0..100_000).map(one).collect();
        let mut file = Vec::new();
        write(&mut file, &threats).unwrap();
        assert_eq!(parse(&*file, None).unwrap(), threats);
    }
}
