#include "scintray/materials/relief_store.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "scintray/core/version.hpp"

namespace scintray::materials {

namespace {

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

/// A table from the cache; null when there is none that can be read.
std::shared_ptr<const optics::SurfaceTable> read_cached(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return nullptr;
  try {
    return std::make_shared<optics::SurfaceTable>(optics::read_table(path));
  } catch (const core::Error&) {
    return nullptr;  // of an older version or damaged: built again and overwritten
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

std::filesystem::path default_table_cache() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto own = variable("SCINTRAY_CACHE"); !own.empty()) return own;
  if (const auto xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg / "scintray";
  if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "scintray";
  return {};
}

std::uint64_t content_hash(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char byte : bytes) {
    hash ^= static_cast<unsigned char>(byte);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

std::shared_ptr<const optics::HeightField> ReliefStore::field(
    const std::string& key, const std::function<optics::HeightField()>& make) {
  auto& known = fields_[key];
  if (!known) known = std::make_shared<const optics::HeightField>(make());
  return known;
}

std::shared_ptr<const optics::SurfaceTable> ReliefStore::table(
    const std::string& surface, const Relief& relief, const topography::TableSettings& settings,
    const std::vector<topography::SpectralPoint>& spectrum) {
  const std::string key =
      fmt::format("{}; {}; indices {}; layout {}; ScintRay {}", relief.key, describe(settings),
                  describe(spectrum), optics::kTableFileVersion, core::version());
  auto& known = tables_[key];
  if (known) return known;
  const auto file = hooks_.cache.empty() ? std::filesystem::path()
                                         : hooks_.cache / fmt::format("table-{:016x}.h5", content_hash(key));
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

}  // namespace scintray::materials
