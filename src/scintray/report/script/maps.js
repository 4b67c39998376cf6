// Maps of values over two axes and over a hemisphere: values under the pointer, zoom, scale of the colours. Data are of
// grid_map(), polar_map() and hemisphere_map().
"use strict";
(function (page) {
  const TOPS = [["largest", 1], ["99.5 % of cells", 0.995], ["98 % of cells", 0.98], ["95 % of cells", 0.95]];

  // The scale of colours: a share in 0 to 1 of a value, the same as that of the drawing at first.
  function Shades(data) {
    const positive = data.values.filter((v) => v > 0).sort((a, b) => a - b);
    const most = positive.length ? positive[positive.length - 1] : 1, unit = data.unit || 1;
    const scale = { log: Boolean(data.log || data.decades), top: most };
    scale.share = function (value) {
      if (data.decades && scale.log) return value > 0 ? 1 + Math.log10(value / scale.top) / data.decades : 0;
      return scale.log ? Math.log1p(Math.max(0, value) / unit) / Math.log1p(scale.top / unit) : value / scale.top;
    };
    scale.set_top = (quantile) => { scale.top = positive.length ? d3.quantile(positive, quantile) : 1; };
    scale.colour = function (value) {
      const c = d3.rgb(d3.interpolateViridis(Math.min(1, Math.max(0, scale.share(value)))));
      return [c.r, c.g, c.b, 255];
    };
    return scale;
  }
  function picture(width, height, colour_at) {
    const canvas = page.make("canvas");
    canvas.width = width;
    canvas.height = height;
    const context = canvas.getContext("2d"), pixels = context.createImageData(width, height);
    for (let row = 0; row < height; ++row)
      for (let column = 0; column < width; ++column) pixels.data.set(colour_at(column, row), 4 * (row * width + column));
    context.putImageData(pixels, 0, 0);
    return canvas.toDataURL();
  }
  // Buttons of the scale; `draw` paints the cells anew.
  function scale_tools(box, data, shades, draw) {
    const ends = [...box.querySelectorAll(".scale > span:not(.shades)")];
    function changed() {
      draw();
      const middle = box.querySelector(".shades span");
      if (middle) middle.textContent = "";
      if (!ends.length) return;
      const low = data.decades && shades.log ? shades.top * Math.pow(10, -data.decades) : 0;
      ends[0].textContent = +low.toPrecision(3);
      ends[ends.length - 1].textContent = +shades.top.toPrecision(3) + " " + data.value + (shades.log ? ", logarithmic" : "");
    }
    const log = page.button("log", "logarithmic colours: " + data.title, () => {
      shades.log = !shades.log;
      log.setAttribute("aria-pressed", String(shades.log));
      changed();
    });
    log.setAttribute("aria-pressed", String(shades.log));
    const top = page.make("select");
    top.setAttribute("aria-label", "upper end of the colours: " + data.title);
    TOPS.forEach(([name, quantile]) => {
      const option = page.make("option", "", "up to " + name);
      option.value = quantile;
      top.append(option);
    });
    top.addEventListener("change", () => { shades.set_top(+top.value); changed(); });
    return [log, top];
  }

  function enhance_grid(box) {
    const data = page.data(box), svg = d3.select(box.querySelector("svg")), canvas = box.querySelector(".canvas");
    const [left, top, right, bottom] = data.area, shades = Shades(data), tip = page.tip(box);
    const whole_x = d3.scaleLinear().domain(data.x).range([left, right]), whole_y = d3.scaleLinear().domain(data.y).range([bottom, top]);
    let x = whole_x, y = whole_y, cell = null;
    const cells = svg.select("g.cells");
    const draw = () => cells.select("image").attr("href", picture(data.columns, data.rows,
      (column, row) => shades.colour(data.values[(data.rows - 1 - row) * data.columns + column])));
    const edge = (range, count, i) => range[0] + (range[1] - range[0]) * i / count;
    const name_of = (axis, i) => data.names[axis][i] || page.number(edge(axis ? data.y : data.x, axis ? data.rows : data.columns, i)) +
      " to " + page.number(edge(axis ? data.y : data.x, axis ? data.rows : data.columns, i + 1));
    const mark = svg.append("rect").attr("class", "cursor").style("display", "none");
    function show(column, row, page_x, page_y) {
      cell = [column, row];
      const x0 = x(edge(data.x, data.columns, column)), x1 = x(edge(data.x, data.columns, column + 1));
      const y0 = y(edge(data.y, data.rows, row + 1)), y1 = y(edge(data.y, data.rows, row));
      mark.style("display", null).attr("x", x0).attr("y", y0).attr("width", Math.max(2, x1 - x0)).attr("height", Math.max(2, y1 - y0));
      const place = mark.node().getBoundingClientRect();
      tip.show([data.labels[0] + " " + name_of(0, column), data.labels[1] + " " + name_of(1, row),
        page.number(data.values[row * data.columns + column]) + " " + data.value],
      page_x === undefined ? place.right : page_x, page_y === undefined ? place.top : page_y);
    }
    function hide() {
      mark.style("display", "none");
      tip.hide();
    }
    svg.on("pointermove", () => {
      const [px, py] = d3.mouse(svg.node());
      const column = Math.floor((x.invert(px) - data.x[0]) / (data.x[1] - data.x[0]) * data.columns);
      const row = Math.floor((y.invert(py) - data.y[0]) / (data.y[1] - data.y[0]) * data.rows);
      if (px < left || px > right || py < top || py > bottom || column < 0 || row < 0 || column >= data.columns || row >= data.rows)
        return hide();
      show(column, row, d3.event.clientX, d3.event.clientY);
    }).on("pointerleave", hide);

    let clipped = false;
    const zoom = page.zoom(svg, data.area, (transform) => {
      x = transform.rescaleX(whole_x);
      y = transform.rescaleY(whole_y);
      if (!clipped) {
        const id = "map-clip-" + Math.random().toString(36).slice(2);
        svg.append("clipPath").attr("id", id).append("rect").attr("x", left).attr("y", top).attr("width", right - left)
          .attr("height", bottom - top);
        const outer = svg.insert("g", "g.cells").attr("clip-path", `url(#${id})`);
        outer.node().append(cells.node());
        clipped = true;
      }
      cells.attr("transform", transform);
      const axes = svg.select("g.axes");
      axes.selectAll("*").remove();
      for (const [made, at] of [[d3.axisBottom(x), `translate(0 ${bottom})`], [d3.axisLeft(y), `translate(${left} 0)`]]) {
        const group = axes.append("g").attr("transform", at).call(made.ticks(5).tickSize(3));
        group.attr("font-size", null).attr("font-family", null).select("path").remove();
        group.selectAll("text").attr("class", "tick").attr("fill", null);
      }
      hide();
    });
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (step) {
        const from = cell || [Math.floor(data.columns / 2), Math.floor(data.rows / 2)];
        show(Math.min(data.columns - 1, Math.max(0, from[0] + step[0])), Math.min(data.rows - 1, Math.max(0, from[1] + step[1])));
      } else if (event.key === "+") zoom.in();
      else if (event.key === "-") zoom.out();
      else if (event.key === "0") zoom.reset();
      else if (event.key === "Escape") hide();
      else return;
      event.preventDefault();
    });
    const borders = [];
    for (const [kind, word] of [["border", "regions"], ["outline", "crystals"]]) {
      const drawn = cells.selectAll("path." + kind);
      if (drawn.empty()) continue;
      const shown = drawn.attr("display") !== "none";
      const toggle = page.button(word, "show " + word + ": " + data.title, () => {
        const on = toggle.getAttribute("aria-pressed") !== "true";
        toggle.setAttribute("aria-pressed", String(on));
        drawn.attr("display", on ? null : "none");
      });
      toggle.setAttribute("aria-pressed", String(shown));
      borders.push(toggle);
    }
    page.tools(box, data.title, [...scale_tools(box, data, shades, draw), ...borders, ...page.zoom_buttons(zoom, data.title)], () => {
      const rows = [[data.labels[0] + " from", data.labels[0] + " to", data.labels[1] + " from", data.labels[1] + " to", data.value]];
      const ends = (axis, i) => (data.names[axis][i] ? [data.names[axis][i], data.names[axis][i]]
        : [i, i + 1].map((k) => edge(axis ? data.y : data.x, axis ? data.rows : data.columns, k)));
      for (let row = 0; row < data.rows; ++row)
        for (let column = 0; column < data.columns; ++column)
          rows.push([...ends(0, column), ...ends(1, row), data.values[row * data.columns + column]]);
      return rows;
    });
  }

  function enhance_polar(box) {
    const data = page.data(box), svg = d3.select(box.querySelector("svg")), shades = Shades(data), tip = page.tip(box);
    const first = [0];
    for (const count of data.cells) first.push(first[first.length - 1] + count);
    const start = (ring) => (data.start === null ? -180 / data.cells[ring] : data.start);
    function cell_at(right, up) {
      const polar = 90 * Math.hypot(right, up);
      if (polar >= 90) return -1;
      const ring = Math.min(data.cells.length - 1, d3.bisectRight(data.edges, polar) - 1);
      const turns = (Math.atan2(up, right) * 180 / Math.PI - start(ring)) / 360;
      return first[ring] + Math.min(data.cells[ring] - 1, Math.floor((turns - Math.floor(turns)) * data.cells[ring]));
    }
    function ends(cell) {
      const ring = d3.bisectRight(first, cell) - 1, step = 360 / data.cells[ring], from = start(ring) + (cell - first[ring]) * step;
      return [data.edges[ring], data.edges[ring + 1], from, from + step];
    }
    const half = 0.5 * data.pixels;
    const draw = () => svg.select("image").attr("href", picture(data.pixels, data.pixels, (column, row) => {
      const cell = cell_at((column + 0.5 - half) / half, (half - row - 0.5) / half);
      return shades.colour(cell < 0 ? 0 : data.values[cell]);
    }));
    svg.on("pointermove", () => {
      const [px, py] = d3.mouse(svg.node()), cell = cell_at((px - data.middle) / data.radius, (data.middle - py) / data.radius);
      if (cell < 0) return tip.hide();
      const [low, high, from, to] = ends(cell).map(page.number);
      tip.show([`polar angle ${low} to ${high} deg`, `azimuth ${from} to ${to} deg`, page.number(data.values[cell]) + " " + data.value],
        d3.event.clientX, d3.event.clientY);
    }).on("pointerleave", tip.hide);
    page.tools(box, data.title, scale_tools(box, data, shades, draw), () =>
      [["polar from (deg)", "polar to (deg)", "azimuth from (deg)", "azimuth to (deg)", data.value],
        ...data.values.map((value, cell) => [...ends(cell), value])]);
  }
  document.querySelectorAll(".chart[data-kind=grid]").forEach(enhance_grid);
  document.querySelectorAll(".chart[data-kind=polar]").forEach(enhance_polar);
})(scintrayPage);
