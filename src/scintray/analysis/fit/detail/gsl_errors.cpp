#include "scintray/analysis/fit/detail/gsl_errors.hpp"

#include <gsl/gsl_errno.h>

#include <mutex>

#include "scintray/core/error.hpp"

namespace scintray::analysis {

void silence_gsl() {
  static std::once_flag once;
  std::call_once(once, [] { gsl_set_error_handler_off(); });
}

void check_gsl(int status, const std::string& what) {
  if (status != GSL_SUCCESS) throw core::InternalError(what + ": " + gsl_strerror(status));
}

}  // namespace scintray::analysis
