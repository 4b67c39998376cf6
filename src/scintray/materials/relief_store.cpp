#include "scintray/materials/relief_store.hpp"

#include "scintray/materials/table_key.hpp"

namespace scintray::materials {

const Relief& ReliefStore::relief(const std::string& key, const std::function<Relief()>& make) {
  if (const auto known = reliefs_.find(key); known != reliefs_.end()) return known->second;
  return reliefs_.emplace(key, make()).first->second;
}

std::shared_ptr<const optics::SurfaceTable> ReliefStore::table(const TableRequest& request,
                                                               const std::function<const Relief&()>& relief) {
  const std::string key = table_key(request.relief, request.settings, request.spectrum);
  auto& known = tables_[key];
  if (known) return known;
  const auto progress = [&](double done) {
    if (hooks_.table_progress) hooks_.table_progress(request.surface, done);
    return !(hooks_.stop && hooks_.stop());
  };
  known = cache_.get({key, request.surface, request.media}, [&] {
    const Relief& made = relief();
    return topography::build_table(*made.field, request.spectrum, request.settings, made.provenance,
                                   progress);
  });
  return known;
}

}  // namespace scintray::materials
