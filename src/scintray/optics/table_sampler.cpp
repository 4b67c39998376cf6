#include "scintray/optics/table_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "scintray/core/vec.hpp"

namespace scintray::optics {

namespace {

double slant_of_node(const TableNode& node) {
  return slant_of<double>(std::sin(node.incidence_rad), std::cos(node.incidence_rad));
}
double angle_of_slant(double value) { return std::atan2(value, 1.0 - value); }

/// Coding of azimuths in 16 bits: 0 and half a turn, of either sign for signed ones, are exact.
struct AzimuthCode {
  double zero, step;
  explicit AzimuthCode(AzimuthKind kind)
      : zero(kind == AzimuthKind::folded ? 0.0 : 32767.0),
        step(azimuth_step_rad(kind == AzimuthKind::folded)) {}
  std::uint16_t encode(float azimuth) const {
    return static_cast<std::uint16_t>(
        std::clamp(std::round(static_cast<double>(azimuth) / step + zero), 0.0, 65535.0));
  }
};

}  // namespace

TableSampler::TableSampler(const std::vector<TableNode>& nodes, AzimuthKind kind, bool absorbs)
    : kind_(kind), directions_{pack(nodes, &TableNode::transmitted), pack(nodes, &TableNode::reflected)} {
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    const TableNode &low = nodes[k], &high = nodes[k + 1];
    const double start = slant_of_node(low), end = slant_of_node(high);
    const double middle =
        (angle_of_slant(0.5 * (start + end)) - low.incidence_rad) / (high.incidence_rad - low.incidence_rad);
    TableInterval interval;
    interval.start = start;
    interval.per_length = 1.0 / (end - start);
    interval.bend = 4.0 * (middle - 0.5);
    interval.reflectance = low.reflectance;
    interval.reflectance_step = high.reflectance - low.reflectance;
    if (!absorbs) {
      interval.absorptance = -2.0;
    } else if (low.transmitted.empty() && high.transmitted.empty()) {
      interval.absorptance = 2.0;
    } else {
      interval.absorptance = low.absorptance;
      interval.absorptance_step = high.absorptance - low.absorptance;
    }
    interval.first_row = static_cast<double>(k * kPolarRows);
    intervals_.push_back(interval);
  }
  std::uint32_t interval = 0;
  for (std::uint32_t step = 0; step <= kTableLookupSteps; ++step) {
    while (interval + 1 < intervals_.size() && intervals_[interval + 1].start * kTableLookupSteps <= step)
      ++interval;
    lookup_.push_back(interval);
  }
}

TableSampler::Directions TableSampler::pack(const std::vector<TableNode>& nodes,
                                            DirectionQuantiles TableNode::*way) const {
  Directions out;
  if (std::all_of(nodes.begin(), nodes.end(), [&](const TableNode& node) { return (node.*way).empty(); }))
    return out;
  const AzimuthCode code(kind_);
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    const DirectionQuantiles *low = &(nodes[k].*way), *high = &(nodes[k + 1].*way);
    if (low->empty()) low = high;
    if (high->empty()) high = low;
    for (std::size_t row = 0; row < kPolarRows; ++row) {
      for (const DirectionQuantiles* node : {low, high})
        out.polar.push_back(node->empty() ? 0.0f : node->polar[row]);
      for (std::size_t edge = 0; edge < kAzimuthEdges; ++edge)
        for (const DirectionQuantiles* node : {low, high})
          out.azimuth.push_back(node->empty() || row == kPolarBins
                                    ? 0
                                    : code.encode(node->azimuth[row * kAzimuthEdges + edge]));
    }
  }
  return out;
}

std::size_t TableSampler::bytes() const {
  std::size_t bytes =
      sizeof *this + intervals_.size() * sizeof(TableInterval) + lookup_.size() * sizeof(lookup_[0]);
  for (const Directions& way : directions_)
    bytes += way.polar.size() * sizeof(way.polar[0]) + way.azimuth.size() * sizeof(way.azimuth[0]);
  return bytes;
}

TableView TableSampler::view() const {
  TableView view{intervals_.data(), lookup_.data(), static_cast<std::uint32_t>(intervals_.size()),
                 kind_ == AzimuthKind::folded ? 1U : 0U, AzimuthCode(kind_).zero};
  for (std::size_t way = 0; way < 2; ++way) {
    view.polar[way] = directions_[way].polar.data();
    view.azimuth[way] = directions_[way].azimuth.data();
  }
  return view;
}

TableSampler::Place TableSampler::place(double sine, double cosine) const {
  const double slant = slant_of(sine, cosine);
  const TableInterval& interval = interval_at(view(), slant, static_cast<std::uint32_t>(lookup_step(slant)));
  return {&interval, share_of(slant, interval.start, interval.per_length, interval.bend)};
}

TableExit TableSampler::sample(const Place& place, bool reflected, core::Rng& rng) const {
  const bool folded = kind_ == AzimuthKind::folded;
  const TableBin<double> polar(level_of_two_tails(rng.uniform()), kPolarBins);
  const std::uint64_t bits = rng.bits();
  const double u = core::uniform_of<double>(bits);
  const TableBin<double> azimuth(folded ? level_of_one_tail(u) : level_of_two_tails(u), kAzimuthBins);

  const Directions& way = directions_[reflected ? 1 : 0];
  const auto row = static_cast<std::size_t>(place.interval_->first_row + polar.number);
  const std::size_t cell = row * kAzimuthEdges + static_cast<std::size_t>(azimuth.number);
  const auto polar_at = [&](std::size_t i) { return static_cast<double>(way.polar[2 * row + i]); };
  const TableQuantiles<double> polars{{polar_at(0), polar_at(1)}, {polar_at(2), polar_at(3)}};
  std::uint64_t codes = 0;
  std::memcpy(&codes, way.azimuth.data() + 2 * cell, sizeof codes);
  const AzimuthCode code(kind_);
  const double angle = code.step * (azimuth_codes<double>(codes).at(azimuth.part, place.share_) - code.zero);
  // A bit that u does not use: either side of the plane of incidence.
  return {polars.at(polar.part, place.share_), folded && (bits & 1) != 0 ? -angle : angle};
}

}  // namespace scintray::optics
