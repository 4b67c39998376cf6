#include "scintray/optics/table_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/vec.hpp"

namespace scintray::optics {

namespace {

/// Number of steps of the incidence lookup: finer than the nodes, so that at most one or two steps remain.
constexpr std::uint32_t kLookupSteps = 2048;

constexpr std::size_t kRowEnds = kAzimuthBins + 1;

/// A measure of the incidence angle between 0 and 1, increasing with it, that needs no arc function.
double slant(double sine, double cosine) { return sine / (sine + cosine); }
double slant_of(const TableNode& node) {
  return slant(std::sin(node.incidence_rad), std::cos(node.incidence_rad));
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
    const double start = slant_of(low), end = slant_of(high);
    const double middle =
        (angle_of_slant(0.5 * (start + end)) - low.incidence_rad) / (high.incidence_rad - low.incidence_rad);
    Interval interval;
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
  for (std::uint32_t step = 0; step <= kLookupSteps; ++step) {
    while (interval + 1 < intervals_.size() && intervals_[interval + 1].start * kLookupSteps <= step)
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
      sizeof *this + intervals_.size() * sizeof(Interval) + lookup_.size() * sizeof(lookup_[0]);
  for (const Directions& way : directions_)
    bytes += way.polar.size() * sizeof(way.polar[0]) + way.azimuth.size() * sizeof(way.azimuth[0]);
  return bytes;
}

TableSampler::Place TableSampler::place(double sine, double cosine) const {
  const double value = slant(sine, cosine);
  std::uint32_t k = lookup_[std::min(static_cast<std::uint32_t>(value * kLookupSteps), kLookupSteps)];
  while (k + 1 < intervals_.size() && value >= intervals_[k + 1].start) ++k;
  const Interval& interval = intervals_[k];
  const double x = std::clamp((value - interval.start) * interval.per_length, 0.0, 1.0);
  return {&interval, x + interval.bend * x * (1.0 - x)};
}

ExitAngles TableSampler::sample(const Place& place, bool reflected, core::Rng& rng) const {
  const auto two_tails = [](double u) {
    return u < 0.5 ? std::sqrt(0.5 * u) : 1.0 - std::sqrt(0.5 * (1.0 - u));
  };
  const bool folded = kind_ == AzimuthKind::folded;
  const double s = two_tails(rng.uniform());
  const std::uint64_t bits = rng.bits();
  const double u = static_cast<double>(bits >> 11) * 0x1.0p-53;
  const double t = folded ? 1.0 - std::sqrt(1.0 - u) : two_tails(u);
  const int polar_bin = std::min(static_cast<int>(s * kPolarBins), kPolarBins - 1);
  const int azimuth_bin = std::min(static_cast<int>(t * kAzimuthBins), kAzimuthBins - 1);
  const auto polar_part = static_cast<float>(s * kPolarBins - polar_bin);
  const auto azimuth_part = static_cast<float>(t * kAzimuthBins - azimuth_bin);
  const auto share = static_cast<float>(place.share_);

  const std::size_t way = reflected ? 1 : 0;
  const Directions& directions = directions_[way];
  const auto node = static_cast<std::size_t>(place.interval_ - intervals_.data());
  const auto row = static_cast<std::size_t>(polar_bin) * nodes_ + node;
  const AzimuthCode code(kind_);
  const auto angles = [&](std::size_t at) -> ExitAngles {
    const float* polar = directions.polar.data() + at;
    const std::uint16_t* azimuth =
        directions.azimuth.data() + at * kRowEnds + static_cast<std::size_t>(azimuth_bin);
    const auto low = static_cast<float>(azimuth[0]), high = static_cast<float>(azimuth[1]);
    return {polar[0] + polar_part * (polar[nodes_] - polar[0]), low + azimuth_part * (high - low)};
  };
  const ExitAngles a = angles(row + place.interval_->low[way]), b = angles(row + place.interval_->high[way]);
  const float azimuth = code.step * (a.azimuth + share * (b.azimuth - a.azimuth) - code.zero);
  // A bit that u does not use: either side of the plane of incidence.
  return {a.polar + share * (b.polar - a.polar), folded && (bits & 1) != 0 ? -azimuth : azimuth};
}

}  // namespace scintray::optics
