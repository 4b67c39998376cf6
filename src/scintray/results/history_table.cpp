#include "scintray/results/history_table.hpp"

#include <algorithm>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace {

using format::damaged;
using format::describe;
using format::put;
using format::put_text;

constexpr const char* kHistoryGroup = "histories";
constexpr const char* kPointGroup = "traced_optics";
/// Numbers of a column kept in memory before they are written, and compressed together.
constexpr std::size_t kBlockNumbers = 65536;

template <typename T>
std::size_t place_of(const std::vector<T>& all, const T& one) {
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), one) - all.begin());
}

template <typename T>
void add_new(std::vector<T>& all, const std::vector<T>& some) {
  for (const T& one : some)
    if (place_of(all, one) == all.size()) all.push_back(one);
}

template <typename T>
std::vector<std::size_t> places_of(const std::vector<T>& all, const std::vector<T>& some) {
  std::vector<std::size_t> places;
  for (const T& one : some) places.push_back(place_of(all, one));
  return places;
}

/// Calls visit(name, member, of) for the columns with a number for each medium, or each reflector.
template <typename Visit>
void for_each_media_column(const Visit& visit) {
  visit("medium_path_mm", &tally::PhotonHistories::path_mm);
  visit("absorption_depth", &tally::PhotonHistories::absorption_depth);
}

template <typename Visit>
void for_each_reflector_column(const Visit& visit) {
  visit("reflections", &tally::PhotonHistories::reflections);
  visit("reflection_depth", &tally::PhotonHistories::reflection_depth);
}

template <typename Visit>
void for_each_photon_column(const Visit& visit) {
  visit("point", &tally::PhotonHistories::point);
  visit("event", &tally::PhotonHistories::event);
  visit("photon", &tally::PhotonHistories::photon);
}

/// Appends rows, placing their columns at `places` in rows of `width`.
template <typename T>
void append_moved(std::vector<T>& to, const std::vector<T>& from, std::size_t rows,
                  const std::vector<std::size_t>& places, std::size_t width) {
  const std::size_t first = to.size();
  to.resize(first + rows * width);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < places.size(); ++i)
      to[first + row * width + places[i]] = from[row * places.size() + i];
}

void put_ranges(core::h5::Group& group, const std::string& name,
                const std::vector<tally::TracedRange>& ranges, const std::vector<std::size_t>& places,
                std::size_t width) {
  std::vector<double> least(width, std::numeric_limits<double>::quiet_NaN()), most = least;
  for (std::size_t i = 0; i < places.size(); ++i) {
    least[places[i]] = ranges[i].least;
    most[places[i]] = ranges[i].most;
  }
  format::put(group, name + "_least", least);
  format::put(group, name + "_most", most);
}

std::vector<tally::TracedRange> get_ranges(const core::h5::Group& group, const std::string& name) {
  const auto least = group.read<double>(name + "_least"), most = group.read<double>(name + "_most");
  std::vector<tally::TracedRange> ranges;
  for (std::size_t i = 0; i < std::min(least.size(), most.size()); ++i) ranges.push_back({least[i], most[i]});
  return ranges;
}

}  // namespace

void HistoryColumns::add(const tally::HistorySubjects& point) {
  add_new(media, point.media);
  add_new(reflectors, point.reflectors);
  add_new(transmitting, point.transmitting);
  add_new(gap_media, point.gap_media);
}

HistoryWriter::HistoryWriter(core::h5::Group& root, HistoryColumns columns)
    : group_(root.create_group(kHistoryGroup)), columns_(std::move(columns)) {
  group_.set_attribute("", "description",
                       std::string("path lengths and reflections of detected photons, one row a photon"));
  format::put_text(group_, "history_media", columns_.media);
  format::put_text(group_, "history_gap_media", columns_.gap_media);
  format::put_text(group_, "history_transmitting", columns_.transmitting);
  std::vector<std::string> surfaces, stacks, reflectors;
  for (const tally::ReflectorSite& site : columns_.reflectors) {
    surfaces.push_back(site.surface);
    stacks.push_back(site.stack);
    reflectors.push_back(site.reflector);
  }
  format::put_text(group_, "reflector_surface", surfaces);
  format::put_text(group_, "reflector_stack", stacks);
  format::put_text(group_, "reflector_name", reflectors);

  const std::size_t widest = std::max<std::size_t>({1, columns_.media.size(), columns_.reflectors.size()});
  block_rows_ = std::max<std::size_t>(1, kBlockNumbers / widest);
  format::create_rows(group_, block_rows_);
  const auto create = [&](const char* name, const auto* column, std::size_t width) {
    group_.create_stream<std::decay_t<decltype(column->front())>>(name, block_rows_, width);
    format::describe(group_, name);
    group_.attach_scale(name, 0, group_, "row");
  };
  for_each_photon_column([&](const char* name, auto member) { create(name, &(waiting_.*member), 0); });
  for_each_media_column(
      [&](const char* name, auto member) { create(name, &(waiting_.*member), columns_.media.size()); });
  if (!columns_.reflectors.empty())
    for_each_reflector_column([&](const char* name, auto member) {
      create(name, &(waiting_.*member), columns_.reflectors.size());
    });
  format::DimensionNames names{{"history_media", {"medium_index"}}};
  for_each_media_column([&](const char* name, auto) { names[name] = {"row", "medium_index"}; });
  for_each_reflector_column([&](const char* name, auto) { names[name] = {"row", "reflector_index"}; });
  for (const char* name : {"reflector_surface", "reflector_stack", "reflector_name"})
    names[name] = {"reflector_index"};
  format::name_dimensions(group_, names);
}

void HistoryWriter::add(const tally::PhotonHistories& rows, const tally::HistorySubjects& point) {
  const std::vector<std::size_t> media = places_of(columns_.media, point.media);
  const std::vector<std::size_t> reflectors = places_of(columns_.reflectors, point.reflectors);
  for_each_photon_column([&](const char*, auto member) {
    auto& to = waiting_.*member;
    to.insert(to.end(), (rows.*member).begin(), (rows.*member).end());
  });
  for_each_media_column([&](const char*, auto member) {
    append_moved(waiting_.*member, rows.*member, rows.rows(), media, columns_.media.size());
  });
  for_each_reflector_column([&](const char*, auto member) {
    append_moved(waiting_.*member, rows.*member, rows.rows(), reflectors, columns_.reflectors.size());
  });
  if (waiting_.rows() >= block_rows_) write_waiting();
}

void HistoryWriter::write_waiting() {
  if (waiting_.rows() == 0) return;
  const auto write = [&](const char* name, auto member) { group_.append(name, waiting_.*member); };
  for_each_photon_column(write);
  for_each_media_column(write);
  if (!columns_.reflectors.empty()) for_each_reflector_column(write);
  format::append_rows(group_, written_, written_ + waiting_.rows());
  written_ += waiting_.rows();
  waiting_ = {};
}

void HistoryWriter::describe_point(core::h5::Group& point, const tally::HistorySubjects& subjects) const {
  core::h5::Group group = point.create_group(kPointGroup);
  group.set_attribute(
      "", "description",
      std::string("absorption and reflectance as traced, in the order of the columns of /histories"));
  put_ranges(group, "absorption_per_mm", subjects.absorption_per_mm,
             places_of(columns_.media, subjects.media), columns_.media.size());
  put_ranges(group, "reflectance", subjects.reflectance, places_of(columns_.reflectors, subjects.reflectors),
             columns_.reflectors.size());
  format::name_dimensions(group, {{"absorption_per_mm_least", {"medium_index"}},
                                  {"absorption_per_mm_most", {"medium_index"}},
                                  {"reflectance_least", {"reflector_index"}},
                                  {"reflectance_most", {"reflector_index"}}});
}

namespace {

core::h5::Group open_histories(const std::filesystem::path& path, const core::h5::Group& root) {
  if (!root.has(kHistoryGroup))
    throw core::InputError({{path.string()},
                            "this result has no photon histories, so it cannot be reweighted",
                            "write photon_history = true in [run] of the scene and run it again"});
  return root.open_group(kHistoryGroup);
}

}  // namespace

HistoryReader::HistoryReader(const std::filesystem::path& path)
    : path_(path), file_(format::open_results(path)), group_(open_histories(path, file_.root())) {
  columns_.media = group_.read_strings("history_media");
  columns_.gap_media = group_.read_strings("history_gap_media");
  columns_.transmitting = group_.read_strings("history_transmitting");
  const auto surfaces = group_.read_strings("reflector_surface"),
             stacks = group_.read_strings("reflector_stack"), names = group_.read_strings("reflector_name");
  if (stacks.size() != surfaces.size() || names.size() != surfaces.size())
    throw format::damaged(path_, "the names of the reflectors of histories differ in number");
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    columns_.reflectors.push_back({surfaces[i], stacks[i], names[i]});
  rows_ = group_.shape("point").at(0);
}

tally::PhotonHistories HistoryReader::read(std::uint64_t offset, std::uint64_t count) const {
  tally::PhotonHistories rows;
  const auto read = [&](const char* name, auto member, std::size_t width) {
    auto& column = rows.*member;
    column = group_.read_part<std::decay_t<decltype(column.front())>>(name, offset, count);
    if (column.size() != width * rows.rows())
      throw format::damaged(path_, std::string("the columns of histories differ in length: ") + name);
  };
  for_each_photon_column([&](const char* name, auto member) { read(name, member, 1); });
  for_each_media_column([&](const char* name, auto member) { read(name, member, columns_.media.size()); });
  if (columns_.reflectors.empty()) return rows;
  for_each_reflector_column(
      [&](const char* name, auto member) { read(name, member, columns_.reflectors.size()); });
  return rows;
}

std::optional<TracedOptics> HistoryReader::traced(std::size_t point) const {
  const core::h5::Group points = file_.root().open_group("points");
  const std::string number = format::numbered(point);
  if (!points.has(number) || !points.open_group(number).has(kPointGroup)) return std::nullopt;
  const core::h5::Group group = points.open_group(number).open_group(kPointGroup);
  TracedOptics optics{get_ranges(group, "absorption_per_mm"), get_ranges(group, "reflectance")};
  if (optics.absorption_per_mm.size() != columns_.media.size() ||
      optics.reflectance.size() != columns_.reflectors.size())
    throw format::damaged(path_, "traced_optics does not match histories");
  return optics;
}

}  // namespace scintray::results
