// The picture, what each pixel cost, and a pixel's story.

// From 0 to what one pixel in a hundred exceeds; the colours of trax-render --cost-picture.
const RAMP = [[0, 0, 0], [40, 40, 220], [160, 30, 170], [240, 110, 20], [255, 230, 60], [255, 255, 255]];
function rampAt(share) {
  const place = Math.min(share, 1) * (RAMP.length - 1), step = Math.min(Math.floor(place), RAMP.length - 2), part = place - step;
  return RAMP[step].map((from, channel) => from + (RAMP[step + 1][channel] - from) * part);
}

function drawPicture(all) {
  const { stats, run, causes, columns } = all;
  const section = byId("picture");
  if (!run.picture) { section.remove(); return; }
  const { width, height } = run.picture, pixels = width * height;
  const sum = (parts) => {
    const total = new Float64Array(pixels);
    for (const part of parts) for (let i = 0; i < pixels; i++) total[i] += part.values[i];
    return total;
  };
  const inGroup = (group) => Object.values(columns).filter((column) => column.group === group);
  const cycles = sum(inGroup("causes")), kinds = inGroup("rays"), counts = inGroup("counts");
  const rays = kinds.length ? sum(kinds) : null;

  // --- what can be shown ---
  const shown = [{ name: "cycles", unit: "cycles", meaning: "of its thread, since the thread's pixel before", values: cycles }];
  for (const column of inGroup("causes")) shown.push(column.name === "issued" ?
    { ...column, name: "instructions", unit: "instructions", meaning: "issued" } : { ...column, unit: "cycles" });
  if (rays) shown.push({ name: "rays", unit: "rays", meaning: "of all kinds", values: rays });
  for (const column of kinds) shown.push({ ...column, name: `rays: ${column.name}` });
  shown.push(...counts);
  if (columns.begin) shown.push({ name: "time", unit: "cycle", meaning: "in which its thread began with it",
    values: columns.begin.values });
  const ordered = (one) => {
    if (!one.sorted) one.sorted = Float64Array.from(one.values).sort();
    one.white = one.sorted[pixels - 1 - Math.floor(pixels / 100)] || one.sorted[pixels - 1] || 1;
    return one;
  };
  const costs = ordered(shown[0]), meanOf = (values) => values.reduce((total, value) => total + value, 0) / pixels;

  // --- pictures ---
  const seen = byId("picture-seen"), cost = byId("picture-cost");
  const paint = (canvas, colour) => {
    canvas.width = width;
    canvas.height = height;
    const image = new ImageData(width, height);
    for (let i = 0; i < pixels; i++) {
      const three = colour(i);
      for (let channel = 0; channel < 3; channel++) image.data[4 * i + channel] = three[channel];
      image.data[4 * i + 3] = 255;
    }
    canvas.base = image;
    canvas.getContext("2d").putImageData(image, 0, 0);
  };
  const channels = ["red", "green", "blue"].map((name) => {
    const differences = columns[`picture.${name}`].values, values = new Uint8Array(pixels);
    for (let i = 0, value = 0; i < pixels; i++) values[i] = value = (value + differences[i]) & 255;
    return values;
  });
  paint(seen, (i) => channels.map((channel) => channel[i]));
  let now = costs;
  const choice = byId("picture-what");
  choice.append(...shown.map((one, i) => element("option", { value: i }, one.name)));
  const redraw = () => {
    now = ordered(shown[choice.value]);
    paint(cost, (i) => rampAt(now.values[i] / now.white));
    const ramp = element("canvas", { width: 256, height: 1, "aria-hidden": "true" }), line = new ImageData(256, 1);
    for (let i = 0; i < 256; i++) line.data.set([...rampAt(i / 255), 255], 4 * i);
    ramp.getContext("2d").putImageData(line, 0, 0);
    byId("picture-scale").replaceChildren(element("span", { class: "ramp" }, "0", ramp, `${whole(now.white)} ${now.unit} and more`),
      `${now.name}: ${now.meaning}. Least ${whole(now.sorted[0])}, median ${whole(now.sorted[pixels >> 1])}, ` +
      `most ${whole(now.sorted[pixels - 1])}; one pixel in a hundred is beyond the last colour.`);
    mark();
  };

  // --- a pixel ---
  let at = -1, pinned = -1;
  const mark = () => {
    for (const canvas of [seen, cost]) {
      const context = canvas.getContext("2d");
      context.putImageData(canvas.base, 0, 0);
      for (const [number, colour] of [[pinned, "#ff2d95"], [at === pinned ? -1 : at, "#00e5ff"]]) {
        if (number < 0) continue;
        const size = Math.max(5, Math.round(width / 60)) | 1;
        context.strokeStyle = colour;
        context.lineWidth = Math.max(1, width / 400);
        context.strokeRect(number % width - (size >> 1) + 0.5, Math.floor(number / width) - (size >> 1) + 0.5, size - 1, size - 1);
      }
    }
  };
  const beyond = (one, value) => {
    let low = 0, high = pixels;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (one.sorted[middle] < value) low = middle + 1; else high = middle;
    }
    return low / pixels;
  };
  const threads = columns.more ? null : threadsOf(columns);
  const story = (i) => {
    const place = `(${i % width}, ${Math.floor(i / width)})`, thread = columns.thread.values[i] - 1;
    if (thread < 0) {
      byId("story").replaceChildren(element("h3", {}, `Pixel ${place}`), element("p", {}, "The run ended before this pixel."));
      return;
    }
    const tps = stats.configuration.chip.tps_per_tm, begin = columns.begin ? columns.begin.values[i] : 0,
      more = columns.more ? columns.more.values[i] : 0, where = `thread ${thread} (TM ${Math.floor(thread / tps)}, TP ${thread % tps})`;
    const facts = [`${whole(cycles[i])} cycles`, beyond(costs, cycles[i]) * pixels >= pixels - 1 ? "the costliest" :
      `more than ${(Math.floor(1000 * beyond(costs, cycles[i])) / 10).toFixed(1)} % of the pixels`, `mean ${whole(meanOf(cycles))}`];
    const table = element("table", { id: "story-table" });
    const own = Object.fromEntries(inGroup("causes").map((column) => [column.name, column.values[i]]));
    const byKind = kinds.filter((kind) => kind.values[i]).map((kind) => `${whole(kind.values[i])} ${kind.name}`);
    byId("story").replaceChildren(element("h3", {}, `Pixel ${place}: ${facts.join(", ")}`),
      element("p", {}, more ? `${whole(more + 1)} items, the last one by ${where}, which began in cycle ${whole(begin)}. ` :
        `T${where.slice(1)}, cycles ${whole(begin)} to ${whole(begin + cycles[i])}. `,
        [rays ? `${whole(rays[i])} rays${kinds.length > 1 ? ` (${byKind.join(", ")})` : ""}` : "",
          ...counts.map((count) => `${whole(count.values[i])} ${count.name}`), `${whole(own.issued ?? 0)} instructions`]
          .filter((part) => part).join(", ") + "."),
      stack(causes, own, cycles[i]), element("div", { class: "scroll" }, table),
      ...(threads ? [threadLine(threads.get(thread), i, stats.cycles, (pixel) => rampAt(cycles[pixel] / costs.white)),
        element("p", { class: "soft" }, `The ${whole(threads.get(thread).length)} pixels of its thread over the run, this one in pink.`)] : []));
    fillTable("story-table", "", [["cause"], ["cycles", "n"], ["share", "n"], ["times the mean pixel's", "n"]],
      causes.filter(({ name }) => own[name]).sort((a, b) => own[b.name] - own[a.name]).map(({ name, colour }) => {
      const mean = meanOf(columns[`causes.${name}`].values);
      return [[element("span", {}, element("i", { class: "swatch", style: `--c: ${colour}` }), name), name], [whole(own[name]), own[name]],
        [percent(own[name] / cycles[i]), own[name]], [digits(own[name] / mean, 2), own[name] / mean]];
    }));
    tellStory(all, i, cycles[i]);
  };
  const pin = (i) => { pinned = i; mark(); byId("story-more").replaceChildren(); if (i < 0) hint(); else story(i); };
  const hint = () => byId("story").replaceChildren(element("p", { class: "soft" }, "No pixel is chosen."));
  const move = (i, x, y) => {
    const more = now === costs ? "" : `\ncycles ${whole(cycles[i])}`;
    at = i;
    mark();
    tell(`(${i % width}, ${Math.floor(i / width)})\n${now.name} ${whole(now.values[i])}${more}`, x, y);
  };
  for (const canvas of [seen, cost]) {
    const under = (event) => {
      const box = canvas.getBoundingClientRect(), x = Math.floor((event.clientX - box.x) / box.width * width),
        y = Math.floor((event.clientY - box.y) / box.height * height);
      return Math.max(0, Math.min(height - 1, y)) * width + Math.max(0, Math.min(width - 1, x));
    };
    canvas.addEventListener("pointermove", (event) => move(under(event), event.clientX, event.clientY));
    for (const leaving of ["pointerleave", "blur"]) canvas.addEventListener(leaving, () => { at = -1; mark(); untell(); });
    canvas.addEventListener("click", (event) => pin(under(event)));
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key],
        from = at >= 0 ? at : pinned >= 0 ? pinned : (height >> 1) * width + (width >> 1);
      if (step) {
        const far = event.shiftKey ? 10 : 1, x = Math.max(0, Math.min(width - 1, from % width + far * step[0])),
          y = Math.max(0, Math.min(height - 1, Math.floor(from / width) + far * step[1])), box = canvas.getBoundingClientRect();
        move(y * width + x, box.x + (x + 0.5) * box.width / width, box.y + (y + 0.5) * box.height / height);
      } else if (event.key === "Enter" || event.key === " ") pin(from);
      else if (event.key === "Escape") { pin(-1); untell(); } else return;
      event.preventDefault();
    });
  }
  choice.addEventListener("change", redraw);
  redraw();

  const least = costs.sorted[Math.max(0, pixels - 10)], ranking = Array.from(cycles.keys()).filter((i) => cycles[i] >= least)
    .sort((a, b) => cycles[b] - cycles[a] || a - b).slice(0, 10);
  fillTable("costliest", "The costliest pixels", [["pixel"], ["cycles", "n"], ["causes", "wide"],
    ...counts.map((count) => [count.name, "n"])], ranking.map((i) => [
    [element("button", { type: "button", onclick: () => pin(i) }, `(${i % width}, ${Math.floor(i / width)})`), i],
    [whole(cycles[i]), cycles[i]],
    stack(causes, Object.fromEntries(inGroup("causes").map((column) => [column.name, column.values[i]])), cycles[ranking[0]]),
      ...counts.map((count) => [whole(count.values[i]), count.values[i]])]));
  const elsewhere = Object.values(run.picture.elsewhere).reduce((total, part) => total + part, 0);
  byId("picture-sum").textContent = `The pixels took ${whole(stats.thread_cycles - elsewhere)} thread-cycles; ` +
    `${whole(elsewhere)} belong to no pixel: after a thread's last, or of items without a place.`;
  run.showPixel = (i) => { pin(i); section.scrollIntoView(); };
  pin(ranking[0]);
}
