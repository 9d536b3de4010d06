// Waits by what is waited for: a load, mostly, and the object that it read.

// For each key of a row of --waits the thread-cycles by cause, the costliest first.
function waitsBy(rows, keyOf) {
  const found = new Map();
  for (const row of rows) {
    const key = keyOf(row), causes = Object.entries(row).filter(([, value]) => typeof value === "number" && value);
    if (!found.has(key)) found.set(key, { key, total: 0, cycles: {}, rows: [] });
    const one = found.get(key);
    one.rows.push(row);
    for (const [name, value] of causes) {
      one.cycles[name] = (one.cycles[name] ?? 0) + value;
      one.total += value;
    }
  }
  return [...found.values()].sort((a, b) => b.total - a.total);
}

function drawWaits({ stats, run, causes, waits }) {
  const loads = waitsBy(waits, (row) => row.line || row.address), share = (one) => percent(one.total / stats.thread_cycles);
  if (!loads.length) { byId("waits").remove(); return; }
  const place = (name, row) => row.line ? element("button", { type: "button", class: "code", onclick: () => run.openLine(row.line) },
    locationOf(run, row.line)) : element("code", {}, name);
  const names = (list) => list.slice(0, 3).map((one) => one.key).join(", ");
  fillTable("waits-table", "The most awaited", [["line"], ["function"], ["object"], ["of thread-cycles", "n"], ["causes", "bar"],
    ["waiting most"]], loads.slice(0, 12).map((one) => {
    const waiting = waitsBy(one.rows, (row) => row.waiting_line || row.waiting_address)[0], [row] = one.rows;
    return [[place(one.key, row), one.key], element("code", {}, names(waitsBy(one.rows, ({ function: name }) => name))),
      names(waitsBy(one.rows, ({ object }) => object).filter(({ key }) => key)), [share(one), one.total],
      stack(causes, one.cycles, loads[0].total),
      [element("span", {}, place(waiting.key, { line: waiting.rows[0].waiting_line }), ` ${percent(waiting.total / one.total)}`),
        waiting.key]];
  }));
}
