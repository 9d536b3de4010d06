// Lines, instructions, and the call tree.

// Lines by cost: {name: "file:line" or "", total, cycles by cause, instructions}.
function linesOf(run, causeNames) {
  const lines = new Map();
  for (const [pc, text, symbol, offset, frames, cycles, loads, hits] of run.instructions.filter((one) => one)) {
    const name = run.names[frames[0][1]], key = name || "";
    if (!lines.has(key)) lines.set(key, { name, total: 0, issued: 0, cycles: {}, loads: 0, hits: 0, instructions: [] });
    const line = lines.get(key), total = cycles.reduce((a, b) => a + b, 0);
    const own = Object.fromEntries(causeNames.map((cause, i) => [cause, cycles[i]]));
    for (const cause of causeNames) line.cycles[cause] = (line.cycles[cause] ?? 0) + own[cause];
    line.total += total;
    line.issued += own.issued;
    line.loads += loads;
    line.hits += hits;
    line.instructions.push({ pc, text, symbol, offset, frames, own, total, loads, hits });
  }
  return [...lines.values()].sort((a, b) => b.total - a.total || a.name.localeCompare(b.name));
}

const fileOf = (name) => name.slice(0, name.lastIndexOf(":"));
const numberOf = (name) => Number(name.slice(name.lastIndexOf(":") + 1));
const hex = (pc) => pc === null ? "" : pc.toString(16).padStart(8, "0");
const cell = (style, ...content) => element("td", { class: style }, ...content);

function drawSource({ stats, run, causes, lines, waits }) {
  const awaited = new Map([...waitsBy(waits, ({ line }) => line), ...waitsBy(waits, ({ address }) => Number(address))]
    .map((one) => [one.key, one.total]));
  const awaitedText = (key) => awaited.has(key) ? percent(awaited.get(key) / stats.thread_cycles) : "";
  const totalOf = (line) => line.total / stats.thread_cycles;
  const named = lines.filter((line) => line.name), files = new Map();
  for (const line of lines) {
    const file = line.name ? fileOf(line.name) : "";
    files.set(file, (files.get(file) ?? 0) + line.total);
  }
  const ranked = [...files.entries()].sort((a, b) => b[1] - a[1]);
  const textOf = (name) => (run.sources[fileOf(name)] ?? "").split("\n")[numberOf(name) - 1]?.trim() ?? "";
  const heads = [["line"], ["share", "n"], ["causes", "bar"], ["instructions", "n"], ["loads that hit", "n"], ["awaited", "n"],
    ["text", "clip"]];
  fillTable("lines-table", "The costliest lines", heads, named.slice(0, 12).map((line) => [
    [element("button", { type: "button", class: "code", onclick: () => run.openLine(line.name) }, locationOf(run, line.name)), line.name],
    [percent(totalOf(line)), line.total],
    stack(causes, line.cycles, named[0].total),
    [whole(line.issued), line.issued],
    line.loads ? [percent(line.hits / line.loads), line.hits / line.loads] : [element("span", { class: "soft" }, "no load"), -1],
    [awaitedText(line.name), awaited.get(line.name) ?? 0],
    element("code", {}, textOf(line.name))]));

  const choice = byId("source-file");
  const short = (file) => file ? file.split("/").slice(-2).join("/") : "(no line is known)";
  choice.append(...ranked.map(([file, total], i) =>
    element("option", { value: i }, `${short(file)} (${percent(total / stats.thread_cycles)})`)));

  const instructionRow = (one) => element("tr", { class: "instruction" },
    cell("n", hex(one.pc)),
    cell("n", percent(one.total / stats.thread_cycles)),
    cell("bar", stack(causes, one.own, run.widest, "thin")),
    cell("n", whole(one.own.issued)),
    cell("n", one.loads ? percent(one.hits / one.loads) : ""),
    cell("n", awaitedText(one.pc)),
    cell("code", one.text || "(no text)",
      element("span", { class: "soft" }, `   ${one.frames.map(([name]) => run.names[name]).join(" in ")}`)));
  const rowOf = (number, text, line) => {
    const heat = line ? Math.round(45 * Math.sqrt(line.total / run.widest)) : 0;
    const row = element("tr", {
      class: `line${heat > 4 ? " hot" : ""}${line && totalOf(line) >= 0.001 ? "" : " cold"}`,
      style: heat > 4 ? `--heat: ${heat}%` : "",
      tabindex: line ? "0" : undefined, "data-line": number, "aria-expanded": line ? "false" : undefined,
    },
    cell("n soft", number),
    cell("n", line?.total ? percent(totalOf(line)) : ""),
    cell("bar", line ? stack(causes, line.cycles, run.widest) : ""),
    cell("n", line ? whole(line.issued) : ""),
    cell("n", line?.loads ? percent(line.hits / line.loads) : ""),
    cell("n", line ? awaitedText(line.name) : ""),
    cell("code", text));
    if (!line) return row;
    const below = line.instructions.map(instructionRow);
    const toggle = () => {
      const open = row.getAttribute("aria-expanded") === "true";
      row.setAttribute("aria-expanded", String(!open));
      if (open) below.forEach((one) => one.remove()); else row.after(...below);
    };
    row.addEventListener("click", toggle);
    row.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      toggle();
    });
    return row;
  };
  const show = () => {
    const file = ranked[choice.value]?.[0], text = file ? run.sources[file] : undefined;
    const own = new Map(lines.filter((line) => (line.name ? fileOf(line.name) : "") === file)
      .map((line) => [line.name ? numberOf(line.name) : 0, line]));
    const rows = text === undefined
      ? [...own.keys()].sort((a, b) => a - b)
        .map((number) => rowOf(number, number ? "" : "instructions of no known line", own.get(number)))
      : text.replace(/\n$/, "").split("\n").map((line, i) => rowOf(i + 1, line, own.get(i + 1)));
    const missing = text === undefined && file;
    byId("source-note").textContent = missing ? `${file} is not in this page: its lines have numbers only.` : file ?? "";
    const titles = ["line", "share", "causes", "instructions", "loads that hit", "awaited", ""];
    const head = titles.map((title) => element("th", { class: title === "causes" || !title ? "" : "n" }, title));
    byId("listing").replaceChildren(element("table", {},
      element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows)));
    return rows;
  };
  const toLine = (rows, number) => {
    const row = rows.find((one) => one.dataset.line === String(number));
    if (row) byId("listing").scrollTop = Math.max(0, row.offsetTop - byId("listing").clientHeight / 3);
    return row;
  };
  run.widest = Math.max(1, ...named.map((line) => line.total));
  run.openLine = (name) => {
    choice.value = String(ranked.findIndex(([file]) => file === fileOf(name)));
    const row = toLine(show(), numberOf(name));
    byId("listing").scrollIntoView({ block: "nearest" });
    if (row) { row.click(); row.focus({ preventScroll: true }); }
  };
  choice.addEventListener("change", show);
  const copied = Object.keys(run.sources);
  byId("source-files").append(element("summary", {}, `${copied.length} source files are copied into this page`),
    element("p", {}, copied.join(", ")),
    run.left_out ? element("p", {}, `Left out, since they do not lie in the program's folder: ${run.left_out}. ` +
      "--source-folder FOLDER allows others.") : undefined);
  const [first] = named;
  if (first) choice.value = String(ranked.findIndex(([file]) => file === fileOf(first.name)));
  toLine(show(), first ? numberOf(first.name) : 0);
}

// Makes the tree of the stacks that --profile-folded writes. A stack has functions, a line, and a cause.
function treeOf(folded) {
  const root = { name: "", own: {}, all: {}, total: 0, below: new Map() };
  for (const line of folded.trim().split("\n").filter((one) => one)) {
    const space = line.lastIndexOf(" "), count = Number(line.slice(space + 1));
    const frames = line.slice(0, space).split(";"), cause = frames.pop();
    if (/:\d+$/.test(frames.at(-1))) frames.pop();
    let node = root;
    const add = () => { node.all[cause] = (node.all[cause] ?? 0) + count; node.total += count; };
    add();
    for (const name of frames) {
      if (!node.below.has(name)) node.below.set(name, { name, own: {}, all: {}, total: 0, below: new Map() });
      node = node.below.get(name);
      add();
    }
    node.own[cause] = (node.own[cause] ?? 0) + count;
  }
  return root;
}

function drawCalls({ stats, run, causes }) {
  const root = treeOf(run.folded), share = (cycles) => percent(cycles / stats.thread_cycles);
  const sum = (own) => Object.values(own).reduce((a, b) => a + b, 0);
  const nodeOf = (node, depth) => {
    const below = [...node.below.values()].sort((a, b) => b.total - a.total || a.name.localeCompare(b.name));
    const row = element("span", { class: "row", style: `--depth: ${depth}` },
      element("code", {}, node.name), element("span", {}, share(node.total)), element("span", {}, share(sum(node.own))),
      stack(causes, node.all, root.total));
    const details = element("details", { class: below.length ? "" : "leaf" }, element("summary", {}, row));
    const fill = () => {
      if (below.length && details.childElementCount === 1) details.append(...below.map((one) => nodeOf(one, depth + 1)));
    };
    details.addEventListener("toggle", () => { if (details.open) fill(); });
    if (below.length && node.total > 0.1 * root.total && depth < 12) { fill(); details.open = true; }
    return details;
  };
  const heads = ["function", "all", "own", "causes of all"].map((title) => element("span", {}, title));
  byId("calls-tree").append(element("div", { class: "row head", style: "--depth: 0" }, ...heads),
    ...[...root.below.values()].sort((a, b) => b.total - a.total).map((node) => nodeOf(node, 0)));
}
