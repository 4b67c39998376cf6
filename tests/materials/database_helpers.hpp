#pragma once
/// A material database with definitions written in the test.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scintray/materials/database.hpp"
#include "support/shared.hpp"

namespace scintray {

inline const materials::MaterialDatabase& shipped_database() {
  static const materials::MaterialDatabase database({test::source_file("materials")});
  return database;
}

/// The shipped database and one definition as a scene would give it, in "scene.toml".
inline materials::MaterialDatabase database_with(materials::DefinitionKind kind, const std::string& name,
                                                 const std::string& text) {
  materials::MaterialDatabase database = shipped_database();
  database.add(kind, {{name, config::parse_toml(text, "scene.toml")}});
  return database;
}

/// A folder of database files that is removed when the test ends.
class TemporaryDatabase {
 public:
  explicit TemporaryDatabase(const std::string& name)
      : folder_(std::filesystem::temp_directory_path() / ("scintray_test_" + name)) {
    std::filesystem::remove_all(folder_);
    for (const char* below : {"media", "surfaces", "sensors", "reflectors"})
      std::filesystem::create_directories(folder_ / below);
  }
  ~TemporaryDatabase() { std::filesystem::remove_all(folder_); }
  TemporaryDatabase(const TemporaryDatabase&) = delete;
  TemporaryDatabase& operator=(const TemporaryDatabase&) = delete;

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text;
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// The problems of what `action` throws; fails when it does not throw InputError.
template <class Action>
std::vector<core::Problem> problems_of(const Action& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    return error.problems();
  }
  FAIL("no InputError was thrown");
  return {};
}

/// True when one problem stands at the line and its text or hint contains the words.
inline bool reports(const std::vector<core::Problem>& problems, long line, const std::string& words) {
  for (const core::Problem& problem : problems)
    if ((line == 0 || problem.where.line == line) && problem.text().find(words) != std::string::npos)
      return true;
  for (const core::Problem& problem : problems) MESSAGE(problem.text());
  return false;
}

}  // namespace scintray
