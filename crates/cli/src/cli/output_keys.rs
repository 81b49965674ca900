//! The keys of `[[output]]` that say what is in a file, and which formats have a use for them.

use super::depths::DepthChanges;
use super::output::Output;
use super::quantities::{NamedQuantity, QuantityError, expression, parse_quantities};
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_io::io::{KeyFault, ThirdCoordinate};

/// Returns the quantities of an output: those of formulas, and then those of grids.
///
/// # Errors
/// Fails for the first value that cannot be used.
pub fn quantities_of(saved: &SavedOutput) -> Result<Vec<NamedQuantity>, KeyFault> {
    let mut quantities = parse_quantities(&saved.quantities).map_err(|(index, error)| {
        let fault = match &error {
            QuantityError::Formula(mistake) => {
                let text = &saved.quantities[index];
                KeyFault::mistake("quantities", text, text.len() - expression(text).len(), mistake)
            }
            _ => KeyFault::value("quantities", error.to_string()),
        };
        fault.at(index)
    })?;
    for (index, grid) in saved.grids.iter().enumerate() {
        let quantity = NamedQuantity::of_grid(grid, &quantities).map_err(|error| {
            let key = if matches!(error, QuantityError::File(_)) { "file" } else { "name" };
            KeyFault::value(key, error.to_string()).within(index).within("grids")
        });
        quantities.push(quantity?);
    }
    Ok(quantities)
}

/// Refuses keys that mean nothing for the format of an output.
///
/// # Errors
/// Fails for the first such key.
pub fn check_use(saved: &SavedOutput, output: &Output) -> Result<(), KeyFault> {
    let SavedOutput {
        file: _,
        binary,
        cells: _,
        quantities,
        grids,
        least_depth,
        depth_slope,
        flat,
        size,
        edges,
        dpi,
        colormap,
        color_by,
        light,
        ground,
        furniture,
        view,
        azimuth,
        altitude,
        exaggeration,
    } = saved;
    if *binary && !output.is_binary() {
        let sentence = "only .msh has a text form and a binary form; leave it out.";
        return Err(KeyFault::key("binary", sentence));
    }
    if *flat && output.third_coordinate() == ThirdCoordinate::None {
        let sentence = "the files of this format have no height of a surface; leave it out.";
        return Err(KeyFault::key("flat", sentence));
    }
    let of_nodes = [
        ("quantities", !quantities.is_empty()),
        ("grids", !grids.is_empty()),
        ("least_depth", least_depth.is_some()),
        ("depth_slope", depth_slope.is_some()),
    ];
    if let Some((key, _)) = of_nodes.iter().find(|(_, is_given)| *is_given && !output.wants_node_data()) {
        let sentence = "this format holds no values at the nodes; leave it out, or take another format.";
        return Err(KeyFault::key(*key, sentence));
    }
    let of_pictures = [
        ("size", size.is_some()),
        ("edges", edges.is_some()),
        ("colormap", colormap.is_some()),
        ("color_by", color_by.is_some()),
        ("dpi", dpi.is_some()),
        ("light", light.is_some()),
        ("ground", ground.is_some()),
        ("furniture", furniture.is_some()),
        ("view", view.is_some()),
        ("azimuth", azimuth.is_some()),
        ("altitude", altitude.is_some()),
        ("exaggeration", exaggeration.is_some()),
    ];
    match of_pictures.iter().find(|(_, is_given)| *is_given && !output.is_picture()) {
        Some(&(key, _)) => Err(KeyFault::key(key, "this is for pictures, .png and .svg; leave it out.")),
        None => Ok(()),
    }
}

/// Returns how the depths in the file of an output are changed.
///
/// # Errors
/// Fails for the first value that cannot be used.
pub fn depth_changes_of(saved: &SavedOutput) -> Result<DepthChanges, KeyFault> {
    let &SavedOutput { least_depth: least, depth_slope: slope, .. } = saved;
    if least.is_some_and(|least| !least.is_finite()) {
        return Err(KeyFault::value("least_depth", "a depth is a number of metres, as in 3."));
    }
    if slope.is_some_and(|slope| !(slope > 0.0 && slope < 1.0)) {
        return Err(KeyFault::value("depth_slope", "an r-factor is a number between 0 and 1, as in 0.2."));
    }
    Ok(DepthChanges { least, slope })
}
