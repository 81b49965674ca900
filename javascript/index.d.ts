/** Loads the module, once; await it before anything else. `source` is an address, a response or the bytes of `core_bg.wasm`, where that does not lie beside this file. */
export default function init(source?: string | URL | Request | Response | BufferSource | WebAssembly.Module): Promise<void>;

/** An array of numbers: of any type but those of 64-bit integers. */
export type Numbers =
  | readonly number[] | Float64Array | Float32Array | Int32Array | Uint32Array | Int16Array | Uint16Array | Int8Array | Uint8Array;
/** Points in world units: x and y in turn, or pairs of them. */
export type Points = Numbers | readonly (readonly [number, number])[];
/** GeoJSON. Coordinates are world units. */
export interface GeoJson {
  type: string;
  [key: string]: unknown;
}
/** Points, or several lists of them: several lines, or the rings of a polygon with the outer one first. Or GeoJSON. */
export type Shapes = Points | readonly Points[] | GeoJson;
/** x0, y0, x1 and y1 in world units, with x0 < x1 and y0 < y1. */
export type Bounds = readonly [number, number, number, number];

/** Where to mesh: a rectangle, a polygon, or an object. An array of four numbers is a rectangle. */
export type Domain =
  | Bounds
  | Shapes
  | {
      /** The rectangle that the coarse grid covers; left out, that of the polygons. */
      bounds?: Bounds;
      /** A formula in `x`, `y`, `r` and `theta`: the domain is made of the coarse triangles at whose three corners it is not 0. */
      inside?: string;
      /** The domain. The names of its coasts come from the property `name` of features. */
      polygons?: Shapes;
    };

/** Values by pixel. */
export interface Raster {
  /** Row by row; the first row is the northern one, unless `origin` is "lower". NaN asks for nothing. */
  values: Numbers;
  /** Pixels in a row. */
  width: number;
  /** Rows. */
  height: number;
  /** Left out, the rectangle of the domain. */
  bounds?: Bounds;
  origin?: "upper" | "lower";
}

export type Quantity = "diameter" | "risk" | "error";
/** "finest" where it is finer than what is below, "floor" where it is coarser, "replace" everywhere. */
export type Combine = "finest" | "floor" | "replace";

/** What every layer can have. */
export interface CommonLayer {
  name?: string;
  /** A hidden layer asks for nothing. */
  visible?: boolean;
  /** A locked layer is not painted on. */
  locked?: boolean;
  combine?: Combine;
  /** Where the layer counts: a polygon, or GeoJSON with polygons. */
  mask?: Shapes;
}

/** A target diameter that grows with a distance. */
export interface Growth {
  /** The diameter at distance 0. */
  atZero: number;
  /** Growth of the diameter by unit of distance. */
  slope: number;
  /** The distance beyond which nothing is asked for. */
  range?: number;
}

/** Triangles across water between two widths. */
export interface AcrossWater {
  across: number;
  widthFrom: number;
  widthTo: number;
}

/** A round brush and where it goes. It has one of `diameter`, `risk`, `error` and `erase`. */
export interface Stroke {
  points: Points;
  radius: number;
  diameter?: number;
  /** From 0 to 1. */
  risk?: number;
  /** The largest error from surfaces, in their unit. */
  error?: number;
  erase?: boolean;
  /** The share of the radius with the full effect; 0.5 unless given. */
  hardness?: number;
  /** The share of the way to the amount; 1 unless given. */
  strength?: number;
  /** Which diameters change; "finer" unless given. */
  change?: "finer" | "coarser" | "any";
  /** The x of a vertical mirror. */
  mirrorX?: number;
  /** The y of a horizontal mirror. */
  mirrorY?: number;
}

/** A layer. Keywords have the meaning that the keys of a recipe have. */
export type Layer = CommonLayer &
  (
    | { kind: "formula"; /** In `x`, `y`, `r` and `theta`. */ formula: string | number; quantity?: Quantity }
    | ({ kind: "raster"; /** What the values are, unless there is a curve. */ as?: Quantity; /** Pairs of a value and the diameter there. */ curve?: Points } & Raster)
    | ({ kind: "band"; /** The least and the greatest value. */ between: readonly [number, number]; diameter: number } & Raster)
    | ({
        kind: "depth";
        size?: "nothing" | "wavelength" | "slope" | "courant";
        /** Whether values are heights ("up") or depths. */
        positive?: "up" | "down";
        offset?: number;
        depthFrom?: number;
        depthTo?: number;
        period?: number;
        triangles?: number;
        smoothing?: number;
        timeStep?: number;
        courant?: number;
      } & Raster)
    | ({
        kind: "surface";
        /** In place of values. */
        formula?: string;
        /** The largest error; or `atMost`. */
        within?: number;
        /** The largest number of triangles; or `within`. */
        atMost?: number;
        norm?: "max" | "l2" | "h1";
      } & Partial<Raster>)
    | { kind: "threats"; threats: readonly { x: number; y: number; range: number; peak?: number; law?: "radar" | "gaussian" | "disc" }[] }
    | ({ kind: "distance"; /** An array is points. */ to?: "outline" | "coasts" | Shapes; /** Names of pieces of the boundary. */ pieces?: string[]; /** Types of them. */ types?: string[] } & Growth)
    | ({ kind: "corridor"; /** An array is a line. */ along: Shapes; width: number } & Growth)
    | ({ kind: "straits" } & AcrossWater)
    | ({ kind: "featureSize" } & AcrossWater)
    | { kind: "paint"; quantity?: Quantity; strokes?: readonly Stroke[] }
  );

/** Options that can be changed. Lengths are in world units. */
export interface Limits {
  /** The longest side of a coarse cell; a twentieth of the longer side of the domain unless given. */
  spacing?: number;
  /** The smallest target diameter. Risk needs it. */
  hMin?: number;
  /** The largest target diameter. */
  hMax?: number;
  /** The target diameter where the risk is 1; `hMin` unless given. */
  hRisk?: number;
  /** The exponent of the curve from risk to diameter. */
  shape?: number;
  /** Largest growth of the target diameter by unit of length, as 0.3. */
  gradation?: number;
  /** How the mesh meets the outline of polygons. */
  boundary?: "outline" | "fitted" | "report";
  /** The diameter of triangles along the outline. */
  boundaryDiameter?: number;
  /** The parts that stay: a number is the least share of the area. */
  parts?: "all" | "largest" | number;
  keepPinches?: boolean;
  /** Angles of at least 25° along the outline where it allows them; no triangle with all nodes on it. */
  improveBoundary?: boolean;
  rule?: "area" | "vertex";
  maxTriangles?: number;
  /** The deepest level: triangles of it stay, also where they are larger than their target. */
  maxLevel?: number;
  /** Bytes for the mesh. */
  maxMemory?: number;
}

export interface Options extends Limits {
  name?: string;
  domain: Domain;
  /** The lowest layer: a target diameter as a formula or number, or a raster of target diameters. */
  size?: string | number | Raster;
  /** The layers above it, from the bottom to the top. */
  layers?: readonly Layer[];
}

/** What an edit changed. */
export interface Change {
  /** Triangles before. */
  before: number;
  /** Triangles now. */
  triangles: number;
  /** Whether another mesh was made in place of the former one. */
  replaced: boolean;
  seconds: number;
}

/** A layer as it is. */
export interface LayerState {
  id: number;
  name: string;
  kind: Layer["kind"];
  visible: boolean;
  locked: boolean;
  combine: Combine;
}
/** A layer by its place from the bottom, the uppermost one of a name, or as `layers` has it. */
export type WhichLayer = number | string | LayerState;

/** Where a point lies. */
export type Place = "outside" | "inside" | "edge" | "node" | "invalid";
/** The words for the numbers in `where`. */
export const PLACES: readonly Place[];

/**
 * A mesh, with the sizes that it is made of. It changes where it is when they change.
 *
 * Nodes and triangles are numbered from 0, as in files. Arrays are computed when they are first asked for, and are copies:
 * an edit leaves them alone, and the next ones are other arrays. All errors are of the class `Error`; their message is a
 * sentence, and where a formula is wrong two more lines point at the mistake. An edit that fails is undone.
 */
export class Mesh {
  private constructor();
  /** Makes a mesh: that of the program for the same input, with the same fingerprint. */
  static generate(options: Options): Mesh;

  /** x and y of each node, in world units. */
  readonly nodes: Float64Array;
  /** The nodes of each triangle anticlockwise, three by three; the first two are the ends of its longest edge. */
  readonly triangles: Uint32Array;
  /** How often the coarse triangle was halved to get each triangle. */
  readonly levels: Uint8Array;
  /** The triangle opposite each corner, three by three; −1 where there is none. */
  readonly neighbours: Int32Array;
  /** The target diameter at each node. */
  readonly h: Float64Array;
  /** The pieces of the boundary; `edges` are the nodes at the ends of each edge, with the domain on the left. */
  readonly boundary: { name: string; marker: number; edges: Uint32Array }[];
  /** The rectangle of the domain. */
  readonly bounds: [number, number, number, number];
  readonly nodeCount: number;
  readonly triangleCount: number;
  /** 32 hexadecimal digits, equal for equal meshes: the `hash` of `meshbrush mesh --json`. */
  readonly fingerprint: string;
  /** The layers, from the bottom to the top. */
  readonly layers: LayerState[];

  /** Returns how many rules the mesh breaks: 0, unless the program has a mistake. */
  violations(): number;
  /** Finds the triangle around a point: the lowest of several, −1 outside. The weights are the barycentric coordinates. */
  locate(x: number, y: number): { triangle: number; weights: [number, number, number]; where: Place };
  /** Finds the triangles around points. `where` has numbers of words in `PLACES`; weights are NaN outside. */
  locateAll(points: Points): { triangles: Int32Array; weights: Float64Array; where: Uint8Array };
  /** Returns values at the nodes, one or several for each, linearly interpolated at points; NaN outside. */
  interpolate(values: Numbers, points: Points): Float64Array;

  /** Changes options. */
  update(options: Limits): Change;
  /**
   * Paints on `layer`. Without it, on the paint layer that was painted on or added last if it has the quantity, else on the
   * uppermost one that has it, and on a new one where there is none.
   */
  paint(strokes: (Stroke & { layer?: WhichLayer }) | readonly (Stroke & { layer?: WhichLayer })[]): Change;
  /** Adds a layer on top. */
  addLayer(layer: Layer): Change;
  /** Changes a layer. `place` counts from 0 at the bottom. */
  changeLayer(layer: WhichLayer, changes: { name?: string; visible?: boolean; locked?: boolean; combine?: Combine; place?: number }): Change;
  removeLayer(layer: WhichLayer): Change;
  /** Undoes the last edit, if there is one. A call that made several, as with several strokes, is undone one by one. */
  undo(): Change;
  /** Redoes the edit that was undone last, if there is one. */
  redo(): Change;
  /** Gives the memory back at once, not when the object is collected. Nothing else may be called then. */
  free(): void;
}
