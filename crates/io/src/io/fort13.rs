//! `fort.13`: the nodal attributes of ADCIRC, beside its mesh.
//!
//! Each quantity but the depth and the surface is an attribute with one value for each node: Manning's n, the
//! quantity `manning`, is `mannings_n_at_sea_floor`, and others have their own names, which can be those of
//! ADCIRC. The title is that of the mesh. After the number of nodes and of attributes, each attribute has its
//! name, its unit (`1`: none), the number of its values at a node, and the default value: the most common
//! one, or the least of equally common ones. Then each attribute has its name again, the number of nodes with
//! another value, and these nodes with their values. ADCIRC takes the attributes that its `fort.15` names.
//! Nodes are those of its mesh, with those that weirs add.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Write};

use super::weirs::WeirCracks;
use super::{MeshData, NodeValues, Number};
use meshbrush_mesh::mesh::Extract;

/// The names of quantities that ADCIRC calls otherwise.
const NAMES: [(&str, &str); 1] = [("manning", "mannings_n_at_sea_floor")];

/// Writes the attributes.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let cracks = WeirCracks::new(mesh, data);
    let attributes: Vec<Attribute> =
        data.attributes().map(|values| Attribute::new(values, &cracks)).collect();
    writeln!(out, "{}", data.provenance.line())?;
    writeln!(out, "{}\n{}", cracks.node_count(), attributes.len())?;
    for Attribute { name, default, .. } in &attributes {
        writeln!(out, "{name}\n1\n1\n{}", Number(*default))?;
    }
    for Attribute { name, default, values } in &attributes {
        let others = || values.iter().enumerate().filter(|(_, value)| *value != default);
        writeln!(out, "{name}\n{}", others().count())?;
        for (node, &value) in others() {
            writeln!(out, "{} {}", node + 1, Number(value))?;
        }
    }
    Ok(())
}

/// A quantity as ADCIRC has it.
struct Attribute<'a> {
    name: &'a str,
    default: f64,
    values: Cow<'a, [f64]>,
}

impl<'a> Attribute<'a> {
    fn new(NodeValues { name, values }: &'a NodeValues, cracks: &WeirCracks<'_>) -> Self {
        let known = NAMES.iter().find(|(own, _)| own == name).map(|(_, known)| *known);
        let values = cracks.values(values);
        Self { name: known.unwrap_or(name), default: most_common(&values), values }
    }
}

/// Returns the value that most nodes have; of several the least.
fn most_common(values: &[f64]) -> f64 {
    let mut counts: BTreeMap<u64, usize> = BTreeMap::new();
    // Both zeros are one value.
    values.iter().for_each(|value| *counts.entry((value + 0.0).to_bits()).or_default() += 1);
    let counted = counts.into_iter().map(|(bits, count)| (f64::from_bits(bits), count));
    let best = counted.reduce(|a, b| match b.1.cmp(&a.1).then(a.0.total_cmp(&b.0)) {
        std::cmp::Ordering::Greater => b,
        _ => a,
    });
    best.map_or(0.0, |(value, _)| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_the_most_common_value_and_of_several_the_least() {
        assert_eq!(most_common(&[0.02, 0.1, 0.1, 0.02, 0.1]), 0.1);
        assert_eq!(most_common(&[0.1, 0.02, -1.0, 0.02, 0.1]), 0.02);
        assert_eq!(most_common(&[]), 0.0);
    }
}
