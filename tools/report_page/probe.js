// A pixel or a region: every method's value beside the reference, its convergence, and the distribution of errors.

const probe = {turn: 0, spreadTurn: 0};

function probedRegion() {
  const pixel = probedPixel(), region = drawnRegion();
  return region ?? (pixel ? [pixel[0], pixel[1], pixel[0], pixel[1]] : null);
}

function regionText(region) {
  if (!region) return "no pixel chosen: click one, or move with the arrow keys";
  const [x0, y0, x1, y1] = region;
  return x0 === x1 && y0 === y1 ? `pixel (${x0}, ${y0})` : `region (${x0}, ${y0}) to (${x1}, ${y1}), ${(x1 - x0 + 1) * (y1 - y0 + 1)} pixels`;
}

/** Means of each channel over a region. */
function regionMean(image, region) {
  const sums = [0, 0, 0];
  let count = 0;
  forRegion(image, region, (i) => { ++count; for (let channel = 0; channel < 3; ++channel) sums[channel] += value(image, channel, i); });
  return sums.map((sum) => sum / count);
}

function meanOfChannels(colour) { return (colour[0] + colour[1] + colour[2]) / 3; }

async function drawProbe() {
  const turn = ++probe.turn, region = probedRegion();
  byId("probe-place").textContent = regionText(region);
  if (!region) { byId("probe-table").replaceChildren(); byId("probe-curve").replaceChildren(); return; }
  byId("probe-table").replaceChildren(make("p", {class: "note"}, `reading the pictures of ${scene().cells.length} cells …`));
  const reference = await referencePicture(errorLayer()), own = await referencePicture(ownErrorLayer());
  const rows = [];
  let middle = null, deviation = null, pixelDeviation = null;
  if (reference) {
    middle = regionMean(reference, region);
    if (own) { // pixels of the reference are independent, so errors of a mean add as squares
      let squares = 0, count = 0;
      forRegion(own, region, (i) => { squares += own.planes[0][i] ** 2; ++count; });
      deviation = Math.sqrt(squares) / count;
      pixelDeviation = Math.sqrt(squares / count);
    }
    rows.push(probeRow("reference", middle, `${short(meanOfChannels(middle))}${deviation === null ? "" : ` ± ${short(deviation, 2)}`}`, "", ""));
  }
  for (const [i, cell] of scene().cells.entries()) {
    const image = await layerOf(i);
    if (image.hole) { rows.push(probeRow(`${methodSign(cell.method)} ${cell.label}`, null, `no picture: ${image.hole}`, "", "")); continue; }
    const found = regionMean(image, region), difference = middle ? meanOfChannels(found) - meanOfChannels(middle) : null;
    rows.push(probeRow(`${methodSign(cell.method)} ${cell.label}`, found, short(meanOfChannels(found)), difference === null ? "" : signed(difference),
      deviation ? `${signed(difference / deviation, 2)} σ` : ""));
  }
  if (turn !== probe.turn) return;
  byId("probe-table").replaceChildren(make("table", {}, make("caption", {}, `${regionText(region)}, seed ${scene().cells[0]?.seeds[Number(state.seed)] ?? "–"}: mean over channels [W m⁻² sr⁻¹], x − r, and that in standard errors σ of the reference`),
    make("thead", {}, make("tr", {}, ["picture", "red", "green", "blue", "mean", "x − r", "in σ"].map((head) => make("th", {scope: "col"}, head)))), make("tbody", {}, rows)));
  await drawConvergence(turn, region, reference, middle, deviation, pixelDeviation);
}

function signed(number, digits) { return (number > 0 ? "+" : "") + short(number, digits); }

function probeRow(name, colour, ...texts) {
  const numbers = colour ? colour.map((each) => short(each)) : ["", "", ""];
  return make("tr", {}, make("th", {scope: "row"}, name), [...numbers, ...texts].map((text) => make("td", {}, text)));
}

/** The value, or the error, of a pixel or a region over the cost, a point for each cell: over its seeds. */
async function drawConvergence(turn, region, reference, middle, deviation, pixelDeviation) {
  const found = new Map(), counted = reference ? await countedPixels([]) : null;
  for (let i = 0; i < scene().cells.length; ++i) {
    const images = await seedsOf(i);
    if (images.length === 0) continue;
    if (state.place === "value") found.set(i, meanAndInterval(images.map((image) => meanOfChannels(regionMean(image, region)))));
    else if (reference) found.set(i, meanAndInterval(images.map((image) => regionError(image, reference, region, counted))));
  }
  if (turn !== probe.turn) return;
  const lines = linesOver(state.cost, (i) => found.get(i) ?? null);
  const levels = state.place === "value" ? (middle ? [{y: meanOfChannels(middle), name: `reference${deviation ? ` ± ${short(deviation, 2)}` : ""}`}] : [])
    : pixelDeviation ? [{y: pixelDeviation, name: "standard error of the reference's pixels"}] : [];
  byId("probe-curve").replaceChildren(plot(lines, {x: costLabel(state.cost), y: state.place === "value" ? "mean radiance there [W m⁻² sr⁻¹]" : "rmse there [W m⁻² sr⁻¹]",
    title: `${regionText(region)}: ${state.place === "value" ? "value" : "error"} over ${costWord(state.cost)}`, width: 620, height: 340, logX: true, logY: state.place !== "value",
    levels, legend: true, pick: (point) => showCell(point.key), empty: "no picture, or no reference"}));
  byId("probe-curve").dataset.ready = String(turn);
}

function regionError(image, reference, region, counted) {
  let sum = 0, count = 0;
  forRegion(image, region, (i) => {
    if (!counted[i]) return;
    for (let channel = 0; channel < 3; ++channel) sum += (value(image, channel, i) - value(reference, channel, i)) ** 2;
    count += 3;
  });
  return count ? Math.sqrt(sum / count) : NaN;
}

/** {y, low, high}: mean and its 95 % interval (Student) over some seeds. */
function meanAndInterval(values) {
  const n = values.length, y = values.reduce((a, b) => a + b, 0) / n;
  if (n < 2) return {y};
  const half = student(n - 1) * Math.sqrt(values.reduce((sum, each) => sum + (each - y) ** 2, 0) / (n - 1) / n);
  return half > 0 ? {y, low: y - half, high: y + half} : {y};
}

/** Student's t for a two-sided 95 % interval. */
function student(degrees) { return page.student[Math.min(degrees, page.student.length) - 1]; }

/** The distribution of the shown error map: bars of equal width; a bar that is chosen shows its pixels in the map. */
async function drawSpread() {
  const turn = ++probe.spreadTurn, key = rightKey();
  const map = key === REFERENCE || state.against === key ? {hole: "a picture held against itself has no error"} : await errorOf(key, state.against);
  if (turn !== probe.spreadTurn) return;
  if (map.hole) { byId("spread").replaceChildren(make("p", {class: "hole"}, `no distribution: ${map.hole}`)); viewer.spread = null; return; }
  const errors = map.planes[0], whole = [...errors].filter((each) => !Number.isNaN(each));
  const range = usualRange([map], FORMULAS[state.formula].signed === true, false);
  const low = range.signed ? -range.high : 0, bars = 48, step = (range.high - low) / bars;
  const barOf = (each) => Math.max(0, Math.min(bars - 1, Math.floor((each - low) / step)));
  const counts = new Array(bars).fill(0);
  for (const each of whole) ++counts[barOf(each)];
  const chosen = state.spread === "" ? -1 : Number(state.spread);
  viewer.spread = chosen < 0 ? null : [...errors.keys()].filter((i) => !Number.isNaN(errors[i]) && barOf(errors[i]) === chosen);
  byId("spread").replaceChildren(histogram(counts, low, step, chosen, key, whole.length));
  repaintPanes();
}

function histogram(counts, low, step, chosen, key, total) {
  const width = 620, height = 220, box = {left: 56, right: 10, top: 28, bottom: 40}, most = Math.max(...counts);
  const wide = (width - box.left - box.right) / counts.length;
  const tall = (count) => (count === 0 ? 0 : ((1 + Math.log10(count)) / (1 + Math.log10(most))) * (height - box.top - box.bottom));
  const svg = make("svg", {class: "plot", width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "distribution of the errors"});
  svg.append(make("text", {x: box.left, y: 16, class: "plot-title"}, `${labelOf(key)}: ${total} pixels`));
  counts.forEach((count, i) => {
    const [from, to] = [low + i * step, low + (i + 1) * step], text = `${count} pixels from ${short(from, 3)} to ${short(to, 3)}${i === counts.length - 1 ? " and above" : i === 0 && low < 0 ? " and below" : ""}`;
    const run = () => change({spread: chosen === i ? "" : i});
    const bar = make("rect", {x: box.left + i * wide, y: height - box.bottom - tall(count), width: Math.max(1, wide - 1), height: tall(count), class: `bar${chosen === i ? " chosen" : ""}`});
    const spot = make("g", {tabindex: 0, role: "button", "aria-label": text, "aria-pressed": String(chosen === i)}, bar,
      make("rect", {x: box.left + i * wide, y: box.top, width: wide, height: height - box.top - box.bottom, class: "halo"}), make("title", {}, text));
    spot.addEventListener("click", run);
    spot.addEventListener("keydown", (event) => { if (event.key === "Enter") run(); });
    spot.addEventListener("pointerenter", () => hover(text));
    svg.append(spot);
  });
  for (const t of linearTicks(low, low + counts.length * step)) svg.append(make("text", {x: box.left + ((t - low) / step) * wide, y: height - box.bottom + 16, "text-anchor": "middle", class: "tick"}, tickText(t)));
  for (let count = 1; count <= most; count *= 10) svg.append(make("text", {x: box.left - 6, y: height - box.bottom - tall(count) + 4, "text-anchor": "end", class: "tick"}, tickText(count)));
  svg.append(make("path", {d: `M${box.left},${box.top}V${height - box.bottom}H${width - box.right}`, class: "axis"}),
    make("text", {x: width / 2, y: height - 6, "text-anchor": "middle", class: "label"}, `${formulaText()} [${FORMULAS[state.formula].unit}]`),
    make("text", {x: 13, y: height / 2, "text-anchor": "middle", class: "label", transform: `rotate(-90 13 ${height / 2})`}, "pixels (log)"));
  return svg;
}

/** The error's power by frequency, of each shown picture; bias² and variance apart where there are seeds. */
async function drawSpectrum() {
  const turn = probe.spectrumTurn = (probe.spectrumTurn ?? 0) + 1, lines = [];
  for (const key of shownKeys()) {
    if (key === REFERENCE) continue;
    const rings = await errorSpectrum(key);
    if (turn !== probe.spectrumTurn) return;
    if (!rings) continue;
    const cell = scene().cells[Number(key)], sum = rings.reduce((total, ring) => total + ring.total, 0);
    const part = (name, index, words) => ({name: `${cell.label}: ${words}`, method: cell.method, index, points: rings.filter((ring) => ring[name] !== null && ring[name] > 0)
      .map((ring) => ({x: ring.frequency, y: ring[name], title: `${cell.label}: ${words} ${short(ring[name])} at ${short(ring.frequency, 3)} per pixel; all rings together ${short(sum)}`}))});
    lines.push(part("total", 0, "bias² + variance"));
    if (rings[0].variance !== null && key === rightKey()) lines.push(part("variance", 2, "variance"), part("bias2", 1, "bias²"));
  }
  byId("spectrum").replaceChildren(plot(lines.filter((line) => line.points.length), {x: "frequency [1 / pixel], mean of a ring", y: "power [(W m⁻² sr⁻¹)²], sum of a ring", logX: false, logY: true, width: 620, height: 340, legend: true,
    title: "error spectrum over the seeds", empty: "no reference, or no picture"}));
  byId("spectrum").dataset.ready = String(turn);
}
