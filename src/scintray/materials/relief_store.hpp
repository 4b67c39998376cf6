#pragma once
/// Height fields and the tables traced on them, each made once.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scintray/materials/table_cache.hpp"
#include "scintray/optics/height_field.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::materials {

/// A height field, with its provenance.
struct Relief {
  optics::TableProvenance provenance;
  std::shared_ptr<const optics::HeightField> field;
};

/// Request of a table of a height field.
struct TableRequest {
  std::string surface;  ///< name of the surface, for progress and lists
  std::string media;    ///< names of the media on its sides, for lists
  std::string relief;   ///< key of the height field
  topography::TableSettings settings;
  std::vector<topography::SpectralPoint> spectrum;
};

/// Store of height fields and tables; tables are also kept between runs (TableCache).
class ReliefStore {
 public:
  explicit ReliefStore(TableHooks hooks) : hooks_(std::move(hooks)), cache_(hooks_) {}

  /// The height field of a key, made on first use. Valid as long as the store.
  const Relief& relief(const std::string& key, const std::function<Relief()>& make);
  /// The table of a height field, traced on first use unless it is cached.
  /// @param relief  returns the height field; not called when the table exists
  /// @throws InputError on settings out of range; TableStopped
  std::shared_ptr<const optics::SurfaceTable> table(const TableRequest& request,
                                                    const std::function<const Relief&()>& relief);

 private:
  TableHooks hooks_;
  TableCache cache_;
  std::map<std::string, Relief> reliefs_;
  std::map<std::string, std::shared_ptr<const optics::SurfaceTable>> tables_;
};

}  // namespace scintray::materials
