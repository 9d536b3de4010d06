"use strict";

// Light and dark: the reader's system decides, until the button does.
const root = document.documentElement;
const remembered = (value) => {
  try { return value ? localStorage.setItem("trax-theme", value) : localStorage.getItem("trax-theme"); } catch { return null; /* a page from a file may have no storage */ }
};
if (["light", "dark"].includes(remembered())) root.dataset.theme = remembered();
document.getElementById("theme").addEventListener("click", () => {
  const now = root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  root.dataset.theme = now === "dark" ? "light" : "dark";
  remembered(root.dataset.theme);
});

// Tables sort by the column whose head is pressed; what is missing stays at the end, equal rows keep their order.
const valueOf = (row, column) => {
  const value = row.cells[column].dataset.value;
  if (value === undefined) return null;
  const number = Number(value);
  return Number.isNaN(number) ? value.replace(/^'|'$/g, "") : number;
};
const compare = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en");
for (const button of document.querySelectorAll("th button")) {
  button.addEventListener("click", () => {
    const head = button.parentElement, body = head.closest("table").tBodies[0], column = head.cellIndex;
    const descending = head.getAttribute("aria-sort") === "ascending";
    for (const other of head.parentElement.cells) if (other.hasAttribute("aria-sort")) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", descending ? "descending" : "ascending");
    const rows = Array.from(body.rows, row => ({ row, value: valueOf(row, column) }));
    rows.sort((a, b) => {
      if (a.value === null || b.value === null) return (a.value === null) - (b.value === null);
      return (descending ? -1 : 1) * compare(a.value, b.value);
    });
    body.append(...rows.map(entry => entry.row));
  });
}

// Values of marks appear at once, not after the browser's delay; without this script the titles do.
const tip = document.createElement("div");
tip.id = "tip";
tip.setAttribute("role", "tooltip");
tip.hidden = true;
document.body.append(tip);
const tell = (mark, event) => {
  tip.textContent = mark.dataset.tip;
  tip.hidden = false;
  const box = mark.getBoundingClientRect();
  const x = event.clientX ?? box.x + box.width / 2, y = event.clientY ?? box.y;
  tip.style.left = Math.max(4, Math.min(x + 12, innerWidth - tip.offsetWidth - 8)) + "px";
  tip.style.top = (y - tip.offsetHeight - 10 < 0 ? y + 18 : y - tip.offsetHeight - 10) + "px";
};
for (const title of document.querySelectorAll("figure svg title")) {
  const mark = title.parentElement;
  mark.dataset.tip = title.textContent;
  mark.setAttribute("aria-label", title.textContent);
  title.remove();
  mark.addEventListener("pointermove", event => tell(mark, event));
  mark.addEventListener("focus", event => tell(mark, event));
  for (const leaving of ["pointerleave", "blur"]) mark.addEventListener(leaving, () => { tip.hidden = true; });
}
