#include "scintray/materials/index_tolerance.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::materials {

namespace {

double ratio(const optics::IndexPair& index) { return index.inside / index.outside; }

/// The ratio of indices of a table at a wavelength. For an opaque stack only the inside index is used.
double tabulated_ratio(const optics::SurfaceTable& table, double nm) {
  const auto of_slice = [&](std::size_t spectral) {
    const optics::IndexPair& index = table.index_pair(spectral * table.azimuths());
    return table.opaque() ? index.inside : ratio(index);
  };
  const std::vector<double>& at = table.wavelengths_nm();
  if (at.size() == 1) return of_slice(0);
  const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, nm);
  const auto k = static_cast<std::size_t>(above - at.begin());
  const double share = std::clamp((nm - at[k - 1]) / (at[k] - at[k - 1]), 0.0, 1.0);
  return of_slice(k - 1) + share * (of_slice(k) - of_slice(k - 1));
}

}  // namespace

double index_mismatch(const optics::SurfaceTable& table, const SurfaceSetting& setting, double nm) {
  const optics::IndexPair here = setting.indices(nm);
  return std::abs((table.opaque() ? here.inside : ratio(here)) / tabulated_ratio(table, nm) - 1.0);
}

}  // namespace scintray::materials
