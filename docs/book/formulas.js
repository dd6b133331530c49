// Formulas of the book: ```math blocks, and code spans between two dollar signs, as MathML.
"use strict";

function render(formula, displayMode) {
  const place = document.createElement(displayMode ? "div" : "span");
  katex.render(formula, place, { output: "mathml", displayMode, throwOnError: false });
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
