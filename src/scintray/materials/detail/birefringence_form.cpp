#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "scintray/materials/detail/forms.hpp"

namespace scintray::materials {

namespace {

constexpr const char* kAxisKeys[] = {"y", "z"};

using AxisCurves = std::array<core::Curve, 3>;

/// Wavelengths (nm) that every table of the axes covers; constants cover all.
struct CommonRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  explicit CommonRange(const AxisCurves& curves) {
    for (const core::Curve& curve : curves) {
      if (curve.is_constant()) continue;
      low = std::max(low, curve.x().front());
      high = std::min(high, curve.x().back());
    }
  }
  bool empty() const { return low >= high; }
  bool contains(double wavelength_nm) const { return wavelength_nm >= low && wavelength_nm <= high; }
};

/// Mean of curves at the points of all, within their common range, which is not empty.
core::Curve mean_of(const AxisCurves& curves) {
  const CommonRange range(curves);
  std::set<double> points;
  for (const core::Curve& curve : curves)
    if (!curve.is_constant()) points.insert(curve.x().begin(), curve.x().end());
  std::erase_if(points, [&](double point) { return !range.contains(point); });
  if (points.empty()) points.insert(0.0);
  std::vector<double> mean;
  for (const double point : points)
    mean.push_back((curves[0](point) + curves[1](point) + curves[2](point)) / 3.0);
  return {{points.begin(), points.end()}, std::move(mean)};
}

AxisCurves indices_of(const optics::Birefringence& medium) {
  return {medium.axes[0].index, medium.axes[1].index, medium.axes[2].index};
}
AxisCurves absorptions_of(const optics::Birefringence& medium) {
  return {medium.axes[0].absorption_per_mm, medium.axes[1].absorption_per_mm,
          medium.axes[2].absorption_per_mm};
}

bool same(const core::Curve& a, const core::Curve& b) { return a.x() == b.x() && a.y() == b.y(); }

}  // namespace

void read_birefringence(const config::TomlTable& index, const config::TomlTable& absorption,
                        optics::Medium& medium) {
  auto axes = std::make_shared<optics::Birefringence>();
  axes->axes.fill({medium.index, medium.group_index, medium.absorption_per_mm});
  bool by_index = false, by_absorption = false;
  for (std::size_t i = 0; i < std::size(kAxisKeys); ++i) {
    optics::PrincipalAxis& axis = axes->axes[i + 1];
    if (const std::optional<config::TomlTable> block = index.optional_table(kAxisKeys[i])) {
      axis.index = read_index(*block);
      axis.group_index = read_group_index(*block);
      by_index = true;
    }
    if (const std::optional<config::TomlTable> block = absorption.optional_table(kAxisKeys[i])) {
      axis.absorption_per_mm = read_extinction(*block);
      by_absorption = true;
    }
  }
  if (by_absorption && !by_index)
    absorption.report(
        absorption.has("y") ? "y" : "z",
        "an absorption that depends on the polarisation, in a medium of one refractive index",
        "give the index of the axes as well, as [index.z] with its n: they decide which polarisations "
        "light has in the medium");
  if (!by_index) return;
  const char* const key = index.has("z") ? "z" : "y";
  // Equal indices are where a sweep of a birefringence begins; polarisations have nothing to be defined by
  // there.
  const bool all_same =
      same(axes->axes[0].index, axes->axes[1].index) && same(axes->axes[0].index, axes->axes[2].index);
  if (all_same && by_absorption)
    absorption.report(
        absorption.has("y") ? "y" : "z",
        "an absorption that depends on the polarisation, in a medium whose indices are all the same",
        "give the axes different indices: they decide which polarisations light has in the medium");
  const bool indices_meet = !CommonRange(indices_of(*axes)).empty();
  const bool absorptions_meet = !CommonRange(absorptions_of(*axes)).empty();
  index.expect(key, indices_meet, "the indices of the principal axes have no wavelengths in common",
               "give all three over one range of wavelengths");
  absorption.expect(absorption.has("z") ? "z" : "y", absorptions_meet,
                    "the absorptions of the principal axes have no wavelengths in common",
                    "give all of them over one range of wavelengths");
  if (!indices_meet || !absorptions_meet) return;
  medium.index = mean_of(indices_of(*axes));
  medium.absorption_per_mm = mean_of(absorptions_of(*axes));
  medium.group_index.reset();
  medium.birefringence = std::move(axes);
}

}  // namespace scintray::materials
