// What the page shows, its state, which is also its link, and small helpers.

const page = JSON.parse(document.getElementById("data").textContent);
const REFERENCE = "ref"; // the key of a scene's reference where a cell's number stands otherwise

const defaults = {
  scene: "0", contest: "", seed: "0", mode: "side", pictures: "", left: "", right: "", show: "picture", formula: "signed",
  against: REFERENCE, epsilon: "0.01", layer: "caustic", tone: "colour", exposure: "", low: "", high: "", scale: "log",
  pixel: "", region: "", view: "", split: "0.5", crops: "", metric: "rmse", cost: "work_s", place: "error", hidden: "",
  map: "", spread: "", rows: "cells", sort: "", filter: "", columns: "", theme: "",
};
const state = {...defaults};
const listeners = [];

/** Calls `draw` with the names of what changed, now and whenever the state does. */
function onChange(draw) { listeners.push(draw); }

/** Changes the state, the link and all that shows it. */
function change(values) {
  const names = Object.keys(values).filter((name) => state[name] !== String(values[name]));
  for (const name of names) state[name] = String(values[name]);
  if (names.length === 0) return;
  writeLink();
  redraw(new Set(names));
}

let pending = null;
function redraw(names) {
  if (pending) { for (const name of names) pending.add(name); return; }
  pending = new Set(names);
  requestAnimationFrame(() => {
    const changed = pending;
    pending = null;
    for (const draw of listeners) draw(changed);
  });
}

function writeLink() {
  const words = Object.keys(defaults).filter((name) => state[name] !== defaults[name])
    .map((name) => `${name}=${encodeURIComponent(state[name])}`);
  history.replaceState(null, "", `#${words.join("&")}`);
}

/** Takes the state from the link; unknown words are ignored, so that links of other versions open. */
function readLink() {
  Object.assign(state, defaults);
  for (const word of location.hash.slice(1).split("&")) {
    const [name, value = ""] = word.split("=");
    if (name in defaults) state[name] = decodeURIComponent(value);
  }
  if (!page.scenes[Number(state.scene)]) state.scene = "0";
}

function scene() { return page.scenes[Number(state.scene)]; }

/** Another scene has its own pictures and places. */
function chooseScene(i) {
  const own = ["pictures", "left", "right", "contest", "crops", "pixel", "region", "view", "spread", "against", "hidden", "low", "high"];
  change({...Object.fromEntries(own.map((name) => [name, defaults[name]])), scene: i});
}

/** A number as people read it: four digits. */
function short(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(Math.max(0, digits - 1)) : value.toPrecision(digits);
  return text.replace("-", "−").replace(/e\+?(.*)$/, (_, power) => ` · 10${superscript(power)}`);
}

function superscript(text) {
  return text.replace(/[-−]/, "⁻").replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]);
}

/** Mean ± half its interval. */
function withInterval(error) {
  if (!error) return "–";
  return error[1] === null ? short(error[0]) : `${short(error[0])} ± ${short(error[1], 2)}`;
}

/** An element with attributes (on… are listeners) and children (texts or elements). */
function make(name, attributes = {}, ...children) {
  const svg = ["svg", "g", "path", "line", "rect", "circle", "polyline", "polygon", "text", "tspan", "image", "title",
    "clipPath", "defs"].includes(name);
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

function byId(id) { return document.getElementById(id); }

/** A control bound to one word of the state: a select of [value, text] pairs. */
function choice(name, label, options, title = "") {
  const select = make("select", {id: `choose-${name}`, onchange: () => change({[name]: select.value})},
    options.map(([value, text]) => make("option", {value}, text)));
  onChange(() => { if (select.value !== state[name]) select.value = state[name]; });
  select.value = state[name];
  return make("label", {title}, `${label} `, select);
}

/** A number typed into the state; empty means: chosen by the page. */
function typed(name, label, title, step = "any") {
  const input = make("input", {id: `type-${name}`, type: "number", step, placeholder: "auto",
    onchange: () => change({[name]: input.value})});
  onChange(() => { if (document.activeElement !== input) input.value = state[name]; });
  input.value = state[name];
  return make("label", {title}, `${label} `, input);
}

function button(text, run, title = "", attributes = {}) {
  return make("button", {type: "button", title, onclick: run, ...attributes}, text);
}

/** Offers a text as a file to keep. */
function download(name, text, type = "image/svg+xml") {
  const link = make("a", {href: URL.createObjectURL(new Blob([text], {type})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

async function copy(text, from) {
  try {
    await navigator.clipboard.writeText(text);
  } catch (refused) { // without the right to the clipboard the older way may still do
    const area = make("textarea", {style: "position:fixed;opacity:0"}, text);
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
    from?.focus();
  }
  byId("status").textContent = `copied: ${text}`;
}

/** Signs of a method that do not need colour: a marker, and a dash for its lines. */
const METHODS = page.methods; // the two that the project compares first, then the others
function rank(method) { return METHODS.indexOf(method); }
const MARKERS = ["●", "■", "▲", "◆", "▼", "✚", "✖"];
function methodSign(method) { return MARKERS[METHODS.indexOf(method) % MARKERS.length]; }
function methodColour(method) { return `var(--method-${METHODS.indexOf(method) % 7})`; }

function labelOf(key) {
  if (key === REFERENCE) return `reference (${scene().reference?.method ?? "none"})`;
  return scene().cells[Number(key)]?.label ?? "–";
}
