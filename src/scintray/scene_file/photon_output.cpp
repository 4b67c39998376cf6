#include "scintray/scene_file/run.hpp"

#include <algorithm>

#include "scintray/core/text.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

PhotonOutputSpec read_photon_output(const config::TomlTable& run, bool listed) {
  PhotonOutputSpec list;
  const std::vector<std::string> known(std::begin(kPhotonOutputColumns), std::end(kPhotonOutputColumns));
  list.columns = run.strings("photon_columns", 0, false);
  for (const std::string& column : list.columns)
    run.expect("photon_columns", std::find(known.begin(), known.end(), column) != known.end(),
               "\"" + column + "\" is no column of the list of photons",
               "the columns are " + core::list_of(known));
  if (const auto every = run.optional_integer("photon_sample"))
    list.every = positive_count(run, "photon_sample", *every);
  list.channels = read_names(run, "photon_channels", false);
  if (listed) return list;
  for (const char* key : {"photon_columns", "photon_sample", "photon_channels"})
    if (run.has(key))
      run.report(key, "there is no list of photons that this would be of",
                 "add photon_list = true, or remove it");
  return list;
}

}  // namespace scintray::scene_file
