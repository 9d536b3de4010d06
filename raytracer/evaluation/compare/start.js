try {
  document.body.append(tip);
  drawComparison();
  drawNavigation();
  byId("failure").remove();
  root.dataset.ready = "yes";
} catch (reason) {
  byId("failure").textContent = `This page could not be drawn: ${reason}. It needs a browser of 2024 or later.`;
  throw reason;
}
