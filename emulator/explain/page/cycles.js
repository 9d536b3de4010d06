// The head of the page, causes, and time.

const locationOf = (run, line) => line.slice(line.lastIndexOf("/") + 1);

function drawHead({ stats, run, causes, lines, columns }) {
  const chip = stats.configuration.chip, program = stats.program.slice(stats.program.lastIndexOf("/") + 1);
  const title = `${run.title ?? program} on ${chip.tms}x${chip.tps_per_tm}`;
  document.title = `${title}: ${whole(stats.cycles)} cycles`;
  byId("title").textContent = title;
  const dram = stats.configuration.memory.model === "dram";
  const memory = dram ? "DRAM" : `${stats.configuration.memory.bandwidth_gbps} GB/s off-chip`;
  byId("about").textContent = `${whole(stats.threads)} threads at ${chip.clock_mhz} MHz, ${memory}; ` +
    `${stats.status}${stats.exit_status === null ? "" : `, exit status ${stats.exit_status}`}; trax ${stats.trax_sim}`;
  const tiles = [
    ["Cycles", whole(stats.cycles), scaled(stats.seconds, "s"), "cycles"],
    stats.rays ? ["Rays per second", `${digits(stats.mrps)} M`, `${whole(stats.rays)} rays`, "mrps"] : null,
    ["Issue utilisation", percent(stats.issue.utilisation),
    `${whole(stats.instructions)} instructions, ${digits(stats.instructions_per_cycle)} a cycle`, "issue.utilisation"],
    ["Off-chip memory", `${digits(stats.memory.bandwidth_gbps)} GB/s`,
    `${percent(stats.memory.utilisation)} of the peak; ${bytesText(stats.memory.bytes)}`, "memory.bandwidth_gbps"],
    ["Data cache", hitShare(stats.dcache), `of ${whole(lookups(stats.dcache))} loads hit`, "dcache.hit_rate"],
    ["Power on the chip", scaled(stats.energy.average_power, "W"), stats.rays ?
    `${scaled(stats.energy.per_ray, "J")} a ray; a lower bound` : `${scaled(stats.energy.total, "J")}; a lower bound`,
    "energy.average_power"],
  ];
  byId("figures").append(...tiles.filter((tile) => tile).map(([name, value, more, key]) =>
    element("div", {}, element("dt", {}, name), element("dd", { "data-figure": key, "data-value": figure(stats, key) }, value),
      element("dd", {}, more))));
  const losses = causes.filter(({ name }) => name !== "issued").sort((a, b) => b.total - a.total).slice(0, 3);
  const said = (name) => `${name} (${causes.find((cause) => cause.name === name).meaning})`;
  const brief = [];
  if (stats.partial) brief.push(element("li", { class: "bad" },
    `The run did not finish (${stats.status}): all figures are those of the part that was run.`));
  if (losses.length) brief.push(element("li", {}, "Of all thread-cycles ",
    ...losses.flatMap(({ name, total }, i) => [i ? ", " : "", element("b", {}, percent(total / stats.thread_cycles)),
    ` went to ${said(name)}`]), "."));
  const hottest = lines.find((line) => line.name && line.total);
  if (hottest) brief.push(element("li", {}, "The costliest line is ", element("button",
    { type: "button", class: "code", onclick: () => run.openLine(hottest.name) }, locationOf(run, hottest.name)),
    `, with ${percent(hottest.total / stats.thread_cycles)} of the thread-cycles.`));
  byId("brief").append(...brief, ...linesOfEnd({ stats, run, columns }));
}

function drawCauses({ stats, causes }) {
  byId("causes-bar").append(stack(causes, stats.causes, stats.thread_cycles, "large", true));
  fillTable("causes-table", "All threads", [["cause"], ["share", "n"], ["thread-cycles", "n"], ["meaning", "wide"]],
    [...causes].sort((a, b) => b.total - a.total).map(({ name, colour, total, meaning }) => [
      [element("span", {}, element("i", { class: "swatch", style: `--c: ${colour}` }), name), name],
      [percent(total / stats.thread_cycles), total],
      [element("span", { "data-figure": `causes.${name}`, "data-value": total }, whole(total)), total], meaning]));
  const cyclesOf = (tm) => Object.values(tm.causes).reduce((sum, cycles) => sum + cycles, 0);
  fillTable("tms-table", "By TM", [["TM"], ["causes", "wide"], ["issued", "n"], ["d-cache hits", "n"], ["rays", "n"]],
    stats.tms.map((tm) => [
    [`TM ${tm.tm}`, tm.tm], stack(causes, tm.causes, cyclesOf(tm)), [percent(tm.issue.utilisation), tm.issue.utilisation],
    [hitShare(tm.dcache), lookups(tm.dcache) ? tm.dcache.hit_rate : -1], [whole(tm.rays), tm.rays]]));
  byId("threads").open = stats.threads <= 128;
  byId("threads").addEventListener("toggle", () => {
    if (byId("threads-bars").firstChild) return;
    for (const tm of stats.tms)
      byId("threads-bars").append(element("div", {}, `TM ${tm.tm}`,
        ...tm.tps.map((tp) => stack(causes, tp.causes, stats.cycles, "thin", false, `TM ${tm.tm}, TP ${tp.tp}: `))));
  });
}

// --- over time ---

const WIDTH = 1100, LEFT = 48, RIGHT = 12;

function ticksOf(most, count) {
  const step = 10 ** Math.floor(Math.log10(most / count || 1)), factor = [1, 2, 5, 10].find((one) => most / (one * step) <= count) ?? 10;
  return Array.from({ length: Math.floor(most / (factor * step) + 1e-9) + 1 }, (_, i) => i * factor * step);
}

// The frame of a chart: draw(svg, x, y) draws; told(row) is what the pointer and the arrow keys tell.
function chart(place, title, rows, end, height, most, unit, draw, told, width = WIDTH) {
  const top = 8, bottom = 24, x = (cycle) => LEFT + (width - LEFT - RIGHT) * cycle / end,
    y = (value) => top + (height - top - bottom) * (1 - value / most);
  const svg = shape("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", tabindex: "0", "aria-label": title });
  for (const tick of ticksOf(most, height > 160 ? 5 : 3)) {
    svg.append(shape("line", { class: "grid", x1: LEFT, x2: width - RIGHT, y1: y(tick), y2: y(tick) }),
      shape("text", { x: LEFT - 6, y: y(tick) + 4, "text-anchor": "end" }, `${digits(tick)}${unit}`));
  }
  draw(svg, x, y);
  const last = ticksOf(end, width > 800 ? 10 : 4);
  for (const tick of last) svg.append(shape("text", { x: x(tick), y: height - 8, "text-anchor": tick ? "middle" : "start" },
    tick ? scaled(tick, "") : "0"));
  if (x(last.at(-1)) < width - 70) svg.append(shape("text", { x: width - RIGHT, y: height - 8, "text-anchor": "end" }, "cycles"));
  svg.append(shape("line", { class: "axis", x1: LEFT, x2: width - RIGHT, y1: y(0), y2: y(0) }));
  const cursor = shape("line", { class: "cursor", y1: top, y2: height - bottom, visibility: "hidden" });
  svg.append(cursor);
  let at = -1;
  const point = (number, event) => {
    at = Math.max(0, Math.min(rows.length - 1, number));
    const box = svg.getBoundingClientRect(), middle = x((rows[at].begin + rows[at].end) / 2);
    cursor.setAttribute("x1", middle);
    cursor.setAttribute("x2", middle);
    cursor.setAttribute("visibility", "visible");
    tell(`cycles ${whole(rows[at].begin)} to ${whole(rows[at].end)}\n${told(rows[at])}`,
      event?.clientX ?? box.x + middle * box.width / width, event?.clientY ?? box.y + 20);
  };
  const leave = () => { cursor.setAttribute("visibility", "hidden"); untell(); };
  svg.addEventListener("pointermove", (event) => {
    const box = svg.getBoundingClientRect(), cycle = ((event.clientX - box.x) / box.width * width - LEFT) / (width - LEFT - RIGHT) * end;
    point(rows.findIndex((row) => cycle < row.end) < 0 ? rows.length - 1 : rows.findIndex((row) => cycle < row.end), event);
  });
  svg.addEventListener("pointerleave", leave);
  svg.addEventListener("blur", leave);
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1, Home: -1e9, End: 1e9 }[event.key];
    if (step) { point(at + step); event.preventDefault(); }
    if (event.key === "Escape") leave();
  });
  place.append(element("figure", {}, element("figcaption", {}, title), svg));
}

// A line for each stretch of intervals that have a value: what has none is a gap, not 0.
function stretches(rows, value) {
  const found = [[]];
  for (const row of rows) if (value(row) === null) found.push([]); else found.at(-1).push(row);
  return found.filter((stretch) => stretch.length);
}
const steps = (rows, x, y) => rows.map((row) =>
  `${x(row.begin).toFixed(1)} ${y(row).toFixed(1)} ${x(row.end).toFixed(1)} ${y(row).toFixed(1)}`).join(" ");

function drawTime({ stats, causes, series }) {
  const choice = byId("time-tm");
  choice.append(element("option", { value: "all" }, "all"), ...stats.tms.map(({ tm }) => element("option", { value: tm }, `TM ${tm}`)));
  const draw = () => {
    const all = choice.value === "all", rows = series.filter((row) => String(row.tm) === choice.value), end = rows.at(-1)?.end ?? 0;
    const threads = all ? stats.threads : stats.configuration.chip.tps_per_tm,
      share = (row, cause) => 100 * row[cause] / (threads * (row.end - row.begin));
    byId("time-interval").textContent = `in intervals of ${whole(rows[0].end - rows[0].begin)} cycles`;
    byId("time-causes").replaceChildren();
    byId("time-lines").replaceChildren();
    chart(byId("time-causes"), "Thread-cycles by cause (%); colours as above", rows, end, 300, 100, " %", (svg, x, y) => {
      const floor = rows.map(() => 0);
      for (const { name, colour } of causes) {
        const below = rows.map((row, i) => ({ ...row, level: floor[i] })).reverse();
        rows.forEach((row, i) => { floor[i] += share(row, name); });
        const up = steps(rows.map((row, i) => ({ ...row, level: floor[i] })), x, (row) => y(row.level));
        const down = below.map((row) =>
          `${x(row.end).toFixed(1)} ${y(row.level).toFixed(1)} ${x(row.begin).toFixed(1)} ${y(row.level).toFixed(1)}`).join(" ");
        svg.append(shape("polygon", { points: `${up} ${down}`, style: `fill: ${colour}` }));
      }
    }, (row) => causes.map(({ name }) => [name, share(row, name)]).filter(([, value]) => value >= 0.05)
      .sort((a, b) => b[1] - a[1]).slice(0, 9).map(([name, value]) => `${name} ${value.toFixed(1)} %`).join("\n"));
    const seconds = (row) => (row.end - row.begin) / (stats.configuration.chip.clock_mhz * 1e6);
    const moved = (row) => all ? row["memory.bytes"] : ["data_read", "instruction_read", "nontemporal_read", "written", "atomic"]
      .reduce((sum, part) => sum + row[`memory.${part}_bytes`], 0);
    const peak = stats.configuration.memory.model === "dram" || !all ? 0 : stats.configuration.memory.bandwidth_gbps;
    const loads = (row) => lookups({ hits: row["dcache.hits"], misses: row["dcache.misses"], merged: row["dcache.merged"] });
    const curves = [
      [all ? "Off-chip memory (GB/s)" : "Requested from memory (GB/s)", (row) => moved(row) / seconds(row) / 1e9, "", peak],
      ["Loads that hit in the data cache (%)", (row) => loads(row) ? 100 * row["dcache.hits"] / loads(row) : null, " %", 0, 100],
      ["Million rays per second", (row) => row.rays / seconds(row) / 1e6, ""],
      ["Requests in the memory queues", (row) => row["memory.queue"], ""],
    ];
    for (const [title, value, unit, bound, top] of curves) {
      const most = top ?? 1.05 * Math.max(bound || 0, ...rows.map(value));
      if (!(most > 0)) continue;
      chart(byId("time-lines"), title + (bound ? "; dashed: the peak" : ""), rows, end, 130, most, unit, (svg, x, y) => {
        if (bound) svg.append(shape("line", { class: "bound", x1: x(0), x2: x(end), y1: y(bound), y2: y(bound) }));
        for (const stretch of stretches(rows, value))
          svg.append(shape("polyline", { class: "curve", points: steps(stretch, x, (row) => y(value(row))) }));
      }, (row) => `${title}: ${value(row) === null ? "none" : `${digits(value(row))}${unit}`}`, 340);
    }
  };
  choice.addEventListener("change", draw);
  draw();
}
