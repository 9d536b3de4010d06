// Lines, instructions, and the call tree.

// Lines by cost: {name: "file:line" or "", total, cycles by cause, instructions}.
function linesOf(run, causeNames) {
  const lines = new Map();
  for (const [pc, text, symbol, offset, frames, cycles, loads, hits] of run.instructions.filter((one) => one)) {
    const name = run.names[frames[0][1]], key = name || "";
    if (!lines.has(key)) lines.set(key, { name, total: 0, issued: 0, cycles: {}, loads: 0, hits: 0, instructions: [] });
    const line = lines.get(key), own = Object.fromEntries(causeNames.map((cause, i) => [cause, cycles[i]])), total = cycles.reduce((a, b) => a + b, 0);
    for (const cause of causeNames) line.cycles[cause] = (line.cycles[cause] ?? 0) + own[cause];
    line.total += total;
    line.issued += own.issued;
    line.loads += loads;
    line.hits += hits;
    line.instructions.push({ pc, text, symbol, offset, frames, own, total, loads, hits });
  }
  return [...lines.values()].sort((a, b) => b.total - a.total || a.name.localeCompare(b.name));
}

const fileOf = (name) => name.slice(0, name.lastIndexOf(":")), numberOf = (name) => Number(name.slice(name.lastIndexOf(":") + 1));
const hex = (pc) => pc === null ? "" : pc.toString(16).padStart(8, "0");

function drawSource({ stats, run, causes, lines }) {
  const totalOf = (line) => line.total / stats.thread_cycles, files = new Map();
  for (const line of lines) files.set(line.name ? fileOf(line.name) : "", (files.get(line.name ? fileOf(line.name) : "") ?? 0) + line.total);
  const ranked = [...files.entries()].sort((a, b) => b[1] - a[1]), textOf = (name) => (run.sources[fileOf(name)] ?? "").split("\n")[numberOf(name) - 1]?.trim() ?? "";
  fillTable("lines-table", "The costliest lines", [["line"], ["share", "n"], ["causes", "bar"], ["instructions", "n"], ["loads that hit", "n"], ["text", "clip"]], lines.filter((line) => line.name).slice(0, 12).map((line) => [
    [element("button", { type: "button", class: "code", onclick: () => run.openLine(line.name) }, locationOf(run, line.name)), line.name], [percent(totalOf(line)), line.total],
    stack(causes, line.cycles, lines.find((one) => one.name).total), [whole(line.issued), line.issued],
    line.loads ? [percent(line.hits / line.loads), line.hits / line.loads] : [element("span", { class: "soft" }, "no load"), -1], element("code", {}, textOf(line.name))]));

  const choice = byId("source-file"), short = (file) => file ? file.split("/").slice(-2).join("/") : "(no line is known)";
  choice.append(...ranked.map(([file, total], i) => element("option", { value: i }, `${short(file)} (${percent(total / stats.thread_cycles)})`)));

  const instructionRow = (one) => element("tr", { class: "instruction" }, element("td", { class: "n" }, hex(one.pc)), element("td", { class: "n" }, percent(one.total / stats.thread_cycles)),
    element("td", { class: "bar" }, stack(causes, one.own, run.widest, "thin")), element("td", { class: "n" }, whole(one.own.issued)), element("td", { class: "n" }, one.loads ? percent(one.hits / one.loads) : ""),
    element("td", { class: "code" }, one.text || "(no text)", element("span", { class: "soft" }, `   ${one.frames.map(([name]) => run.names[name]).join(" in ")}`)));
  const rowOf = (number, text, line) => {
    const heat = line ? Math.round(45 * Math.sqrt(line.total / run.widest)) : 0;
    const row = element("tr", { class: `line${heat > 4 ? " hot" : ""}${line && totalOf(line) >= 0.001 ? "" : " cold"}`, style: heat > 4 ? `--heat: ${heat}%` : "", tabindex: line ? "0" : undefined, "data-line": number, "aria-expanded": line ? "false" : undefined },
      element("td", { class: "n soft" }, number), element("td", { class: "n" }, line?.total ? percent(totalOf(line)) : ""), element("td", { class: "bar" }, line ? stack(causes, line.cycles, run.widest) : ""),
      element("td", { class: "n" }, line ? whole(line.issued) : ""), element("td", { class: "n" }, line?.loads ? percent(line.hits / line.loads) : ""), element("td", { class: "code" }, text));
    if (!line) return row;
    const below = line.instructions.map(instructionRow);
    const toggle = () => {
      const open = row.getAttribute("aria-expanded") === "true";
      row.setAttribute("aria-expanded", String(!open));
      if (open) below.forEach((one) => one.remove()); else row.after(...below);
    };
    row.addEventListener("click", toggle);
    row.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); toggle(); } });
    return row;
  };
  const show = () => {
    const file = ranked[choice.value]?.[0], own = new Map(lines.filter((line) => line.name ? fileOf(line.name) === file : file === "").map((line) => [line.name ? numberOf(line.name) : 0, line]));
    const text = file ? run.sources[file] : undefined, rows = text === undefined ? [...own.keys()].sort((a, b) => a - b).map((number) => rowOf(number, number ? "" : "instructions of no known line", own.get(number))) :
      text.replace(/\n$/, "").split("\n").map((line, i) => rowOf(i + 1, line, own.get(i + 1)));
    byId("source-note").textContent = text === undefined && file ? `${file} is not in this page: its lines have numbers only.` : file ?? "";
    byId("listing").replaceChildren(element("table", {}, element("thead", {}, element("tr", {}, ...["line", "share", "causes", "instructions", "loads that hit", ""].map((head) => element("th", { class: head === "causes" || !head ? "" : "n" }, head)))), element("tbody", {}, ...rows)));
    return rows;
  };
  const toLine = (rows, number) => {
    const row = rows.find((one) => one.dataset.line === String(number));
    if (row) byId("listing").scrollTop = Math.max(0, row.offsetTop - byId("listing").clientHeight / 3);
    return row;
  };
  run.widest = Math.max(1, ...lines.filter((line) => line.name).map((line) => line.total));
  run.openLine = (name) => {
    choice.value = String(ranked.findIndex(([file]) => file === fileOf(name)));
    const row = toLine(show(), numberOf(name));
    byId("listing").scrollIntoView({ block: "nearest" });
    if (row) { row.click(); row.focus({ preventScroll: true }); }
  };
  choice.addEventListener("change", show);
  byId("source-files").append(element("summary", {}, `${Object.keys(run.sources).length} source files are copied into this page`), element("p", {}, Object.keys(run.sources).join(", ")),
    run.left_out ? element("p", {}, `Left out, since they do not lie in the program's folder: ${run.left_out}. --source-folder FOLDER allows others.`) : undefined);
  const first = lines.find((line) => line.name);
  if (first) choice.value = String(ranked.findIndex(([file]) => file === fileOf(first.name)));
  toLine(show(), first ? numberOf(first.name) : 0);
}

// Of the stacks, as --profile-folded writes them: functions, the line, the cause.
function treeOf(folded) {
  const root = { name: "", own: {}, all: {}, total: 0, below: new Map() };
  for (const line of folded.trim().split("\n").filter((one) => one)) {
    const space = line.lastIndexOf(" "), count = Number(line.slice(space + 1)), frames = line.slice(0, space).split(";"), cause = frames.pop();
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
  const root = treeOf(run.folded), share = (cycles) => percent(cycles / stats.thread_cycles), sum = (own) => Object.values(own).reduce((a, b) => a + b, 0);
  const nodeOf = (node, depth) => {
    const below = [...node.below.values()].sort((a, b) => b.total - a.total || a.name.localeCompare(b.name));
    const details = element("details", { class: below.length ? "" : "leaf" }, element("summary", {}, element("span", { class: "row", style: `--depth: ${depth}` },
      element("code", {}, node.name), element("span", {}, share(node.total)), element("span", {}, share(sum(node.own))), stack(causes, node.all, root.total))));
    const fill = () => { if (below.length && details.childElementCount === 1) details.append(...below.map((one) => nodeOf(one, depth + 1))); };
    details.addEventListener("toggle", () => { if (details.open) fill(); });
    if (below.length && node.total > 0.1 * root.total && depth < 12) { fill(); details.open = true; }
    return details;
  };
  byId("calls-tree").append(element("div", { class: "row head", style: "--depth: 0" }, element("span", {}, "function"), element("span", {}, "all"), element("span", {}, "own"), element("span", {}, "causes of all")),
    ...[...root.below.values()].sort((a, b) => b.total - a.total).map((node) => nodeOf(node, 0)));
}
