// The package in Node.js, which reads the module from the disk.

import { readFile } from "node:fs/promises";
import load from "./index.js";

export * from "./index.js";

/** Loads the module, once. */
export default async function init(source) {
  await load(source ?? (await readFile(new URL("./core_bg.wasm", import.meta.url))));
}
