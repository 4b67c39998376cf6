#pragma once
/// When numbers with errors agree.

namespace scintray::test {

/// Limit of agreement in combined standard errors. Two-sided, a true law fails it once in 15,800
/// comparisons; the seeds are fixed, so a test either always passes or always fails.
inline constexpr double kSigmas = 4.0;

}  // namespace scintray::test
