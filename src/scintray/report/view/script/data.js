// Data of view_data.cpp, unpacked: shapes, parts, photon paths. Numbers are integers of one, two or four bytes; those of
// coordinates are shares of 65535 of a box. Nothing here draws.
const view_bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
const view_integers = (text, width) => new ({ 1: Uint8Array, 2: Uint16Array, 4: Uint32Array })[width](view_bytes(text));

function view_coordinates(text, box, Made) {
  const shares = new Uint16Array(view_bytes(text)), values = new Made(shares.length);
  for (let i = 0; i < shares.length; ++i) values[i] = box[i % 3] + (box[3 + i % 3] - box[i % 3]) * shares[i] / 65535;
  return values;
}

// A shape: vertices, triangles, and per triangle the number of its face within the part.
function view_shape(shape) {
  const made = { v: view_coordinates(shape.v, shape.b, Float32Array), t: view_integers(shape.t, shape.tw),
    f: view_integers(shape.f, shape.fw) };
  const corner = (t, k) => made.v.subarray(3 * made.t[3 * t + k], 3 * made.t[3 * t + k] + 3);
  made.areas = [];  // mm2, by face
  for (let t = 0; t < made.t.length / 3; ++t) {
    const [a, b, c] = [corner(t, 0), corner(t, 1), corner(t, 2)], u = [], w = [];
    for (let k = 0; k < 3; ++k) { u.push(b[k] - a[k]); w.push(c[k] - a[k]); }
    made.areas[made.f[t]] = (made.areas[made.f[t]] || 0) +
      0.5 * Math.hypot(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]);
  }
  return made;
}

// Least and largest coordinates of all parts, mm.
function view_extent(parts, shapes) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const part of parts) {
    const v = shapes[part.s].v;
    for (let i = 0; i < v.length; ++i) {
      const x = v[i] + part.o[i % 3];
      low[i % 3] = Math.min(low[i % 3], x);
      high[i % 3] = Math.max(high[i % 3], x);
    }
  }
  if (low[0] > high[0]) { low.fill(-1); high.fill(1); }
  return { low, high, middle: low.map((x, i) => 0.5 * (x + high[i])),
    size: Math.max(1e-6, Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2])) };
}

// Paths: per step its place p, (time in ns, wavelength in nm) v, and the number of its event e.
function view_paths(data) {
  const p = view_coordinates(data.steps.p, data.steps.b, Float64Array), t = view_integers(data.steps.t, 2),
    e = view_integers(data.steps.e, data.steps.ew);
  let first = 0;
  return data.paths.map((path) => {
    const made = { n: path.n, fate: data.fates[path.f], p: p.subarray(3 * first, 3 * (first + path.k)),
      v: new Float32Array(2 * path.k), e: e.subarray(first, first + path.k) };
    let nm = 0, change = 0;
    for (let i = 0; i < path.k; ++i) {
      if (change < path.w.length && path.w[change][0] === i) nm = path.w[change++][1];
      made.v[2 * i] = path.t[0] + (path.t[1] - path.t[0]) * t[first + i] / 65535;
      made.v[2 * i + 1] = nm;
    }
    first += path.k;
    return made;
  });
}

// The number of each part's first face, counted over the parts in their order, as tallies number faces.
function view_first_faces(data) {
  let faces = 0;
  return data.parts.map((part) => { const first = faces; faces += data.faces[part.l].length; return first; });
}
