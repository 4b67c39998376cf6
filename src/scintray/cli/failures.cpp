#include "scintray/cli/commands.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <map>
#include <new>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "scintray/cli/alike.hpp"
#include "scintray/cli/error_kinds.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/cancelled.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/core/version.hpp"

namespace scintray::cli {

namespace {

/// Problems of one kind above this number share one message.
constexpr std::size_t kFewAlike = 3;

/// Problems that differ in numbers, and in numbers of names, only.
struct Kind {
  std::vector<const core::Problem*> problems;
};

/// "lines 12, 15, 20 and 61 more": where the problems after the first are.
std::string other_places(const Kind& kind) {
  constexpr std::size_t kMostPlaces = 8;
  std::set<long> lines;
  for (std::size_t i = 1; i < kind.problems.size(); ++i)
    if (kind.problems[i]->where.line > 0) lines.insert(kind.problems[i]->where.line);
  if (lines.empty()) return "";
  std::string text = lines.size() > 1 ? ", at lines " : ", at line ";
  std::size_t named = 0;
  for (const long line : lines) {
    if (named == kMostPlaces) break;
    text += (named++ > 0 ? ", " : "") + std::to_string(line);
  }
  return named < lines.size() ? text + " and " + std::to_string(lines.size() - named) + " more" : text;
}

/// The message of a problem, with the code of its kind after the finding.
std::string message(core::Problem problem) {
  problem.what += std::string(" [") + input_error_code(problem.what, problem.hint) + "]";
  return problem.text();
}

void print_kind(const Kind& kind, std::ostream& err) {
  if (kind.problems.size() <= kFewAlike) {
    for (const core::Problem* problem : kind.problems) err << message(*problem) << '\n';
    return;
  }
  const core::Problem& first = *kind.problems.front();
  err << message(first) << '\n'
      << "  and " << kind.problems.size() - 1 << " more of this kind" << other_places(kind) << '\n';
  const std::string hint = core::with_patterns(first.hint);
  if (hint != first.hint) err << "  for all of them: " << hint << '\n';
}

int report_input_error(const core::InputError& error, std::ostream& err) {
  std::vector<Kind> kinds;
  std::map<std::string, std::size_t> known;
  for (const core::Problem& problem : error.problems()) {
    const std::string key = problem.where.file + '\n' + without_numbers(core::with_patterns(problem.what));
    const auto [at, is_new] = known.try_emplace(key, kinds.size());
    if (is_new) kinds.emplace_back();
    kinds[at->second].problems.push_back(&problem);
  }
  for (const Kind& kind : kinds) print_kind(kind, err);
  const std::size_t count = error.problems().size();
  const bool some_shared = std::any_of(kinds.begin(), kinds.end(),
                                       [](const Kind& kind) { return kind.problems.size() > kFewAlike; });
  if (count > 1)
    err << count << " problems"
        << (some_shared ? " of " + std::to_string(kinds.size()) + (kinds.size() > 1 ? " kinds" : " kind")
                        : "")
        << '\n';
  return kBadInput;
}

int report_system_error(const std::string& what, std::ostream& err) {
  err << "error: " << what << " [" << kSystemError << "]\n";
  return kSystemFailure;
}

int report_defect(const std::string& what, std::ostream& err) {
  err << "internal error: " << what << " [" << kDefectError << "]\n"
      << "  This is a defect in ScintRay, not in your input. Please report it with this message, the\n"
      << "  version (" << core::version() << "), and the scene file.\n";
  return kDefect;
}

}  // namespace

int run_guarded(const std::function<void()>& command, std::ostream& err) {
  try {
    command();
    return kSuccess;
  } catch (const CLI::ParseError&) {
    throw;
  } catch (const core::InputError& error) {
    return report_input_error(error, err);
  } catch (const core::Cancelled& error) {
    err << "stopped: " << error.what() << '\n';
    return kInterrupted;
  } catch (const core::SystemError& error) {
    return report_system_error(error.what(), err);
  } catch (const std::filesystem::filesystem_error& error) {
    return report_system_error(error.what(), err);
  } catch (const std::bad_alloc&) {
    return report_system_error("out of memory", err);
  } catch (const std::exception& error) {
    return report_defect(error.what(), err);
  } catch (...) {
    return report_defect("an exception of unknown type", err);
  }
}

}  // namespace scintray::cli
