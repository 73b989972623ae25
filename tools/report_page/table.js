// The table: cells with their intervals, or every record as records.csv has it; sorted, filtered, with commands to copy.

function sortBy(name) {
  const [column, way] = state.sort.split(":");
  change({sort: column === name ? (way === "down" ? "" : `${name}:down`) : `${name}:up`});
}

/** Rows as {texts: {column: text}, sort: {column: value}, key, tied, extra: elements}. */
function cellRows() {
  const rows = [];
  page.scenes.forEach((where, s) => where.cells.forEach((cell, i) => {
    const texts = {scene: where.title, method: `${methodSign(cell.method)} ${cell.method}`, settings: cell.label.replace(cell.method, "").replace(/^, /, ""), seeds: String(cell.seeds.length), best: cell.tied ? "★" : ""};
    const sort = {...texts, method: cell.method, seeds: cell.seeds.length};
    for (const name of page.errors) { texts[name] = cell.errors[name] ? withInterval(cell.errors[name]) : ""; sort[name] = cell.errors[name]?.[0]; }
    for (const name of page.costs) { texts[name] = cell.costs[name] === undefined ? "" : short(cell.costs[name]); sort[name] = cell.costs[name]; }
    rows.push({texts, sort, title: cell.label, run: () => { if (Number(state.scene) !== s) chooseScene(s); showCell(i); }});
  }));
  return rows;
}

function recordRows() {
  const kept = new Map();
  for (const where of page.scenes) for (const cell of where.cells) for (const each of cell.pictures) kept.set(each.trial, each);
  return page.tables.flatMap((table) => table.rows.map((fields) => {
    const texts = Object.fromEntries(table.header.map((name, i) => [name, fields[i]]));
    const sort = Object.fromEntries(Object.entries(texts).map(([name, text]) => [name, text !== "" && !Number.isNaN(Number(text)) ? Number(text) : text]));
    return {texts, sort, picture: kept.get(texts.trial)};
  }));
}

const CELL_COLUMNS = ["best", "scene", "method", "settings", "seeds"];
const RECORD_COLUMNS = ["trial", "status", "scene", "method", "seed", "rmse", "relmse", "total_s", "cpu_s", "picture_hash", "config_hash"];

function allColumns() {
  return state.rows === "cells" ? [...CELL_COLUMNS, ...page.errors, ...page.costs] : [...new Set(page.tables.flatMap((table) => table.header))];
}

function shownColumns() {
  const known = allColumns(), named = state.columns ? state.columns.split(".").filter((name) => known.includes(name)) : [];
  if (state.rows !== "cells") return named.length ? named : RECORD_COLUMNS.filter((name) => known.includes(name));
  const usual = ["rmse", "relmse", "bias", "flip", "indirect_rmse", "build_s", "query_s", "work_s", "map_bytes"].filter((name) => known.includes(name));
  return [...CELL_COLUMNS, ...(named.length ? named.filter((name) => !CELL_COLUMNS.includes(name)) : usual)];
}

function drawTable() {
  const columns = shownColumns(), words = state.filter.toLowerCase().split(/\s+/).filter(Boolean);
  let rows = state.rows === "cells" ? cellRows() : recordRows();
  const all = rows.length;
  rows = rows.filter((row) => words.every((word) => Object.entries(row.texts).some(([name, text]) => (columns.includes(name) || name === "settings") && text.toLowerCase().includes(word))));
  const [column, way] = state.sort.split(":");
  if (column) rows.sort((a, b) => (way === "down" ? -1 : 1) * compare(a.sort[column], b.sort[column]));
  const head = columns.map((name) => make("th", {scope: "col", "aria-sort": column === name ? (way === "down" ? "descending" : "ascending") : "none"},
    make("button", {type: "button", title: page.words[name] ?? name, onclick: () => sortBy(name)}, `${name}${page.units[name] ? ` [${page.units[name]}]` : ""}${column === name ? (way === "down" ? " ▼" : " ▲") : ""}`)));
  const body = rows.map((row) => make("tr", {class: row.texts.best === "★" ? "tied" : null}, columns.map((name) => make("td", {"data-column": name}, row.texts[name] ?? "")), make("td", {}, rowButtons(row))));
  byId("table").replaceChildren(make("table", {}, make("thead", {}, make("tr", {}, head, make("th", {scope: "col"}, state.rows === "cells" ? "picture" : "command"))), make("tbody", {}, body)));
  byId("table-count").textContent = `${rows.length} of ${all} rows. ${state.rows === "cells" ? tieText() : "Every field as records.csv has it."} `
    + columns.filter((name) => page.errors.includes(name)).map((name) => page.words[name]).join("; ");
  drawColumnChoice(columns);
}

function tieText() {
  const few = page.scenes.filter((where) => where.seeds < 5).length;
  return "Mean over seeds ± half its 95 % interval (Student); times and sizes are medians."
    + (few < page.scenes.length ? " ★: least rmse of its scene, and all that the seeds do not tell from it (Welch's t of the logarithms, 95 %)." : "")
    + (few ? " With fewer than five seeds none is called the best." : "");
}

function compare(a, b) {
  if (a === undefined || a === "") return b === undefined || b === "" ? 0 : 1;
  if (b === undefined || b === "") return -1;
  return typeof a === typeof b ? (a < b ? -1 : a > b ? 1 : 0) : typeof a === "number" ? -1 : 1;
}

function rowButtons(row) {
  if (row.run) return [button("show", row.run, `show the picture of ${row.title}`)];
  if (!row.picture) return [];
  const buttons = [];
  if (row.picture.command) buttons.push(copyButton("command", row.picture.command));
  if (row.picture.hash) buttons.push(copyButton("hash", row.picture.hash));
  if (row.picture.hole) buttons.push(make("span", {class: "hole", title: row.picture.hole}, "no picture"));
  return buttons;
}

function copyButton(name, text) {
  const made = button(`copy ${name}`, () => copy(text, made), text, {class: "copy"});
  return made;
}

function drawColumnChoice(columns) {
  const host = byId("columns"), names = allColumns().filter((name) => state.rows !== "cells" || !CELL_COLUMNS.includes(name));
  host.replaceChildren(...names.map((name) => {
    const box = make("input", {type: "checkbox", checked: columns.includes(name), onchange: () => {
      const chosen = names.filter((each) => (each === name ? box.checked : columns.includes(each)));
      change({columns: chosen.join(".")});
    }});
    return make("label", {title: page.words[name] ?? ""}, box, ` ${name}`);
  }));
}

/** The shown rows and columns as CSV. */
function tableCsv() {
  const mark = (text) => (/^'*[=+\-@\t\r]/.test(text) && (text.startsWith("'") || Number.isNaN(Number(text))) ? `'${text}` : text);
  const quote = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  return [...byId("table").querySelectorAll("tr")].map((row) => [...row.children].slice(0, -1).map((each) => quote(mark(each.textContent))).join(",")).join("\n") + "\n";
}
