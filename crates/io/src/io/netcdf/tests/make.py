"""Makes the NetCDF-4 files of the tests: pip install netCDF4 h5py, then python make.py in this folder.

Each has `elevation` over `lat` (50.25 to 53.25) and `lon` (4.25 to 8.25) in steps of 0.5: row * 9 + column.
"""
import h5py
import netCDF4
import numpy as np

ROWS, COLUMNS = 7, 9
LAT, LON = np.arange(ROWS) * 0.5 + 50.25, np.arange(COLUMNS) * 0.5 + 4.25
VALUES = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)


def netcdf(name, attributes=0, unlimited=(), kind="i2", scale=None, is_north_up=False, **options):
    with netCDF4.Dataset(name, "w", format="NETCDF4") as file:
        order = slice(None, None, -1) if is_north_up else slice(None)
        for side, values, unit in (("lat", LAT[order], "degrees_north"), ("lon", LON, "degrees_east")):
            file.createDimension(side, None if side in unlimited else len(values))
            variable = file.createVariable(side, "f8", (side,))
            variable.units = unit
            variable[:] = values
        variable = file.createVariable("elevation", kind, ("lat", "lon"), **options)
        for number in range(attributes):
            variable.setncattr(f"attribute_{number}", f"text {number}")
        if scale:
            variable.scale_factor, variable.add_offset = scale
        variable[:] = np.ma.masked_equal(VALUES[order], 20)


def hdf5(name, maxshape=None, **options):
    with h5py.File(name, "w", libver="latest") as file:
        lat, lon = file.create_dataset("lat", data=LAT), file.create_dataset("lon", data=LON)
        lat.make_scale("lat")
        lon.make_scale("lon")
        values = VALUES.astype(">f4")
        values[VALUES == 20] = np.nan
        grid = file.create_dataset("elevation", data=values, maxshape=maxshape, **options)
        grid.dims[0].attach_scale(lat)
        grid.dims[1].attach_scale(lon)


netcdf("contiguous.nc", kind="f8", fill_value=-9999.0)
netcdf("packed.nc", scale=(0.5, -10.0), is_north_up=True, zlib=True, fletcher32=True, chunksizes=(4, 5), fill_value=-32768)
netcdf("attributes.nc", attributes=12, zlib=True, chunksizes=(2, 4))
netcdf("unlimited.nc", unlimited=("lat",), kind="f4", zlib=True, chunksizes=(3, 9))
hdf5("fixed_array.nc", chunks=(2, 2), compression=4)
hdf5("extensible_array.nc", (None, COLUMNS), chunks=(2, 2))
hdf5("tree.nc", (None, None), chunks=(3, 4), compression=4, shuffle=True)
hdf5("one_chunk.nc", chunks=(ROWS, COLUMNS), compression=4)
