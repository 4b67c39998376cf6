#include "scintray/simulation/detail/backward_response.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "scintray/core/in_order.hpp"
#include "scintray/simulation/detail/journal_pieces.hpp"
#include "scintray/simulation/detail/map_shard.hpp"
#include "scintray/simulation/detail/response_pieces.hpp"

namespace scintray::simulation {

namespace {

/// Points at which a cell on the boundary of its region is sampled for the volume within.
constexpr std::uint32_t kVolumePoints = 1024;
/// Point number i of the sequence of multiples of (1/g, 1/g^2, 1/g^3) modulo 1, g^4 = g + 1: even over the
/// unit cube.
core::Vec3 even_point(std::uint32_t i) {
  constexpr double kRoot = 1.2207440846057596;
  const double n = i + 0.5;
  core::Vec3 point(n / kRoot, n / (kRoot * kRoot), n / (kRoot * kRoot * kRoot));
  for (int axis = 0; axis < 3; ++axis) point[axis] -= std::floor(point[axis]);
  return point;
}

/// Share of a cell that lies within the region.
double share_within(const scene::Scene& scene, core::RegionId region, const Eigen::AlignedBox3d& cell) {
  if (scene.region_contains(region, cell)) return 1.0;
  std::uint32_t inside = 0;
  for (std::uint32_t i = 0; i < kVolumePoints; ++i)
    if (scene.region_contains(region, core::Vec3(cell.min() + cell.sizes().cwiseProduct(even_point(i)))))
      ++inside;
  return static_cast<double>(inside) / kVolumePoints;
}

/// Volumes of the region within the cells of its grid, mm3.
std::vector<double> volumes_of(const scene::Scene& scene, const ResponseGrid& grid, int threads) {
  std::vector<double> volumes(grid.size());
  const auto of = [&](std::uint64_t cell) {
    return grid.pitch.prod() * share_within(scene, grid.region, cell_box(grid, cell));
  };
  core::work_in_order(grid.size(), threads, nullptr, of,
                      [&](std::uint64_t cell, double volume) { volumes[cell] = volume; });
  return volumes;
}

/// Of each grid the number of its medium: of the media in the order of their ids, from 0.
std::vector<std::uint32_t> media_of(const scene::Scene& scene, const ResponseMap& map) {
  std::map<core::MediumId, std::uint32_t> numbers;
  for (const ResponseGrid& grid : map.grids) numbers[scene.regions[grid.region].medium] = 0;
  std::uint32_t next = 0;
  for (auto& [medium, number] : numbers) number = next++;
  std::vector<std::uint32_t> media;
  for (const ResponseGrid& grid : map.grids) media.push_back(numbers.at(scene.regions[grid.region].medium));
  return media;
}

}  // namespace

bool trace_backward(const scene::Scene& scene, const tally::ReadoutChannels& channels, const RunSettings& run,
                    const ResponseHooks& hooks, ResponseMap& map) {
  const std::vector<std::uint32_t> media = media_of(scene, map);
  ChannelAssembly assembly(map, media);
  std::vector<BackwardTracer> tracers;
  for (std::size_t medium = 0; medium < assembly.media(); ++medium) {
    std::vector<const ResponseGrid*> grids;
    std::vector<std::vector<double>> volumes;
    for (ResponseGrid* const grid : assembly.grids_of(medium)) {
      volumes.push_back(volumes_of(scene, *grid, run.threads));
      for (const double volume : volumes.back())
        grid->photons.push_back(volume > 0.0 ? map.photons_started() : 0);
      grids.push_back(grid);
    }
    tracers.emplace_back(scene, channels, map, std::move(grids), std::move(volumes), run);
  }
  if (hooks.shard) hooks.shard->begin(map, media);
  const tally::BlockRange pieces =
      hooks.shard ? hooks.shard->of(assembly.pieces()) : tally::BlockRange{0, assembly.pieces()};
  const auto photons_of = [&](const ChannelAssembly::Place& at) {
    return tally::BlockRange{map.photons_per_channel * at.part / at.parts,
                             map.photons_per_channel * (at.part + 1) / at.parts};
  };
  std::uint64_t done = 0, total = 0;
  for (std::uint64_t piece = pieces.first; piece < pieces.last; ++piece)
    total += photons_of(assembly.place(piece)).count();
  const auto trace = [&](std::uint64_t number) {
    const std::uint64_t piece = pieces.first + number;
    const std::string key = assembly.key(piece);
    ChannelLight light;
    if (detail::find_piece(hooks.journal, key, light.sum, light.squares, light.photons, light.delays_ns))
      return light;
    const ChannelAssembly::Place at = assembly.place(piece);
    const tally::BlockRange photons = photons_of(at);
    light = tracers[at.medium].trace(at.channel, at.stream, photons.first, photons.last);
    detail::add_piece(hooks.journal, key, light.sum, light.squares, light.photons, light.delays_ns);
    return light;
  };
  const auto collect = [&](std::uint64_t number, ChannelLight& light) {
    const std::uint64_t piece = pieces.first + number;
    if (hooks.shard)
      hooks.shard->add(piece, light);
    else
      assembly.add(piece, light);
    done += photons_of(assembly.place(piece)).count();
    if (hooks.progress) hooks.progress(done, total);
  };
  return core::work_in_order(pieces.count(), run.threads, hooks.stop, trace, collect) == pieces.count();
}

std::string why_not_backward(const scene::Scene& scene) {
  for (const core::MediumId id : scene.media.ids()) {
    const optics::Medium& medium = scene.media[id].medium();
    if (medium.shifter) return "medium \"" + medium.name + "\" shifts wavelengths";
    if (medium.birefringence) return "medium \"" + medium.name + "\" is birefringent";
  }
  for (const core::SensorId id : scene.sensors.ids()) {
    const detector::Sensor& sensor = scene.sensors[id];
    if (sensor.converts_absorbed())
      return "sensor \"" + sensor.name + "\" converts light that surfaces absorb";
    if (sensor.over_face)
      return "the efficiency of sensor \"" + sensor.name + "\" depends on the place on its face";
  }
  const tally::ReadoutChannels channels(scene);
  for (const core::InterfaceId id : scene.interfaces.ids()) {
    const scene::Interface& interface = scene.interfaces[id];
    const bool both = interface.back_surface.has_value() && interface.front_surface.has_value();
    if (both && !interface.gap_medium.has_value())
      return "the surface \"" + scene.surfaces[interface.back_surface].definition +
             "\" is for light of one direction";
    for (const core::SurfaceId surface : {interface.back_surface, interface.front_surface}) {
      if (!surface.has_value()) continue;
      const std::string why = scene.surfaces[surface].why_not_reciprocal();
      if (!why.empty()) return "surface \"" + scene.surfaces[surface].definition + "\": " + why;
    }
    for (const bool from_back : {false, true})
      if (channels.at_crossing[id][from_back].has_value() &&
          (scene.regions[interface.back].curved || scene.regions[interface.front].curved))
        return "the sensor of channel \"" + channels.list[channels.at_crossing[id][from_back].index()].name +
               "\" is on a part with round faces";
  }
  return {};
}

}  // namespace scintray::simulation
