#include "scintray/materials/surface_factory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "scintray/core/input_file.hpp"
#include "scintray/core/version.hpp"

namespace scintray::materials {

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

/// Names a recipe's map among all others: the description and the spectrum that it only sums up.
std::string key_of(const topography::SynthesisRecipe& recipe) {
  const topography::SpectrumRelief& spectrum = recipe.spectrum;
  std::string points;
  for (std::size_t k = 0; k < spectrum.frequency_per_um.size(); ++k)
    points += fmt::format(" {} {}", spectrum.frequency_per_um[k], spectrum.density_um4[k]);
  return fmt::format("{}, spectrum {:016x}", describe(recipe), fnv1a(points));
}

std::string describe(const topography::TableSettings& s) {
  return fmt::format(
      "incidence step {} rad, azimuth step {} rad, {} rays, seed {}, refine {} {} {}, grazing {} rad, "
      "directional {}, target error {} within {}, reciprocal {}",
      s.incidence_step_rad, s.azimuth_step_rad, s.rays, s.seed, s.refine, s.refine_change,
      s.refine_down_to_rad, s.grazing_rad, s.directional, s.target_error, s.most_rays, s.reciprocal);
}

std::string describe(const std::vector<topography::SpectralPoint>& spectrum) {
  std::string text;
  for (const topography::SpectralPoint& point : spectrum)
    text += fmt::format("{}{} nm: {} {}", text.empty() ? "" : ", ", point.wavelength_nm, point.index.inside,
                        point.index.outside);
  return text;
}

double ratio(const optics::IndexPair& index) { return index.inside / index.outside; }

/// A table read back from the cache, or nothing when there is none that can be read.
std::shared_ptr<const optics::SurfaceTable> read_cached(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return nullptr;
  try {
    return std::make_shared<optics::SurfaceTable>(optics::read_table(path));
  } catch (const core::Error&) {
    return nullptr;  // of an older version or damaged: built anew and written over
  }
}

void write_cached(const std::filesystem::path& path, const optics::SurfaceTable& table) {
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  try {
    optics::write_table(path, table);
  } catch (const core::Error&) {
    // The cache only saves time: a full or read-only home does not stop a run.
  }
}

}  // namespace

SurfaceFactory::SurfaceFactory() : SurfaceFactory(Hooks{}) {}

std::filesystem::path SurfaceFactory::default_cache() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto own = variable("SCINTRAY_CACHE"); !own.empty()) return own;
  if (const auto xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg / "scintray";
  if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "scintray";
  return {};
}

SurfaceFactory::Relief SurfaceFactory::relief(const RecipeSpec& spec) {
  Relief result;
  result.key = key_of(spec.recipe);
  result.provenance.map = describe(spec.recipe);
  auto& field = fields_[result.key];
  if (!field) {
    const topography::HeightMap map = topography::synthesize(spec.recipe);
    field = std::make_shared<optics::HeightField>(topography::make_height_field(map));
  }
  result.provenance.preparation = "none";
  result.provenance.tiling = "periodic";
  result.field = field;
  return result;
}

SurfaceFactory::Relief SurfaceFactory::relief(const HeightMapSpec& spec) {
  topography::HeightMap map = topography::read_height_map(spec.path, spec.options);
  topography::prepare(map, spec.preparation);
  Relief result;
  result.provenance.map = spec.path.filename().string();
  result.provenance.preparation = map.history();
  result.provenance.tiling = topography::tiling_name(map, spec.tiling);
  result.key =
      fmt::format("map {:016x}; {}; {}; pitch {} {}", fnv1a(core::read_whole_file(spec.path).value_or("")),
                  result.provenance.preparation, result.provenance.tiling, map.pitch_x_um, map.pitch_y_um);
  auto& field = fields_[result.key];
  if (!field) field = std::make_shared<optics::HeightField>(topography::make_height_field(map, spec.tiling));
  result.field = field;
  return result;
}

std::shared_ptr<const optics::SurfaceTable> SurfaceFactory::table(
    const std::string& surface, const Relief& relief, const topography::TableSettings& settings,
    const std::vector<topography::SpectralPoint>& spectrum) {
  const std::string key =
      fmt::format("{}; {}; indices {}; layout {}; ScintRay {}", relief.key, describe(settings),
                  describe(spectrum), optics::kTableFileVersion, core::version());
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
  known = std::make_shared<optics::SurfaceTable>(
      topography::build_table(*relief.field, spectrum, settings, relief.provenance, progress));
  if (!file.empty()) write_cached(file, *known);
  return known;
}

namespace {

/// What a surface lies between, and the wavelengths in use.
struct Setting {
  const SurfaceSpec& spec;
  const optics::Medium &inside, &outside;
  double reference_nm, low_nm, high_nm;

  /// Indices on the two sides of the microsurface.
  optics::IndexPair indices(double nm) const {
    const bool layer = spec.reflector || spec.gap_thickness_um;
    return {inside.index(nm), layer ? spec.gap_index(nm) : outside.index(nm)};
  }
  std::vector<topography::SpectralPoint> spectrum(const std::vector<double>& wavelengths_nm) const {
    if (wavelengths_nm.empty()) return {{reference_nm, indices(reference_nm)}};
    std::vector<topography::SpectralPoint> points;
    for (const double nm : wavelengths_nm) points.push_back({nm, indices(nm)});
    return points;
  }
};

/// The ratio of indices that a table stands for at a wavelength. Of a stack that lets nothing through, only
/// the inside index matters.
double tabulated_ratio(const optics::SurfaceTable& table, double nm) {
  const auto of_slice = [&](std::size_t spectral) {
    const optics::IndexPair& index = table.index_pair(spectral * table.azimuths());
    return table.opaque() ? index.inside : ratio(index);
  };
  const std::vector<double>& at = table.wavelengths_nm();
  if (at.size() == 1) return of_slice(0);
  const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, nm);
  const auto k = static_cast<std::size_t>(above - at.begin());
  const double share = std::clamp((nm - at[k - 1]) / (at[k] - at[k - 1]), 0.0, 1.0);
  return of_slice(k - 1) + share * (of_slice(k) - of_slice(k - 1));
}

/// Relative difference between the indices here and the table's.
double mismatch(const optics::SurfaceTable& table, const Setting& setting, double nm) {
  const optics::IndexPair here = setting.indices(nm);
  return std::abs((table.opaque() ? here.inside : ratio(here)) / tabulated_ratio(table, nm) - 1.0);
}

void warn_of_dispersion(const optics::SurfaceTable& table, const Setting& setting,
                        std::vector<std::string>& warnings) {
  double worst = 0.0;
  for (const double nm : {setting.low_nm, setting.reference_nm, setting.high_nm})
    worst = std::max(worst, mismatch(table, setting, nm));
  if (worst > SurfaceFactory::kIndexTolerance)
    warnings.push_back(fmt::format(
        "surface \"{}\" ({} to {}): over the wavelengths in use, {:.0f} to {:.0f} nm, the ratio of indices "
        "differs from its table's by up to {:.1f} %; a table for more wavelengths would follow it "
        "(tracing.wavelengths)",
        setting.spec.name, setting.inside.name, setting.outside.name, setting.low_nm, setting.high_nm,
        100.0 * worst));
}

std::shared_ptr<const optics::SurfaceTable> load_table(const TableFileSpec& file, const Setting& setting) {
  auto table = std::make_shared<const optics::SurfaceTable>(optics::read_table(file.path));
  const std::string& name = setting.spec.name;
  if (table->absorbs() && (setting.spec.reflector || setting.spec.gap_thickness_um))
    throw core::InputError(
        {file.where,
         "the table of surface \"" + name + "\" holds a whole stack (" + table->provenance().stack +
             "), and another lies on it",
         "remove the surface's gap and reflector, or name a table of the bare microsurface"});
  if (mismatch(*table, setting, setting.reference_nm) > SurfaceFactory::kIndexTolerance) {
    const optics::IndexPair own = table->index_pair(), here = setting.indices(setting.reference_nm);
    throw core::InputError(
        {file.where,
         fmt::format("the table of surface \"{}\" is for indices {:.4f} to {:.4f}, but here light goes from "
                     "{:.4f} to {:.4f}",
                     name, own.inside, own.outside, here.inside, here.outside),
         "build a table for these media with `scintray table build`, or name the height map itself"});
  }
  return table;
}

}  // namespace

MadeSurface SurfaceFactory::make(const SurfaceSpec& spec, const optics::Medium& inside,
                                 const optics::Medium& outside, double reference_nm, double low_nm,
                                 double high_nm) {
  MadeSurface made;
  optics::Surface& surface = made.surface;
  surface.name = surface.definition = spec.name;
  for (const ShareSpec& part : spec.mixture) {
    MadeSurface share = make(*part.surface, inside, outside, reference_nm, low_nm, high_nm);
    surface.mixture.push_back(
        {part.share, std::make_shared<const optics::Surface>(std::move(share.surface))});
    made.warnings.insert(made.warnings.end(), share.warnings.begin(), share.warnings.end());
  }
  if (!spec.mixture.empty()) return made;

  surface.reflector = spec.reflector;
  surface.gap_index = spec.gap_index;
  surface.gap_absorption_per_mm = spec.gap_absorption_per_mm;
  surface.gap_medium = spec.gap;
  surface.gap_shifter = spec.gap_shifter;
  surface.gap_thickness_um = spec.gap_thickness_um;
  surface.direction = spec.direction;
  const Setting setting{spec, inside, outside, reference_nm, low_nm, high_nm};
  const auto of_relief = [&](const Relief& map,
                             const std::optional<TracingSpec>& tracing) -> optics::Microsurface {
    if (!tracing) return map.field;
    return table(spec.name, map, tracing->settings, setting.spectrum(tracing->wavelengths_nm));
  };
  struct Visitor {
    SurfaceFactory& factory;
    const decltype(of_relief)& tabulate;
    const Setting& setting;
    optics::Microsurface operator()(const SmoothSpec&) const { return optics::SmoothSurface{}; }
    optics::Microsurface operator()(const PaintedSpec&) const { return optics::PaintedSurface{}; }
    optics::Microsurface operator()(const optics::UnifiedSurface& unified) const { return unified; }
    optics::Microsurface operator()(const HeightMapSpec& map) const {
      return tabulate(factory.relief(map), map.table);
    }
    optics::Microsurface operator()(const RecipeSpec& recipe) const {
      return tabulate(factory.relief(recipe), recipe.table);
    }
    optics::Microsurface operator()(const TableFileSpec& file) const { return load_table(file, setting); }
  };
  surface.microsurface = std::visit(Visitor{*this, of_relief, setting}, spec.microsurface);
  if (const auto* tabulated = std::get_if<std::shared_ptr<const optics::SurfaceTable>>(&surface.microsurface))
    warn_of_dispersion(**tabulated, setting, made.warnings);
  return made;
}

}  // namespace scintray::materials
