// Checks the package for JavaScript in Node.js: node tests/npm.mjs FOLDER PROGRAM SCRATCH
// FOLDER has the package, PROGRAM is the desktop program, SCRATCH is a folder for files.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

import { Choices, random, randomDocument, randomLayer } from "./npm_documents.mjs";

const [folder, program, scratch] = process.argv.slice(2).map((name) => path.resolve(name));
const { default: init, Mesh, PLACES } = await import(pathToFileURL(path.join(folder, "node.js")));
assert.throws(() => Mesh.generate({ domain: [0, 0, 1, 1] }), /await init\(\) first/);
// A module that cannot be loaded is no obstacle to the next one.
await assert.rejects(() => init(Uint8Array.of(1, 2, 3)), WebAssembly.CompileError);
await init();

/** Returns the fingerprint and the number of triangles that the program finds for a recipe. */
function byProgram(recipe, files = {}) {
  for (const [name, content] of Object.entries({ "input.toml": recipe, ...files })) {
    fs.writeFileSync(path.join(scratch, name), content);
  }
  const answer = execFileSync(program, ["mesh", path.join(scratch, "input.toml"), "--json"], { encoding: "utf8", maxBuffer: 1 << 26, stdio: "pipe" });
  return JSON.parse(answer);
}

const coast = [[0, 0], [4, 0.5], [5, 3], [2.5, 2], [1, 4], [0, 0]];
const hole = [[2, 1], [2.6, 1], [2.3, 1.4], [2, 1]];
const coastFile = JSON.stringify({ type: "Polygon", coordinates: [coast, hole] });
const asc = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n0.5 0.05 0.3\n0.2 -9 0.1\n";
const square = "[domain]\nbounds = [0, 0, 1, 1]\n[mesh]\nspacing = 0.25\n";

/** Inputs for the package, and recipes with their files that say the same. */
const inputs = {
  "a formula": [
    { domain: [0, 0, 1, 1], spacing: 0.25, hMin: 0.004, size: "0.01 + 0.2*hypot(x - 0.3, y - 0.4)" },
    `${square}[limits]\nh_min = 0.004\n[[layer]]\nkind = "formula"\nquantity = "diameter"\nformula = "0.01 + 0.2*hypot(x - 0.3, y - 0.4)"\n`,
  ],
  "no options": [
    { domain: [0, 0, 3, 1], size: 0.05 },
    `[domain]\nbounds = [0, 0, 3, 1]\n[[layer]]\nkind = "formula"\nquantity = "diameter"\nformula = "0.05"\n`,
  ],
  "polygons with gradation": [
    {
      domain: [coast, hole], spacing: 1, hMin: 0.02, gradation: 0.3, boundaryDiameter: 0.2,
      layers: [{ kind: "distance", to: Float64Array.of(1, 1, 4, 1.5), atZero: 0.03, slope: 0.5, range: 2 }, { kind: "distance", to: "outline", atZero: 0.1, slope: 1 }],
    },
    `[domain]\nregion = "coast.geojson"\nunit = "none"\nboundary_diameter = 0.2\n[mesh]\nspacing = 1\n[limits]\nh_min = 0.02\ngradation = 0.3
[[layer]]\nkind = "distance"\nshapes = [{ point = [1, 1] }, { point = [4, 1.5] }]\nat_zero = 0.03\nslope = 0.5\nrange = 2
[[layer]]\nkind = "distance"\nto = "outline"\nat_zero = 0.1\nslope = 1\n`,
    { "coast.geojson": coastFile },
  ],
  "a raster, a floor and a mask": [
    {
      domain: { bounds: [0, 0, 3, 2] }, spacing: 0.5, hMin: 0.01,
      layers: [
        { kind: "raster", values: Float32Array.of(0.5, 0.05, 0.3, 0.2, NaN, 0.1), width: 3, height: 2, bounds: [0, 0, 3, 2], as: "diameter" },
        { kind: "formula", formula: "0.15", combine: "floor", mask: [[1.2, 0.5], [2.5, 0.5], [2, 1.8]] },
      ],
    },
    `[domain]\nbounds = [0, 0, 3, 2]\n[mesh]\nspacing = 0.5\n[limits]\nh_min = 0.01\n[[layer]]\nkind = "raster"\nfile = "sizes.asc"\nas = "diameter"
[[layer]]\nkind = "formula"\nquantity = "diameter"\nformula = "0.15"\ncombine = "floor"\nmask = [[[[1.2, 0.5], [2.5, 0.5], [2, 1.8]]]]\n`,
    { "sizes.asc": asc },
  ],
  "threats, the vertex rule and a formula for the domain": [
    {
      domain: { bounds: [-1, -1, 1, 1], inside: "r < 0.9" }, spacing: 0.2, hMin: 0.01, hMax: 0.3, rule: "vertex", shape: 2,
      layers: [{ kind: "threats", threats: [{ x: 0.2, y: 0.1, range: 0.5, peak: 0.8, law: "gaussian" }, { x: -0.4, y: 0, range: 0.3 }] }],
    },
    `[domain]\nbounds = [-1, -1, 1, 1]\ninside = "r < 0.9"\n[mesh]\nspacing = 0.2\nrule = "vertex"\n[limits]\nh_min = 0.01\nh_max = 0.3\nshape = 2
[[layer]]\nkind = "threats"\nthreats = [{ x = 0.2, y = 0.1, range = 0.5, peak = 0.8, law = "gaussian" }, { x = -0.4, y = 0, range = 0.3 }]\n`,
  ],
  "a corridor, a replacement and a deepest level": [
    {
      domain: [0, 0, 1, 1], spacing: 0.25, hMin: 0.01, maxLevel: 9,
      layers: [{ kind: "corridor", along: [[[0.1, 0.1], [0.5, 0.8], [0.9, 0.2]], [[0.05, 0.7], [0.2, 0.95]]], width: 0.1, atZero: 0.02, slope: 0.4 }, { kind: "formula", formula: "if(x < 0.3, 0.1, inf)", combine: "replace" }],
    },
    `${square}max_level = 9\n[limits]\nh_min = 0.01
[[layer]]\nkind = "corridor"\nshapes = [{ line = [[0.1, 0.1], [0.5, 0.8], [0.9, 0.2]] }, { line = [[0.05, 0.7], [0.2, 0.95]] }]\nwidth = 0.1\nat_zero = 0.02\nslope = 0.4
[[layer]]\nkind = "formula"\nquantity = "diameter"\nformula = "if(x < 0.3, 0.1, inf)"\ncombine = "replace"\n`,
  ],
  "a formula of the depth": [
    {
      domain: [0, 0, 3, 2], spacing: 0.5, hMin: 0.02,
      layers: [{ kind: "depth", values: [-5, -20, 3, -9, NaN, -40], width: 3, height: 2 }, { kind: "formula", formula: "0.05 + depth/100" }],
    },
    `[domain]\nbounds = [0, 0, 3, 2]\nunit = "m"\n[mesh]\nspacing = 0.5\n[limits]\nh_min = 0.02\n[[layer]]\nkind = "depth"\nfile = "depths.asc"
[[layer]]\nkind = "formula"\nquantity = "diameter"\nformula = "0.05 + depth/100"\n`,
    { "depths.asc": "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -99\n-5 -20 3\n-9 -99 -40\n" },
  ],
  "straits, feature size and a surface": [
    {
      domain: { polygons: { type: "Feature", properties: { name: "bay" }, geometry: JSON.parse(coastFile) } }, spacing: 1, hMin: 0.05,
      layers: [
        { kind: "straits", across: 4, widthFrom: 0.1, widthTo: 1.5 }, { kind: "featureSize", across: 3, widthFrom: 0.1, widthTo: 3 },
        { kind: "surface", formula: "sin(3*x)*cos(2*y)", within: 0.05 },
      ],
    },
    `[domain]\nregion = "coast.geojson"\nunit = "none"\n[mesh]\nspacing = 1\n[limits]\nh_min = 0.05\n[[layer]]\nkind = "straits"\nacross = 4\nwidth_from = 0.1\nwidth_to = 1.5
[[layer]]\nkind = "feature-size"\nacross = 3\nwidth_from = 0.1\nwidth_to = 3\n[[layer]]\nkind = "surface"\nformula = "sin(3*x)*cos(2*y)"\nwithin = 0.05\n`,
    { "coast.geojson": coastFile },
  ],
};

const painted = { domain: [0, 0, 1, 1], spacing: 0.25, hMin: 0.005, gradation: 0.3, size: 0.2 };
const strokes = [
  { points: [[0.2, 0.2], [0.5, 0.7], [0.8, 0.3]], radius: 0.06, diameter: 0.012 },
  { points: Float64Array.of(0.7, 0.8), radius: 0.1, diameter: 0.02, hardness: 1 },
];

/** Returns the signed areas of a point and each side of a triangle, by the sides. */
function areas(nodes, corners, x, y) {
  const [a, b, c] = corners.map((node) => [nodes[2 * node], nodes[2 * node + 1]]);
  const area = (p, q) => (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
  return [area(b, c), area(c, a), area(a, b)];
}

const tests = {
  "meshes are those of the program"() {
    for (const [name, [options, recipe, files]] of Object.entries(inputs)) {
      const mesh = Mesh.generate(options);
      const expected = byProgram(recipe, files);
      assert.equal(mesh.fingerprint, expected.hash, name);
      assert.deepEqual([mesh.triangleCount, mesh.nodeCount], [expected.triangles, expected.nodes ?? expected.vertices], name);
      assert.equal(mesh.violations(), 0, name);
      console.log(`    ${name}: ${mesh.triangleCount} triangles`);
      mesh.free();
    }
  },

  "random documents are those of the program"() {
    let failed = 0;
    for (let seed = 0; seed < 50; seed++) {
      const { options, recipe, files } = randomDocument(seed);
      let expected;
      try {
        expected = byProgram(recipe, files);
      } catch (problem) {
        assert.throws(() => Mesh.generate(options), `${seed}: ${problem}`);
        failed++;
        continue;
      }
      const mesh = Mesh.generate(options);
      assert.equal(mesh.fingerprint, expected.hash, `${seed}: ${recipe}`);
      assert.deepEqual([mesh.triangleCount, mesh.nodeCount, mesh.violations()], [expected.triangles, expected.nodes, 0], `${seed}`);
      const pieces = mesh.boundary.map(({ name, marker, edges }) => [name, marker, edges.length / 2]);
      assert.deepEqual(pieces, expected.boundary.map(({ name, id, edges }) => [name, id + 1, edges]), `${seed}`);
      mesh.free();
    }
    assert.ok(failed < 5, `${failed} documents have no mesh`);
  },

  "random edits in place give the mesh from scratch, and undo leads back through them"() {
    // Documents with few triangles.
    [2, 3, 5, 7, 8, 9, 10, 11].forEach(followEdits);
  },

  "arrays fit each other"() {
    const [options] = inputs["polygons with gradation"];
    const { nodes, triangles, levels, neighbours, h, boundary, triangleCount, nodeCount } = Mesh.generate(options);
    assert.ok(nodes instanceof Float64Array && triangles instanceof Uint32Array && levels instanceof Uint8Array && neighbours instanceof Int32Array);
    assert.deepEqual([nodes.length, triangles.length, levels.length, neighbours.length, h.length], [2, 3, 1, 3, 1].map((n, i) => n * (i % 4 === 0 ? nodeCount : triangleCount)));
    const ends = (t, corner) => [1, 2].map((step) => triangles[3 * t + ((corner + step) % 3)]).sort((a, b) => a - b).join();
    const owners = new Map();
    for (let side = 0; side < 3 * triangleCount; side++) {
      const key = ends(Math.floor(side / 3), side % 3);
      owners.set(key, [...(owners.get(key) ?? []), Math.floor(side / 3)]);
    }
    let outer = 0;
    for (let t = 0; t < triangleCount; t++) {
      for (let corner = 0; corner < 3; corner++) {
        const other = neighbours[3 * t + corner];
        outer += Number(other < 0);
        assert.equal(other, owners.get(ends(t, corner)).find((owner) => owner !== t) ?? -1);
      }
      assert.ok(areas(nodes, [...triangles.subarray(3 * t, 3 * t + 3)], nodes[2 * triangles[3 * t]], nodes[2 * triangles[3 * t] + 1])[0] > 0, "anticlockwise");
    }
    assert.equal(boundary.reduce((sum, { edges }) => sum + edges.length / 2, 0), outer);
    assert.deepEqual(new Set(boundary.map(({ marker }) => marker)).size, boundary.length);
  },

  "points are found where a search through all triangles finds them"() {
    for (const name of ["a formula", "polygons with gradation", "threats, the vertex rule and a formula for the domain"]) {
      const mesh = Mesh.generate(inputs[name][0]);
      const { nodes, triangles } = mesh;
      const [x0, y0, x1, y1] = mesh.bounds;
      const next = random(7);
      const points = Float64Array.from({ length: 600 }, (_, n) => (n % 2 ? y0 + (1.1 * next() - 0.05) * (y1 - y0) : x0 + (1.1 * next() - 0.05) * (x1 - x0)));
      const { triangles: found, weights, where } = mesh.locateAll(points);
      for (let p = 0; p < 300; p++) {
        const [x, y] = [points[2 * p], points[2 * p + 1]];
        let expected = -1;
        for (let t = 0; t < mesh.triangleCount && expected < 0; t++) {
          if (areas(nodes, [...triangles.subarray(3 * t, 3 * t + 3)], x, y).every((area) => area >= 0)) {
            expected = t;
          }
        }
        assert.equal(found[p], expected, `${name}: ${x}, ${y}`);
        assert.equal(PLACES[where[p]], expected < 0 ? "outside" : "inside");
        const single = mesh.locate(x, y);
        assert.deepEqual([single.triangle, single.weights], [found[p], [...weights.subarray(3 * p, 3 * p + 3)]]);
      }
      // A linear function is interpolated exactly.
      const values = Float64Array.from({ length: mesh.nodeCount }, (_, n) => 2 * nodes[2 * n] - 3 * nodes[2 * n + 1] + 1);
      mesh.interpolate(values, points).forEach((value, p) => {
        const linear = 2 * points[2 * p] - 3 * points[2 * p + 1] + 1;
        assert.ok(found[p] < 0 ? Number.isNaN(value) : Math.abs(value - linear) < 1e-9, `${value} and ${linear}`);
      });
      mesh.interpolate(nodes, points).forEach((value, n) => {
        assert.ok(found[n >> 1] < 0 ? Number.isNaN(value) : Math.abs(value - points[n]) < 1e-9, `${value} and ${points[n]}`);
      });
      const corner = mesh.locate(nodes[0], nodes[1]);
      assert.equal(corner.where, "node");
      if (name === "a formula") {
        // Coordinates of this mesh are exact.
        const [a, b] = [0, 1].map((n) => [0, 1].map((axis) => nodes[2 * triangles[n] + axis]));
        assert.equal(mesh.locate((a[0] + b[0]) / 2, (a[1] + b[1]) / 2).where, "edge");
      }
      assert.deepEqual(mesh.locate(NaN, 0).where, "invalid");
    }
  },

  "an update in place gives the mesh from scratch, and undo the former one"() {
    const mesh = Mesh.generate(painted);
    const first = mesh.fingerprint;
    const change = mesh.paint(strokes);
    assert.equal(change.replaced, false);
    assert.ok(change.triangles > change.before && change.triangles === mesh.triangleCount && change.seconds >= 0);
    const scratch = Mesh.generate({ ...painted, layers: [{ kind: "paint", strokes }] });
    assert.equal(mesh.fingerprint, scratch.fingerprint);
    assert.notEqual(mesh.fingerprint, first);
    assert.equal(mesh.violations(), 0);
    const added = { kind: "distance", to: [[0.1, 0.9]], atZero: 0.01, slope: 0.5, name: "near" };
    mesh.addLayer(added);
    mesh.update({ gradation: 0.2, hMin: 0.01 });
    const all = { ...painted, gradation: 0.2, hMin: 0.01, layers: [{ kind: "paint", strokes }, added] };
    assert.equal(mesh.fingerprint, Mesh.generate(all).fingerprint);
    mesh.changeLayer("near", { combine: "floor", place: 0 });
    assert.deepEqual(mesh.layers.map(({ name, combine }) => [name, combine])[0], ["near", "floor"]);
    mesh.changeLayer("near", { combine: "finest" });
    mesh.changeLayer("near", { visible: false });
    mesh.removeLayer("near");
    mesh.update({ gradation: 0.3, hMin: 0.005 });
    assert.equal(mesh.fingerprint, scratch.fingerprint);
    for (let tries = 0; mesh.fingerprint !== first && tries < 40; tries++) {
      mesh.undo();
    }
    assert.equal(mesh.fingerprint, first);
  },

  "an edit that fails is undone"() {
    const mesh = Mesh.generate(painted);
    const [first, count] = [mesh.fingerprint, mesh.layers.length];
    const failing = [
      [() => mesh.update({ maxTriangles: 2 }), /triangles/],
      [() => mesh.update({ hMin: -1 }), /hMin: -1 cannot be used/],
      [() => mesh.update({ hMin: 5, hMax: 1 }), /5/],
      [() => mesh.paint([strokes[0], { ...strokes[0], radius: NaN }]), /radius: NaN cannot be used/],
      [() => mesh.paint({ points: [[0.5, 0.5]], radius: 0.4, risk: 2 }), /risk/],
      [() => mesh.addLayer({ kind: "formula", formula: "-1" }), /-1/],
      [() => mesh.addLayer({ kind: "formula", formula: "x - 0.5" }), /positive/],
      [() => mesh.removeLayer("absent"), /There is no layer "absent"/],
      [() => mesh.update({ maxLevel: -1 }), /maxLevel: -1/],
      [() => mesh.update({ domain: [0, 0, 2, 2] }), /there is no key domain/],
      [() => mesh.changeLayer(0, { colour: "red" }), /there is no key colour/],
    ];
    for (const [act, words] of failing) {
      assert.throws(act, (problem) => problem instanceof Error && words.test(problem.message), String(words));
      assert.deepEqual([mesh.fingerprint, mesh.layers.length, mesh.violations()], [first, count, 0], String(words));
    }
    mesh.paint(strokes);
    assert.equal(mesh.fingerprint, Mesh.generate({ ...painted, layers: [{ kind: "paint", strokes }] }).fingerprint);
  },

  "a mirror repeats a stroke, on a layer of its own quantity"() {
    const stroke = { points: [[0.25, 0.125]], radius: 0.0625, diameter: 0.015625, hardness: 1 };
    const at = (x, y) => ({ ...stroke, points: [[x, y]] });
    const mirrors = [
      [{ mirrorX: 0.5 }, [at(0.25, 0.125), at(0.75, 0.125)]],
      [{ mirrorY: 0.5 }, [at(0.25, 0.125), at(0.25, 0.875)]],
      [{ mirrorX: 0.5, mirrorY: 0.5 }, [at(0.25, 0.125), at(0.75, 0.125), at(0.25, 0.875), at(0.75, 0.875)]],
    ];
    const once = Mesh.generate(painted);
    once.paint(stroke);
    for (const [mirror, all] of mirrors) {
      const [mirrored, drawn] = [Mesh.generate(painted), Mesh.generate(painted)];
      mirrored.paint({ ...stroke, ...mirror });
      drawn.paint(all);
      assert.equal(mirrored.fingerprint, drawn.fingerprint, JSON.stringify(mirror));
      assert.notEqual(mirrored.fingerprint, once.fingerprint);
    }
    // An effect that is weaker leaves larger triangles, and a change that is not wanted none.
    const least = (more) => {
      const mesh = Mesh.generate(painted);
      mesh.paint({ ...stroke, ...more });
      return mesh.h[mesh.triangles[3 * mesh.locate(0.25, 0.125).triangle]];
    };
    assert.ok(least({ strength: 0.5 }) > 2 * least({}) && least({ strength: 0 }) === 0.2);
    assert.equal(least({ diameter: 0.5, change: "finer" }), 0.2);
    assert.equal(least({ change: "coarser" }), 0.2);
  },

  "strokes go to the layer that was painted on or added last, else to the uppermost one of their quantity"() {
    const layers = [{ kind: "paint", name: "a" }, { kind: "paint", name: "b" }, { kind: "paint", quantity: "risk", name: "risk" }];
    const mesh = Mesh.generate({ ...painted, gradation: undefined, layers });
    const isFine = (x) => mesh.h[mesh.triangles[3 * mesh.locate(x, 0.5).triangle]] < 0.1;
    const layerOf = (x, more) => {
      mesh.paint({ points: [[x, 0.5]], radius: 0.06, diameter: 0.012, ...more });
      assert.ok(isFine(x));
      return mesh.layers.filter(({ kind }) => kind === "paint").map(({ name }) => name).filter((name) => {
        mesh.changeLayer(name, { visible: false });
        const isHere = !isFine(x);
        mesh.changeLayer(name, { visible: true });
        return isHere;
      }).join();
    };
    assert.deepEqual([layerOf(0.2), layerOf(0.4, { layer: "a" }), layerOf(0.6)], ["b", "a", "a"]);
    mesh.addLayer({ kind: "paint", name: "c" });
    assert.equal(layerOf(0.8), "c");
    // Of several layers with a name, the uppermost is meant.
    mesh.addLayer({ kind: "paint", name: "c" });
    mesh.changeLayer("c", { name: "d" });
    assert.deepEqual(mesh.layers.slice(-2).map(({ name }) => name), ["c", "d"]);
  },

  "risk needs the smallest diameter, which an edit can say"() {
    const options = { domain: [0, 0, 1, 1], size: 0.2 };
    const risky = { kind: "formula", quantity: "risk", formula: "0.5" };
    const dot = { points: [[0.5, 0.5]], radius: 0.2, risk: 0.5 };
    assert.throws(() => Mesh.generate({ ...options, layers: [risky] }), /Risk needs hMin/);
    const mesh = Mesh.generate(options);
    const acts = [() => mesh.addLayer(risky), () => mesh.paint(dot)];
    acts.forEach((act) => assert.throws(act, /Risk needs hMin/));
    assert.deepEqual([mesh.layers.length, mesh.fingerprint], [1, Mesh.generate(options).fingerprint]);
    mesh.update({ hMin: 0.05 });
    acts.forEach((act) => act());
    assert.deepEqual(mesh.layers.map(({ kind }) => kind), ["formula", "formula", "paint"]);
  },

  "the same can be said in several ways, and what is usual left out"() {
    const of = (layers, act) => {
      const mesh = Mesh.generate({ domain: [0, 0, 1, 1], spacing: 0.25, hMin: 0.01, layers });
      act?.(mesh);
      return mesh.fingerprint;
    };
    const point = { type: "Point", coordinates: [0.3, 0.8, 5] };
    const feature = (geometry) => ({ type: "Feature", properties: null, geometry });
    const places = [[[0.3, 0.8]], [0.3, 0.8], point, feature(point), { type: "FeatureCollection", features: [feature(null), feature(point)] }];
    assert.equal(new Set(places.map((to) => of([{ kind: "distance", to, atZero: 0.02, slope: 0.3 }]))).size, 1);
    const stroke = { points: [[0.3, 0.8]], radius: 0.2, diameter: 0.02 };
    const painting = (more) => of([], (mesh) => mesh.paint({ ...stroke, ...more }));
    assert.equal(painting({}), painting({ hardness: 0.5, strength: 1, change: "finer" }));
    assert.equal(painting({}), painting({ erase: false }));
    assert.equal(new Set([{}, { hardness: 1 }, { strength: 0.5 }].map(painting)).size, 3);
    const coarser = [{}, { change: "any" }].map((more) => of([], (mesh) => mesh.paint([stroke, { ...stroke, diameter: 0.2, ...more }])));
    assert.deepEqual(coarser.map((fingerprint) => fingerprint === painting({})), [true, false]);
    // What a mesh is made of is no edit, and arrays are computed once.
    const mesh = Mesh.generate({ domain: [0, 0, 1, 1], size: 0.1, layers: [{ kind: "paint", strokes: [stroke] }] });
    const [before, nodes] = [mesh.fingerprint, mesh.nodes];
    assert.equal(mesh.nodes, nodes);
    mesh.undo();
    assert.deepEqual([mesh.fingerprint, mesh.layers.length], [before, 2]);
  },

  "parts and pinches stay where the options say so"() {
    // Two squares that meet in a node, and a smaller one beside them.
    const ring = (x, y, side) => [[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
    const polygons = { type: "MultiPolygon", coordinates: [[ring(0, 0, 2)], [ring(2, 2, 2)], [ring(3, 0, 1)]] };
    const made = (more) => {
      const mesh = Mesh.generate({ domain: polygons, spacing: 0.5, boundary: "fitted", ...more });
      const { nodes, triangles } = mesh;
      const areasOf = Array.from({ length: mesh.triangleCount }, (_, t) => areas(nodes, [...triangles.subarray(3 * t, 3 * t + 3)], nodes[2 * triangles[3 * t]], nodes[2 * triangles[3 * t] + 1])[0] / 2);
      return { mesh, area: areasOf.reduce((sum, area) => sum + area, 0) };
    };
    const area = (more) => made(more).area;
    const stay = [{}, { parts: "largest" }, { parts: 0.2 }, { parts: 0.05 }, { parts: "all" }];
    assert.deepEqual(stay.map((more) => Math.round(area(more))), [4, 4, 8, 9, 9]);
    // Small triangles go where the squares meet.
    assert.ok(area({ parts: "all" }) < 9 && area({ parts: "all", keepPinches: false }) < 9);
    assert.deepEqual([{ parts: 0.2 }, { parts: "all" }].map((more) => area({ ...more, keepPinches: true })), [8, 9]);
    const { mesh } = made({ parts: "all", keepPinches: true });
    const kept = mesh.triangleCount;
    mesh.update({ hMax: 0.4 });
    mesh.update({ hMax: 100 });
    assert.equal(mesh.triangleCount, kept);
    mesh.update({ keepPinches: false });
    assert.ok(mesh.triangleCount < kept);
    mesh.undo();
    assert.equal(mesh.triangleCount, kept);
    mesh.update({ parts: "largest" });
    assert.ok(mesh.triangleCount < kept);
    mesh.undo();
    assert.equal(mesh.triangleCount, kept);
    mesh.redo();
    assert.ok(mesh.triangleCount < kept);
    assert.throws(() => mesh.update({ hMin: 200, hMax: 1, parts: "all" }));
    assert.ok(mesh.triangleCount < kept);
  },

  "every number has its rule, and its error names it"() {
    const square = { domain: [0, 0, 1, 1], spacing: 0.25, hMin: 0.125 };
    const grid = { values: [-1, -2, -3, -4], width: 2, height: 2 };
    const layer = (more) => (key, value) => ({ ...square, layers: [{ ...more, [key]: value }] });
    const option = (key, value) => ({ ...square, hMax: 1, [key]: value });
    const [positive, depth] = [[0, -1, NaN, Infinity, "1"], { kind: "depth", ...grid }];
    const water = { kind: "straits", across: 1, widthFrom: 0.1, widthTo: 0.2 };
    const stroke = { points: [[0.5, 0.5]], radius: 0.25, diameter: 0.25 };
    const brush = (quantity, more) => (key, value) => ({ ...square, layers: [{ kind: "paint", quantity, strokes: [{ ...stroke, ...more, [key]: value }] }] });
    const rules = [
      [option, { spacing: [positive, [0.5]], hMin: [positive, [1e-300, 0.5]], hMax: [positive, [0.125, 2]], hRisk: [positive, [0.125, 1]] }],
      [option, { maxTriangles: [[1, 2.5, NaN, -1], [1000]], maxLevel: [[-1, 0.5, 256, NaN], [0, 1, 255]], maxMemory: [[-1, NaN, Infinity], [1e9]] }],
      [option, { parts: [[-0.1, 1.1, NaN, "some"], [0, 1, "all"]], shape: [["1", 0, NaN], [1]], gradation: [["1", -1, NaN], [0.1]] }],
      [(key, value) => ({ ...option(key, value), domain: coast }), { boundaryDiameter: [positive, [0.5]], boundary: [["none", 1], ["fitted"]] }],
      [layer({ kind: "corridor", along: [[0, 0], [1, 1]], width: 0.1, atZero: 0.2, slope: 1 }), { width: [positive, [0.2]], atZero: [positive, [0.3]], range: [positive, [0.5]], slope: [[-1, NaN, Infinity, "1"], [0]] }],
      [layer(water), { across: [[0.99, 0, NaN, Infinity], [1]], widthFrom: [positive, [0.05]], widthTo: [[0.1, 0, NaN, Infinity], [0.11]] }],
      [layer({ kind: "band", ...grid, between: [-3, -1], diameter: 0.3 }), { diameter: [positive, [1]], between: [[[2, 1], [NaN, 1], [0, Infinity], [-Infinity, 0], [1, 2, 3]], [[1, 1]]] }],
      [layer({ ...depth, size: "wavelength", period: 0.2, triangles: 4 }), { period: [positive, [1]], triangles: [positive, [1]], offset: [[NaN, Infinity], [0, -1]], depthFrom: [[-1, NaN], [0]], depthTo: [[0, -1, NaN], [0.1]], size: [["deep"], []], positive: [["left"], ["down"]] }],
      [layer({ ...depth, depthFrom: 2 }), { depthTo: [[2, 1], [2.1]] }],
      [layer({ ...depth, size: "courant", timeStep: 0.01, courant: 0.5 }), { timeStep: [positive, [0.1]], courant: [positive, [1]] }],
      [layer({ ...depth, size: "slope", triangles: 4 }), { smoothing: [positive, [0.5]], triangles: [positive, [3]] }],
      [layer({ kind: "surface", formula: "x*y" }), { within: [[0, -1, NaN, "1"], [0.1]], atMost: [[0, 1.5, NaN, -1], [100]] }],
      [brush("diameter", {}), { radius: [[0, -1, NaN, Infinity], [1]], hardness: [[-0.1, 1.1, NaN], [0, 1]], strength: [[-0.1, 1.1, NaN], [0, 1]], diameter: [[0, -1, NaN], [0.3]], change: [["finest"], ["any"]] }],
      [brush("risk", { diameter: undefined }), { risk: [[-0.1, 1.1, NaN], [0, 1]] }],
    ];
    for (const [options, keys] of rules) {
      for (const [key, [wrong, right]] of Object.entries(keys)) {
        for (const value of wrong) {
          const named = (problem) => problem instanceof Error && !(problem instanceof WebAssembly.RuntimeError) && problem.message.length > 20;
          assert.throws(() => Mesh.generate(options(key, value)), named, `${key}: ${value}`);
        }
        right.forEach((value) => Mesh.generate(options(key, value)).free());
      }
    }
    // The least number that is possible is asked for, and cannot be met here.
    assert.throws(() => Mesh.generate({ ...square, layers: [{ kind: "surface", formula: "x*y", atMost: 1 }] }), /A mesh of at most 1 triangles cannot be made: without the surface it has 32/);
  },

  "bad input is an error with a sentence"() {
    const square = { domain: [0, 0, 1, 1] };
    const raster = (more) => ({ ...square, layers: [{ kind: "raster", values: [1, 2], width: 2, height: 1, as: "diameter", ...more }] });
    const distance = (to) => ({ ...square, layers: [{ kind: "distance", to, atZero: 0.1, slope: 0.1 }] });
    const bad = [
      [undefined, /this must be an object/],
      [{}, /domain/],
      [{ ...square, hmin: 1 }, /there is no key hmin/],
      [{ domain: [0, 0, NaN, 1] }, /no rectangle/],
      [{ domain: [0, 0, 0, 1] }, /no rectangle/],
      [{ domain: [] }, /no point/],
      [{ domain: Float64Array.of(0, 0, 1, 1) }, /needs 3 points/],
      [{ domain: [[0, 0], [1, 1]] }, /needs 3 points/],
      [{ domain: [[0, 0], [1, NaN], [1, 1]] }, /must be finite/],
      [{ domain: { bounds: [0, 0, 1] } }, /bounds: this must be 4 numbers, and these are 3/],
      [{ domain: { type: "Polygon", coordinates: 7 } }, /not those of GeoJSON/],
      [{ domain: { type: "Sphere" } }, /no type/],
      [{ ...square, spacing: 0 }, /spacing: 0 cannot be used/],
      [{ ...square, spacing: "wide" }, /spacing: this must be a number/],
      [{ ...square, spacing: 1e-9 }, /spacing|coarse/],
      [{ ...square, rule: "other" }, /write one of area, vertex/],
      [{ ...square, size: "0.1 +* x" }, /formula:.*\n.*\^/s],
      [{ ...square, size: "unknown(x)" }, /unknown/],
      [{ ...square, size: "(".repeat(100_000) }, /formula/],
      [{ ...square, size: "1e-9" }, /Raise hMin/],
      [{ ...square, size: NaN }, /NaN|formula/],
      [{ ...square, layers: [{ kind: "circle" }] }, /no kind of layer/],
      [{ ...square, layers: [null] }, /no kind of layer/],
      [raster({ values: [1, 2, 3] }), /has 2 values, and these are 3/],
      [raster({ values: [] }), /has 2 values, and these are 0/],
      [raster({ values: [1, -2] }), /target diameter is -2 at/],
      [raster({ values: ["1", "2"] }), /array of numbers/],
      [raster({ values: new BigInt64Array(2) }), /array of numbers/],
      [raster({ values: new DataView(new ArrayBuffer(16)) }), /array of numbers/],
      [distance([[0, 0, 1], [1, 1, 1]]), /x and y in turn/],
      [raster({ width: 0, height: 0, values: [] }), /impossible/],
      [raster({ width: 1.5 }), /impossible/],
      [raster({ as: undefined }), /what its values mean/],
      [distance([]), /no point/],
      [distance(Float64Array.of(1, 2, 3)), /x and y in turn/],
      [distance([[0, Infinity]]), /must be finite/],
      [distance("shore"), /write one of outline, coasts/],
      [distance(undefined), /the pieces or types of the boundary/],
      [{ ...square, layers: [{ kind: "distance", types: ["sand"], atZero: 0.1, slope: 0.1 }] }, /"sand" is no type/],
      [{ ...square, layers: [{ kind: "corridor", along: [[0, 0]], width: 0.1, atZero: 0.1, slope: 0.1 }] }, /A line needs 2 points/],
      [{ ...square, boundary: "fitted" }, /for the outline of polygons/],
      [{ ...square, boundaryDiameter: 0.1 }, /for the outline of polygons/],
      [{ domain: [[0, 0], [2, 0], [0, 2]], spacing: 1, boundary: "report", boundaryDiameter: 0.1 }, /nothing is refined/],
      [{ ...square, layers: [{ kind: "surface", formula: "x", within: 0.1, atMost: 9 }] }, /one of within/],
      [{ domain: { bounds: [0, 0, 1, 1], inside: "x < 0.5" }, layers: [{ kind: "distance", to: "outline", atZero: 0.1, slope: 0.1 }] }, /given by a formula/],
      [{ domain: { bounds: [0, 0, 1, 1], inside: "x <" } }, /inside/],
      [{ domain: { inside: "x < 0.5" } }, /bounds is missing/],
      [raster({ origin: "left" }), /write one of upper, lower/],
      [raster({ values: [1, 1e39] }), /beyond single precision/],
      [raster({ as: undefined, curve: Float64Array.of(1, 2, 3) }), /x and y in turn/],
      [raster({ as: "risk", curve: [[0, 1]] }), /what its values mean/],
      [raster({ as: "error", values: [0, 1] }), /error is 0 at/],
      [{ ...square, layers: [{ kind: "threats", threats: [{ x: 1, y: NaN, range: 1 }] }], hMin: 0.1 }, /threat 1 cannot be used/],
      [{ ...square, layers: [{ kind: "paint", strokes: [{ points: [], radius: 1, diameter: 1 }] }] }, /needs a point/],
      [{ ...square, layers: [{ kind: "paint", strokes: [{ points: [[0, 0]], radius: 1, diameter: 1, error: 1 }] }] }, /one of diameter, risk, error and erase/],
      [{ ...square, layers: [{ kind: "paint", strokes: [{ points: [[NaN, 1]], radius: 1, diameter: 1 }] }] }, /impossible/],
    ];
    for (const [options, words] of bad) {
      assert.throws(() => Mesh.generate(options), (problem) => problem instanceof Error && !(problem instanceof WebAssembly.RuntimeError) && words.test(problem.message), String(words));
    }
    const mesh = Mesh.generate(square);
    assert.throws(() => mesh.locateAll([1, 2, 3]), /x and y in turn/);
    [[1, 2], []].forEach((values) => assert.throws(() => mesh.interpolate(values, [0, 0]), /the mesh has \d+ nodes/));
  },
};

/** Makes a mesh whose paint layers are painted on before they are hidden and locked. */
function painting(options) {
  const isPaint = ({ kind }) => kind === "paint";
  const mesh = Mesh.generate({ ...options, layers: options.layers.map((layer) => (isPaint(layer) ? { ...layer, visible: true, locked: false } : layer)) });
  options.layers.filter(isPaint).forEach(({ name, visible, locked }) => mesh.changeLayer(name, { visible, locked }));
  return mesh;
}

/**
 * Edits a random mesh, and compares it with one that is made of what the edits led to: `model`, whose layers have the
 * strokes that were painted on them.
 */
function followEdits(seed) {
  const choices = new Choices(100 + seed);
  const { options, bounds } = randomDocument(100 + seed);
  const quick = { kinds: ["formula", "raster", "band", "threats"], bounds };
  const named = (layer, number) => ({ ...layer, name: `layer ${number}`, visible: layer.visible ?? true, locked: layer.locked ?? false, combine: layer.combine ?? "finest" });
  let model = { ...options, layers: Array.from({ length: 2 }, (_, number) => named(randomLayer(choices, number, quick).layer, number)) };
  const mesh = Mesh.generate(model);
  const [first, firstRows] = [mesh.fingerprint, JSON.stringify(mesh.layers)];
  const edits = {
    add(layers, number) {
      const layer = named(choices.is(0.3) ? { kind: "paint", quantity: choices.pick(["diameter", "risk"]) } : randomLayer(choices, number, quick).layer, number);
      return [() => mesh.addLayer(layer), [...layers, layer]];
    },
    paint(layers, number) {
      const layer = named({ kind: "paint", quantity: "diameter" }, number);
      const strokes = Array.from({ length: 1 + (choices.next() > 0.5) }, () => ({
        points: choices.points(1, 3), radius: choices.number(0.1, 0.4), diameter: choices.number(0.08, 0.2), hardness: choices.number(0, 1),
        strength: choices.number(0.5, 1), change: choices.pick(["finer", "any", undefined]), mirrorX: choices.maybe(() => 2, 0.2),
      }));
      const at = layers.findLastIndex(({ kind, visible, locked, quantity }) => kind === "paint" && visible && !locked && quantity === "diameter");
      if (at < 0) {
        return [() => mesh.addLayer({ ...layer, strokes }), [...layers, { ...layer, strokes }]];
      }
      const which = choices.pick([at, layers[at].name, mesh.layers[at]]);
      return [() => mesh.paint(strokes.map((stroke) => ({ ...stroke, layer: which }))), layers.with(at, { ...layers[at], strokes: [...(layers[at].strokes ?? []), ...strokes] })];
    },
    change(layers) {
      const at = Math.floor(choices.next() * layers.length);
      const changes = Object.fromEntries(
        Object.entries({ name: `${layers[at].name}'`, visible: choices.is(), locked: choices.is(), combine: choices.pick(["finest", "floor", "replace"]) }).filter(() => choices.is()),
      );
      const others = layers.with(at, { ...layers[at], ...changes });
      return [() => mesh.changeLayer(layers[at].name, changes), others];
    },
    move(layers) {
      const [at, place] = [Math.floor(choices.next() * layers.length), Math.floor(choices.next() * (layers.length + 1))];
      return [() => mesh.changeLayer(at, { place }), layers.toSpliced(at, 1).toSpliced(place, 0, layers[at])];
    },
    remove(layers) {
      const at = Math.floor(choices.next() * layers.length);
      return [() => mesh.removeLayer(layers[at].name), layers.toSpliced(at, 1)];
    },
    update(layers) {
      const hasOwn = model.hMax !== undefined && (model.boundary === "report" || model.boundaryDiameter !== undefined || bounds.join() === "0,0,4,3");
      const some = { gradation: choices.number(0.1, 0.5), hRisk: choices.number(0.08, 0.4), shape: choices.number(0.5, 3), rule: choices.pick(["area", "vertex"]), hMin: choices.number(0.05, 0.08) };
      // What is not given follows from the first spacing.
      const spacing = choices.number(0.5, 1);
      Object.assign(some, hasOwn ? { spacing } : {});
      const changes = Object.fromEntries(Object.entries(some).filter(() => choices.is(0.3)));
      return [() => mesh.update(changes), layers, changes];
    },
    fail(layers) {
      const wrong = choices.pick([
        () => mesh.update({ hMin: 0.3, maxTriangles: 2 }), () => mesh.update({ hMin: 5, hMax: 1 }), () => mesh.addLayer({ kind: "formula", formula: "x - 9" }),
        () => mesh.paint([{ points: [[1, 1]], radius: 0.3, diameter: 0.1 }, { points: [[1, 1]], radius: 0, diameter: 0.1 }]), () => mesh.changeLayer(0, { combine: "best" }),
        () => mesh.paint({ points: [[1, 1]], radius: 1, diameter: 0.1, layer: layers.findIndex(({ kind }) => kind !== "paint") }),
      ]);
      return [() => assert.throws(wrong, Error, String(wrong)), layers];
    },
  };
  for (let step = 0; step < 12; step++) {
    const names = model.layers.length > 0 ? Object.keys(edits) : ["add", "update"];
    const name = choices.pick(names);
    const [act, layers, changes = {}] = edits[name](model.layers, 2 + step);
    const before = mesh.triangleCount;
    const change = act();
    model = { ...model, ...changes, layers };
    const scratch = painting(model);
    const place = `seed ${seed}, step ${step}: ${name}`;
    assert.equal(mesh.fingerprint, scratch.fingerprint, place);
    assert.deepEqual([mesh.triangleCount, mesh.nodeCount, mesh.violations()], [scratch.triangleCount, scratch.nodeCount, 0], place);
    assert.deepEqual(mesh.layers.map(({ name, kind, visible, locked, combine }) => ({ name, kind, visible, locked, combine })),
      layers.map(({ name, kind, visible, locked, combine }) => ({ name, kind, visible, locked, combine })), place);
    if (name !== "fail") {
      assert.deepEqual([change.before, change.triangles], [before, scratch.triangleCount], place);
    }
    scratch.free();
  }
  const last = mesh.fingerprint;
  const rows = JSON.stringify(mesh.layers);
  const go = (act, end, layers) => {
    for (let tries = 0; tries < 60 && !(mesh.fingerprint === end && JSON.stringify(mesh.layers) === layers); tries++) {
      act();
    }
    assert.deepEqual([mesh.fingerprint, JSON.stringify(mesh.layers)], [end, layers], `seed ${seed}`);
  };
  go(() => mesh.undo(), first, firstRows);
  go(() => mesh.redo(), last, rows);
  mesh.free();
}

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  const began = Date.now();
  try {
    await test();
    console.log(`ok   npm: ${name} (${Date.now() - began} ms)`);
  } catch (problem) {
    failed++;
    console.log(`FAIL npm: ${name}\n  ${problem.stack ?? problem}`);
  }
}
process.exit(failed > 0 ? 1 : 0);
