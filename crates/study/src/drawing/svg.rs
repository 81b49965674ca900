//! A drawing as an SVG of paths alone: no fonts, and nothing that some programs do not draw.

use std::fmt;
use std::io::{self, Write};

use super::{Drawing, DrawingGroup, DrawnShape, OutlinePart};
use crate::text::xml_text;

impl Drawing {
    /// Writes an SVG.
    ///
    /// # Errors
    /// Fails with the errors of `out`.
    pub fn write_svg(&self, out: &mut impl Write) -> io::Result<()> {
        let [width, height] = self.size;
        let title = xml_text(&self.title);
        writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">"
        )?;
        let [r, g, b] = self.ground;
        writeln!(out, "<title>{title}</title>")?;
        writeln!(out, "<rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>")?;
        self.groups.iter().try_for_each(|group| write_group(out, group))?;
        writeln!(out, "</svg>")
    }
}

fn write_group(out: &mut impl Write, group: &DrawingGroup) -> io::Result<()> {
    writeln!(out, "<g id=\"{}\">", group.name)?;
    let mut texts = group.texts.iter().peekable();
    for (number, shape) in group.shapes.iter().enumerate() {
        if let Some((text, _)) = texts.peek().filter(|(_, shapes)| shapes.start == number) {
            writeln!(out, "<g role=\"img\" aria-label=\"{}\">", attribute(text))?;
        }
        write_shape(out, shape)?;
        if texts.next_if(|(_, shapes)| shapes.end == number + 1).is_some() {
            writeln!(out, "</g>")?;
        }
    }
    writeln!(out, "</g>")
}

fn write_shape(out: &mut impl Write, shape: &DrawnShape) -> io::Result<()> {
    write!(out, "<path d=\"{}\"", PathData(&shape.parts))?;
    write_color(out, "fill", shape.fill)?;
    // Also where there is none: some programs keep the line of the shape before.
    write_color(out, "stroke", shape.line.map(|(color, _)| color))?;
    if let Some((_, width)) = shape.line {
        write!(out, " stroke-width=\"{width:.2}\"")?;
    }
    writeln!(out, "/>")
}

fn write_color(out: &mut impl Write, name: &str, color: Option<[u8; 4]>) -> io::Result<()> {
    let Some([r, g, b, opacity]) = color else { return write!(out, " {name}=\"none\"") };
    write!(out, " {name}=\"#{r:02x}{g:02x}{b:02x}\"")?;
    if opacity < 0xff {
        write!(out, " {name}-opacity=\"{:.3}\"", f64::from(opacity) / 255.0)?;
    }
    Ok(())
}

fn attribute(text: &str) -> String {
    xml_text(text).replace('"', "&quot;")
}

/// An outline in the language of paths.
struct PathData<'a>(&'a [OutlinePart]);

impl fmt::Display for PathData<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for part in self.0 {
            let (letter, points) = part.letter_and_points();
            write!(f, "{letter}")?;
            for (number, [x, y]) in points.iter().enumerate() {
                let space = if number == 0 { "" } else { " " };
                write!(f, "{space}{x:.2} {y:.2}")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BoxLetters, TextStyle, Weight};
    use super::*;

    #[test]
    fn a_drawing_is_written_in_its_order_with_the_texts_for_readers() {
        let mut names = DrawingGroup::new("names");
        names.line(&[[0.0, 0.0], [5.0, 2.5]], [1, 2, 3, 51], 1.5);
        let halo = Some([0; 3]);
        let style = TextStyle { size: 10.0, weight: Weight::SemiBold, color: [0xff; 3], halo };
        names.text(&BoxLetters, "a < \"b\"", [10.0, 20.0], &style);
        names.polygon(&[[1.0, 1.0], [2.0, 1.0], [1.0, 2.0]], Some([4, 5, 6, 255]), None);
        let title = "Step 1 & 2".into();
        let drawing = Drawing { size: [200.0, 100.0], title, ground: [7, 8, 9], groups: vec![names] };
        let mut out = Vec::new();
        drawing.write_svg(&mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[1], "<title>Step 1 &amp; 2</title>");
        assert_eq!(lines[2], "<rect width=\"200\" height=\"100\" fill=\"#070809\"/>");
        assert_eq!(
            lines[4],
            "<path d=\"M0.00 0.00L5.00 2.50\" fill=\"none\" stroke=\"#010203\" stroke-opacity=\"0.200\" stroke-width=\"1.50\"/>"
        );
        assert_eq!(lines[5], "<g role=\"img\" aria-label=\"a &lt; &quot;b&quot;\">");
        assert!(lines[6].contains("fill=\"#000000\" stroke=\"#000000\""), "the halo: {}", lines[6]);
        assert!(
            lines[7].contains("fill=\"#ffffff\"") && lines[7].contains("stroke=\"none\""),
            "{}",
            lines[7]
        );
        assert_eq!(lines[8], "</g>");
        assert!(lines[9].contains("Z\" fill=\"#040506\" stroke=\"none\""), "{}", lines[9]);
        assert_eq!(text.matches("<g").count(), text.matches("</g>").count());
        assert!(!text.contains("paint-order") && !text.contains("<text"));
    }
}
