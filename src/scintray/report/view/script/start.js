// A scene in three dimensions: parts, tallies on faces, paths of photons, findings of check. On a page of its own it begins
// at once; within a report by the button .view-open, so that the report does not wait for it.
const view_element = (id) => document.getElementById(id);

// Whether pictures are drawn by software, without a graphics processor.
function view_by_software(gl) {
  const names = gl.getExtension("WEBGL_debug_renderer_info"), name = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

// Draws a picture without the smoothing of edges that the canvas has: beside the canvas, then copied onto it.
function view_unsmoothed(renderer) {
  const target = new THREE.WebGLRenderTarget(1, 1, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter }),
    copied = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), new THREE.MeshBasicMaterial({ map: target.texture,
      depthTest: false, depthWrite: false })),
    space = new THREE.Scene(), camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1), points = new THREE.Vector2();
  target.texture.generateMipmaps = false;
  space.add(copied);
  return (scene, from) => {
    renderer.getDrawingBufferSize(points);
    target.setSize(points.x, points.y);
    renderer.setRenderTarget(target);
    renderer.render(scene, from);
    renderer.setRenderTarget(null);
    renderer.render(space, camera);
  };
}

// Draws when something has changed: all of it, or, while photons are played, only what came since the last picture, onto
// it. Where pictures take long, as by software, those of a moving camera have some of the paths only, and fewer points.
function view_renderer(view, canvas) {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  const SLOW_MS = 60, REST_MS = 250, COARSEST = 0.35, draw_unsmoothed = view_unsmoothed(renderer);
  let stale = true, moving = false, moved_at = 0, quick = view_by_software(renderer.getContext()), coarse = 1;
  const counts = { frames: 0, increments: 0 };
  const ratio = () => Math.min(window.devicePixelRatio, 2);

  function resize() {
    const wide = view.host.clientWidth, tall = view.host.clientHeight;
    if (!wide || !tall) return;
    view.host.classList.toggle("narrow", wide < 720);
    renderer.setPixelRatio(ratio() * (moving ? coarse : 1));
    renderer.setSize(wide, tall, false);
    view.camera.resize(wide, tall);
    stale = true;
  }
  function move(on) {
    moving = on;
    if (coarse < 1) resize();
    else stale = true;
  }
  // The time that a picture takes, ms: reading a point waits for it.
  const point = new Uint8Array(4);
  function wait_for_picture(begin) {
    const gl = renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, point);
    return performance.now() - begin;
  }
  // After a long picture of a moving camera: less in the next ones; after short ones, more points again, then all.
  function adapt(taken_ms) {
    const before = coarse;
    if (taken_ms > SLOW_MS && quick) coarse = Math.max(COARSEST, 0.9 * coarse * Math.sqrt(SLOW_MS / taken_ms));
    else if (taken_ms > SLOW_MS) quick = true;
    else if (taken_ms < SLOW_MS / 2 && coarse < 1) coarse = Math.min(1, 1.1 * coarse);
    else if (taken_ms < SLOW_MS / 8) quick = false;
    if (coarse !== before) resize();
  }
  function frame(now) {
    view.playback.advance(now);
    if (moving && now - moved_at > REST_MS) move(false);
    if (!stale && !view.paths.behind()) return;
    // What is new is not drawn onto an unsmoothed picture, which has no depths.
    const hurry = moving && quick, all = stale || hurry, begin = performance.now();
    stale = false;
    view.paths.prepare(all, hurry);
    view.parts.fade_edges(hurry ? coarse : 1);
    view.lamp.position.copy(view.camera.camera.position);
    renderer.autoClear = all;
    if (hurry) draw_unsmoothed(view.space, view.camera.camera);
    else renderer.render(all ? view.space : view.increment, view.camera.camera);
    ++counts.frames;
    if (!all) ++counts.increments;
    if (all && moving) adapt(wait_for_picture(begin));
  }
  return { renderer, resize, frame, counts, redraw: () => { stale = true; },
    moved: () => {
      moved_at = performance.now();
      if (!moving) move(true);
      stale = true;
    } };
}

// Time runs through the slider in six seconds.
function view_playback(view) {
  const { element } = view;
  let playing = false, before = 0;
  function toggle() {
    playing = !playing;
    element("play").textContent = playing ? "stop" : "play";
    if (playing && +element("time").value >= 1) element("time").value = 0;
    before = performance.now();
  }
  element("play").addEventListener("click", toggle);
  return { advance: (now) => {
    if (!playing) return;
    element("time").value = Math.min(1, +element("time").value + Math.max(0, now - before) / 6000);
    before = now;
    view.paths.set_time();
    if (+element("time").value >= 1) toggle();
  } };
}

function view_cut(view) {
  const { element, low, high, middle } = view, plane = new THREE.Plane(new THREE.Vector3(-1, 0, 0), 0);
  const axis = () => "xyz".indexOf(element("axis").value || "?");
  const planes = () => axis() < 0 ? [] : [plane];
  function set() {
    const k = axis();
    if (k >= 0) {
      const sign = element("flip").checked ? 1 : -1, at = low[k] + +element("cut").value * (high[k] - low[k]);
      plane.normal.set(0, 0, 0).setComponent(k, sign);
      plane.constant = -sign * (at - middle[k]);
      element("cut_mm").textContent = element("axis").value + " = " + Math.round(1e4 * at) / 1e4 + " mm";
    } else {
      element("cut_mm").textContent = "";
    }
    view.drawing.renderer.localClippingEnabled = k >= 0;
    for (const material of [view.paths.material, ...view.parts.materials, ...view.painted.materials()]) {
      material.clippingPlanes = planes();
      material.needsUpdate = true;
    }
    view.redraw();
  }
  for (const id of ["axis", "flip"]) element(id).addEventListener("change", set);
  element("cut").addEventListener("input", set);
  return { planes, keeps: (hit) => axis() < 0 || plane.distanceToPoint(hit.point) >= 0 };
}

// Colours of parts and their legend.
function view_colours(view) {
  const { element, data } = view, select = element("colour");
  if (data.tallies.length) {
    const group = document.createElement("optgroup");
    group.label = "light of the run";
    data.tallies.forEach((tally, i) => group.append(new Option(tally.n, "tally:" + i)));
    select.append(group);
  }
  function legend() {
    const by = select.value, painted = view.painted.shown();
    element("log_row").hidden = !painted;
    element("legend").replaceChildren(...(painted ? view.painted.legend() : view.parts.legend(by)));
  }
  function paint() {
    view.painted.show(select.value.startsWith("tally:") ? +select.value.slice(6) : null);
    view.parts.paint(select.value);
    legend();
  }
  // Paths would cover what is painted: they are shown again on request.
  select.addEventListener("change", () => {
    element("show_paths").checked = !select.value.startsWith("tally:");
    view.show_paths();
    paint();
  });
  element("tally_log").addEventListener("change", paint);
  return { paint };
}

function view_counts(view, paths) {
  const text = (x) => String(+x.toPrecision(4));
  return view.data.parts.length + " parts, " + view.parts.triangles + " triangles, " + paths.length +
    (view.data.left_out ? " of " + (paths.length + view.data.left_out) : "") + " photon paths; " +
    view.low.map((x, i) => "xyz"[i] + " " + text(x) + " to " + text(view.high[i])).join(", ") + " mm";
}

function view_listen(view, canvas, properties) {
  const { element, host, dark } = view, on = (id, kind, act) => element(id).addEventListener(kind, act);
  on("opacity", "input", () => view.parts.set_opacity(+element("opacity").value));
  on("edges", "change", () => view.parts.show_edges(element("edges").checked));
  on("apart", "input", () => {
    view.show_paths();
    view.parts.place();
    view.painted.place();
  });
  on("show_paths", "change", view.show_paths);
  on("path_colour", "change", view.paths.draw);
  on("time", "input", view.paths.set_time);
  on("menu", "click", () => {
    element("menu").setAttribute("aria-expanded", String(!host.classList.toggle("folded")));
    view.drawing.resize();
  });
  for (const button of document.querySelectorAll("[data-look]"))
    button.addEventListener("click", () => view.camera.look(+button.dataset.look));
  element("full").hidden = !view.within || !document.fullscreenEnabled;
  on("full", "click", () => { document.fullscreenElement ? document.exitFullscreen() : host.requestFullscreen(); });
  const lights = () => { view.drawing.renderer.setClearColor(dark.matches ? 0x14181c : 0xffffff); view.redraw(); };
  dark.addEventListener("change", () => { lights(); view.colours.paint(); });
  lights();
  // What is observed first is the size that the first picture has.
  const size = () => host.clientWidth + " x " + host.clientHeight;
  let drawn_size = size();
  new ResizeObserver(() => {
    if (size() === drawn_size) return;
    drawn_size = size();
    view.drawing.resize();
  }).observe(host);

  const pick = (event) => {
    const ray = view.camera.ray_through(event.clientX, event.clientY), path = view.paths.hit(ray, view.cut.keeps);
    const face = path ? null : view.parts.hit(ray, view.cut.keeps);
    if (path || face) view.paths.choose(path);
    if (path) properties.show_path(path);
    else if (face) properties.show_face(face);
  };
  let down = null;
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5) pick(event);
  });
}

function view_start(host) {
  const data = JSON.parse(view_element("data").textContent), canvas = view_element("scene");
  const shapes = data.shapes.map(view_shape);
  const view = { data, shapes, host, ...view_extent(data.parts, shapes), first_faces: view_first_faces(data),
    element: view_element, within: host.classList.contains("within"), dark: matchMedia("(prefers-color-scheme: dark)"),
    space: new THREE.Scene(), increment: new THREE.Scene(), lamp: new THREE.DirectionalLight(0xffffff, 0.35),
    redraw: () => view.drawing.redraw(), moved: () => view.drawing.moved(), planes: () => view.cut.planes(),
    look_at: (place) => view.camera.look_at(place),
    show_paths: () => view.paths.show(view_element("show_paths").checked && +view_element("apart").value === 0) };
  try {
    view.drawing = view_renderer(view, canvas);
  } catch (error) {
    view_element("failure").hidden = false;
    view_element("failure").textContent = "This browser draws no WebGL, which the picture is made with: " + error.message;
    return;
  }
  const paths = view_paths(data);
  view.space.add(new THREE.HemisphereLight(0xffffff, 0x8a8f95, 0.9), view.lamp);
  view.parts = view_parts(view);
  view.paths = view_path_lines(view, paths);
  view.painted = view_painted(view, view.parts);
  view.camera = view_camera(view, canvas);
  view.cut = view_cut(view);
  view.playback = view_playback(view);
  view.colours = view_colours(view);
  view_findings(view);
  // The lines once more, in a scene by themselves, for what is new of them.
  view.increment.autoUpdate = false;
  view.increment.children.push(view.paths.lines);
  const properties = view_properties(view, view.parts, view.painted, paths);
  view_listen(view, canvas, properties);

  view_element("counts").textContent = view_counts(view, paths);
  // Walls behind walls add up.
  view_element("opacity").value = Math.max(0.04, Math.min(0.3, 0.6 / Math.sqrt(data.parts.length)));
  view.parts.set_opacity(+view_element("opacity").value);
  view.parts.place();
  view.colours.paint();
  view.paths.draw();
  view.paths.set_time();
  view.drawing.resize();
  if (host.classList.contains("narrow")) view_element("menu").click();
  view.camera.look(3);
  view.drawing.renderer.setAnimationLoop(view.drawing.frame);
  // For tools/pages_check, which computes by itself what lies under a place of the screen.
  window.scintrayView = { data, shapes, histories: paths, middle: view.middle, camera: view.camera.camera,
    paths: paths.length, counts: view.drawing.counts, turn: view.camera.turn, space: view.space,
    show_path: (i) => { view.paths.choose(paths[i]); properties.show_path(paths[i]); },
    get frames() { return view.drawing.counts.frames; } };
}

(function () {
  const host = view_element("view"), open = host.querySelector(".view-open");
  const start = () => view_start(host);
  if (open) open.addEventListener("click", () => { host.classList.add("open"); start(); view_element("scene").focus(); }, { once: true });
  else start();
})();
