// The opening: reference and methods at equal time, cut out and enlarged, and error over time beside them.

/** The contest shown: what each method's best picture is within the same CPU time, or null. */
function shownContest() {
  const contests = scene().contests;
  if (contests.length === 0) return null;
  return contests[state.contest === "" ? scene().contest ?? contests.length - 1 : Math.min(Number(state.contest), contests.length - 1)];
}

/** The picks of a contest: photon map and beam tree first, as the sentence this page exists for asks, then by error. */
function orderedPicks(contest) {
  return Object.values(contest.picks).sort((a, b) => {
    const leading = (i) => { const at = ["photonmap", "beamtree"].indexOf(scene().cells[i].method); return at < 0 ? 2 : at; };
    return leading(a) - leading(b) || scene().cells[a].errors.rmse[0] - scene().cells[b].errors.rmse[0];
  });
}

const INSETS = ["#ff9d00", "#00b7ff"];
const strip = {turn: 0};

/** The corners of the two insets: where a picture changes most among counted pixels, up to its white, unless the state names others. */
function insets(reference, counted) {
  if (state.crops) return state.crops.split("_").map((corner) => corner.split(",").map(Number));
  const side = insetSide(), {width, height} = reference, found = [];
  const change = new Float64Array(width * height), white = 2 ** -usualExposure(reference);
  const shown = (i) => Math.min(white, luminance(reference, i));
  for (let y = 0; y + 1 < height; ++y) for (let x = 0; x + 1 < width; ++x) {
    const i = y * width + x;
    if (!counted[i] || !counted[i + 1] || !counted[i + width]) continue;
    change[i] = Math.abs(shown(i + 1) - shown(i)) + Math.abs(shown(i + width) - shown(i));
  }
  for (let n = 0; n < 2; ++n) {
    let best = [-1, 0, 0];
    for (let y = 0; y + side <= height; y += 2) for (let x = 0; x + side <= width; x += 2) {
      if (found.some(([a, b]) => Math.abs(a - x) < side && Math.abs(b - y) < side)) continue;
      let sum = 0;
      for (let v = y; v < y + side; ++v) for (let u = x; u < x + side; ++u) sum += change[v * width + u];
      if (sum > best[0]) best = [sum, x, y];
    }
    if (best[0] >= 0) found.push([best[1], best[2]]);
  }
  return found;
}

function insetSide() { return Math.max(4, Math.round(Math.min(scene().width, scene().height) / 5)); }

async function drawStrip() {
  const turn = ++strip.turn, contest = shownContest();
  const keys = usualKeys().slice(0, 9);
  const images = new Map();
  for (const key of keys) images.set(key, await wholePicture(key));
  if (turn !== strip.turn) return;
  const reference = images.get(REFERENCE), whole = [...images.values()].find((image) => !image.hole);
  const guide = reference && !reference.hole ? reference : whole;
  const exposure = state.exposure !== "" ? Number(state.exposure) : guide ? usualExposure(guide) : 0;
  const caustic = await layerOf(REFERENCE, "caustic"); // not the edges of lamps and shadows, where there is a caustic
  const bright = !caustic.hole && caustic.planes.some((plane) => plane.some((each) => each > 0));
  const corners = guide ? insets(bright ? caustic : guide, await countedPixels([])) : [];
  const figures = [];
  for (const key of keys) figures.push(await stripFigure(key, images.get(key), exposure, corners, contest));
  if (turn !== strip.turn) return;
  byId("strip").replaceChildren(...figures);
  byId("strip").dataset.ready = String(turn);
  byId("opening-head").textContent = contest ? "At equal time" : "Best of each method";
  const left = (await countedPixels([])).filter((each) => !each).length;
  byId("contest-text").textContent = contestText(contest) + (left ? ` Greyed: ${left} pixels that the reference does not reach; no number counts them.` : "");
}

function contestText(contest) {
  if (!contest) return "No two methods have errors and times here, so nothing is held against equal time: the best of each method, or of each of indirect light.";
  const own = scene().cells.find((each) => each.references_error)?.references_error;
  const noise = own && Object.values(contest.picks).some((i) => scene().cells[i].errors.rmse[0] < 2 * own)
    ? ` An rmse near ${short(own, 3)}, the reference's own standard error, is mostly the reference's noise.` : "";
  const time = `Each method's least rmse within ${short(contest.seconds, 3)} CPU seconds of build and query; ${page.words.rmse} of the caustic layer [W m⁻² sr⁻¹].${noise}`;
  return contest.seeds < 5 ? `${time} With ${contest.seeds_text} (five are asked for) none is called the best.`
    : `${time} ★: the best, and all that the seeds do not tell from it (Welch's t of the logarithms, 95 %).`;
}

async function stripFigure(key, image, exposure, corners, contest) {
  const cell = key === REFERENCE ? null : scene().cells[Number(key)];
  const lines = [make("strong", {}, cell ? `${methodSign(cell.method)} ${cell.method}${contest?.best.includes(Number(key)) ? " ★" : ""}` : "reference")];
  if (cell) {
    const settings = cell.label.replace(`${cell.method}, `, "");
    lines.push(make("span", {}, settings === cell.method ? "" : settings), make("span", {}, `rmse ${withInterval(cell.errors.rmse)}`),
      make("span", {}, `build ${short(cell.costs.build_s, 3)} + query ${short(cell.costs.query_s, 3)}${cell.costs.indirect_cpu_s ? ` + indirect ${short(cell.costs.indirect_cpu_s, 3)}` : ""} CPU s`));
    if (cell.errors.indirect_rmse) lines.push(make("span", {}, `indirect rmse ${withInterval(cell.errors.indirect_rmse)}`));
  } else {
    const error = scene().cells.find((each) => each.references_error)?.references_error;
    lines.push(make("span", {}, scene().reference.method), make("span", {}, error ? `standard error of a pixel ${short(error, 3)} W m⁻² sr⁻¹` : ""), make("span", {}));
  }
  const caption = make("figcaption", {}, lines.map((line) => make("div", {}, line)));
  if (!image || image.hole) return make("figure", {class: "tile"}, make("p", {class: "hole"}, `no picture: ${image?.hole}`), caption);
  const paintedOnce = painted(image, exposure, null, await countedPixels([key]));
  const scale = Math.max(1, Math.round(400 / image.width));
  const canvas = make("canvas", {width: image.width * scale, height: image.height * scale, role: "img", "aria-label": `caustic of ${labelOf(key)}`,
    title: "click: move the first inset here; with Shift: the second", onclick: (event) => moveInset(canvas, corners, event)});
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.drawImage(paintedOnce, 0, 0, canvas.width, canvas.height);
  const side = insetSide();
  const crops = corners.map(([x, y], n) => {
    context.strokeStyle = INSETS[n];
    context.lineWidth = 3;
    context.setLineDash(n ? [9, 4] : []);
    context.strokeRect(scale * x, scale * y, scale * side, scale * side);
    const crop = make("canvas", {width: side * 8, height: side * 8, class: `crop crop-${n}`, role: "img", "aria-label": `inset ${n + 1} of ${labelOf(key)}`});
    const own = crop.getContext("2d");
    own.imageSmoothingEnabled = false;
    own.drawImage(paintedOnce, x, y, side, side, 0, 0, crop.width, crop.height);
    return crop;
  });
  return make("figure", {class: "tile"}, canvas, make("div", {class: "crops"}, crops), caption);
}

function moveInset(canvas, corners, event) {
  const box = canvas.getBoundingClientRect(), side = insetSide();
  const place = (offset, size, whole) => Math.max(0, Math.min(whole - side, Math.floor((offset / size) * whole - side / 2)));
  const moved = corners.map((corner) => corner.slice());
  moved[event.shiftKey && moved.length > 1 ? 1 : 0] = [place(event.clientX - box.left, box.width, scene().width), place(event.clientY - box.top, box.height, scene().height)];
  change({crops: moved.map((corner) => corner.join(",")).join("_")});
}

/** The strip as one SVG: pictures as PNG in it, insets, labels, numbers. */
function stripSvg() {
  const tiles = [...byId("strip").querySelectorAll(".tile")].filter((tile) => tile.querySelector("canvas"));
  const wide = 240, gap = 10, tall = (wide * scene().height) / scene().width, crop = (wide - gap) / 2;
  const width = tiles.length * (wide + gap) - gap, height = tall + gap + crop + 76;
  const svg = make("svg", {xmlns: "http://www.w3.org/2000/svg", width, height, viewBox: `0 0 ${width} ${height}`});
  svg.append(make("rect", {width, height, fill: "#fff"}));
  const image = (canvas, x, y, w, h) => make("image", {href: canvas.toDataURL("image/png"), x, y, width: w, height: h, style: "image-rendering:pixelated"});
  tiles.forEach((tile, n) => {
    const x = n * (wide + gap), [whole, ...crops] = tile.querySelectorAll("canvas");
    svg.append(image(whole, x, 0, wide, tall));
    crops.forEach((each, i) => svg.append(image(each, x + i * (crop + gap), tall + gap, crop, crop),
      make("rect", {x: x + i * (crop + gap) + 1, y: tall + gap + 1, width: crop - 2, height: crop - 2, fill: "none", stroke: INSETS[i], "stroke-width": 2, "stroke-dasharray": i ? "6 3" : null})));
    [...tile.querySelectorAll("figcaption > div")].forEach((line, i) => svg.append(make("text",
      {x, y: tall + gap + crop + 18 + 16 * i, "font-family": "sans-serif", "font-size": i ? 11 : 13, "font-weight": i ? "normal" : "bold", fill: "#111"}, line.textContent)));
  });
  return new XMLSerializer().serializeToString(svg);
}
