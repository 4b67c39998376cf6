// The list of detected photons of a results file.
#include <algorithm>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace {

core::h5::Group list_of_photons(const core::h5::File& file, const std::filesystem::path& path) {
  const core::h5::Group root = file.root();
  if (!root.has("photons"))
    throw format::lacking(path, "this result has no list of detected photons",
                          "request the list when running the scene");
  return root.open_group("photons");
}

PhotonListLayout layout_of(const core::h5::Group& photons, const std::filesystem::path& path) {
  PhotonListLayout layout;
  if (!photons.has_attribute("", "one_in")) return layout;  // of 0.2.0 and before
  const std::int64_t every = photons.integer_attribute("", "one_in");
  if (every < 1) throw format::damaged(path, "the list of photons is one in less than one");
  layout.every = static_cast<std::uint64_t>(every);
  const auto lines = [&](const char* attribute) {
    std::vector<std::string> list;
    std::istringstream text(photons.string_attribute("", attribute));
    for (std::string line; std::getline(text, line);) list.push_back(line);
    return list;
  };
  layout.columns = lines("columns");
  layout.channels = lines("channels");
  return layout;
}

}  // namespace

PhotonListLayout read_photon_layout(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  return layout_of(list_of_photons(file, path), path);
}

std::vector<tally::DetectedPhoton> read_photons(const std::filesystem::path& path, std::uint64_t offset,
                                                std::uint64_t count) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group group = list_of_photons(file, path);
  const PhotonListLayout layout = layout_of(group, path);
  auto photons = format::read_rows(group, offset, count, format::unknown_photon(),
                                   [&](const std::string& column) { return layout.has(column); });
  if (!photons) throw format::damaged(path, "the columns of photons differ in length");
  return std::move(*photons);
}

bool PhotonListLayout::has(const std::string& column) const {
  return columns.empty() || column == "point" ||
         std::find(columns.begin(), columns.end(), column) != columns.end();
}

}  // namespace scintray::results
