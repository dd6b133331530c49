// Formulas of the book, ```math blocks and code spans between two dollar signs; links to sources that are not in it.
"use strict";

// As a page of the book and not one of its styles, so that it finds its fonts beside it. mdBook gives path_to_root.
const style = document.createElement("link");
style.rel = "stylesheet";
style.href = `${path_to_root}book/katex.min.css`;
document.head.append(style);

function render(formula, displayMode) {
  const place = document.createElement(displayMode ? "div" : "span");
  katex.render(formula, place, { displayMode, throwOnError: false });
  return place;
}

for (const code of document.querySelectorAll("code.language-math")) {
  code.closest("pre").replaceWith(render(code.textContent, true));
}

for (const code of document.querySelectorAll("code")) {
  const [before, after] = [code.previousSibling, code.nextSibling];
  if (!before?.nodeValue?.endsWith("$") || !after?.nodeValue?.startsWith("$")) {
    continue;
  }
  before.nodeValue = before.nodeValue.slice(0, -1);
  after.nodeValue = after.nodeValue.slice(1);
  code.replaceWith(render(code.textContent, false));
}

const root = new URL(path_to_root || ".", location.href).href;
for (const link of document.querySelectorAll("main a[href]")) {
  const isHere = link.protocol === location.protocol && link.host === location.host;
  if (isHere && !link.href.startsWith(root)) {
    link.replaceWith(...link.childNodes);
  }
}
