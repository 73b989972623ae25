// Plots as SVG: lines with markers, intervals, hover, and axes that are logarithmic where all values are positive.

const MARKER_PATHS = ["M-4,0a4,4 0 1,0 8,0a4,4 0 1,0 -8,0", "M-3.6,-3.6h7.2v7.2h-7.2z", "M0,-4.6L4.4,3.4H-4.4z",
  "M0,-5L4,0L0,5L-4,0z", "M0,4.6L4.4,-3.4H-4.4z", "M-1.4,-4.4h2.8v3h3v2.8h-3v3h-2.8v-3h-3v-2.8h3z",
  "M-4,-2.4L-2.4,-4L0,-1.6L2.4,-4L4,-2.4L1.6,0L4,2.4L2.4,4L0,1.6L-2.4,4L-4,2.4L-1.6,0z"];
const DASHES = ["", "7 3", "2 2.5", "9 3 2 3", "12 3", "5 2 1 2 1 2"];

/** Ticks of a logarithmic axis: 1, 2, 5 of each decade below two decades, else powers of ten; at least two of them. */
function logTicks(low, high) {
  for (const digits of [[1], [1, 2, 5], [1, 2, 3, 4, 5, 6, 7, 8, 9]]) {
    const ticks = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
      for (const digit of digits) { const t = digit * 10 ** power; if (t >= low * 0.9999 && t <= high * 1.0001) ticks.push(t); }
    if (ticks.length >= 3) return ticks.length > 9 ? ticks.filter((_, i) => i % Math.ceil(ticks.length / 8) === 0) : ticks;
  }
  return linearTicks(low, high);
}

function linearTicks(low, high) {
  const rough = (high - low) / 5 || 1, unit = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((digit) => digit * unit).find((each) => each >= rough) ?? rough;
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(k * step);
  return ticks;
}

function tickText(number) {
  const size = Math.abs(number);
  if (size >= 1e5 || (size > 0 && size < 1e-3)) return short(number, 1).replace(/^1 · /, "").replace(/\.(?= )/, "");
  return String(Number(number.toPrecision(6))).replace("-", "−");
}

/** An axis over values: {low, high, log, of(value) in 0..1, ticks}. */
function axis(values, log, wanted = {}) {
  let [low, high] = [Math.min(...values), Math.max(...values)];
  const isLog = log && low > 0;
  if (isLog) {
    const room = Math.max(Math.log(high / low) * 0.06, 0.08);
    [low, high] = [low * Math.exp(-room), high * Math.exp(room)];
  } else {
    const room = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
    [low, high] = [wanted.zero && low >= 0 ? 0 : low - room, high + room];
  }
  const of = isLog ? (x) => Math.log(x / low) / Math.log(high / low) : (x) => (x - low) / (high - low);
  return {low, high, log: isLog, of, ticks: isLog ? logTicks(low, high) : linearTicks(low, high)};
}

/**
 * A plot. lines: [{name, method, index, points: [{x, y, low, high, title, key}]}], `index` telling a method's lines apart;
 * options: {x, y: labels, title, width, height, logX, logY, levels: [{y, name}], pick(point), legend: under it}.
 */
function plot(lines, options) {
  const width = options.width ?? 640, height = options.height ?? 360;
  const box = {left: 68, right: 14, top: options.title ? 30 : 12, bottom: 46};
  const points = lines.flatMap((line) => line.points);
  const svg = make("svg", {class: "plot", width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": options.title ?? `${options.y} over ${options.x}`});
  if (options.title) svg.append(make("text", {x: box.left, y: 18, class: "plot-title"}, options.title));
  if (points.length === 0) {
    svg.append(make("text", {x: width / 2, y: height / 2, "text-anchor": "middle", class: "label"}, options.empty ?? "nothing to draw"));
    return svg;
  }
  const ys = points.map((point) => point.y).concat((options.levels ?? []).map((level) => level.y));
  const bounds = points.flatMap((point) => [point.low, point.high]).filter((y) => y !== undefined && (!options.logY || y > 0));
  const smallest = Math.min(...ys.filter((y) => y > 0)) / 3; // an interval may reach far down: it is cut at the frame
  const x = axis(points.map((point) => point.x), options.logX);
  const y = axis(ys.concat(bounds.filter((each) => !options.logY || each >= smallest)), options.logY, {zero: !options.logY});
  const toX = (v) => box.left + x.of(v) * (width - box.left - box.right);
  const toY = (v) => height - box.bottom - Math.max(-0.02, Math.min(1.02, !y.log || v > 0 ? y.of(v) : -0.02)) * (height - box.top - box.bottom);
  frame(svg, x, y, toX, toY, box, width, height, options);
  for (const level of options.levels ?? []) {
    svg.append(make("line", {x1: box.left, x2: width - box.right, y1: toY(level.y), y2: toY(level.y), class: "level"}),
      make("text", {x: width - box.right, y: toY(level.y) - 4, "text-anchor": "end", class: "level-name"}, level.name));
  }
  for (const line of lines) drawLine(svg, line, toX, toY, options);
  if (options.legend) addLegend(svg, lines); else svg.lines = lines; // for the legend of a file
  return svg;
}

/** The sign of a line: its colour, dash and marker. */
function lineSign(line) {
  const colour = line.colour ?? methodColour(line.method);
  return [make("path", {d: "M1,7H43", class: "line", style: `stroke:${colour}`, "stroke-dasharray": DASHES[(line.index ?? 0) % DASHES.length]}),
    make("path", {d: MARKER_PATHS[METHODS.indexOf(line.method) % 7], transform: "translate(22 7)", class: "mark",
      style: `stroke:${colour};fill:${(line.index ?? 0) % 2 ? "var(--paper)" : colour}`})];
}

/** Puts a legend under a plot, in as many columns as its names leave room for. */
function addLegend(svg, lines) {
  const [width, height] = [Number(svg.getAttribute("width")), Number(svg.getAttribute("height"))];
  const columns = (width - 68) / 2 > 60 + 6.2 * Math.max(0, ...lines.map((line) => line.name.length)) ? 2 : 1;
  lines.forEach((line, i) => svg.append(make("g", {transform: `translate(${68 + (i % columns) * (width - 68) / 2} ${height + 4 + 18 * Math.floor(i / columns)})`},
    lineSign(line), make("text", {x: 50, y: 11, class: "tick"}, line.name))));
  const tall = height + 10 + 18 * Math.ceil(lines.length / columns);
  svg.setAttribute("height", tall);
  svg.setAttribute("viewBox", `0 0 ${width} ${tall}`);
}

function frame(svg, x, y, toX, toY, box, width, height, options) {
  const bottom = height - box.bottom;
  for (const tick of x.ticks) svg.append(make("line", {x1: toX(tick), x2: toX(tick), y1: box.top, y2: bottom, class: "grid"}),
    make("text", {x: toX(tick), y: bottom + 16, "text-anchor": "middle", class: "tick"}, tickText(tick)));
  for (const tick of y.ticks) svg.append(make("line", {x1: box.left, x2: width - box.right, y1: toY(tick), y2: toY(tick), class: "grid"}),
    make("text", {x: box.left - 6, y: toY(tick) + 4, "text-anchor": "end", class: "tick"}, tickText(tick)));
  svg.append(make("path", {d: `M${box.left},${box.top}V${bottom}H${width - box.right}`, class: "axis"}),
    make("text", {x: (box.left + width - box.right) / 2, y: height - 8, "text-anchor": "middle", class: "label"}, options.x),
    make("text", {x: 14, y: (box.top + bottom) / 2, "text-anchor": "middle", class: "label", transform: `rotate(-90 14 ${(box.top + bottom) / 2})`}, options.y));
}

function drawLine(svg, line, toX, toY, options) {
  const colour = line.colour ?? methodColour(line.method), shape = MARKER_PATHS[METHODS.indexOf(line.method) % 7] ?? MARKER_PATHS[0];
  const path = line.points.map((point, i) => `${i ? "L" : "M"}${toX(point.x).toFixed(1)},${toY(point.y).toFixed(1)}`).join("");
  svg.append(make("path", {d: path, class: "line", style: `stroke:${colour}`, "stroke-dasharray": DASHES[(line.index ?? 0) % DASHES.length]}));
  for (const point of line.points) {
    const [px, py] = [toX(point.x), toY(point.y)];
    if (point.low !== undefined) svg.append(make("path", {d: `M${px},${toY(point.low)}V${toY(point.high)}`, class: "interval", style: `stroke:${colour}`}));
    const mark = make("path", {d: shape, transform: `translate(${px} ${py})`, class: `mark${(line.index ?? 0) % 2 ? " hollow" : ""}`,
      style: `stroke:${colour};fill:${(line.index ?? 0) % 2 ? "var(--paper)" : colour}`});
    const spot = make("g", {class: "spot", tabindex: options.pick ? 0 : null, role: options.pick ? "button" : null,
      "aria-label": point.title}, mark, make("circle", {cx: px, cy: py, r: 9, class: "halo"}), make("title", {}, point.title));
    spot.addEventListener("pointerenter", () => hover(point.title));
    spot.addEventListener("focus", () => hover(point.title));
    if (options.pick) {
      spot.addEventListener("click", () => options.pick(point));
      spot.addEventListener("keydown", (event) => { if (event.key === "Enter") options.pick(point); });
    }
    svg.append(spot);
  }
}

function hover(text) { byId("status").textContent = text; }

/** An SVG file of what is drawn: colours and fonts are written into it, in the light palette. */
function svgText(svg) {
  const theme = document.documentElement.dataset.theme;
  document.documentElement.dataset.theme = "light";
  const copied = svg.cloneNode(true);
  if (svg.lines) addLegend(copied, svg.lines);
  const host = make("div", {style: "position:absolute;left:-10000px"}, copied);
  document.body.append(host);
  const clone = host.firstChild;
  clone.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  const kept = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "font-family", "font-weight", "opacity", "paint-order"];
  for (const element of clone.querySelectorAll("*")) {
    const style = getComputedStyle(element);
    element.setAttribute("style", kept.map((name) => `${name}:${style.getPropertyValue(name)}`).join(";"));
    for (const name of ["class", "tabindex", "role", "aria-label"]) element.removeAttribute(name);
  }
  const text = new XMLSerializer().serializeToString(clone);
  host.remove();
  if (theme) document.documentElement.dataset.theme = theme; else delete document.documentElement.dataset.theme;
  return text;
}
