#include "scintray/simulation/response_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/core/in_order.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/simulation/detail/backward_response.hpp"
#include "scintray/simulation/detail/journal_pieces.hpp"
#include "scintray/simulation/detail/map_shard.hpp"
#include "scintray/simulation/detail/response_pieces.hpp"
#include "scintray/source/photon_optics.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::simulation {

namespace {

/// Points sampled in a cell to find whether it contains part of its region: one that fills less than a
/// hundredth of its cell is missed once in ten times, and then has its neighbours' response.
constexpr int kSurveyDraws = 256;
/// Trials after which a photon of a non-empty cell is treated as being in a sliver.
constexpr int kMostDraws = 1'000'000;
/// Address of the random stream of a cell's test points, which no photon has.
constexpr std::uint64_t kSurvey = std::numeric_limits<std::uint64_t>::max();

/// Traces cells of one grid.
class CellTracer {
 public:
  CellTracer(const scene::Scene& scene, const tally::ReadoutChannels& channels, const ResponseMap& map,
             const ResponseGrid& grid, const RunSettings& run)
      : scene_(scene),
        channels_(channels),
        map_(map),
        grid_(grid),
        run_(run),
        efficiency_bound_(efficiency_bound(scene)) {
    medium_ = scene.regions[grid.region].medium;
    emission_ = core::CurveSampler(scene.media[medium_].medium().emission);
  }

  /// @param address  of the cell among those of all grids, for its streams
  CellResponse trace(std::size_t cell, std::uint64_t address) const {
    CellResponse response;
    response.detected.resize(channels_.list.size());
    response.delays_ns.resize(channels_.list.size());
    const Eigen::AlignedBox3d box = cell_box(grid_, cell);
    if (!holds_something(box, address)) return response;
    for (std::uint32_t photon = 0; photon < map_.photons_per_cell; ++photon)
      trace_photon(box, address, photon, response);
    return response;
  }

 private:
  static core::Vec3 point_in(const Eigen::AlignedBox3d& box, core::Rng& rng) {
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    return box.min() + box.sizes().cwiseProduct(core::Vec3(x, y, z));
  }

  bool holds_something(const Eigen::AlignedBox3d& box, std::uint64_t address) const {
    core::Rng rng(run_.seed, core::StreamKind::cell, address, kSurvey);
    for (int draw = 0; draw < kSurveyDraws; ++draw)
      if (scene_.region_contains(grid_.region, point_in(box, rng))) return true;
    return false;
  }

  /// A point of the region within the cell; false when none is found.
  bool place(const Eigen::AlignedBox3d& box, core::Rng& rng, core::PlainVec3& position) const {
    for (int draw = 0; draw < kMostDraws; ++draw) {
      position = point_in(box, rng);
      if (scene_.region_contains(grid_.region, position)) return true;
    }
    return false;
  }

  void trace_photon(const Eigen::AlignedBox3d& box, std::uint64_t address, std::uint32_t number,
                    CellResponse& response) const {
    core::Rng rng(run_.seed, core::StreamKind::cell, address, number);
    source::Photon photon;
    if (!place(box, rng, photon.position)) return;
    ++response.photons;
    photon.conversion_draw = rng.uniform();
    if (photon.conversion_draw >= efficiency_bound_) return;  // no sensor would convert it
    photon.region = grid_.region;
    photon.ray.direction = core::sample_isotropic(rng);
    photon.ray.polarisation = map_.unpolarised ? core::Vec3(core::Vec3::Zero())
                                               : core::sample_polarisation(photon.ray.direction, rng);
    photon.ray.keeps_phases = scene_.keeps_phases;
    photon.wavelength_nm = emission_.sample(rng.uniform());
    photon.optics = scene_.optics.at(medium_, photon.wavelength_nm);
    photon.optical_depth = core::sample_exponential(rng);
    source::emit_isotropic(scene_, photon, rng);
    const transport::PropagationLimits limits = limits_of(run_);
    for (;;) {
      const transport::Step taken = transport::step(scene_, photon, rng, limits);
      if (taken.event == core::StepEvent::detected) {
        const std::uint32_t channel = channels_.at(taken);
        if (response.detected[channel]++ < map_.delays_kept)
          response.delays_ns[channel].push_back(static_cast<float>(photon.time_ns));
      }
      if (core::is_final(taken.event) || limits.reached(photon)) return;
    }
  }

  const scene::Scene& scene_;
  const tally::ReadoutChannels& channels_;
  const ResponseMap& map_;
  const ResponseGrid& grid_;
  const RunSettings& run_;
  double efficiency_bound_;
  core::MediumId medium_;
  core::CurveSampler emission_;
};

/// A map holds the response to one photon, which is then one photon at most at a sensor.
void refuse_multiplication(const scene::Scene& scene) {
  if (multiplies_light(scene))
    throw core::InputError({{},
                            "a wavelength shifter may re-emit several photons for one, and a response map "
                            "counts one photon at most for each",
                            "trace the scene without a map, or state statistics = \"single\""});
}

/// A piece that may be of a journal.
struct FoundCell {
  CellResponse response;
  bool is_earlier = false;
};

/// Traces the cells of all grids, or those of a shard; false when stopped.
bool trace_forward(const scene::Scene& scene, const tally::ReadoutChannels& channels, const RunSettings& run,
                   const ResponseHooks& hooks, ResponseMap& map) {
  CellAssembly assembly(map);
  std::vector<CellTracer> tracers;
  for (const ResponseGrid& grid : map.grids) tracers.emplace_back(scene, channels, map, grid, run);
  if (hooks.shard) hooks.shard->begin(map, std::vector<std::uint32_t>(map.grids.size(), 0));
  const tally::BlockRange pieces =
      hooks.shard ? hooks.shard->of(assembly.pieces()) : tally::BlockRange{0, assembly.pieces()};
  const auto trace = [&](std::uint64_t number) {
    const std::uint64_t piece = pieces.first + number;
    FoundCell found;
    CellResponse& cell = found.response;
    found.is_earlier = detail::find_piece(hooks.journal, CellAssembly::key(piece), cell.photons,
                                          cell.detected, cell.delays_ns);
    if (found.is_earlier) return found;
    const CellAssembly::Place at = assembly.place(piece);
    cell = tracers[at.grid].trace(at.cell, piece);
    return found;
  };
  const auto collect = [&](std::uint64_t number, const FoundCell& found) {
    const std::uint64_t piece = pieces.first + number;
    const CellResponse& cell = found.response;
    if (hooks.shard)
      hooks.shard->add(piece, cell);
    else
      assembly.add(piece, cell);
    if (!found.is_earlier)
      detail::add_piece(hooks.journal, CellAssembly::key(piece), cell.photons, cell.detected, cell.delays_ns);
    if (hooks.progress) hooks.progress(number + 1, pieces.count());
  };
  return core::work_in_order(pieces.count(), run.threads, hooks.stop, trace, collect) == pieces.count();
}

/// Whether the map is traced backward. @throws InputError where that is requested and not exact
bool traces_backward(const scene::Scene& scene, MapDirection direction) {
  if (direction == MapDirection::forward) return false;
  const std::string why = why_not_backward(scene);
  if (why.empty()) return true;
  if (direction == MapDirection::automatic) return false;
  throw core::InputError({{},
                          "light cannot be traced backward from the channels: " + why,
                          "trace the map forward, from its cells"});
}

}  // namespace

Eigen::AlignedBox3d cell_box(const ResponseGrid& grid, std::size_t cell) {
  const std::size_t z = cell % grid.cells[2], rest = cell / grid.cells[2];
  const core::Vec3 at(static_cast<double>(rest / grid.cells[1]), static_cast<double>(rest % grid.cells[1]),
                      static_cast<double>(z));
  const core::Vec3 low = grid.low + grid.pitch.cwiseProduct(at);
  return {low, core::Vec3(low + grid.pitch)};
}

core::Estimate ResponseGrid::estimate(std::size_t cell, std::size_t response) const {
  if (probabilities.empty()) return core::binomial_estimate(detected[response], photons[cell]);
  return {double{probabilities[response]}, double{probability_errors[response]}};
}

std::vector<ResponseGrid> lay_grids(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                                    double pitch_mm) {
  std::vector<ResponseGrid> grids;
  for (const core::RegionId region : regions) {
    const core::PartId part = scene.regions[region].part;
    if (!part.has_value()) continue;
    const scene::PartInfo& info = scene.parts[part];
    ResponseGrid grid;
    grid.part = info.name;
    grid.region = region;
    grid.low = info.bounds.min();
    for (int axis = 0; axis < 3; ++axis) {
      const double size = info.bounds.sizes()[axis];
      // Rounding must not make an eleventh cell of 10 mm at a pitch of 1 mm.
      const double count = std::max(1.0, std::ceil(size / pitch_mm - 1e-6));
      if (count > 1e6)
        throw core::InputError({{},
                                "cells of " + std::to_string(pitch_mm) + " mm are " + std::to_string(count) +
                                    " along one edge of \"" + info.name + "\"",
                                "choose a larger pitch"});
      grid.cells[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(count);
      grid.pitch[axis] = size / count;
    }
    grids.push_back(std::move(grid));
  }
  if (grids.empty())
    throw core::InputError({{},
                            "no part scintillates, so there is no light to map",
                            "give the medium of a part [yield], [emission] and [[decay]]"});
  return grids;
}

ResponseMap build_response_map(const scene::Scene& scene, const std::vector<core::RegionId>& regions,
                               bool unpolarised, const ResponseSettings& settings, const RunSettings& run,
                               const ResponseHooks& hooks) {
  const tally::ReadoutChannels channels(scene);
  if (channels.list.empty())
    throw core::InputError({{}, "the scene has no sensor", "assign a sensor to a part or a face"});
  refuse_multiplication(scene);
  ResponseMap map;
  for (const tally::ReadoutChannel& channel : channels.list) map.channels.push_back(channel.name);
  map.seed = run.seed;
  if (traces_backward(scene, settings.direction))
    map.photons_per_channel = settings.photons_per_channel;
  else
    map.photons_per_cell = settings.photons_per_cell;
  map.delays_kept = settings.delays_kept;
  map.unpolarised = unpolarised;
  map.grids = lay_grids(scene, regions, settings.pitch_mm);
  refuse_too_large(map);
  const bool complete = map.backward() ? trace_backward(scene, channels, run, hooks, map)
                                       : trace_forward(scene, channels, run, hooks, map);
  if (!complete) map.grids.clear();
  return map;
}

}  // namespace scintray::simulation
