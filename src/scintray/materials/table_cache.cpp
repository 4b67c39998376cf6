#include "scintray/materials/table_cache.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "scintray/core/byte_size.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/file_lock.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/optics/table_group.hpp"

namespace scintray::materials {

namespace {

constexpr std::chrono::milliseconds kWait{100};

/// Group of a table file with what the cache adds, a dataset of one text each.
constexpr const char* kGroup = "cache";

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// True when the bytes of a file are those that were written. A file of an earlier ScintRay has no such seal
/// and its table is built again.
bool is_whole(const std::filesystem::path& path) { return core::h5::seal_of(path) == core::h5::Seal::intact; }

/// A text of the group; empty when it is missing.
std::string read_text(const core::h5::Group& group, const std::string& name) {
  if (!group.has(name)) return {};
  const std::vector<std::string> texts = group.read_strings(name);
  return texts.size() == 1 ? texts.front() : std::string();
}

/// Writes what describe_cached() returns.
void write_description(core::h5::Group& group, const CacheEntry& entry, const optics::SurfaceTable& table) {
  group.write_strings("surface", {entry.surface});
  group.write_strings("media", {entry.media});
  group.write_strings("map", {table.provenance().map});
  group.write_strings("stack", {table.provenance().stack});
  group.write_strings("version", {table.provenance().version});
  std::vector<double> inside, outside;
  for (std::size_t k = 0; k < table.wavelengths_nm().size(); ++k) {
    const optics::IndexPair& index = table.index_pair(k * table.azimuths());
    inside.push_back(index.inside);
    outside.push_back(index.outside);
  }
  group.write("wavelength_nm", table.wavelengths_nm());
  group.write("index_inside", inside);
  group.write("index_outside", outside);
}

}  // namespace

std::filesystem::path default_table_cache() {
  if (const std::string own = environment("SCINTRAY_CACHE"); !own.empty()) return own;
  if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty())
    return std::filesystem::path(xdg) / "scintray";
  if (const std::string home = environment("HOME"); !home.empty())
    return std::filesystem::path(home) / ".cache" / "scintray";
  return {};
}

CacheLimit cache_limit() {
  const std::string text = environment("SCINTRAY_CACHE_SIZE");
  if (text.empty()) return {};
  if (const std::optional<std::uint64_t> bytes = core::parse_byte_size(text)) return {*bytes, {}};
  return {
      kDefaultCacheBytes,
      fmt::format("SCINTRAY_CACHE_SIZE is {}; expected a size with its unit, as \"2 GiB\" or \"500 MB\", or "
                  "0; the limit is {}",
                  core::in_quotes(text), core::byte_size_text(kDefaultCacheBytes))};
}

TableCache::TableCache(const TableHooks& hooks) : hooks_(hooks), folder_(hooks.cache) {
  if (hooks_.cache.empty()) return;
  const CacheLimit limit = hooks_.cache_bytes ? CacheLimit{*hooks_.cache_bytes, {}} : cache_limit();
  limit_bytes_ = limit.bytes;
  if (!limit.warning.empty()) warn(limit.warning);
}

std::shared_ptr<const optics::SurfaceTable> TableCache::get(
    const CacheEntry& entry, const std::function<optics::SurfaceTable()>& build) {
  if (limit_bytes_ == 0) return std::make_shared<const optics::SurfaceTable>(build());
  if (auto kept = find(entry)) return kept;
  const std::optional<core::FileLock> held = lock(entry);
  if (held)  // whoever held it before may have built this table
    if (auto kept = find(entry)) return kept;
  auto table = std::make_shared<const optics::SurfaceTable>(build());
  keep(entry, *table);
  return table;
}

std::shared_ptr<const optics::SurfaceTable> TableCache::find(const CacheEntry& entry) {
  const core::InputRecord apart;  // whether a table was kept changes no result
  const std::filesystem::path path = folder_.file_of(entry.key);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return nullptr;
  try {
    if (is_whole(path)) {
      const core::h5::File file = core::h5::File::open(path);
      if (read_text(file.root().open_group(kGroup), "key") != entry.key) return nullptr;
      auto table = std::make_shared<const optics::SurfaceTable>(optics::read_table(file));
      CacheFolder::mark_used(path);
      return table;
    }
  } catch (const core::Error&) {  // of another layout
  }
  if (!std::filesystem::exists(path, error)) return nullptr;  // removed by another process in between
  warn(fmt::format("the cached table of \"{}\" cannot be read, and is built again ({})", entry.surface,
                   path.string()));
  return nullptr;
}

std::optional<core::FileLock> TableCache::lock(const CacheEntry& entry) {
  try {
    folder_.make();
    while (true) {
      if (std::optional<core::FileLock> taken = folder_.try_lock(entry.key)) return taken;
      if (hooks_.table_waiting) hooks_.table_waiting(entry.surface);
      if (hooks_.stop && hooks_.stop())
        throw topography::TableStopped("waiting for a surface table was stopped");
      std::this_thread::sleep_for(kWait);
    }
  } catch (const core::SystemError&) {
    return std::nullopt;  // two processes may build the same table; whether it can be kept, keep() finds out
  }
}

void TableCache::keep(const CacheEntry& entry, const optics::SurfaceTable& table) {
  const core::InputRecord apart;
  const std::filesystem::path path = folder_.file_of(entry.key);
  std::error_code ignored;
  try {
    if (!is_whole(path)) std::filesystem::remove(path, ignored);  // whatever it is: its name is the cache's
    core::h5::File file = core::h5::File::create(path);
    optics::write_table(file.root(), table);
    core::h5::Group group = file.root().create_group(kGroup);
    group.write_strings("key", {entry.key});
    write_description(group, entry, table);
    file.commit();
  } catch (const std::exception& error) {
    return warn(std::string("surface tables are not kept for later runs: ") + error.what(), "write");
  }
  if (const std::uintmax_t bytes = std::filesystem::file_size(path, ignored);
      !ignored && bytes > limit_bytes_) {
    std::filesystem::remove(path, ignored);
    return warn(
        fmt::format("the table of \"{}\", {}, is larger than the limit of the cache, {} "
                    "(SCINTRAY_CACHE_SIZE), and is not kept for later runs",
                    entry.surface, core::byte_size_text(bytes), core::byte_size_text(limit_bytes_)));
  }
  folder_.shrink(limit_bytes_, path);
}

void TableCache::warn(const std::string& warning, const std::string& kind) {
  if (warned_.insert(kind.empty() ? warning : kind).second && hooks_.cache_warning)
    hooks_.cache_warning(warning);
}

std::optional<CachedTable> describe_cached(const std::filesystem::path& file) {
  if (!is_whole(file)) return std::nullopt;
  try {
    const core::h5::File opened = core::h5::File::open(file);
    const core::h5::Group root = opened.root();
    if (!root.has(kGroup)) return std::nullopt;
    const core::h5::Group group = root.open_group(kGroup);
    CachedTable described{read_text(group, "surface"), read_text(group, "media"),   read_text(group, "map"),
                          read_text(group, "stack"),   read_text(group, "version"), {}};
    const auto wavelengths_nm = group.read<double>("wavelength_nm");
    const auto inside = group.read<double>("index_inside"), outside = group.read<double>("index_outside");
    if (inside.size() != wavelengths_nm.size() || outside.size() != wavelengths_nm.size())
      return std::nullopt;
    for (std::size_t k = 0; k < wavelengths_nm.size(); ++k)
      described.spectrum.push_back({wavelengths_nm[k], {inside[k], outside[k]}});
    return described;
  } catch (const core::Error&) {
    return std::nullopt;
  }
}

}  // namespace scintray::materials
