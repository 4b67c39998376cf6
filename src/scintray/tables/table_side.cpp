#include "scintray/tables/table_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/core/text.hpp"

namespace scintray::tables {

namespace {

const optics::DirectionQuantiles& directions(const optics::TableNode& node, Leaving way) {
  return way == Leaving::reflected ? node.reflected : node.transmitted;
}

double share_of(const optics::TableNode& node, Leaving way) {
  return way == Leaving::reflected ? node.reflectance : node.transmittance();
}

/// s of the level P = 2 s^2 and its mirror image: the inverse of polar_level.
double polar_step(double level) {
  return level < 0.5 ? std::sqrt(0.5 * level) : 1.0 - std::sqrt(0.5 * (1.0 - level));
}

/// The inverse of azimuth_level.
double azimuth_step(double level) { return 1.0 - std::sqrt(1.0 - level); }

/// Radical inverse of `k` in a base: its digits mirrored at the point.
double mirrored_digits(std::uint64_t k, std::uint64_t base) {
  double value = 0.0, digit = 1.0;
  for (; k > 0; k /= base) {
    digit /= static_cast<double>(base);
    value += digit * static_cast<double>(k % base);
  }
  return value;
}

std::string wavelength_list(const optics::SurfaceTable& table) {
  return core::list_of(table.wavelengths_nm(), ", ", [](double nm) { return fmt::format("{:g} nm", nm); });
}

}  // namespace

std::size_t slice_at(const optics::SurfaceTable& table, std::optional<double> wavelength_nm) {
  const std::vector<double>& wavelengths = table.wavelengths_nm();
  if (!wavelength_nm) {
    if (wavelengths.size() == 1) return 0;
    throw core::InputError(
        {{},
         "a table of " + std::to_string(wavelengths.size()) + " wavelengths; the format holds one",
         "choose with --wavelength one of " + wavelength_list(table)});
  }
  constexpr double kSame_nm = 1e-3;
  for (std::size_t k = 0; k < wavelengths.size(); ++k)
    if (std::abs(wavelengths[k] - *wavelength_nm) < kSame_nm) return k * table.azimuths();
  throw core::InputError({{},
                          fmt::format("no slice at {:g} nm; expected one of {} (0 nm: not stated)",
                                      *wavelength_nm, wavelength_list(table)),
                          "build the table at this wavelength"});
}

TableSide::TableSide(const optics::SurfaceTable& table, optics::Side side, std::size_t slice)
    : nodes_(&table.nodes(side, slice)),
      before_(table.index_pair(slice).on(side)),
      behind_(table.index_pair(slice).on(optics::other(side))) {
  if (table.azimuth_kind() == optics::AzimuthKind::directional)
    throw core::InputError({{},
                            "a table of a surface with direction (" + std::to_string(table.azimuths()) +
                                " azimuths of incidence); the format has the angle of incidence only",
                            "build the table without direction"});
  if (table.slices()[slice].reciprocal)
    throw core::InputError(
        {{},
         "a table made reciprocal, whose light is sampled from bins and not from the distributions of its "
         "angles of incidence",
         "export the table built without that"});
}

TableSide::Place TableSide::place(double incidence_rad) const {
  const auto above =
      std::lower_bound(nodes_->begin() + 1, nodes_->end() - 1, incidence_rad,
                       [](const optics::TableNode& n, double angle) { return n.incidence_rad < angle; });
  const optics::TableNode &low = *(above - 1), &high = *above;
  const double share = (incidence_rad - low.incidence_rad) / (high.incidence_rad - low.incidence_rad);
  return {&low, &high, std::clamp(share, 0.0, 1.0)};
}

double TableSide::share(Leaving way, double incidence_rad) const {
  const Place at = place(incidence_rad);
  const double low = share_of(*at.low, way);
  return low + at.share * (share_of(*at.high, way) - low);
}

double TableSide::absorptance(double incidence_rad) const {
  const Place at = place(incidence_rad);
  const double low = at.low->absorptance;
  return low + at.share * (at.high->absorptance - low);
}

bool TableSide::has_directions(Leaving way, double incidence_rad) const {
  const Place at = place(incidence_rad);
  return !directions(*at.low, way).empty() || !directions(*at.high, way).empty();
}

optics::ExitAngles TableSide::direction(Leaving way, double incidence_rad, double u, double v) const {
  const Place at = place(incidence_rad);
  const optics::DirectionQuantiles* low = &directions(*at.low, way);
  const optics::DirectionQuantiles* high = &directions(*at.high, way);
  if (low->empty()) low = high;
  if (high->empty()) high = low;
  const double s = polar_step(u) * optics::kPolarBins, t = azimuth_step(v) * optics::kAzimuthBins;
  const int row = std::clamp(static_cast<int>(s), 0, optics::kPolarBins - 1);
  const int column = std::clamp(static_cast<int>(t), 0, optics::kAzimuthBins - 1);
  const auto angles = [&](const optics::DirectionQuantiles& q) -> optics::ExitAngles {
    const float* polar = q.polar.data() + row;
    const float* azimuth = q.azimuth.data() + row * (optics::kAzimuthBins + 1) + column;
    return {polar[0] + static_cast<float>(s - row) * (polar[1] - polar[0]),
            azimuth[0] + static_cast<float>(t - column) * (azimuth[1] - azimuth[0])};
  };
  const optics::ExitAngles a = angles(*low), b = angles(*high);
  const auto share = static_cast<float>(at.share);
  return {a.polar + share * (b.polar - a.polar), a.azimuth + share * (b.azimuth - a.azimuth)};
}

CubePoint cube_point(std::uint64_t k, const CubePoint& shift) {
  const auto moved = [&](std::uint64_t base, double start) {
    const double value = mirrored_digits(k, base) + start;
    return value - std::floor(value);
  };
  return {moved(2, shift.u), moved(3, shift.v), moved(5, shift.w)};
}

CubePoint random_shift(std::uint64_t seed, std::uint64_t a, std::uint64_t b) {
  core::Rng rng(seed, core::StreamKind::other, a, b);
  const double u = rng.uniform(), v = rng.uniform();
  return {u, v, rng.uniform()};
}

}  // namespace scintray::tables
