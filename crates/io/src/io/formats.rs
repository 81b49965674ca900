//! All formats. A new one is a module and an entry here.

use super::format_spec::{FormatSpec, RasterFormatSpec, ShapeFormatSpec};
use super::{
    asc, csv, disv, fort14, fvcom, geojson, geotiff, glb, gpkg, gr3, mike, msh, msh22, netcdf, node, npy,
    obj, ply, png, selafin, shp, sms, stl, ugrid, vtu, ww3,
};

/// The formats of meshes.
pub static MESH_FORMATS: [&FormatSpec; 19] = [
    &vtu::FORMAT,
    &msh::FORMAT,
    &msh22::FORMAT,
    &obj::FORMAT,
    &stl::FORMAT,
    &ply::FORMAT,
    &glb::FORMAT,
    &node::FORMAT,
    &sms::FORMAT,
    &csv::FORMAT,
    &fort14::FORMAT,
    &gr3::FORMAT,
    &gr3::FORMAT_IN_DEGREES,
    &ugrid::FORMAT,
    &selafin::FORMAT,
    &mike::FORMAT,
    &ww3::FORMAT,
    &fvcom::FORMAT,
    &disv::FORMAT,
];

/// The formats of rasters.
pub static RASTER_FORMATS: [&RasterFormatSpec; 5] =
    [&png::RASTER, &asc::RASTER, &geotiff::RASTER, &netcdf::RASTER, &npy::RASTER];

/// The formats of shapes.
pub static SHAPE_FORMATS: [&ShapeFormatSpec; 3] = [&geojson::FORMAT, &shp::FORMAT, &gpkg::FORMAT];
