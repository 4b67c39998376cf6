#pragma once
/// Surface tables kept between runs.

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scintray/materials/cache_folder.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::materials {

/// Default folder of the table cache: $SCINTRAY_CACHE, $XDG_CACHE_HOME/scintray or $HOME/.cache/scintray;
/// empty without any of them.
std::filesystem::path default_table_cache();

/// Limit of the table cache unless $SCINTRAY_CACHE_SIZE states one.
inline constexpr std::uint64_t kDefaultCacheBytes = std::uint64_t{1} << 30;

/// Limit of the table cache from $SCINTRAY_CACHE_SIZE, a size with its unit; 0: tables are not kept.
struct CacheLimit {
  std::uint64_t bytes = kDefaultCacheBytes;
  std::string warning;  ///< about a variable that is no size; else empty
};
CacheLimit cache_limit();

/// Callbacks of the making of tables, and where they are kept.
struct TableHooks {
  /// Called while a table is built: the surface's name and the completed share, 0 to 1.
  std::function<void(const std::string& surface, double done)> table_progress;
  /// Called while another process builds the table: the surface's name.
  std::function<void(const std::string& surface)> table_waiting;
  /// Receives, each kind once, warnings of a cache that does not work; none of them stops a run.
  std::function<void(const std::string& warning)> cache_warning;
  /// Called while a table is built or waited for; true stops with TableStopped.
  std::function<bool()> stop;
  /// Folder in which tables are kept between runs; empty: they are not.
  std::filesystem::path cache = default_table_cache();
  /// Limit of the sum of its files; nothing: that of cache_limit().
  std::optional<std::uint64_t> cache_bytes;
};

/// A table to make, and to keep.
struct CacheEntry {
  std::string key;      ///< everything on which the table depends (materials/table_key.hpp)
  std::string surface;  ///< name of its surface, for progress and lists
  std::string media;    ///< names of the media on its sides, as "LSO to air", for lists
};

/// Tables by their keys, in a folder that many processes share. A file is written under another name and
/// renamed, so that no reader sees a part of it, and holds the key and a hash of its bytes, both compared on
/// reading: a damaged file is built again. Of several processes that need a table one builds it, and the
/// others wait for it. After a table was added, the least recently used ones beyond the limit are removed.
/// To be used by one thread at a time.
class TableCache {
 public:
  explicit TableCache(const TableHooks& hooks);

  /// The table of a key: from the folder, else built and kept. Where it cannot be kept, a warning is issued.
  /// @param build  makes the table; its exceptions are passed on
  /// @throws TableStopped when it was stopped while waiting
  std::shared_ptr<const optics::SurfaceTable> get(const CacheEntry& entry,
                                                  const std::function<optics::SurfaceTable()>& build);

 private:
  /// The kept table; null when there is none, or it is damaged.
  std::shared_ptr<const optics::SurfaceTable> find(const CacheEntry& entry);
  /// The right to build a table, after waiting for it; nothing where the folder has no locks.
  [[nodiscard]] std::optional<core::FileLock> lock(const CacheEntry& entry);
  void keep(const CacheEntry& entry, const optics::SurfaceTable& table);
  /// Issues a warning, once for each kind; without a kind, once for each text.
  void warn(const std::string& warning, const std::string& kind = {});

  TableHooks hooks_;
  CacheFolder folder_;
  std::uint64_t limit_bytes_ = 0;
  std::set<std::string> warned_;
};

/// Description of a table in the cache.
struct CachedTable {
  std::string surface, media;  ///< of the first use, as in CacheEntry
  std::string map;             ///< map file or recipe; of a stack the surface's name
  std::string stack;           ///< layers in the table; empty: none
  std::string version;         ///< ScintRay version that built it
  std::vector<topography::SpectralPoint> spectrum;
};

/// The description in a file of the cache; nothing for a file that cannot be read, is damaged or is of an
/// earlier ScintRay.
[[nodiscard]] std::optional<CachedTable> describe_cached(const std::filesystem::path& file);

}  // namespace scintray::materials
