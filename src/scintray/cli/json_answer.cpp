#include "scintray/cli/json_answer.hpp"

#include <cmath>
#include <iostream>

namespace scintray::cli {

void add_json_flag(CLI::App& command, bool& wanted) {
  command.add_flag("--json", wanted, "print the numbers as JSON, and the text on standard error");
}

JsonAnswer::JsonAnswer(bool wanted) {
  if (wanted) standard_output_ = std::cout.rdbuf(std::cerr.rdbuf());
}

JsonAnswer::~JsonAnswer() {
  if (standard_output_) std::cout.rdbuf(standard_output_);
}

void JsonAnswer::print(const std::function<Json()>& value) const {
  print_text([&] { return value().dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; });
}

void JsonAnswer::print_text(const std::function<std::string()>& text) const {
  if (standard_output_) std::ostream(standard_output_) << text() << std::flush;
}

Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_of(const core::Estimate& estimate) {
  return {{"value", json_of(estimate.value)}, {"error", json_of(estimate.error)}};
}

}  // namespace scintray::cli
