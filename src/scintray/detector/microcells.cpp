#include "scintray/detector/microcells.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <unordered_map>

#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray::detector {

namespace {

constexpr double kMostCells = 1e8;

std::uint32_t index_along(double from_edge, double length, std::uint32_t cells) {
  const double index = std::floor(from_edge / length * cells);
  return static_cast<std::uint32_t>(std::clamp(index, 0.0, static_cast<double>(cells - 1)));
}

bool later(const Carrier& a, const Carrier& b) { return a.time_ns > b.time_ns; }

/// The cells of one sensor during one event.
class FiringCells {
 public:
  FiringCells(const Microcells& cells, const MicrocellGrid& grid, std::size_t expected)
      : cells_(cells), grid_(grid), neighbour_rate_(-std::log1p(-cells.crosstalk) / 8.0) {
    fired_ns_.reserve(expected);
  }

  /// Fires the cell of a carrier and the cells that this fires at once. Carriers released later are queued.
  void fire(const Carrier& first, core::Rng& rng, const AvalancheSink& deliver) {
    at_once_.assign(1, first);
    while (!at_once_.empty()) {
      const Carrier carrier = at_once_.back();
      at_once_.pop_back();
      const double charge = discharge(carrier);
      if (charge <= 0.0) continue;
      deliver(carrier.time_ns, charge, carrier.cause);
      spread(carrier, charge, rng);
      if (cells_.afterpulse > 0.0 && rng.uniform() < cells_.afterpulse * charge)
        released_.push({carrier.time_ns + cells_.afterpulse_time_ns * core::sample_exponential(rng),
                        carrier.cell, AvalancheCause::afterpulse});
    }
  }

  /// Time of the next carrier to be released, infinite when there is none; and that carrier.
  double next_release_ns() const { return released_.empty() ? HUGE_VAL : released_.top().time_ns; }
  Carrier take_released() {
    const Carrier carrier = released_.top();
    released_.pop();
    return carrier;
  }

 private:
  /// Charge of a cell that fires now, as a share of a full one.
  double discharge(const Carrier& carrier) {
    const auto [cell, is_first] = fired_ns_.try_emplace(carrier.cell, carrier.time_ns);
    if (is_first) return 1.0;
    const double charge = -std::expm1((cell->second - carrier.time_ns) / cells_.recovery_ns);
    cell->second = carrier.time_ns;
    return charge;
  }

  /// Crosstalk: each neighbour absorbs a photon of the avalanche independently; the gaps between those that
  /// do are geometric, and drawn as exponentials.
  void spread(const Carrier& carrier, double charge, core::Rng& rng) {
    if (neighbour_rate_ <= 0.0) return;
    std::array<std::uint32_t, 8> buffer{};
    const double rate = neighbour_rate_ * charge;
    double index = std::floor(core::sample_exponential(rng) / rate);
    if (index >= static_cast<double>(buffer.size())) return;
    const auto around = grid_.neighbours(carrier.cell, buffer);
    while (index < static_cast<double>(around.size())) {
      at_once_.push_back(
          {carrier.time_ns, around[static_cast<std::size_t>(index)], AvalancheCause::crosstalk});
      index += 1.0 + std::floor(core::sample_exponential(rng) / rate);
    }
  }

  const Microcells& cells_;
  const MicrocellGrid& grid_;
  double neighbour_rate_;
  std::unordered_map<std::uint32_t, double> fired_ns_;
  std::vector<Carrier> at_once_;
  std::priority_queue<Carrier, std::vector<Carrier>, decltype(&later)> released_{&later};
};

/// All cells of one sensor.
class CellProcess : public AvalancheProcess {
 public:
  CellProcess(const Microcells& cells, const SensorFace& face) : cells_(cells), grid_(cells, face) {}

  double memory_ns() const override {
    return kTimesToForget * std::max(cells_.recovery_ns, cells_.afterpulse_time_ns);
  }
  std::uint32_t cell(const Arrival& arrival, core::Rng& rng) const override { return grid_.at(arrival, rng); }

  void fire(std::vector<Carrier>& carriers, double end_ns, core::Rng& rng,
            const AvalancheSink& deliver) const override {
    std::stable_sort(carriers.begin(), carriers.end(),
                     [](const Carrier& a, const Carrier& b) { return a.time_ns < b.time_ns; });
    FiringCells cells(cells_, grid_, carriers.size());
    for (std::size_t next = 0;;) {
      const double carrier_ns = next < carriers.size() ? carriers[next].time_ns : HUGE_VAL;
      if (std::min(carrier_ns, cells.next_release_ns()) >= end_ns) break;
      cells.fire(cells.next_release_ns() < carrier_ns ? cells.take_released() : carriers[next++], rng,
                 deliver);
    }
  }

 private:
  Microcells cells_;
  MicrocellGrid grid_;
};

}  // namespace

std::unique_ptr<const AvalancheProcess> MicrocellModel::on(const SensorFace& face) const {
  return std::make_unique<const CellProcess>(cells, face);
}

MicrocellGrid::MicrocellGrid(const Microcells& cells, const SensorFace& face) : face_(face) {
  if (!(face.area_mm2() > 0.0))
    throw core::InputError(
        {{}, "a sensor whose face has no area", "light must reach the sensor through a face"});
  const double pitch = cells.count > 0 ? std::sqrt(face.area_mm2() / cells.count) : cells.pitch_mm;
  const double columns = std::max(1.0, std::round(face.width_mm / pitch));
  const double rows =
      cells.count > 0 ? std::ceil(cells.count / columns) : std::max(1.0, std::round(face.height_mm / pitch));
  if (!(columns * rows <= kMostCells))
    throw core::InputError({{},
                            "a sensor of " + std::to_string(face.width_mm) + " by " +
                                std::to_string(face.height_mm) + " mm with more than 10^8 cells",
                            "check the pitch of the cells and the size of the sensor"});
  columns_ = static_cast<std::uint32_t>(columns);
  rows_ = static_cast<std::uint32_t>(rows);
  count_ = cells.count > 0 ? cells.count : columns_ * rows_;
}

std::uint32_t MicrocellGrid::any(core::Rng& rng) const {
  return static_cast<std::uint32_t>(rng.uniform() * count_);
}

std::uint32_t MicrocellGrid::at(const Arrival& arrival, core::Rng& rng) const {
  if (std::isnan(arrival.x_mm) || std::isnan(arrival.y_mm)) return any(rng);
  const std::uint32_t column = index_along(arrival.x_mm + 0.5 * face_.width_mm, face_.width_mm, columns_);
  const std::uint32_t row = index_along(arrival.y_mm + 0.5 * face_.height_mm, face_.height_mm, rows_);
  return std::min(row * columns_ + column, count_ - 1);
}

std::span<const std::uint32_t> MicrocellGrid::neighbours(std::uint32_t cell,
                                                         std::array<std::uint32_t, 8>& buffer) const {
  const std::uint32_t row = cell / columns_, column = cell % columns_;
  std::size_t found = 0;
  for (std::uint32_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, rows_ - 1); ++r)
    for (std::uint32_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, columns_ - 1); ++c) {
      const std::uint32_t other = r * columns_ + c;
      if (other != cell && other < count_) buffer[found++] = other;
    }
  return {buffer.data(), found};
}

}  // namespace scintray::detector
