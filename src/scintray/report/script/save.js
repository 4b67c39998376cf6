// What the scripts of a page share: buttons, and plots saved as SVG, PNG or CSV.
"use strict";
const scintrayPage = {};
(function (page) {
  page.make = function (tag, kind, text) {
    const made = document.createElement(tag);
    if (kind) made.className = kind;
    if (text !== undefined) made.textContent = text;
    return made;
  };
  page.button = function (text, title, act) {
    const made = page.make("button", "", text);
    made.type = "button";
    made.title = title;
    made.setAttribute("aria-label", text + ": " + title);
    made.addEventListener("click", act);
    return made;
  };
  // Six digits are more than a plot shows.
  page.number = (value) => (value === null || value === undefined ? "none" : String(+value.toPrecision(6)));

  const STYLES = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray", "stroke-linejoin",
    "paint-order", "font-family", "font-size", "font-weight", "text-anchor", "image-rendering", "opacity"];
  // A drawing with its style written into every element, so that it looks alike outside of the page.
  function standalone(svg) {
    const copy = svg.cloneNode(true), from = [svg, ...svg.querySelectorAll("*")], to = [copy, ...copy.querySelectorAll("*")];
    from.forEach((element, i) => {
      const style = getComputedStyle(element);
      for (const name of STYLES) to[i].style.setProperty(name, style.getPropertyValue(name));
    });
    copy.querySelectorAll(".cursor").forEach((element) => element.remove());
    const box = svg.viewBox.baseVal;
    copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    copy.setAttribute("width", box.width);
    copy.setAttribute("height", box.height);
    copy.style.maxWidth = "none";
    copy.style.background = getComputedStyle(document.body).backgroundColor;
    return { text: new XMLSerializer().serializeToString(copy), width: box.width, height: box.height };
  }
  function save(blob, name) {
    const link = page.make("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }
  function save_png(svg, name) {
    const SCALE = 2, drawn = standalone(svg), image = new Image();
    image.onload = () => {
      const canvas = page.make("canvas");
      canvas.width = SCALE * drawn.width;
      canvas.height = SCALE * drawn.height;
      canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => save(blob, name));
    };
    image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(drawn.text);
  }
  const quoted = (cell) => (/[",\n]/.test(cell) ? "\"" + String(cell).replace(/"/g, "\"\"") + "\"" : String(cell));
  page.csv = (rows) => rows.map((row) => row.map((cell) => (cell === null || cell === undefined ? "" : quoted(cell))).join(",")).join("\n") + "\n";

  // The row of buttons of a plot. `rows` makes the rows of its table, head first.
  page.tools = function (box, title, buttons, rows) {
    const bar = page.make("div", "tools"), svg = box.querySelector("svg");
    const name = title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "plot";
    bar.setAttribute("role", "group");
    bar.setAttribute("aria-label", "tools of the plot: " + title);
    bar.append(...buttons,
      page.button("SVG", "save the plot as SVG", () => save(new Blob([standalone(svg).text], { type: "image/svg+xml" }), name + ".svg")),
      page.button("PNG", "save the plot as PNG", () => save_png(svg, name + ".png")),
      page.button("CSV", "save the numbers as CSV", () => save(new Blob([page.csv(rows())], { type: "text/csv" }), name + ".csv")));
    box.append(bar);
    return bar;
  };

  // A label that follows the pointer inside a plot; screen readers read what the keyboard put there.
  page.tip = function (box) {
    const tip = page.make("div", "tip");
    tip.hidden = true;
    tip.setAttribute("role", "status");
    box.append(tip);
    return {
      show(lines, x, y) {
        tip.replaceChildren(...lines.map((line) => page.make("div", "", line)));
        tip.hidden = false;
        const frame = box.getBoundingClientRect();
        const left = Math.min(Math.max(0, x - frame.left + 14), Math.max(0, frame.width - tip.offsetWidth - 2));
        const above = y - frame.top - tip.offsetHeight - 12;
        tip.style.left = left + "px";
        tip.style.top = (above > 0 ? above : y - frame.top + 18) + "px";
      },
      hide() { tip.hidden = true; },
    };
  };
  page.data = (box) => JSON.parse(box.querySelector("script").textContent);

  // Zoom by buttons, pinch, Ctrl and wheel, double click; drag moves. One finger scrolls the page.
  page.zoom = function (svg, area, changed) {
    const [left, top, right, bottom] = area;
    const behaviour = d3.zoom().scaleExtent([1, 200]).extent([[left, top], [right, bottom]])
      .translateExtent([[left, top], [right, bottom]])
      .filter(() => {
        const event = d3.event;
        if (event.type === "wheel") return event.ctrlKey || event.metaKey;
        return event.touches ? event.touches.length > 1 : !event.button;
      })
      .on("zoom", () => changed(d3.event.transform));
    svg.call(behaviour);
    const by = (factor) => svg.call(behaviour.scaleBy, factor);
    return { in: () => by(1.5), out: () => by(1 / 1.5), reset: () => svg.call(behaviour.transform, d3.zoomIdentity) };
  };
  page.zoom_buttons = (zoom, title) => [page.button("+", "zoom in: " + title, zoom.in), page.button("−", "zoom out: " + title, zoom.out),
    page.button("all", "show all: " + title, zoom.reset)];
})(scintrayPage);
