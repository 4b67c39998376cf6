// Prints scenes/spectra/lso_511keV.csv: what a crystal of LSO sees of 511 keV gammas, blurred as a detector
// of 22 % resolution would.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/gamma_source.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/source/event.hpp"

namespace {

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;

constexpr double kResolution = 0.22;  // full width at half maximum over 511 keV
constexpr double kPeak_keV = 511.0;
constexpr double kBin_keV = 10.0;
constexpr std::size_t kBins = 80;

const char* const kScene = R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "LSO"
surface = "polished"
[source]
type = "photons"
position = ["0 mm", "0 mm", "10 mm"]
direction = "isotropic"
wavelength = "420 nm"
photons = 1
)";

const char* const kSource = R"(
type = "gammas"
emission = "gamma"
energy = "511 keV"
events = 1000000
plane = { center = ["-50 mm", "0 mm", "10 mm"], x = ["0 mm", "2 mm", "0 mm"], y = ["0 mm", "0 mm", "20 mm"] }
direction = [1, 0, 0]
)";

/// Share of a normal distribution below x.
double below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Adds an energy to the bins as a detector blurs it: its variance goes with the energy.
void add_blurred(double energy_keV, std::vector<double>& bins) {
  const double sigma_keV = kResolution * kPeak_keV / kFwhmPerSigma * std::sqrt(energy_keV / kPeak_keV);
  double before = 0.0;  // what would fall below zero goes to the first bin
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    const double up_to = below((kBin_keV * static_cast<double>(bin + 1) - energy_keV) / sigma_keV);
    bins[bin] += up_to - before;
    before = up_to;
  }
}

std::vector<double> spectrum() {
  const BuiltScene built = SceneBuilder().build(SceneFile::from_text(kScene, "crystal.toml").spec(0));
  Problems problems;
  const TomlTable table(parse_toml(kSource, "source.toml"), problems);
  const GammaSpec spec = read_gamma_source(table, {"crystal"});
  table.finish();
  problems.throw_if_any();
  const auto source = make_event_source(spec, built.scene);
  std::vector<double> bins(kBins, 0.0);
  for (std::uint64_t event = 0; event < source->events(); ++event) {
    Rng rng(1, StreamKind::event, event);
    double energy_keV = 0.0;
    for (const Deposit& deposit : source->make(built.scene, event, rng).deposits)
      energy_keV += deposit.energy_keV;
    if (energy_keV > 0.0) add_blurred(energy_keV, bins);
  }
  return bins;
}

}  // namespace

int main() {
  try {
    const std::vector<double> bins = spectrum();
    fmt::print(
        "# Made by ScintRay's gamma transport (tools/spectrum), not measured: 511 keV gammas straight onto "
        "a\n"
        "# side of 2 x 20 mm2 of a crystal of LSO of 2 x 2 x 20 mm3 in empty space, the energy left in it\n"
        "# blurred to {:g} % full width at half maximum at 511 keV, the width going with the square root of\n"
        "# the energy. Counts of 1 million gammas in bins of {:g} keV, at their middles.\n"
        "energy_keV,counts\n",
        100.0 * kResolution, kBin_keV);
    for (std::size_t bin = 0; bin < bins.size(); ++bin)
      fmt::print("{:g},{:.1f}\n", kBin_keV * (static_cast<double>(bin) + 0.5), bins[bin]);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
