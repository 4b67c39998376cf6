#pragma once
/// A result that no run made, with every field filled, for tests of files and pages.

#include <cmath>
#include <cstdlib>

#include "scintray/analysis/light_analysis.hpp"

namespace scintray::test {

/// One point whose detected fraction is near `light`; every count is consistent with the others.
inline tally::PointResult made_up_point(std::vector<std::string> parameters, double light,
                                        std::uint64_t photons) {
  tally::PointResult point;
  point.parameters = std::move(parameters);
  point.photons_requested = point.emitted = point.photons = photons;
  point.complete = true;
  const auto share = [&](double fraction) {
    return static_cast<std::uint64_t>(fraction * static_cast<double>(photons));
  };
  const std::uint64_t detected = share(light);
  point.fates = {detected, share(0.21 * light), share(0.07), 0, share(0.04), share(0.0004), share(0.0001)};
  std::uint64_t sum = 0;
  for (const std::uint64_t count : point.fates) sum += count;
  point.fates[core::fate_index(core::Fate::absorbed_at_surface)] = photons - sum;
  point.absorbed_in_medium = {share(0.066), share(0.07) - share(0.066), 0};
  const std::uint64_t absorbed = point.count(core::Fate::absorbed_at_surface);
  point.absorbed_at_surface = {absorbed - absorbed / 9, absorbed / 9};
  const auto energy = static_cast<double>(share(0.02));
  point.shifted_in_medium = {
      {}, {share(0.03), share(0.02), share(0.005), 3.1 * energy, 2.4 * energy, 31.0}, {}};
  point.shifted_at_surface = {{}, {share(0.01), share(0.004), 0, 0.5 * energy, 0.4 * energy, 1.5}};
  point.sensor_faces = {
      {core::PartId(1), core::FaceId(2), detected - detected / 40, point.count(core::Fate::not_detected)},
      {core::PartId(1), core::FaceId(1), detected / 40, 0}};
  for (const bool detected_only : {false, true}) {
    analysis::CrossingAngles angles;
    angles.name = detected_only ? "exit face, detected" : "exit face, all";
    angles.face = "crystal:exit";
    angles.detected_only = detected_only;
    for (int bin = 0; bin < 90; ++bin) {
      const double angle = (bin + 0.5) * 3.14159265358979 / 180.0;
      const double shape = std::sin(2.0 * angle) * std::exp(-std::pow(angle / 0.9, 4.0)) + 0.01;
      const double beyond = std::sin(2.0 * angle) * (bin > 60 ? 1.6 : 1.0);
      angles.inside.push_back(share((detected_only ? 0.01 : 0.02) * shape));
      angles.outside.push_back(share((detected_only ? 0.008 : 0.016) * beyond));
    }
    for (tally::TallyResult& tally : analysis::tallies_of(angles)) point.tallies.push_back(std::move(tally));
  }
  for (int i = 0; i < 1000; ++i) {
    point.interactions.add(std::fmod(i * 7.3, 40.0));
    point.detected_path_mm.add(20.0 + std::fmod(i * 3.7, 120.0));
    point.detected_time_ns.add(0.1 + std::fmod(i * 0.37, 30.0));
    point.detected_interactions.add(std::fmod(i * 1.7, 30.0));
  }
  for (std::size_t bin = 0; bin < point.detected_path_histogram.size(); ++bin) {
    const double x = static_cast<double>(bin);
    point.detected_path_histogram[bin] =
        static_cast<std::uint64_t>(static_cast<double>(detected) * 0.28 * x * std::exp(-0.53 * x));
  }
  point.scatterings = photons / 50;
  point.segments = photons * 21;
  point.resolved_misses = 3;
  point.wall_seconds = static_cast<double>(photons) * 1.1e-6;
  return point;
}

/// Light output against depth for three surface models.
inline tally::RunResult made_up_run() {
  tally::RunResult run;
  tally::RunHeader& header = run.header;
  header.title = "Light output against depth, LSO 2 x 2 x 20 mm in air";
  header.version = "0.1.0";
  header.scene_file = "scenes/depth.toml";
  header.scene_text =
      "title = \"Light output against depth\"\nambient = \"air\"\n\n[[part]]\nname = \"crystal\"\n"
      "box = [\"2 mm\", \"2 mm\", \"20 mm\"]  # a < b & c > \"d\"\n";
  header.seed = 0xfedcba9876543210ULL;
  header.sweep_keys = {"part.crystal.surface", "source.region.slab_z.center"};
  header.media = {"LSO", "optical_grease", "air"};
  header.surfaces = {"ground, table", "reflector: ESR"};
  header.parts = {"crystal", "pmt"};
  header.faces = {"crystal:exit", "pmt:side", "pmt:window"};
  header.note = "LSO: no absorption length given below 380 nm; the first value is used\nsecond warning";
  struct Model {
    const char* name;
    double at_window, slope;
  };
  for (const Model& model : {Model{"polished", 0.452, 0.0009}, Model{"ground, table", 0.424, 0.0122},
                             Model{"ground, UNIFIED", 0.367, 0.0061}})
    for (const char* depth : {"2 mm", "6 mm", "10 mm", "14 mm", "18 mm"})
      run.points.push_back(made_up_point({model.name, depth},
                                         model.at_window - model.slope * (std::atof(depth) - 2.0), 187'500));
  return run;
}

}  // namespace scintray::test
