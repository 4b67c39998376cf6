// A report as it is printed: on A4 with margins of 10 mm nothing is wider than the paper, nothing is there to be clicked,
// and colours are those of light pages also where the browser is dark.
"use strict";
const A4 = { width: 718, height: 1047 };  // px, 96 to the inch

// Of every element that is drawn: its colours. Runs in the page.
function colours() {
  const seen = [];
  for (const one of document.querySelectorAll("body, body *")) {
    if (!one.checkVisibility() || one.closest("script, style")) continue;
    const style = getComputedStyle(one);
    seen.push([one.tagName + "." + (one.getAttribute("class") || ""), style.color, style.backgroundColor, style.fill, style.stroke].join(" "));
  }
  return seen;
}

// What is cut off, and what could be clicked. Runs in the page.
function faults() {
  const shown = (one) => one.checkVisibility() && one.getClientRects().length > 0, name = (one) => one.tagName.toLowerCase() +
    (one.id ? "#" + one.id : "") + [...one.classList].map((c) => "." + c).join("") + " \"" + (one.textContent || "").trim().slice(0, 30) + "\"";
  const cut = [], controls = [], all = [...document.querySelectorAll("body *")].filter(shown);
  for (const one of all) {
    const style = getComputedStyle(one), box = one.getBoundingClientRect();
    if (box.right > innerWidth + 1 && !one.closest("svg svg")) cut.push(name(one) + " reaches to " + box.right.toFixed(0) + " px");
    if (style.overflowX !== "visible" && one.scrollWidth > one.clientWidth + 1 && !one.closest("svg, .bar")) cut.push(name(one) + " scrolls");
    if (style.overflowY !== "visible" && one.scrollHeight > one.clientHeight + 1 && !one.closest("svg, .bar")) cut.push(name(one) + " is cut below");
    if (one.matches("button, input, select, textarea, canvas") && !one.closest("thead")) controls.push(name(one));
  }
  // A heading with nothing beneath it.
  const bare = [...document.querySelectorAll("h2")].filter(shown).filter((head) => {
    let next = head.nextElementSibling;
    while (next && !shown(next) && next.tagName !== "H2") next = next.nextElementSibling;
    return !next || next.tagName === "H2";
  }).map(name);
  return { cut, controls, bare, paper: getComputedStyle(document.body).backgroundColor, title: Boolean(document.querySelector("h1").checkVisibility()) };
}

// Pages of the printed document. `file` keeps it where it is given, and the picture of it beside it.
async function print(page, colorScheme, expect, file) {
  const before = page.viewportSize();
  await page.setViewportSize(A4);
  await page.emulateMedia({ media: "print", colorScheme: "light" });
  const light = await page.evaluate(colours);
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  const dark = await page.evaluate(colours);
  const other = light.findIndex((one, i) => one !== dark[i]);
  expect(other < 0, `printed colours are those of a light page: ${light[other]}, and dark ${dark[other]}`);
  const found = await page.evaluate(faults);
  for (const one of found.cut.slice(0, 5)) expect(false, "printed whole: " + one);
  for (const one of found.controls.slice(0, 5)) expect(false, "not printed: " + one);
  for (const one of found.bare) expect(false, "a printed heading has something under it: " + one);
  expect(found.paper === "rgb(255, 255, 255)", "paper is white: " + found.paper);
  if (file) await page.screenshot({ path: file + ".png", fullPage: true });
  const pdf = await page.pdf({ format: "A4", margin: { left: "10mm", right: "10mm", top: "10mm", bottom: "10mm" }, printBackground: false });
  if (file) require("fs").writeFileSync(file + ".pdf", pdf);
  const sheets = (pdf.toString("latin1").match(/\/Type\s*\/Page\b/g) || []).length;
  expect(sheets > 0, "it is printed");
  await page.emulateMedia({ media: null, colorScheme });
  await page.setViewportSize(before);
  return sheets;
}

module.exports = { print };
