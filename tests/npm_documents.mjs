// Random documents for tests/npm.mjs: options of the package, and recipes with their files that say the same.

/** A generator of numbers from 0 to 1, the same at every run. */
export function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

const coast = [[0, 0], [4, 0.5], [5, 3], [2.5, 2], [1, 4], [0, 0]];
const hole = [[2, 1], [2.6, 1], [2.3, 1.4], [2, 1]];
const lagoon = [[6, 0], [7, 0], [7, 1], [6, 1], [6, 0]];

/** A source of choices. */
export class Choices {
  constructor(seed) {
    this.next = random(seed);
  }

  /** A number with three digits, so that the text of a recipe has it exactly. */
  number(least, most) {
    return Number((least + (most - least) * this.next()).toPrecision(3));
  }

  pick(list) {
    return list[Math.floor(this.next() * list.length)];
  }

  /** Whether something is so, with a probability. */
  is(share = 0.5) {
    return this.next() < share;
  }

  /** A value, or `undefined`. */
  maybe(value, share = 0.5) {
    return this.is(share) ? value() : (value(), undefined);
  }

  point() {
    return [this.number(0, 4), this.number(0, 3)];
  }

  points(least, most) {
    return Array.from({ length: least + Math.floor(this.next() * (most - least + 1)) }, () => this.point());
  }
}

/** Points as any of the types that the package takes. */
const anyPoints = (choices, list) => choices.pick([list, list.flat(), Float64Array.from(list.flat())]);

/** The key of a recipe for a key of the package. */
const keyOfRecipe = (key) => key.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);

const valueOfRecipe = (value) =>
  Array.isArray(value)
    ? `[${value.map(valueOfRecipe).join(", ")}]`
    : typeof value === "object"
      ? `{ ${Object.entries(value).map(([key, entry]) => `${keyOfRecipe(key)} = ${valueOfRecipe(entry)}`).join(", ")} }`
      : JSON.stringify(value);

/** Lines of a recipe for the keys that have a value. */
const lines = (table) =>
  Object.entries(table)
    .filter(([, value]) => value !== undefined)
    .map(([key, value]) => `${keyOfRecipe(key)} = ${valueOfRecipe(value)}\n`)
    .join("");

/** A rectangle with the corners of an axis-parallel box, as a ring. */
function box(choices) {
  const [x, y] = choices.point();
  const [width, height] = [choices.number(0.5, 2), choices.number(0.5, 2)];
  return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
}

/** Values by pixel: the keys of the package, and a file for a recipe. */
function raster(choices, { file, bounds: rectangle }, least, most) {
  const [columns, rows, cell] = choices.pick([[8, 6, 0.5], [4, 3, 1], [16, 12, 0.25]]);
  const covers = choices.is();
  const [x, y] = covers ? [0, 0] : [choices.pick([0, 0.5, 1]), choices.pick([0, 0.25])];
  const values = Array.from({ length: columns * rows }, () => (choices.is(0.1) ? NaN : Math.fround(choices.number(least, most))));
  const byRow = Array.from({ length: rows }, (_, row) => values.slice(columns * row, columns * (row + 1)));
  const origin = choices.pick([undefined, "upper", "lower"]);
  const given = (origin === "lower" ? byRow.toReversed() : byRow).flat();
  const text = byRow.map((row) => row.map((value) => (Number.isNaN(value) ? -9999 : value)).join(" ")).join("\n");
  const header = `ncols ${columns}\nnrows ${rows}\nxllcorner ${x}\nyllcorner ${y}\ncellsize ${cell}\nNODATA_value -9999\n`;
  // Without bounds it covers the rectangle of the domain.
  const bounds = covers && rectangle.join() === "0,0,4,3" && choices.is() ? undefined : [x, y, x + columns * cell, y + rows * cell];
  return {
    keys: { values: choices.pick([given, Float64Array.from(given), Float32Array.from(given)]), width: columns, height: rows, bounds, origin },
    files: { [file]: `${header}${text}\n` },
  };
}

/** Each kind of layer: the keys of the package, those of a recipe where they differ, and files. */
const KINDS = {
  formula(choices) {
    const quantity = choices.pick([undefined, "diameter", "risk"]);
    const [x, y] = choices.point();
    const formula =
      quantity === "risk" ? `0.9*exp(-(hypot(x - ${x}, y - ${y})))` : choices.pick([`${choices.number(0.1, 0.4)} + 0.1*hypot(x - ${x}, y - ${y})`, choices.number(0.2, 0.5)]);
    return { keys: { formula, quantity }, recipe: { formula: String(formula), quantity: quantity ?? "diameter" } };
  },
  raster(choices, place) {
    const as = choices.pick(["risk", "diameter", undefined]);
    const curve = as === undefined ? [[0, 0.1], [0.5, choices.number(0.1, 0.3)], [1, 0.6]] : undefined;
    const { keys, files } = raster(choices, place, as === "diameter" ? 0.1 : 0, as === "diameter" ? 0.8 : 1);
    return { keys: { ...keys, as, curve: curve && anyPoints(choices, curve) }, recipe: { file: place.file, as, curve }, files };
  },
  band(choices, place) {
    const { keys, files } = raster(choices, place, -50, 10);
    const own = { between: choices.pick([[-20, -10], [-30, 0], [-5, -5]]), diameter: choices.number(0.08, 0.3) };
    return { keys: { ...keys, ...own }, recipe: { file: place.file, ...own }, files };
  },
  depth(choices, place) {
    const { keys, files } = raster(choices, place, -50, 10);
    const size = choices.pick([undefined, "nothing", "wavelength", "slope", "courant"]);
    const own = {
      size,
      positive: choices.pick([undefined, "up", "down"]),
      offset: choices.maybe(() => choices.number(-5, 5)),
      depthFrom: choices.maybe(() => choices.number(0, 5)),
      depthTo: choices.maybe(() => choices.number(10, 40)),
      period: size === "wavelength" ? choices.number(0.1, 0.5) : undefined,
      triangles: size === "wavelength" ? choices.number(4, 10) : size === "slope" ? choices.number(2, 8) : undefined,
      smoothing: size === "slope" ? choices.pick([undefined, 0.6, 1.2]) : undefined,
      timeStep: size === "courant" ? choices.number(0.005, 0.01) : undefined,
      courant: size === "courant" ? choices.number(0.4, 0.9) : undefined,
    };
    return { keys: { ...keys, ...own }, recipe: { file: place.file, ...own }, files };
  },
  surface(choices, place) {
    const goal = choices.is(0.7) ? { within: choices.number(0.05, 0.2) } : { atMost: Math.round(choices.number(500, 2000)) };
    const norm = choices.pick([undefined, "max", "l2", "h1"]);
    if (choices.is()) {
      const formula = `sin(${choices.number(1, 3)}*x)*cos(${choices.number(1, 3)}*y)`;
      return { keys: { formula, norm, ...goal }, recipe: { formula, norm, ...goal } };
    }
    const { keys, files } = raster(choices, place, 0, 1);
    return { keys: { ...keys, norm, ...goal }, recipe: { file: place.file, norm, ...goal }, files };
  },
  threats(choices) {
    const threats = choices.points(1, 4).map(([x, y]) => {
      const [range, peak] = [choices.number(0.2, 1), choices.maybe(() => choices.number(0.2, 1))];
      const law = choices.pick([undefined, "radar", "gaussian", "disc"]);
      return { x, y, range, ...(peak === undefined ? {} : { peak }), ...(law === undefined ? {} : { law }) };
    });
    return { keys: { threats }, recipe: { threats } };
  },
  distance(choices) {
    const own = growth(choices);
    const word = choices.pick(["outline", "coasts", undefined, undefined]);
    if (word !== undefined) {
      return { keys: { to: word, ...own }, recipe: { to: word, ...own } };
    }
    const [points, line, ring] = [choices.points(1, 5), choices.points(2, 4), box(choices)];
    const shapes = points.map((point) => ({ point }));
    if (choices.is()) {
      return { keys: { to: anyPoints(choices, points), ...own }, recipe: { shapes, ...own } };
    }
    const closed = [...ring, ring[0]];
    const geometries = [
      ...choices.pick([[{ type: "MultiPoint", coordinates: points }], points.map((coordinates) => ({ type: "Point", coordinates }))]),
      choices.pick([{ type: "LineString", coordinates: line }, { type: "MultiLineString", coordinates: [line] }]),
      choices.pick([{ type: "Polygon", coordinates: [closed] }, { type: "MultiPolygon", coordinates: [[closed]] }]),
    ];
    const to = choices.pick([
      { type: "GeometryCollection", geometries },
      { type: "FeatureCollection", features: geometries.map((geometry) => ({ type: "Feature", properties: {}, geometry })) },
    ]);
    return { keys: { to, ...own }, recipe: { shapes: [...shapes, { line }, { polygon: [ring] }], ...own } };
  },
  pieces(choices) {
    const [own, pieces] = [growth(choices), choices.maybe(() => choices.pick([["bay"], ["lagoon"], ["bay", "lagoon"]]))];
    const types = pieces === undefined || choices.is(0.3) ? choices.pick([["land"], ["open", "land"]]) : undefined;
    return { kind: "distance", keys: { pieces, types, ...own }, recipe: { pieces, types, ...own } };
  },
  corridor(choices) {
    const [along, other, own] = [choices.points(2, 4), choices.points(2, 3), { width: choices.number(0.05, 0.3), ...growth(choices) }];
    const [given, ...all] = choices.pick([
      [along, along], [[along], along], [{ type: "LineString", coordinates: along }, along],
      [[along, other], along, other], [{ type: "MultiLineString", coordinates: [along, other] }, along, other],
    ]);
    return { keys: { along: given, ...own }, recipe: { shapes: all.map((line) => ({ line })), ...own } };
  },
  straits(choices) {
    const own = { across: choices.number(1, 4), widthFrom: choices.number(0.1, 0.2), widthTo: choices.number(0.5, 2) };
    return { keys: own, recipe: own };
  },
  featureSize(choices) {
    const own = { across: choices.number(1, 4), widthFrom: choices.number(0.1, 0.2), widthTo: choices.number(0.5, 2) };
    return { keys: own, recipe: own };
  },
};

const growth = (choices) => ({
  atZero: choices.number(0.06, 0.3),
  slope: choices.pick([0, 0.2, choices.number(0.1, 1)]),
  range: choices.maybe(() => choices.number(0.2, 2)),
});

/** Returns a random layer: the keys of the package, its table in a recipe, and files. */
export function randomLayer(choices, number, { kinds, bounds }) {
  const drawn = choices.pick(kinds);
  const { kind = drawn, keys, recipe, files } = KINDS[drawn](choices, { file: `values${number}.asc`, bounds });
  const ring = box(choices);
  const masked = choices.is(0.2);
  const common = {
    name: choices.maybe(() => `layer ${number}`),
    visible: choices.pick([undefined, undefined, undefined, true, false]),
    locked: choices.maybe(() => choices.is(), 0.2),
    combine: choices.pick([undefined, undefined, "finest", "floor", "replace"]),
  };
  const shape = choices.pick([ring, [ring], { type: "Polygon", coordinates: [ring] }]);
  return {
    layer: { kind, ...common, ...keys, ...(masked ? { mask: shape } : {}) },
    table: `[[layer]]\n${lines({ kind: kind.replace("featureSize", "feature-size"), ...common, ...recipe, ...(masked ? { mask: [[ring]] } : {}) })}`,
    files: files ?? {},
  };
}

/** Each way to say a domain: that of the package, the table of a recipe, files, and what only polygons have. */
const DOMAINS = {
  rectangle: () => ({ domain: [0, 0, 4, 3], bounds: [0, 0, 4, 3], table: "bounds = [0, 0, 4, 3]\n" }),
  formula: () => ({ domain: { bounds: [0, 0, 4, 3], inside: "hypot(x - 2, y - 1.5) < 1.6" }, bounds: [0, 0, 4, 3], table: 'bounds = [0, 0, 4, 3]\ninside = "hypot(x - 2, y - 1.5) < 1.6"\n' }),
  polygons(choices) {
    const feature = (name, rings) => ({ type: "Feature", properties: { name }, geometry: { type: "Polygon", coordinates: rings } });
    const collection = { type: "FeatureCollection", features: [feature("bay", [coast, hole]), feature("lagoon", [lagoon])] };
    const [files, bounds] = [{ "coast.geojson": JSON.stringify(collection) }, choices.maybe(() => [0, 0, 7, 3])];
    const table = `region = "coast.geojson"\n${lines({ bounds })}`;
    return { domain: bounds === undefined ? choices.pick([collection, { polygons: collection }]) : { bounds, polygons: collection }, bounds: bounds ?? [0, 0, 7, 4], table, files };
  },
};

/** Returns a random document. `kinds` are those of its layers. */
export function randomDocument(seed) {
  const choices = new Choices(seed);
  const place = choices.pick(["rectangle", "formula", "polygons", "polygons"]);
  const { domain, bounds, table, files = {} } = DOMAINS[place](choices);
  const hMin = choices.number(0.05, 0.08);
  const boundary = place === "polygons" ? choices.pick([undefined, "outline", "fitted", "report"]) : undefined;
  const ofDomain = {
    boundary,
    boundaryDiameter: place === "polygons" && boundary !== "report" ? choices.maybe(() => choices.number(0.1, 0.3)) : undefined,
    parts: choices.pick([undefined, "all", "largest", 0.05, 0.3]),
    keepPinches: choices.maybe(() => choices.is(), 0.3),
    improveBoundary: choices.maybe(() => choices.is(), 0.3),
  };
  const ofMesh = { spacing: choices.maybe(() => choices.number(0.4, 1)), rule: choices.pick([undefined, "area", "vertex"]), maxLevel: choices.maybe(() => Math.round(choices.number(0, 9)), 0.2) };
  const limits = {
    hMin,
    hRisk: choices.maybe(() => choices.number(0.08, 0.2)),
    hMax: choices.maybe(() => choices.number(0.5, 1)),
    shape: choices.maybe(() => choices.number(0.5, 3)),
    gradation: choices.maybe(() => choices.number(0.1, 0.5)),
  };
  const every = Object.keys(KINDS).filter((kind) => kind !== "pieces");
  const ofPlace = place === "formula" ? every.filter((kind) => !["distance", "straits", "featureSize"].includes(kind)) : place === "polygons" ? [...every, "pieces"] : every;
  const layers = Array.from({ length: 1 + Math.floor(choices.next() * 4) }, (_, number) => randomLayer(choices, number, { kinds: ofPlace, bounds }));
  return {
    bounds,
    options: { domain, ...ofDomain, ...ofMesh, ...limits, layers: layers.map(({ layer }) => layer) },
    recipe: `[domain]\nunit = "m"\n${table}${lines(ofDomain)}[mesh]\n${lines(ofMesh)}[limits]\n${lines(limits)}${layers.map((layer) => layer.table).join("")}`,
    files: Object.assign({}, files, ...layers.map((layer) => layer.files)),
  };
}
