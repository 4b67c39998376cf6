// The camera: looks from sides, turned by drag and keys; the size of the picture.
const VIEW_SIDES = [[0, -1, 0.001], [1, 0, 0.001], [0, -0.001, 1], [0.7, -1, 0.6]];

function view_camera(view, canvas) {
  const { host, element, size } = view;
  const camera = new THREE.PerspectiveCamera(35, 1, 0.002 * size, 40 * size);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;  // arrow keys turn, below
  // A camera that is placed is not moving: its picture is drawn once, and whole.
  let placing = false;
  controls.addEventListener("change", () => placing ? view.redraw() : view.moved());
  function place(target, way, distance) {
    controls.target.set(...target);
    camera.position.set(...way).normalize().multiplyScalar(distance).add(controls.target);
    placing = true;
    controls.update();
    placing = false;
    view.redraw();
  }
  const look = (number) => place([0, 0, 0], VIEW_SIDES[number], 1.9 * size * Math.max(1, 0.9 / camera.aspect));
  const look_at = (target) => place(target, [0.2, -0.25, 0.15], 0.354 * size);

  // The middle of what the panel leaves free.
  function resize(wide, tall) {
    const panel = element("panel").getBoundingClientRect();
    camera.aspect = wide / tall;
    if (host.classList.contains("folded")) camera.clearViewOffset();
    else if (panel.width < wide) camera.setViewOffset(wide, tall, panel.width / 2, 0, wide, tall);
    else camera.setViewOffset(wide, tall, 0, panel.height / 2, wide, tall);
    camera.updateProjectionMatrix();
  }
  // Turns by steps of 0.1 rad, and comes nearer by a factor.
  function turn(steps, nearer) {
    const way = new THREE.Spherical(), from = camera.position.clone().sub(controls.target);
    way.setFromVector3(new THREE.Vector3(from.x, from.z, -from.y));  // its axis is y, ours is z
    way.theta += 0.1 * steps[0];
    way.phi = Math.max(0.01, Math.min(Math.PI - 0.01, way.phi + 0.1 * steps[1]));
    way.radius *= nearer;
    const to = new THREE.Vector3().setFromSpherical(way);
    camera.position.copy(controls.target).add(new THREE.Vector3(to.x, -to.z, to.y));
    controls.update();
    view.moved();
  }
  canvas.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const nearer = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 }[event.key];
    if (!steps && !nearer || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    turn(steps || [0, 0], nearer || 1);
  });
  // Within a page the wheel scrolls the page until the scene is clicked or has the keyboard.
  const zooms = () => { controls.enableZoom = !view.within || document.activeElement === canvas; };
  canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  for (const kind of ["focus", "blur"]) canvas.addEventListener(kind, zooms);
  zooms();
  // The ray through a place of the page.
  const ray = new THREE.Raycaster();
  function ray_through(x, y) {
    const box = canvas.getBoundingClientRect();
    ray.setFromCamera(new THREE.Vector2(2 * (x - box.left) / box.width - 1, 1 - 2 * (y - box.top) / box.height), camera);
    ray.params.Line = { threshold: 0.004 * camera.position.distanceTo(controls.target) };
    return ray;
  }
  return { camera, look, look_at, resize, turn, ray_through };
}
