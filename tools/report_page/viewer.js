// The pictures: one pane that flips or is split, or all side by side; zoom and place are the same in all of them.

const viewer = {panes: [], images: new Map(), range: null, exposure: 0, painting: 0};

/** The keys shown: the reference and the picks at equal time, unless the state names others. */
function shownKeys() {
  const named = state.pictures ? state.pictures.split(".").filter((key) => key === REFERENCE || scene().cells[Number(key)]) : [];
  return named.length ? named : usualKeys();
}

function usualKeys() {
  const keys = scene().reference && !scene().reference.hole ? [REFERENCE] : [];
  const found = shownContest();
  const cells = found ? orderedPicks(found) : bestOfMethods();
  return [...keys, ...cells.map(String)].slice(0, 9);
}

/** Where no two methods compete: each method's cell with the least error, or its first; where methods of indirect light do, the
 *  best of each of those. */
function bestOfMethods() {
  const cells = scene().cells, lit = cells.some((cell) => cell.errors.indirect_rmse);
  const error = (cell) => (lit ? cell.errors.indirect_rmse?.[0] ?? Infinity : cell.errors.rmse?.[0] ?? 0);
  const best = new Map();
  cells.forEach((cell, i) => {
    const group = lit ? cell.parameters.indirect ?? "" : cell.method, before = best.get(group);
    if (before === undefined || error(cell) < error(cells[before])) best.set(group, i);
  });
  return [...best.values()].sort((a, b) => rank(cells[a].method) - rank(cells[b].method) || error(cells[a]) - error(cells[b]));
}

/** Left and right of flip and split: what is named, or the first; of maps those that the reference is held against come first. */
function leftKey() { const keys = shownKeys(); return keys.includes(state.left) ? state.left : mappedFirst(keys)[0]; }
function rightKey() {
  const keys = shownKeys();
  return keys.includes(state.right) ? state.right : mappedFirst(keys).find((key) => key !== leftKey()) ?? keys[0];
}
function mappedFirst(keys) { return showsReferenceAsPicture() ? [...keys].sort((a, b) => (a === REFERENCE) - (b === REFERENCE)) : keys; }

/** Whether what is shown is a map that the reference itself has none of: its picture is shown in the map's place. */
function showsReferenceAsPicture() { return !["picture", "mean"].includes(state.show) && !(state.show === "error" && state.against !== REFERENCE); }

/** What is painted for a key: the picture, or a map of it. {image, hole} */
async function shownImage(key) {
  const reference = await referencePicture(errorLayer());
  if (key === REFERENCE && reference && showsReferenceAsPicture()) return {...reference, asPicture: true};
  if (state.show === "picture") return state.layer === "beauty" ? wholePicture(key) : layerOf(key);
  if (state.show === "error") return errorOf(key, state.against);
  if (state.show === "flip") return flipOf(key);
  if (key === REFERENCE) return state.show === "mean" ? reference ?? {hole: "no reference"} : {hole: "the reference has no seeds"};
  const found = await seedStatistics(key);
  if (!found) return {hole: pictureOf(key).hole ?? "no picture"};
  if (state.show === "mean") return found.mean;
  if (state.show === "variance") return found.variance ?? {hole: "one seed has no variance"};
  if (!reference) return {hole: referenceLayer(errorLayer()).hole};
  const counted = await countedPixels([key]);
  if (state.show === "bias2") return biasSquare(found, reference, await referencePicture(ownErrorLayer()), counted);
  return errorMap(found.mean, reference, "signed", 0, counted); // bias
}

/** A key's caustic, its indirect light where it has some, and all other light of the reference's picture; without that, where
 *  it is not in the page. */
async function wholePicture(key) {
  const caustic = await layerOf(key, "caustic");
  if (caustic.hole || typeof scene().rest !== "number") return caustic;
  const indirect = await layerOf(key, "indirect");
  const parts = [caustic, await picture(scene().rest), ...(indirect.hole ? [] : [indirect])];
  return {width: caustic.width, height: caustic.height, planes: [0, 1, 2].map((channel) =>
    Float32Array.from({length: caustic.width * caustic.height}, (_, i) => parts.reduce((sum, part) => sum + value(part, channel, i), 0)))};
}

/** The FLIP map of a key at the shown seed. */
async function flipOf(key) {
  if (key === REFERENCE) return {hole: "FLIP of the reference beside itself is 0"};
  const found = pictureOf(key);
  if (!found.hole && found.flip === undefined) return {hole: "its record has no FLIP (tools/flip_column.py)"};
  const at = pictureLayer(found, "flip");
  if (at.hole) return at;
  const map = await picture(at.id), counted = await countedPixels([key]);
  return grey(map.width, map.height, (i) => (counted[i] ? map.planes[0][i] : NaN));
}

/** The error map of a key against another, by the chosen formula. */
async function errorOf(key, against) {
  const [x, r] = [await layerOf(key), await layerOf(against)];
  if (x.hole || r.hole) return x.hole ? x : r;
  return errorMap(x, r, state.formula, Number(state.epsilon), await countedPixels([key, against]));
}

const SHOWN = {
  picture: "picture", error: "error map", mean: "mean over seeds", bias: "bias: mean over seeds − r", bias2: "bias² over seeds",
  variance: "variance over seeds", flip: "FLIP map",
};
const LAYERS = {caustic: "caustic alone", indirect: "indirect light alone", beauty: "whole picture"};

/** What some picture of the page has: maps of FLIP, or a layer of indirect light. */
function anyPictureHas(name) { return page.scenes.some((where) => where.cells.some((cell) => cell.pictures.some((each) => each[name] !== undefined))); }

function isSigned() { return state.show === "bias" || (state.show === "error" && FORMULAS[state.formula].signed === true); }
function isFalseColour() { return !["picture", "mean"].includes(state.show) || state.tone === "false"; }

/** What the colours mean, as the line above the panes says it. */
function shownText() {
  if (state.show === "picture") return `radiance of the ${{caustic: "caustic layer", indirect: "indirect layer", beauty: "whole picture"}[state.layer]} [W m⁻² sr⁻¹]`;
  if (state.show === "error") return `${formulaText()}, r: ${labelOf(state.against)} [${FORMULAS[state.formula].unit}], a mean over channels`;
  if (state.show === "flip") return "HDR-FLIP [1], 0 the same to 1: the reference's whole picture beside the same with the picture's caustic [Andersson et al. 2021]";
  if (state.show === "bias2") return "(mean over seeds − r)² − variance / seeds − stderr(r)² [(W m⁻² sr⁻¹)²], below 0 by chance";
  if (state.show === "variance") return "sample variance over the seeds, divided by seeds − 1 [(W m⁻² sr⁻¹)²]";
  if (state.show === "bias") return "mean over seeds − r [W m⁻² sr⁻¹], a mean over channels";
  return "mean over the seeds [W m⁻² sr⁻¹]";
}

async function drawViewer() {
  const turn = ++viewer.painting, keys = shownKeys();
  const wanted = state.mode === "side" ? keys : [leftKey(), rightKey()];
  const images = new Map();
  for (const key of new Set(wanted)) images.set(key, await shownImage(key));
  const reference = await layerOf(REFERENCE), counted = new Map();
  for (const key of images.keys()) counted.set(key, await countedPixels([key]));
  if (turn !== viewer.painting) return; // something newer is being drawn
  viewer.images = images;
  chooseColours([...images.values()].filter((image) => !image.hole), reference);
  for (const [key, image] of images) if (!image.hole) image.canvas = painted(image, viewer.exposure, image.asPicture ? null : viewer.range, counted.get(key));
  layPanes(state.mode === "side" ? wanted.map((key) => [key]) : state.mode === "split" ? [[leftKey(), rightKey()]] : [[leftKey()]]);
  byId("meaning").textContent = shownText();
  byId("scale").replaceChildren(...(viewer.range ? [scaleBar(viewer.range, 300, "")] : [exposureText()]));
  paintPanes();
  byId("viewer").dataset.ready = String(turn);
}

function exposureText() { return make("span", {}, `exposure ${short(viewer.exposure, 3)} stops: sRGB(radiance · 2^exposure), white at ${short(2 ** -viewer.exposure, 3)} W m⁻² sr⁻¹`); }

function chooseColours(images, reference) {
  viewer.exposure = state.exposure !== "" ? Number(state.exposure)
    : images.length ? usualExposure(reference.hole || (state.layer === "beauty" && state.show === "picture") ? images[0] : reference) : 0;
  viewer.range = null;
  if (!isFalseColour()) return;
  const maps = images.filter((image) => !image.asPicture).map((image) => image.planes.length === 1 ? image : grey(image.width, image.height, (i) => luminance(image, i)));
  const range = state.show === "flip" ? {signed: false, log: false, low: 0, high: 1} : usualRange(maps, isSigned(), state.scale === "log");
  if (state.high !== "" && Number(state.high) > 0) { range.high = Number(state.high); if (range.signed) range.low = -range.high; }
  if (state.low !== "" && !range.signed && Number(state.low) < range.high && (Number(state.low) > 0 || !range.log)) range.low = Number(state.low);
  viewer.range = range;
}

/** Makes as many panes as are wanted; those that are there are kept, so that focus stays. */
function layPanes(groups) {
  const host = byId("panes");
  host.dataset.count = groups.length;
  while (viewer.panes.length > groups.length) viewer.panes.pop().element.remove();
  while (viewer.panes.length < groups.length) { const pane = newPane(); viewer.panes.push(pane); host.append(pane.element); }
  groups.forEach((keys, i) => { viewer.panes[i].keys = keys; });
}

function newPane() {
  const pane = {keys: [], canvas: make("canvas", {tabindex: 0, role: "img"}), caption: make("figcaption")};
  pane.element = make("figure", {class: "pane"}, pane.canvas, pane.caption);
  listenToPane(pane);
  return pane;
}

/** The view: the pixel in the middle and how many screen pixels one is wide, or the whole picture. */
function view(canvas) {
  const {width, height} = scene(), fit = Math.min(canvas.width / width, canvas.height / height);
  if (!state.view) return {x: width / 2, y: height / 2, zoom: fit, fit};
  const [x, y, zoom] = state.view.split(",").map(Number);
  return {x, y, zoom: fit * zoom, fit};
}

/** Paints the panes again, unless they still show another state: drawViewer paints them then. */
function repaintPanes() { if (!isStale("panes")) paintPanes(); }

function paintPanes() {
  for (const pane of viewer.panes) paintPane(pane);
}

function paintPane(pane) {
  const {canvas, keys} = pane, context = canvas.getContext("2d");
  const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  canvas.width = Math.round(box.width * ratio);
  canvas.height = Math.round(box.height * ratio);
  context.imageSmoothingEnabled = false;
  const at = view(canvas), {width, height} = scene();
  const left = canvas.width / 2 - at.x * at.zoom, top = canvas.height / 2 - at.y * at.zoom;
  const border = keys.length === 2 ? Number(state.split) * canvas.width : canvas.width;
  keys.forEach((key, part) => {
    const image = viewer.images.get(key);
    context.save();
    context.beginPath();
    context.rect(part === 0 ? 0 : border, 0, part === 0 ? border : canvas.width - border, canvas.height);
    context.clip();
    if (image?.canvas) {
      context.drawImage(image.canvas, left, top, width * at.zoom, height * at.zoom);
      if (viewer.range?.signed && !image.asPicture && at.zoom >= 18 * ratio) paintSigns(context, image, at, left, top, canvas);
    } else paintHole(context, canvas, image?.hole ?? "no picture", ratio);
    context.restore();
  });
  if (keys.length === 2) { context.fillStyle = "#fff"; context.fillRect(border - ratio, 0, 2 * ratio, canvas.height); }
  paintMarks(context, at, left, top, ratio);
  const text = keys.map((key, part) => (keys.length === 2 ? ["left: ", "right: "][part] : "") + captionOf(key)).join("\n");
  pane.caption.textContent = text;
  canvas.setAttribute("aria-label", text);
}

function captionOf(key) {
  const number = shownKeys().indexOf(key) + 1, cell = key === REFERENCE ? null : scene().cells[Number(key)];
  const sign = cell ? `${methodSign(cell.method)} ` : "";
  const error = cell && layerError(cell) ? ` · ${errorLayer() === "caustic" ? "" : "indirect "}rmse ${withInterval(layerError(cell))}${cell.costs.work_s !== undefined ? ` · ${short(cell.costs.work_s, 3)} CPU s` : ""}` : "";
  const image = viewer.images.get(key);
  const mean = image?.asPicture ? ", its picture" : image && !image.hole && image.planes.length === 1 && state.show !== "picture"
    ? ` · mean of the map ${short(meanOfMap(image).mean)}` : "";
  return `${number} ${sign}${labelOf(key)}${error}${mean}`;
}

function paintHole(context, canvas, reason, ratio) {
  context.fillStyle = "#777";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = "#fff";
  context.font = `${13 * ratio}px sans-serif`;
  const words = `no picture: ${reason}`.split(" ");
  let line = "", y = 26 * ratio;
  for (const word of words) {
    if (line && context.measureText(`${line} ${word}`).width > canvas.width - 20 * ratio) { context.fillText(line, 10 * ratio, y); line = ""; y += 18 * ratio; }
    line = line ? `${line} ${word}` : word;
  }
  context.fillText(line, 10 * ratio, y);
}

/** The sign of each enlarged pixel, beside its colour. */
function paintSigns(context, image, at, left, top, canvas) {
  context.fillStyle = "rgba(255,255,255,.8)";
  context.font = `${at.zoom * 0.5}px sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (let y = Math.max(0, Math.floor(-top / at.zoom)); y < Math.min(image.height, (canvas.height - top) / at.zoom); ++y)
    for (let x = Math.max(0, Math.floor(-left / at.zoom)); x < Math.min(image.width, (canvas.width - left) / at.zoom); ++x) {
      const each = image.planes[0][y * image.width + x];
      if (each !== 0 && !Number.isNaN(each)) context.fillText(each < 0 ? "−" : "+", left + (x + 0.5) * at.zoom, top + (y + 0.5) * at.zoom);
    }
}

/** The probed pixel, the drawn region, and the pixels of the chosen part of the distribution. */
function paintMarks(context, at, left, top, ratio) {
  const outline = (x0, y0, x1, y1) => {
    for (const [colour, width] of [["#000", 3], ["#fff", 1.2]]) {
      context.strokeStyle = colour;
      context.lineWidth = width * ratio;
      context.strokeRect(left + x0 * at.zoom, top + y0 * at.zoom, (x1 - x0) * at.zoom, (y1 - y0) * at.zoom);
    }
  };
  const spread = viewer.spread;
  if (spread) {
    context.fillStyle = "#ff30ff";
    for (const i of spread) {
      const x = i % scene().width, y = Math.floor(i / scene().width), side = Math.max(2 * ratio, at.zoom * 0.5);
      context.fillRect(left + (x + 0.5) * at.zoom - side / 2, top + (y + 0.5) * at.zoom - side / 2, side, side);
    }
  }
  const pixel = probedPixel(), region = drawnRegion();
  if (pixel) outline(pixel[0], pixel[1], pixel[0] + 1, pixel[1] + 1);
  if (region) outline(region[0], region[1], region[2] + 1, region[3] + 1);
}

function probedPixel() { return state.pixel ? state.pixel.split(",").map(Number) : null; }
function drawnRegion() { return state.region ? state.region.split(",").map(Number) : null; }

function pixelAt(pane, event) {
  const box = pane.canvas.getBoundingClientRect(), ratio = pane.canvas.width / box.width, at = view(pane.canvas);
  return [at.x + ((event.clientX - box.left) * ratio - pane.canvas.width / 2) / at.zoom,
    at.y + ((event.clientY - box.top) * ratio - pane.canvas.height / 2) / at.zoom];
}

function inside(x, y) {
  return [Math.max(0, Math.min(scene().width - 1, Math.floor(x))), Math.max(0, Math.min(scene().height - 1, Math.floor(y)))];
}

function setView(at) {
  const zoom = Math.max(1, Math.min(64, at.zoom / at.fit));
  change({view: zoom === 1 ? "" : [at.x.toFixed(2), at.y.toFixed(2), zoom.toFixed(3)].join(",")});
}

/** Enlarges about a place of the picture, which stays where it is on the screen. */
function zoomAbout(canvas, factor, place) {
  const at = view(canvas), [x, y] = place ?? [at.x, at.y];
  const zoom = Math.max(at.fit, Math.min(64 * at.fit, at.zoom * factor)), kept = at.zoom / zoom;
  setView({...at, x: x + (at.x - x) * kept, y: y + (at.y - y) * kept, zoom});
}

function listenToPane(pane) {
  const {canvas} = pane;
  let start = null;
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return; // it scrolls the page
    event.preventDefault();
    zoomAbout(canvas, Math.exp(-event.deltaY * 0.0015), pixelAt(pane, event));
  }, {passive: false});
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    const box = canvas.getBoundingClientRect();
    const onBorder = pane.keys.length === 2 && Math.abs((event.clientX - box.left) / box.width - Number(state.split)) < 12 / box.width;
    start = {x: event.clientX, y: event.clientY, pixel: pixelAt(pane, event), at: view(canvas), moved: false,
      what: onBorder ? "split" : event.shiftKey || byId("draw-region").getAttribute("aria-pressed") === "true" ? "region" : "pan"};
  });
  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = pixelAt(pane, event);
    if (!start) { hoverPixel(...inside(x, y)); return; }
    if (Math.hypot(event.clientX - start.x, event.clientY - start.y) > 3) start.moved = true;
    if (!start.moved) return;
    const box = canvas.getBoundingClientRect(), ratio = canvas.width / box.width;
    if (start.what === "split") change({split: Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)).toFixed(3)});
    else if (start.what === "region") {
      const [x0, y0] = inside(...start.pixel), [x1, y1] = inside(x, y);
      change({region: [Math.min(x0, x1), Math.min(y0, y1), Math.max(x0, x1), Math.max(y0, y1)].join(",")});
    } else setView({...start.at, x: start.at.x - ((event.clientX - start.x) * ratio) / start.at.zoom, y: start.at.y - ((event.clientY - start.y) * ratio) / start.at.zoom});
  });
  canvas.addEventListener("pointerup", () => {
    if (start && !start.moved) change({pixel: inside(...start.pixel).join(","), region: ""});
    start = null;
  });
}

/** Values under the pointer, in the status line. */
function hoverPixel(x, y) {
  const at = y * scene().width + x;
  const words = [...viewer.images].filter(([, image]) => !image.hole).map(([key, image]) =>
    `${shownKeys().indexOf(key) + 1}: ${short(image.planes.length === 1 ? image.planes[0][at] : luminance(image, at))}`);
  byId("status").textContent = `pixel (${x}, ${y})  ${words.join("   ")}`;
}
