#pragma once
/// Numbers of quantiles of a surface table's directions.

namespace scintray::optics {

inline constexpr int kPolarBins = 64;
inline constexpr int kAzimuthBins = 32;

}  // namespace scintray::optics
