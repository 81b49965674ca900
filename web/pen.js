// The pressure of a pen. Browsers tell of it in pointer events only, and egui's part for browsers does not pass it on.

let pressure; // 0 to 1; -1: it was lifted; undefined: nothing new

const note = (event) => {
  if (event.pointerType === "pen") {
    pressure = event.buttons === 0 ? -1 : event.pressure;
  }
};
for (const type of ["pointerdown", "pointermove", "pointerup", "pointercancel"]) {
  window.addEventListener(type, note, { capture: true });
}

/** Returns what is new since the last question. */
export function pen() {
  const news = pressure;
  pressure = undefined;
  return news;
}
