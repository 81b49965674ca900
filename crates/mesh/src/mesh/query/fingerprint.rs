use crate::geometry::LatticePoint;
use crate::mesh::kernel::Mesh;

/// A hash of a mesh's set of triangles, independent of their order and numbering.
///
/// Equal meshes have equal fingerprints. Different meshes have different ones unless the hashes collide. That
/// should be rare, but it is not proved, and nothing protects against a mesh that is made to collide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fingerprint(pub u128);

impl std::fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// Returns the fingerprint of a set of triangles given by their corners in lattice coordinates, in any order.
pub fn fingerprint_of(triangles: impl IntoIterator<Item = [LatticePoint; 3]>) -> Fingerprint {
    // A sum does not depend on the order of its terms.
    let sum = triangles.into_iter().fold(0u128, |sum, corners| sum.wrapping_add(hash_of_triangle(corners)));
    Fingerprint(sum)
}

fn hash_of_triangle(mut corners: [LatticePoint; 3]) -> u128 {
    corners.sort_unstable();
    let (mut low, mut high): (u64, u64) = (0x243f_6a88_85a3_08d3, 0x1319_8a2e_0370_7344); // digits of π
    for corner in corners {
        let word = u64::from(corner.x) << 32 | u64::from(corner.y);
        low = scrambled(low ^ word);
        high = scrambled(high.rotate_left(29) ^ word ^ low);
    }
    u128::from(high) << 64 | u128::from(low)
}

/// Returns the finaliser of SplitMix64: every bit of the input moves every bit of the output.
const fn scrambled(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Mesh {
    /// Returns the hash of the set of triangles of the domain, in lattice coordinates.
    pub fn fingerprint(&self) -> Fingerprint {
        fingerprint_of(self.triangles().map(|(id, _)| self.corners(id)))
    }
}
