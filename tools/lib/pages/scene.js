// The scene in three dimensions, of `scintray view` or inside of a report: what a user does there with the mouse, and
// whether the picture and the panel follow.
"use strict";
const in_page = require("./in_page.js");

// Points of the picture that may differ where nothing should: smoothed edges are drawn anew.
const FEW_POINTS = 40;

// Opens the view; seconds from the start of the page, or from the click that opens it, until it is drawn and answers.
async function open_scene(page) {
  const open = await page.$(".view-open");
  if (!open && !await page.$("#scene")) return null;
  if (open) {
    await open.scrollIntoViewIfNeeded();
    await page.evaluate(() => { window.opened_ms = performance.now(); });
    await open.click();
  }
  await page.waitForFunction(() => window.scintrayView && window.scintrayView.frames > 0, null, { polling: 20, timeout: 60000 });
  return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(() => {
    // Reading a point waits until the picture is drawn.
    const canvas = document.getElementById("scene"), gl = canvas.getContext("webgl2") || canvas.getContext("webgl");
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    done((performance.now() - (window.opened_ms || 0)) / 1000);
  }, 0))));
}

class Scene {
  constructor(page, expect) { this.page = page; this.expect = expect; }
  seen(name, ...given) { return this.page.evaluate(([n, a]) => window.scintraySeen[n](...a), [name, given]); }
  chosen() { return this.page.$eval("#chosen", (chosen) => chosen.textContent); }
  async set(id, value) {
    await this.page.$eval("#" + id, (field, v) => {
      field.value = v;
      for (const kind of ["input", "change"]) field.dispatchEvent(new Event(kind));
    }, value);
    await this.seen("rest");
  }
  // Ticks or unticks by a click of the mouse.
  async tick(box, on) {
    if (await box.isChecked() === on) return;
    await box.scrollIntoViewIfNeeded();
    await box.click();
  }
  // Opens the panel, or on a narrow window, where it covers the picture, closes it.
  async panel(open) {
    const [folded, narrow] = await this.page.$eval("#view", (view) => ["folded", "narrow"].map((name) => view.classList.contains(name)));
    if (folded !== open || !narrow) return;
    await this.page.click("#menu");
    await this.seen("rest");
  }
  async click(x, y) {
    await this.page.mouse.click(x, y);
    await this.seen("rest");
  }
  async rows() {
    return this.page.$$eval("#chosen tbody tr", (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
  }

  // A click on a vertex of a path has the path's history: of a fate with few paths, so that one lies alone.
  async pick_path() {
    const fates = await this.page.evaluate(() => {
      const count = {};
      for (const path of window.scintrayView.histories) count[path.fate] = (count[path.fate] || 0) + 1;
      return window.scintrayView.data.fates.map((fate) => [fate, count[fate]]);
    });
    const order = fates.map(([, count], i) => [count, i]).sort((a, b) => a[0] - b[0]).map((one) => one[1]);
    for (const wanted of order) {
      await this.panel(true);
      for (const [i, box] of (await this.page.$$("#fates input")).entries()) await this.tick(box, i === wanted);
      await this.panel(false);
      await this.seen("rest");
      const lone = await this.page.evaluate((fate) => window.scintraySeen.lone_vertex((path) => path.fate === fate), fates[wanted][0]);
      if (!lone) continue;
      await this.seen("keep", "before");
      await this.click(lone.x, lone.y);
      const { title, events } = await this.seen("history", lone.number), rows = await this.rows();
      const head = await this.page.$eval("#chosen", (chosen) => chosen.firstChild.textContent);
      this.expect(head === title, `a click on ${title} shows it, not "${head}"`);
      this.expect(rows.length === events.length && rows.every((row, i) => row[1] === events[i]),
        `the history of ${title} has its ${events.length} steps: ${rows.length} rows`);
      this.expect(rows.every((row) => row.length === 7 && row.slice(2).every((cell) => cell !== "" && isFinite(cell))),
        "every step of a history has time, wavelength and place");
      await this.panel(false);
      this.expect(await this.seen("changed", "before") > 0, "the path that was clicked is marked");
      break;
    }
    await this.panel(true);
    for (const box of await this.page.$$("#fates input")) await this.tick(box, true);
    await this.panel(false);
    return (await this.rows()).length;
  }

  // A click on a face has its part, surface, rule and what the run counted there.
  async pick_face(media, only_sensors, what) {
    const place = await this.seen("place_of_face", media, only_sensors);
    if (!place) return null;
    await this.click(place.x, place.y);
    const rows = new Map(await this.rows()), head = await this.page.$eval("#chosen", (chosen) => chosen.firstChild.textContent);
    const face = place.faces.find((one) => one.part + ":" + one.face === head);
    this.expect(face, `a click on ${what} shows ${place.faces.map((one) => one.part + ":" + one.face).join(" or ")}, not "${head}"`);
    if (!face) return null;
    this.expect(rows.get("surface") === face.surface && rows.get("medium") === face.medium, head + " has its surface and medium");
    this.expect(parseFloat(rows.get("area")) > 0, head + " has its area");
    if (face.stated_at) this.expect(rows.get("stated at") === face.stated_at && /:\d+/.test(face.stated_at), head + " has the line that gave its surface");
    if (face.sensor) this.expect(rows.get("sensor") === face.sensor, head + " has its sensor");
    const ledger = await this.page.evaluate(([part, name, surface, medium]) => {
      const all = window.scintrayView.data.ledger;
      return all && { through: all.faces[part + ":" + name], surface: all.surfaces[surface], medium: all.media[medium],
        tallies: window.scintrayView.data.tallies.length };
    }, [face.part, face.face, face.surface, face.medium]);
    if (ledger) {
      const counted = (title, count) => this.expect(count === undefined || (rows.get(title) || "").startsWith(count + " ("), `${head} has "${title}", ${count}`);
      counted(`run: absorbed at ${face.surface}, all its faces`, ledger.surface);
      counted(`run: absorbed in ${face.medium}, all its parts`, ledger.medium);
      if (ledger.through) {
        counted("run: detected through this face", ledger.through[0]);
        counted("run: not detected through it", ledger.through[1]);
      }
    }
    return { ...place, head, face, ledger };
  }
  async pick_faces() {
    await this.panel(true);
    await this.tick(await this.page.$("#show_paths"), false);
    await this.panel(false);
    const media = await this.page.evaluate(() => window.scintrayView.data.media.map((_, m) => m));
    const any = await this.pick_face(media, false, "a face");
    this.expect(any, "a face can be clicked");
    this.expect(!any || any.face.stated_at, "the face has a rule");
    // Sensors from above, all else hidden.
    const sensors = await this.page.evaluate(() => {
      const { data } = window.scintrayView;
      return data.media.map((_, m) => m).filter((m) => data.parts.some((part) => part.m === m && data.faces[part.l].some((face) => face.d)));
    });
    let sensor = null;
    if (sensors.length) {
      await this.panel(true);
      await this.page.click("[data-look='2']");
      for (const [m, box] of (await this.page.$$("#legend input")).entries()) await this.tick(box, sensors.includes(m));
      await this.panel(false);
      await this.seen("rest");
      sensor = await this.pick_face(sensors, true, "a sensor's face");
      this.expect(sensor, "a sensor's face can be clicked");
      if (sensor && sensor.ledger) this.expect(sensor.ledger.through, sensor.head + " is one that the run counted at");
      await this.panel(true);
      for (const box of await this.page.$$("#legend input")) await this.tick(box, true);
      await this.page.click("[data-look='3']");
      await this.panel(false);
    }
    return [any, sensor].filter(Boolean).map((one) => one.head);
  }

  // Hiding, opacity, edges, cutting and moving apart: of the parts alone.
  async change_parts() {
    await this.panel(true);
    await this.seen("rest");
    await this.seen("keep", "whole");
    const whole = await this.seen("drawn"), boxes = await this.page.$$("#legend input");
    this.expect(whole.count > 1000, "the parts are drawn: " + whole.count + " points");
    for (const [i, box] of boxes.entries()) {
      await this.tick(box, false);
      if (i === 0) {
        await this.seen("rest");
        this.expect(await this.seen("changed", "whole") > 100, "hiding a medium changes the picture");
      }
    }
    await this.seen("rest");
    const marks = await this.page.evaluate(() => window.scintrayView.data.marks.length);
    if (!marks) this.expect((await this.seen("drawn")).count === 0, "nothing is drawn where all media are hidden");
    for (const box of boxes) await this.tick(box, true);
    await this.seen("rest");
    this.expect(await this.seen("changed", "whole") <= FEW_POINTS, "parts that are shown again look as before");

    for (const [id, value, back] of [["opacity", "0.9", await this.page.$eval("#opacity", (field) => field.value)], ["apart", "1", "0"]]) {
      await this.set(id, value);
      this.expect(await this.seen("changed", "whole") > 100, id + " changes the picture");
      if (id === "apart") {
        const apart = await this.seen("drawn");
        const parts = await this.page.evaluate(() => window.scintrayView.data.parts.length);
        this.expect(parts < 2 || apart.wide > 1.1 * whole.wide || apart.tall > 1.1 * whole.tall, "parts move apart");
      }
      await this.set(id, back);
      this.expect(await this.seen("changed", "whole") <= FEW_POINTS, id + " goes back");
    }
    await this.tick(await this.page.$("#edges"), false);
    await this.seen("rest");
    this.expect(await this.seen("changed", "whole") > 100, "edges can be hidden");
    await this.tick(await this.page.$("#edges"), true);

    for (const axis of ["x", "y", "z"]) {
      await this.page.selectOption("#axis", axis);
      await this.set("cut", "0.5");
      this.expect(await this.seen("changed", "whole") > 100, "a plane across " + axis + " cuts");
      this.expect((await this.page.$eval("#cut_mm", (out) => out.textContent)).startsWith(axis + " = "), "the plane's place is shown");
      await this.seen("keep", "half");
      await this.tick(await this.page.$("#flip"), true);
      await this.seen("rest");
      this.expect(await this.seen("changed", "half") > 100, "the other side is shown");
      await this.tick(await this.page.$("#flip"), false);
      await this.set("cut", "0");
      if (!marks) this.expect((await this.seen("drawn")).count < 0.25 * whole.count, "a plane at the begin of " + axis + " leaves nothing but its edge");
    }
    await this.page.selectOption("#axis", "");
    await this.seen("rest");
    this.expect(await this.seen("changed", "whole") <= FEW_POINTS, "without the plane all is there again");
    await this.panel(false);
  }

  // Colours of paths by fate, wavelength and time, with their legends; paths up to a time.
  async change_paths() {
    await this.panel(true);
    await this.seen("rest");
    await this.seen("keep", "without");
    await this.tick(await this.page.$("#show_paths"), true);
    await this.seen("rest");
    this.expect(await this.seen("changed", "without") > 50, "paths are drawn");
    const legends = {};
    let before = null;
    for (const by of ["fate", "wavelength", "time"]) {
      await this.page.selectOption("#path_colour", by);
      await this.seen("rest");
      if (before) this.expect(await this.seen("changed", before) > 50, `colours of paths by ${by} differ from those by ${before}`);
      await this.seen("keep", by);
      before = by;
      legends[by] = await this.page.$eval("#path_scale", (scale) => scale.hidden ? "" : scale.textContent);
    }
    this.expect(await this.seen("changed", "fate") > 50, "colours of paths by time differ from those by fate");
    this.expect(legends.fate === "" && /^\d+ nm\d+ nm$/.test(legends.wavelength) && /^0[\d.e+]+ ns$/.test(legends.time),
      "each colouring of paths has its legend: " + JSON.stringify(legends));
    await this.page.selectOption("#path_colour", "fate");
    await this.seen("rest");
    const fates = await this.page.$$eval("#fates label", (rows) => rows.map((row) => +row.lastChild.textContent));
    this.expect(fates.reduce((sum, count) => sum + count, 0) === await this.page.evaluate(() => window.scintrayView.paths),
      "the fates in the legend add up to the paths");
    await this.set("time", "0.1");
    const early = await this.seen("changed", "without");
    this.expect(await this.seen("changed", "fate") > 50, "paths up to a time are fewer");
    await this.set("time", "0");
    this.expect(await this.seen("changed", "without") <= Math.max(FEW_POINTS, 0.2 * early), "at time 0 no path is drawn");
    await this.set("time", "1");
    await this.panel(false);
  }

  // Findings of check: listed, red at their places; a click on one looks at it.
  async findings() {
    const marks = await this.page.evaluate(() => window.scintrayView.data.marks);
    const listed = await this.page.$$eval("#marks li", (items) => items.map((item) => item.textContent));
    this.expect(listed.length === marks.length && marks.every((mark, i) => listed[i] === mark.t), "every finding is listed");
    this.expect(await this.page.$eval("#findings", (set) => set.hidden) === !marks.length, "findings are shown where there are some");
    for (const [i, mark] of marks.entries()) {
      await this.panel(true);
      const button = (await this.page.$$("#marks button"))[i];
      await button.scrollIntoViewIfNeeded();
      await button.click();
      await this.panel(false);
      await this.seen("rest");
      const [x, y] = await this.seen("on_screen", mark.p[0]), box = await (await this.page.$("#scene")).boundingBox();
      const panel = await this.page.$eval("#panel", (one) => { const r = one.getBoundingClientRect(); return [r.width, r.height]; });
      const narrow = panel[0] >= box.width, middle = [box.x + (box.width - (narrow ? 0 : panel[0])) / 2, box.y + (box.height - (narrow ? panel[1] : 0)) / 2];
      this.expect(Math.hypot(x - middle[0], y - middle[1]) < 3, `a click on finding ${i + 1} brings it into the middle`);
      this.expect(await this.seen("red_near", x, y, 6) > 20, `finding ${i + 1} is marked at its place`);
      this.expect(await this.seen("red_near", x, y - 18, 16) > 40, `finding ${i + 1} has its number`);
    }
    await this.panel(true);
    await this.page.click("[data-look='3']");
    await this.panel(false);
    return marks.length;
  }

  // Parts coloured by surface and by every tally; the number of tallies.
  async tallies() {
    const painted = await this.page.$$eval("#colour option", (options) => options.map((o) => o.value));
    await this.panel(true);
    await this.seen("keep", "medium");
    for (const value of painted) {
      await this.page.selectOption("#colour", value);
      await this.seen("rest");
      const legend = await this.page.$eval("#legend", (one) => one.textContent);
      if (value.startsWith("tally:")) this.expect(/per mm2/.test(legend), "a tally is painted: " + value);
      if (value !== painted[0]) this.expect(await this.seen("changed", "medium") > 0, "parts are coloured by " + value);
    }
    await this.page.selectOption("#colour", painted[0]);
    await this.panel(false);
    return painted.filter((value) => value.startsWith("tally:")).length;
  }

  // The picture has as many points as the window has room for, also when it changes.
  async follow_window() {
    const window_size = this.page.viewportSize();
    for (const width of [window_size.width - 60, window_size.width]) {
      await this.page.setViewportSize({ ...window_size, width });
      await this.page.waitForTimeout(100);
      await this.seen("rest");
      const [points, room] = await this.page.$eval("#scene", (canvas) => [canvas.width, canvas.clientWidth * Math.min(2, devicePixelRatio)]);
      this.expect(Math.abs(points - room) <= 1, `the picture is ${room} points wide, not ${points}`);
    }
  }

  // Frames a second while photons are played, and while the scene turns.
  async rates(plays) {
    await this.panel(true);
    await this.tick(await this.page.$("#show_paths"), true);
    await this.panel(false);
    await this.seen("rest");
    return this.page.evaluate(async (plays) => {
      const view = window.scintrayView, counts = view.counts;
      const during = async (work, ms) => {
        const frames = counts.frames, begin = performance.now();
        await new Promise((done) => {
          const tick = () => { work(); performance.now() - begin < ms ? requestAnimationFrame(tick) : done(); };
          requestAnimationFrame(tick);
        });
        return 1000 * (counts.frames - frames) / (performance.now() - begin);
      };
      let played = null;
      if (plays) {
        const play = document.getElementById("play"), time = document.getElementById("time");
        play.click();
        await during(() => {}, 300);
        const increments = counts.increments, at = +time.value;
        played = await during(() => {}, 2000);
        if (counts.increments === increments || +time.value <= at) played = 0;
        play.click();
      }
      return { played, turned: await during(() => view.turn([0.2, 0], 1), 2500) };
    }, plays);
  }
}

// All of it. Returns what was counted, or null for a page without a scene.
async function scene(page, expect) {
  const seconds = await open_scene(page);
  if (seconds === null) return null;
  await page.evaluate(in_page);
  const one = new Scene(page, expect);
  await one.seen("rest");
  const paths = await page.evaluate(() => window.scintrayView.paths), result = { seconds, paths };
  if (paths) {
    result.steps = await one.pick_path();
    expect(result.steps > 0, "a path lies where it can be clicked");
  }
  result.faces = await one.pick_faces();
  await one.change_parts();
  if (paths) await one.change_paths();
  result.findings = await one.findings();
  result.painted = await one.tallies();
  Object.assign(result, await one.rates(paths > 0));
  if (paths) expect(result.played > 0, "playing draws what is new");
  expect(result.turned > 0, "turning draws");
  await one.set("time", "1");
  await one.follow_window();
  return result;
}

module.exports = { open_scene, scene };
