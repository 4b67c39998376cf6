// Geant4's own example OpNovice2: the outputs that it ships, against surfaces imported from GDML files that
// state the same. The outputs are data of third parties; without them the tests are skipped.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "io/gdml_texts.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/optics/coherent_layers.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

constexpr double kPhotonEnergy_eV = 3.0;
constexpr std::uint64_t kPhotons = 400'000;

/// A mean with its standard deviation, as Geant4's histograms print it.
struct Spread {
  double mean = 0.0, rms = 0.0;
};

/// One run of the example.
struct BoundaryRun {
  std::string model, type, finish;
  double sigma_alpha = 0.0, polish = 1.0, roughness_mm = 0.0;
  std::map<std::string, double> counts;  ///< by surface process
  std::map<std::string, Spread> means;   ///< of "X backward", ...

  double count(const std::string& process) const {
    const auto found = counts.find(process);
    return found == counts.end() ? 0.0 : found->second;
  }
  bool back_painted() const { return finish.ends_with("backpainted"); }
  double outside() const {
    return count("Transmission") + (back_painted() ? 0.0 : count("Fresnel refraction"));
  }
  double absorbed() const { return count("Absorption") + count("Detection"); }
};

std::vector<BoundaryRun> runs_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<BoundaryRun> runs;
  BoundaryRun state;
  bool in_counts = false;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string first, second;
    words >> first;
    if (first == "/opnovice2/surfaceModel") words >> state.model;
    if (first == "/opnovice2/surfaceType") words >> state.type;
    if (first == "/opnovice2/surfaceFinish") words >> state.finish;
    if (first == "/opnovice2/surfaceSigmaAlpha") words >> state.sigma_alpha;
    if (first == "/opnovice2/surfacePolish") words >> state.polish;
    if (first == "/opnovice2/surfaceConstProperty") words >> second >> state.roughness_mm;
    if (line.starts_with("Surface events by process:")) {
      runs.push_back(state);
      in_counts = true;
      continue;
    }
    const std::size_t colon = line.find(':');
    if (in_counts && line.starts_with(" Sum")) in_counts = false;
    if (in_counts && colon != std::string::npos && line.starts_with("  "))
      runs.back().counts[line.substr(2, colon - 2)] = std::stod(line.substr(colon + 1));
    if (const std::size_t at = line.find(" momentum dir of "); at != std::string::npos && !runs.empty()) {
      Spread spread;
      std::sscanf(line.c_str() + line.find("mean ="), "mean = %lf rms = %lf", &spread.mean, &spread.rms);
      const std::string rest = line.substr(at + 17);
      runs.back().means[line.substr(1, 1) + " " + rest.substr(0, rest.find_first_of("- "))] = spread;
    }
  }
  return runs;
}

/// The surface of a run, imported from GDML with the properties of boundary.mac.
Surface imported(const BoundaryRun& run) {
  GdmlText text;
  text.define = fmt::format(R"(<matrix name="BOX" coldim="2" values="2*eV 1.3 8*eV 1.4"/>
<matrix name="OUT" coldim="2" values="2*eV 1.01 8*eV 1.01"/><matrix name="P1" coldim="2" values="2*eV 0.1 8*eV 0.1"/>
<matrix name="P8" coldim="2" values="2*eV 0.8 8*eV 0.8"/><matrix name="GAP" coldim="2" values="2*eV 1.4 8*eV 1.5"/>
<matrix name="ROUGH" coldim="1" values="{:.9g}"/>)",
                            run.roughness_mm);
  text.materials = R"(<material name="Box"><property name="RINDEX" ref="BOX"/></material>
<material name="Out"><property name="RINDEX" ref="OUT"/></material>)";
  text.solids =
      R"(<box name="b" x="20" y="20" z="20"/><box name="o" x="40" y="40" z="40"/>
<opticalsurface name="it" model=")" +
      run.model + "\" finish=\"" + run.finish + "\" type=\"" + run.type + "\" value=\"" +
      fmt::format("{:.9g}", run.model == "glisur" ? run.polish : run.sigma_alpha) +
      R"("><property name="SPECULARLOBECONSTANT" ref="P1"/><property name="SPECULARSPIKECONSTANT" ref="P1"/>
<property name="BACKSCATTERCONSTANT" ref="P1"/><property name="TRANSMITTANCE" ref="P1"/>
<property name="REFLECTIVITY" ref="P8"/><property name="EFFICIENCY" ref="P1"/><property name="RINDEX" ref="GAP"/>
<property name="SURFACEROUGHNESS" ref="ROUGH"/></opticalsurface>)";
  text.structure = gdml_volume("inner", "b", "Box") +
                   R"(<skinsurface name="s" surfaceproperty="it"><volumeref ref="inner"/></skinsurface>)" +
                   gdml_volume("outer", "o", "Out", gdml_placed("inner_p", "inner"));
  text.daughters = gdml_placed("outer_p", "outer");
  exchange::gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  static int number = 0;
  const auto file = scratch_folder("opnovice2_" + std::to_string(++number)) / "scene.toml";
  exchange::write_scene_draft(exchange::gdml::draft_of_gdml(text.text(), "test.gdml", options), file);
  const scene::BuiltScene built = scene::SceneBuilder().build(scene_file::SceneFile::load(file).spec(0));
  for (const Surface& surface : built.scene.surfaces)
    if (surface.definition == "it" && surface.name.find("(Box to Out)") != std::string::npos) return surface;
  FAIL("the surface is not in the scene");
  return {};
}

struct Ours {
  std::uint64_t inside = 0, outside = 0, absorbed = 0;
  std::array<Moments, 3> backward, forward;
};

Ours send(const Surface& surface) {
  Ours ours;
  const double n1 = 1.3 + 0.1 * (kPhotonEnergy_eV - 2.0) / 6.0;
  const double nm = 1239.841984 / kPhotonEnergy_eV;
  for (std::uint64_t i = 0; i < kPhotons; ++i) {
    Rng rng(31, StreamKind::other, i);
    Ray ray{Vec3(0.9, 0.44, 0.0).normalized(), Vec3::Zero()};
    ray.polarisation = sample_polarisation(ray.direction, rng);
    const SurfaceOutcome outcome = surface.interact(ray, Side::inside, Vec3::UnitX(), {n1, 1.01}, nm, rng);
    if (outcome == SurfaceOutcome::absorbed) {
      ++ours.absorbed;
      continue;
    }
    ++(outcome == SurfaceOutcome::inside ? ours.inside : ours.outside);
    for (int axis = 0; axis < 3; ++axis)
      (outcome == SurfaceOutcome::inside ? ours.backward : ours.forward)[static_cast<std::size_t>(axis)].add(
          ray.direction[axis]);
  }
  return ours;
}

/// Compares a share of theirs, of so many photons, with ours.
void compare_shares(const std::string& run, const std::string& what, double theirs, double of,
                    std::uint64_t ours) {
  const Estimate g4 = binomial_estimate(static_cast<std::uint64_t>(theirs), static_cast<std::uint64_t>(of));
  const Estimate own = binomial_estimate(ours, kPhotons);
  CAPTURE(what);
  CAPTURE(g4.value);
  CAPTURE(own.value);
  evidence("opnovice2",
           {run, what, fmt::format("{:.4f} ± {:.4f}", g4.value, g4.error),
            fmt::format("{:.4f} ± {:.4f}", own.value, own.error), fmt::format("{:.2f}", sigmas(g4, own))});
  CHECK(sigmas(g4, own) < kSigmas);
}

void compare_means(const BoundaryRun& run, const std::string& side, double count,
                   const std::array<Moments, 3>& ours) {
  if (count < 2.0) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Spread& spread = run.means.at(std::string(1, "XYZ"[axis]) + " " + side);
    // Single precision of Geant4's histograms; where all photons have one direction there is no spread.
    const Estimate g4{spread.mean, std::hypot(spread.rms / std::sqrt(count), 1e-6)};
    CAPTURE(side);
    CAPTURE(axis);
    CAPTURE(g4.value);
    CAPTURE(ours[axis].mean().value);
    CHECK(sigmas(g4, ours[axis].mean()) < kSigmas);
  }
}

}  // namespace

TEST_CASE("OpNovice2 boundary: every finish of UNIFIED and GLISUR, on dielectrics and metals, agrees") {
  const auto path = shared_file("reference/geant4_opnovice2/boundary.out");
  if (!path) return;
  std::size_t compared = 0;
  for (const BoundaryRun& run : runs_of(*path)) {
    if (run.model != "unified" && run.model != "glisur") continue;  // LUT, DAVIS: without their tables
    const std::string name = run.model + ", " + run.type + ", " + run.finish +
                             (run.roughness_mm > 0.0 ? ", SURFACEROUGHNESS" : "");
    CAPTURE(name);
    double photons = 0.0;
    for (const auto& [process, count] : run.counts) photons += count;
    REQUIRE(photons > 9000.0);
    const Ours ours = send(imported(run));
    const double inside = photons - run.outside() - run.absorbed();
    compare_shares(name, "reflected", inside, photons, ours.inside);
    compare_means(run, "backward", inside, ours.backward);
    compare_shares(name, "transmitted", run.outside(), photons, ours.outside);
    compare_shares(name, "absorbed", run.absorbed(), photons, ours.absorbed);
    // At steep facets before paint Geant4 ends some light as refracted that is on its way to the paint again
    // (G4OpBoundaryProcess::DielectricDielectric: its flag `swap` after two refractions). It is among
    // "Fresnel refraction", and among the forward directions, which are not comparable.
    if (run.model != "glisur" || run.finish != "groundbackpainted")
      compare_means(run, "forward", run.outside(), ours.forward);
    ++compared;
  }
  CHECK(compared == 18);
}

TEST_CASE("OpNovice2 fresnel: reflection, total reflection and refraction by polarisation agree") {
  const auto path = shared_file("reference/geant4_opnovice2/fresnel.out");
  if (!path) return;
  std::ifstream file(*path);
  std::vector<std::map<std::string, double>> runs;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("Surface events by process:")) runs.emplace_back();
    const std::size_t colon = line.find(':');
    if (!runs.empty() && colon != std::string::npos &&
        (line.starts_with("  Fresnel") || line.starts_with("  Total internal")))
      runs.back()[line.substr(2, colon - 2)] = std::stod(line.substr(colon + 1));
  }
  REQUIRE(runs.size() == 2);
  constexpr double n1 = 1.405, n2 = 1.01;
  for (std::size_t run = 0; run < 2; ++run) {  // p, then s
    CAPTURE(run);
    std::uint64_t reflected = 0, total = 0, refracted = 0;
    for (std::uint64_t i = 0; i < kPhotons; ++i) {
      Rng rng(32, StreamKind::other, i);
      // In the example the angle is uniform, not the direction.
      const double angle = 0.5 * kPi * rng.uniform();
      Ray ray{Vec3(std::cos(angle), std::sin(angle), 0.0), Vec3::UnitZ()};
      if (run == 0) ray.polarisation = Vec3(-std::sin(angle), std::cos(angle), 0.0);
      const bool beyond = Refraction(std::cos(angle), n1, n2).total();
      if (interact_at_facet(ray, -Vec3::UnitX(), n1, n2, rng))
        ++refracted;
      else
        ++(beyond ? total : reflected);
    }
    double photons = 0.0;
    for (const auto& [process, count] : runs[run]) photons += count;
    const std::string name = run == 0 ? "p" : "s";
    compare_shares(name, "Fresnel reflection", runs[run]["Fresnel reflection"], photons, reflected);
    compare_shares(name, "refraction", runs[run]["Fresnel refraction"], photons, refracted);
    // Light near grazing has a longer way through the absorbing box, 0.1 mm thick: 0.3 % of it is missing.
    const Estimate g4 = binomial_estimate(static_cast<std::uint64_t>(runs[run]["Total internal reflection"]),
                                          static_cast<std::uint64_t>(photons));
    CHECK(std::abs(g4.value - binomial_estimate(total, kPhotons).value) < 0.006);
  }
}

TEST_CASE("OpNovice2 coated and complexRindex: a film and aluminium reflect as in Geant4's outputs") {
  // Counts of coated.out and complexRindex.out of Geant4 11.4 (examples/extended/optical/OpNovice2, read).
  const Film film{1.7, 100.0};
  const double reflectance = film_response(1.0, 1.4, {&film, 1}, 1.0, 1239.841984 / 5.0).reflectance();
  for (const auto& [reflected, of] : {std::pair{53'700.0, 499'758.0}, std::pair{53'778.0, 499'765.0}}) {
    const Estimate g4 =
        binomial_estimate(static_cast<std::uint64_t>(reflected), static_cast<std::uint64_t>(of));
    CAPTURE(g4.value);
    CAPTURE(reflectance);
    CHECK(sigmas(g4, {reflectance, 0.0}) < kSigmas);
  }
  // Aluminium at 4 eV around a box of air, index 1.01, of 2 m; light starts 10 cm before its +X face, with
  // angles to X uniform between 0 and 90 deg, so that some of it reaches the sides first.
  const auto reflected_share = [](bool polarised_p) {
    Moments share;
    for (std::uint64_t i = 0; i < kPhotons; ++i) {
      Rng rng(33, StreamKind::other, i);
      const double angle = 0.5 * kPi * rng.uniform(), turn = kTwoPi * rng.uniform();
      const Vec3 direction(std::cos(angle), std::sin(angle) * std::sin(turn),
                           std::sin(angle) * std::cos(turn));
      const Vec3 across = Vec3::UnitX().cross(direction).normalized();
      const Vec3 field = polarised_p ? Vec3(across.cross(direction)) : across;
      int axis = 0;
      const Vec3 way = Vec3(100.0, 1000.0, 1000.0).cwiseQuotient(direction.cwiseAbs());
      way.minCoeff(&axis);
      const Vec3 normal = Vec3::Unit(axis);
      const double s = field.dot(direction.cross(normal).normalized());
      const FilmResponse metal = film_response(std::abs(direction.dot(normal)), 1.01, {},
                                               std::complex<double>(0.28, 3.71), 1239.841984 / 4.0);
      share.add(s * s * metal.reflectance_s + (1.0 - s * s) * metal.reflectance_p);
    }
    return share.mean();
  };
  CHECK(sigmas(binomial_estimate(449'293, 499'911), reflected_share(true)) < kSigmas);
  CHECK(sigmas(binomial_estimate(474'561, 499'907), reflected_share(false)) < kSigmas);
}
