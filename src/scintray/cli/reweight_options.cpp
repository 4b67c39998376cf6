#include "scintray/cli/reweight_options.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"

namespace scintray::cli {

namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string> items_of(const std::string& list) {
  std::vector<std::string> items;
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(',', start), list.size());
    items.push_back(trimmed(list.substr(start, end - start)));
    start = end + 1;
  }
  return items;
}

/// What follows the number that `item` begins with.
std::string unit_of(const std::string& item) {
  char* end = nullptr;
  std::strtod(item.c_str(), &end);
  return trimmed(end);
}

}  // namespace

simulation::PropertyScan parse_scan(const std::string& option, simulation::OpticalProperty property,
                                    const std::string& text) {
  const bool length = property == simulation::OpticalProperty::absorption_length;
  const auto refuse = [&](const std::string& what) {
    return CLI::ValidationError(option, "\"" + text + "\": " + what + "; write " +
                                            (length ? "\"LSO=200 mm\", \"LSO=100,200 mm,none\" or \"LSO=x2\""
                                                    : "\"PTFE=0.95\", \"PTFE=0.9,0.95\" or \"PTFE=x0.98\""));
  };
  simulation::PropertyScan scan;
  scan.property = property;
  const std::size_t equals = text.rfind('=');
  scan.name = trimmed(text.substr(0, std::min(equals, text.size())));
  if (equals == std::string::npos || scan.name.empty()) throw refuse("no name before a \"=\"");
  const std::vector<std::string> items = items_of(text.substr(equals + 1));
  scan.times = items.front().starts_with("x");
  std::string unit;  // of those that have none of their own: the last one given
  for (const std::string& item : items)
    if (item != "none" && !unit_of(item).empty()) unit = unit_of(item);
  for (std::string item : items) {
    if (item.starts_with("x") != scan.times) throw refuse("factors and values are mixed");
    if (length && item == "none" && !scan.times) {
      scan.values.push_back(std::numeric_limits<double>::infinity());
      continue;
    }
    if (scan.times) item.erase(0, 1);
    if (!scan.times && unit_of(item).empty() && !unit.empty()) item += " " + unit;
    try {
      const bool is_length = length && !scan.times;
      scan.values.push_back(
          core::parse_quantity(item, is_length ? core::Dimension::length : core::Dimension::dimensionless));
    } catch (const core::InputError& error) {
      throw refuse(error.problems().front().what);
    }
  }
  return scan;
}

}  // namespace scintray::cli
