//! `_thd.pli`: the lines of a document as thin dams of Delft3D-FM, beside its mesh.
//!
//! A file of polylines has blocks: the name, the number of points and of columns, and then x and y of each
//! point, those of the nodes of the mesh to the last digit. A line that is not on edges somewhere has several
//! blocks, with numbers in their names. No water flows across a thin dam. The solver reads the file where its
//! `.mdu` names it (`ThinDamFile`).

use std::io::{self, Write};

use super::MeshData;
use super::i2s::write_points;
use meshbrush_mesh::mesh::Extract;

/// Signs with which a line is a comment for readers of these files.
const COMMENT_SIGNS: [char; 2] = ['*', '#'];

/// Writes a block for each part of a line.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    for (number, line) in (1..).zip(data.lines) {
        let runs = line.runs();
        for (part, nodes) in (1..).zip(&runs) {
            let part = if runs.len() > 1 { format!(" ({part})") } else { String::new() };
            writeln!(out, "{}{part}", block_name(&line.name, number))?;
            writeln!(out, "{} 2", nodes.len())?;
            write_points(out, mesh, nodes)?;
        }
    }
    Ok(())
}

/// Returns a name that no reader takes for a comment or for numbers; `number` is that of the line.
fn block_name(name: &str, number: usize) -> String {
    let name = name.trim_start_matches(|c: char| COMMENT_SIGNS.contains(&c) || c.is_whitespace());
    match name.chars().next() {
        Some(first) if first.is_alphabetic() => name.to_owned(),
        Some(_) => format!("line {name}"),
        None => format!("line {number}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_neither_comments_nor_numbers() {
        let names = ["mole", "* mole", "3 4", "##", "", "Ärmelkanal"].map(|name| block_name(name, 7));
        assert_eq!(names, ["mole", "mole", "line 3 4", "line 7", "line 7", "Ärmelkanal"]);
    }
}
