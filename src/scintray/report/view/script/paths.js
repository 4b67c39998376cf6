// Paths of photons: segments in the order of their begin, with the times of their ends, so that playback draws only what
// is new since the last picture.
// Distinguishable for all kinds of colour vision (Okabe and Ito 2008).
const FATE_COLOURS = ["#009e73", "#e69f00", "#0072b2", "#d55e00", "#cc79a7", "#56b4e9", "#8a8a8a"];
const FATES = ["detected", "not detected", "absorbed in medium", "absorbed at surface", "escaped", "cut interactions", "cut time"];
const view_fate_colour = (fate) => FATE_COLOURS[Math.max(0, FATES.indexOf(fate))];
const ALL_TIME = 1e30;

// Lines whose fragments have a time: those after `since`, up to `now`.
function view_timed_material() {
  const material = new THREE.ShaderMaterial({
    uniforms: { since: { value: -ALL_TIME }, now: { value: ALL_TIME }, opacity: { value: 1 } }, depthWrite: false,
    vertexColors: THREE.VertexColors, clipping: true, clippingPlanes: [],
    vertexShader: "attribute float time; varying float at; varying vec3 c;\n#include <clipping_planes_pars_vertex>\n" +
      "void main() {\n#include <begin_vertex>\n#include <project_vertex>\n#include <clipping_planes_vertex>\nat = time; c = color; }",
    fragmentShader: "uniform float since; uniform float now; uniform float opacity; varying float at; varying vec3 c;\n" +
      "#include <clipping_planes_pars_fragment>\n" +
      "void main() {\n#include <clipping_planes_fragment>\nif (at > now || at <= since) discard; gl_FragColor = vec4(c, opacity); }",
  });
  material.transparent = true;  // drawn after the walls
  return material;
}

// The first of the rising numbers that is above a limit.
function view_first_above(numbers, limit) {
  let low = 0, high = numbers.length;
  while (low < high) {
    const half = (low + high) >> 1;
    if (numbers[half] > limit) high = half;
    else low = half + 1;
  }
  return low;
}

function view_path_lines(view, paths) {
  const { element, middle } = view;
  const material = view_timed_material(), lines = new THREE.LineSegments(new THREE.BufferGeometry(), material);
  lines.frustumCulled = false;
  lines.renderOrder = 1;
  const chosen = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ depthTest: false, transparent: true }));
  chosen.frustumCulled = chosen.visible = false;
  chosen.renderOrder = 2;
  // Every so manieth path, for pictures that have to be quick.
  const few = new THREE.LineSegments(new THREE.BufferGeometry(), material), MOST_QUICK = 3000;
  few.frustumCulled = few.visible = false;
  few.renderOrder = 1;
  view.space.add(lines, few, chosen);
  const shown = Object.fromEntries(view.data.fates.map((fate) => [fate, true]));
  let last_ns = 0, low_nm = Infinity, high_nm = -Infinity;
  for (const path of paths)
    for (let i = 0; i < path.e.length; ++i) {
      last_ns = Math.max(last_ns, path.v[2 * i]);
      low_nm = Math.min(low_nm, path.v[2 * i + 1]);
      high_nm = Math.max(high_nm, path.v[2 * i + 1]);
    }
  // Per segment drawn: its path; when it begins; the latest end up to it.
  let path_of = [], begins = [], ends = [];
  let on = true, drawn_ns = -ALL_TIME;  // up to where the picture on the screen has them

  // Violet to red between the shortest and the longest wavelength, or time.
  const hues = new Map();
  function scale(share) {
    const hue = Math.round(270 * (1 - share));
    if (!hues.has(hue)) hues.set(hue, view_rgb("hsl(" + hue + ", 85%, 50%)"));
    return hues.get(hue);
  }
  const fate_colours = Object.fromEntries(view.data.fates.map((fate) => [fate, view_rgb(view_fate_colour(fate))]));
  function colour_of(path, i, by) {
    if (by === "fate") return fate_colours[path.fate];
    if (by === "wavelength") return scale(high_nm > low_nm ? (path.v[2 * i + 1] - low_nm) / (high_nm - low_nm) : 0.5);
    return scale(last_ns > 0 ? path.v[2 * i] / last_ns : 0);
  }
  function legend(by) {
    const words = by === "wavelength" ? [Math.round(low_nm) + " nm", Math.round(high_nm) + " nm"] : ["0", last_ns.toPrecision(3) + " ns"];
    element("path_scale").hidden = by === "fate";
    element("path_scale").querySelectorAll("span").forEach((span, i) => { span.textContent = words[i]; });
  }
  function segments() {
    const list = [];
    paths.forEach((path, number) => {
      if (shown[path.fate]) for (let i = 0; i + 1 < path.e.length; ++i) list.push([path.v[2 * i], number, i]);
    });
    return list.sort((a, b) => a[0] - b[0]);
  }
  function draw() {
    const by = element("path_colour").value, list = segments();
    const position = new Float32Array(6 * list.length), colour = new Float32Array(6 * list.length),
      time = new Float32Array(2 * list.length);
    legend(by);
    path_of = list.map((one) => one[1]);
    begins = list.map((one) => one[0]);
    ends = [];
    let end = -ALL_TIME;
    list.forEach(([, number, i], at) => {
      const path = paths[number], c = colour_of(path, i, by);
      for (const j of [0, 1]) {
        for (let k = 0; k < 3; ++k) position[6 * at + 3 * j + k] = path.p[3 * (i + j) + k] - middle[k];
        colour.set(c, 6 * at + 3 * j);
        time[2 * at + j] = path.v[2 * (i + j)];
      }
      ends.push(end = Math.max(end, path.v[2 * i + 2]));
    });
    // Where many lie over each other, each is fainter.
    material.uniforms.opacity.value = Math.max(0.3, Math.min(1, Math.sqrt(4000 / Math.max(1, list.length))));
    lines.geometry.dispose();
    lines.geometry = new THREE.BufferGeometry();
    for (const [name, values, items] of [["position", position, 3], ["color", colour, 3], ["time", time, 1]])
      lines.geometry.setAttribute(name, new THREE.BufferAttribute(values, items));
    lines.geometry.computeBoundingSphere();
    const every = Math.ceil(list.length / MOST_QUICK), index = [];
    path_of.forEach((number, at) => { if (number % every === 0) index.push(2 * at, 2 * at + 1); });
    few.geometry.dispose();
    few.geometry = new THREE.BufferGeometry();
    for (const name of ["position", "color", "time"]) few.geometry.setAttribute(name, lines.geometry.attributes[name]);
    few.geometry.setIndex(index);
    view.redraw();
  }
  function set_time() {
    const share = +element("time").value, before = material.uniforms.now.value;
    material.uniforms.now.value = share >= 1 ? ALL_TIME : share * last_ns;
    element("time_ns").textContent = (share * last_ns).toPrecision(3) + " ns";
    if (material.uniforms.now.value < before) view.redraw();
  }
  // What a picture has to draw: all, or what came since the last one; for a quick picture, some paths.
  function prepare(all, quick) {
    few.visible = quick && on;
    lines.visible = !quick && on;
    const { since, now } = material.uniforms;
    since.value = all ? -ALL_TIME : drawn_ns;
    const first = all ? 0 : view_first_above(ends, since.value), end = view_first_above(begins, now.value);
    lines.geometry.setDrawRange(2 * first, 2 * Math.max(0, end - first));
    drawn_ns = now.value;
  }
  function hit(ray, side) {
    if (!on || !path_of.length) return null;
    lines.geometry.setDrawRange(0, Infinity);
    const found = ray.intersectObject(lines).filter(side)
      .find((one) => lines.geometry.attributes.time.array[one.index] <= material.uniforms.now.value);
    return found ? paths[path_of[Math.floor(found.index / 2)]] : null;
  }
  function choose(path) {
    chosen.visible = Boolean(path) && on;
    if (path) {
      chosen.geometry.dispose();
      chosen.geometry = new THREE.BufferGeometry();
      chosen.geometry.setAttribute("position",
        new THREE.BufferAttribute(Float32Array.from(path.p, (x, i) => x - middle[i % 3]), 3));
      chosen.material.color.set(view.dark.matches ? "#ffffff" : "#000000");
    }
    view.redraw();
  }
  function show(is_on) {
    on = is_on;
    chosen.visible = chosen.visible && on;
    view.redraw();
  }
  element("paths").hidden = paths.length === 0;
  for (const fate of view.data.fates)
    element("fates").append(view_row(view_fate_colour(fate), fate, paths.filter((path) => path.fate === fate).length, true,
      (on) => { shown[fate] = on; draw(); }));
  return { draw, set_time, prepare, hit, choose, show, lines, material,
    behind: () => on && material.uniforms.now.value > drawn_ns };
}
