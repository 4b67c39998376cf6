// Parts: one geometry for those of a medium, without shared corners, so that every triangle has its own colour.
const view_rgb = (text) => { const c = new THREE.Color(text); return [c.r, c.g, c.b]; };

// A line of a legend, with a box to tick where `changed` is given.
function view_row(swatch, name, count, checked, changed) {
  const label = document.createElement("label");
  if (changed) {
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = checked;
    box.addEventListener("change", () => changed(box.checked));
    label.append(box);
  }
  for (const [text, colour] of [["", swatch], [name, ""], [count, ""]]) {
    const span = document.createElement("span");
    span.textContent = text;
    if (colour) { span.className = "swatch"; span.style.background = colour; }
    label.append(span);
  }
  return label;
}

function view_parts(view) {
  const { data, shapes, middle, element } = view;
  const colours = { medium: data.media.map((m) => view_rgb(m.c)), surface: data.surfaces.map((s) => view_rgb(s.c)) };
  const NEUTRAL = [0.6, 0.6, 0.6], EDGE_OPACITY = 0.55;

  const groups = data.media.map((medium, m) => {
    const parts = data.parts.filter((part) => part.m === m), group = { parts, first: [], triangles: 0, medium };
    for (const part of parts) { group.first.push(group.triangles); group.triangles += shapes[part.s].t.length / 3; }
    const geometry = new THREE.BufferGeometry();
    for (const name of ["position", "color"])
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(9 * group.triangles), 3));
    group.mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({
      vertexColors: THREE.VertexColors, side: THREE.DoubleSide, transparent: true, depthWrite: false, flatShading: true,
      clippingPlanes: [],
    }));
    group.edges = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({
      transparent: true, opacity: EDGE_OPACITY, clippingPlanes: [],
    }));
    view.space.add(group.mesh, group.edges);
    return group;
  });

  const shape_edges = new Map();
  function edges_of(index) {
    if (!shape_edges.has(index)) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(shapes[index].v, 3));
      geometry.setIndex(new THREE.BufferAttribute(shapes[index].t, 1));
      shape_edges.set(index, new THREE.EdgesGeometry(geometry, 20).attributes.position.array);
    }
    return shape_edges.get(index);
  }
  // Of a part's shape, as drawn: relative to the middle of the scene, and moved apart from it.
  function offset_of(part) {
    const apart = +element("apart").value, v = shapes[part.s].v;
    if (!part.c) {
      const centre = [0, 0, 0];
      for (let i = 0; i < v.length; ++i) centre[i % 3] += 3 * v[i] / v.length;
      part.c = centre.map((x, i) => x + part.o[i] - middle[i]);
    }
    return part.o.map((x, i) => x - middle[i] + apart * part.c[i]);
  }
  function place() {
    for (const group of groups) {
      const position = group.mesh.geometry.attributes.position.array;
      let at = 0, lines = 0;
      for (const part of group.parts) lines += edges_of(part.s).length;
      const edges = new Float32Array(lines);
      lines = 0;
      for (const part of group.parts) {
        const shape = shapes[part.s], o = offset_of(part), e = edges_of(part.s);
        for (let i = 0; i < shape.t.length; ++i)
          for (let k = 0; k < 3; ++k) position[at++] = shape.v[3 * shape.t[i] + k] + o[k];
        for (let i = 0; i < e.length; ++i) edges[lines++] = e[i] + o[i % 3];
      }
      group.mesh.geometry.attributes.position.needsUpdate = true;
      group.mesh.geometry.computeBoundingSphere();
      group.mesh.geometry.computeVertexNormals();
      group.edges.geometry.setAttribute("position", new THREE.BufferAttribute(edges, 3));
      group.edges.geometry.computeBoundingSphere();
    }
    view.redraw();
  }
  function face_of(part, triangle) { return data.faces[part.l][shapes[part.s].f[triangle]]; }
  function colour_of(by, part, triangle) {
    if (by === "medium") return colours.medium[part.m];
    const face = by === "surface" ? face_of(part, triangle) : null;
    return face ? colours.surface[face.s] : NEUTRAL;
  }
  // By medium, by surface, or all alike beneath a tally.
  function paint(by) {
    const line = view.dark.matches ? "#aab4bd" : "#55606a";
    for (const group of groups) {
      const colour = group.mesh.geometry.attributes.color;
      let at = 0;
      for (const part of group.parts)
        for (let t = 0; t < shapes[part.s].t.length / 3; ++t) {
          const c = colour_of(by, part, t);
          for (let k = 0; k < 9; ++k) colour.array[at++] = c[k % 3];
        }
      colour.needsUpdate = true;
      group.edges.material.color.set(by === "medium" ? group.medium.c : line);
    }
    view.redraw();
  }
  function legend(by) {
    if (by === "surface") return data.surfaces.map((surface) => view_row(surface.c, surface.n, "", true, null));
    return groups.map((group) => view_row(group.medium.c, group.medium.n,
      group.parts.length === 1 ? "1 part" : group.parts.length + " parts", group.mesh.visible, (on) => {
        group.mesh.visible = on;
        group.edges.visible = on && element("edges").checked;
        view.redraw();
      }));
  }
  function set_opacity(opacity) {
    for (const group of groups) {
      group.mesh.material.opacity = opacity;
      group.mesh.material.depthWrite = opacity > 0.95;
    }
    view.redraw();
  }
  function show_edges(on) {
    for (const group of groups) group.edges.visible = on && group.mesh.visible;
    view.redraw();
  }
  // Lines are a point wide: where points are larger, they are fainter, and cover as much.
  function fade_edges(share) {
    for (const group of groups) group.edges.material.opacity = share * EDGE_OPACITY;
  }
  // The part, its triangle and the place where a ray enters what `side` keeps.
  function hit(ray, side) {
    let nearest = null;
    for (const group of groups)
      if (group.mesh.visible)
        for (const found of ray.intersectObject(group.mesh))
          if (side(found) && (!nearest || found.distance < nearest.distance)) nearest = { ...found, group };
    if (!nearest) return null;
    const { group, faceIndex, point } = nearest;
    let number = 0;
    while (number + 1 < group.first.length && group.first[number + 1] <= faceIndex) ++number;
    return { part: group.parts[number], triangle: faceIndex - group.first[number], point };
  }
  return { place, paint, legend, set_opacity, show_edges, fade_edges, hit, face_of, offset_of,
    triangles: groups.reduce((sum, group) => sum + group.triangles, 0),
    materials: groups.flatMap((group) => [group.mesh.material, group.edges.material]) };
}
