#include "scintray/cli/commands.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <new>
#include <ostream>
#include <string>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/core/cancelled.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/version.hpp"

namespace scintray::cli {

namespace {

int report_input_error(const core::InputError& error, std::ostream& err) {
  for (const core::Problem& problem : error.problems()) err << problem.text() << '\n';
  if (error.problems().size() > 1) err << error.problems().size() << " problems\n";
  return kBadInput;
}

int report_system_error(const std::string& what, std::ostream& err) {
  err << "error: " << what << '\n';
  return kSystemFailure;
}

int report_defect(const std::string& what, std::ostream& err) {
  err << "internal error: " << what << '\n'
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
