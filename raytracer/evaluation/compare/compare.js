// The page of trax-sim compare, and its part of a page of --explore, in which all identifiers have a prefix.
// Differences are B less A.

const at = (id) => byId(prefix + id);
const signed = (value, text = whole) => typeof value !== "number" ? "" : (value > 0 ? "+" : value < 0 ? "\u2212" : "") + text(Math.abs(value));
const cyclesText = (value) => typeof value !== "number" ? "" : Math.abs(value) < 10 ? digits(value) : whole(value);
const finePercent = (share) => `${(100 * share).toFixed(2)} %`;
const shareText = (share) => typeof share !== "number" ? "" : Math.abs(share) < 10 ? signed(share, finePercent) : `\u00d7 ${digits(1 + share)}`;
// A contribution, of A's cycles: it may be many times as great, with either sign.
const partText = (share) => typeof share !== "number" ? "" : Math.abs(share) < 10 ? signed(share, finePercent) : `${signed(100 * share)} %`;
const shownValue = (value, unit = "") => value === undefined || value === null ? "" : valueText(value, unit);
const shownChange = (value, unit) => signed(value, unit === "fraction" ? finePercent : (size) => shownValue(size, unit));
const relativeOf = ({ a, b }) => typeof a === "number" && typeof b === "number" && a ? (b - a) / Math.abs(a) : undefined;

// A bar for a share from -1 to 1.
const changeBar = (share, colour) => element("div", { "aria-hidden": "true" }, element("i",
  { style: `--c: ${colour}; width: ${50 * Math.min(1, Math.abs(share))}%; ${share < 0 ? "right" : "left"}: 50%` }));
const breakable = (name) => element("span", {}, ...name.split(/(?<=_)/).flatMap((part) => [part, element("wbr")]));
const swatch = (cause) => element("i", { class: "swatch", style: `--c: ${colourOf(cause)}` });

function drawContributions(id, title, rows, run, named) {
  const most = Math.max(...rows.map((row) => Math.abs(row.difference)), 1e-9), limit = run.cycles.interval ?
    (run.cycles.interval[1] - run.cycles.interval[0]) / 2 : 0;
  fillTable(prefix + id, title,
            [
              [ "" ], [ "A", "n" ], [ "B", "n" ], [ "difference", "n" ], [ "", "change" ], [ "of A's cycles", "n" ],
              [ named ? "meaning" : "most by" ]
            ],
            rows.map((row) => [named ? [ element("span", {}, swatch(row.name), row.name), row.name ]
                                     : [ element("code", {}, row.name), row.name ],
                               [ cyclesText(row.a), row.a ?? 0 ], [ cyclesText(row.b), row.b ?? 0 ],
                               [ signed(row.difference, cyclesText), row.difference ],
                               changeBar(row.difference / most, named       ? colourOf(row.name)
                                                                : row.cause ? colourOf(row.cause)
                                                                            : "var(--bar)"),
                               [ partText(run.cycles.a ? row.difference / run.cycles.a : undefined), row.difference ],
                               (Math.abs(row.difference) < limit ? "within the noise; " : "") +
                                   (row.meaning ??
                                    (row.cause ? `${row.cause} ${signed(row.cause_difference, cyclesText)}` : ""))]));
}

function drawHead(run) {
  const { a, b, cycles } = run, card = (name, value, below) => element("div", {}, element("dt", {}, name), element("dd", {}, value),
    below ? element("dd", {}, below) : undefined);
  at("about").textContent = `A: ${a.file} (${a.chip}). B: ${b.file} (${b.chip}).`;
  at("figures").replaceChildren(card("cycles of A", whole(cycles.a)), card("cycles of B", whole(cycles.b)),
                                card("difference", signed(cycles.difference), shareText(cycles.relative)),
                                ...(run.causes.length ? [ card("most by", breakable(run.causes[0].name),
                                                               signed(run.causes[0].difference, cyclesText)) ]
                                                      : []));
  const notes = run.warnings.map((text) => element("li", { class: "bad" }, text));
  if (cycles.interval) notes.push(element("li", {}, `${cycles.sampled.join(" and ")} ${cycles.sampled.length === 1 ? "is" : "are"} ` +
    `sampled: the difference is ${signed(cycles.interval[0])} to ` +
    `${signed(cycles.interval[1])} with 95 % confidence${cycles.within_noise ? ", which is within the noise" : ""}. ` +
    "The parts are estimates without intervals."));
  at("brief").replaceChildren(...notes);
}

function drawFigures({ sections }, titles) {
  at("figures-tables").replaceChildren();
  for (const [name, rows] of Object.entries(sections).filter(([, one]) => one.length)) {
    const table = element("table", {id : `${prefix}${name}-figures`}),
          box = element("div", {class : "scroll tall"}, table);
    at("figures-tables")
        .append([ "shares", "parts" ].includes(name)
                    ? element("details", {}, element("summary", {}, `${titles[name]}: ${whole(rows.length)}`), box)
                    : box);
    fillTable(table.id, titles[name], [["name"], ["A", "n"], ["B", "n"], ["difference", "n"], ["relative", "n"], ["meaning"]],
      rows.map((row) => [[element("code", {}, row.name), row.name], [shownValue(row.a, row.unit), row.a], [shownValue(row.b, row.unit), row.b],
        [shownChange(row.difference, row.unit), row.difference ?? 0],
        [row.only_in ? `only ${row.only_in.toUpperCase()}` : shareText(relativeOf(row)), relativeOf(row) ?? 0],
        [row.unit && !["J", "W", "s", "fraction"].includes(row.unit) ? row.unit : "", row.meaning].filter((text) => text).join(": ")]));
  }
}

function drawPictures({ pictures }, images) {
  const shown = pictures ?? {}, { cost } = shown;
  at("picture-note").textContent =
      shown.sizes ? `They are of different sizes: ${shown.sizes.map((size) => size.join("x")).join(" and ")}.`
      : !shown.different
          ? "The pictures are the same."
          : `${whole(shown.different)} of ${whole(shown.pixels)} pixels differ, by at most ${shown.largest} of 255.`;
  const texts = { pixels: "Where the pictures differ", cost: cost && `Thread-cycles of each pixel: ${whole(cost.pixels_more)} take more in B ` +
    `(orange), ${whole(cost.pixels_less)} take less (blue). Most changed: (${cost.largest.x}, ${cost.largest.y}), ` +
    `${whole(cost.largest.a)} to ${whole(cost.largest.b)}` };
  at("pictures")
      .replaceChildren(...Object.entries(images).map(
          ([ name, source ]) => element("figure", {}, element("img", {src : source, alt : texts[name]}),
                                        element("figcaption", {}, texts[name]))));
}

function drawRun(run, images, titles) {
  drawHead(run);
  const say = (id, text) => { at(id).textContent = text ? `Not compared: ${text}` : ""; };
  const show = (id, known) => { at(id).hidden = !known; };
  show("configuration", run.configuration.length);
  fillTable(`${prefix}configuration-table`, "", [ [ "key" ], [ "A", "n" ], [ "B", "n" ] ],
            run.configuration.map(
                (row) => [[ element("code", {}, row.name), row.name ], shownValue(row.a), shownValue(row.b)]),
            false);
  drawContributions("causes-table", "Causes, in cycles of a mean thread", run.causes, run, true);
  say("places-note", run.missing.profile);
  for (const name of ["functions", "lines"]) {
    show(`${name}-table`, run[name]);
    drawContributions(`${name}-table`, name === "lines" ? "Lines, in cycles" : "Functions, in cycles", run[name] ?? [], run, false);
  }
  say("rays-note", run.missing.kinds);
  show("rays-table", run.kinds);
  fillTable(`${prefix}rays-table`, "",
            [
              [ "kind" ], [ "A", "n" ], [ "B", "n" ], [ "difference", "n" ], [ "A: rays", "n" ], [ "B: rays", "n" ],
              [ "A: thread-cycles a ray", "n" ], [ "B: thread-cycles a ray", "n" ]
            ],
            (run.kinds ?? [])
                .map((row) => [row.name, ...[row.a, row.b].map((value) => [cyclesText(value), value]),
                               [ signed(row.difference, cyclesText), row.difference ],
                               ...[row.rays_a, row.rays_b, row.cycles_per_ray_a, row.cycles_per_ray_b].map(
                                   (value) => [shownValue(value), value ?? 0])]));
  drawPictures(run, images);
  if (run.missing.picture) say("picture-note", run.missing.picture);
  drawFigures(run, titles);
}

function drawComparison() {
  const {runs, images, titles, only_a : onlyA, only_b : onlyB} = JSON.parse(at("data").textContent),
                                                        names = Object.keys(runs);
  if (onlyA === undefined)
    at("runs").remove();
  else {
    fillTable(`${prefix}runs-table`, "Runs, in cycles",
              [ [ "run" ], [ "A", "n" ], [ "B", "n" ], [ "difference", "n" ], [ "relative", "n" ], [ "most by" ] ],
              Object.entries(runs).map(
                  ([ name, run ]) => [[
                    element("button", {type : "button", onclick : () => drawRun(run, images[name], titles)}, name), name
                  ],
                                      [ whole(run.cycles.a), run.cycles.a ], [ whole(run.cycles.b), run.cycles.b ],
                                      [ signed(run.cycles.difference), run.cycles.difference ],
                                      [ shareText(run.cycles.relative), run.cycles.relative ?? 0 ],
                                      run.cycles.within_noise ? "within the noise"
                                      : run.causes.length     ? run.causes[0].name
                                                              : ""]));
    for (const [which, only] of [["A", onlyA], ["B", onlyB]])
      if (only.length)
        at("runs").append(element("p", {class : "soft"}, `Only in ${which}: ${only.join(", ")}`));
  }
  drawRun(runs[names[0]], images[names[0]], titles);
}
