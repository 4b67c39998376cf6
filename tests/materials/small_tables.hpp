#pragma once
/// A cache of small tables, and files.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scintray/materials/table_cache.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::test {

using Path = std::filesystem::path;

inline topography::TableSettings few_rays() {
  topography::TableSettings settings;
  settings.incidence_step_rad = 45.0 * core::kDegree;
  settings.azimuth_step_rad = 90.0 * core::kDegree;
  settings.rays = 4;
  settings.refine = false;
  return settings;
}

inline optics::SurfaceTable small_table(std::uint64_t seed = 1) {
  topography::SynthesisRecipe recipe;
  recipe.gaussian = {0.1, 1.0};
  recipe.columns = recipe.rows = 32;
  recipe.seed = seed;
  return topography::build_table(topography::make_height_field(topography::synthesize(recipe)),
                                 {{420.0, {1.8, 1.0}}}, few_rays());
}

/// A cache in a folder, with what it warned of and how often it built.
struct Cache {
  explicit Cache(const Path& folder, std::uint64_t limit_bytes = materials::kDefaultCacheBytes) {
    hooks.cache = folder;
    hooks.cache_bytes = limit_bytes;
    hooks.cache_warning = [this](const std::string& warning) { warnings.push_back(warning); };
  }

  std::shared_ptr<const optics::SurfaceTable> get(const std::string& key) {
    materials::TableCache cache(hooks);
    return cache.get({key, "ground", "LSO to air"}, [&] {
      ++built;
      return small_table();
    });
  }

  materials::TableHooks hooks;
  std::vector<std::string> warnings;
  int built = 0;
};

inline std::string content_of(const Path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void write(const Path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

inline std::size_t entries(const Path& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

}  // namespace scintray::test
