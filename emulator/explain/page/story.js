// A pixel's story: its rays, the functions and lines of its instructions, and its time line.

// The rays of all pixels: first[i] to first[i + 1] are those of pixel i.
function raysOf(picture, next) {
  if (!picture?.rays) return null;
  const pixels = picture.width * picture.height, first = new Uint32Array(pixels + 1), fields = {};
  for (let i = 0; i < pixels; i++) first[i + 1] = first[i] + next();
  for (const field of picture.rays.fields) {
    fields[field] = new Float64Array(first[pixels]);
    for (let i = 0; i < first[pixels]; i++) fields[field][i] = next();
  }
  return { ...picture.rays, ...fields, first };
}

const causesIn = (causeNames, cycles) => Object.fromEntries(causeNames.map((cause, i) => [cause, cycles[i]]));
const sumOf = (numbers) => numbers.reduce((sum, number) => sum + number, 0);

function rayTable({ rays, causes, causeNames }, pixel, story, total) {
  const from = rays.first[pixel], count = rays.first[pixel + 1] - from, costs = rays.cycles !== undefined,
    parts = story && story.rays.length === count + 1 ? story.rays : null, placed = rays.instance !== undefined;
  if (!count) return [];
  const heads = [["ray"], ["hit"], ...(placed ? [["instance", "n"]] : []), ["nodes", "n"], ["triangles", "n"],
    ...(costs ? [["cycles", "n"], ["share", "n"], ["instructions", "n"]] : []), ...(costs && parts ? [["causes", "bar"]] : [])];
  const rows = Array.from({ length: count }, (_, k) => {
    const i = from + k, material = rays.material[i] ? rays.materials[rays.material[i] - 1] : rays.hit[i] ? "yes" : "nothing",
      cycles = costs ? rays.cycles[i] : 0;
    return [`${k + 1} ${rays.kinds[rays.kind[i]]}`, material, ...(placed ? [rays.instance[i] ?
      [whole(rays.instance[i] - 1), rays.instance[i]] : ["none", 0]] : []), [whole(rays.nodes[i]), rays.nodes[i]],
      [whole(rays.triangles[i]), rays.triangles[i]], ...(costs ? [[whole(cycles), cycles], [percent(cycles / total), cycles],
        [whole(rays.instructions[i]), rays.instructions[i]]] : []),
      ...(costs && parts ? [stack(causes, causesIn(causeNames, parts[k + 1].slice(2)), total)] : [])];
  });
  const before = costs ? total - sumOf(rows.map((row) => row[placed ? 5 : 4][1])) : 0;
  return [element("div", { class: "scroll" }, element("table", { id: "story-rays" })), element("p", { class: "soft" }, costs ?
    `${whole(before)} cycles passed before the first ray; what follows a ray, such as shading, is counted with it.` :
    "The program counts a pixel's rays together, so that their cycles are not known apart: trax-render --mark-rays."),
  () => fillTable("story-rays", "Its rays", heads, rows)];
}

// Rows of a name and its sum, the costliest first, and the button or text of each.
function storyCode({ run, causes, causeNames, places }, story, title, id, nameOf, show) {
  const sums = new Map();
  for (const [pc, ...cycles] of story.code) {
    const name = nameOf(places.get(pc));
    if (!sums.has(name)) sums.set(name, causeNames.map(() => 0));
    sums.get(name).forEach((_, i, all) => { all[i] += cycles[i]; });
  }
  const ranked = [...sums].sort((a, b) => sumOf(b[1]) - sumOf(a[1])).slice(0, 10), most = sumOf(ranked[0][1]);
  return [element("div", { class: "scroll" }, element("table", { id })), () => fillTable(id, `Its ${title.toLowerCase()}s`, [[title.toLowerCase()],
    ["cycles", "n"], ["share", "n"], ["causes", "bar"], ["instructions", "n"]], ranked.map(([name, cycles]) => [[show(name), name],
    [whole(sumOf(cycles)), sumOf(cycles)], [percent(sumOf(cycles) / story.cycles), sumOf(cycles)],
    stack(causes, causesIn(causeNames, cycles), most), [whole(cycles[0]), cycles[0]]]))];
}

// The causes over the pixel's time; marks: where its rays begin.
function storyTime({ causes, causeNames, rays }, story, place) {
  const rows = story.time.map(([since, ...cycles], i) => ({ begin: since,
    end: i + 1 < story.time.length ? story.time[i + 1][0] : story.cycles, ...causesIn(causeNames, cycles) }));
  const share = (row, cause) => 100 * row[cause] / (row.end - row.begin);
  chart(place, `Its ${whole(story.cycles)} cycles by cause (%); lines: its rays begin`, rows, story.cycles, 160, 100, " %", (svg, x, y) => {
    for (const row of rows) {
      let level = 0;
      for (const { name, colour } of causes) {
        const part = share(row, name);
        if (part > 0) svg.append(shape("rect", { x: x(row.begin), width: Math.max(0.1, x(row.end) - x(row.begin)), y: y(level + part),
          height: y(level) - y(level + part), style: `fill: ${colour}` }));
        level += part;
      }
    }
    for (const [kind, begin] of story.rays.slice(1, 200)) {
      const at = x(begin - story.begin);
      svg.append(shape("line", { class: "axis", x1: at, x2: at, y1: y(0), y2: y(100) }, shape("title", {}, rays?.kinds[kind] ?? "ray")));
    }
  }, (row) => causes.map(({ name }) => [name, share(row, name)]).filter(([, value]) => value >= 0.05).sort((a, b) => b[1] - a[1])
    .slice(0, 6).map(([name, value]) => `${name} ${value.toFixed(1)} %`).join("\n"), 700);
}

// Shows all that is known of the pixel beyond its causes.
function tellStory(all, pixel, total) {
  const { run, rays } = all, story = run.stories.find((one) => one && one.place === pixel),
    top = element("div", { class: "across" }), left = element("div"), right = element("div"), tables = [];
  const add = (place, parts) => { // a table is filled when it is in the page
    for (const part of parts) if (typeof part === "function") tables.push(part); else place.append(part);
  };
  if (rays) add(top, rayTable(all, pixel, story, total));
  if (story) {
    storyTime(all, story, left);
    add(right, storyCode(all, story, "Function", "story-functions", (one) => run.names[one[4][0][0]], (name) => element("code", {}, name)));
    add(right, storyCode(all, story, "Line", "story-lines", (one) => run.names[one[4][0][1]], (name) => name ? element("button",
      { type: "button", class: "code", onclick: () => run.openLine(name) }, locationOf(run, name)) : "no line is known"));
  } else {
    const at = `${pixel % run.picture.width},${Math.floor(pixel / run.picture.width)}`;
    right.append(element("p", { class: "soft" }, "The page has functions, lines and the time line of the costliest pixels. " +
      "They are added for this one by ", element("code", {}, `trax-render --pixel ${at}`), "."));
  }
  byId("story-more").replaceChildren(top, left, right);
  for (const fill of tables) fill();
}
