#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "physics/crystal_scene.hpp"
#include "physics/traced.hpp"
#include "scintray/analysis/light_analysis.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::test;
using nlohmann::json;

namespace {

json reference_run(const std::string& name) {
  std::ifstream stream(source_file("tests/reference/geant4/" + name + ".json"));
  return json::parse(stream);
}

/// Crystal, grease, detector and source of a reference run; tests/reference/README.md describes them.
std::string reference_scene(const json& config, const std::string& surface, std::uint64_t seed) {
  const bool volume = config["source"] == "volume" || config["z0_mm"].is_null();
  CrystalScene scene{"lso", surface, "", 200'000, R"(, gap = "0.1 mm", fill = "n15")"};
  if (!volume) scene.where = slab(config["z0_mm"].get<double>(), config["dz_mm"].get<double>());
  scene.width_mm = config["width_mm"].get<double>();
  return crystal_scene(scene) + fmt::format(R"(
[run]
seed = {}
[[tally]]
type = "exit_angle"
name = "crystal"
face = "crystal:exit"
detected_only = true
)",
                                            seed);
}

/// Walls 0.1 mm away that reflect Lambertian with 0.97, open at the exit end.
const std::string kTape = R"(
[[part]]
name = "wall_left"
box = { low = ["-1.6 mm", "-1.6 mm", "0 mm"], high = ["-1.1 mm", "1.6 mm", "20.1 mm"] }
medium = "opaque"
surface = "tape"
[[part]]
name = "wall_right"
box = { low = ["1.1 mm", "-1.6 mm", "0 mm"], high = ["1.6 mm", "1.6 mm", "20.1 mm"] }
medium = "opaque"
surface = "tape"
[[part]]
name = "wall_front"
box = { low = ["-1.1 mm", "-1.6 mm", "0 mm"], high = ["1.1 mm", "-1.1 mm", "20.1 mm"] }
medium = "opaque"
surface = "tape"
[[part]]
name = "wall_back"
box = { low = ["-1.1 mm", "1.1 mm", "0 mm"], high = ["1.1 mm", "1.6 mm", "20.1 mm"] }
medium = "opaque"
surface = "tape"
[[part]]
name = "wall_top"
box = { low = ["-1.6 mm", "-1.6 mm", "20.1 mm"], high = ["1.6 mm", "1.6 mm", "20.6 mm"] }
medium = "opaque"
surface = "tape"
[surfaces.tape]
model = "painted"
reflectance = 0.97
specular_share = 0.0
)";

const std::string kUnified = R"(
[surfaces.ground]
model = "unified"
[surfaces.ground.unified]
sigma_alpha = "0.314 rad"
definition = "solid_angle"
facets = "geant4"
lobe = 1.0
)";

const std::string kBackPainted = R"(
[surfaces.backpainted]
model = "smooth"
gap = 1.0
reflectance = 0.97
specular_share = 1.0
)";

/// A seed of its own for every run: with one for all they would share the fluctuations of one source.
std::uint64_t seed_of(const std::string& run) {
  std::uint64_t seed = 0;
  for (const char letter : run) seed = 31 * seed % 1'000'003 + static_cast<unsigned char>(letter);
  return seed;
}

std::string scene_for(const json& config, std::uint64_t seed) {
  const std::string finish = config["finish"];
  if (finish == "ground") return reference_scene(config, "ground", seed) + kUnified;
  if (finish == "polishedbackpainted") return reference_scene(config, "backpainted", seed) + kBackPainted;
  if (finish == "tape") return reference_scene(config, "flat", seed) + kTape;
  return reference_scene(config, "flat", seed);
}

/// What a run of ours and Geant4's differ by, gathered for docs/validation.md.
struct Comparison {
  explicit Comparison(std::string name) : run(std::move(name)) {}

  std::string run;
  double largest_sigmas = 0.0;
  std::string largest_of;
  Estimate detected, detected_geant4;
  double least_p = 1.0;

  void number(const std::string& what, const Estimate& ours, const Estimate& theirs) {
    const double distance = sigmas(ours, theirs);
    CAPTURE(run);
    CAPTURE(what);
    CAPTURE(ours.value);
    CAPTURE(theirs.value);
    CHECK(distance < kSigmas);
    if (what == "detected") {
      detected = ours;
      detected_geant4 = theirs;
    }
    if (distance < largest_sigmas) return;
    largest_sigmas = distance;
    largest_of = what;
  }

  void histogram(const std::string& what, const std::vector<std::uint64_t>& ours, const json& theirs) {
    const ChiSquare test = chi_square_two_samples(ours, theirs.get<std::vector<std::uint64_t>>());
    CAPTURE(run);
    CAPTURE(what);
    CHECK(test.p_value > 6.3e-5);  // the two-sided probability of 4 sigma
    least_p = std::min(least_p, test.p_value);
  }

  void report(const std::string& table) const {
    evidence(table, {run, fmt::format("{:.5f} ± {:.5f}", detected.value, detected.error),
                     fmt::format("{:.5f} ± {:.5f}", detected_geant4.value, detected_geant4.error),
                     fmt::format("{:.2f}", sigmas(detected, detected_geant4)),
                     fmt::format("{:.2f} ({})", largest_sigmas, largest_of),
                     least_p == 1.0 ? std::string("-") : fmt::format("{:.3f}", least_p)});
  }
};

Estimate mean_of(const json& run, const std::string& key) {
  return {run[key].get<double>(), run[key + "_err"].get<double>()};
}

Estimate share_of(const json& run, const std::string& key) {
  return binomial_estimate(run[key + "_count"], run["photons"]);
}

void compare_run(const json& run, const std::string& name, const std::string& scene) {
  const PointResult result = trace(scene).result;
  Comparison c(name);
  c.number("detected", result.fraction(Fate::detected), share_of(run, "detected"));
  c.number("escaped", result.fraction(Fate::escaped), share_of(run, "escaped"));
  c.number("absorbed in the bulk", result.fraction(Fate::absorbed_in_medium), share_of(run, "bulk_absorbed"));
  c.number("absorbed at surfaces", result.fraction(Fate::absorbed_at_surface),
           share_of(run, "surface_absorbed"));
  c.number("interactions", result.interactions.mean(), mean_of(run, "boundary_interactions_mean"));
  c.number("path of detected", result.detected_path_mm.mean(), mean_of(run, "detected_path_mm_mean"));
  c.number("time of detected", result.detected_time_ns.mean(), mean_of(run, "detected_time_ns_mean"));
  const std::vector<CrossingAngles> angles = crossing_angles(result);
  c.histogram("angle in crystal", angles.at(0).inside, run["theta_crystal_hist"]);
  c.histogram("angle in grease", angles.at(0).outside, run["theta_grease_hist"]);
  std::vector<std::uint64_t> paths = run["path_hist"];
  paths.push_back(run["path_overflow"]);
  const auto& ours = result.detected_path_histogram;
  c.histogram("path of detected", std::vector<std::uint64_t>(ours.begin(), ours.end()), paths);
  c.report("geant4");
}

void compare_finish(const std::string& prefix) {
  for (const std::string place : {"vol", "z02", "z06", "z10", "z14", "z18"}) {
    const json run = reference_run("phys_" + prefix + "_w2_" + place);
    json config = run["config"];
    if (place == "vol") config["source"] = "volume";
    compare_run(run, prefix + ", " + place, scene_for(config, seed_of(prefix + place)));
  }
}

}  // namespace

TEST_CASE("Geant4: polished crystal in air") { compare_finish("polished"); }
TEST_CASE("Geant4: UNIFIED ground crystal, sigma_alpha 0.314 rad") { compare_finish("ground_sa0.314"); }
TEST_CASE("Geant4: polished crystal, back-painted") { compare_finish("polishedbackpainted"); }
TEST_CASE("Geant4: polished crystal in a box of Lambertian tape") { compare_finish("tape"); }

TEST_CASE("Geant4: arrays of polished crystals with air gaps share light alike") {
  for (const std::string name :
       {"array3x3_polished_w2_z02", "array3x3_polished_w2_z10", "array5x5_polished_w2_z10"}) {
    const json run = reference_run(name);
    const int n = run["config"]["array"];
    const double pitch = run["config"]["width_mm"].get<double>() + run["config"]["air_gap_mm"].get<double>();
    // The crystal of the source, at the centre, then its neighbours, each with its grease and detector.
    std::string scene = reference_scene(run["config"], "flat", seed_of(name));
    const std::size_t end_of_parts = scene.find("[source]");
    std::string neighbours;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        if (i == n / 2 && j == n / 2) continue;
        const double x = (i - n / 2) * pitch, y = (j - n / 2) * pitch;
        neighbours += fmt::format(R"(
[[part]]
name = "crystal_{0}_{1}"
box = ["2 mm", "2 mm", "20 mm"]
translate = ["{2} mm", "{3} mm", "0 mm"]
medium = "lso"
surface = "flat"
[[part]]
name = "detector_{0}_{1}"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal_{0}_{1}", side = "-z", gap = "0.1 mm", fill = "n15" }}
medium = "n15"
sensor = "perfect"
)",
                                  i, j, x, y);
      }
    scene.insert(end_of_parts, neighbours);
    const Traced traced = trace(scene);
    const PointResult& result = traced.result;
    CHECK(traced.built.scene.accelerators.size() <= 5);  // ambient, crystal, grease, detector
    Comparison c(name);
    c.number("detected", result.fraction(Fate::detected), share_of(run, "detected"));
    c.number("escaped", result.fraction(Fate::escaped), share_of(run, "escaped"));
    c.number("absorbed in the bulk", result.fraction(Fate::absorbed_in_medium),
             share_of(run, "bulk_absorbed"));
    c.number("interactions", result.interactions.mean(), mean_of(run, "boundary_interactions_mean"));
    std::uint64_t own = 0, neighbours_detected = 0;
    for (const SensorFaceCount& count : result.sensor_faces)
      (traced.built.scene.parts[count.part].name == "detector" ? own : neighbours_detected) += count.detected;
    const std::uint64_t reference_own =
        run["detected_count_per_crystal"][static_cast<std::size_t>(n / 2)][static_cast<std::size_t>(n / 2)];
    const std::uint64_t reference_all = run["detected_count"];
    c.number("own detector", binomial_estimate(own, result.photons),
             binomial_estimate(reference_own, run["photons"]));
    c.number("other detectors", binomial_estimate(neighbours_detected, result.photons),
             binomial_estimate(reference_all - reference_own, run["photons"]));
    c.report("geant4");
  }
}
