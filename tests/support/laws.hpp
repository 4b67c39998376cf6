#pragma once
/// Measured numbers against the law that a test's name states.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

#include "scintray/core/statistics.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"

namespace scintray::test {

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
