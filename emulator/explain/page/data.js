"use strict";
// The data: what trax-sim writes as JSON and CSV, packed; and what all parts of the page use.

const byId = (id) => document.getElementById(id);

async function unpack(id) {
  const text = atob(byId(id).textContent), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  byId(id).remove();
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// A table as --heat and the like write it: rows as objects; what is a number becomes one.
function rowsOf(csv) {
  const lines = csv.trim().match(/([^"\n]|"([^"]|"")*")+/g), heads = lines[0].split(","); // a quoted name may have any character
  return lines.slice(1).map((line) => {
    const cells = line.match(/("([^"]|"")*"|[^,]*)(,|$)/g).map((cell) => cell.replace(/,$/, ""));
    return Object.fromEntries(heads.map((head, i) => {
      const cell = cells[i] ?? "";
      const isNumber = cell !== "" && !cell.startsWith("\"") && !Number.isNaN(Number(cell)) && !cell.startsWith("0x");
      return [head, isNumber ? Number(cell) : cell.replace(/^"|"$/g, "").replace(/""/g, "\"")];
    }));
  });
}

// Reads LEB128 numbers, one after another.
function numbersIn(bytes) {
  let at = 0;
  return () => {
    let value = 0, scale = 1, byte;
    do {
      byte = bytes[at++];
      value += (byte & 127) * scale;
      scale *= 128;
    } while (byte >= 128);
    return value;
  };
}

// Each column of the picture.
function columnsOf(picture, next) {
  const pixels = picture.width * picture.height, columns = {};
  for (const [group, name, unit, meaning] of picture.columns.filter((column) => column)) {
    const values = new Float64Array(pixels);
    for (let i = 0; i < pixels; i++) values[i] = next();
    columns[group ? `${group}.${name}` : name] = { group, name, unit, meaning, values };
  }
  return columns;
}

// A figure by its name with dots, as docs/statistics.md has them.
const figure = (stats, name) => name.split(".").reduce((level, part) => level === undefined ? undefined : level[part], stats);

// --- numbers as text ---

const whole = (value) => Math.round(value).toLocaleString("en-US");
const percent = (share) => !Number.isFinite(share) ? "" : share === 0 ? "0 %" : share < 0.0005 ? "< 0.1 %" :
  `${(100 * share).toFixed(1)} %`;
function digits(value, places = 3) {
  if (value === 0 || !Number.isFinite(value)) return "0";
  if (Math.abs(value) >= 1e5 || Math.abs(value) < 1e-4)
    return value.toExponential(places - 1).replace("e", "\u00a0\u00d7\u00a010^").replace("^+", "^");
  return Number(value.toPrecision(places)).toLocaleString("en-US", { maximumSignificantDigits: places });
}
// With a prefix of the SI, as of 2.9e-3 s.
function scaled(value, unit, places = 3) {
  const steps = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "\u00b5"], [1e-9, "n"], [1e-12, "p"]];
  const [factor, prefix] = steps.find(([least]) => Math.abs(value) >= least) ?? [1, ""];
  return `${digits(value / factor, places)} ${prefix}${unit}`;
}
const bytesText = (value) => scaled(value, "B");
const sizeText = (value) => // of memories
  value >= 2 ** 20 ? `${digits(value / 2 ** 20)} MiB` : value >= 1024 ? `${digits(value / 1024)} KiB` : `${value} B`;
const valueText = (value, unit) => typeof value !== "number" ? String(value) : unit === "fraction" ? percent(value) :
  unit === "J" || unit === "W" || unit === "s" ? scaled(value, unit) :
  Number.isInteger(value) ? whole(value) : digits(value, 6);

// --- elements ---

// element("td", {class: "n"}, child, ...); text is text, never markup.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "style") made.style.cssText = value;
    else if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value !== undefined && value !== false) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child !== undefined && child !== null));
  return made;
}
function shape(tag, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

// columns: [head, n for numbers or another class, what orders it].
// rows: arrays of cells, each a text, an element, or [what is shown, its order].
function fillTable(id, title, columns, rows, sortable = true) {
  const table = byId(id), body = element("tbody");
  const heads = columns.map(([head, kind], column) => element("th", { class: kind, scope: "col" },
    sortable && head && kind !== "wide" ? element("button", { type: "button", onclick: () => sortBy(column) }, head) : head));
  const made = rows.map((cells, number) => ({
    number,
    order: cells.map((cell) => Array.isArray(cell) ? cell[1] : cell),
    row: element("tr", {}, ...cells.map((cell, column) => element(column ? "td" : "th",
      { class: columns[column][1], scope: column ? undefined : "row" }, ...(Array.isArray(cell) ? [cell[0]] : [cell])))),
  }));
  function sortBy(column) {
    const descending = heads[column].getAttribute("aria-sort") !== "descending" && columns[column][1] === "n" ||
      heads[column].getAttribute("aria-sort") === "ascending";
    for (const head of heads) head.removeAttribute("aria-sort");
    heads[column].setAttribute("aria-sort", descending ? "descending" : "ascending");
    const compare = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en");
    made.sort((a, b) => (descending ? -1 : 1) * compare(a.order[column], b.order[column]) || a.number - b.number);
    body.append(...made.map((one) => one.row));
  }
  body.append(...made.map((one) => one.row));
  table.replaceChildren(element("caption", {}, title), element("thead", {}, element("tr", {}, ...heads)), body);
  return made.map((one) => one.row);
}

const partBar = (share, colour) => element("div", { class: "part",
  style: `width: ${100 * Math.min(1, share)}%${colour ? `; background: ${colour}` : ""}`, "aria-hidden": "true" });

// --- what is told under the pointer ---

const tip = element("div", { id: "tip", role: "tooltip", hidden: "" });
function tell(text, x, y) {
  tip.textContent = text;
  tip.hidden = false;
  tip.style.left = `${Math.max(4, Math.min(x + 14, innerWidth - tip.offsetWidth - 8))}px`;
  tip.style.top = `${y + tip.offsetHeight + 22 > innerHeight ? Math.max(4, y - tip.offsetHeight - 10) : y + 18}px`;
}
const untell = () => { tip.hidden = true; };

// --- causes ---

// Each cause has one colour on every page. The hue says what is behind it, the shade which cause it is: per cent of white, or of black
// below 0. The order is that of the bars.
const COLOURS = {
  issued: ["issued", 0], icache_bank_conflict: ["fetch", 0], icache_miss: ["fetch", -24],
  wait_local: ["cache", 58], wait_dcache_hit: ["cache", 34], dcache_bank_conflict: ["cache", 0],
  wait_memory: ["memory", 0], memory_queue_full: ["memory", 34],
  fp_add_conflict: ["unit", 0], fp_mul_conflict: ["unit", 34], int_mul_conflict: ["unit", 58],
  special_conflict: ["unit", -24], wait_special: ["unit", -40], ray_conflict: ["unit", -12],
  wait_atomic: ["atomic", 0], wait_other: ["other", 0], branch_bubble: ["other", 34], halted: ["ended", 0],
};
// The shade of a unit that was added to the machine, by its name.
const shadeOf = (cause) => [46, -32, 20, -48][Array.from(cause).reduce((sum, letter) => sum + letter.charCodeAt(0), 0) % 4];
const lookOf = (cause) => COLOURS[cause] ?? [cause.endsWith("_conflict") || cause.startsWith("wait_") ? "unit" : "other", shadeOf(cause)];
function colourOf(cause) {
  const [family, shade] = lookOf(cause);
  return shade === 0 ? `var(--${family})` : `color-mix(in oklab, var(--${family}), ${shade > 0 ? "white" : "black"} ${Math.abs(shade)}%)`;
}

function causesOf(stats, figures) {
  const order = [...new Set(Object.values(COLOURS).map(([family]) => family))],
    meanings = new Map(figures.map(([name, , meaning]) => [name, meaning]));
  const names = Object.keys(stats.causes).filter((name) => stats.causes[name] > 0);
  names.sort((a, b) => order.indexOf(lookOf(a)[0]) - order.indexOf(lookOf(b)[0]));
  return names.map((name) => ({ name, colour: colourOf(name), meaning: meanings.get(`causes.${name}`), total: stats.causes[name] }));
}

// The share of a cache's lookups that hit; of none there is no share.
const lookups = (cache) => cache.hits + cache.misses + cache.merged;
const hitShare = (cache) => lookups(cache) ? percent(cache.hits / lookups(cache)) : "\u2013";

// A bar of causes; cycles: by name. whole: what its full width is.
function stack(causes, cycles, total, kind = "", labels = false, whose = "") {
  return element("div", { class: `stack ${kind}`, "aria-hidden": "true" },
    ...causes.filter(({ name }) => cycles[name] > 0).map(({ name, colour }) => {
    const share = cycles[name] / total, text = `${name} ${percent(share)}`;
    return element("i", { style: `--c: ${colour}; width: ${100 * share}%`,
      "data-tip": `${whose}${text}\n${whole(cycles[name])} thread-cycles` },
      labels && share > 0.05 ? element("span", {}, share > 0.14 ? text : percent(share)) : undefined);
  }));
}
