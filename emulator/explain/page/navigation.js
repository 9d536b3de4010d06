// Light and dark: the reader's system decides, until the button does.
const root = document.documentElement;
const remembered = (value) => {
  try { return value ? localStorage.setItem("trax-theme", value) : localStorage.getItem("trax-theme"); } catch { return null;
    /* a page from a file may have no storage */ }
};
function drawNavigation() {
  if (["light", "dark"].includes(remembered())) root.dataset.theme = remembered();
  for (const section of document.querySelectorAll("main > section")) byId("nav")
    .append(element("a", { href: `#${section.id}` }, section.dataset.title));
  byId("nav").append(element("button", { id: "theme", type: "button", onclick: () => {
    const now = root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
    root.dataset.theme = now === "dark" ? "light" : "dark";
    remembered(root.dataset.theme);
  } }, "Light or dark"));
}

