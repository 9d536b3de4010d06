// Units, caches, memory, objects, kinds of rays, and every figure.

function drawHardware({ stats, figures, causes }) {
  const config = stats.configuration, share = (cycles) => cycles / stats.thread_cycles,
    colour = (cause) => causes.find(({ name }) => name === cause)?.colour;
  const meanings = new Map(figures.map(([name, unit, meaning]) => [name, { unit, meaning }]));
  const units = figures.map(([name]) => name.match(/^(\w+)\.utilisation$/)?.[1])
    .filter((name) => name && !["issue", "memory", "l2"].includes(name) && stats[name].operations !== undefined);
  const range = (values) => `${percent(Math.min(...values))} to ${percent(Math.max(...values))}`;
  fillTable("units-table", "Shared units", [["unit"], ["busy", "n"], ["", "bar"], ["least and most busy TM", "n"], ["operations", "n"],
    ["threads refused", "n"]], units.map((unit) => [
    [element("span", { "data-tip": meanings.get(`${unit}.utilisation`).meaning }, unit), unit],
    [percent(stats[unit].utilisation), stats[unit].utilisation], partBar(stats[unit].utilisation),
    [range(stats.tms.map((tm) => tm[unit].utilisation)), 0], [whole(stats[unit].operations), stats[unit].operations],
    [percent(share(stats.causes[`${unit}_conflict`] ?? 0)), stats.causes[`${unit}_conflict`] ?? 0]]));

  const caches = [["instruction", stats.icache, sizeText(config.icache.bytes)], ["data", stats.dcache, sizeText(config.dcache.bytes)]];
  if (config.l2?.bytes) caches.push(["second level", stats.l2, sizeText(config.l2.bytes)]);
  fillTable("caches-table", "Caches", [["cache"], ["size", "n"], ["hits", "n"], ["", "bar"], ["lookups", "n"], ["misses", "n"],
    ["merged", "n"]], caches.map(([name, cache, size]) => [
    name, size, [hitShare(cache), lookups(cache) ? cache.hit_rate : -1], partBar(cache.hit_rate, "var(--cache)"),
      [whole(lookups(cache)), cache.hits], [whole(cache.misses), cache.misses], [whole(cache.merged), cache.merged]]));

  const origins = ["data_read_bytes", "instruction_read_bytes", "nontemporal_read_bytes", "written_bytes", "atomic_bytes"]
    .map((name) => [name, stats.memory[name]]).filter(([, value]) => value);
  const requested = origins.reduce((sum, [, value]) => sum + value, 0);
  const rows = origins.sort((a, b) => b[1] - a[1])
    .map(([name, value]) => [meanings.get(`memory.${name}`).meaning, [bytesText(value), value], partBar(value / requested, "var(--memory)"),
    [percent(value / requested), value]]);
  rows.push(["at the chip's pins", [bytesText(stats.memory.bytes), stats.memory.bytes], partBar(stats.memory.utilisation, "var(--memory)"),
    [`${percent(stats.memory.utilisation)} of the time`, 0]]);
  for (const one of stats.channels.length > 1 ? stats.channels : [])
    rows.push([`channel ${one.channel}`, [bytesText(one.bytes), one.bytes], partBar(one.utilisation, "var(--memory)"),
      [`${percent(one.utilisation)} of the time`, 0]]);
  for (const [name, unit, meaning] of figures.filter(([one]) => one.startsWith("dram.")))
    rows.push([`DRAM: ${meaning}`, [`${whole(figure(stats, name))} ${unit}`, figure(stats, name)], "", ""]);
  fillTable("memory-table", `Off-chip memory: ${digits(stats.memory.bandwidth_gbps)} GB/s`,
    [["what"], ["bytes", "n"], ["", "bar"], ["share", "n"]], rows, false);

  const parts = figures.filter(([name]) => name.startsWith("energy.") &&
    !["energy.total", "energy.off_chip", "energy.average_power", "energy.per_ray"].includes(name))
    .map(([name, , meaning]) => [meaning, figure(stats, name)]);
  const energies = parts.filter(([, value]) => value).sort((a, b) => b[1] - a[1])
    .map(([meaning, value]) => [meaning, [scaled(value, "J"), value], partBar(value / stats.energy.total),
    [percent(value / stats.energy.total), value]]);
  energies.push(["off-chip memory, not in the sum", [scaled(stats.energy.off_chip, "J"), stats.energy.off_chip], "", ""]);
  fillTable("energy-table", `Energy on the chip: ${scaled(stats.energy.total, "J")}, a lower bound`,
    [["part"], ["energy", "n"], ["", "bar"], ["share", "n"]], energies);
}

function drawObjects({ stats, run, waits }) {
  // A bound buffer and the object of 8 bytes that says where it is have one name. A buffer's parts stand below it.
  const listed = rowsOf(run.heat), parts = rowsOf(run.parts),
    descriptors = new Set(listed.filter((one) => one.bytes === 8 && listed.some((other) => other !== one && other.object === one.object)));
  for (const one of descriptors) one.object += " (its address)";
  const awaited = new Map(waitsBy(waits, ({ object }) => object).map((one) => [one.key, one.total]));
  // Waits are those of the smallest object: of a buffer with parts, of its parts.
  for (const part of parts) awaited.set(part.object.split(":")[0], (awaited.get(part.object.split(":")[0]) ?? 0) + (awaited.get(part.object) ?? 0));
  const objects = [...listed, ...parts].sort((a, b) => (b.loads + b.stores + b.atomics) - (a.loads + a.stores + a.atomics)),
    most = Math.max(1, ...objects.map((one) => one.loads + one.stores + one.atomics));
  if (!objects.length) { byId("objects").remove(); return; }
  const some = (value, text = whole) => value ? text(value) : "", cached = (one) => one.hits + one.misses + one.merged;
  fillTable("objects-table", parts.length ? "Accesses to memory; a row such as scene: nodes is a part of the buffer scene" :
    "Accesses to memory", [["object"], ["address", "n"], ["size", "n"], ["accesses", "n"], ["", "bar"], ["loads", "n"], ["hit", "n"],
    ["misses", "n"], ["merged", "n"], ["loaded", "n"], ["stores", "n"], ["stored", "n"], ["increments", "n"], ["awaited", "n"]],
    objects.map((one) => [[element("code", {}, one.object), one.object], one.address, [bytesText(one.bytes), one.bytes],
      [whole(one.loads + one.stores + one.atomics), one.loads + one.stores + one.atomics],
      partBar((one.loads + one.stores + one.atomics) / most), [some(one.loads), one.loads],
        [cached(one) ? percent(one.hits / cached(one)) : "", cached(one) ? one.hits / cached(one) : -1], [some(one.misses), one.misses],
        [some(one.merged), one.merged],
      [some(one.load_bytes, bytesText), one.load_bytes], [some(one.stores), one.stores],
      [some(one.store_bytes, bytesText), one.store_bytes], [some(one.atomics), one.atomics],
      [some(awaited.get(one.object), (cycles) => percent(cycles / stats.thread_cycles)), awaited.get(one.object) ?? 0]]));
}

function drawRays({ stats, run, causes }) {
  const kinds = rowsOf(run.ray_kinds).filter((one) => one.rays || one.thread_cycles || one.energy > 0),
    marked = kinds.find((one) => one.kind === "none")?.issued < stats.causes.issued / 2;
  if (!stats.rays) { byId("rays").remove(); return; }
  if (!marked) { // all work is that of no kind, so a kind has a number of rays and nothing else
    byId("rays-note").textContent = "This program counts a pixel's rays together, at its end, so their work is not known by kind. " +
      "trax-render --mark-rays counts each ray where it begins.";
    fillTable("rays-table", "By kind", [["kind"], ["rays", "n"]], kinds.filter((one) => one.rays)
      .map((one) => [one.kind, [whole(one.rays), one.rays]]));
    return;
  }
  byId("rays-note").textContent = "A thread works for the kind that it counted last. " +
    "The row none has the work for no ray, the row rest what belongs to no instruction.";
  fillTable("rays-table", "By kind", [["kind"], ["rays", "n"], ["million a second", "n"], ["of thread-cycles", "n"], ["causes", "bar"],
    ["issued", "n"],
    ["cycles a ray", "n"], ["bytes a ray", "n"], ["energy a ray", "n"]], kinds.map((one) => {
    const cause = Object.fromEntries(causes.map(({ name }) => [name, one[name]])), some = one.rays > 0 && one.thread_cycles > 0;
    const each = (value, text) => [some ? text(value) : "", some ? value : -1];
    return [one.kind, [one.rays ? whole(one.rays) : "", one.rays], each(one.mrps, digits),
      [percent(one.thread_cycles / stats.thread_cycles), one.thread_cycles],
      stack(causes, cause, stats.thread_cycles), [one.thread_cycles ? percent(one.utilisation) : "", one.utilisation],
        each(one.thread_cycles / one.rays, whole),
      each(one.bytes_per_ray, digits), each(one.energy_per_ray, (value) => scaled(value, "J"))];
  }));
}

function drawStatistics({ stats, figures }) {
  const known = figures.filter(([name]) => figure(stats, name) !== undefined);
  const rows = fillTable("statistics-table", `${known.length} figures, as in --stats`, [["name"], ["value", "n"], ["unit"], ["meaning"]],
    known.map(([name, unit, meaning]) => {
    const value = figure(stats, name);
    return [[element("code", {}, name), name], [element("span", { "data-figure": name, "data-value": value }, valueText(value, unit)),
      value], ["J", "W", "s", "fraction"].includes(unit) ? "" : unit, meaning];
  }));
  byId("statistics-filter").addEventListener("input", (event) => {
    const words = event.target.value.toLowerCase().split(/\s+/).filter((word) => word);
    for (const row of rows) row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
  });
  fillTable("configuration-table", "", [["key"], ["value", "n"]],
    Object.entries(stats.configuration).flatMap(([section, keys]) => Object.entries(keys)
    .map(([key, value]) => [element("code", {}, `${section}.${key}`), String(value)])), false);
}
