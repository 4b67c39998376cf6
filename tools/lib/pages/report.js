// Plots and tables of a page.
"use strict";
const fs = require("fs");

// Every plot of a page: drawn, with tools, values and files.
async function plots(page, expect) {
  await page.evaluate(() => document.querySelectorAll("details").forEach((details) => { details.open = true; }));
  const charts = await page.$$(".chart");
  for (const [number, chart] of charts.entries()) {
    const canvas = await chart.$(".canvas"), what = "plot " + (number + 1) + " (" + await canvas.getAttribute("aria-label") + ")";
    const drawn = await chart.$eval("svg", (svg) => ({ area: svg.getBoundingClientRect().width * svg.getBoundingClientRect().height,
      parts: svg.querySelectorAll("path, image, line").length }));
    expect(drawn.area > 1000 && drawn.parts > 0, what + " is drawn");
    const kind = await chart.getAttribute("data-kind");
    await chart.scrollIntoViewIfNeeded();
    await canvas.evaluate((element) => { element.scrollLeft = 0; });
    const box = await chart.$eval("svg", (svg) => { const r = svg.getBoundingClientRect(); return [r.left, r.top, r.width, r.height]; });
    let shown = false;
    for (const share of [0.3, 0.45, 0.6, 0.2, 0.75]) {
      await page.mouse.move(box[0] + share * box[2], box[1] + 0.5 * box[3]);
      shown = shown || await chart.$eval(".tip", (tip) => !tip.hidden && tip.textContent.length > 0);
      if (shown) break;
    }
    expect(shown, what + " shows values under the pointer");
    if (kind !== "polar") {
      await canvas.focus();
      await page.keyboard.press("ArrowRight");
      expect(await chart.$eval(".tip", (tip) => !tip.hidden), what + " shows values to the arrow keys");
      const before = await chart.$eval("g.axes", (axes) => axes.textContent);
      await chart.$eval(".tools", (tools) => [...tools.querySelectorAll("button")].find((b) => b.textContent === "+").click());
      expect(await chart.$eval("g.axes", (axes) => axes.textContent) !== before, what + " zooms");
      await chart.$eval(".tools", (tools) => [...tools.querySelectorAll("button")].find((b) => b.textContent === "all").click());
    }
    const log = await chart.$(".tools button[aria-label^=log]");
    if (log) {
      const state = (svg) => svg.querySelector("image") ? svg.querySelector("image").getAttribute("href") : svg.querySelector("g.axes").innerHTML;
      const before = await chart.$eval("svg", state);
      await log.evaluate((button) => button.click());
      expect(await chart.$eval("svg", state) !== before, what + " changes its scale");
      await log.evaluate((button) => button.click());
    }
    if (number < 3)
      for (const [word, begin] of [["SVG", "<svg"], ["PNG", "\x89PNG"], ["CSV", ""]]) {
        const [download] = await Promise.all([page.waitForEvent("download", { timeout: 10000 }),
          chart.$eval(".tools", (tools, text) => [...tools.querySelectorAll("button")].find((b) => b.textContent === text).click(), word)]);
        const content = fs.readFileSync(await download.path(), "latin1");
        expect(content.startsWith(begin) && content.length > 20, what + " saves " + word);
      }
  }
  return charts.length;
}

// Sorting and searching of tables; columns that can be sorted.
async function tables(page, expect) {
  const sorted = await page.$$("th[aria-sort] button");
  for (const button of sorted.slice(0, 6)) {
    await button.evaluate((element) => element.click());
    expect(await button.evaluate((element) => element.parentElement.getAttribute("aria-sort")) === "ascending", "a table is sorted");
  }
  for (const field of await page.$$(".search input")) {
    const result = await field.evaluate((input) => {
      input.value = "no such row";
      input.dispatchEvent(new Event("input"));
      const table = input.closest("label").nextElementSibling, hidden = [...table.querySelectorAll("tbody tr")].every((row) => row.hidden);
      input.value = "";
      input.dispatchEvent(new Event("input"));
      return hidden && [...table.querySelectorAll("tbody tr")].every((row) => !row.hidden);
    });
    expect(result, "a table is searched");
  }
  return sorted.length;
}

module.exports = { plots, tables };
