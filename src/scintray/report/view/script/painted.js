// Tallies painted on faces: counts of faces per area, or grids across faces as a picture on them.
// viridis at nine places: S. van der Walt and N. Smith, matplotlib 1.5.
const VIRIDIS = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"];

function view_viridis(share) {
  const stops = view_viridis.stops = view_viridis.stops || VIRIDIS.map(view_rgb);
  const at = Math.max(0, Math.min(1, share)) * (stops.length - 1), i = Math.min(Math.floor(at), stops.length - 2);
  return stops[i].map((x, k) => x + (at - i) * (stops[i + 1][k] - x));
}

// The triangles of faces of some parts, as drawn. `wanted(face number)` picks faces, `each(part, face, triangle)` is
// called for each.
function view_face_triangles(view, wanted, each) {
  view.data.parts.forEach((part, number) => {
    const shape = view.shapes[part.s], first = view.first_faces[number];
    for (let t = 0; t < shape.t.length / 3; ++t)
      if (wanted(first + shape.f[t])) each(part, first + shape.f[t], t);
  });
}

// What is painted of a tally: per face its value per area, or a grid with its values per area.
function view_tally_values(view, tally) {
  if (tally.g) {
    const g = tally.g, cell = (g.b[1] - g.b[0]) * (g.b[3] - g.b[2]) / (g.n[0] * g.n[1]);
    return { grid: new Float32Array(view_bytes(tally.v)).map((x) => x / cell),
      faces: new Set(view_integers(tally.f, tally.fw)) };
  }
  const values = new Float32Array(view_bytes(tally.v));
  view.data.parts.forEach((part, number) => view.data.faces[part.l].forEach((face, i) => {
    values[view.first_faces[number] + i] /= view.shapes[part.s].areas[i];
  }));
  return { values };
}

// A number in a legend or a table, with three digits.
function view_number(x) {
  return x !== 0 && Math.abs(x) < 1e-3 ? x.toExponential(2).replace("e-", "e\u2212") : String(+x.toPrecision(3));
}

function view_painted(view, parts) {
  const { data, element, space } = view, tallies = data.tallies;
  let current = null;  // { tally, values or grid and faces, low, high, meshes }

  function range(values) {
    let low = Infinity, high = 0;
    for (const x of values) if (x > 0) { low = Math.min(low, x); high = Math.max(high, x); }
    return high > 0 ? [low, high] : [1, 1];
  }
  function share_of(x) {
    if (!(x > 0)) return 0;
    if (!element("tally_log").checked) return x / current.high;
    const low = Math.max(current.low, 1e-4 * current.high);
    return current.high > low ? Math.log(x / low) / Math.log(current.high / low) : 1;
  }
  function picture() {
    const [columns, rows] = current.tally.g.n, pixels = new Uint8Array(4 * columns * rows);
    for (let i = 0; i < columns; ++i)
      for (let j = 0; j < rows; ++j) {
        const c = view_viridis(share_of(current.grid[i * rows + j]));
        for (let k = 0; k < 3; ++k) pixels[4 * (j * columns + i) + k] = Math.round(255 * c[k]);
        pixels[4 * (j * columns + i) + 3] = 255;
      }
    const texture = new THREE.DataTexture(pixels, columns, rows, THREE.RGBAFormat);
    texture.magFilter = texture.minFilter = THREE.NearestFilter;
    texture.needsUpdate = true;
    return texture;
  }
  // Beyond the grid nothing is painted.
  function grid_material() {
    return new THREE.ShaderMaterial({
      uniforms: { cells: { value: picture() } }, clipping: true, side: THREE.DoubleSide,
      vertexShader: "varying vec2 at;\n#include <clipping_planes_pars_vertex>\n" +
        "void main() {\n#include <begin_vertex>\n#include <project_vertex>\n#include <clipping_planes_vertex>\nat = uv; }",
      fragmentShader: "uniform sampler2D cells; varying vec2 at;\n#include <clipping_planes_pars_fragment>\n" +
        "void main() {\n#include <clipping_planes_fragment>\n" +
        "if (at.x < 0.0 || at.x > 1.0 || at.y < 0.0 || at.y > 1.0) discard; gl_FragColor = texture2D(cells, at); }",
    });
  }
  function clear() {
    if (!current) return;
    for (const mesh of current.meshes) {
      space.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.dispose();
      if (mesh.material.uniforms) mesh.material.uniforms.cells.value.dispose();
    }
    current = null;
  }
  function grid_share(g, k, place) {
    const along = g.a[k], x = along[0] * place[0] + along[1] * place[1] + along[2] * place[2];
    return (x - g.b[2 * k]) / (g.b[2 * k + 1] - g.b[2 * k]);
  }
  function build() {
    const position = [], extra = [], { tally } = current;
    const wanted = tally.g ? (face) => current.faces.has(face) : (face) => !Number.isNaN(current.values[face]);
    view_face_triangles(view, wanted, (part, face, triangle) => {
      const shape = view.shapes[part.s], offset = parts.offset_of(part);
      const colour = tally.g ? null : view_viridis(share_of(current.values[face]));
      for (let k = 0; k < 3; ++k) {
        const corner = shape.t[3 * triangle + k], v = [0, 1, 2].map((i) => shape.v[3 * corner + i]);
        position.push(...v.map((x, i) => x + offset[i]));
        if (colour) extra.push(...colour);
        else extra.push(...[0, 1].map((i) => grid_share(tally.g, i, v.map((x, j) => x + part.o[j]))));
      }
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(position), 3));
    geometry.setAttribute(tally.g ? "uv" : "color", new THREE.BufferAttribute(new Float32Array(extra), tally.g ? 2 : 3));
    // Where faces of two parts lie on each other, each is seen from its own outside.
    const materials = tally.g ? [grid_material()] : [THREE.BackSide, THREE.FrontSide].map((side) =>
      new THREE.MeshBasicMaterial({ vertexColors: THREE.VertexColors, side }));
    current.meshes = materials.map((material, i) => {
      Object.assign(material, { polygonOffset: true, polygonOffsetFactor: -1 - i, polygonOffsetUnits: -1 - i,
        clippingPlanes: view.planes() });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.renderOrder = -1;
      space.add(mesh);
      return mesh;
    });
  }
  function show(number) {
    clear();
    if (number !== null) {
      const tally = tallies[number], values = view_tally_values(view, tally);
      current = { number, tally, meshes: [], ...values };
      [current.low, current.high] = range(values.grid || values.values);
      build();
    }
    view.redraw();
  }
  function legend() {
    const scale = document.createElement("p"), log = element("tally_log").checked;
    scale.className = "scale";
    const low = log ? Math.max(current.low, 1e-4 * current.high) : 0;
    const bar = document.createElement("i");
    bar.style.background = "linear-gradient(90deg, " + VIRIDIS.join(", ") + ")";
    const ends = [low, current.high].map((x) => {
      const span = document.createElement("span");
      span.textContent = view_number(x);
      return span;
    });
    scale.append(ends[0], bar, ends[1]);
    const unit = document.createElement("p");
    unit.className = "soft";
    unit.textContent = current.tally.u + ", per mm2";
    return [scale, unit];
  }
  // Rows of properties: what tallies have of a face, at a place (mm).
  function rows_at(face, place) {
    const rows = [];
    for (const tally of tallies) {
      const made = tally.made = tally.made || view_tally_values(view, tally);
      let value = NaN;
      if (made.values) value = made.values[face];
      else if (made.faces.has(face)) {
        const [i, j] = [0, 1].map((k) => Math.floor(tally.g.n[k] * grid_share(tally.g, k, place)));
        if (i >= 0 && j >= 0 && i < tally.g.n[0] && j < tally.g.n[1]) value = made.grid[i * tally.g.n[1] + j];
      }
      if (!Number.isNaN(value))
        rows.push([tally.n + (made.values ? ", of the face" : ", here"), view_number(value) + " " + tally.u + ", per mm2"]);
    }
    return rows;
  }
  return { show, legend, rows_at, place: () => { if (current) show(current.number); },
    shown: () => current !== null, materials: () => current ? current.meshes.map((mesh) => mesh.material) : [] };
}
