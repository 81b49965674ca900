"""What files say about their values and their coordinates, against GDAL (rasterio and fiona), netCDF4 and PROJ.

Called by tests/run with the program to test: file_facts.py PROGRAM. Needs numpy, netCDF4, rasterio, fiona and pyproj (from PyPI).
Each fact is written in three files of each format that can have it. A cell of the table that is printed says what the program did
with them: "read", as the referee reads them; "said", where a sentence names the fact; "refused", with a sentence; "-", where the
format cannot have it.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import warnings

import fiona
import netCDF4
import numpy as np
import pyproj
import rasterio
from rasterio.transform import from_origin

warnings.simplefilter("ignore")

CELL, SIDE = 10.0, 6
FEET, SURVEY_FEET = 0.3048, 1200 / 3937
#: Sizes of units in metres, and how files name them.
UNITS = {"ft": FEET, "US survey foot": SURVEY_FEET, "cm": 0.01, "km": 1000.0, "fathom": 1.8288}


class Run:
    """What the program did with a command."""

    def __init__(self, program, *arguments, cwd=None):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=60)
        self.failed, self.out = done.returncode != 0, done.stdout
        self.sentences = " ".join(line for line in done.stderr.splitlines() if line.startswith("meshbrush:"))


def depths_of(program, grid, folder):
    """Depths at the centres of pixels as the program reads them, the top row first, and its sentences; None where refused."""
    out = folder / "o.14"
    low, high = CELL / 2, CELL * SIDE - CELL / 2
    run = Run(program, "mesh", "--domain", f"{low},{low},{high},{high}", "--spacing", CELL, "--depth", grid, "-o", out)
    if run.failed:
        return None, run.sentences
    lines = out.read_text().splitlines()
    count = int(lines[1].split()[1])
    depths = np.full((SIDE, SIDE), np.nan)
    for line in lines[2 : 2 + count]:
        x, y, depth = map(float, line.split()[1:4])
        column, row = round((x - low) / CELL), round((high - y) / CELL)
        depths[row, column] = depth
    return depths, run.sentences


def missing_of(program, grid, folder):
    """The number of pixels without a value."""
    run = Run(program, "mesh", "--domain", f"0,0,{CELL * SIDE},{CELL * SIDE}", "--spacing", CELL, "--surface", grid,
              "--max-error", 1e30, "--json")
    return None if run.failed else json.loads(run.out).get("missing_samples", 0)


def heights(kind):
    """Three grids of whole numbers around zero."""
    rows, columns = np.mgrid[0:SIDE, 0:SIDE]
    return [(7 * rows - 5 * columns - 40).astype(kind), (rows * columns - 60).astype(kind), (3 * rows - columns * columns).astype(kind)]


# Writers of rasters: a fact is a dictionary of what is to be said about the grid.


def write_tif(path, values, fact):
    options = dict(driver="GTiff", width=SIDE, height=SIDE, transform=from_origin(0, CELL * SIDE, CELL, CELL))
    options |= fact.get("layout", {})
    bands = [values] * fact.get("bands", 1)
    if fact.get("band"):
        bands = [np.zeros_like(values), values]
    with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=not fact.get("mask_beside")):
        with rasterio.open(path, "w", count=len(bands), dtype=values.dtype, crs=fact.get("crs"), nodata=fact.get("no_data"), **options) as file:
            for number, band in enumerate(bands, 1):
                file.write(band, number)
            if "scale" in fact:
                file.scales, file.offsets = (fact["scale"],) * len(bands), (fact["offset"],) * len(bands)
            if "unit" in fact:
                file.units = (fact["unit"],) * len(bands)
            if "mask" in fact:
                file.write_mask(np.where(fact["mask"], 0, 255).astype("uint8"))
    return f"{path}#2" if fact.get("band") else path


def write_nc(form):
    def write(path, values, fact):
        with netCDF4.Dataset(path, "w", format=form) as file:
            for name, centres in (("x", CELL / 2 + CELL * np.arange(SIDE)), ("y", CELL * SIDE - CELL / 2 - CELL * np.arange(SIDE))):
                file.createDimension(name, SIDE)
                axis = file.createVariable(name, "f8", (name,))
                axis.units, axis.axis = "m", name.upper()
                axis[:] = centres
            grid = file.createVariable("z", values.dtype, ("y", "x"), fill_value=fact.get("no_data", False))
            if "scale" in fact:
                grid.scale_factor, grid.add_offset = fact["scale"], fact["offset"]
            for name, text in (("units", fact.get("unit")), *fact.get("attributes", {}).items()):
                if text is not None:
                    grid.setncattr(name, text)
            grid.set_auto_maskandscale(False)
            grid[:] = values
        return path

    return write


def write_asc(path, values, fact):
    mark = "" if "no_data" not in fact else f"NODATA_value {fact.get('no_data_text', fact['no_data'])}\n"
    rows = "\n".join(" ".join(map(str, row)) for row in values.tolist())
    path.write_text(f"ncols {SIDE}\nnrows {SIDE}\nxllcorner 0\nyllcorner 0\ncellsize {CELL}\n{mark}{rows}\n")
    if "scale" in fact or "unit" in fact:
        scale = f"<Scale>{fact['scale']}</Scale><Offset>{fact['offset']}</Offset>" if "scale" in fact else ""
        unit = f"<UnitType>{fact['unit']}</UnitType>" if "unit" in fact else ""
        beside = path.with_name(path.name + ".aux.xml")
        beside.write_text(f'<PAMDataset><PAMRasterBand band="1">{unit}{scale}</PAMRasterBand></PAMDataset>')
    return path


def by_gdal(path, fact):
    """Values as GDAL reads them, NaN where it masks them."""
    name, _, band = str(path).partition("#")
    with rasterio.open(name) as file:
        number = int(band or 1)
        values = file.read(number, masked=True).astype(float)
        return (values * file.scales[number - 1] + file.offsets[number - 1]).filled(np.nan)


def by_netcdf(path, fact):
    with netCDF4.Dataset(path) as file:
        return np.ma.masked_array(file["z"][:]).astype(float).filled(np.nan)


FORMATS = {
    "GeoTIFF": (".tif", write_tif, by_gdal),
    "NetCDF classic": (".nc", write_nc("NETCDF3_CLASSIC"), by_netcdf),
    "NetCDF 4": (".nc", write_nc("NETCDF4"), by_netcdf),
    "ASC": (".asc", write_asc, by_gdal),
}
HOLES = np.zeros((SIDE, SIDE), bool)
HOLES[1, 2] = HOLES[4, 4] = True


def filled(kind, fill):
    grids = heights(kind)
    for grid in grids:
        grid[HOLES] = fill
    return grids


def facts_of_values():
    """Each fact: its name, three grids, what is said about them, formats, and what the values become."""
    grids, whole = heights("float32"), heights("int16")
    every, netcdf = list(FORMATS), ["NetCDF classic", "NetCDF 4"]
    same = lambda values: values
    yield "plain", grids, {}, every, same
    yield "scale and offset", whole, {"scale": 0.1, "offset": -5.0}, every, same
    tiles = {"tiled": True, "blockxsize": 16, "blockysize": 16, "compress": "deflate"}
    yield "scale in tiles", whole, {"scale": 0.5, "offset": 1.0, "layout": tiles}, ["GeoTIFF"], same
    for unit, metres in UNITS.items():
        yield f"unit {unit}", grids, {"unit": unit}, every, lambda values, metres=metres: values * metres
    yield "heights in US survey feet", grids, {"crs": "EPSG:26910+6360"}, ["GeoTIFF"], lambda values: values * SURVEY_FEET
    yield "depths, MSL depth", grids, {"crs": "EPSG:26910+5715"}, ["GeoTIFF"], lambda values: -values
    yield "positive down", grids, {"attributes": {"positive": "down"}}, netcdf, lambda values: -values
    yield "sea_floor_depth", grids, {"attributes": {"standard_name": "sea_floor_depth_below_geoid"}}, netcdf, lambda values: -values
    yield "declared fill", filled("int16", -99), {"no_data": -99}, every, same
    yield "packed valid_range", whole, {"scale": 0.1, "offset": 0.0, "attributes": {"valid_range": np.array([-45, -5], "i2")}}, netcdf, same
    yield "valid_min", whole, {"attributes": {"valid_min": np.int16(-45)}}, netcdf, same
    yield "missing_value", filled("float32", -77), {"attributes": {"missing_value": np.float32(-77)}}, netcdf, same
    last = {"no_data": float(np.float32(-3.4028235e38)), "no_data_text": "-3.40282346638528898e+38"}
    yield "fill in other digits", filled("float32", np.float32(-3.4028235e38)), last, ["ASC", "GeoTIFF"], same
    yield "mask inside", grids, {"mask": HOLES}, ["GeoTIFF"], same
    yield "mask inside, tiles", whole, {"mask": HOLES, "layout": tiles}, ["GeoTIFF"], same
    yield "mask beside", grids, {"mask": HOLES, "mask_beside": True}, ["GeoTIFF"], same
    yield "the second band", grids, {"band": True}, ["GeoTIFF"], same
    for fill in (3.4028235e38, 1e20, -32768):
        hole = lambda values: np.where(HOLES, np.nan, values)
        yield f"undeclared {fill:g}", filled("float32", fill), {}, every, hole


def compared(program, folder, path, expected):
    """"read", or "refused", for one file."""
    depths, sentences = depths_of(program, path, folder)
    assert depths is not None, f"{path}: {sentences}"
    # Beside pixels without a value the program fills them from neighbours.
    known = np.isfinite(expected)
    assert np.allclose(depths[known], -expected[known], atol=1e-4, rtol=1e-6), f"{path}:\n{depths}\n{-expected}\n{sentences}"
    missing = missing_of(program, path, folder)
    assert missing == int((~known).sum()), f"{path}: {missing} pixels have no value, and {(~known).sum()} are expected"


def check_values(program, folder, rows):
    for name, grids, fact, formats, meaning in facts_of_values():
        cells = {}
        for form in formats:
            ending, write, referee = FORMATS[form]
            for number, grid in enumerate(grids):
                path = write(folder / f"{re.sub('[^a-z0-9]', '-', name)}{form[-1]}{number}{ending}", grid, fact)
                compared(program, folder, path, meaning(referee(path, fact)))
            cells[form] = "read"
        rows[name] = cells


def check_pictures(program, folder, rows):
    """A picture in colours is refused as heights, unless a band is named."""
    values = heights("uint8")
    for number, grid in enumerate(values):
        colours = folder / f"colours{number}.tif"
        write_tif(colours, grid, {"bands": 3, "layout": {"photometric": "RGB"}})
        depths, sentences = depths_of(program, colours, folder)
        assert depths is None and "colours" in sentences, sentences
        depths, sentences = depths_of(program, f"{colours}#1", folder)
        assert depths is not None and np.allclose(depths, -grid.astype(float)), sentences
    rows["colours"] = {"GeoTIFF": "refused", "GeoTIFF#1": "read"}


SYSTEMS = [4258, 4283, 7844, 4490, 6668, 6318, 4230, 4277, 4301, 4806, 4807, 4312]
#: A place in each that differs from WGS 84, in degrees from Greenwich.
PLACES = {4230: (4, 50), 4277: (-4, 54), 4301: (138, 35), 4806: (12, 42), 4807: (2, 47), 4312: (15, 47)}
#: Systems that PROJ knows exactly only from Greenwich: its code from there, and the longitude of the own meridian.
FROM_GREENWICH = {4806: (4265, 12.4523333333)}


def square(code):
    """A square of a degree in a system, and its corners in longitudes and latitudes on WGS 84 by PROJ."""
    x, y = PLACES.get(code, (140, 36) if code == 6668 else (-100, 40) if code == 6318 else (145, -38) if code in (4283, 7844) else (10, 50))
    base, meridian = FROM_GREENWICH.get(code, (code, 0))
    from_wgs = pyproj.Transformer.from_crs(4326, base, always_xy=True)
    corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
    longitudes, latitudes = from_wgs.transform(*zip(*corners))
    own = [(float(x - meridian), float(y)) for x, y in zip(longitudes, latitudes)]
    return own, corners


def write_polygon(path, code, corners):
    system = pyproj.CRS.from_epsg(code)
    if path.suffix == ".geojson":
        ring = [list(corner) for corner in [*corners, corners[0]]]
        crs = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:EPSG::{code}"}}
        path.write_text(json.dumps({"type": "Polygon", "coordinates": [ring], "crs": crs}))
        return
    driver = {".shp": "ESRI Shapefile", ".gpkg": "GPKG"}[path.suffix]
    schema = {"geometry": "Polygon", "properties": {}}
    with fiona.open(path, "w", driver=driver, crs=f"EPSG:{code}", schema=schema) as file:
        file.write({"geometry": {"type": "Polygon", "coordinates": [[*corners, corners[0]]]}, "properties": {}})
    if path.suffix == ".shp":
        path.with_suffix(".prj").write_text(system.to_wkt("WKT1_ESRI"))


def check_systems(program, folder, rows):
    """Corners of a square in each geographic system are where PROJ has them, within 30 m."""
    globe = pyproj.Geod(ellps="WGS84")
    for code in SYSTEMS:
        own, expected = square(code)
        cells = {}
        for ending, form in ((".geojson", "GeoJSON"), (".shp", "shapefile"), (".gpkg", "GeoPackage")):
            path, out = folder / f"s{code}{ending}", folder / "s.14"
            write_polygon(path, code, own)
            run = Run(program, "mesh", "--region", path, "--projection", "merc", "--spacing", "20 km", "--out-crs", "lonlat", "-o", out)
            assert not run.failed, f"{path}: {run.sentences}"
            lines = out.read_text().splitlines()
            nodes = np.array([list(map(float, line.split()[1:3])) for line in lines[2 : 2 + int(lines[1].split()[1])]])
            for corner in expected:
                lengths = globe.inv(nodes[:, 0], nodes[:, 1], *[np.full(len(nodes), c, float) for c in corner])[2]
                assert lengths.min() < 30, f"EPSG:{code} in {form}: a corner is {lengths.min():.1f} m away. {run.sentences}"
            cells[form] = "read"
        rows[f"EPSG:{code}"] = cells


def check_longitudes(program, folder, rows):
    """Longitudes of a sea across 180° do not jump in any file, and those of a path neither."""
    box = lambda west, east: [[[west, -20], [east, -20], [east, -15], [west, -15], [west, -20]]]
    seas = {
        "cut at 180°": {"type": "MultiPolygon", "coordinates": [box(176, 180), box(-180, -178)]},
        "176 to 182": {"type": "Polygon", "coordinates": box(176, 182)},
        "−184 to −178": {"type": "Polygon", "coordinates": box(-184, -178)},
    }
    for number, (name, sea) in enumerate(seas.items()):
        region = folder / f"sea{number}.geojson"
        region.write_text(json.dumps(sea))
        common = ["--region", region, "--projection", "auto", "--crs", "lonlat", "--spacing", "150 km"]
        files = [folder / f"sea.{ending}" for ending in ("14", "ll", "2dm")]
        run = Run(program, "mesh", *common, *(word for file in files for word in ("-o", file)))
        assert not run.failed, run.sentences
        for file in files:
            lines = [line.split() for line in file.read_text().splitlines()]
            rows_of = {"2dm": [line[2:4] for line in lines if line and line[0] == "ND"]}
            count = int(lines[1][1]) if file.suffix != ".2dm" else 0
            longitudes = np.array([float(line[0]) for line in rows_of.get(file.suffix[1:], [line[1:3] for line in lines[2 : 2 + count]])])
            assert longitudes.size and np.ptp(longitudes) < 7, f"{file}: {longitudes.min()} to {longitudes.max()}"
        path = folder / "path.geojson"
        run = Run(program, "path", *common, "--from", "177°,-17°", "--to", "-178.5°,-18°", "-o", path)
        assert not run.failed, run.sentences
        points = np.array(json.loads(path.read_text())["geometry"]["coordinates"])
        assert np.ptp(points[:, 0]) < 7 and abs(points[0, 0] % 360 - 177) < 1e-6 and abs(points[-1, 1] + 18) < 1e-6, points
        rows[f"longitudes {name}"] = {"GeoJSON": "read"}


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        for check in (check_values, check_pictures, check_systems, check_longitudes):
            check(program, pathlib.Path(folder), rows)
    columns = [*FORMATS, "GeoTIFF#1", "GeoJSON", "shapefile", "GeoPackage"]
    print(f"{'':27}" + "".join(f"{column:16}" for column in columns))
    for name, cells in rows.items():
        print(f"{name:27}" + "".join(f"{cells.get(column, '-'):16}" for column in columns).rstrip())
    print(f"{sum(map(len, rows.values()))} facts of files are read as their referees read them, or refused with a sentence")


if __name__ == "__main__":
    main()
