#pragma once
/// The one place where exceptions become messages and exit codes.

#include <functional>
#include <iosfwd>

namespace scintray::cli {

/// Runs `command`; whatever it throws is explained on `err`. Returns an exit code (exit_codes.hpp).
///
/// InputError: every problem with its place and hint. SystemError and failures of the standard
/// library: their text. InternalError and anything unknown: the text and a request to report it.
/// CLI::ParseError is passed on: the caller has the application that explains it.
int run_guarded(const std::function<void()>& command, std::ostream& err);

}  // namespace scintray::cli
