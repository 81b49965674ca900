// Drives the page in Chromium as a person does, without a GPU: node tests/web.mjs FOLDER PROGRAM SCRATCH [PACKAGE]
// FOLDER has the page, PROGRAM is the desktop program, SCRATCH is a folder for files and pictures, PACKAGE has the package
// for npm. `sh tests/web` calls it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import { createRequire } from "node:module";
import path from "node:path";
import zlib from "node:zlib";

const [folder, program, scratch, npmPackage] = process.argv.slice(2).map((name) => path.resolve(name));
const { chromium } = createRequire(path.join(scratch, "x.js"))("playwright-core");
const assets = path.resolve(import.meta.dirname, "../assets");
const recording = path.resolve(import.meta.dirname, "sessions/random_gestures.jsonl");
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".png": "image/png" };
// Without a GPU Chromium emulates one for WebGL, and another one for WebGPU.
const WEBGL = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"];
const WEBGPU = [...WEBGL, "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader"];

/** Serves the folder, as any static server does. */
async function serve(folder) {
  const server = http.createServer((request, response) => {
    const name = decodeURIComponent(new URL(request.url, "http://localhost").pathname).replace(/\/$/, "/index.html");
    const file = path.join(folder, name);
    if (!file.startsWith(folder) || !fs.existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    const bytes = fs.readFileSync(file);
    response.writeHead(200, { "Content-Type": TYPES[path.extname(file)] ?? "application/octet-stream", "Content-Length": bytes.length });
    response.end(bytes);
  });
  await new Promise((resolve) => server.listen(0, resolve));
  return [server, `http://localhost:${server.address().port}/`];
}

const [server, url] = await serve(folder);
const sleep = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));
let open;
/** How long the page works on what a desktop does beside the window, in milliseconds. */
const WORK_BESIDE = 6000;

/** Opens a browser with a page, which counts its errors and notes when its first frame was drawn. */
async function browse(mode, options = {}) {
  const browser = await chromium.launch({ executablePath: browserPath, args: mode === "webgpu" ? WEBGPU : [...WEBGL, "--disable-features=WebGPU"] });
  const context = await browser.newContext({ viewport: { width: 1360, height: 800 }, acceptDownloads: true, permissions: ["clipboard-read", "clipboard-write"], ...options });
  context.on("page", (other) => { other.shot = (name) => other.screenshot({ path: path.join(scratch, `${mode}-${name}.png`) }); });
  const page = await context.newPage();
  page.problems = [];
  page.on("pageerror", (problem) => page.problems.push(String(problem)));
  page.on("console", (message) => message.type() === "error" && page.problems.push(message.text()));
  await page.addInitScript(() => {
    const getContext = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      const context = getContext.call(this, kind, ...rest);
      window.glContext = kind === "webgl2" && context ? context : window.glContext;
      return context;
    };
    if (window.GPUAdapter) {
      const requestDevice = GPUAdapter.prototype.requestDevice;
      GPUAdapter.prototype.requestDevice = async function (...of) {
        return (window.gpuDevice = await requestDevice.apply(this, of));
      };
    }
    const request = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (frame) =>
      request((time) => {
        const began = performance.now();
        frame(time);
        const took = performance.now() - began;
        if (took > 5) {
          window.firstFrame ??= performance.now();
        }
      });
  });
  page.shot = (name) => page.screenshot({ path: path.join(scratch, `${mode}-${name}.png`) });
  open = { browser, page };
  return open;
}

const fingerprint = (page) => page.evaluate(() => window.meshbrush?.fingerprint());
const message = (page) => page.evaluate(() => window.meshbrush?.message());

/** Waits until the mesh follows the document, and stays so for a while. */
async function settled(page) {
  await page.waitForFunction(() => window.meshbrush?.fingerprint(), null, { timeout: 90_000, polling: 50 });
  for (let last, same = 0; same < 6; ) {
    const now = await fingerprint(page);
    same = now && now === last ? same + 1 : 0;
    last = now;
    await sleep(50);
  }
  return fingerprint(page);
}

async function until(what, condition) {
  for (let tries = 0; tries < 600; tries++) {
    const value = await condition();
    if (value) {
      return value;
    }
    await sleep(50);
  }
  await open.page.shot("failed").catch(() => {}); // it may be closed
  throw new Error(`${what}: waited for 30 s in vain`);
}

/** Waits until the storage of the browser has unsaved work. Returns how long that took, in milliseconds. */
async function kept(page) {
  const began = Date.now();
  const hasWork = () => page.evaluate(() => new Promise((done) => {
    const request = indexedDB.open("meshbrush", 1);
    request.onsuccess = () => {
      const count = request.result.transaction("work").objectStore("work").count();
      count.onsuccess = () => {
        request.result.close();
        done(count.result > 0);
      };
    };
  }));
  await until("the work is kept", hasWork);
  return Date.now() - began;
}

/** Opens an example in the place of another document, and returns the fingerprint of its mesh. */
async function openedExample(page, name) {
  const before = await settled(page);
  await page.evaluate((name) => window.meshbrush.openExample(name), name);
  await until("the example is opened", async () => (await fingerprint(page)) !== before);
  return settled(page);
}

/** Returns the fingerprint that the desktop program finds for the bytes of a project. */
function onDesktop(bytes) {
  const file = path.join(scratch, "from-page.meshbrush");
  fs.writeFileSync(file, bytes);
  return JSON.parse(execFileSync(program, ["mesh", "--project", file, "--json"], { encoding: "utf8", maxBuffer: 1 << 26 })).hash;
}

const projectOf = async (page) => Buffer.from(await page.evaluate(() => Array.from(window.meshbrush.project())));

async function paint(page, from = [300, 350], steps = 60) {
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let step = 0; step < steps; step++) {
    await page.mouse.move(from[0] + 8 * step, from[1] + 60 * Math.sin(step / 8));
    await sleep(16);
  }
  await page.mouse.up();
}

/** Drags the goal of the path of the example around. */
async function dragGoal(page) {
  await page.mouse.move(817, 174);
  await page.mouse.down();
  for (let step = 0; step < 60; step++) {
    await page.mouse.move(817 - 4 * step, 174 + 2 * step);
    await sleep(16);
  }
  await page.mouse.up();
}

function times(list) {
  const sorted = list.filter((time) => time > 1).sort((a, b) => a - b); // the others drew nothing
  if (sorted.length === 0) {
    return "no frame";
  }
  const at = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))].toFixed(1);
  const long = sorted.filter((time) => time > 50).length;
  return `median ${at(0.5)} ms, 95 % ${at(0.95)} ms, worst ${at(1)} ms, ${long} of ${sorted.length} frames over 50 ms`;
}

/** Returns how long the page's thread computed in each frame while something is done: other work of the machine does not count. */
async function framesOf(browser, act) {
  const cdp = await browser.newBrowserCDPSession();
  const events = [];
  cdp.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  await cdp.send("Tracing.start", { traceConfig: { includedCategories: ["devtools.timeline"], excludedCategories: ["*"] }, transferMode: "ReportEvents" });
  await act();
  const complete = new Promise((resolve) => cdp.once("Tracing.tracingComplete", resolve));
  await cdp.send("Tracing.end");
  await complete;
  await cdp.detach();
  return events.filter((event) => event.name === "FireAnimationFrame" && event.tdur !== undefined).map((event) => event.tdur / 1000);
}

/** Drops files on the page. */
async function drop(page, names) {
  const files = names.map((name) => [path.basename(name), fs.readFileSync(name).toString("base64")]);
  await page.evaluate((files) => {
    const data = new DataTransfer();
    for (const [name, base64] of files) {
      data.items.add(new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], name));
    }
    const canvas = document.querySelector("canvas");
    for (const type of ["dragenter", "dragover", "drop"]) {
      canvas.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
    }
  }, files);
}

const tests = {
  async "each example has the mesh of the desktop"({ page, mode }) {
    await page.goto(url);
    await settled(page);
    console.log(`    first frame after ${await page.evaluate(() => Math.round(window.firstFrame))} ms`);
    const names = await page.evaluate(() => window.meshbrush.constructor.examples());
    for (const name of names) {
      // Painted work of one example is not offered in the next one.
      const { browser, page } = await browse(mode);
      await page.goto(url);
      const before = await settled(page);
      let found;
      const opening = await framesOf(browser, async () => {
        await page.evaluate((name) => window.meshbrush.openExample(name), name);
        await until("it is opened", async () => name === names[0] || (await fingerprint(page)) !== before);
        found = await settled(page);
        await sleep(WORK_BESIDE);
      });
      assert.equal(found, onDesktop(await projectOf(page)), name);
      await page.shot(`example-${name.replace(/\W+/g, "-")}`);
      const painting = await framesOf(browser, () => paint(page));
      await settled(page);
      const afterwards = await framesOf(browser, () => sleep(WORK_BESIDE));
      console.log(`    ${name}: ${found}\n      opening ${times(opening)}\n      painting ${times(painting)}\n      afterwards ${times(afterwards)}`);
      if (name === "Threats and a path") {
        await page.mouse.click(26, 250); // the tool Path
        console.log(`      dragging the goal ${times(await framesOf(browser, () => dragGoal(page)))}`);
      }
      assert.deepEqual(page.problems, [], name);
      await browser.close();
    }
  },

  async "a stroke is painted, undone and done again"({ page }) {
    await page.goto(url);
    const before = await settled(page);
    await paint(page);
    const painted = await settled(page);
    assert.notEqual(painted, before);
    assert.equal(painted, onDesktop(await projectOf(page)));
    await page.keyboard.press("Control+z");
    await until("undo", async () => (await fingerprint(page)) === before);
    await page.keyboard.press("Control+Shift+z");
    await until("redo", async () => (await fingerprint(page)) === painted);
  },

  async "work is offered again after a reload"({ page }) {
    await page.goto(url);
    await settled(page);
    await paint(page);
    const painted = await settled(page);
    const pause = await kept(page);
    console.log(`    unsaved work is kept after ${pause} ms`);
    assert.ok(pause < 10_500, "it is kept half a second after an edit, or 10 s later at the latest");
    await page.reload();
    const fresh = await settled(page);
    assert.notEqual(fresh, painted);
    await sleep(2000);
    await page.shot("restore");
    await page.keyboard.press("Enter");
    await until("the work is restored", async () => (await fingerprint(page)) === painted);
  },

  async "a saved project is a download that the desktop opens"({ page }) {
    await page.goto(url);
    await settled(page);
    await paint(page);
    const painted = await settled(page);
    await page.keyboard.press("Control+s");
    await sleep(500);
    await page.shot("save");
    const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
    assert.equal(download.suggestedFilename(), "Radar threats.meshbrush");
    assert.equal(onDesktop(fs.readFileSync(await download.path())), painted);
    // Saved again, it goes to the same file without a question; and nothing is offered after a reload.
    const [again] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Control+s")]);
    assert.equal(again.suggestedFilename(), "Radar threats.meshbrush");
    await sleep(1000);
    await page.reload();
    await settled(page);
    await page.keyboard.press("Enter");
    await sleep(500);
    assert.notEqual(await fingerprint(page), painted);
  },

  async "a mesh is exported as the desktop writes it"({ page }) {
    await page.goto(url);
    await settled(page);
    await openedExample(page, "The report's diamond");
    const project = path.join(scratch, "diamond.meshbrush");
    fs.writeFileSync(project, await projectOf(page));
    await page.keyboard.press("Control+e");
    await sleep(500);
    await page.keyboard.press("Control+a");
    await page.keyboard.type("diamond.msh");
    await page.shot("export");
    const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
    const expected = path.join(scratch, "diamond.msh");
    execFileSync(program, ["mesh", "--project", project, "-o", expected], { stdio: "ignore" });
    const lines = (file) => fs.readFileSync(file, "latin1").split("\n").length;
    assert.equal(lines(await download.path()), lines(expected));
  },

  async "a recipe is dropped with its rasters, and alone it names what is missing"({ page }) {
    await page.goto(url);
    await settled(page);
    const example = await openedExample(page, "Celtic Sea with depths");
    await page.reload();
    await settled(page);
    await drop(page, [path.join(assets, "celtic_sea.toml")]);
    const problem = await until("a sentence", () => message(page));
    assert.match(problem, /celtic_sea\.geojson/);
    await drop(page, ["celtic_sea.toml", "celtic_sea.geojson", "celtic_sea_depths.tif"].map((name) => path.join(assets, name)));
    await until("the recipe is shown", async () => (await fingerprint(page)) === example);
    await page.shot("dropped");
  },

  async "a file is chosen in the browser's dialog"({ page }) {
    await page.goto(url);
    await settled(page);
    const shown = await openedExample(page, "Threats and a path");
    const file = path.join(scratch, "chosen.meshbrush");
    fs.writeFileSync(file, await projectOf(page));
    await page.reload();
    await settled(page);
    const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.keyboard.press("Control+o")]);
    await chooser.setFiles([file]);
    await sleep(500);
    await until("the project is shown", async () => (await fingerprint(page)) === shown);
  },

  async "a link has the same mesh, and one that is no good is a sentence"({ page }) {
    await page.goto(url);
    await settled(page);
    const shown = await openedExample(page, "Threats and a path");
    const link = await page.evaluate(() => window.meshbrush.link());
    const visit = async (hash) => {
      await page.goto("about:blank");
      await page.goto(`${url}#${hash}`);
      return settled(page);
    };
    assert.equal(await visit(link), shown);
    for (const [hash, words] of [
      [link.slice(0, -9), /The link is damaged/],
      ["nonsense", /The link is damaged/],
      [link.replace("1.", "9."), /newer Meshbrush/],
      [`1.${"A".repeat(1_000_000)}`, /The link is damaged/],
    ]) {
      const empty = await visit(hash);
      assert.match(await until("a sentence", () => message(page)), words);
      await paint(page);
      await until("the empty document is painted", async () => { const now = await fingerprint(page); return now && now !== empty; });
    }
  },

  async "a recording, done again from a link, has the meshes of the desktop"({ page }) {
    const [, start, ...edits] = fs.readFileSync(recording, "utf8").trim().split("\n").map((line) => JSON.parse(line));
    for (let count = edits.length; count > 0; count -= 9) {
      const gestures = { start: start.start, edits: edits.slice(0, count).map((edit) => edit.does) };
      const packed = zlib.deflateSync(JSON.stringify(gestures), { level: 9 }).toString("base64url");
      await page.goto("about:blank");
      await page.goto(`${url}#1.g.${packed}.${Buffer.from("{}").toString("base64url")}`);
      assert.equal(await settled(page), edits[count - 1].gives.mesh.fingerprint, `after ${count} edits`);
      assert.equal((await message(page)) ?? "", "");
    }
  },

  async "pages embed it: a slide, an article, a comparison"({ page }) {
    const frames = async (count) => {
      await until("the frames", () => page.frames().length === count + 1);
      for (const frame of page.frames().slice(1)) {
        await frame.waitForFunction(() => window.meshbrush?.fingerprint(), null, { timeout: 60_000 });
      }
      return page.frames().slice(1);
    };
    await page.goto(`${url}slide.html`);
    await frames(1);
    await sleep(1500);
    await page.click("#forward");
    await sleep(1000);
    await page.shot("slide");
    await page.goto(`${url}article.html`);
    const [mesh] = await frames(1);
    const triangles = () => mesh.evaluate(() => window.meshbrush.triangles());
    await sleep(1000);
    const before = await triangles();
    await page.fill("#size", "7");
    await until("a finer mesh", async () => (await triangles()) > 2 * before);
    await page.shot("article");
    // The wheel moves the page until the canvas is clicked.
    await page.evaluate(() => { document.body.style.height = "3000px"; });
    await page.mouse.move(400, 400);
    await page.mouse.wheel(0, 300);
    await until("the page scrolls", () => page.evaluate(() => window.scrollY > 0));
    await page.goto(`${url}comparison.html`);
    const both = await frames(2);
    await sleep(2000);
    const prints = await Promise.all(both.map((frame) => frame.evaluate(() => window.meshbrush.fingerprint())));
    assert.notEqual(prints[0], prints[1]);
    await page.shot("comparison");
  },

  async "fingers: one paints, two move and zoom the view"({ mode }) {
    const { page } = await browse(mode, { hasTouch: true });
    await page.goto(url);
    const before = await settled(page);
    const cdp = await page.context().newCDPSession(page);
    const touch = async (type, ...points) => {
      await cdp.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
      await sleep(20);
    };
    const picture = async () => { await sleep(600); return (await page.screenshot()).toString("base64"); };
    const fitted = await picture();
    await touch("touchStart", [420, 400]);
    await touch("touchMove", [422, 401]);
    await touch("touchStart", [422, 401], [520, 400]);
    for (let step = 1; step < 20; step++) {
      await touch("touchMove", [422 - 6 * step, 401], [520 + 6 * step, 400]);
    }
    await touch("touchEnd");
    assert.equal(await settled(page), before, "nothing was painted");
    assert.notEqual(await picture(), fitted, "the view has moved");
    await page.shot("fingers");
    await touch("touchStart", [400, 380]);
    for (let step = 1; step < 20; step++) {
      await touch("touchMove", [400 + 8 * step, 380]);
    }
    await touch("touchEnd");
    const painted = await settled(page);
    assert.notEqual(painted, before);
    assert.equal(painted, onDesktop(await projectOf(page)));
    await page.keyboard.press("Control+z");
    await until("one stroke is undone", async () => (await fingerprint(page)) === before);
    assert.deepEqual(page.problems, []);
    await page.context().browser().close();
  },

  async "a pen paints broader the harder it is pressed"({ page }) {
    await page.goto(url);
    const before = await settled(page);
    const triangles = () => page.evaluate(() => window.meshbrush.triangles());
    const unpainted = await triangles();
    const cdp = await page.context().newCDPSession(page);
    const pen = (type, x, force) => cdp.send("Input.dispatchMouseEvent", {
      type, x, y: 640, force, button: "left", buttons: type === "mouseReleased" ? 0 : 1, clickCount: 1, pointerType: "pen",
    });
    const stroke = async (force) => {
      await pen("mousePressed", 300, force);
      for (let x = 304; x < 420; x += 4) {
        await pen("mouseMoved", x, force);
        await sleep(16);
      }
      await pen("mouseReleased", 420, 0);
      await settled(page);
      const added = (await triangles()) - unpainted;
      await page.shot(`pen-${force}`);
      await page.keyboard.press("Control+z");
      await until("undo", async () => (await fingerprint(page)) === before);
      return added;
    };
    const [light, firm] = [await stroke(0.2), await stroke(0.9)];
    assert(light > 0 && firm > 2 * light, `${light} and ${firm} triangles more`);
  },

  async "a lost graphics device is a sentence, and the work is offered again"({ page, mode }) {
    await page.goto(url);
    await settled(page);
    await paint(page);
    const painted = await settled(page);
    await page.evaluate(() => {
      window.lost = window.gpuDevice ? window.gpuDevice.destroy() : window.glContext.getExtension("WEBGL_lose_context").loseContext();
    });
    await until("a sentence", async () => /lost its graphics device/.test(await page.textContent("#text")));
    assert(await page.isVisible("#text"));
    await page.shot("lost");
    await sleep(1500);
    page.problems = []; // the browser's own words about it
    await page.reload();
    await settled(page);
    await sleep(2500);
    await page.keyboard.press("Enter");
    await until("the work is restored", async () => (await fingerprint(page)) === painted);
  },

  async "two tabs keep their own work, and only what was left behind is offered"({ page }) {
    await page.goto(url);
    const fresh = await settled(page);
    await paint(page);
    const first = await settled(page);
    const context = page.context();
    const open = async () => {
      const other = await context.newPage();
      await other.goto(url);
      assert.equal(await settled(other), fresh);
      await sleep(2500);
      return other;
    };
    const other = await open();
    await other.keyboard.press("Enter");
    await sleep(300);
    assert.equal(await fingerprint(other), fresh, "the work of a tab that lives is not offered");
    await paint(other, [300, 500], 30);
    const second = await settled(other);
    await sleep(1500);
    await page.close();
    await other.close();
    await sleep(2500); // a busy browser holds the locks of closed tabs for a while
    // Both are offered, one after the other.
    const third = await open();
    await third.keyboard.press("Enter");
    await until("one is restored", async () => [first, second].includes(await fingerprint(third)));
    await sleep(1500);
    await third.close();
    await sleep(2500);
    const fourth = await open();
    await fourth.keyboard.press("Enter");
    await until("one is restored", async () => [first, second].includes(await fingerprint(fourth)));
    const again = await fingerprint(fourth);
    await sleep(2500);
    await fourth.keyboard.press("Enter"); // the other one: the window asks whether to save the first
    await sleep(2500);
    await fourth.shot("two-tabs");
    await fourth.mouse.click(538, 432); // “Do not save”
    const left = again === first ? second : first;
    await until("the other is restored", async () => (await fingerprint(fourth)) === left);
  },

  async "a tab in the background finishes its mesh and keeps its work"({ page }) {
    await page.goto(url);
    const fresh = await settled(page);
    await paint(page);
    // Another tab is brought to the front at once, before the work is kept.
    const front = await page.context().newPage();
    await front.bringToFront();
    await page.evaluate(() => {
      Object.defineProperty(document, "hidden", { get: () => true });
      Object.defineProperty(document, "visibilityState", { get: () => "hidden" });
      document.dispatchEvent(new Event("visibilitychange"));
      window.dispatchEvent(new Event("blur"));
    });
    const painted = await settled(page);
    assert.notEqual(painted, fresh);
    await sleep(2500);
    await page.close();
    const next = await page.context().newPage();
    await next.goto(url);
    await settled(next);
    await sleep(2500);
    await next.keyboard.press("Enter");
    await until("the work is restored", async () => (await fingerprint(next)) === painted);
  },

  // BACKGROUND_MINUTES=60 leaves it there for an hour.
  async "a tab that was frozen in the background goes on where it was"({ page }) {
    await page.goto(url);
    const fresh = await settled(page);
    await paint(page);
    const painted = await settled(page);
    await paint(page, [300, 500]);
    const client = await page.context().newCDPSession(page);
    const front = await page.context().newPage();
    await front.bringToFront();
    // The browser stops it in the middle of its work.
    await client.send("Page.setWebLifecycleState", { state: "frozen" });
    await sleep(60_000 * Number(process.env.BACKGROUND_MINUTES ?? 0.1));
    await client.send("Page.setWebLifecycleState", { state: "active" });
    await page.bringToFront();
    const twice = await settled(page);
    assert.ok(twice !== painted && twice === onDesktop(await projectOf(page)));
    await page.keyboard.press("Control+z");
    await until("undo", async () => (await fingerprint(page)) === painted);
    await page.keyboard.press("Control+z");
    await until("undo", async () => (await fingerprint(page)) === fresh);
    await paint(page);
    assert.equal(await settled(page), painted, "the same stroke");
  },

  async "an example that the server does not send is a sentence, and can be opened later"({ page }) {
    await page.route("**/assets/**", (route) => route.fulfill({ status: 404, body: "" }));
    await page.goto(url);
    const before = await settled(page);
    await page.evaluate(() => window.meshbrush.openExample("Aegean Sea"));
    assert.match(await until("a sentence", () => message(page)), /“Aegean Sea” could not be loaded.*aegean_sea\.geojson \(404/);
    await page.shot("not-sent");
    assert.equal(await fingerprint(page), before, "the document stays");
    await page.unroute("**/assets/**");
    page.problems = []; // the browser's own words about it
    await page.evaluate(() => window.meshbrush.openExample("Aegean Sea"));
    await until("it is opened", async () => { const now = await fingerprint(page); return now && now !== before; });
  },

  async "a link has the view, the tool and the step"({ page }) {
    const parsed = async () => {
      const link = await page.evaluate(() => window.meshbrush.link());
      const [, , , view] = link.split(".");
      return [link, JSON.parse(Buffer.from(view ?? "", "base64url").toString() || "{}")];
    };
    await page.goto(url);
    await settled(page);
    const shown = await openedExample(page, "The report's diamond");
    await page.keyboard.press("h");
    await page.mouse.move(500, 400);
    await page.mouse.wheel(0, -600);
    await sleep(500);
    await page.keyboard.press("F10");
    await until("the steps", async () => { await page.evaluate(() => window.meshbrush.step(3)); return (await parsed())[1].step >= 9; });
    const [link, view] = await parsed();
    await page.goto("about:blank");
    await page.goto(`${url}#${link}`);
    await until("the step", async () => (await page.evaluate(() => window.meshbrush?.fingerprint())) && (await parsed())[1].step === view.step);
    assert.equal(await settled(page), shown);
    const [, again] = await parsed();
    assert.equal(again.tool, view.tool);
    assert.ok(view.tool && view.area && view.area.every((side, n) => Math.abs(side - again.area[n]) < 1e-6 * (view.area[2] - view.area[0])), JSON.stringify([view, again]));
  },

  async "a painted example is sent as its gestures"({ page }) {
    await page.goto(url);
    await settled(page);
    await paint(page);
    await settled(page);
    await paint(page, [400, 500]);
    const painted = await settled(page);
    const link = await page.evaluate(() => window.meshbrush.link());
    console.log(`    ${link.length} characters`);
    assert.match(link.slice(0, 4), /^2\.g\./);
    await page.goto("about:blank");
    await page.goto(`${url}#${link}`);
    assert.equal(await settled(page), painted);
    assert.equal(onDesktop(await projectOf(page)), painted);
  },

  async "a page paints strokes, takes pictures and hears events"({ page }) {
    await page.goto(url);
    const before = await settled(page);
    await page.evaluate(() => {
      window.heard = { complete: [], changed: [], message: [], step: [] };
      for (const [event, list] of Object.entries(window.heard)) {
        // What is told may ask the program.
        window.meshbrush.on(event, (detail) => list.push({ ...detail, fingerprint: window.meshbrush.fingerprint() }));
      }
      window.unheard = () => { throw new Error("it was taken off"); };
      window.meshbrush.on("changed", window.unheard);
      window.meshbrush.off("changed", window.unheard);
    });
    const picture = async () => Buffer.from(await page.evaluate(() => Array.from(window.meshbrush.picture(320, 200))));
    const first = await picture();
    assert.deepEqual([first.toString("latin1", 1, 4), first.readUInt32BE(16), first.readUInt32BE(20)], ["PNG", 320, 200]);
    await page.evaluate(() => window.meshbrush.paint(Float64Array.of(0.4, 0.4, 1, 0.5, 0.6, 0.5, 0.7, 0.4, 0.2)));
    const painted = await until("another mesh", async () => { const now = await fingerprint(page); return now && now !== before && now; });
    assert.equal(await settled(page), onDesktop(await projectOf(page)));
    assert.notDeepEqual(await picture(), first);
    const { complete, changed } = await page.evaluate(() => window.heard);
    assert.equal(complete.at(-1).fingerprint, painted);
    assert.equal(complete.at(-1).triangles, await page.evaluate(() => window.meshbrush.triangles()));
    assert.equal(changed.at(-1).name, "Radar threats");
    await page.keyboard.press("F10");
    await until("steps", () => page.evaluate(() => window.heard.step.length > 0));
    await page.evaluate(() => window.meshbrush.step(2));
    await until("a step", () => page.evaluate(() => window.heard.step.at(-1).step === 2 && window.heard.step.at(-1).steps > 2));
    await page.evaluate(() => window.meshbrush.open("wrong.toml", new Uint8Array(3)));
    await until("a message", () => page.evaluate(() => window.heard.message.at(-1)?.failed));
    for (const [wrong, words] of [
      ["paint(Float64Array.of(1, 2))", /x, y and pressure/], ["paint(new Float64Array())", /x, y and pressure/],
      ["paint(Float64Array.of(NaN, 0, 1))", /x, y and pressure/], ["paint(Float64Array.of(0, 0, 2))", /x, y and pressure/],
      ["picture(0, 5)", /impossible/], ["picture(5, 99999)", /impossible/], ["on('other', () => {})", /no event “other”/],
    ]) {
      assert.match(await page.evaluate((wrong) => { try { eval(`window.meshbrush.${wrong}`); return "no error"; } catch (problem) { return problem.message; } }, wrong), words);
    }
  },

  async "the example page of the package follows the pointer"({ page }) {
    if (!npmPackage) {
      return;
    }
    const [server, url] = await serve(npmPackage);
    await page.goto(`${url}example.html`);
    const text = () => page.textContent("#text");
    await until("a mesh", async () => /triangles/.test(await text()));
    const before = Number.parseInt(await text(), 10);
    await page.mouse.move(200, 500);
    await page.mouse.down();
    await page.mouse.move(350, 520, { steps: 8 });
    await page.mouse.up();
    await until("a finer mesh", async () => Number.parseInt(await text(), 10) > before);
    await page.shot("package");
    page.problems = page.problems.filter((problem) => !/favicon|404/.test(problem));
    server.close();
  },

  async "a small screen, a dense one, and a second tab"({ page, browser }) {
    await page.goto(url);
    await page.setViewportSize({ width: 360, height: 640 });
    await settled(page);
    await sleep(500);
    await page.shot("small");
    const dense = await browser.newContext({ viewport: { width: 1000, height: 600 }, deviceScaleFactor: 3 });
    const other = await dense.newPage();
    await other.goto(url);
    await settled(other);
    await other.screenshot({ path: path.join(scratch, "dense.png") });
  },

  async "without storage one is told once, and can paint and save"({ page }) {
    await page.addInitScript(() => { IDBFactory.prototype.open = () => { throw new Error("storage is switched off"); }; });
    await page.goto(url);
    await settled(page);
    assert.match(await until("a sentence", () => message(page)), /not kept in the storage of the browser/);
    await paint(page);
    await settled(page);
  },

  async "a page from a file, or without WebAssembly or drawing, is a sentence"({ page }) {
    const text = () => page.textContent("#text");
    await page.goto(`file://${folder}/index.html`);
    assert.match(await text(), /does not run programs from a file/);
    await page.addInitScript(() => { if (location.search === "?none") { delete window.WebAssembly; } });
    await page.goto(`${url}?none`);
    await until("a sentence", async () => /WebAssembly/.test(await text()));
    await page.addInitScript(() => {
      if (location.search === "?blind") {
        HTMLCanvasElement.prototype.getContext = () => null;
        Object.defineProperty(navigator, "gpu", { value: undefined });
      }
    });
    await page.goto(`${url}?blind`);
    await until("a sentence", async () => /neither with WebGPU nor with WebGL/.test(await text()));
    page.problems = []; // the browser's own words about it
  },
};

const wanted = process.env.ONLY;
let failed = 0;
for (const mode of process.env.MODES?.split(" ") ?? ["webgl", "webgpu"]) {
  for (const [name, test] of Object.entries(tests)) {
    if (wanted && !name.includes(wanted)) {
      continue;
    }
    const began = Date.now();
    const { browser, page } = await browse(mode);
    try {
      await test({ page, browser, mode });
      assert.deepEqual(page.problems, [], "errors on the console");
      console.log(`ok   ${mode}: ${name} (${Date.now() - began} ms)`);
    } catch (problem) {
      failed++;
      await page.shot("failed").catch(() => {});
      console.log(`FAIL ${mode}: ${name}\n  ${problem.stack ?? problem}`);
      console.log(page.problems.join("\n"));
    }
    await browser.close();
  }
}
server.close();
process.exit(failed > 0 ? 1 : 0);
