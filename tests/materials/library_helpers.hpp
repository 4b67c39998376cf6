#pragma once
/// A library with definitions written in the test.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scintray/scene/library.hpp"

namespace scintray {

inline const Library& shipped_library() {
  static const Library library({std::filesystem::path(SCINTRAY_SOURCE_DIR) / "materials"});
  return library;
}

/// The shipped library and one definition as a scene would give it, in "scene.toml".
inline Library library_with(LibraryKind kind, const std::string& name, const std::string& text) {
  Library library = shipped_library();
  library.add(kind, {{name, parse_toml(text, "scene.toml")}});
  return library;
}

/// A folder of library files that goes when the test ends.
class TemporaryLibrary {
 public:
  explicit TemporaryLibrary(const std::string& name)
      : folder_(std::filesystem::temp_directory_path() / ("scintray_test_" + name)) {
    std::filesystem::remove_all(folder_);
    for (const char* below : {"media", "surfaces", "sensors", "reflectors"})
      std::filesystem::create_directories(folder_ / below);
  }
  ~TemporaryLibrary() { std::filesystem::remove_all(folder_); }
  TemporaryLibrary(const TemporaryLibrary&) = delete;
  TemporaryLibrary& operator=(const TemporaryLibrary&) = delete;

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text;
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// The problems of what `action` throws; fails when it does not throw InputError.
template <class Action>
std::vector<Problem> problems_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.problems();
  }
  FAIL("no InputError was thrown");
  return {};
}

/// True when one problem stands at the line and its text or hint contains the words.
inline bool reports(const std::vector<Problem>& problems, long line, const std::string& words) {
  for (const Problem& problem : problems)
    if ((line == 0 || problem.where.line == line) && problem.text().find(words) != std::string::npos)
      return true;
  for (const Problem& problem : problems) MESSAGE(problem.text());
  return false;
}

}  // namespace scintray
