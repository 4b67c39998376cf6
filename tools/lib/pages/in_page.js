// What tools/pages_check computes within a page with a scene, independently of the page's own picking: where places of the
// scene are on the screen, what lies under a place of the screen, and which points of the picture differ. Sent to the page
// as text: uses nothing from outside.
"use strict";
module.exports = function () {
  const view = window.scintrayView, canvas = document.getElementById("scene"), kept = {};
  const sub = (a, b) => a.map((x, k) => x - b[k]), dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const BACKGROUND_STEP = 12;  // of 255: smaller differences of colour are those of smoothed edges

  // Of a place in mm: coordinates in the window, px; whether the canvas is what is clicked there.
  function on_screen(mm) {
    const at = new THREE.Vector3(...sub(mm, view.middle)).project(view.camera), box = canvas.getBoundingClientRect();
    return [box.left + 0.5 * (1 + at.x) * box.width, box.top + 0.5 * (1 - at.y) * box.height, at.z];
  }
  const is_free = (x, y) => document.elementFromPoint(x, y) === canvas;

  // The photon number and the place on the screen of a vertex around which no other of the given paths is drawn.
  function lone_vertex(wanted) {
    const CELL = 4, REACH = 4, owner = new Map(), MANY = -1;
    const key = (x, y) => Math.round(x / CELL) + 65536 * Math.round(y / CELL);
    const lines = view.histories.map((path, number) => wanted(path) ? Array.from(path.e, (_, i) =>
      on_screen([0, 1, 2].map((k) => path.p[3 * i + k]))) : null);
    lines.forEach((line, number) => {
      for (let i = 0; line && i + 1 < line.length; ++i) {
        const [a, b] = [line[i], line[i + 1]], steps = 1 + Math.ceil(Math.hypot(b[0] - a[0], b[1] - a[1]) / (0.5 * CELL));
        for (let s = 0; s <= steps; ++s) {
          const at = key(a[0] + s / steps * (b[0] - a[0]), a[1] + s / steps * (b[1] - a[1]));
          owner.set(at, owner.has(at) && owner.get(at) !== number ? MANY : number);
        }
      }
    });
    const alone = (x, y, number) => {
      for (let i = -REACH; i <= REACH; ++i)
        for (let j = -REACH; j <= REACH; ++j) {
          const found = owner.get(key(x + CELL * i, y + CELL * j));
          if (found !== undefined && found !== number) return false;
        }
      return true;
    };
    // Those of many steps first: their histories say more.
    const order = lines.map((_, number) => number).filter((number) => lines[number])
      .sort((a, b) => view.histories[b].e.length - view.histories[a].e.length);
    for (const number of order)
      for (const [x, y] of lines[number].slice(1))
        if (is_free(x, y) && alone(x, y, number)) return { number, x, y };
    return null;
  }
  // What the page is to show of a path: its title, and per step its event.
  function history(number) {
    const path = view.histories[number];
    return { title: path.n + ": " + path.fate, events: Array.from(path.e, (e) => view.data.events[e]) };
  }

  // Faces under a place of the screen, of parts of the given media: those nearest to the camera, all that lie on each other
  // (Möller and Trumbore 1997).
  function faces_at(x, y, media) {
    const box = canvas.getBoundingClientRect();
    const far = new THREE.Vector3(2 * (x - box.left) / box.width - 1, 1 - 2 * (y - box.top) / box.height, 0.5).unproject(view.camera);
    const from = view.camera.position.toArray(), way = far.toArray().map((c, k) => c - from[k]);
    let hits = [];
    for (const part of view.data.parts) {
      if (!media.includes(part.m)) continue;
      const shape = view.shapes[part.s], shift = sub(part.o, view.middle);
      for (let t = 0; t < shape.f.length; ++t) {
        const [a, b, c] = [0, 1, 2].map((k) => [0, 1, 2].map((i) => shape.v[3 * shape.t[3 * t + k] + i] + shift[i]));
        const u = sub(b, a), w = sub(c, a), p = cross(way, w), det = dot(u, p);
        if (Math.abs(det) < 1e-12) continue;
        const s = sub(from, a), q = cross(s, u), along = [dot(s, p) / det, dot(way, q) / det, dot(w, q) / det];
        if (along[0] < 0 || along[1] < 0 || along[0] + along[1] > 1 || along[2] <= 0) continue;
        const face = view.data.faces[part.l][shape.f[t]];
        hits.push({ at: along[2], part: part.n, face: face.n, surface: view.data.surfaces[face.s].n,
          medium: view.data.media[part.m].n, stated_at: face.w, sensor: face.d });
      }
    }
    const nearest = Math.min(...hits.map((hit) => hit.at));
    hits = hits.filter((hit) => hit.at < nearest * (1 + 1e-5));
    return hits;
  }
  // A place of the screen under which the nearest face fulfils a condition, from the middle of the picture outwards.
  function place_of_face(media, only_sensors) {
    const box = canvas.getBoundingClientRect(), places = [];
    for (let i = 1; i < 30; ++i)
      for (let j = 1; j < 30; ++j) places.push([box.left + i / 30 * box.width, box.top + j / 30 * box.height]);
    const far = ([x, y]) => Math.hypot(x - box.left - 0.4 * box.width, y - box.top - 0.45 * box.height);
    places.sort((a, b) => far(a) - far(b));
    for (const [x, y] of places) {
      if (!is_free(x, y)) continue;
      const faces = faces_at(x, y, media);
      if (faces.length && (!only_sensors || faces.every((face) => face.sensor))) return { x, y, faces };
    }
    return null;
  }

  // The picture as it is on the screen.
  function picture() {
    const copy = document.createElement("canvas");
    copy.width = canvas.clientWidth;
    copy.height = canvas.clientHeight;
    const draw = copy.getContext("2d");
    draw.drawImage(canvas, 0, 0, copy.width, copy.height);
    return draw.getImageData(0, 0, copy.width, copy.height);
  }
  const differs = (a, b, i, j) => [0, 1, 2].some((k) => Math.abs(a[i + k] - b[j + k]) > BACKGROUND_STEP);
  function keep(name) { kept[name] = picture(); }
  // Points that differ from a picture that was kept.
  function changed(name) {
    const now = picture(), then = kept[name];
    if (now.width !== then.width || now.height !== then.height) return Infinity;
    let count = 0;
    for (let i = 0; i < now.data.length; i += 4) if (differs(now.data, then.data, i, i)) ++count;
    return count;
  }
  // Points that are not background, and how far they reach, px.
  function drawn() {
    const { data, width } = picture();
    let count = 0, left = Infinity, right = 0, top = Infinity, bottom = 0;
    for (let i = 0; i < data.length; i += 4)
      if (differs(data, data, i, 0)) {
        const x = i / 4 % width, y = Math.floor(i / 4 / width);
        ++count;
        left = Math.min(left, x); right = Math.max(right, x); top = Math.min(top, y); bottom = Math.max(bottom, y);
      }
    return { count, wide: Math.max(0, right - left), tall: Math.max(0, bottom - top) };
  }
  // Points of the red of findings within some px of a place.
  function red_near(x, y, reach) {
    const { data, width, height } = picture(), box = canvas.getBoundingClientRect();
    let count = 0;
    for (let i = -reach; i <= reach; ++i)
      for (let j = -reach; j <= reach; ++j) {
        const px = Math.round(x - box.left) + i, py = Math.round(y - box.top) + j;
        if (px < 0 || py < 0 || px >= width || py >= height) continue;
        const at = 4 * (py * width + px);
        if (data[at] > 140 && data[at + 1] < 90 && data[at + 2] < 90) ++count;
      }
    return count;
  }
  // When nothing has been drawn for a while: the picture is that of a scene at rest.
  async function rest() {
    const QUIET_MS = 320;
    let frames = -1, since = performance.now();
    for (;;) {
      await new Promise((done) => requestAnimationFrame(done));
      const now = performance.now();
      if (view.counts.frames !== frames) { frames = view.counts.frames; since = now; }
      if (now - since > QUIET_MS) return;
    }
  }
  window.scintraySeen = { on_screen, is_free, lone_vertex, history, place_of_face, keep, changed, drawn, red_near, rest };
};
