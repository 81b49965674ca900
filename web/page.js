// Loads the program, and shows how far that is. Whatever goes wrong is a sentence on the page.

const canvas = document.getElementById("canvas");
const cover = document.getElementById("cover");
const bar = document.getElementById("bar");
const text = document.getElementById("text");
const MODULE = "meshbrush_bg.wasm";

/** Covers the page with a sentence. */
function say(sentence) {
  bar.hidden = true;
  text.textContent = sentence;
  cover.hidden = false;
}

const megabytes = (bytes) => (bytes / 1e6).toFixed(1);

/** Returns a response whose body moves the bar. `bytes` is the size of the module, 0 if it is not known. */
function metered(response, bytes) {
  let loaded = 0;
  const counter = new TransformStream({
    transform(chunk, controller) {
      loaded += chunk.byteLength;
      if (bytes > 0) {
        bar.max = bytes;
        bar.value = loaded;
      }
      const of = bytes > 0 ? ` of ${megabytes(bytes)}` : "";
      text.textContent = `Meshbrush is being loaded: ${megabytes(loaded)}${of} MB.`;
      controller.enqueue(chunk);
    },
  });
  return new Response(response.body.pipeThrough(counter), { headers: { "Content-Type": "application/wasm" } });
}

/** Says when the browser takes away what the canvas is drawn with: nothing more can be seen on it then. */
function watchDevice() {
  const lost = () => say("The browser has lost its graphics device. Load the page again: unsaved work is kept and is then offered.");
  canvas.addEventListener("webglcontextlost", lost);
  const adapter = globalThis.GPUAdapter?.prototype;
  const requestDevice = adapter?.requestDevice;
  if (requestDevice) {
    adapter.requestDevice = async function (...options) {
      const device = await requestDevice.apply(this, options);
      device.lost.then(lost);
      return device;
    };
  }
}

async function load() {
  if (typeof WebAssembly !== "object") {
    throw new Error("This browser runs no WebAssembly, or it is switched off. Use a newer browser, or allow it for this page.");
  }
  const { default: init, Meshbrush } = await import("./meshbrush.js");
  const response = await fetch(MODULE);
  if (!response.ok) {
    throw new Error(`The program could not be loaded (${response.status} ${response.statusText}). Load the page again later.`);
  }
  // The server may compress: then the header counts other bytes than those that arrive.
  const packed = response.headers.has("Content-Encoding");
  const bytes = packed ? 0 : Number(response.headers.get("Content-Length"));
  await init({ module_or_path: metered(response, bytes) });
  text.textContent = "Meshbrush starts.";
  watchDevice();
  canvas.hidden = false;
  const meshbrush = new Meshbrush();
  await meshbrush.start(canvas);
  window.meshbrush = meshbrush;
  const asked = new URLSearchParams(location.search);
  if (asked.has("embed")) {
    embed(meshbrush, asked.get("embed"), asked.get("theme"));
  } else {
    canvas.focus();
  }
  if (asked.has("example")) {
    meshbrush.openExample(asked.get("example"));
  }
  if (asked.has("figure")) {
    meshbrush.openFigure(Number(asked.get("figure")));
  }
  cover.hidden = true;
  window.dispatchEvent(new Event("meshbrush"));
}

/**
 * Leaves the canvas alone, or with the strip of the tool (`?embed=tool`), in the theme of the page around it (`&theme=dark`). Wheel
 * and keys belong to that page until the canvas is clicked.
 */
function embed(meshbrush, strip, theme) {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const follow = () => meshbrush.embed(strip === "tool", theme ? theme === "dark" : dark.matches);
  follow();
  dark.addEventListener("change", follow);
  let clicked = false;
  window.addEventListener("pointerdown", () => { clicked = true; }, { capture: true });
  window.addEventListener("blur", () => { clicked = false; });
  for (const type of ["wheel", "keydown", "keyup"]) {
    window.addEventListener(type, (event) => clicked || event.stopImmediatePropagation(), { capture: true });
  }
}

window.addEventListener("error", (event) => {
  if (event.error instanceof WebAssembly.RuntimeError) {
    say("Meshbrush has stopped: the tab ran out of memory, or there is a bug. Load the page again.");
  }
});

if (location.protocol !== "file:") {
  load().catch((problem) => say(String(problem?.message ?? problem)));
}
