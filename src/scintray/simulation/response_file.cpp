#include "scintray/simulation/response.hpp"

#include <cmath>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::simulation {

namespace {

constexpr const char* kResponseFormat = "scintray-response";

void say(core::h5::Group& group, const std::string& name, const std::string& unit,
         const std::string& description) {
  group.set_attribute(name, "unit", unit);
  group.set_attribute(name, "description", description);
}

std::vector<double> numbers_of(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Probabilities follow from the counts: they are there for other programs to read.
void put_probability(core::h5::Group& group, const ResponseGrid& grid, std::size_t channels,
                     const core::h5::Shape& shape) {
  std::vector<float> values, errors;
  values.reserve(grid.detected.size());
  errors.reserve(grid.detected.size());
  for (std::size_t i = 0; i < grid.detected.size(); ++i) {
    const core::Estimate estimate = core::binomial_estimate(grid.detected[i], grid.photons[i / channels]);
    const bool empty = grid.photons[i / channels] == 0;
    values.push_back(empty ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(estimate.value));
    errors.push_back(empty ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(estimate.error));
  }
  group.write("probability", values, shape);
  say(group, "probability", "1", "probability that a photon is detected, per cell and channel; NaN: empty");
  group.write("probability_error", errors, shape);
  say(group, "probability_error", "1", "binomial standard error of probability");
}

void put_grid(core::h5::Group& group, const ResponseGrid& grid, std::size_t channels) {
  group.set_attribute("", "part", grid.part);
  group.write("low_mm", numbers_of(grid.low));
  say(group, "low_mm", "mm", "corner of the grid: x, y, z");
  group.write("pitch_mm", numbers_of(grid.pitch));
  say(group, "pitch_mm", "mm", "edges of a cell: x, y, z");
  const core::h5::Shape cells{grid.cells[0], grid.cells[1], grid.cells[2]};
  const core::h5::Shape responses{cells[0], cells[1], cells[2], channels};
  group.write("photons_emitted", grid.photons, cells);
  say(group, "photons_emitted", "1", "photons emitted in each cell; 0: nothing of the part is in it");
  group.write("photons_detected", grid.detected, responses);
  say(group, "photons_detected", "1", "of them detected, per cell and channel");
  put_probability(group, grid, channels, responses);
  group.write("delay_ns", grid.delays_ns);
  say(group, "delay_ns", "ns",
      "times from emission to detection of the first photons of each cell and channel, as many as "
      "photons_detected or at most delays_kept, one after the other");
}

core::InputError wrong_map(const std::filesystem::path& path, const std::string& what,
                           const std::string& hint) {
  return core::InputError({{path.string()}, what, hint});
}

bool has_response_format(const core::h5::Group& root) {
  return root.has_attribute("", "format") && root.string_attribute("", "format") == kResponseFormat;
}

bool is_response_file(const std::filesystem::path& path) {
  try {
    return has_response_format(core::h5::File::open(path).root());
  } catch (const core::Error&) {
    return false;
  }
}

/// Reads one grid, with checks that nothing contradicts anything.
class GridReader {
 public:
  GridReader(const std::filesystem::path& path, const ResponseMap& map) : path_(path), map_(map) {}

  ResponseGrid read(const core::h5::Group& group) const {
    ResponseGrid grid;
    grid.part = group.string_attribute("", "part");
    grid.low = vec(group, "low_mm");
    grid.pitch = vec(group, "pitch_mm");
    require(grid.low.allFinite() && grid.pitch.allFinite() && grid.pitch.minCoeff() > 0.0,
            "the place of the grid of \"" + grid.part + "\" is not one");
    core::h5::Shape cells, responses;
    grid.photons = group.read<std::uint32_t>("photons_emitted", &cells);
    grid.detected = group.read<std::uint32_t>("photons_detected", &responses);
    require(cells.size() == 3 && !grid.photons.empty(), "photons_emitted has not three axes");
    for (std::size_t axis = 0; axis < 3; ++axis) grid.cells[axis] = static_cast<std::uint32_t>(cells[axis]);
    cells.push_back(map_.channels.size());
    require(responses == cells, "photons_detected does not match photons_emitted and the channels");
    grid.delays_ns = group.read<float>("delay_ns");
    check_counts(grid);
    for (const float delay : grid.delays_ns)
      require(std::isfinite(delay) && delay >= 0.0f, "delay_ns has a time that is not one");
    return grid;
  }

 private:
  void require(bool holds, const std::string& what) const {
    if (!holds)
      throw wrong_map(path_, "this response map contradicts itself: " + what,
                      "copy it again from where it was made, or build it again");
  }

  core::Vec3 vec(const core::h5::Group& group, const std::string& name) const {
    const auto values = group.read<double>(name);
    require(values.size() == 3, name + " has not three numbers");
    return {values[0], values[1], values[2]};
  }

  void check_counts(const ResponseGrid& grid) const {
    const std::size_t channels = map_.channels.size();
    std::uint64_t delays = 0, emitted = 0;
    for (std::size_t cell = 0; cell < grid.photons.size(); ++cell) {
      std::uint64_t detected = 0;
      for (std::size_t channel = 0; channel < channels; ++channel) {
        detected += grid.detected[cell * channels + channel];
        delays += map_.kept(grid.detected[cell * channels + channel]);
      }
      require(detected <= grid.photons[cell], "more photons are detected than emitted");
      emitted += grid.photons[cell];
    }
    require(emitted > 0, "all cells of \"" + grid.part + "\" are empty");
    require(delays == grid.delays_ns.size(), "delay_ns has another length than the counts say");
  }

  const std::filesystem::path& path_;
  const ResponseMap& map_;
};

std::uint32_t count_attribute(const std::filesystem::path& path, const core::h5::Group& root,
                              const std::string& name) {
  const std::int64_t value = root.integer_attribute("", name);
  if (value < 1 || value > std::numeric_limits<std::uint32_t>::max())
    throw wrong_map(path, "this response map has " + std::to_string(value) + " as its " + name,
                    "build it again");
  return static_cast<std::uint32_t>(value);
}

}  // namespace

void check_response_path(const std::filesystem::path& path) {
  const auto status = std::filesystem::status(path);
  if (!std::filesystem::exists(status) || is_response_file(path)) return;
  throw wrong_map(path, "this exists and is not a response map, so it is not written over",
                  "choose another name for the map, or move what is there away");
}

void write_response(const std::filesystem::path& path, const ResponseFile& file) {
  check_response_path(path);
  core::h5::File out = core::h5::File::create(path);
  core::h5::Group root = out.root();
  const ResponseMap& map = file.map;
  root.set_attribute("", "format", std::string(kResponseFormat));
  root.set_attribute("", "version", kResponseVersion);
  root.set_attribute("", "scintray_version", file.version);
  root.set_attribute("", "scene_file", file.scene_file);
  root.set_attribute("", "photons_per_cell", static_cast<std::int64_t>(map.photons_per_cell));
  root.set_attribute("", "delays_kept", static_cast<std::int64_t>(map.delays_kept));
  root.set_attribute("", "unpolarised", static_cast<std::int64_t>(map.unpolarised));
  root.write("seed", std::vector<std::uint64_t>{map.seed}, {});
  say(root, "seed", "1", "seed of the random streams");
  root.write_strings("scene", {file.scene_text});
  say(root, "scene", "", "the scene file, whole");
  root.write_strings("channel_name", map.channels);
  say(root, "channel_name", "", "name of each channel");
  core::h5::Group grids = root.create_group("grids");
  grids.set_attribute("", "description", std::string("one group for each part that scintillates"));
  for (std::size_t i = 0; i < map.grids.size(); ++i) {
    core::h5::Group group = grids.create_group(results::format::numbered(i));
    put_grid(group, map.grids[i], map.channels.size());
  }
  out.commit();
}

ResponseFile read_response(const std::filesystem::path& path) {
  const core::h5::File in = core::h5::File::open(path);
  const core::h5::Group root = in.root();
  if (!has_response_format(root))
    throw wrong_map(path, "this HDF5 file is not a response map",
                    "name a file that `scintray response build` wrote");
  const std::int64_t version = root.integer_attribute("", "version");
  if (version != kResponseVersion)
    throw wrong_map(path,
                    "this response map has format version " + std::to_string(version) +
                        " (written by ScintRay " + root.string_attribute("", "scintray_version") +
                        "), but this program reads version " + std::to_string(kResponseVersion),
                    "build it again with this ScintRay");
  ResponseFile file;
  file.version = root.string_attribute("", "scintray_version");
  file.scene_file = root.string_attribute("", "scene_file");
  const auto scene = root.read_strings("scene");
  const auto seed = root.read<std::uint64_t>("seed");
  if (scene.size() != 1 || seed.size() != 1)
    throw wrong_map(path, "this response map does not say which scene or seed it is of", "build it again");
  file.scene_text = scene.front();
  file.map.seed = seed.front();
  file.map.channels = root.read_strings("channel_name");
  file.map.photons_per_cell = count_attribute(path, root, "photons_per_cell");
  file.map.delays_kept = count_attribute(path, root, "delays_kept");
  file.map.unpolarised = root.integer_attribute("", "unpolarised") != 0;
  const core::h5::Group grids = root.open_group("grids");
  const GridReader reader(path, file.map);
  for (const std::string& name : grids.members())
    file.map.grids.push_back(reader.read(grids.open_group(name)));
  if (file.map.grids.empty() || file.map.channels.empty())
    throw wrong_map(path, "this response map is empty", "build it again");
  return file;
}

}  // namespace scintray::simulation
