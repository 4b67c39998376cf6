#pragma once
/// Exit codes of the program; README.md lists them for users.

namespace scintray::cli {

enum ExitCode : int {
  kSuccess = 0,
  kBadInput = 1,       ///< the scene, a file, or a value is wrong
  kBadUsage = 2,       ///< the command line is wrong
  kSystemFailure = 3,  ///< error of the operating system: a disk is full, a file cannot be read
  kDefect = 4,         ///< a defect in ScintRay
  kInterrupted = 130,  ///< stopped by the user; the finished part is in the results file
};

}  // namespace scintray::cli
