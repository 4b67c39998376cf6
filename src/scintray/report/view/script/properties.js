// Properties of what is picked: the history of a path, or a face with what the run counted there.
function view_table(heads, rows) {
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

// What the whole run counted at a face, its part, its surface and in its medium.
function view_ledger_rows(data, part, face) {
  const ledger = data.ledger, rows = [];
  if (!ledger) return rows;
  const share = (count) => count + " (" + (100 * count / ledger.n).toPrecision(3) + " %)";
  const add = (title, count) => { if (count !== undefined) rows.push([title, share(count)]); };
  const through = ledger.faces[part.n + ":" + (face ? face.n : "")], all = ledger.parts[part.n];
  const medium = data.media[part.m].n, surface = face ? data.surfaces[face.s].n : "";
  if (through) { add("run: detected through this face", through[0]); add("run: not detected through it", through[1]); }
  if (all) { add("run: detected by this part", all[0]); add("run: not detected by it", all[1]); }
  add("run: absorbed at " + surface + ", all its faces", ledger.surfaces[surface]);
  add("run: absorbed in " + medium + ", all its parts", ledger.media[medium]);
  return rows;
}

function view_properties(view, parts, painted, paths) {
  const { data, element, host, shapes } = view;
  const finest = Math.max(...[0, 1, 2].map((k) => data.steps.b[3 + k] - data.steps.b[k])) / 131070;
  const decimals = Math.max(0, Math.min(3, Math.floor(-Math.log10(Math.max(finest, 1e-9)))));

  function show(title, heads, rows) {
    const head = document.createElement(view.within ? "h3" : "h2");
    head.textContent = title;
    element("chosen").replaceChildren(head, view_table(heads, rows));
    if (host.classList.contains("folded")) element("menu").click();
    element("panel").scrollTop = element("chosen").offsetTop - 8;
  }
  function show_path(path) {
    const rows = [];
    for (let i = 0; i < path.e.length; ++i)
      rows.push([i, data.events[path.e[i]], path.v[2 * i].toFixed(3), path.v[2 * i + 1].toFixed(1),
        ...[0, 1, 2].map((k) => path.p[3 * i + k].toFixed(decimals))]);
    show(path.n + ": " + path.fate, ["step", "event", "ns", "nm", "x mm", "y mm", "z mm"], rows);
  }
  // What the paths in the picture did at a part.
  function path_rows(part) {
    const rows = [];
    for (const [verb, title] of [["detected by " + part.n, "paths detected here"],
      ["not detected by " + part.n, "paths not detected here"],
      ["reflected at " + part.n + " |", "reflections at this part, as seen from inside"],
      ["into " + part.n, "entries into this part"]]) {
      let count = 0;
      for (const path of paths) for (const e of path.e) if (data.events[e].startsWith(verb)) ++count;
      if (count > 0) rows.push([title, count]);
    }
    return rows;
  }
  function show_face({ part, triangle, point }) {
    const face = parts.face_of(part, triangle), number = shapes[part.s].f[triangle];
    const rows = [["medium", data.media[part.m].n], ["face", face ? face.n : "-"],
      ["surface", face ? data.surfaces[face.s].n : "-"],
      ["area", shapes[part.s].areas[number].toPrecision(5) + " mm2"]];
    if (face && face.w) rows.push(["stated at", face.w]);
    if (face && face.d) rows.push(["sensor", face.d]);
    const offset = parts.offset_of(part), place = [point.x, point.y, point.z].map((x, k) => x - offset[k] + part.o[k]);
    rows.push(...view_ledger_rows(data, part, face), ...path_rows(part),
      ...painted.rows_at(view.first_faces[data.parts.indexOf(part)] + number, place));
    show(part.n + ":" + (face ? face.n : ""), [], rows);
  }
  return { show_path, show_face };
}
