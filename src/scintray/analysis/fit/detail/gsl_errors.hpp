#pragma once
/// GSL's way with errors, made ours.

#include <string>

namespace scintray::analysis {

/// From now on GSL returns its errors instead of ending the process, which is its habit. May be called
/// often and from any thread.
void silence_gsl();

/// Throws InternalError when a GSL function returned an error.
void check_gsl(int status, const std::string& what);

}  // namespace scintray::analysis
