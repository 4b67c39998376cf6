#include "scintray/optics/table_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/vec.hpp"

namespace scintray::optics {

namespace {

constexpr std::size_t kRowEnds = kAzimuthBins + 1;

double slant_of_node(const TableNode& node) {
  return slant_of<double>(std::sin(node.incidence_rad), std::cos(node.incidence_rad));
}
double angle_of_slant(double value) { return std::atan2(value, 1.0 - value); }

/// Coding of azimuths in 16 bits: 0 and half a turn, of either sign for signed ones, are exact.
struct AzimuthCode {
  float zero, step;
  explicit AzimuthCode(AzimuthKind kind)
      : zero(kind == AzimuthKind::folded ? 0.0f : 32767.0f),
        step(static_cast<float>(core::kPi) / (kind == AzimuthKind::folded ? 65535.0f : 32767.0f)) {}
  std::uint16_t encode(float azimuth) const {
    return static_cast<std::uint16_t>(std::clamp(std::round(azimuth / step + zero), 0.0f, 65535.0f));
  }
};

}  // namespace

TableSampler::TableSampler(const std::vector<TableNode>& nodes, AzimuthKind kind)
    : kind_(kind),
      nodes_(nodes.size()),
      directions_{pack(nodes, &TableNode::transmitted), pack(nodes, &TableNode::reflected)} {
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
    interval.absorptance = low.absorptance;
    interval.absorptance_step = high.absorptance - low.absorptance;
    const auto ends = [&](const DirectionQuantiles& below, const DirectionQuantiles& above, std::size_t way) {
      interval.low[way] = below.empty() ? 1 : 0;
      interval.high[way] = above.empty() ? 0 : 1;
    };
    ends(low.transmitted, high.transmitted, 0);
    ends(low.reflected, high.reflected, 1);
    interval.transmits = !low.transmitted.empty() || !high.transmitted.empty();
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
  out.polar.assign((kPolarBins + 1) * nodes.size(), 0.0f);
  out.azimuth.assign(kPolarBins * nodes.size() * kRowEnds, 0);
  const AzimuthCode code(kind_);
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const DirectionQuantiles& from = nodes[node].*way;
    if (from.empty()) continue;
    for (std::size_t edge = 0; edge <= kPolarBins; ++edge)
      out.polar[edge * nodes.size() + node] = from.polar[edge];
    for (std::size_t bin = 0; bin < kPolarBins; ++bin)
      for (std::size_t edge = 0; edge < kRowEnds; ++edge)
        out.azimuth[(bin * nodes.size() + node) * kRowEnds + edge] =
            code.encode(from.azimuth[bin * kRowEnds + edge]);
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
  const AzimuthCode code(kind_);
  TableView view{intervals_.data(),
                 lookup_.data(),
                 static_cast<std::uint32_t>(intervals_.size()),
                 static_cast<std::uint32_t>(nodes_),
                 code.zero,
                 code.step,
                 kind_ == AzimuthKind::folded};
  for (std::size_t way = 0; way < 2; ++way) {
    view.polar[way] = directions_[way].polar.data();
    view.azimuth[way] = directions_[way].azimuth.data();
  }
  return view;
}

TableSampler::Place TableSampler::place(double sine, double cosine) const {
  const double slant = slant_of(sine, cosine);
  const TableInterval& interval = interval_at(view(), slant);
  return {&interval, share_of(slant, interval.start, interval.per_length, interval.bend)};
}

ExitAngles TableSampler::sample(const Place& place, bool reflected, core::Rng& rng) const {
  const double polar_level = level_of_two_tails(rng.uniform());
  const std::uint64_t bits = rng.bits();
  const double u = core::uniform_of<double>(bits);
  const bool folded = kind_ == AzimuthKind::folded;
  const TableView numbers = view();
  const TableCell cell = table_cell(numbers, *place.interval_, reflected ? 1 : 0, polar_level,
                                    folded ? level_of_one_tail(u) : level_of_two_tails(u));
  const TableExit exit = table_exit(numbers, cell, place.share_);
  // A bit that u does not use: either side of the plane of incidence.
  return {exit.polar, folded && (bits & 1) != 0 ? -exit.azimuth : exit.azimuth};
}

}  // namespace scintray::optics
