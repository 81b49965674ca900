// The interface of the package: objects and typed arrays for the module `core.js`, which wasm-bindgen makes
// of `src`. `index.d.ts` describes everything that is exported.

import start, { Core } from "./core.js";

let loading;

/** Loads the module, once. */
export default function init(source) {
  return (loading ??= start(source === undefined ? undefined : { module_or_path: source }).then(
    () => undefined,
    (problem) => {
      loading = undefined;
      throw problem;
    },
  ));
}

const OPTIONS = [
  ...["name", "domain", "spacing", "hMin", "hMax", "hRisk", "shape", "gradation", "boundary", "boundaryDiameter", "parts"],
  ...["keepPinches", "improveBoundary", "rule", "maxTriangles", "maxLevel", "maxMemory", "size", "layers"],
];
/** Options that are about the domain and the layers, which have methods of their own. */
const NOT_UPDATED = ["name", "domain", "size", "layers"];
const COMMON = ["kind", "name", "visible", "locked", "combine", "mask"];
const RASTER = ["values", "width", "height", "bounds", "origin"];
const GROWTH = ["atZero", "slope", "range"];
const WIDTHS = ["across", "widthFrom", "widthTo"];
const KINDS = {
  formula: ["formula", "quantity"],
  raster: [...RASTER, "as", "curve"],
  band: [...RASTER, "between", "diameter"],
  depth: [...RASTER, "size", "positive", "offset", "depthFrom", "depthTo", "period", "triangles", "smoothing", "timeStep", "courant"],
  surface: [...RASTER, "formula", "within", "atMost", "norm"],
  threats: ["threats"],
  distance: ["to", "pieces", "types", ...GROWTH],
  corridor: ["along", "width", ...GROWTH],
  straits: WIDTHS,
  featureSize: WIDTHS,
  paint: ["quantity", "strokes"],
};
const BRUSH = [
  ...["points", "radius", "diameter", "risk", "error", "erase", "hardness", "strength", "change", "mirrorX", "mirrorY", "layer"],
];
/** The words for the numbers in `where`. */
export const PLACES = Object.freeze(["outside", "inside", "edge", "node", "invalid"]);

/** Looks for keys that nobody reads: most are typing mistakes. */
function checkKeys(object, known, what) {
  if (object === null || typeof object !== "object" || Array.isArray(object)) {
    throw new Error(`${what}: this must be an object, with some of the keys ${known.join(", ")}.`);
  }
  const unknown = Object.keys(object).find((key) => !known.includes(key));
  if (unknown !== undefined) {
    throw new Error(`${what}: there is no key ${unknown}; the keys are ${known.join(", ")}.`);
  }
}

const isNumbers = (value) =>
  (ArrayBuffer.isView(value) && !(value instanceof DataView) && typeof value[0] !== "bigint") ||
  (Array.isArray(value) && value.every((entry) => typeof entry === "number"));

/** Returns numbers as the module takes them. */
function numbers(value, key) {
  if (!isNumbers(value)) {
    throw new Error(`${key}: this must be an array of numbers.`);
  }
  return value instanceof Float64Array ? value : Float64Array.from(value);
}

const isPairs = (value) => Array.isArray(value) && value.every((entry) => isNumbers(entry) && entry.length === 2);

/** Returns x and y in turn: of an array of those, or of pairs. */
function points(value, key) {
  return isPairs(value) ? Float64Array.from(value.flatMap((pair) => [...pair])) : numbers(value, key);
}

/** Returns shapes of GeoJSON, of a list of points, or of several. `kind` says what arrays are. */
function shapes(value, key, kind) {
  const found = { points: [], lines: [], polygons: [], names: [] };
  if (value !== null && typeof value === "object" && typeof value.type === "string") {
    addGeoJson(value, found, "", key);
  } else {
    const lists = isNumbers(value) || isPairs(value) || !Array.isArray(value) ? [value] : value;
    const arrays = lists.map((list) => points(list, key));
    if (arrays.length === 0 || arrays.some((array) => array.length === 0)) {
      throw new Error(`${key}: these are no shapes, as there is no point among them.`);
    }
    if (kind === "polygon") {
      found.polygons.push(arrays);
    } else if (kind === "line") {
      found.lines.push(...arrays);
    } else {
      const odd = arrays.find((array) => array.length % 2 !== 0);
      if (odd !== undefined) {
        throw new Error(`${key}: points are x and y in turn, and these are ${odd.length} numbers: give two for each point.`);
      }
      arrays.forEach((array) => found.points.push(...array));
    }
  }
  return { ...found, points: Float64Array.from(found.points) };
}

function addGeoJson(object, found, name, key) {
  const positions = (list) => Float64Array.from(list.flatMap((at) => [at[0], at[1]]));
  const { type, coordinates } = object;
  try {
    switch (type) {
      case "FeatureCollection":
        return object.features.forEach((feature) => addGeoJson(feature, found, name, key));
      case "Feature":
        return object.geometry && addGeoJson(object.geometry, found, String(object.properties?.name ?? ""), key);
      case "GeometryCollection":
        return object.geometries.forEach((geometry) => addGeoJson(geometry, found, name, key));
      case "Point":
        return found.points.push(coordinates[0], coordinates[1]);
      case "MultiPoint":
        return found.points.push(...positions(coordinates));
      case "LineString":
        return found.lines.push(positions(coordinates));
      case "MultiLineString":
        return found.lines.push(...coordinates.map(positions));
      case "Polygon":
        return found.names.push(name), found.polygons.push(coordinates.map(positions));
      case "MultiPolygon":
        return coordinates.forEach((rings) => (found.names.push(name), found.polygons.push(rings.map(positions))));
    }
  } catch (problem) {
    if (!(problem instanceof TypeError)) {
      throw problem;
    }
    throw new Error(`${key}: the coordinates of the ${type} are not those of GeoJSON.`);
  }
  throw new Error(`${key}: GeoJSON has no type “${type}”.`);
}

function domain(value) {
  if (isNumbers(value) && value.length === 4 && !ArrayBuffer.isView(value)) {
    return { bounds: numbers(value, "domain") };
  }
  const isTable = value !== null && typeof value === "object" && !Array.isArray(value) && !ArrayBuffer.isView(value) && value.type === undefined;
  if (!isTable) {
    return { shapes: shapes(value, "domain", "polygon") };
  }
  checkKeys(value, ["bounds", "inside", "polygons"], "domain");
  const { bounds, inside, polygons } = value;
  return {
    bounds: bounds === undefined ? undefined : numbers(bounds, "bounds"),
    inside,
    shapes: polygons === undefined ? undefined : shapes(polygons, "polygons", "polygon"),
  };
}

/** Returns a layer as the module takes it. */
function layer(given) {
  const keys = KINDS[given?.kind];
  if (keys === undefined) {
    throw new Error(`kind: ${JSON.stringify(given?.kind)} is no kind of layer; write one of ${Object.keys(KINDS).join(", ")}.`);
  }
  checkKeys(given, [...COMMON, ...keys], `a layer of the kind ${given.kind}`);
  const made = { ...given };
  const change = (key, make) => (made[key] === undefined ? undefined : (made[key] = make(made[key], key)));
  ["values", "bounds", "between"].forEach((key) => change(key, numbers));
  change("formula", (formula) => (typeof formula === "number" ? String(formula) : formula));
  change("curve", points);
  change("mask", (mask) => shapes(mask, "mask", "polygon"));
  change("along", (along) => shapes(along, "along", "line"));
  change("to", (to) => (typeof to === "string" ? to : shapes(to, "to", "points")));
  return made;
}

/** Returns the layer of the option `size`: a formula, a number, or a raster of diameters. */
const layerOfSize = (size) =>
  typeof size === "object" ? { kind: "raster", as: "diameter", ...size } : { kind: "formula", formula: size };

function paint(core, stroke, number) {
  checkKeys(stroke, BRUSH, "a stroke");
  const { radius, diameter, risk, error, erase, hardness = 0.5, strength = 1, change = "finer", mirrorX = NaN, mirrorY = NaN } = stroke;
  const media = Object.entries({ diameter, risk, error, eraser: erase || undefined }).filter(([, value]) => value !== undefined);
  if (media.length !== 1) {
    throw new Error("A brush has one of diameter, risk, error and erase.");
  }
  const [[medium, value]] = media;
  core.paint(points(stroke.points, "points"), medium, Number(value), change, Number(radius), Number(hardness), Number(strength), [mirrorX, mirrorY], number);
}

/** A mesh, with the sizes that it is made of. It changes where it is when they change. */
export class Mesh {
  #core;
  #known = new Map();

  /** Makes a mesh. */
  static generate(options) {
    checkKeys(options, OPTIONS, "the options");
    if (loading === undefined) {
      throw new Error("The module is not loaded yet: await init() first.");
    }
    const core = new Core({ ...options, domain: domain(options.domain) });
    try {
      const size = options.size === undefined ? [] : [layerOfSize(options.size)];
      for (const given of [...size, ...(options.layers ?? [])]) {
        const number = core.addLayer(layer(given));
        (given.strokes ?? []).forEach((stroke) => paint(core, stroke, number));
      }
      core.forgetEdits();
      core.follow();
    } catch (problem) {
      core.free();
      throw problem;
    }
    const mesh = new Mesh();
    mesh.#core = core;
    return mesh;
  }

  /** Computes something of the mesh once. */
  #once(key, compute) {
    if (!this.#known.has(key)) {
      this.#known.set(key, compute());
    }
    return this.#known.get(key);
  }

  get nodes() {
    return this.#once("nodes", () => this.#core.nodes());
  }

  get triangles() {
    return this.#once("triangles", () => this.#core.triangles());
  }

  get levels() {
    return this.#once("levels", () => this.#core.levels());
  }

  get neighbours() {
    return this.#once("neighbours", () => this.#core.neighbours());
  }

  get h() {
    return this.#once("h", () => this.#core.h());
  }

  get boundary() {
    return this.#once("boundary", () => this.#core.boundary().map(([name, marker, edges]) => ({ name, marker, edges })));
  }

  get bounds() {
    return [...this.#core.bounds()];
  }

  get nodeCount() {
    return this.#core.nodeCount;
  }

  get triangleCount() {
    return this.#core.triangleCount;
  }

  get fingerprint() {
    return this.#once("fingerprint", () => this.#core.fingerprint());
  }

  get layers() {
    return this.#core.layers().map(([id, name, kind, visible, locked, combine]) => ({ id, name, kind, visible, locked, combine }));
  }

  violations() {
    return this.#core.violations();
  }

  locate(x, y) {
    const [triangles, weights, where] = this.#core.locate([Number(x), Number(y)]);
    return { triangle: triangles[0], weights: [...weights], where: PLACES[where[0]] };
  }

  locateAll(places) {
    const [triangles, weights, where] = this.#core.locate(points(places, "points"));
    return { triangles, weights, where };
  }

  interpolate(values, places) {
    const nodes = this.nodeCount;
    const atNodes = numbers(values, "values");
    const count = atNodes.length / nodes;
    if (!Number.isInteger(count) || count === 0) {
      throw new Error(`There are ${atNodes.length} values, and the mesh has ${nodes} nodes: give one, or as many for each.`);
    }
    const { triangles: found, weights } = this.locateAll(places);
    const corners = this.triangles;
    const result = new Float64Array(count * found.length).fill(NaN);
    found.forEach((triangle, point) => {
      for (let value = 0; triangle >= 0 && value < count; value++) {
        const part = (corner) => weights[3 * point + corner] * atNodes[count * corners[3 * triangle + corner] + value];
        result[count * point + value] = part(0) + part(1) + part(2);
      }
    });
    return result;
  }

  /** Edits the document and brings the mesh up to date. An edit that fails is undone. */
  #edit(act) {
    const [began, before] = [performance.now(), this.#core.triangleCount];
    this.#core.beginEdit();
    try {
      act(this.#core);
    } catch (problem) {
      this.#core.takeBack();
      throw problem;
    }
    this.#known.clear();
    const replaced = this.#core.follow();
    return { before, triangles: this.#core.triangleCount, replaced, seconds: (performance.now() - began) / 1000 };
  }

  update(options) {
    checkKeys(options, OPTIONS.filter((key) => !NOT_UPDATED.includes(key)), "the options");
    return this.#edit((core) => core.set(options));
  }

  paint(strokes) {
    const all = Array.isArray(strokes) ? strokes : [strokes];
    return this.#edit((core) => all.forEach((stroke) => paint(core, stroke, stroke?.layer === undefined ? undefined : this.#idOf(stroke.layer))));
  }

  addLayer(given) {
    return this.#edit((core) => {
      const number = core.addLayer(layer(given));
      (given.strokes ?? []).forEach((stroke) => paint(core, stroke, number));
    });
  }

  changeLayer(which, changes) {
    checkKeys(changes, ["name", "visible", "locked", "combine", "place"], "the changes");
    const { name, visible, locked, combine, place } = changes;
    const id = this.#idOf(which);
    return this.#edit((core) => {
      core.changeLayer(id, name, visible, locked, combine);
      if (place !== undefined) {
        core.moveLayer(id, place);
      }
    });
  }

  removeLayer(which) {
    const id = this.#idOf(which);
    return this.#edit((core) => core.removeLayer(id));
  }

  undo() {
    return this.#edit((core) => core.undo());
  }

  redo() {
    return this.#edit((core) => core.redo());
  }

  free() {
    this.#known.clear();
    this.#core.free();
  }

  /** Returns the number of a layer by its place, its name or itself. */
  #idOf(which) {
    const layers = this.layers;
    const found = typeof which === "number" ? layers[which] : layers.findLast((known) => known.name === which || known.id === which?.id);
    if (found === undefined) {
      const known = layers.map((known) => `“${known.name}”`).join(", ") || "none";
      throw new Error(`There is no layer ${JSON.stringify(which)}; there are ${known}.`);
    }
    return found.id;
  }
}
