/// Keys of tables: whatever changes a table changes its key.

#include "scintray/materials/table_key.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <functional>
#include <set>

#include "scintray/core/version.hpp"
#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/facets.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::materials;
using namespace scintray::optics;
using namespace scintray::topography;

namespace {

/// Checks that every change of an object, from the same start, gives a key of its own.
template <typename Object, typename Key>
void check_changes(const Object& start, const Key& key_of,
                   const std::vector<std::function<void(Object&)>>& changes) {
  std::set<std::string> keys{key_of(start)};
  CHECK(key_of(Object(start)) == *keys.begin());
  for (std::size_t k = 0; k < changes.size(); ++k) {
    CAPTURE(k);
    Object changed = start;
    changes[k](changed);
    CHECK(keys.insert(key_of(changed)).second);
  }
}

constexpr double kUp = 1.0 + 1e-15;  ///< to a neighbouring number

std::vector<SpectralPoint> spectrum() { return {{420.0, {1.82, 1.0}}, {500.0, {1.80, 1.0}}}; }

SurfaceSpec wrapped() {
  SurfaceSpec surface;
  surface.name = "wrapped";
  surface.gap = "grease";
  surface.gap_index = core::Curve({400.0, 500.0}, {1.5, 1.4});
  surface.gap_thickness_um = 10.0;
  surface.reflector = Reflector{"ESR", core::Curve::constant(0.98), 1.0};
  return surface;
}

}  // namespace

TEST_CASE("every member of a recipe is in its key, to the last bit") {
  SynthesisRecipe start = ground_recipe();
  start.gaussian.lay_length_um = 9.0;
  start.gaussian.lay_angle_rad = 0.3;
  start.scratches = {10.0, 30.0, 0.02, 0.5};
  start.k_correlation = {0.1, 2.0, 3.0};
  start.spectrum = {{0.1, 1.0}, {1.0, 0.1}};
  check_changes<SynthesisRecipe>(start, recipe_key,
                                 {[](auto& r) { r.name = "mine"; },
                                  [](auto& r) { r.gaussian.rms_height_um *= kUp; },
                                  [](auto& r) { r.gaussian.correlation_length_um *= kUp; },
                                  [](auto& r) { r.gaussian.lay_length_um *= kUp; },
                                  [](auto& r) { r.gaussian.lay_angle_rad *= kUp; },
                                  [](auto& r) { r.fracture.spacing_um *= kUp; },
                                  [](auto& r) { r.fracture.rise_um *= kUp; },
                                  [](auto& r) { r.fracture.exponent *= kUp; },
                                  [](auto& r) { r.fracture.depth_spread_um *= kUp; },
                                  [](auto& r) { r.fracture.size_spread *= kUp; },
                                  [](auto& r) { r.scratches.spacing_um *= kUp; },
                                  [](auto& r) { r.scratches.length_um *= kUp; },
                                  [](auto& r) { r.scratches.depth_um *= kUp; },
                                  [](auto& r) { r.scratches.width_um *= kUp; },
                                  [](auto& r) { r.k_correlation.rms_height_um *= kUp; },
                                  [](auto& r) { r.k_correlation.knee_length_um *= kUp; },
                                  [](auto& r) { r.k_correlation.exponent *= kUp; },
                                  [](auto& r) { r.spectrum.frequency_per_um[1] *= kUp; },
                                  [](auto& r) { r.spectrum.density_um4[0] *= kUp; },
                                  [](auto& r) { r.columns += 1; },
                                  [](auto& r) { r.rows += 1; },
                                  [](auto& r) { r.pitch_um *= kUp; },
                                  [](auto& r) { r.seed += 1; }});
}

TEST_CASE("every setting of a table is in its key") {
  check_changes<TableSettings>(
      {}, [](const TableSettings& s) { return table_key("surface", s, spectrum()); },
      {[](auto& s) { s.incidence_step_rad *= kUp; }, [](auto& s) { s.azimuth_step_rad *= kUp; },
       [](auto& s) { s.rays += 1; }, [](auto& s) { s.seed += 1; }, [](auto& s) { s.refine = !s.refine; },
       [](auto& s) { s.refine_change *= kUp; }, [](auto& s) { s.refine_down_to_rad *= kUp; },
       [](auto& s) { s.grazing_rad *= kUp; }, [](auto& s) { s.directional = true; },
       [](auto& s) { s.target_error = 0.01; }, [](auto& s) { s.most_rays += 1; },
       [](auto& s) { s.reciprocal = true; }});
}

TEST_CASE("surface, wavelengths and indices are in the key of a table, and versions") {
  struct Parts {
    std::string surface = "surface";
    std::vector<SpectralPoint> at = spectrum();
  };
  const auto key_of = [](const Parts& parts) { return table_key(parts.surface, {}, parts.at); };
  check_changes<Parts>(Parts(), key_of,
                       {[](auto& p) { p.surface = "other"; }, [](auto& p) { p.at[1].wavelength_nm *= kUp; },
                        [](auto& p) { p.at[0].index.inside *= kUp; },
                        [](auto& p) { p.at[0].index.outside *= kUp; }, [](auto& p) { p.at.pop_back(); }});
  CHECK(key_of({}).find("content " + std::to_string(kTableContentVersion)) != std::string::npos);
  CHECK(key_of({}).find("release " + core::release()) != std::string::npos);
  CHECK(key_of({}).find("layout " + std::to_string(kTableFileVersion)) != std::string::npos);
}

TEST_CASE("a height map is keyed by its content, not by its place or time") {
  const auto folder = test::scratch_folder("table_key");
  std::filesystem::create_directory(folder / "moved");
  std::ofstream(folder / "map.txt") << "1 2\n3 4\n";
  std::ofstream(folder / "other.txt") << "1 2\n3 4\n";
  std::filesystem::copy(folder / "map.txt", folder / "moved" / "map.txt");
  const auto time = std::filesystem::last_write_time(folder / "map.txt");
  const auto key_at = [](const std::filesystem::path& path) {
    return height_map_key({path, {}, {}, Tiling::mirror});
  };
  const std::string before = key_at(folder / "map.txt");
  CHECK(key_at(folder / "moved" / "map.txt") == before);
  CHECK(key_at(folder / "other.txt") != before);  // the name is in the table's provenance
  std::ofstream(folder / "map.txt") << "1 2\n3 5\n";
  std::filesystem::last_write_time(folder / "map.txt", time);
  CHECK(key_at(folder / "map.txt") != before);
}

TEST_CASE("reading, preparation and tiling of a height map are in its key") {
  struct Parts {
    ReadOptions options;
    Preparation preparation;
    Tiling tiling = Tiling::mirror;
  };
  Parts start;
  start.options.width_um = 90.0;
  start.preparation.outlier_limit = 6.0;
  start.preparation.gaussian_um = 0.5;
  const std::filesystem::path none;
  check_changes<Parts>(
      start,
      [&](const Parts& p) {
        return height_map_key({none, p.options, p.preparation, p.tiling});
      },
      {[](auto& p) { p.options.pitch_um = 1.0; }, [](auto& p) { *p.options.width_um *= kUp; },
       [](auto& p) { p.options.height_unit_um = 1.0; }, [](auto& p) { p.options.channel = "Height"; },
       [](auto& p) { p.options.periodic = true; }, [](auto& p) { p.options.query_gwyddion = false; },
       [](auto& p) {
         p.preparation.crop = CropBox{0, 0, 4, 4};
       },
       [](auto& p) {
         p.preparation.crop = CropBox{0, 0, 4, 5};
       },
       [](auto& p) {
         p.preparation.crop = CropLengths{0.0, 0.0, 4.0, 4.0};
       },
       [](auto& p) { *p.preparation.outlier_limit *= kUp; },
       [](auto& p) { p.preparation.outlier_radius = 3; }, [](auto& p) { p.preparation.fill_missing = true; },
       [](auto& p) { p.preparation.median_radius = 1; }, [](auto& p) { p.preparation.loess_width_um = 1.0; },
       [](auto& p) { *p.preparation.gaussian_um *= kUp; },
       [](auto& p) { p.preparation.leveling.kind = Leveling::Kind::mean; },
       [](auto& p) { p.preparation.leveling.degree = 2; }, [](auto& p) { p.tiling = Tiling::periodic; }});
}

TEST_CASE("every layer of a stack is in its key; names are not") {
  const auto key_of = [](const SurfaceSpec& s) { return stack_key(s).value(); };
  check_changes<SurfaceSpec>(
      wrapped(), key_of,
      {[](auto& s) {
         s.gap_index = core::Curve({400.0, 500.0}, {1.5, 1.4 * kUp});
       },
       [](auto& s) { s.gap_absorption_per_mm = core::Curve::constant(0.1); },
       [](auto& s) { s.gap_thickness_um.reset(); }, [](auto& s) { s.gap_thickness_um = 11.0; },
       [](auto& s) { s.reflector.reset(); },
       [](auto& s) { s.reflector->reflectance = core::Curve::constant(0.98 * kUp); },
       [](auto& s) { s.reflector->specular_share = 0.9; }, [](auto& s) { s.reflector->volume_index = 1.35; },
       [](auto& s) { s.reflector->transmittance = core::Curve::constant(0.01); },
       [](auto& s) { s.direction = core::Vec3::UnitY(); },
       [](auto& s) { s.microsurface = FixedMicrosurface(PaintedSurface(), "painted"); },
       [](auto& s) { s.microsurface = RecipeSpec(); },
       [](auto& s) {
         RecipeSpec tabulated;
         tabulated.table.emplace();
         s.microsurface = tabulated;
       },
       [](auto& s) {
         s.mixture = {{0.5, std::make_shared<const SurfaceSpec>(wrapped())},
                      {0.5, std::make_shared<const SurfaceSpec>()}};
       },
       [](auto& s) {
         s.mixture = {{0.4, std::make_shared<const SurfaceSpec>(wrapped())},
                      {0.6, std::make_shared<const SurfaceSpec>()}};
       }});
  SurfaceSpec renamed = wrapped();
  renamed.name = "renamed";
  renamed.reflector->name = "film";
  CHECK(key_of(renamed) == key_of(wrapped()));
}

TEST_CASE("a stack of unknown content has no key") {
  SurfaceSpec outside = wrapped();
  outside.microsurface = FixedMicrosurface(FacetSurface());
  CHECK_FALSE(stack_key(outside).has_value());
  SurfaceSpec mixed;
  mixed.mixture = {{1.0, std::make_shared<const SurfaceSpec>(outside)}};
  CHECK_FALSE(stack_key(mixed).has_value());
}
