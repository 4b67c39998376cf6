#include "scintray/scene/surface_maker.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "scintray/core/version.hpp"

namespace scintray {

namespace {

/// 64-bit FNV-1a (Fowler, Noll, Vo), to name cache files and to notice that a map file changed.
std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char byte : bytes) {
    hash ^= static_cast<unsigned char>(byte);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

/// Names a recipe's map among all others: the description and the spectrum that it only sums up.
std::string key_of(const SynthesisRecipe& recipe) {
  const SpectrumRelief& spectrum = recipe.spectrum;
  std::string points;
  for (std::size_t k = 0; k < spectrum.frequency_per_um.size(); ++k)
    points += fmt::format(" {} {}", spectrum.frequency_per_um[k], spectrum.density_um4[k]);
  return fmt::format("{}, spectrum {:016x}", describe(recipe), fnv1a(points));
}

std::string describe(const TableSettings& s) {
  return fmt::format(
      "incidence step {} rad, azimuth step {} rad, {} rays, seed {}, refine {} {} {}, grazing {} rad",
      s.incidence_step_rad, s.azimuth_step_rad, s.rays, s.seed, s.refine, s.refine_change,
      s.refine_down_to_rad, s.grazing_rad);
}

double ratio(const IndexPair& index) { return index.inside / index.outside; }

/// A table read back from the cache, or nothing when there is none that can be read.
std::shared_ptr<const SurfaceTable> read_cached(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return nullptr;
  try {
    return std::make_shared<SurfaceTable>(read_table(path));
  } catch (const Error&) {
    return nullptr;  // of an older version or damaged: built anew and written over
  }
}

void write_cached(const std::filesystem::path& path, const SurfaceTable& table) {
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  try {
    write_table(path, table);
  } catch (const Error&) {
    // The cache only saves time: a full or read-only home does not stop a run.
  }
}

}  // namespace

SurfaceMaker::SurfaceMaker() : SurfaceMaker(Hooks{}) {}

std::filesystem::path SurfaceMaker::default_cache() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto own = variable("SCINTRAY_CACHE"); !own.empty()) return own;
  if (const auto xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg / "scintray";
  if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "scintray";
  return {};
}

SurfaceMaker::Relief SurfaceMaker::relief(const RecipeSpec& spec) {
  Relief result;
  result.key = key_of(spec.recipe);
  result.provenance.map = describe(spec.recipe);
  auto& field = fields_[result.key];
  if (!field) {
    const HeightMap map = synthesize(spec.recipe);
    field = std::make_shared<HeightField>(make_height_field(map));
  }
  result.provenance.preparation = "none";
  result.provenance.tiling = "periodic";
  result.field = field;
  return result;
}

SurfaceMaker::Relief SurfaceMaker::relief(const HeightMapSpec& spec) {
  HeightMap map = read_height_map(spec.path, spec.options);
  prepare(map, spec.preparation);
  Relief result;
  result.provenance.map = spec.path.filename().string();
  result.provenance.preparation = map.history();
  result.provenance.tiling = tiling_name(map, spec.tiling);
  result.key =
      fmt::format("map {:016x}; {}; {}; pitch {} {}", fnv1a(content_of(spec.path)),
                  result.provenance.preparation, result.provenance.tiling, map.pitch_x_um, map.pitch_y_um);
  auto& field = fields_[result.key];
  if (!field) field = std::make_shared<HeightField>(make_height_field(map, spec.tiling));
  result.field = field;
  return result;
}

std::shared_ptr<const SurfaceTable> SurfaceMaker::table(const std::string& surface, const Relief& relief,
                                                        const TableSettings& settings,
                                                        const IndexPair& index) {
  const std::string key =
      fmt::format("{}; {}; indices {} {}; layout {}; ScintRay {}", relief.key, describe(settings),
                  index.inside, index.outside, kTableFileVersion, version());
  auto& known = tables_[key];
  if (known) return known;
  const auto file = hooks_.cache.empty() ? std::filesystem::path()
                                         : hooks_.cache / fmt::format("table-{:016x}.h5", fnv1a(key));
  if (!file.empty()) known = read_cached(file);
  if (known) return known;
  const auto progress = [&](double done) {
    if (hooks_.table_progress) hooks_.table_progress(surface, done);
    return !(hooks_.stop && hooks_.stop());
  };
  known = std::make_shared<SurfaceTable>(
      build_table(*relief.field, index, settings, relief.provenance, progress));
  if (!file.empty()) write_cached(file, *known);
  return known;
}

MadeSurface SurfaceMaker::make(const SurfaceSpec& spec, const Medium& inside, const Medium& outside,
                               double reference_nm, double low_nm, double high_nm) {
  MadeSurface made;
  Surface& surface = made.surface;
  surface.name = spec.name;
  surface.reflector = spec.reflector;
  surface.gap_index = spec.gap_index;
  const Curve& beyond = spec.reflector ? spec.gap_index : outside.index;
  const auto indices_at = [&](double nm) { return IndexPair{inside.index(nm), beyond(nm)}; };
  const IndexPair index = indices_at(reference_nm);

  const auto check_dispersion = [&](const IndexPair& tabulated) {
    double worst = 0.0;
    for (const double nm : {low_nm, reference_nm, high_nm})
      worst = std::max(worst, std::abs(ratio(indices_at(nm)) / ratio(tabulated) - 1.0));
    if (worst > kIndexTolerance)
      made.warnings.push_back(
          fmt::format("surface \"{}\" ({} to {}): its table is for one index ratio, {:.4f}; over the "
                      "wavelengths in use the "
                      "ratio differs by up to {:.1f} %",
                      spec.name, inside.name, outside.name, ratio(tabulated), 100.0 * worst));
  };
  const auto tabulated = [&](const Relief& map,
                             const std::optional<TableSettings>& settings) -> Microsurface {
    if (!settings) return map.field;
    auto built = table(spec.name, map, *settings, index);
    check_dispersion(built->index_pair());
    return built;
  };
  struct Visitor {
    SurfaceMaker& maker;
    const decltype(tabulated)& tabulate;
    const decltype(check_dispersion)& check;
    const SurfaceSpec& spec;
    const IndexPair& index;
    Microsurface operator()(const SmoothSpec&) const { return SmoothSurface{}; }
    Microsurface operator()(const PaintedSpec&) const { return PaintedSurface{}; }
    Microsurface operator()(const UnifiedSurface& unified) const { return unified; }
    Microsurface operator()(const HeightMapSpec& map) const { return tabulate(maker.relief(map), map.table); }
    Microsurface operator()(const RecipeSpec& recipe) const {
      return tabulate(maker.relief(recipe), recipe.table);
    }
    Microsurface operator()(const TableFileSpec& file) const {
      auto table = std::make_shared<const SurfaceTable>(read_table(file.path));
      const IndexPair& own = table->index_pair();
      if (std::abs(ratio(own) / ratio(index) - 1.0) > kIndexTolerance)
        throw InputError(
            {file.where,
             fmt::format("the table of surface \"{}\" is for indices {:.4f} to {:.4f}, but here light "
                         "goes from {:.4f} to {:.4f}",
                         spec.name, own.inside, own.outside, index.inside, index.outside),
             "build a table for these media with `scintray table build`, or name the height map itself"});
      check(own);
      return table;
    }
  };
  surface.microsurface =
      std::visit(Visitor{*this, tabulated, check_dispersion, spec, index}, spec.microsurface);
  return made;
}

}  // namespace scintray
