#include "scintray/results/detail/point_records.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace format {

PathTables::PathTables(core::h5::Group& root)
    : root_(root),
      paths_(root, "paths", "recorded photon paths, one row a photon"),
      steps_(root, "path_steps", "steps of photon paths, one row a step") {}

void PathTables::add(std::size_t point, const std::vector<tally::PhotonPath>& paths) {
  for (const tally::PhotonPath& path : paths) {
    const std::uint64_t row = paths_.rows();
    paths_.add({static_cast<std::uint32_t>(point), path.event, path.photon,
                static_cast<std::uint32_t>(core::fate_index(path.fate)), steps_.rows()});
    for (const tally::PathStep& step : path.steps) {
      const auto [text, is_new] = numbers_.try_emplace(step.text, static_cast<std::uint32_t>(texts_.size()));
      if (is_new) texts_.push_back(step.text);
      steps_.add({row, step, text->second});
    }
  }
}

void PathTables::finish() {
  paths_.write_waiting();
  steps_.write_waiting();
  put_text(root_, "step_texts", texts_);
  root_.make_scale("step_texts");
}

}  // namespace format

std::vector<tally::PhotonPath> read_paths(const std::filesystem::path& path, std::size_t point) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  if (!root.has("paths")) return {};
  const auto require = [&](bool holds, const char* what) {
    if (!holds) throw format::damaged(path, what);
  };
  const core::h5::Group step_group = root.open_group("path_steps");
  const std::uint64_t all = root.open_group("paths").shape("point").at(0),
                      all_steps = step_group.shape("path_row").at(0);
  const auto rows = format::read_rows<format::PathRow>(root.open_group("paths"), 0, all);
  require(rows.has_value(), "the columns of paths differ in length");
  const auto steps = format::read_rows<format::PathStepRow>(step_group, 0, all_steps);
  require(steps.has_value() && steps->size() == all_steps, "the columns of path_steps differ in length");
  const std::vector<std::string> texts = root.read_strings("step_texts");
  std::vector<tally::PhotonPath> paths;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const format::PathRow& row = (*rows)[i];
    const std::uint64_t end = i + 1 < rows->size() ? (*rows)[i + 1].first_step : all_steps;
    require(row.first_step < end && end <= all_steps && end - row.first_step >= 2 &&
                end - row.first_step <= tally::kMostPathSteps,
            "the steps of photon paths are out of order");
    require(row.fate < core::kFateCount, "a photon path has an unknown fate");
    if (row.point != point) continue;
    tally::PhotonPath& read = paths.emplace_back();
    read.event = row.event;
    read.photon = row.photon;
    read.fate = core::fate_at(static_cast<int>(row.fate));
    for (std::uint64_t at = row.first_step; at < end; ++at) {
      const format::PathStepRow& step = (*steps)[at];
      require(step.path_row == i && step.text < texts.size(),
              "a step of a photon path names a path or a text that does not exist");
      require(step.step.position.allFinite() && std::isfinite(step.step.time_ns) &&
                  std::isfinite(step.step.wavelength_nm),
              "a step of a photon path has a place or time that is no number");
      read.steps.push_back(step.step);
      read.steps.back().text = texts[step.text];
    }
  }
  return paths;
}

}  // namespace scintray::results
