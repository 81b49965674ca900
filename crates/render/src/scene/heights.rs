//! Heights of nodes as whole numbers: a third coordinate on the lattice.

/// A node without a height. Triangles at it are not drawn in space.
pub const NO_HEIGHT: u32 = u32::MAX;

/// The highest height, in steps.
const HIGHEST: f64 = (1u32 << 30) as f64;

/// Heights as numbers of steps above the lowest one.
///
/// Steps have 30 bits, as the coordinates of nodes do: the difference of two of them fits an `i32` and is
/// exact, so that a picture from nearby is as sharp as one of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightScale {
    lowest: f64,
    step: f64,
}

/// Heights at the nodes of a mesh, and at those of the pieces in place of some of its triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeHeights {
    /// The meaning of the steps.
    pub scale: HeightScale,
    /// For each node of the mesh its height in steps, or [`NO_HEIGHT`].
    pub mesh: Vec<u32>,
    /// The same for each node of the pieces.
    pub pieces: Vec<u32>,
}

impl HeightScale {
    /// Returns the scale of heights between two.
    pub fn between(lowest: f64, highest: f64) -> Self {
        let range = highest - lowest;
        Self { lowest, step: if range > 0.0 { range / HIGHEST } else { 1.0 } }
    }

    /// Returns the lowest height.
    pub fn lowest(&self) -> f64 {
        self.lowest
    }

    /// Returns the length of a step.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Returns a height in steps, to the nearest whole one.
    pub fn steps(&self, height: Option<f64>) -> u32 {
        let steps = height.map(|height| ((height - self.lowest) / self.step).round());
        steps.filter(|steps| !steps.is_nan()).map_or(NO_HEIGHT, |steps| steps.clamp(0.0, HIGHEST) as u32)
    }

    /// Returns the height of `steps` steps.
    pub fn height(&self, steps: f64) -> f64 {
        self.lowest + self.step * steps
    }
}

impl NodeHeights {
    /// Returns heights at the nodes of a mesh and of its pieces; `None` where no node has a height.
    pub fn new(mesh: &[Option<f64>], pieces: &[Option<f64>]) -> Option<Self> {
        let known = mesh.iter().chain(pieces).flatten().filter(|height| height.is_finite());
        let ends = known.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &height| {
            [low.min(height), high.max(height)]
        });
        if ends[0] > ends[1] {
            return None;
        }
        let scale = HeightScale::between(ends[0], ends[1]);
        let in_steps = |heights: &[Option<f64>]| heights.iter().map(|&height| scale.steps(height)).collect();
        Some(Self { scale, mesh: in_steps(mesh), pieces: in_steps(pieces) })
    }

    /// Returns the lowest and the highest height of all nodes, in steps.
    pub fn ends(&self) -> [u32; 2] {
        let known = self.mesh.iter().chain(&self.pieces).filter(|&&steps| steps != NO_HEIGHT);
        known.fold([u32::MAX, 0], |[low, high], &steps| [low.min(steps), high.max(steps)])
    }

    /// Returns the difference of the highest and the lowest height.
    pub fn relief(&self) -> f64 {
        let [low, high] = self.ends();
        self.scale.step() * f64::from(high.saturating_sub(low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_are_exact_to_a_billionth_of_the_relief() {
        let heights = [Some(-350.25), None, Some(1200.5), Some(17.0 / 3.0), Some(f64::NAN)];
        let found = NodeHeights::new(&heights, &[Some(1.0)]).unwrap();
        assert_eq!(found.ends(), [0, 1 << 30]);
        assert_eq!((found.scale.lowest(), found.scale.steps(Some(-350.25))), (-350.25, 0));
        assert_eq!((found.mesh[1], found.mesh[4]), (NO_HEIGHT, NO_HEIGHT));
        assert!((found.relief() - 1550.75).abs() < 1e-9);
        for (height, steps) in heights.iter().zip(&found.mesh).filter(|(_, steps)| **steps != NO_HEIGHT) {
            assert!((found.scale.height(f64::from(*steps)) - height.unwrap()).abs() < 1e-6);
        }
    }

    #[test]
    fn a_plain_has_one_height_and_nothing_has_none() {
        let plain = NodeHeights::new(&[Some(3.0), Some(3.0)], &[]).unwrap();
        assert_eq!((plain.mesh.as_slice(), plain.relief(), plain.scale.height(0.0)), (&[0, 0][..], 0.0, 3.0));
        assert_eq!(NodeHeights::new(&[None], &[]), None);
    }
}
