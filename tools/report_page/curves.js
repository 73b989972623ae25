// Curves: a number of every cell over what it cost, a line for cells of one method that differ in one number only.

/** Lines of cells: {method, name, index, cells}; those hidden by the user are marked. */
function cellLines() {
  const groups = new Map();
  scene().cells.forEach((cell, i) => {
    const name = cell.line.join(", ");
    if (!groups.has(name)) groups.set(name, {name, method: cell.method, cells: []});
    groups.get(name).cells.push(i);
  });
  const lines = [...groups.values()].sort((a, b) => rank(a.method) - rank(b.method) || (a.name < b.name ? -1 : 1));
  const seen = {};
  for (const line of lines) { line.index = seen[line.method] = (seen[line.method] ?? -1) + 1; line.hidden = hiddenLines().includes(line.name); }
  return lines;
}

function hiddenLines() { return state.hidden ? state.hidden.split("|") : []; }

/** A cell's place along an axis: a cost, or a parameter of its own. */
function costOf(cell, name) {
  return name.startsWith("parameter:") ? numberOrNull(cell.parameters[name.slice(10)]) : cell.costs[name] ?? null;
}

function numberOrNull(text) { return text === undefined || text === "" || Number.isNaN(Number(text)) ? null : Number(text); }

/** Lines with points, by a function from a cell's number to {y, low, high} or null; points without a place are left out. */
function linesOver(cost, valueOf) {
  return cellLines().filter((line) => !line.hidden).map((line) => ({...line, points: line.cells.map((i) => {
    const cell = scene().cells[i], x = costOf(cell, cost), found = valueOf(i);
    if (x === null || !found || !Number.isFinite(found.y)) return null;
    return {x, ...found, key: i, title: `${cell.label}: ${short(found.y)}${found.low !== undefined ? ` (95 %: ${short(found.low)} to ${short(found.high)})` : ""} at ${short(x)} ${costWord(cost)}`};
  }).filter(Boolean).sort((a, b) => a.x - b.x)})).filter((line) => line.points.length);
}

function costWord(cost) { return cost.startsWith("parameter:") ? cost.slice(10) : `${page.names[cost]} [${page.units[cost] ?? "1"}]`; }
function costLabel(cost) {
  if (cost.startsWith("parameter:")) return cost.slice(10);
  return `${page.words[cost] ?? cost}`;
}

function metricPoint(cell) {
  const error = cell.errors[state.metric];
  if (!error) return null;
  const y = state.metric === "bias" ? Math.abs(error[0]) : error[0];
  return error[1] === null || error[1] === 0 ? {y} : {y, low: y - error[1], high: y + error[1]};
}

function curvePlot(width, height, pick) {
  const lines = linesOver(state.cost, (i) => metricPoint(scene().cells[i]));
  const own = scene().cells.find((cell) => cell.references_error)?.references_error;
  const signedRatio = state.metric.endsWith("mean_ratio");
  return plot(lines, {x: costLabel(state.cost), y: `${state.metric === "bias" ? "|bias|" : state.metric} [${page.units[state.metric] ?? "1"}]`, width, height,
    title: `${scene().title}: ${state.metric} over ${costWord(state.cost)}`, logX: true, logY: !signedRatio,
    levels: state.metric === "rmse" && own ? [{y: own, name: "standard error of the reference"}] : signedRatio ? [{y: 1, name: "1"}] : [], pick});
}

/** The legend of all lines: a switch for each, with its sign and fitted slope. */
function legend(lines) {
  const drawn = new Map(lines.map((line) => [line.name, line]));
  return cellLines().map((line) => {
    const slope = drawn.has(line.name) && isWide(drawn.get(line.name).points) ? fittedSlope(drawn.get(line.name).points) : null;
    const svg = make("svg", {width: 44, height: 14, viewBox: "0 0 44 14", class: "plot"}, lineSign(line));
    const text = slope ? ` slope ${short(slope.slope, 3)}${slope.error === null ? "" : ` ± ${short(slope.error, 2)}`}` : "";
    return make("button", {type: "button", class: "line-switch", "aria-pressed": String(!line.hidden), "data-line": line.name, title: "show or hide this line",
      onclick: () => toggleLine(line.name)}, svg, make("span", {}, line.name), make("small", {}, text));
  });
}

/** Points of about one cost have no slope over it. */
function isWide(points) { return points.at(-1).x > 1.5 * points[0].x; }

function toggleLine(name) {
  const hidden = hiddenLines();
  change({hidden: (hidden.includes(name) ? hidden.filter((each) => each !== name) : [...hidden, name]).join("|")});
}

/** A cell picked in a plot is added to the pictures. */
function showCell(key) {
  const keys = shownKeys();
  if (!keys.includes(String(key))) keys.push(String(key));
  change({pictures: keys.slice(-9).join("."), right: String(key)});
}

function drawCurves() {
  const lines = linesOver(state.cost, (i) => metricPoint(scene().cells[i]));
  byId("curve").replaceChildren(curvePlot(760, 420, (point) => showCell(point.key)));
  byId("curve-legend").replaceChildren(...legend(lines));
  byId("opening-curve").replaceChildren(curvePlot(560, 330, (point) => showCell(point.key)));
  byId("opening-legend").replaceChildren(...legend(lines));
  byId("curve-words").textContent = `${page.words[state.metric] ?? state.metric}. Points: means over seeds; bars: 95 % intervals (Student), cut at the frame. `
    + "Slopes: least squares through the logarithms ± standard error (none for two points). Click a point to add its picture.";
}
