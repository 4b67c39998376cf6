#include "scintray/report/view/view_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "scintray/core/pattern.hpp"
#include "scintray/core/words.hpp"

namespace scintray::report {

namespace {

constexpr const char* kShareUnit = "share of the emitted photons";
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Numbers of the faces of a view, over its parts in their order.
class FaceNumbers {
 public:
  explicit FaceNumbers(const std::vector<ViewPart>& parts) {
    for (const ViewPart& part : parts)
      for (const ViewFace& face : part.faces) names_.push_back(part.name + ":" + face.name);
    for (std::size_t i = 0; i < names_.size(); ++i) numbers_.emplace(names_[i], i);
  }
  std::size_t size() const { return names_.size(); }
  /// Number of a face; nothing for one that the view does not have.
  std::optional<std::size_t> of(const std::string& name) const {
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? std::nullopt : std::optional(found->second);
  }
  std::vector<std::uint32_t> matching(const std::vector<config::NameRef>& patterns) const {
    std::vector<std::uint32_t> faces;
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (std::any_of(patterns.begin(), patterns.end(), [&](const config::NameRef& pattern) {
            return core::matches_pattern(pattern.name, names_[i]);
          }))
        faces.push_back(static_cast<std::uint32_t>(i));
    return faces;
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> numbers_;
};

/// Sums of a tally over all axes but some.
/// @param kept  axes kept, in the order of the result, the last one fastest
std::vector<double> projected(const tally::TallyResult& tally, const std::vector<std::size_t>& kept) {
  std::size_t size = 1;
  for (const std::size_t axis : kept) size *= tally.axes[axis].bins();
  std::vector<double> sums(size, 0.0);
  std::vector<std::size_t> at(tally.axes.size(), 0);
  for (const double sum : tally.sum) {
    std::size_t bin = 0;
    for (const std::size_t axis : kept) bin = bin * tally.axes[axis].bins() + at[axis];
    sums[bin] += sum;
    for (std::size_t axis = at.size(); axis-- > 0;) {
      if (++at[axis] < tally.axes[axis].bins()) break;
      at[axis] = 0;
    }
  }
  return sums;
}

std::vector<std::size_t> axes_of(const tally::TallyResult& tally, const char* variable) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < tally.axes.size(); ++i)
    if (tally.axes[i].variable == variable) found.push_back(i);
  return found;
}

std::string unit_of(const tally::TallyResult& tally) {
  if (tally.score == scene_file::kPhotonScore) return kShareUnit;
  return tally.score + (tally.unit == "1" ? "" : " (" + tally.unit + ")") + " per emitted photon";
}

bool any(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return value > 0.0; });
}

/// A tally over faces, for each of its step events, which are its second axis of names.
void add_face_counts(const tally::TallyResult& tally, double photons, const FaceNumbers& faces,
                     std::vector<ViewTally>& list) {
  const std::size_t axis = axes_of(tally, "face").front();
  const std::vector<std::size_t> occasions = axes_of(tally, "occasion");
  const std::size_t events = occasions.empty() ? 1 : tally.axes[occasions.front()].bins();
  std::vector<std::size_t> kept = occasions;
  kept.push_back(axis);
  const std::vector<double> sums = projected(tally, kept);
  const std::vector<std::string>& names = tally.axes[axis].names;
  for (std::size_t event = 0; event < events; ++event) {
    ViewTally painted{
        tally.name, unit_of(tally), std::vector<double>(faces.size(), kNoValue), std::nullopt, {}};
    if (!occasions.empty()) {
      std::string word = tally.axes[occasions.front()].names[event];
      std::replace(word.begin(), word.end(), '_', ' ');
      painted.name += ": " + word;
    }
    std::vector<double> counted(sums.begin() + static_cast<std::ptrdiff_t>(event * names.size()),
                                sums.begin() + static_cast<std::ptrdiff_t>((event + 1) * names.size()));
    if (!any(counted)) continue;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (const auto face = faces.of(names[i])) painted.of_faces[*face] = counted[i] / photons;
    list.push_back(std::move(painted));
  }
}

/// Groups of bins that are joined into one, so that at most kMostViewBins stay.
std::size_t joined_bins(std::size_t bins) { return (bins + kMostViewBins - 1) / kMostViewBins; }

ViewGrid grid_of(const tally::TallyResult& tally, const std::vector<std::size_t>& positions, double photons) {
  const std::vector<double> sums = projected(tally, positions);
  ViewGrid grid;
  std::array<std::size_t, 2> bins{}, joined{};
  for (std::size_t k = 0; k < 2; ++k) {
    const tally::TallyAxis& axis = tally.axes[positions[k]];
    bins[k] = axis.bins();
    joined[k] = joined_bins(bins[k]);
    grid.bins[k] = (bins[k] + joined[k] - 1) / joined[k];
    grid.along[k] = axis.along;
    grid.low_mm[k] = axis.edges.front();
    // The last group may be incomplete: its bins reach beyond the axis.
    const double bin_mm = (axis.edges.back() - axis.edges.front()) / static_cast<double>(bins[k]);
    grid.high_mm[k] = grid.low_mm[k] + bin_mm * static_cast<double>(joined[k] * grid.bins[k]);
  }
  grid.values.assign(grid.bins[0] * grid.bins[1], 0.0);
  for (std::size_t i = 0; i < bins[0]; ++i)
    for (std::size_t j = 0; j < bins[1]; ++j)
      grid.values[i / joined[0] * grid.bins[1] + j / joined[1]] += sums[i * bins[1] + j] / photons;
  return grid;
}

void add_sensor_faces(const tally::RunHeader& header, const tally::PointResult& point, double photons,
                      const FaceNumbers& faces, std::vector<ViewTally>& list) {
  const std::array<std::pair<const char*, std::uint64_t tally::SensorFaceCount::*>, 2> counts{
      {{"detected, by sensor face", &tally::SensorFaceCount::detected},
       {"not detected, by sensor face", &tally::SensorFaceCount::not_detected}}};
  for (const auto& [name, count] : counts) {
    std::vector<double> values(faces.size(), kNoValue);
    for (const tally::SensorFaceCount& row : point.sensor_faces) {
      if (!header.faces.contains(row.face)) continue;
      const auto face = faces.of(header.faces[row.face]);
      if (!face) continue;
      values[*face] =
          (std::isnan(values[*face]) ? 0.0 : values[*face]) + static_cast<double>(row.*count) / photons;
    }
    if (any(values)) list.push_back({name, kShareUnit, std::move(values), std::nullopt, {}});
  }
}

}  // namespace

std::vector<ViewTally> view_tallies(const tally::RunHeader& header, const tally::PointResult& point,
                                    const std::vector<scene_file::TallySpec>& specs,
                                    const std::vector<ViewPart>& parts) {
  std::vector<ViewTally> list;
  const auto photons = static_cast<double>(point.emitted);
  if (!(photons > 0.0)) return list;
  const FaceNumbers faces(parts);
  for (const tally::TallyResult& tally : point.tallies) {
    const std::vector<std::size_t> positions = axes_of(tally, "position");
    if (axes_of(tally, "face").size() == 1) {
      add_face_counts(tally, photons, faces, list);
      continue;
    }
    const auto spec = std::find_if(specs.begin(), specs.end(),
                                   [&](const scene_file::TallySpec& one) { return one.name == tally.name; });
    if (positions.size() != 2 || spec == specs.end() || spec->faces.empty()) continue;
    ViewTally painted{
        tally.name, unit_of(tally), {}, grid_of(tally, positions, photons), faces.matching(spec->faces)};
    if (any(painted.grid->values) && !painted.faces.empty()) list.push_back(std::move(painted));
  }
  add_sensor_faces(header, point, photons, faces, list);
  return list;
}

}  // namespace scintray::report
