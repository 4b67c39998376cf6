#pragma once
/// The page of a fit.

#include <string>

#include "scintray/analysis/fit/fit_record.hpp"

namespace scintray::report {

/// Measured points, the curves of the start and of what was found, residuals, parameters.
std::string fit_page(const analysis::FitRecord& record);

}  // namespace scintray::report
