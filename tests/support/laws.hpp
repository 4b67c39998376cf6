#pragma once
/// Measured numbers against the law that a test's name states.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "scintray/core/statistics.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"

namespace scintray::test {

/// Photons with which a law is tested: those that show it, or SCINTRAY_LAW_PHOTONS where that is set to more.
inline int law_photons(int usual) {
  const char* const wanted = std::getenv("SCINTRAY_LAW_PHOTONS");
  return wanted ? std::max(usual, std::atoi(wanted)) : usual;
}

/// Checks a measured number against the law in the test's name.
inline void check_law(const std::string& what, const core::Estimate& measured, const core::Estimate& law) {
  const double distance = core::sigmas(measured, law);
  evidence("laws", {doctest::getContextOptions()->currentTest->m_name, what,
                    fmt::format("{:.6g} ± {:.2g}", measured.value, measured.error),
                    fmt::format("{:.6g}", law.value), fmt::format("{:.2f}", distance)});
  CAPTURE(what);
  CAPTURE(measured.value);
  CAPTURE(measured.error);
  CAPTURE(law.value);
  CHECK(distance < kSigmas);
}

}  // namespace scintray::test
