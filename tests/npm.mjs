// Checks the package for JavaScript in Node.js: node tests/npm.mjs FOLDER PROGRAM SCRATCH
// FOLDER has the package, PROGRAM is the desktop program, SCRATCH is a folder for files.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [folder, program, scratch] = process.argv.slice(2).map((name) => path.resolve(name));
const { default: init, Mesh, PLACES } = await import(pathToFileURL(path.join(folder, "node.js")));
assert.throws(() => Mesh.generate({ domain: [0, 0, 1, 1] }), /await init\(\) first/);
await init();

/** Returns the fingerprint and the number of triangles that the program finds for a recipe. */
function byProgram(recipe, files = {}) {
  for (const [name, content] of Object.entries({ "input.toml": recipe, ...files })) {
    fs.writeFileSync(path.join(scratch, name), content);
  }
  const answer = execFileSync(program, ["mesh", path.join(scratch, "input.toml"), "--json"], { encoding: "utf8", maxBuffer: 1 << 26 });
  return JSON.parse(answer);
}

/** A generator of numbers from 0 to 1, the same at every run. */
function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
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
      layers: [{ kind: "corridor", along: [[0.1, 0.1], [0.5, 0.8], [0.9, 0.2]], width: 0.1, atZero: 0.02, slope: 0.4 }, { kind: "formula", formula: "if(x < 0.3, 0.1, inf)", combine: "replace" }],
    },
    `${square}max_level = 9\n[limits]\nh_min = 0.01
[[layer]]\nkind = "corridor"\nshapes = [{ line = [[0.1, 0.1], [0.5, 0.8], [0.9, 0.2]] }]\nwidth = 0.1\nat_zero = 0.02\nslope = 0.4
[[layer]]\nkind = "formula"\nquantity = "diameter"\nformula = "if(x < 0.3, 0.1, inf)"\ncombine = "replace"\n`,
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

  "arrays fit each other"() {
    const [options] = inputs["polygons with gradation"];
    const { nodes, triangles, levels, neighbours, h, boundary, triangleCount, nodeCount } = Mesh.generate(options);
    assert.ok(nodes instanceof Float64Array && triangles instanceof Uint32Array && levels instanceof Uint8Array && neighbours instanceof Int32Array);
    assert.deepEqual([nodes.length, triangles.length, levels.length, neighbours.length, h.length], [2, 3, 1, 3, 1].map((n, i) => n * (i % 4 === 0 ? nodeCount : triangleCount)));
    let outer = 0;
    for (let t = 0; t < triangleCount; t++) {
      for (let corner = 0; corner < 3; corner++) {
        const other = neighbours[3 * t + corner];
        outer += Number(other < 0);
        if (other >= 0) {
          const shared = [1, 2].map((step) => triangles[3 * t + ((corner + step) % 3)]);
          shared.forEach((node) => assert.ok(triangles.subarray(3 * other, 3 * other + 3).includes(node)));
        }
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
      const corner = mesh.locate(nodes[0], nodes[1]);
      assert.equal(corner.where, "node");
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
    ];
    for (const [act, words] of failing) {
      assert.throws(act, (problem) => problem instanceof Error && words.test(problem.message), String(words));
      assert.deepEqual([mesh.fingerprint, mesh.layers.length, mesh.violations()], [first, count, 0], String(words));
    }
    mesh.paint(strokes);
    assert.equal(mesh.fingerprint, Mesh.generate({ ...painted, layers: [{ kind: "paint", strokes }] }).fingerprint);
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
      [raster({ width: 0, height: 0, values: [] }), /impossible/],
      [raster({ width: 1.5 }), /impossible/],
      [raster({ as: undefined }), /what its values mean/],
      [distance([]), /no point/],
      [distance(Float64Array.of(1, 2, 3)), /x and y in turn/],
      [distance([[0, Infinity]]), /must be finite/],
      [distance("shore"), /write one of outline, coasts/],
      [{ ...square, layers: [{ kind: "threats", threats: [{ x: 1, y: NaN, range: 1 }] }], hMin: 0.1 }, /threat 1 cannot be used/],
      [{ ...square, layers: [{ kind: "paint", strokes: [{ points: [], radius: 1, diameter: 1 }] }] }, /needs a point/],
      [{ ...square, layers: [{ kind: "paint", strokes: [{ points: [[NaN, 1]], radius: 1, diameter: 1 }] }] }, /impossible/],
    ];
    for (const [options, words] of bad) {
      assert.throws(() => Mesh.generate(options), (problem) => problem instanceof Error && !(problem instanceof WebAssembly.RuntimeError) && words.test(problem.message), String(words));
    }
    const mesh = Mesh.generate(square);
    assert.throws(() => mesh.locateAll([1, 2, 3]), /x and y in turn/);
    assert.throws(() => mesh.interpolate([1, 2], [0, 0]), /the mesh has \d+ nodes/);
  },
};

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
