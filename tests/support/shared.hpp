#pragma once
/// Files that tests read and write: of this repository, of this build, and beside the checkout.

#include <filesystem>
#include <optional>
#include <string>

namespace scintray::test {

/// `relative` inside the shared folder beside the repository, or nothing (and a line that marks the
/// test as skipped) when it is not there.
std::optional<std::filesystem::path> shared_file(const std::string& relative);

/// A file of this repository.
std::filesystem::path source_file(const std::string& relative);

/// The program of this build, once its target is built.
std::filesystem::path program_file();

/// An empty folder for one test's files, below the build folder; gone when the test program ends.
std::filesystem::path scratch_folder(const std::string& name);

/// The folder where the tests of one run of ctest keep surface tables for each other. It has none when ctest
/// starts, so that all are of this build. A test program that is run without ctest has a folder of its own.
std::filesystem::path tables_of_this_run();

}  // namespace scintray::test
