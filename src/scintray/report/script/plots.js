// Plots of curves and histograms: values under the pointer, zoom along x, logarithmic y. Data are of chart().
"use strict";
(function (page) {
  let clips = 0;
  const SYMBOLS = [d3.symbolCircle, d3.symbolSquare, d3.symbolTriangle, d3.symbolDiamond];
  const middle = (s, i) => (s.steps ? 0.5 * (s.x[i] + s.x[i + 1]) : s.x[i]);

  function rows_of(data) {
    const x = data.x || "x", y = data.y || "y", steps = data.series.some((s) => s.steps);
    const rows = [["series", ...(steps ? [x + " from", x + " to"] : [x]), y, "standard error"]];
    for (const s of data.series)
      s.y.forEach((value, i) => rows.push([s.n, ...(steps ? [s.x[i], s.steps ? s.x[i + 1] : s.x[i]] : [s.x[i]]), value,
        s.e.length ? s.e[i] : ""]));
    return rows;
  }

  function enhance(box) {
    const data = page.data(box), svg = d3.select(box.querySelector("svg")), canvas = box.querySelector(".canvas");
    const [left, top, right, bottom] = data.area, colours = 7;
    const whole = d3.scaleLinear().domain(data.xr).range([left, right]);
    let log = data.log, x = whole, redrawn = false;
    let y = d3.scaleLinear().domain(data.yr).range([bottom, top]);
    if (log) y = d3.scaleLog().domain(data.yr.map((v) => Math.pow(10, v))).range([bottom, top]);
    const positive = data.series.some((s) => s.y.some((v) => v > 0));

    function y_scale(all) {
      if (all && log === data.log)
        return log ? d3.scaleLog().domain(data.yr.map((v) => Math.pow(10, v))).range([bottom, top])
          : d3.scaleLinear().domain(data.yr).range([bottom, top]);
      const [from, to] = x.domain();
      let low = Infinity, high = -Infinity;
      for (const s of data.series)
        s.y.forEach((value, i) => {
          const begin = s.x[i], end = s.steps ? s.x[i + 1] : s.x[i], error = s.e.length ? s.e[i] || 0 : 0;
          if (value === null || end < from || begin > to || (log && value <= 0)) return;
          low = Math.min(low, log || (data.zero && value >= 0) ? Math.max(log ? value : 0, value - error) : value - error);
          high = Math.max(high, value + error);
        });
      if (!(low <= high)) [low, high] = log ? [0.1, 1] : [0, 1];
      if (log) return d3.scaleLog().domain([low / 1.3, high * 1.3]).range([bottom, top]);
      if (data.zero) low = Math.min(low, 0);
      if (low === high) high = low + 1;
      return d3.scaleLinear().domain([low, high]).nice(5).range([bottom, top]);
    }
    function axis(group, made) {
      group.call(made).attr("font-size", null).attr("font-family", null);
      group.selectAll("text").attr("class", "tick").attr("fill", null);
      group.selectAll("line").attr("stroke", null);
      return group;
    }
    function draw_axes() {
      const axes = svg.select("g.axes"), labels = axes.selectAll("text.label").nodes().map((node) => node.cloneNode(true));
      axes.selectAll("*").remove();
      const ticks = log ? d3.axisLeft(y).ticks(5, "~g") : d3.axisLeft(y).ticks(5);
      const side = axis(axes.append("g").attr("transform", `translate(${left} 0)`), ticks.tickSize(left - right).tickPadding(8));
      side.selectAll("line").attr("class", "grid");
      side.select("path").remove();
      axis(axes.append("g").attr("transform", `translate(0 ${bottom})`), d3.axisBottom(x).ticks(8).tickSizeOuter(0))
        .selectAll("path, line").attr("class", "axis");
      if (data.top) {
        const scale = d3.scaleLinear().domain(x.domain().map((v) => v / data.top)).range([left, right]);
        axis(axes.append("g").attr("transform", `translate(0 ${top})`), d3.axisTop(scale).ticks(8).tickSizeOuter(0))
          .selectAll("path, line").attr("class", "axis");
      }
      for (const label of labels) axes.node().append(label);
    }
    function draw_curves() {
      const curves = svg.select("g.curves");
      const draws = (v) => v !== null && (!log || v > 0);
      curves.selectAll("*").remove();
      data.series.forEach((s, number) => {
        const group = curves.append("g").attr("class", "series c" + (number % colours));
        const points = s.y.map((value, i) => ({ x: s.x[i], mid: middle(s, i), y: value, e: s.e.length ? s.e[i] : 0 }));
        if (s.steps) points.push({ x: s.x[s.y.length], y: s.y[s.y.length - 1], e: 0 });
        if (s.joined)
          group.append("path").attr("class", "curve" + (s.dashed ? " dashed" : ""))
            .attr("d", d3.line().defined((p) => draws(p.y)).x((p) => x(p.x)).y((p) => y(p.y))
              .curve(s.steps ? d3.curveStepAfter : d3.curveLinear)(points));
        for (const p of points) {
          if (!draws(p.y)) continue;
          if (p.e > 0) {
            const at = x(p.mid === undefined ? p.x : p.mid), low = log && p.y <= p.e ? bottom : y(p.y - p.e);
            group.append("line").attr("class", "error").attr("x1", at).attr("x2", at).attr("y1", low).attr("y2", y(p.y + p.e));
          }
          if (s.marks)
            group.append("path").attr("class", "mark").attr("transform", `translate(${x(p.x)} ${y(p.y)})`)
              .attr("d", d3.symbol().type(SYMBOLS[number % SYMBOLS.length]).size(64)());
        }
      });
      if (!redrawn) {
        const id = "clip-" + ++clips;
        svg.append("clipPath").attr("id", id).append("rect").attr("x", left - 6).attr("y", top - 6)
          .attr("width", right - left + 12).attr("height", bottom - top + 6.6);
        curves.attr("clip-path", `url(#${id})`);
        redrawn = true;
      }
    }
    function draw(all) {
      y = y_scale(all);
      draw_axes();
      draw_curves();
      hide();
    }

    // The pointer and the arrow keys choose a place along x; the label has the nearest value of every curve.
    const cursor = svg.append("g").attr("class", "cursor").style("display", "none");
    const rule = cursor.append("line").attr("y1", top).attr("y2", bottom), tip = page.tip(box);
    const places = [...new Set(data.series.flatMap((s) => s.y.map((v, i) => middle(s, i))))].sort((a, b) => a - b);
    function index_at(s, value) {
      if (s.steps) return Math.min(Math.max(d3.bisectRight(s.x, value) - 1, 0), s.y.length - 1);
      let best = 0;
      s.x.forEach((at, i) => { if (Math.abs(at - value) < Math.abs(s.x[best] - value)) best = i; });
      return best;
    }
    const stepped = data.series.some((s) => s.steps);
    function nearest(value) {
      const i = d3.bisectLeft(places, value);
      return i > 0 && (i === places.length || value - places[i - 1] < places[i] - value) ? places[i - 1] : places[i];
    }
    function show(place_x, page_y) {
      const lines = [], value = stepped || !places.length ? place_x : nearest(place_x);
      cursor.selectAll("circle").remove();
      data.series.forEach((s, number) => {
        if (!s.y.length) return;
        const i = index_at(s, value), at = middle(s, i);
        if (s.steps ? value < s.x[0] || value > s.x[s.y.length] : Math.abs(x(at) - x(value)) > (stepped ? 40 : 1)) return;
        const where = s.steps ? page.number(s.x[i]) + " to " + page.number(s.x[i + 1]) : page.number(at);
        const error = s.e.length && s.e[i] ? " ± " + page.number(s.e[i]) : "";
        lines.push((s.n ? s.n + ", " : "") + where + ": " + page.number(s.y[i]) + error);
        if (s.y[i] !== null && (!log || s.y[i] > 0))
          cursor.append("circle").attr("r", 6).attr("cx", x(at)).attr("cy", y(s.y[i])).attr("class", "c" + (number % colours));
      });
      if (!lines.length) return hide();
      const at = Math.min(right, Math.max(left, x(value)));
      cursor.style("display", null);
      rule.attr("x1", at).attr("x2", at);
      const place = rule.node().getBoundingClientRect();
      tip.show(lines, place.left, page_y === undefined ? place.top + 0.3 * place.height : page_y);
    }
    function hide() {
      cursor.style("display", "none");
      tip.hide();
    }
    svg.on("pointermove", () => {
      const [px, py] = d3.mouse(svg.node());
      if (px < left || px > right || py < top || py > bottom) return hide();
      show(x.invert(px), d3.event.clientY);
    }).on("pointerleave", hide);

    const zoom = page.zoom(svg, data.area, (transform) => {
      x = d3.zoomIdentity.x === transform.x && transform.k === 1 ? whole : transform.rescaleX(whole);
      draw(transform.k === 1);
    });
    let chosen = -1;
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (step && places.length) {
        chosen = chosen < 0 ? (step > 0 ? 0 : places.length - 1) : Math.min(places.length - 1, Math.max(0, chosen + step));
        show(places[chosen]);
      } else if (event.key === "+") zoom.in();
      else if (event.key === "-") zoom.out();
      else if (event.key === "0") zoom.reset();
      else if (event.key === "Escape") hide();
      else return;
      event.preventDefault();
    });
    const scale = page.button("log", "logarithmic axis: " + data.title, () => {
      log = !log;
      scale.setAttribute("aria-pressed", String(log));
      draw(x === whole);
    });
    scale.setAttribute("aria-pressed", String(log));
    page.tools(box, data.title, [...(positive ? [scale] : []), ...page.zoom_buttons(zoom, data.title)], () => rows_of(data));
  }
  document.querySelectorAll(".chart[data-kind=plot]").forEach(enhance);
})(scintrayPage);
