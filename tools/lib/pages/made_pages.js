// Pages for which there are limits, made by a program: the block detector of 12 x 12 crystals with 500 paths, as a view and as
// the page of a run; 1,600 crystals with 1,000 paths; and a scene with findings.
"use strict";
const fs = require("fs");
const path = require("path");
const { execFileSync } = require("child_process");

const SOURCE = path.resolve(__dirname, "../../..");

const CRYSTALS = `title = "1,600 crystals on 14 x 14 sensors"
ambient = "air"
contacts_default = "bonded"
[[array]]
name = "crystal"
count = [40, 40]
pitch = "2.1 mm"
filler = "epoxy"
[array.element]
box = ["2 mm", "2 mm", "12 mm"]
medium = "LSO"
surface = "polished"
[[array]]
name = "sipm"
count = [14, 14]
pitch = "6.3 mm"
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "optical_grease" }
[array.element]
box = ["6 mm", "6 mm", "0.3 mm"]
sensor = "S13360_6050VE"
[source]
type = "photons"
region = { part = "crystal[20,20]" }
wavelength = "emission"
photons = 1000
`;

// Gaps of 2 and 3 um, which may be meant.
const FINDINGS = `title = "Gaps that may be meant"
ambient = "air"
[[part]]
name = "crystal"
box = { low = ["-1 mm", "-1 mm", "0 mm"], high = ["1 mm", "1 mm", "4 mm"] }
medium = "LSO"
surface = "polished"
[[part]]
name = "neighbour"
box = { low = ["1.003 mm", "-1 mm", "0 mm"], high = ["3 mm", "1 mm", "4 mm"] }
medium = "LSO"
surface = "polished"
[[part]]
name = "sipm"
box = { low = ["-1 mm", "-1 mm", "-0.302 mm"], high = ["1 mm", "1 mm", "-0.002 mm"] }
sensor = "S13360_6050VE"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
photons = 1000
`;

// The block detector at its first point, with a ledger, paths and few photons.
function block_run() {
  const text = fs.readFileSync(path.join(SOURCE, "scenes/block_detector.toml"), "utf8");
  return text.slice(0, text.indexOf("\n[[sweep]]") + 1).replace("photons = 50_000", "photons = 20_000").replace("\n[run]", "\n[run]\npaths = 500") +
    '[[tally]]\nname = "ledger"\ntype = "ledger"\n';
}

// What a picture may ask of a graphics processor that is to draw 60 a second at 1280 x 900, see docs/view.md.
const MOST_COSTS = { calls: 20, triangles: 50e3, line_ends: 250e3, uploaded: 1000, script_ms: 5, filled: 27e6 };

// Each with its limits: size, MB; time until the scene is drawn and answers, s; frames a second, by software; costs of a
// picture; findings.
function made_pages(program, folder) {
  const inside = (name) => path.join(folder, name);
  const call = (...words) => execFileSync(path.resolve(program), words,
    { cwd: folder, stdio: ["ignore", "ignore", "inherit"], env: { SCINTRAY_DATA: SOURCE, ...process.env } });
  fs.mkdirSync(folder, { recursive: true });
  for (const [name, text] of [["crystals", CRYSTALS], ["findings", FINDINGS], ["block_run", block_run()]])
    fs.writeFileSync(inside(name + ".toml"), text);
  call("view", path.join(SOURCE, "scenes/block_detector.toml"), "--paths", "500", "-o", "block.html");
  call("run", "block_run.toml", "--quiet");
  call("view", "crystals.toml", "--paths", "1000", "-o", "crystals.html");
  call("view", "findings.toml", "--paths", "50", "-o", "findings.html");
  return [
    { file: inside("block.html"), most_mb: 5, most_s: 2, paths: 500 },
    { file: inside("block_run.html"), most_mb: 5, most_s: 2, paths: 500, ledger: true },
    { file: inside("crystals.html"), most_mb: 5, least_rate: 2, paths: 1000, most_costs: MOST_COSTS },
    { file: inside("findings.html"), findings: 2 },
  ];
}

module.exports = { made_pages };
