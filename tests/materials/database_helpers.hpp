#pragma once
/// A material database with definitions written in the test.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <type_traits>

#include "scintray/detector/microcells.hpp"
#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/optics/facets.hpp"
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

/// The microsurface of a definition as one of a class: of optics, or a definition of materials. Nullptr when
/// it is of another.
template <typename Model>
const Model* microsurface_if(const materials::SurfaceSpec& surface) {
  if constexpr (std::is_base_of_v<optics::MicrosurfaceModel, Model>) {
    const auto* fixed = surface.microsurface.get_if<materials::FixedMicrosurface>();
    return fixed ? fixed->microsurface().template get_if<Model>() : nullptr;
  } else {
    return surface.microsurface.get_if<Model>();
  }
}
template <typename Model>
bool holds_microsurface(const materials::SurfaceSpec& surface) {
  return microsurface_if<Model>(surface) != nullptr;
}
template <typename Model>
Model microsurface_of(const materials::SurfaceSpec& surface) {
  const Model* model = microsurface_if<Model>(surface);
  REQUIRE(model != nullptr);
  return *model;
}

/// The cells of a sensor that has them.
inline std::optional<detector::Microcells> microcells_of(const detector::Sensor& sensor) {
  const auto* model = sensor.avalanches.get_if<detector::MicrocellModel>();
  return model ? std::optional(model->cells) : std::nullopt;
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
