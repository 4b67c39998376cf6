// Findings of check: balls over everything, with the number of the finding at its first place.
function view_number_label(text) {
  const canvas = document.createElement("canvas"), wide = 20 + 22 * text.length;
  canvas.width = wide;
  canvas.height = 40;
  const draw = canvas.getContext("2d");
  draw.fillStyle = "#a80019";
  draw.fillRect(0, 0, wide, 40);
  draw.fillStyle = "#ffffff";
  draw.font = "bold 30px sans-serif";
  draw.textAlign = "center";
  draw.textBaseline = "middle";
  draw.fillText(text, wide / 2, 21);
  const label = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false,
    sizeAttenuation: false }));
  label.material.map.minFilter = THREE.LinearFilter;
  label.center.set(0.5, -0.4);
  label.scale.set(0.018 * wide / 40, 0.018, 1);
  label.renderOrder = 3;
  return label;
}

function view_findings(view) {
  const { data, element, middle, size, space } = view;
  const ball = new THREE.SphereBufferGeometry(0.006 * size, 12, 8),
    red = new THREE.MeshBasicMaterial({ color: "#d0021b", depthTest: false, transparent: true, opacity: 0.8 });
  data.marks.forEach((mark, number) => mark.p.forEach((p, i) => {
    const drawn = [new THREE.Mesh(ball, red)];
    if (i === 0) drawn.push(view_number_label(String(number + 1)));
    for (const one of drawn) {
      one.position.set(...p.map((x, k) => x - middle[k]));
      one.renderOrder = one.renderOrder || 2;
      space.add(one);
    }
  }));
  element("findings").hidden = data.marks.length === 0;
  for (const mark of data.marks) {
    const item = document.createElement("li"), button = document.createElement("button");
    button.type = "button";
    button.textContent = mark.t;
    button.addEventListener("click", () => { if (mark.p.length) view.look_at(mark.p[0].map((x, k) => x - middle[k])); });
    item.append(button);
    element("marks").append(item);
  }
}
