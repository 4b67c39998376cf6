// A scene in three dimensions: parts, paths of photons, findings of check. Data are of view_data.cpp. On a page of its own
// it begins at once; within a report by the button .view-open, so that the report does not wait for it.
(function () {
  "use strict";
  const element = (id) => document.getElementById(id);
  const host = element("view"), within = host.classList.contains("within"), open = host.querySelector(".view-open");
  if (open) open.addEventListener("click", () => { host.classList.add("open"); start(); element("scene").focus(); }, { once: true });
  else start();

  function start() {
  const data = JSON.parse(element("data").textContent);
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const dark = matchMedia("(prefers-color-scheme: dark)");

  // Distinguishable for all kinds of colour vision (Okabe and Ito 2008).
  const FATE_COLOURS = ["#009e73", "#e69f00", "#0072b2", "#d55e00", "#cc79a7", "#56b4e9", "#8a8a8a"];
  const FATES = ["detected", "not detected", "absorbed in medium", "absorbed at surface", "escaped", "cut interactions", "cut time"];

  let renderer, frames = 0;
  try {
    renderer = new THREE.WebGLRenderer({ canvas: element("scene"), antialias: true });
  } catch (error) {
    element("failure").hidden = false;
    element("failure").textContent = "This browser draws no WebGL, which the picture is made with: " + error.message;
    return;
  }
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  const space = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(35, 1, 1, 10);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, element("scene"));
  controls.enableKeys = false;  // arrow keys turn, below
  const cut = new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0);
  let drawn = false;
  const redraw = () => { drawn = false; };

  // Shapes, unpacked once; coordinates of parts are relative to the middle of the scene. Numbers are integers of one, two or
  // four bytes; those of coordinates are shares of 65535 of a box.
  const integers = (text, width) => new ({ 1: Uint8Array, 2: Uint16Array, 4: Uint32Array })[width](bytes(text));
  const unpacked = (text, box, made) => {
    const shares = new Uint16Array(bytes(text)), values = new made(shares.length);
    for (let i = 0; i < shares.length; ++i) values[i] = box[i % 3] + (box[3 + i % 3] - box[i % 3]) * shares[i] / 65535;
    return values;
  };
  const shapes = data.shapes.map((shape) => ({
    v: unpacked(shape.v, shape.b, Float32Array), t: integers(shape.t, shape.tw), f: integers(shape.f, shape.fw),
  }));
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const part of data.parts) {
    const v = shapes[part.s].v;
    for (let i = 0; i < v.length; ++i) {
      const x = v[i] + part.o[i % 3];
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    }
  }
  if (low[0] > high[0]) { low.fill(-1); high.fill(1); }
  const middle = low.map((x, i) => 0.5 * (x + high[i]));
  const size = Math.max(1e-6, Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]));

  // One geometry for the parts of a medium, without shared corners: every triangle has its own colour.
  function rgb(text) { const c = new THREE.Color(text); return [c.r, c.g, c.b]; }
  const mediumColours = data.media.map((m) => rgb(m.c)), surfaceColours = data.surfaces.map((s) => rgb(s.c));
  const groups = data.media.map((medium, m) => {
    const parts = data.parts.filter((part) => part.m === m);
    let triangles = 0;
    for (const part of parts) triangles += shapes[part.s].t.length / 3;
    const group = { parts, first: [], triangles, medium };
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(9 * triangles), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(9 * triangles), 3));
    let at = 0;
    for (const part of parts) { group.first.push(at); at += shapes[part.s].t.length / 3; }
    const material = new THREE.MeshLambertMaterial({
      vertexColors: THREE.VertexColors, side: THREE.DoubleSide, transparent: true, depthWrite: false, flatShading: true,
      clippingPlanes: [],
    });
    group.mesh = new THREE.Mesh(geometry, material);
    group.edges = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({
      transparent: true, opacity: 0.55, clippingPlanes: [],
    }));
    space.add(group.mesh, group.edges);
    return group;
  });

  const shapeEdges = new Map();
  function edgesOf(index) {
    if (!shapeEdges.has(index)) {
      const shape = shapes[index], geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(shape.v, 3));
      geometry.setIndex(new THREE.BufferAttribute(shape.t, 1));
      shapeEdges.set(index, new THREE.EdgesGeometry(geometry, 20).attributes.position.array);
    }
    return shapeEdges.get(index);
  }
  function offsetOf(part, apart) {
    const v = shapes[part.s].v, centre = [0, 0, 0];
    if (!part.c) {
      for (let i = 0; i < v.length; ++i) centre[i % 3] += 3 * v[i] / v.length;
      part.c = centre.map((x, i) => x + part.o[i] - middle[i]);
    }
    return part.o.map((x, i) => x - middle[i] + apart * part.c[i]);
  }
  function place() {
    const apart = +element("apart").value;
    for (const group of groups) {
      const position = group.mesh.geometry.attributes.position.array;
      let at = 0, lines = 0;
      for (const part of group.parts) lines += edgesOf(part.s).length;
      const edges = new Float32Array(lines);
      lines = 0;
      for (const part of group.parts) {
        const shape = shapes[part.s], o = offsetOf(part, apart);
        for (let i = 0; i < shape.t.length; ++i)
          for (let k = 0; k < 3; ++k) position[at++] = shape.v[3 * shape.t[i] + k] + o[k];
        const e = edgesOf(part.s);
        for (let i = 0; i < e.length; ++i) edges[lines++] = e[i] + o[i % 3];
      }
      group.mesh.geometry.attributes.position.needsUpdate = true;
      group.mesh.geometry.computeBoundingSphere();
      group.mesh.geometry.computeVertexNormals();
      group.edges.geometry.setAttribute("position", new THREE.BufferAttribute(edges, 3));
      group.edges.geometry.computeBoundingSphere();
    }
    redraw();
  }
  function surfaceOf(part, triangle) {
    return data.faces[part.l][shapes[part.s].f[triangle]];
  }
  function paint() {
    const bySurface = element("colour").value === "surface";
    groups.forEach((group, m) => {
      const colours = group.mesh.geometry.attributes.color.array;
      let at = 0;
      for (const part of group.parts)
        for (let t = 0; t < shapes[part.s].t.length / 3; ++t) {
          const face = bySurface ? surfaceOf(part, t) : null;
          const c = bySurface ? (face ? surfaceColours[face.s] : [0.6, 0.6, 0.6]) : mediumColours[m];
          for (let k = 0; k < 9; ++k) colours[at++] = c[k % 3];
        }
      group.mesh.geometry.attributes.color.needsUpdate = true;
      group.edges.material.color.set(bySurface ? (dark.matches ? "#aab4bd" : "#55606a") : group.medium.c);
    });
    legend();
    redraw();
  }
  function row(colour, name, count, checked, changed) {
    const label = document.createElement("label");
    if (changed) {
      const box = document.createElement("input");
      box.type = "checkbox";
      box.checked = checked;
      box.addEventListener("change", () => { changed(box.checked); redraw(); });
      label.append(box);
    }
    for (const [text, style] of [["", colour], [name, ""], [count, ""]]) {
      const span = document.createElement("span");
      span.textContent = text;
      if (style) { span.className = "swatch"; span.style.background = style; }
      label.append(span);
    }
    return label;
  }
  function legend() {
    const list = element("legend"), bySurface = element("colour").value === "surface";
    list.textContent = "";
    if (bySurface) {
      data.surfaces.forEach((surface) => list.append(row(surface.c, surface.n, "", true, null)));
      return;
    }
    groups.forEach((group) => list.append(row(group.medium.c, group.medium.n,
      group.parts.length === 1 ? "1 part" : group.parts.length + " parts", group.mesh.visible,
      (on) => { group.mesh.visible = on; group.edges.visible = on && element("edges").checked; })));
  }

  // Paths: line segments with the time and the fate of their ends; the later ones are not drawn.
  const steps = { p: unpacked(data.steps.p, data.steps.b, Float64Array), t: integers(data.steps.t, 2),
    e: integers(data.steps.e, data.steps.ew) };
  const finest = Math.max(...[0, 1, 2].map((k) => data.steps.b[3 + k] - data.steps.b[k])) / 131070;
  const decimals = Math.max(0, Math.min(3, Math.floor(-Math.log10(Math.max(finest, 1e-9)))));
  let first = 0;
  const paths = data.paths.map((path) => {
    const made = { n: path.n, fate: data.fates[path.f], p: steps.p.subarray(3 * first, 3 * (first + path.k)),
      v: new Float32Array(2 * path.k), e: steps.e.subarray(first, first + path.k) };
    let nm = 0, change = 0;
    for (let i = 0; i < path.k; ++i) {
      if (change < path.w.length && path.w[change][0] === i) nm = path.w[change++][1];
      made.v[2 * i] = path.t[0] + (path.t[1] - path.t[0]) * steps.t[first + i] / 65535;
      made.v[2 * i + 1] = nm;
    }
    first += path.k;
    return made;
  });
  const shown = Object.fromEntries(data.fates.map((fate) => [fate, true]));
  let lastTime = 0, lowNm = Infinity, highNm = -Infinity;
  for (const path of paths)
    for (let i = 0; i < path.e.length; ++i) {
      lastTime = Math.max(lastTime, path.v[2 * i]);
      lowNm = Math.min(lowNm, path.v[2 * i + 1]);
      highNm = Math.max(highNm, path.v[2 * i + 1]);
    }
  const timed = new THREE.ShaderMaterial({
    uniforms: { now: { value: 1e30 }, opacity: { value: 1 } }, depthWrite: false, vertexColors: THREE.VertexColors, clipping: true, clippingPlanes: [],
    vertexShader: "attribute float time; varying float at; varying vec3 c;\n#include <clipping_planes_pars_vertex>\n" +
      "void main() {\n#include <begin_vertex>\n#include <project_vertex>\n#include <clipping_planes_vertex>\nat = time; c = color; }",
    fragmentShader: "uniform float now; uniform float opacity; varying float at; varying vec3 c;\n#include <clipping_planes_pars_fragment>\n" +
      "void main() {\n#include <clipping_planes_fragment>\nif (at > now) discard; gl_FragColor = vec4(c, opacity); }",
  });
  timed.transparent = true;  // drawn after the walls
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), timed);
  lines.frustumCulled = false;
  lines.renderOrder = 1;
  const chosen = new THREE.Line(new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ depthTest: false, transparent: true }));
  chosen.frustumCulled = chosen.visible = false;
  chosen.renderOrder = 2;
  space.add(lines, chosen);
  let pathOf = [];
  // Violet to red between the shortest and the longest wavelength, or time.
  function scale(share) { return rgb("hsl(" + Math.round(270 * (1 - share)) + ", 85%, 50%)"); }
  function pathColour(path, i, by) {
    if (by === "fate") return rgb(FATE_COLOURS[Math.max(0, FATES.indexOf(path.fate))]);
    if (by === "wavelength") return scale(highNm > lowNm ? (path.v[2 * i + 1] - lowNm) / (highNm - lowNm) : 0.5);
    return scale(lastTime > 0 ? path.v[2 * i] / lastTime : 0);
  }
  function path_legend(by) {
    const ends = by === "wavelength" ? [Math.round(lowNm) + " nm", Math.round(highNm) + " nm"] : ["0", lastTime.toPrecision(3) + " ns"];
    element("path_scale").hidden = by === "fate";
    element("path_scale").querySelectorAll("span").forEach((span, i) => { span.textContent = ends[i]; });
  }
  function draw_paths() {
    path_legend(element("path_colour").value);
    const by = element("path_colour").value, position = [], colour = [], time = [];
    pathOf = [];
    paths.forEach((path, number) => {
      if (!shown[path.fate]) return;
      for (let i = 0; i + 1 < path.e.length; ++i) {
        pathOf.push(number);
        for (const j of [i, i + 1]) {
          for (let k = 0; k < 3; ++k) position.push(path.p[3 * j + k] - middle[k]);
          colour.push(...pathColour(path, i, by));
          time.push(path.v[2 * j]);
        }
      }
    });
    // Where many lie over each other, each is fainter.
    timed.uniforms.opacity.value = Math.max(0.3, Math.min(1, Math.sqrt(4000 / Math.max(1, pathOf.length))));
    lines.geometry.dispose();
    lines.geometry = new THREE.BufferGeometry();
    for (const [name, values, items] of [["position", position, 3], ["color", colour, 3], ["time", time, 1]])
      lines.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(values), items));
    lines.geometry.computeBoundingSphere();
    redraw();
  }
  function set_time() {
    const share = +element("time").value;
    timed.uniforms.now.value = share >= 1 ? 1e30 : share * lastTime;
    element("time_ns").textContent = (share * lastTime).toPrecision(3) + " ns";
    redraw();
  }

  // Findings: rings are drawn over everything.
  const marks = [];
  data.marks.forEach((mark) => mark.p.forEach((p) => {
    const ball = new THREE.Mesh(new THREE.SphereBufferGeometry(0.008 * size, 12, 8),
      new THREE.MeshBasicMaterial({ color: "#d0021b", depthTest: false, transparent: true, opacity: 0.8 }));
    ball.position.set(p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]);
    ball.renderOrder = 2;
    marks.push(ball);
    space.add(ball);
  }));
  element("findings").hidden = data.marks.length === 0;
  data.marks.forEach((mark) => {
    const item = document.createElement("li"), button = document.createElement("button");
    button.type = "button";
    button.textContent = mark.t;
    button.addEventListener("click", () => {
      if (!mark.p.length) return;
      controls.target.set(...mark.p[0].map((x, i) => x - middle[i]));
      camera.position.copy(controls.target).add(new THREE.Vector3(0.2, -0.25, 0.15).multiplyScalar(size));
      controls.update();
    });
    item.append(button);
    element("marks").append(item);
  });

  // Picking.
  const ray = new THREE.Raycaster();
  function table(heads, rows) {
    const made = document.createElement("table"), head = heads.length ? made.createTHead().insertRow() : null;
    for (const text of heads) { const th = document.createElement("th"); th.textContent = text; head.append(th); }
    const body = made.createTBody();
    for (const cells of rows) {
      const line = body.insertRow();
      for (const text of cells) {
        const cell = line.insertCell();
        cell.textContent = text;
        if (typeof text === "number" || /^-?[\d.]+$/.test(text)) cell.className = "n";
      }
    }
    return made;
  }
  function show(title, heads, rows) {
    const head = document.createElement(within ? "h3" : "h2");
    head.textContent = title;
    element("chosen").replaceChildren(head, table(heads, rows));
    if (host.classList.contains("folded")) element("menu").click();
    element("panel").scrollTop = element("chosen").offsetTop - 8;
  }
  function show_path(path) {
    chosen.geometry.dispose();
    chosen.geometry = new THREE.BufferGeometry();
    chosen.geometry.setAttribute("position",
      new THREE.BufferAttribute(Float32Array.from(path.p, (x, i) => x - middle[i % 3]), 3));
    chosen.material.color.set(dark.matches ? "#ffffff" : "#000000");
    chosen.visible = lines.visible;
    redraw();
    const rows = [];
    for (let i = 0; i < path.e.length; ++i)
      rows.push([i, data.events[path.e[i]], path.v[2 * i].toFixed(3), path.v[2 * i + 1].toFixed(1),
        ...[0, 1, 2].map((k) => path.p[3 * i + k].toFixed(decimals))]);
    show(path.n + ": " + path.fate, ["step", "event", "ns", "nm", "x mm", "y mm", "z mm"], rows);
  }
  // What the whole run counted there.
  function ledger_rows(part, face, at) {
    const ledger = data.ledger, rows = [];
    if (!ledger) return rows;
    const share = (count) => count + " (" + (100 * count / ledger.n).toPrecision(3) + " %)";
    const add = (title, count) => { if (count !== undefined) rows.push([title, share(count)]); };
    const through = ledger.faces[at], all = ledger.parts[part.n], medium = data.media[part.m].n, surface = face ? data.surfaces[face.s].n : "";
    if (through) { add("run: detected through this face", through[0]); add("run: not detected through it", through[1]); }
    if (all) { add("run: detected by this part", all[0]); add("run: not detected by it", all[1]); }
    add("run: absorbed at " + surface + ", all its faces", ledger.surfaces[surface]);
    add("run: absorbed in " + medium + ", all its parts", ledger.media[medium]);
    return rows;
  }
  function show_face(part, triangle) {
    chosen.visible = false;
    redraw();
    const face = surfaceOf(part, triangle), shape = shapes[part.s], number = shape.f[triangle];
    let area = 0;
    const corner = (t, k) => new THREE.Vector3().fromArray(shape.v, 3 * shape.t[3 * t + k]);
    for (let t = 0; t < shape.t.length / 3; ++t)
      if (shape.f[t] === number)
        area += 0.5 * corner(t, 1).sub(corner(t, 0)).cross(corner(t, 2).sub(corner(t, 0))).length();
    const at = part.n + ":" + (face ? face.n : "");
    const rows = [["medium", data.media[part.m].n], ["face", face ? face.n : "-"],
      ["surface", face ? data.surfaces[face.s].n : "-"], ["area", area.toPrecision(5) + " mm2"]];
    if (face && face.w) rows.push(["stated at", face.w]);
    if (face && face.d) rows.push(["sensor", face.d]);
    ledger_rows(part, face, at).forEach((entry) => rows.push(entry));
    for (const [verb, title] of [["detected by " + part.n, "paths detected here"], ["not detected by " + part.n, "paths not detected here"],
      ["reflected at " + part.n + " |", "reflections at this part, as seen from inside"], ["into " + part.n, "entries into this part"]]) {
      let count = 0;
      for (const path of paths) for (const e of path.e) if (data.events[e].startsWith(verb)) ++count;
      if (count > 0) rows.push([title, count]);
    }
    show(at, [], rows);
  }
  function pick(event) {
    const box = element("scene").getBoundingClientRect();
    ray.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1,
      1 - 2 * (event.clientY - box.top) / box.height), camera);
    const side = (hit) => element("axis").value === "" || cut.distanceToPoint(hit.point) >= 0;
    ray.params.Line = { threshold: 0.004 * camera.position.distanceTo(controls.target) };
    const line = lines.visible && pathOf.length ? ray.intersectObject(lines).filter(side)
      .filter((hit) => lines.geometry.attributes.time.array[hit.index] <= timed.uniforms.now.value)[0] : null;
    if (line) return show_path(paths[pathOf[Math.floor(line.index / 2)]]);
    const hits = [];
    for (const group of groups)
      if (group.mesh.visible)
        for (const hit of ray.intersectObject(group.mesh)) if (side(hit)) hits.push([hit, group]);
    if (!hits.length) return;
    hits.sort((a, b) => a[0].distance - b[0].distance);
    const [hit, group] = hits[0];
    let number = 0;
    while (number + 1 < group.first.length && group.first[number + 1] <= hit.faceIndex) ++number;
    show_face(group.parts[number], hit.faceIndex - group.first[number]);
  }
  let down = null;
  element("scene").addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  element("scene").addEventListener("pointerup", (event) => {
    if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5) pick(event);
  });

  // Cut plane, camera, panel.
  function set_cut() {
    const axis = "xyz".indexOf(element("axis").value || "?"), planes = axis < 0 ? [] : [cut];
    const share = +element("cut").value;
    if (axis >= 0) {
      const sign = element("flip").checked ? 1 : -1, place = low[axis] + share * (high[axis] - low[axis]);
      cut.normal.set(0, 0, 0).setComponent(axis, sign);
      cut.constant = -sign * (place - middle[axis]);
      element("cut_mm").textContent = element("axis").value + " = " + Math.round(1e4 * place) / 1e4 + " mm";
    } else {
      element("cut_mm").textContent = "";
    }
    renderer.localClippingEnabled = axis >= 0;
    for (const group of groups) {
      group.mesh.material.clippingPlanes = planes;
      group.edges.material.clippingPlanes = planes;
    }
    timed.clippingPlanes = planes;
    for (const material of [timed, ...groups.map((g) => g.mesh.material), ...groups.map((g) => g.edges.material)])
      material.needsUpdate = true;
    redraw();
  }
  const LOOKS = [[0, -1, 0.001], [1, 0, 0.001], [0, -0.001, 1], [0.7, -1, 0.6]];
  function look(number) {
    controls.target.set(0, 0, 0);
    camera.position.set(...LOOKS[number]).normalize().multiplyScalar(1.9 * size * Math.max(1, 0.9 / camera.aspect));
    controls.update();
    redraw();
  }
  function resize() {
    const wide = host.clientWidth, tall = host.clientHeight;
    if (!wide || !tall) return;
    host.classList.toggle("narrow", wide < 720);
    const folded = host.classList.contains("folded"), panel = element("panel").getBoundingClientRect();
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    renderer.setSize(wide, tall, false);
    camera.aspect = wide / tall;
    // The middle of what the panel leaves free.
    if (folded) camera.clearViewOffset();
    else if (panel.width < wide) camera.setViewOffset(wide, tall, panel.width / 2, 0, wide, tall);
    else camera.setViewOffset(wide, tall, 0, panel.height / 2, wide, tall);
    camera.near = 0.002 * size;
    camera.far = 40 * size;
    camera.updateProjectionMatrix();
    redraw();
  }
  function lights() {
    renderer.setClearColor(dark.matches ? 0x14181c : 0xffffff);
    redraw();
  }
  space.add(new THREE.HemisphereLight(0xffffff, 0x8a8f95, 0.9));
  const lamp = new THREE.DirectionalLight(0xffffff, 0.35);
  space.add(lamp);

  const on = (id, kind, act) => element(id).addEventListener(kind, act);
  on("colour", "change", paint);
  on("opacity", "input", () => { groups.forEach((g) => { opaque(g); }); redraw(); });
  on("edges", "change", () => { groups.forEach((g) => { g.edges.visible = element("edges").checked && g.mesh.visible; }); redraw(); });
  on("apart", "input", () => {
    lines.visible = +element("apart").value === 0;
    chosen.visible = chosen.visible && lines.visible;
    place();
  });
  for (const id of ["axis", "flip"]) on(id, "change", set_cut);
  on("cut", "input", set_cut);
  on("path_colour", "change", draw_paths);
  on("time", "input", set_time);
  let playing = false, before = 0;
  on("play", "click", () => {
    playing = !playing;
    element("play").textContent = playing ? "stop" : "play";
    if (playing && +element("time").value >= 1) element("time").value = 0;
    before = performance.now();
  });
  on("menu", "click", () => {
    const folded = host.classList.toggle("folded");
    element("menu").setAttribute("aria-expanded", String(!folded));
    resize();
  });
  document.querySelectorAll("[data-look]").forEach((button) =>
    button.addEventListener("click", () => look(+button.dataset.look)));
  function opaque(group) {
    const opacity = +element("opacity").value;
    group.mesh.material.opacity = opacity;
    group.mesh.material.depthWrite = opacity > 0.95;
  }
  controls.addEventListener("change", redraw);
  dark.addEventListener("change", () => { lights(); paint(); });
  new ResizeObserver(resize).observe(host);
  // Within a page the wheel scrolls the page until the scene is clicked or has the keyboard.
  const canvas = element("scene"), zooms = () => { controls.enableZoom = !within || document.activeElement === canvas; };
  canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  for (const kind of ["focus", "blur"]) canvas.addEventListener(kind, zooms);
  zooms();
  canvas.addEventListener("keydown", (event) => {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const zoom = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 }[event.key];
    if (!turn && !zoom || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    const way = new THREE.Spherical(), from = camera.position.clone().sub(controls.target);
    way.setFromVector3(new THREE.Vector3(from.x, from.z, -from.y));  // its axis is y, ours is z
    if (turn) {
      way.theta += 0.1 * turn[0];
      way.phi = Math.max(0.01, Math.min(Math.PI - 0.01, way.phi + 0.1 * turn[1]));
    }
    if (zoom) way.radius *= zoom;
    const to = new THREE.Vector3().setFromSpherical(way);
    camera.position.copy(controls.target).add(new THREE.Vector3(to.x, -to.z, to.y));
    controls.update();
    redraw();
  });
  element("full").hidden = !within || !document.fullscreenEnabled;
  on("full", "click", () => { document.fullscreenElement ? document.exitFullscreen() : host.requestFullscreen(); });

  const number_text = (x) => String(+x.toPrecision(4));
  const triangles = groups.reduce((sum, group) => sum + group.triangles, 0);
  element("counts").textContent = data.parts.length + " parts, " + triangles + " triangles, " + paths.length +
    (data.left_out ? " of " + (paths.length + data.left_out) : "") + " photon paths; " + low.map((x, i) => "xyz"[i] + " " + number_text(x) + " to " + number_text(high[i])).join(", ") + " mm";
  element("paths").hidden = paths.length === 0;
  data.fates.forEach((fate) => element("fates").append(row(FATE_COLOURS[Math.max(0, FATES.indexOf(fate))], fate,
    paths.filter((path) => path.fate === fate).length, true, (is) => { shown[fate] = is; draw_paths(); })));
  // Walls behind walls add up.
  element("opacity").value = Math.max(0.04, Math.min(0.3, 0.6 / Math.sqrt(data.parts.length)));
  groups.forEach(opaque);
  place();
  paint();
  draw_paths();
  set_time();
  lights();
  resize();
  if (host.classList.contains("narrow")) element("menu").click();
  look(3);
  renderer.setAnimationLoop((now) => {
    if (playing) {
      // The whole of it in six seconds.
      element("time").value = Math.min(1, +element("time").value + (now - before) / 6000);
      before = now;
      set_time();
      if (+element("time").value >= 1) element("play").click();
    }
    if (drawn) return;
    drawn = true;
    lamp.position.copy(camera.position);
    renderer.render(space, camera);
    ++frames;
  });
  window.scintrayView = { data, paths: paths.length, show_path: (i) => show_path(paths[i]), pick, get frames() { return frames; } };
  }
})();
