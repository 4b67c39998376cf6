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

/// $SCINTRAY_CACHE, $XDG_CACHE_HOME/scintray or $HOME/.cache/scintray; empty without any of them.
std::filesystem::path default_table_cache();

/// What a caller may follow and stop while surface tables are built.
struct TableHooks {
  /// Called while a table is built: the surface's name and the share done, 0 to 1.
  std::function<void(const std::string& surface, double done)> table_progress;
  /// Called while a table is built; true stops with TableStopped.
  std::function<bool()> stop;
  /// Folder in which built tables are kept between runs; empty: none are.
  std::filesystem::path cache = default_table_cache();
};

/// A height field, and how it came to be.
struct Relief {
  std::string key;  ///< everything that the height field depends on
  optics::TableProvenance provenance;
  std::shared_ptr<const optics::HeightField> field;
};

/// Keeps height fields and tables, and tables also in a folder between runs.
class ReliefStore {
 public:
  explicit ReliefStore(TableHooks hooks) : hooks_(std::move(hooks)) {}

  /// The height field of a key, made now unless it is kept.
  std::shared_ptr<const optics::HeightField> field(const std::string& key,
                                                   const std::function<optics::HeightField()>& make);
  /// The table of a relief, traced now unless it is kept.
  /// @param surface  its name, for the progress
  /// @throws InputError on settings out of range; TableStopped
  std::shared_ptr<const optics::SurfaceTable> table(const std::string& surface, const Relief& relief,
                                                    const topography::TableSettings& settings,
                                                    const std::vector<topography::SpectralPoint>& spectrum);

 private:
  TableHooks hooks_;
  std::map<std::string, std::shared_ptr<const optics::HeightField>> fields_;
  std::map<std::string, std::shared_ptr<const optics::SurfaceTable>> tables_;
};

/// 64-bit FNV-1a (Fowler, Noll, Vo), to name cache files and to notice that a file changed.
std::uint64_t content_hash(std::string_view bytes);

}  // namespace scintray::materials
