#pragma once
/// Height fields and the tables traced on them, each made once.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/optics/height_field.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::materials {

/// Default folder of the table cache: $SCINTRAY_CACHE, $XDG_CACHE_HOME/scintray or $HOME/.cache/scintray;
/// empty without any of them.
std::filesystem::path default_table_cache();

/// Callbacks during the construction of surface tables, and their cache.
struct TableHooks {
  /// Called while a table is built: the surface's name and the completed share, 0 to 1.
  std::function<void(const std::string& surface, double done)> table_progress;
  /// Called while a table is built; true stops with TableStopped.
  std::function<bool()> stop;
  /// Folder in which tables are cached between runs; empty: no cache.
  std::filesystem::path cache = default_table_cache();
};

/// A height field, with its provenance.
struct Relief {
  std::string key;  ///< all inputs of the height field
  optics::TableProvenance provenance;
  std::shared_ptr<const optics::HeightField> field;
};

/// Store of height fields and tables; tables are also cached in a folder between runs.
class ReliefStore {
 public:
  explicit ReliefStore(TableHooks hooks) : hooks_(std::move(hooks)) {}

  /// The height field of a key, made on first use.
  std::shared_ptr<const optics::HeightField> field(const std::string& key,
                                                   const std::function<optics::HeightField()>& make);
  /// The table of a relief, traced on first use unless it is cached.
  /// @param surface  name of the surface, for the progress
  /// @throws InputError on settings out of range; TableStopped
  std::shared_ptr<const optics::SurfaceTable> table(const std::string& surface, const Relief& relief,
                                                    const topography::TableSettings& settings,
                                                    const std::vector<topography::SpectralPoint>& spectrum);

 private:
  TableHooks hooks_;
  std::map<std::string, std::shared_ptr<const optics::HeightField>> fields_;
  std::map<std::string, std::shared_ptr<const optics::SurfaceTable>> tables_;
};

/// 64-bit FNV-1a (Fowler, Noll, Vo), for the names of cache files and the detection of changed files.
std::uint64_t content_hash(std::string_view bytes);

}  // namespace scintray::materials
