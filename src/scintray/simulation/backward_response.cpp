#include "scintray/simulation/detail/backward_response.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scintray/core/in_order.hpp"
#include "scintray/simulation/detail/journal_pieces.hpp"

namespace scintray::simulation {

namespace {

/// Points at which a cell on the boundary of its region is sampled for the volume within.
constexpr std::uint32_t kVolumePoints = 1024;
/// Random streams of backward light begin here; those of the cells of forward maps are numbered from 0.
constexpr std::uint64_t kBackwardStreams = std::uint64_t{1} << 40;
/// Pieces into which the photons of a channel are divided, so that one channel occupies many threads; maps
/// whose times of flight are large have one, as every piece has its own.
constexpr std::uint64_t kPieces = 8, kLargeDelays = 20'000'000;

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

/// The grids of one medium, whose light has one spectrum.
struct MediumGrids {
  std::vector<ResponseGrid*> grids;
};

std::vector<MediumGrids> by_medium(const scene::Scene& scene, ResponseMap& map) {
  std::map<core::MediumId, MediumGrids> media;
  for (ResponseGrid& grid : map.grids) media[scene.regions[grid.region].medium].grids.push_back(&grid);
  std::vector<MediumGrids> list;
  for (auto& [medium, grids] : media) list.push_back(std::move(grids));
  return list;
}

/// Moves the light of all channels into the grids of one medium.
class GridFiller {
 public:
  GridFiller(ResponseMap& map, const std::vector<ResponseGrid*>& grids, std::vector<ChannelLight> channels)
      : map_(map), grids_(grids), channels_(std::move(channels)) {}

  void fill(const BackwardTracer& tracer) {
    for (std::size_t i = 0; i < grids_.size(); ++i) {
      ResponseGrid& grid = *grids_[i];
      for (std::size_t cell = 0; cell < grid.size(); ++cell)
        for (const ChannelLight& light : channels_) add(grid, light, tracer.first_cells()[i] + cell);
    }
  }

 private:
  void add(ResponseGrid& grid, const ChannelLight& light, std::size_t cell) const {
    const auto photons = static_cast<double>(map_.photons_per_channel);
    const double mean = light.sum[cell] / photons;
    const double variance = std::max(0.0, light.squares[cell] / photons - mean * mean) / photons;
    grid.detected.push_back(light.photons[cell]);
    grid.probabilities.push_back(static_cast<float>(mean));
    grid.probability_errors.push_back(static_cast<float>(std::sqrt(variance)));
    const float* const delays = light.delays_ns.data() + cell * map_.delays_kept;
    grid.delays_ns.insert(grid.delays_ns.end(), delays, delays + map_.kept(light.photons[cell]));
  }

  ResponseMap& map_;
  const std::vector<ResponseGrid*>& grids_;
  std::vector<ChannelLight> channels_;
};

/// Progress over all media.
struct Work {
  std::uint64_t done = 0, total = 0;
};

/// Light of all channels through the grids of one medium; nothing when stopped.
std::optional<std::vector<ChannelLight>> trace_medium(const BackwardTracer& tracer,
                                                      std::uint64_t first_stream, const RunSettings& run,
                                                      const ResponseHooks& hooks, const ResponseMap& map,
                                                      Work& work) {
  const std::uint64_t pieces = tracer.cells() * map.delays_kept > kLargeDelays ? 1 : kPieces;
  const std::uint64_t channels = map.channels.size(), photons = map.photons_per_channel;
  std::vector<ChannelLight> lights(channels);
  const auto trace = [&](std::uint64_t number) {
    const std::uint64_t channel = number / pieces, piece = number % pieces;
    const std::string key = detail::encoded(first_stream + channel, piece);  // longer than that of a cell
    ChannelLight light;
    if (detail::find_piece(hooks.journal, key, light.sum, light.squares, light.photons, light.delays_ns))
      return light;
    light = tracer.trace(channel, first_stream + channel, photons * piece / pieces,
                         photons * (piece + 1) / pieces);
    detail::add_piece(hooks.journal, key, light.sum, light.squares, light.photons, light.delays_ns);
    return light;
  };
  const auto collect = [&](std::uint64_t number, ChannelLight& light) {
    const std::uint64_t channel = number / pieces, piece = number % pieces;
    core::Rng rng(run.seed, core::StreamKind::cell, first_stream + channels + channel, piece);
    if (piece == 0)
      lights[channel] = std::move(light);
    else
      lights[channel].add(light, map.delays_kept, rng);
    work.done += photons / pieces;
    if (hooks.progress) hooks.progress(std::min(work.done, work.total), work.total);
  };
  const std::uint64_t done = core::work_in_order(channels * pieces, run.threads, hooks.stop, trace, collect);
  if (done < channels * pieces) return std::nullopt;
  return lights;
}

}  // namespace

bool trace_backward(const scene::Scene& scene, const tally::ReadoutChannels& channels, const RunSettings& run,
                    const ResponseHooks& hooks, ResponseMap& map) {
  const std::vector<MediumGrids> media = by_medium(scene, map);
  Work work{0, map.photons_per_channel * map.channels.size() * media.size()};
  std::uint64_t stream = kBackwardStreams;
  for (const MediumGrids& medium : media) {
    std::vector<const ResponseGrid*> grids;
    std::vector<std::vector<double>> volumes;
    for (ResponseGrid* const grid : medium.grids) {
      volumes.push_back(volumes_of(scene, *grid, run.threads));
      for (const double volume : volumes.back())
        grid->photons.push_back(volume > 0.0 ? map.photons_started() : 0);
      grids.push_back(grid);
    }
    const BackwardTracer tracer(scene, channels, map, std::move(grids), std::move(volumes), run);
    std::optional<std::vector<ChannelLight>> lights = trace_medium(tracer, stream, run, hooks, map, work);
    if (!lights) return false;
    GridFiller(map, medium.grids, std::move(*lights)).fill(tracer);
    stream += 2 * map.channels.size();
  }
  return true;
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
