/// The data of a run as arrays.

#include "scintray/results/results.hpp"

#include <cstddef>

#include "scintray/python/detail/bindings.hpp"

namespace scintray::python {

using RunDataPtr = std::shared_ptr<RunData>;

namespace {

/// The owner of arrays over a run's data.
py::capsule owner_of(const RunDataPtr& data) {
  return {new RunDataPtr(data), [](void* held) { delete static_cast<RunDataPtr*>(held); }};
}

py::ssize_t count_of(std::size_t number) { return static_cast<py::ssize_t>(number); }

template <typename IdType>
std::vector<std::int32_t> indices_of(const std::vector<IdType>& ids) {
  std::vector<std::int32_t> indices;
  for (const IdType& id : ids) indices.push_back(id.has_value() ? static_cast<std::int32_t>(id.index()) : -1);
  return indices;
}

py::dict moments(const core::Moments& of, const core::Estimate& mean) {
  py::dict entry;
  entry["count"] = of.count;
  entry["sum"] = of.sum;
  entry["sum_of_squares"] = of.sum_of_squares;
  entry["mean"] = estimate(mean);
  entry["standard_deviation"] = of.standard_deviation();
  return entry;
}

py::dict header_of(const RunData& data) {
  const tally::RunHeader& header = data.result.header;
  py::dict entry;
  entry["title"] = header.title;
  entry["version"] = header.version;
  entry["scene_file"] = header.scene_file;
  entry["scene_text"] = header.scene_text;
  entry["seed"] = header.seed;
  entry["sweep_keys"] = header.sweep_keys;
  entry["media"] = header.media.values();
  entry["surfaces"] = header.surfaces.values();
  entry["parts"] = header.parts.values();
  entry["faces"] = header.faces.values();
  entry["note"] = header.note;
  entry["complete"] = data.result.complete();
  entry["partial_reason"] = data.result.partial_reason;
  entry["points"] = data.result.points.size();
  entry["photon_list"] = data.photon_list;
  entry["has_events"] = !data.events.empty();
  std::vector<std::string> fates;
  for (int i = 0; i < core::kFateCount; ++i) fates.emplace_back(core::fate_name(core::fate_at(i)));
  entry["fates"] = fates;
  return entry;
}

py::dict axis_of(const tally::TallyAxis& axis, const py::object& owner) {
  py::dict entry;
  entry["variable"] = axis.variable;
  entry["unit"] = axis.unit;
  entry["edges"] = view(axis.edges, owner);
  entry["names"] = axis.names;
  entry["along"] = axis.along;
  return entry;
}

py::dict tally_of(const tally::TallyResult& tally, std::uint64_t photons, const py::object& owner) {
  py::dict entry;
  entry["name"] = tally.name;
  entry["type"] = tally.type;
  entry["score"] = tally.score;
  entry["unit"] = tally.unit;
  entry["faces"] = tally.faces;
  entry["outside"] = tally.outside;
  entry["index"] = tally.index;
  entry["photons"] = photons;
  py::list axes;
  std::vector<py::ssize_t> shape;
  for (const tally::TallyAxis& axis : tally.axes) {
    axes.append(axis_of(axis, owner));
    shape.push_back(count_of(axis.bins()));
  }
  entry["axes"] = axes;
  std::vector<double> error(tally.sum.size());
  for (std::size_t bin = 0; bin < error.size(); ++bin) error[bin] = tally.at(bin, photons).error;
  entry["sum"] = view(tally.sum.data(), shape, owner);
  entry["sum_of_squares"] = view(tally.sum_of_squares.data(), shape, owner);
  entry["error"] = array_of(std::move(error), shape);
  return entry;
}

py::dict sensor_faces_of(const tally::PointResult& point) {
  std::vector<core::PartId> parts;
  std::vector<core::FaceId> faces;
  std::vector<std::uint64_t> detected, not_detected;
  for (const tally::SensorFaceCount& of : point.sensor_faces) {
    parts.push_back(of.part);
    faces.push_back(of.face);
    detected.push_back(of.detected);
    not_detected.push_back(of.not_detected);
  }
  py::dict entry;
  entry["part"] = array_of(indices_of(parts));
  entry["face"] = array_of(indices_of(faces));
  entry["detected"] = array_of(std::move(detected));
  entry["not_detected"] = array_of(std::move(not_detected));
  return entry;
}

py::dict energy_of(const tally::EnergyBalance& energy) {
  py::dict entry;
  entry["events_requested"] = energy.events_requested;
  entry["events"] = energy.events;
  entry["silent"] = energy.silent;
  entry["started_keV"] = energy.started;
  entry["deposited_keV"] = energy.deposited;
  entry["escaped_keV"] = energy.escaped;
  entry["non_scintillating_keV"] = energy.non_scintillating;
  entry["detected_per_event"] = moments(energy.detected, energy.detected.mean());
  return entry;
}

py::dict point_of(const RunDataPtr& data, std::size_t number) {
  const tally::PointResult& point = data->result.points.at(number);
  const py::capsule owner = owner_of(data);
  py::dict entry;
  entry["parameters"] = point.parameters;
  entry["photons_requested"] = point.photons_requested;
  entry["photons"] = point.emitted;
  entry["photons_traced"] = point.photons;
  entry["birth_efficiency"] = point.birth_efficiency;
  entry["complete"] = point.complete;
  entry["fate_count"] = view(point.fates.data(), {core::kFateCount}, owner);
  std::vector<core::Estimate> fractions;
  for (int i = 0; i < core::kFateCount; ++i) fractions.push_back(point.fraction(core::fate_at(i)));
  entry["fate_fraction"] = estimates(fractions);
  entry["absorbed_in_medium"] = view(point.absorbed_in_medium.values(), owner);
  entry["absorbed_at_surface"] = view(point.absorbed_at_surface.values(), owner);
  entry["sensor_faces"] = sensor_faces_of(point);
  entry["energy"] = energy_of(point.energy);
  entry["interactions"] = moments(point.interactions, point.interactions.mean());
  entry["detected_path_mm"] = moments(point.detected_path_mm, point.detected_path_mm.mean());
  entry["detected_time_ns"] = moments(point.detected_time_ns, point.detected_time_ns.mean());
  entry["detected_interactions"] = moments(point.detected_interactions, point.detected_interactions.mean());
  entry["detected_path_histogram"] =
      view(point.detected_path_histogram.data(), {count_of(point.detected_path_histogram.size())}, owner);
  entry["scatterings"] = point.scatterings;
  entry["segments"] = point.segments;
  entry["wall_seconds"] = point.wall_seconds;
  entry["cut_bias_bound"] = point.cut_bias_bound();
  py::list tallies;
  for (const tally::TallyResult& tally : point.tallies) tallies.append(tally_of(tally, point.emitted, owner));
  entry["tallies"] = tallies;
  return entry;
}

/// The type of one detected photon, of which the array is a view: one record a photon.
py::dtype photon_type() {
  py::list names, formats, offsets;
  const auto field = [&](const char* name, const char* format, std::size_t offset) {
    names.append(name);
    formats.append(py::dtype(std::string(format)));
    offsets.append(offset);
  };
  using Photon = tally::DetectedPhoton;
  field("point", "u4", offsetof(Photon, point));
  field("event", "u8", offsetof(Photon, event));
  field("photon", "u8", offsetof(Photon, photon));
  field("part", "i4", offsetof(Photon, part));
  field("face", "i4", offsetof(Photon, face));
  field("position_mm", "3f4", offsetof(Photon, position_mm));
  field("direction", "3f4", offsetof(Photon, direction));
  field("wavelength_nm", "f4", offsetof(Photon, wavelength_nm));
  field("time_ns", "f4", offsetof(Photon, time_ns));
  field("path_mm", "f4", offsetof(Photon, path_mm));
  field("interactions", "u4", offsetof(Photon, interactions));
  return {names, formats, offsets, count_of(sizeof(Photon))};
}
static_assert(sizeof(core::PartId) == 4 && sizeof(core::FaceId) == 4);

py::array photons_of(const RunDataPtr& data) {
  if (!data->file.empty() && data->photons.empty() && data->photon_list)
    data->photons =
        results::read_photons(data->file, 0, results::read_results_status(data->file).listed_photons);
  py::array array(photon_type(), {count_of(data->photons.size())}, {}, data->photons.data(), owner_of(data));
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::dict channels_of(const std::vector<tally::ReadoutChannel>& channels) {
  std::vector<std::string> names;
  std::vector<double> positions, normals, areas;
  std::vector<core::PartId> parts;
  for (const tally::ReadoutChannel& channel : channels) {
    names.push_back(channel.name);
    parts.push_back(channel.part);
    areas.push_back(channel.area_mm2);
    for (int k = 0; k < 3; ++k) {
      positions.push_back(channel.position[k]);
      normals.push_back(channel.normal[k]);
    }
  }
  const py::ssize_t rows = count_of(channels.size());
  py::dict entry;
  entry["name"] = names;
  entry["part"] = array_of(indices_of(parts));
  entry["position_mm"] = array_of(std::move(positions), {rows, 3});
  entry["normal"] = array_of(std::move(normals), {rows, 3});
  entry["area_mm2"] = array_of(std::move(areas));
  return entry;
}

py::object events_of(const RunDataPtr& data, std::size_t point) {
  data->read_all_events();
  if (point >= data->events.size()) return py::none();
  const EventColumns& events = data->events[point];
  const py::capsule owner = owner_of(data);
  const py::ssize_t rows = count_of(events.size()), channels = count_of(events.channels.size());
  const auto per_channel = [&](const auto& values) { return view(values.data(), {rows, channels}, owner); };
  const auto deep = [&](const std::vector<float>& values) {
    const py::ssize_t depth = rows * channels == 0 ? 0 : count_of(values.size()) / (rows * channels);
    return view(values.data(), {rows, channels, depth}, owner);
  };
  py::dict entry;
  entry["event"] = view(events.event, owner);
  entry["energy_keV"] = view(events.energy_keV, owner);
  entry["escaped_keV"] = view(events.escaped_keV, owner);
  entry["non_scintillating_keV"] = view(events.non_scintillating_keV, owner);
  entry["position_mm"] = view(events.position_mm.data(), {rows, 3}, owner);
  entry["part"] = view(events.part, owner);
  entry["emitted"] = view(events.emitted, owner);
  entry["detected"] = view(events.detected, owner);
  entry["channel_detected"] = per_channel(events.channel_detected);
  entry["first_ns"] = per_channel(events.first_ns);
  entry["charge"] = per_channel(events.charge);
  entry["amplitude"] = per_channel(events.amplitude);
  entry["time_ns"] = per_channel(events.time_ns);
  entry["order_ns"] = deep(events.order_ns);
  entry["waveform"] = deep(events.waveform);
  entry["photon_order"] = events.photon_order;
  entry["channels"] = channels_of(events.channels);
  return entry;
}

}  // namespace

RunDataPtr open_results(const std::string& path) {
  auto data = std::make_shared<RunData>();
  data->file = path;
  data->result = results::read_results(path);
  const results::ResultsStatus status = results::read_results_status(path);
  data->photon_list = status.has_photon_list;
  if (status.listed_events > 0) data->events.resize(data->result.points.size());
  data->surfaces = results::read_surfaces(path);
  return data;
}

void EventColumns::add(const tally::EventRecord& record) {
  event.push_back(record.event);
  emitted.push_back(record.emitted);
  detected.push_back(record.detected);
  energy_keV.push_back(record.energy_keV);
  escaped_keV.push_back(record.escaped_keV);
  non_scintillating_keV.push_back(record.non_scintillating_keV);
  position_mm.insert(position_mm.end(), record.position_mm.begin(), record.position_mm.end());
  part.push_back(record.part.has_value() ? static_cast<std::int32_t>(record.part.index()) : -1);
  for (const tally::ChannelRecord& channel : record.channels) {
    channel_detected.push_back(channel.detected);
    first_ns.push_back(channel.first_ns);
    charge.push_back(channel.charge);
    amplitude.push_back(channel.amplitude);
    time_ns.push_back(channel.time_ns);
    order_ns.insert(order_ns.end(), channel.order_ns.begin(), channel.order_ns.end());
    waveform.insert(waveform.end(), channel.waveform.begin(), channel.waveform.end());
  }
}

tally::EventRecord EventColumns::record(std::size_t row, std::uint32_t point) const {
  tally::EventRecord record;
  record.point = point;
  record.event = event[row];
  record.emitted = emitted[row];
  record.detected = detected[row];
  record.energy_keV = energy_keV[row];
  record.escaped_keV = escaped_keV[row];
  record.non_scintillating_keV = non_scintillating_keV[row];
  for (std::size_t k = 0; k < 3; ++k) record.position_mm[k] = position_mm[3 * row + k];
  if (part[row] >= 0) record.part = core::PartId(part[row]);
  const std::size_t count = channels.size(), orders = photon_order.size();
  record.channels.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    const std::size_t at = row * count + c;
    tally::ChannelRecord& channel = record.channels[c];
    channel.detected = channel_detected[at];
    channel.first_ns = first_ns[at];
    channel.charge = charge[at];
    channel.amplitude = amplitude[at];
    channel.time_ns = time_ns[at];
    if (!order_ns.empty()) {
      const auto first = order_ns.begin() + static_cast<std::ptrdiff_t>(at * orders);
      channel.order_ns.assign(first, first + static_cast<std::ptrdiff_t>(orders));
    }
  }
  return record;
}

void RunData::read_all_events() {
  constexpr std::uint64_t kPortion = 8192;
  if (file.empty() || events_read || events.empty()) return;
  std::vector<EventColumns> columns(events.size());
  const std::vector<std::uint64_t> order = results::read_photon_order(file);
  for (std::size_t point = 0; point < columns.size(); ++point) {
    columns[point].channels = results::read_channels(file, point);
    columns[point].photon_order = order;
  }
  for (std::uint64_t row = 0;;) {
    const std::vector<tally::EventRecord> portion = results::read_events(file, row, kPortion);
    if (portion.empty()) break;
    row += portion.size();
    for (const tally::EventRecord& event : portion) columns.at(event.point).add(event);
  }
  events = std::move(columns);
  events_read = true;
}

void add_results(py::module_& module) {
  py::class_<RunData, RunDataPtr>(module, "RunData")
      .def("header", &header_of)
      .def("file", [](const RunData& data) { return data.file.string(); })
      .def("point", &point_of)
      .def("photons", &photons_of)
      .def("events", &events_of);
  module.def("open_results", &open_results, py::call_guard<py::gil_scoped_release>());
}

}  // namespace scintray::python
