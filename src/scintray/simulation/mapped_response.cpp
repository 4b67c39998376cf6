#include "scintray/simulation/mapped_response.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/count_sampling.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray::simulation {

double PlaceResponse::sample_delay(core::Rng& rng) const {
  const double u = rng.uniform() * probability_;
  std::size_t cell = 0;
  while (cell + 1 < count_ && u >= cells_[cell].below) ++cell;
  const std::span<const float> delays = cells_[cell].delays_ns;
  return delays[static_cast<std::size_t>(rng.uniform() * static_cast<double>(delays.size()))];
}

MappedResponse::MappedResponse(const ResponseMap& map) : map_(map) {
  const std::size_t channels = map.channels.size();
  for (const ResponseGrid& grid : map.grids) {
    if (!grid_of_.contains(grid.region)) grid_of_.resize(grid.region.index() + 1);
    grid_of_[grid.region] = grids_.emplace_back();
    Grid& indexed = grids_.back();
    indexed.data = &grid;
    indexed.first_delay.reserve(grid.size());
    std::uint64_t delays = 0;
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
      indexed.first_delay.push_back(delays);
      for (std::size_t channel = 0; channel < channels; ++channel) {
        const std::uint32_t kept = map.kept(grid.detected[cell * channels + channel]);
        const std::span<const float> own(grid.delays_ns.data() + delays, kept);
        indexed.earliest.push_back(own.empty() ? 0.0f : *std::min_element(own.begin(), own.end()));
        delays += kept;
      }
    }
  }
}

MappedResponse::Corners MappedResponse::corners(const ResponseGrid& grid, const core::Vec3& position) {
  std::array<std::array<std::size_t, 2>, 3> index{};
  std::array<std::array<double, 2>, 3> weight{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double last = static_cast<double>(grid.cells[axis] - 1);
    const double at = std::clamp((position[i] - grid.low[i]) / grid.pitch[i] - 0.5, 0.0, last);
    const double below = std::min(std::floor(at), std::max(0.0, last - 1.0));
    index[axis] = {static_cast<std::size_t>(below), static_cast<std::size_t>(std::min(below + 1.0, last))};
    weight[axis] = {1.0 - (at - below), at - below};
  }
  Corners corners;
  double sum = 0.0;
  for (const std::size_t corner : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u}) {
    const std::size_t x = corner >> 2, y = (corner >> 1) & 1, z = corner & 1;
    const double w = weight[0][x] * weight[1][y] * weight[2][z];
    const std::size_t cell = (index[0][x] * grid.cells[1] + index[1][y]) * grid.cells[2] + index[2][z];
    if (w <= 0.0 || grid.photons[cell] == 0) continue;
    corners.list[corners.count++] = {cell, w};
    sum += w;
  }
  for (std::size_t i = 0; i < corners.count; ++i) corners.list[i].weight /= sum;
  if (corners.count == 0) corners.list[corners.count++] = {nearest_filled(grid, position), 1.0};
  return corners;
}

std::size_t MappedResponse::nearest_filled(const ResponseGrid& grid, const core::Vec3& position) {
  std::size_t nearest = 0, cell = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t x = 0; x < grid.cells[0]; ++x)
    for (std::uint32_t y = 0; y < grid.cells[1]; ++y)
      for (std::uint32_t z = 0; z < grid.cells[2]; ++z, ++cell) {
        if (grid.photons[cell] == 0) continue;
        const core::Vec3 centre = grid.low + grid.pitch.cwiseProduct(core::Vec3(x + 0.5, y + 0.5, z + 0.5));
        const double distance = (centre - position).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        nearest = cell;
      }
  return nearest;
}

void MappedResponse::at(const core::Vec3& position, core::RegionId region,
                        std::vector<PlaceResponse>& response) const {
  const Grid& grid = grids_[grid_of_[region]];
  const Corners around = corners(*grid.data, position);
  const std::size_t channels = map_.channels.size();
  response.assign(channels, {});
  for (std::size_t i = 0; i < around.count; ++i) {
    const Corner& corner = around.list[i];
    const bool backward = map_.backward();
    const double per_photon = corner.weight / static_cast<double>(grid.data->photons[corner.cell]);
    const float* delay = grid.data->delays_ns.data() + grid.first_delay[corner.cell];
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const std::size_t entry = corner.cell * channels + channel;
      const std::uint32_t detected = grid.data->detected[entry];
      if (detected == 0) continue;
      const std::uint32_t kept = map_.kept(detected);
      PlaceResponse& seen = response[channel];
      seen.probability_ += backward ? corner.weight * grid.data->probabilities[entry] : per_photon * detected;
      seen.earliest_ = std::min(seen.earliest_, double{grid.earliest[entry]});
      seen.cells_[seen.count_++] = {seen.probability_, {delay, kept}};
      delay += kept;
    }
  }
}

double sample_first(std::uint64_t count, const std::vector<optics::DecayComponent>& decay,
                    const PlaceResponse& response, core::Rng& rng) {
  double first = std::numeric_limits<double>::infinity();
  double share = 1.0;  // of the components that are left
  for (const optics::DecayComponent& component : decay) {
    const bool last = &component == &decay.back();
    const std::uint64_t photons =
        last ? count : core::sample_binomial(count, component.fraction / share, rng);
    count -= photons;
    share -= component.fraction;
    double decayed = 0.0;
    for (std::uint64_t left = photons; left > 0; --left) {
      decayed += component.decay_ns * core::sample_exponential(rng) / static_cast<double>(left);
      if (decayed + response.earliest_delay() >= first) break;
      double time = decayed + response.sample_delay(rng);
      if (component.rise_ns > 0.0) time += component.rise_ns * core::sample_exponential(rng);
      first = std::min(first, time);
    }
  }
  return first;
}

}  // namespace scintray::simulation
