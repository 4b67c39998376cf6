#include "scintray/core/named_file.hpp"

#include <string>
#include <utility>
#include <vector>

namespace scintray::core {

InputError named_at(const FileLocation& where, const InputError& error) {
  const std::string place = where.text();
  if (place.empty()) return error;
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems)
    problem.hint += (problem.hint.empty() ? "" : "; ") + ("the file is named at " + place);
  return InputError(std::move(problems));
}

}  // namespace scintray::core
