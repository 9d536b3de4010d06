// Why the run is as long as it is: which pixel ended last, and since when there was no further one to begin with.

// For each thread its pixels in the order of time: { pixel, begin, end }.
function threadsOf(columns) {
  const causes = Object.values(columns).filter((column) => column.group === "causes"), threads = new Map();
  columns.thread.values.forEach((thread, pixel) => {
    if (!thread) return;
    const begin = columns.begin ? columns.begin.values[pixel] : 0,
      end = begin + causes.reduce((sum, column) => sum + column.values[pixel], 0);
    if (!threads.has(thread - 1)) threads.set(thread - 1, []);
    threads.get(thread - 1).push({ pixel, begin, end });
  });
  for (const pixels of threads.values()) pixels.sort((a, b) => a.begin - b.begin);
  return threads;
}

// The share of the run that is due to its end. Times of pixels to which several items belong are not known.
function endOf({ stats, run, columns }) {
  if (!run.picture || !columns.thread || columns.more || stats.partial) return null;
  const ends = Array.from(threadsOf(columns).values(), (pixels) => pixels[pixels.length - 1])
    .sort((a, b) => b.end - a.end || a.pixel - b.pixel);
  if (ends.length < 2) return null;
  const begun = ends.reduce((latest, { begin }) => Math.max(latest, begin), 0);
  const idle = stats.threads * stats.cycles - ends.reduce((sum, { end }) => sum + end, 0);
  return { last: ends[0], alone: ends[0].end - ends[1].end, begun, idle };
}

// Lines for the head of the page.
function linesOfEnd(all) {
  const { stats, run } = all, end = endOf(all);
  if (!end) return [];
  const { last, alone, begun, idle } = end, width = run.picture.width;
  const pixel = element("button", { type: "button", onclick: () => run.showPixel(last.pixel) },
    `pixel (${last.pixel % width}, ${Math.floor(last.pixel / width)})`);
  const took = `, which was begun in cycle ${whole(last.begin)} and took ${whole(last.end - last.begin)}.`;
  return [
    alone >= stats.cycles / 100 ? element("li", {}, "The last ", element("b", {}, `${whole(alone)} cycles`), " wait for ", pixel, took) :
      element("li", {}, `The last to end, ${whole(alone)} ${alone === 1 ? "cycle" : "cycles"} after all others, was `, pixel, took),
    element("li", {}, `After cycle ${whole(begun)} no further pixel was begun: threads that had ended theirs had nothing to do in `,
      element("b", {}, percent(idle / stats.thread_cycles)), " of all thread-cycles."),
  ];
}

// A thread's pixels over the run, by their colours, and the chosen one.
function threadLine(pixels, chosen, cycles, colour) {
  const canvas = element("canvas", { width: 1200, height: 14, class: "line", "aria-hidden": "true" }),
    context = canvas.getContext("2d"), x = (cycle) => 1200 * cycle / cycles;
  for (const { pixel, begin, end } of pixels) {
    context.fillStyle = pixel === chosen ? "#ff2d95" : `rgb(${colour(pixel).map(Math.round).join(" ")})`;
    context.fillRect(x(begin), pixel === chosen ? 0 : 3, Math.max(pixel === chosen ? 2 : 0.5, x(end - begin) - 0.3), pixel === chosen ? 14 : 8);
  }
  return canvas;
}
