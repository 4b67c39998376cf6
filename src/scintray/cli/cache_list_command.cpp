#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <numeric>

#include "scintray/cli/json_answer.hpp"
#include "scintray/core/byte_size.hpp"
#include "scintray/core/text.hpp"
#include "scintray/materials/cache_folder.hpp"
#include "scintray/materials/table_cache.hpp"

namespace scintray::cli {

namespace {

using materials::CachedTable;
using materials::CacheFile;

/// The cache as it is now.
struct Listing {
  std::filesystem::path folder;
  materials::CacheLimit limit;
  std::vector<CacheFile> files;  ///< the most recently used first

  std::uint64_t bytes() const {
    return std::accumulate(files.begin(), files.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const CacheFile& file) { return sum + file.bytes; });
  }
};

Listing read_cache() {
  Listing cache{materials::default_table_cache(), materials::cache_limit(), {}};
  if (!cache.folder.empty()) cache.files = materials::CacheFolder(cache.folder).files();
  std::reverse(cache.files.begin(), cache.files.end());
  return cache;
}

std::string utc_text(const CacheFile& file) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(file.last_use)));
}

std::string indices_text(const topography::SpectralPoint& point) {
  std::string text = fmt::format("{:g} to {:g}", point.index.inside, point.index.outside);
  return point.wavelength_nm > 0.0 ? text + fmt::format(" at {:g} nm", point.wavelength_nm) : text;
}

void print_table(const CacheFile& file) {
  const std::string use = fmt::format("{}, last used {:%Y-%m-%d %H:%M}", core::byte_size_text(file.bytes),
                                      fmt::localtime(std::chrono::system_clock::to_time_t(file.last_use)));
  const std::optional<CachedTable> table = materials::describe_cached(file.path);
  if (!table) {
    std::cout << "\n"
              << file.path.filename().string() << "\n    not readable by this ScintRay; " << use << "\n";
    return;
  }
  std::cout << "\n"
            << table->surface << ", " << table->media << "\n    " << use << ", built by ScintRay "
            << table->version << "\n    indices " << core::list_of(table->spectrum, "; ", indices_text)
            << "\n    " << table->map << "\n";
  if (!table->stack.empty()) std::cout << "    stack " << table->stack << "\n";
}

void print_list(const Listing& cache) {
  if (!cache.limit.warning.empty()) std::cerr << "warning: " << cache.limit.warning << "\n";
  if (cache.folder.empty()) {
    std::cout << "no cache: neither SCINTRAY_CACHE, XDG_CACHE_HOME nor HOME is set\n";
    return;
  }
  std::cout << "folder       " << cache.folder.string() << "\n";
  for (const CacheFile& file : cache.files) print_table(file);
  std::cout << fmt::format("{}total        {} table{}, {} of at most {}\n", cache.files.empty() ? "" : "\n",
                           cache.files.size(), cache.files.size() == 1 ? "" : "s",
                           core::byte_size_text(cache.bytes()), core::byte_size_text(cache.limit.bytes));
}

Json cached_json(const CacheFile& file) {
  Json json = {{"file", file.path.string()}, {"bytes", file.bytes}, {"last_use", utc_text(file)}};
  const std::optional<CachedTable> table = materials::describe_cached(file.path);
  json["readable"] = table.has_value();
  if (!table) return json;
  json["surface"] = table->surface;
  json["media"] = table->media;
  json["map"] = table->map;
  json["stack"] = table->stack;
  json["version"] = table->version;
  json["spectrum"] = Json::array();
  for (const topography::SpectralPoint& point : table->spectrum)
    json["spectrum"].push_back({{"wavelength_nm", json_of(point.wavelength_nm)},
                                {"index_inside", json_of(point.index.inside)},
                                {"index_outside", json_of(point.index.outside)}});
  return json;
}

Json cache_json(const Listing& cache) {
  Json tables = Json::array();
  for (const CacheFile& file : cache.files) tables.push_back(cached_json(file));
  return {{"folder", cache.folder.string()},
          {"limit_bytes", cache.limit.bytes},
          {"total_bytes", cache.bytes()},
          {"tables", tables}};
}

}  // namespace

void add_cache_list_command(CLI::App& cache) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      cache.add_subcommand("list", "Print what is kept: surfaces, media, sizes, the last use of each");
  add_json_flag(*command, *json);
  command->footer("Example: scintray cache list --json");
  command->callback([json] {
    const JsonAnswer answer(*json);
    const Listing listing = read_cache();
    print_list(listing);
    answer.print([&] { return cache_json(listing); });
  });
}

}  // namespace scintray::cli
