// What a picture of a scene asks of a graphics processor, counted in the page, whatever draws it: calls that draw, triangles,
// ends of lines, bytes sent, points filled, and the time that the page's JavaScript takes.
"use strict";

// Runs in the page before its scripts: counts what is asked of WebGL, frame by frame. Uses nothing from outside.
function count_in_page() {
  const counts = window.frameCounts = { calls: 0, triangles: 0, line_ends: 0, uploaded: 0, script_ms: 0, at_once: false };
  const TRIANGLES = 4, LINES = 1, LINE_STRIP = 3, RENDERER_NAMES = [0x1f01, 0x9246];
  const drawn = (mode, elements) => {
    ++counts.calls;
    if (mode === TRIANGLES) counts.triangles += elements / 3;
    if (mode === LINES) counts.line_ends += elements;
    if (mode === LINE_STRIP) counts.line_ends += 2 * (elements - 1);
  };
  const bytes = (data) => data && data.byteLength || (data && data.width ? 4 * data.width * data.height : 0);
  const sent = (...values) => { counts.uploaded += typeof values[1] === "number" ? values[1] : bytes(values[1]); };
  const picture_sent = (...values) => { counts.uploaded += bytes(values[values.length - 1]); };
  const counters = {
    drawArrays: (mode, first, count) => drawn(mode, count),
    drawElements: (mode, count) => drawn(mode, count),
    drawArraysInstanced: (mode, first, count, times) => drawn(mode, count * times),
    drawElementsInstanced: (mode, count, type, offset, times) => drawn(mode, count * times),
    bufferData: sent,
    bufferSubData: (target, offset, data) => sent(target, data),
    texImage2D: picture_sent,
    texSubImage2D: picture_sent,
  };
  for (const prototype of [WebGLRenderingContext.prototype, WebGL2RenderingContext.prototype]) {
    for (const [name, count] of Object.entries(counters)) {
      const call = prototype[name];
      if (call) prototype[name] = function (...values) { count(...values); return call.apply(this, values); };
    }
    // For the page, a graphics processor draws, and at once: a point that it reads, to learn how long a picture took, is there.
    const read = prototype.readPixels, parameter = prototype.getParameter;
    prototype.readPixels = function (...values) { if (!counts.at_once) read.apply(this, values); };
    prototype.getParameter = function (name) { return RENDERER_NAMES.includes(name) ? "counted" : parameter.call(this, name); };
  }
  const request = window.requestAnimationFrame;
  window.requestAnimationFrame = (work) => request.call(window, (now) => {
    const begin = performance.now();
    work(now);
    counts.script_ms += performance.now() - begin;
  });
}

// Runs in the page: points of the picture that its triangles and lines fill, all layers of them. The scene is drawn once more,
// elsewhere, each layer brighter by one.
function points_filled() {
  const { space, camera } = window.scintrayView, { width, height } = document.getElementById("scene");
  const renderer = new THREE.WebGLRenderer({ antialias: false }), gl = renderer.getContext();
  renderer.setSize(width, height, false);
  renderer.setClearColor(0);
  space.overrideMaterial = new THREE.MeshBasicMaterial({ color: 0x010101, blending: THREE.AdditiveBlending, depthTest: false,
    depthWrite: false, side: THREE.DoubleSide });
  renderer.render(space, camera);
  space.overrideMaterial = null;
  const points = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, points);
  renderer.forceContextLoss();
  const layers = points.filter((_, i) => i % 4 === 0);
  return { points: layers.reduce((sum, count) => sum + count, 0),
    layers: layers.reduce((most, count) => Math.max(most, count), 0) };
}

// Per picture drawn while the camera turns, or the page does what it does: means of what was counted, and the median of the time.
async function per_picture(page, turn) {
  return page.evaluate(async (turn) => {
    const PICTURES = 8, view = window.scintrayView, counts = window.frameCounts, times = [];
    const next = () => new Promise((done) => requestAnimationFrame(() => {
      if (turn) view.turn([0.2, 0], 1);
      setTimeout(done, 0);
    }));
    for (let i = 0; i < 3; ++i) await next();  // what comes with a begin is not counted
    const before = { ...counts, pictures: view.counts.frames };
    while (times.length < PICTURES) {
      const script_ms = counts.script_ms, pictures = view.counts.frames;
      await next();
      if (view.counts.frames > pictures) times.push(counts.script_ms - script_ms);
    }
    const mean = (key) => (counts[key] - before[key]) / (view.counts.frames - before.pictures);
    return { calls: mean("calls"), triangles: mean("triangles"), line_ends: mean("line_ends"), uploaded: mean("uploaded"),
      script_ms: times.sort((a, b) => a - b)[PICTURES / 2] };
  }, turn);
}

// What the pictures of a page with a scene cost, within limits; lines to print.
async function frame_costs(page, most, expect) {
  const lines = [], filled = {}, rest = () => page.waitForTimeout(1000);
  const set = (id, value) => page.$eval("#" + id, (field, v) => {
    field.value = v;
    for (const kind of ["input", "change"]) field.dispatchEvent(new Event(kind));
  }, value);
  const count = async (title, turn) => {
    const costs = await per_picture(page, turn), whole = (x) => Math.round(x).toLocaleString("en");
    for (const [key, value] of Object.entries(costs))
      expect(value <= most[key], `${title}: ${key} ${value.toFixed(1)}, at most ${most[key]}`);
    lines.push(`${title}: ${whole(costs.calls)} calls that draw, ${whole(costs.triangles)} triangles, ` +
      `${whole(costs.line_ends)} ends of lines, ${whole(costs.uploaded)} bytes sent, JavaScript ${costs.script_ms.toFixed(1)} ms`);
  };
  await page.evaluate(() => { window.frameCounts.at_once = true; });
  await count("turned", true);
  await page.selectOption("#axis", "x");
  await set("cut", "0.5");
  await count("turned, cut", true);
  await page.selectOption("#axis", "");
  await set("apart", "0.5");
  await count("turned, apart", true);
  await set("apart", "0");
  await page.evaluate(() => window.scintrayView.show_path(0));
  await count("turned, a path chosen", true);
  await rest();
  await page.click("#play");
  await count("played", false);
  await page.click("#play");
  await set("time", "1");
  await page.evaluate(() => { window.frameCounts.at_once = false; });
  for (const side of await page.$$("[data-look]")) {
    await side.click();
    await rest();
    filled[await side.textContent()] = await page.evaluate(points_filled);
  }
  await page.evaluate(() => window.scintrayView.turn([0, 0], 0.5));
  await rest();
  filled["from half the distance"] = await page.evaluate(points_filled);
  for (const [from, { points, layers }] of Object.entries(filled))
    expect(layers < 255 && points <= most.filled, `points filled, ${from}: ${points} in at most ${layers} layers, at most ${most.filled}`);
  lines.push("fills, all layers: " +
    Object.entries(filled).map(([from, { points }]) => `${from} ${(points / 1e6).toFixed(1)} million points`).join(", "));
  return lines;
}

module.exports = { count_in_page, frame_costs };
