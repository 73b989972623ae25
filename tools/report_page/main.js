// The controls, the keys, and what is drawn anew when the state changes.

/** Parts of the page that wait for pictures: the elements of each, and the words of the state that it depends on. */
const STRIP = {ids: ["opening-head", "strip", "contest-text"], of: ["scene", "contest", "seed", "exposure", "crops"], draw: () => drawStrip()};
const PICTURES = {ids: ["panes", "meaning", "scale"], draw: () => drawViewer(), of: ["scene", "contest", "seed", "pictures", "left", "right", "mode",
  "show", "formula", "against", "epsilon", "layer", "tone", "exposure", "low", "high", "scale"]};
const PROBE = {ids: ["probe-table", "probe-curve"], draw: () => drawProbe(),
  of: ["scene", "seed", "layer", "pixel", "region", "place", "cost", "hidden"]};
const SPREAD = {ids: ["spread"], draw: () => drawSpread(),
  of: ["scene", "contest", "seed", "pictures", "left", "right", "show", "layer", "formula", "against", "epsilon", "spread"]};
const SPECTRUM = {ids: ["spectrum"], of: ["scene", "contest", "pictures", "left", "right", "show", "against", "layer"], draw: () => drawSpectrum()};
const KEYS = [
  ["1 … 9", "show that picture (flip), or make it the left one (split, side by side)"], ["Space", "swap left and right: flip between two pictures"],
  ["n, p", "next, previous picture"], ["m", "next mode: side by side, flip, split"], ["e", "picture or error map"], ["f", "false colour or colours of a screen"],
  ["[, ]", "exposure half a stop down, up"], ["+, −, 0", "zoom in, out, whole picture"], ["Ctrl + wheel", "zoom about the pointer"], ["h, j, k, l", "move the view"],
  ["arrows", "move the probed pixel (Shift: ten pixels); in split mode with Alt: the split"], ["r", "draw a region by dragging"], ["c", "copy the command of the left picture"],
  ["s", "next seed"], ["t", "light or dark"], ["?", "show or hide this list"], ["Escape", "hide this list"],
];

function buildControls() {
  byId("scene-choice").replaceChildren(sceneChoice());
  byId("viewer-controls").append(
    choice("mode", "Mode", [["side", "side by side"], ["flip", "flip"], ["split", "split"]], "key m"),
    choice("show", "Show", Object.entries(SHOWN).filter(([name]) => name !== "flip" || anyPictureHas("flip")), "key e"),
    choice("layer", "Layer", Object.entries(LAYERS).filter(([name]) => name !== "indirect" || anyPictureHas("indirect")),
      "errors are of the caustic, or of the indirect light where that is shown; the whole picture: both, and all other light of the reference"),
    choice("tone", "Colours", [["colour", "screen"], ["false", "false colour"]], "key f"), seedChoice(),
    typed("exposure", "Exposure", "stops; empty: the 99th percentile of the reference is white", "0.5"));
  byId("map-controls").append(
    choice("formula", "Error", Object.entries(FORMULAS).map(([name, formula]) => [name, formula.text])), againstChoice(),
    typed("epsilon", "ε", "in units of mean(r), or of its square"), choice("scale", "Scale", [["log", "logarithmic"], ["linear", "linear"]]),
    typed("low", "from", "least of the scale"), typed("high", "to", "greatest of the scale"));
  byId("split-at").addEventListener("input", () => change({split: byId("split-at").value}));
  byId("draw-region").addEventListener("click", () => toggleRegion());
  byId("curve-controls").append(metricChoice(), costChoice("curve-cost"), button("SVG", () => saveSvg("curve", "curves.svg"), "keep the plot as SVG", {id: "save-curve"}));
  byId("probe-controls").append(choice("place", "Convergence of the", [["error", "error"], ["value", "value"]]), costChoice("probe-cost"), button("SVG", () => saveSvg("probe-curve", "convergence.svg"), "keep the plot as SVG", {id: "save-probe"}));
  byId("spread-controls").append(button("SVG", () => saveSvg("spread", "distribution.svg"), "keep the plot as SVG"), button("clear", () => change({spread: ""}), "show no pixels of a bar"));
  byId("spectrum-controls").append(button("SVG", () => saveSvg("spectrum", "spectrum.svg"), "keep the plot as SVG"));
  byId("save-strip").addEventListener("click", () => { if (!isStale("strip")) download("strip.svg", stripSvg()); });
  byId("table-controls").append(choice("rows", "Rows", [["cells", "cells (over seeds)"], ["records", "records (one a trial)"]]), filterInput(),
    button("CSV", () => download("table.csv", tableCsv(), "text/csv"), "keep the shown rows as CSV", {id: "save-table"}));
  for (const link of document.querySelectorAll("nav a")) { // the fragment of the link is the state
    link.addEventListener("click", (event) => { event.preventDefault(); byId(link.dataset.to).scrollIntoView(); });
  }
  byId("theme").addEventListener("click", nextTheme);
  for (const id of ["show-keys", "hide-keys"]) byId(id).addEventListener("click", toggleKeys);
  byId("copy-link").addEventListener("click", () => copy(location.href, byId("copy-link")));
  byId("budget").addEventListener("input", () => change({contest: byId("budget").value, pictures: ""}));
  byId("keys").replaceChildren(...KEYS.map(([keys, text]) => make("div", {}, make("dt", {}, make("kbd", {}, keys)), make("dd", {}, text))));
}

function saveSvg(id, name) {
  const svg = byId(id).querySelector("svg");
  if (svg && !isStale(id)) download(name, svgText(svg));
}

function sceneChoice() {
  const select = make("select", {id: "choose-scene", onchange: () => chooseScene(select.value)}, page.scenes.map((each, i) => make("option", {value: i}, each.title)));
  onChange(() => { select.value = state.scene; });
  return make("label", {}, "Scene ", select);
}

/** A select whose options depend on the scene. */
function changing(name, label, options, title, id = name) {
  const select = make("select", {id: `choose-${id}`, onchange: () => change({[name]: select.value})});
  const fill = () => {
    select.replaceChildren(...options().map(([value, text]) => make("option", {value}, text)));
    select.value = state[name];
    if (select.selectedIndex < 0) select.selectedIndex = 0;
  };
  onChange(fill);
  return make("label", {title}, `${label} `, select);
}

function seedChoice() {
  return changing("seed", "Seed", () => (scene().cells[0]?.seeds ?? []).map((seed, i) => [String(i), seed]), "key s");
}

function againstChoice() {
  return changing("against", "against", () => [[REFERENCE, "reference"], ...scene().cells.map((cell, i) => [String(i), cell.label])], "r of the formula");
}

function metricChoice() { return choice("metric", "Error", page.errors.map((name) => [name, name])); }

function costChoice(id) {
  return changing("cost", "over", () => {
    const parameters = [...new Set(scene().cells.map((cell) => cell.work_parameter).filter(Boolean))];
    return [...page.costs.map((name) => [name, costWord(name)]), ...parameters.map((name) => [`parameter:${name}`, `${name} (parameter)`])];
  }, "what is drawn against", id);
}

function filterInput() {
  const input = make("input", {type: "search", id: "filter", placeholder: "words that a row has", oninput: () => change({filter: input.value})});
  onChange(() => { if (document.activeElement !== input) input.value = state.filter; });
  input.value = state.filter;
  return make("label", {}, "Filter ", input);
}

function toggleRegion() {
  const pressed = byId("draw-region");
  pressed.setAttribute("aria-pressed", String(pressed.getAttribute("aria-pressed") !== "true"));
}

const THEMES = ["", "light", "dark"];
/** The list of keys keeps no focus, so that the keys can be tried while it is read. */
function toggleKeys() { byId("help").open = !byId("help").open; }

function nextTheme() { change({theme: THEMES[(THEMES.indexOf(state.theme) + 1) % 3]}); }

function drawHead() {
  if (state.theme) document.documentElement.dataset.theme = state.theme; else delete document.documentElement.dataset.theme;
  byId("theme").textContent = `Theme: ${state.theme || "system"}`;
  const contests = scene().contests, budget = byId("budget");
  byId("budget-line").hidden = contests.length === 0;
  if (contests.length) {
    budget.max = contests.length - 1;
    budget.value = state.contest === "" ? scene().contest ?? contests.length - 1 : state.contest;
    byId("budget-text").textContent = `${short(shownContest().seconds, 3)} CPU s`;
  }
  byId("scene-text").textContent = `${scene().width} × ${scene().height} pixels, ${scene().cells.length} cells, ${scene().seeds_text}, `
    + (scene().reference ? `reference ${scene().reference.method} ${scene().reference.key}` : "no reference");
  drawNotDone();
}

function drawNotDone() {
  const reasons = new Map();
  for (const each of scene().not_done) {
    const text = `${each.method}: ${each.status}${each.message ? `: ${each.message}` : ""}`;
    reasons.set(text, (reasons.get(text) ?? 0) + 1);
  }
  byId("not-done").replaceChildren(...[...reasons].map(([text, count]) => make("li", {}, `${count} trial${count > 1 ? "s" : ""} of ${text}`)),
    ...scene().missed.map((text) => make("li", {}, text)));
}

/** The list of pictures shown, each with what makes it again, and those that may be added. */
function drawChosen() {
  const keys = shownKeys();
  const chips = keys.map((key, i) => make("li", {class: "chip", "data-key": key},
    button(`${i + 1} ${key === REFERENCE ? "" : methodSign(scene().cells[Number(key)].method)} ${labelOf(key)}`, () => change({left: key, right: key === rightKey() ? leftKey() : rightKey()}), "make it the left picture",
      {"aria-pressed": String(key === leftKey())}), button("right", () => change({right: key}), "make it the right picture", {"aria-pressed": String(key === rightKey())}),
    copyButtons(key), button("×", () => change({pictures: keys.filter((each) => each !== key).join(".") || REFERENCE}), "take it away", {"aria-label": `take away ${labelOf(key)}`})));
  const others = [[REFERENCE, "reference"], ...scene().cells.map((cell, i) => [String(i), cell.label])].filter(([key]) => !keys.includes(key));
  const select = make("select", {id: "add-picture", "aria-label": "add a picture", onchange: () => change({pictures: [...keys, select.value].slice(-9).join(".")})},
    make("option", {value: ""}, "add a picture …"), others.map(([key, text]) => make("option", {value: key}, text)));
  byId("chosen").replaceChildren(...chips, make("li", {}, select), make("li", {}, button("as at equal time", () => change({pictures: "", left: "", right: ""}), "reference and the picks of the opening")));
  byId("split-line").hidden = state.mode !== "split";
  byId("split-at").value = state.split;
}

function copyButtons(key) {
  if (key === REFERENCE) return scene().reference ? [scene().reference.settings ? copyButton("settings", scene().reference.settings) : null, copyButton("hash", scene().reference.key)] : [];
  const found = pictureOf(key);
  return [found.command ? copyButton("command", found.command) : null, found.hash ? copyButton("hash", found.hash) : null].filter(Boolean);
}

function cycle(name, values) { change({[name]: values[(values.indexOf(state[name]) + 1) % values.length]}); }

function movePixel(dx, dy, far) {
  const [x, y] = probedPixel() ?? [Math.floor(scene().width / 2), Math.floor(scene().height / 2)], step = far ? 10 : 1;
  change({pixel: inside(x + dx * step, y + dy * step).join(","), region: ""});
}

function choosePicture(i) {
  const key = shownKeys()[i];
  if (!key || key === leftKey()) return;
  change({left: key, right: state.mode === "flip" || key === rightKey() ? leftKey() : rightKey()});
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
  if (event.key === " " && /^(BUTTON|SUMMARY|A)$/.test(event.target.tagName)) return;
  const canvas = viewer.panes[0]?.canvas, keys = shownKeys();
  const step = (by) => choosePicture((keys.indexOf(leftKey()) + by + keys.length) % keys.length);
  const pan = (dx, dy) => { const at = view(canvas); setView({...at, x: at.x + dx * 40 / at.zoom, y: at.y + dy * 40 / at.zoom}); };
  const arrow = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
  const exposed = () => Number(state.exposure === "" ? viewer.exposure.toFixed(1) : state.exposure);
  const actions = {
    " ": () => change({left: rightKey(), right: leftKey()}), n: () => step(1), p: () => step(-1), m: () => cycle("mode", ["side", "flip", "split"]),
    e: () => cycle("show", ["picture", "error"]), f: () => cycle("tone", ["colour", "false"]), "[": () => change({exposure: exposed() - 0.5}),
    "]": () => change({exposure: exposed() + 0.5}), "+": () => zoomAbout(canvas, 1.5), "=": () => zoomAbout(canvas, 1.5), "-": () => zoomAbout(canvas, 1 / 1.5),
    0: () => change({view: ""}), h: () => pan(-1, 0), l: () => pan(1, 0), k: () => pan(0, -1), j: () => pan(0, 1), r: toggleRegion, t: nextTheme,
    c: () => { const found = leftKey() === REFERENCE ? {} : pictureOf(leftKey()); if (found.command) copy(found.command, document.activeElement); },
    s: () => cycle("seed", (scene().cells[0]?.seeds ?? ["0"]).map((_, i) => String(i))), "?": toggleKeys, Escape: () => { byId("help").open = false; },
  };
  if (arrow && event.altKey && state.mode === "split") change({split: Math.min(1, Math.max(0, Number(state.split) + arrow[0] * 0.02)).toFixed(3)});
  else if (arrow && (document.activeElement === document.body || document.activeElement.tagName === "CANVAS")) movePixel(...arrow, event.shiftKey);
  else if (/^[1-9]$/.test(event.key)) choosePicture(Number(event.key) - 1);
  else if (actions[event.key]) actions[event.key]();
  else return;
  event.preventDefault();
}

function drawAll(names) {
  const any = (wanted) => !names || wanted.some((name) => names.has(name));
  drawHead();
  if (any(["scene"])) byId("status").textContent = "";
  if (any(SPREAD.of)) viewer.spread = null;
  if (any(["scene", "contest", "seed", "pictures", "left", "right", "mode", "show", "against"])) drawChosen();
  if (any(["scene", "metric", "cost", "hidden", "pictures"])) drawCurves();
  if (any(["rows", "sort", "filter", "columns"])) drawTable();
  if (any(["split"])) byId("split-at").value = state.split;
  document.body.classList.toggle("other-scene", any(["scene"]) || document.body.classList.contains("other-scene"));
  const drawn = (...parts) => parts.filter((part) => any(part.of)).map(markStale);
  drawParts(drawn(STRIP));
  drawParts(drawn(PICTURES, PROBE, SPREAD, SPECTRUM)); // what is computed from the pictures comes after them
  if (any(["view", "pixel", "region", "split"])) repaintPanes();
}

/** Marks a part that still shows the state before; style.css dims it. */
function markStale(part) {
  part.turn = (part.turn ?? 0) + 1;
  for (const id of part.ids) byId(id).setAttribute("aria-busy", "true");
  return {...part, isCurrent: ((turn) => () => turn === part.turn)(part.turn)};
}

function isStale(id) { return byId(id).getAttribute("aria-busy") === "true"; }

/** Draws marked parts one after the other. A frame passes before each, so that the user sees what is stale, and what is done, while
 *  the next part is computed. A part that was marked again since belongs to the later call. */
async function drawParts(parts) {
  for (const part of parts) {
    await nextFrame();
    if (part.isCurrent()) await part.draw();
    if (part.isCurrent()) for (const id of part.ids) byId(id).removeAttribute("aria-busy");
  }
  if (!document.querySelector("[aria-busy]")) document.body.classList.remove("other-scene");
}

/** Settles after the browser has painted. */
function nextFrame() { return new Promise((done) => requestAnimationFrame(() => setTimeout(done))); }

/** What a column is, with its name before it. */
function explained(name) {
  const words = page.words[name] ?? "";
  return words.startsWith(name) ? words : `${name}: ${words}`;
}

readLink();
buildControls();
onChange(drawAll);
window.addEventListener("hashchange", () => { readLink(); listeners.forEach((draw) => draw(new Set(Object.keys(defaults).filter((name) => name !== "scene")))); drawAll(null); });
window.addEventListener("keydown", onKey);
window.addEventListener("resize", repaintPanes);
byId("machines").replaceChildren(...page.machines.map((line, i) => make("li", {}, `${page.tables[i].folder}: ${line}`)));
byId("words").replaceChildren(...[...page.errors, ...page.costs].map((name) => make("li", {}, explained(name), page.units[name] ? ` [${page.units[name]}]` : "")));
byId("newest").textContent = page.newest;
byId("warning").hidden = page.left_out === 0;
byId("warning").textContent = `${page.left_out} pictures are left out: with them the pictures would be larger than ${page.megabytes} MB. `
  + `\`causticbench report\` with --megabytes ${page.megabytes_wanted} keeps them all. Table and curves are of all trials; maps and spectrum over seeds are of the seeds that are here.`;
for (const draw of listeners) if (draw !== drawAll) draw(new Set());
drawAll(null);
