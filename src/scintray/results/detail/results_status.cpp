#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/results/detail/goniometer_columns.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

bool is_results_file(const std::filesystem::path& path) {
  try {
    return format::has_format(core::h5::File::open(path).root());
  } catch (const core::Error&) {
    return false;
  }
}

ResultsStatus read_results_status(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  ResultsStatus status;
  status.complete = root.integer_attribute("", "complete") != 0;
  status.reason = root.string_attribute("", "partial_reason");
  status.has_photon_list = root.has("photons");
  if (status.has_photon_list) status.listed_photons = root.open_group("photons").shape("point").at(0);
  if (root.has("events")) status.listed_events = root.open_group("events").shape("point").at(0);
  return status;
}

std::vector<analysis::SurfaceAnalysis> read_surfaces(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  try {
    return format::get_surface_analyses(file.root());
  } catch (const std::invalid_argument& contradiction) {
    throw format::damaged(path, contradiction.what());
  }
}

}  // namespace scintray::results
