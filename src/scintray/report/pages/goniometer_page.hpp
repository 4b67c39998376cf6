#pragma once
/// The goniometer's page: where the light of a beam goes on a surface.

#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/measured_profile.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"

namespace scintray::report {

/// A measurement shown beside the reflected light of the only reading.
struct Overlay {
  analysis::ScaledProfile scaled;
  std::string name;  ///< of its file
};

/// "LSO (n 1.8270) to air (n 1.0003), 420 nm, from inside".
std::string sample_text(const analysis::SampleSurface& sample, optics::Side side);

/// One self-contained page: shares with errors, mean directions and widths, and for each reading the
/// in-plane profile and maps of reflected and transmitted light.
std::string goniometer_page(const analysis::SampleSurface& sample,
                            const std::vector<analysis::GoniometerReading>& readings,
                            const std::optional<Overlay>& overlay);

/// "scaled by 0.0123, to the same area as ...": how a measurement was brought to scale, and how far off it
/// is.
std::string overlay_text(const Overlay& overlay);

}  // namespace scintray::report
