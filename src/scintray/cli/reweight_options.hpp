#pragma once
/// Values of optical properties as they are written on the command line.

#include <string>

#include "scintray/simulation/reweight_plan.hpp"

namespace scintray::cli {

/// "LSO=200 mm", "LSO=100,200,400 mm", "LSO=100 mm,none", "LSO=x0.5,x2"; "PTFE=0.95", "PTFE=90,95 %",
/// "PTFE=x0.98".
/// @param option  for messages: "--reflectance"
/// @throws CLI::ValidationError for what is not of this form; values are not yet checked for their range
simulation::PropertyScan parse_scan(const std::string& option, simulation::OpticalProperty property,
                                    const std::string& text);

}  // namespace scintray::cli
