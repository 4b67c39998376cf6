#include <map>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace {

std::vector<tally::ReadoutChannel> get_channels(const std::filesystem::path& path,
                                                const core::h5::Group& root, std::size_t point) {
  const core::h5::Group points = root.open_group("points");
  const std::string name = format::numbered(point);
  if (!points.has(name) || !points.open_group(name).has("channels")) return {};
  const core::h5::Group group = points.open_group(name).open_group("channels");
  const std::vector<std::string> names = group.read_strings("channel_name");
  const auto parts = group.read<std::uint32_t>("channel_part");
  std::vector<tally::ReadoutChannel> channels(names.size());
  const auto require = [&](std::size_t size) {
    if (size != names.size()) throw format::damaged(path, "the columns of channels differ in length");
  };
  require(parts.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    channels[i].name = names[i];
    format::from_file(parts[i], channels[i].part);
  }
  format::for_each_channel_number([&](const char* column, auto member) {
    const auto values = group.read<double>(column);
    require(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) member(channels[i]) = values[i];
  });
  return channels;
}

/// Rows of the samples of a group one after the other; empty without that group.
std::vector<float> samples_of(const core::h5::Group& root, const std::string& name, std::uint64_t first,
                              std::uint64_t count) {
  if (!root.has(name)) return {};
  return root.open_group(name).read_part<float>("samples", first, count);
}

std::vector<float> row_of(const std::vector<float>& samples, std::size_t row, std::size_t rows) {
  const std::size_t width = samples.size() / rows;
  const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(row * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

/// Attaches the signals of the channels to events.
void add_signals(const std::filesystem::path& path, const core::h5::Group& root, std::uint64_t offset,
                 const std::vector<format::EventRow>& rows, EventDetail detail,
                 std::vector<tally::EventRecord>& events) {
  std::map<std::uint32_t, std::size_t> channels;  // of each point
  for (tally::EventRecord& event : events) {
    const auto [known, is_new] = channels.try_emplace(event.point, 0);
    if (is_new) known->second = get_channels(path, root, event.point).size();
    event.channels.resize(known->second);
  }
  const core::h5::Group group = root.open_group("signals");
  const std::uint64_t first = rows.front().first_signal;
  const auto next = format::read_rows<format::EventRow>(root.open_group("events"), offset + rows.size(), 1);
  const std::uint64_t end =
      next && !next->empty() ? next->front().first_signal : group.shape("channel").at(0);
  if (end < first) throw format::damaged(path, "the signals of events are out of order");
  const auto signals = format::read_rows<format::SignalRow>(group, first, end - first);
  if (!signals) throw format::damaged(path, "the columns of signals differ in length");
  const auto samples = [&](const std::string& name, EventDetail from) {
    return samples_of(root, name, first, detail >= from ? end - first : 0);
  };
  const std::vector<float> orders = samples("photon_times", EventDetail::photon_times);
  const std::vector<float> pulses = samples("pulses", EventDetail::all);
  for (std::size_t i = 0; i < signals->size(); ++i) {
    const format::SignalRow& signal = (*signals)[i];
    if (signal.event_row < offset || signal.event_row - offset >= events.size() ||
        signal.channel >= events[signal.event_row - offset].channels.size())
      throw format::damaged(path, "a signal names an event or a channel that does not exist");
    tally::ChannelRecord& record = events[signal.event_row - offset].channels[signal.channel];
    record = signal.signal;
    record.order_ns = row_of(orders, i, signals->size());
    record.waveform = row_of(pulses, i, signals->size());
  }
}

}  // namespace

std::vector<tally::ReadoutChannel> read_channels(const std::filesystem::path& path, std::size_t point) {
  const core::h5::File file = format::open_results(path);
  return get_channels(path, file.root(), point);
}

std::vector<std::uint64_t> read_photon_order(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  if (!root.has("photon_times")) return {};
  return root.open_group("photon_times").read<std::uint64_t>("order");
}

std::vector<tally::EventRecord> read_events(const std::filesystem::path& path, std::uint64_t offset,
                                            std::uint64_t count, EventDetail detail) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  if (!root.has("events"))
    throw format::lacking(path, "this result has no events", "run a scene whose [source] is an event source");
  const auto rows = format::read_rows<format::EventRow>(root.open_group("events"), offset, count);
  if (!rows) throw format::damaged(path, "the columns of events differ in length");
  std::vector<tally::EventRecord> events;
  for (const format::EventRow& row : *rows) events.push_back(row.event);
  if (events.empty()) return events;
  add_signals(path, root, offset, *rows, detail, events);
  return events;
}

}  // namespace scintray::results
