async function start() {
  const run = JSON.parse(new TextDecoder().decode(await unpack("data"))), next = numbersIn(await unpack("pixels"));
  const { stats } = run, figures = run.figures.filter((one) => one), causeNames = Object.keys(stats.causes);
  const all = { run, stats, figures, causes: causesOf(stats, figures), lines: linesOf(run, causeNames), series: rowsOf(run.series), waits: rowsOf(run.waits),
    columns: run.picture ? columnsOf(run.picture, next) : {}, rays: raysOf(run.picture, next), causeNames,
    places: new Map(run.instructions.filter((one) => one).map((one) => [one[0], one])) };
  document.body.append(tip);
  document.addEventListener("pointermove", (event) => {
    const told = event.target.closest?.("[data-tip]");
    if (told) tell(told.dataset.tip, event.clientX, event.clientY);
    else if (!event.target.closest?.("svg, .pictures canvas")) untell();
  });
  for (const draw of [drawHead, drawCauses, drawTime, drawPicture, drawSource, drawCalls, drawHardware, drawObjects, drawWaits, drawRays,
    drawStatistics]) draw(all);
  drawNavigation();
  byId("failure").remove();
  root.dataset.ready = "yes";
}
start().catch((reason) => {
  byId("failure").textContent = `This page could not be drawn: ${reason}. It needs a browser of 2024 or later.`;
  throw reason;
});
