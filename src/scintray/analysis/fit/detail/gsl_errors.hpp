#pragma once
/// Conversion of GSL's errors to exceptions.

#include <string>

namespace scintray::analysis {

/// Makes GSL return its errors instead of aborting the process, which is its default. May be called
/// often and from any thread.
void silence_gsl();

/// Throws InternalError when a GSL function returned an error.
void check_gsl(int status, const std::string& what);

}  // namespace scintray::analysis
