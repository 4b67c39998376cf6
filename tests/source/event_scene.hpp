#pragma once
/// Small scenes for events, and sources read from text.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/gamma_source.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/source/event.hpp"
#include "support/shared.hpp"

namespace scintray::test {

/// A file beside which relative paths count.
inline std::string scene_path() { return source_file("test.toml").string(); }

/// Parts in the given ambient; every face smooth.
inline scene::Scene scene_of(const std::string& parts, const std::string& ambient = "vacuum") {
  const std::string text = "ambient = \"" + ambient + "\"\n" + parts + R"(
[source]
type = "photons"
position = ["0 mm", "0 mm", "0 mm"]
direction = "isotropic"
wavelength = "420 nm"
photons = 1
[surfaces.flat]
model = "smooth"
)";
  materials::SurfaceFactory::Hooks hooks;
  hooks.cache.clear();
  return scene::SceneBuilder(hooks).build(scene_file::SceneFile::from_text(text, scene_path()).spec(0)).scene;
}

/// A box about the origin.
inline std::string box_part(const std::string& name, const std::string& medium, const core::Vec3& size_mm,
                            const std::string& more = "") {
  return fmt::format(
      R"(
[[part]]
name = "{}"
box = {{ low = [{}, {}, {}], high = [{}, {}, {}] }}
medium = "{}"
surface = "flat"
{}
)",
      name, fmt::format("\"{} mm\"", -0.5 * size_mm.x()), fmt::format("\"{} mm\"", -0.5 * size_mm.y()),
      fmt::format("\"{} mm\"", -0.5 * size_mm.z()), fmt::format("\"{} mm\"", 0.5 * size_mm.x()),
      fmt::format("\"{} mm\"", 0.5 * size_mm.y()), fmt::format("\"{} mm\"", 0.5 * size_mm.z()), medium, more);
}

/// A cube of LSO about the origin in empty space.
inline scene::Scene lso_cube(double edge_mm) {
  return scene_of(box_part("crystal", "LSO", core::Vec3::Constant(edge_mm)));
}

/// Reads the keys of [source]; throws InputError with all that is wrong.
inline scene_file::GammaSpec gamma_spec(const std::string& source,
                                        const std::vector<std::string>& parts = {"crystal"}) {
  core::Problems problems;
  const config::TomlTable table(config::parse_toml(source, scene_path()), problems);
  const scene_file::GammaSpec spec = scene_file::read_gamma_source(table, parts);
  table.finish();
  problems.throw_if_any();
  return spec;
}

inline std::unique_ptr<source::EventSource> event_source(const std::string& source, const scene::Scene& scene,
                                                         std::vector<std::string>* notes = nullptr) {
  std::vector<std::string> parts;
  for (const scene::PartInfo& part : scene.parts) parts.push_back(part.name);
  return source::make_event_source(gamma_spec(source, parts), scene, notes);
}

inline source::Event make_event(const source::EventSource& source, const scene::Scene& scene,
                                std::uint64_t number) {
  core::Rng rng(1, core::StreamKind::event, number);
  return source.make(scene, number, rng);
}

inline double deposited_keV(const source::Event& event) {
  double sum = 0.0;
  for (const source::Deposit& deposit : event.deposits) sum += deposit.energy_keV;
  return sum;
}

/// What an InputError states in full.
template <class Action>
std::string complaint(const Action& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    std::string text;
    for (const core::Problem& problem : error.problems()) text += problem.text() + "\n";
    return text;
  }
  FAIL("no InputError was thrown");
  return {};
}

inline bool says(const std::string& text, const std::string& words) {
  if (text.find(words) != std::string::npos) return true;
  MESSAGE(text);
  return false;
}

}  // namespace scintray::test
