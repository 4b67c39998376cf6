#include "scintray/simulation/detail/response_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/simulation/detail/byte_archive.hpp"

namespace scintray::simulation {

namespace {

/// Random streams of backward light begin here; those of the cells of forward maps are numbered from 0.
constexpr std::uint64_t kBackwardStreams = std::uint64_t{1} << 40;
/// Parts into which the photons of a channel are divided, so that one channel occupies many threads; maps
/// whose times of flight are large have one, as every part has its own.
constexpr std::uint64_t kParts = 8, kLargeDelays = 20'000'000;

/// Number of the last of ascending `first` that is not above `piece`.
std::size_t holder_of(const std::vector<std::uint64_t>& first, std::uint64_t piece) {
  return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), piece) - first.begin()) - 1;
}

bool is_time(float delay) { return std::isfinite(delay) && delay >= 0.0f; }

/// Probabilities of a cell from the light of one channel.
void append(ResponseGrid& grid, const ChannelLight& light, std::size_t cell, const ResponseMap& map) {
  const auto photons = static_cast<double>(map.photons_per_channel);
  const double mean = light.sum[cell] / photons;
  const double variance = std::max(0.0, light.squares[cell] / photons - mean * mean) / photons;
  grid.detected.push_back(light.photons[cell]);
  grid.probabilities.push_back(static_cast<float>(mean));
  grid.probability_errors.push_back(static_cast<float>(std::sqrt(variance)));
  const float* const delays = light.delays_ns.data() + cell * map.delays_kept;
  grid.delays_ns.insert(grid.delays_ns.end(), delays, delays + map.kept(light.photons[cell]));
}

}  // namespace

CellAssembly::CellAssembly(ResponseMap& map) : map_(map), first_{0} {
  for (const ResponseGrid& grid : map.grids) first_.push_back(first_.back() + grid.size());
}

CellAssembly::Place CellAssembly::place(std::uint64_t piece) const {
  const std::size_t grid = holder_of(first_, piece);
  return {grid, static_cast<std::size_t>(piece - first_[grid])};
}

std::string CellAssembly::key(std::uint64_t piece) { return detail::encoded(piece); }

void CellAssembly::add(std::uint64_t piece, const CellResponse& response) {
  ResponseGrid& grid = map_.grids[place(piece).grid];
  grid.photons.push_back(response.photons);
  grid.detected.insert(grid.detected.end(), response.detected.begin(), response.detected.end());
  for (const std::vector<float>& delays : response.delays_ns)
    grid.delays_ns.insert(grid.delays_ns.end(), delays.begin(), delays.end());
}

bool CellAssembly::is_consistent(const CellResponse& response) const {
  const std::size_t channels = map_.channels.size();
  if (response.detected.size() != channels || response.delays_ns.size() != channels) return false;
  std::uint64_t detected = 0;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const std::vector<float>& delays = response.delays_ns[channel];
    detected += response.detected[channel];
    if (delays.size() != map_.kept(response.detected[channel])) return false;
    if (!std::all_of(delays.begin(), delays.end(), is_time)) return false;
  }
  return detected <= response.photons && response.photons <= map_.photons_per_cell;
}

ChannelAssembly::ChannelAssembly(ResponseMap& map, const std::vector<std::uint32_t>& media)
    : map_(map), first_{0}, lights_(map.channels.size()) {
  for (std::size_t i = 0; i < media.size(); ++i) {
    if (media[i] >= grids_.size()) grids_.resize(media[i] + 1);
    grids_[media[i]].push_back(&map.grids[i]);
  }
  for (std::size_t medium = 0; medium < grids_.size(); ++medium)
    first_.push_back(first_.back() + map.channels.size() * parts_of(medium));
}

std::size_t ChannelAssembly::cells_of(std::size_t medium) const {
  const std::vector<ResponseGrid*>& grids = grids_[medium];
  return std::accumulate(grids.begin(), grids.end(), std::size_t{0},
                         [](std::size_t cells, const ResponseGrid* grid) { return cells + grid->size(); });
}

std::uint64_t ChannelAssembly::parts_of(std::size_t medium) const {
  return cells_of(medium) * map_.delays_kept > kLargeDelays ? 1 : kParts;
}

ChannelAssembly::Place ChannelAssembly::place(std::uint64_t piece) const {
  const std::size_t medium = holder_of(first_, piece);
  const std::uint64_t parts = parts_of(medium), within = piece - first_[medium];
  const auto channel = static_cast<std::size_t>(within / parts);
  return {medium, channel, within % parts, parts,
          kBackwardStreams + 2 * medium * map_.channels.size() + channel};
}

std::string ChannelAssembly::key(std::uint64_t piece) const {
  const Place at = place(piece);
  return detail::encoded(at.stream, at.part);
}

void ChannelAssembly::add(std::uint64_t piece, ChannelLight& light) {
  const Place at = place(piece);
  core::Rng rng(map_.seed, core::StreamKind::cell, at.stream + map_.channels.size(), at.part);
  if (at.part == 0)
    lights_[at.channel] = std::move(light);
  else
    lights_[at.channel].add(light, map_.delays_kept, rng);
  if (piece + 1 == first_[at.medium + 1]) fill(at.medium);
}

void ChannelAssembly::fill(std::size_t medium) {
  std::size_t first = 0;  // cell of the grid among those of the medium
  for (ResponseGrid* const grid : grids_[medium]) {
    for (std::size_t cell = 0; cell < grid->size(); ++cell)
      for (const ChannelLight& light : lights_) append(*grid, light, first + cell, map_);
    first += grid->size();
  }
  lights_.assign(map_.channels.size(), {});
}

bool ChannelAssembly::is_consistent(std::uint64_t piece, const ChannelLight& light) const {
  const std::size_t cells = cells_of(place(piece).medium);
  if (light.sum.size() != cells || light.squares.size() != cells || light.photons.size() != cells ||
      light.delays_ns.size() != cells * map_.delays_kept)
    return false;
  for (std::size_t cell = 0; cell < cells; ++cell)
    if (!std::isfinite(light.sum[cell]) || !std::isfinite(light.squares[cell]) || light.squares[cell] < 0.0 ||
        (light.photons[cell] == 0 ? light.sum[cell] != 0.0 : !(light.sum[cell] > 0.0)) ||
        light.photons[cell] > map_.photons_per_channel)
      return false;
  return std::all_of(light.delays_ns.begin(), light.delays_ns.end(), is_time);
}

void refuse_too_large(const ResponseMap& map) {
  const std::size_t channels = map.channels.size();
  if (map.photons_per_channel > std::numeric_limits<std::uint32_t>::max() / channels)
    throw core::InputError({{},
                            std::to_string(map.photons_per_channel) + " photons from each of " +
                                std::to_string(channels) + " channels are more than a map counts",
                            "trace at most 4e9 in all"});
  double cells = 0.0;
  for (const ResponseGrid& grid : map.grids)
    cells += static_cast<double>(grid.cells[0]) * grid.cells[1] * grid.cells[2];
  const double responses = cells * static_cast<double>(channels);
  // A photon is detected once, so no cell keeps more delays than it has photons.
  const double photons = map.backward() ? responses * static_cast<double>(map.photons_per_channel)
                                        : cells * map.photons_per_cell;
  const double delays = std::min(responses * map.delays_kept, photons);
  if (responses <= static_cast<double>(kMostResponses) && delays <= static_cast<double>(kMostDelays)) return;
  throw core::InputError({{},
                          "the map would have " + std::to_string(static_cast<std::uint64_t>(cells)) +
                              " cells for " + std::to_string(channels) + " channels, with up to " +
                              std::to_string(static_cast<std::uint64_t>(delays)) +
                              " delays: more than fits into memory",
                          "choose a larger pitch, or keep fewer delays"});
}

}  // namespace scintray::simulation
