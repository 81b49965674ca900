//! Colours for categories, which have no order.

/// The palette of Okabe and Ito without black: colour-blind people can tell these apart (M. Okabe and K. Ito,
/// “Color Universal Design”, 2008).
const PALETTE: [[u8; 3]; 7] = [
    [0x56, 0xb4, 0xe9],
    [0xe6, 0x9f, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xf0, 0xe4, 0x42],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x72, 0xb2],
];

/// Returns the colour of category `number`: the seven colours of the palette, then the same colours darker,
/// then lighter, and so on in turn.
pub fn category_color(number: u32) -> [u8; 3] {
    let count = PALETTE.len() as u32;
    let color = PALETTE[(number % count) as usize];
    match number / count % 3 {
        0 => color,
        1 => color.map(|channel| (f32::from(channel) * 0.6) as u8),
        _ => color.map(|channel| 255 - ((255.0 - f32::from(channel)) * 0.5) as u8),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_21_categories_have_different_colors() {
        let mut colors: Vec<_> = (0..21).map(category_color).collect();
        colors.sort_unstable();
        colors.dedup();
        assert_eq!(colors.len(), 21);
        assert_eq!(category_color(21), category_color(0));
    }
}
