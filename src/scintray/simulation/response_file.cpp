#include "scintray/simulation/response.hpp"

#include <cmath>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::simulation {

namespace {

/// Version before maps could be traced backward, which is read as well.
constexpr std::int64_t kForwardVersion = 1;

constexpr const char* kResponseFormat = "scintray-response";

void describe(core::h5::Group& group, const std::string& name, const std::string& unit,
              const std::string& description) {
  group.set_attribute(name, "unit", unit);
  group.set_attribute(name, "description", description);
}

std::vector<double> numbers_of(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Probabilities of a map traced forward follow from the counts, and are there for other programs to read.
void put_probability(core::h5::Group& group, const ResponseGrid& grid, std::size_t channels,
                     const core::h5::Shape& shape) {
  std::vector<float> values, errors;
  values.reserve(grid.detected.size());
  errors.reserve(grid.detected.size());
  for (std::size_t i = 0; i < grid.detected.size(); ++i) {
    const bool empty = grid.photons[i / channels] == 0;
    const core::Estimate estimate = empty ? core::Estimate{} : grid.estimate(i / channels, i);
    values.push_back(empty ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(estimate.value));
    errors.push_back(empty ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(estimate.error));
  }
  group.write("probability", values, shape);
  describe(group, "probability", "1",
           "probability that a photon is detected, per cell and channel; NaN: empty");
  group.write("probability_error", errors, shape);
  describe(group, "probability_error", "1", "standard error of probability");
}

void put_grid(core::h5::Group& group, const ResponseGrid& grid, std::size_t channels) {
  group.set_attribute("", "part", grid.part);
  group.write("low_mm", numbers_of(grid.low));
  describe(group, "low_mm", "mm", "corner of the grid: x, y, z");
  group.write("pitch_mm", numbers_of(grid.pitch));
  describe(group, "pitch_mm", "mm", "edges of a cell: x, y, z");
  const core::h5::Shape cells{grid.cells[0], grid.cells[1], grid.cells[2]};
  const core::h5::Shape responses{cells[0], cells[1], cells[2], channels};
  group.write("photons_emitted", grid.photons, cells);
  describe(
      group, "photons_emitted", "1",
      "photons emitted in each cell, or started at all channels of a map traced backward; 0: the part is "
      "not in the cell");
  group.write("photons_detected", grid.detected, responses);
  describe(group, "photons_detected", "1",
           "of them detected, per cell and channel; those that passed the cell in a map traced backward");
  put_probability(group, grid, channels, responses);
  group.write("delay_ns", grid.delays_ns);
  describe(group, "delay_ns", "ns",
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

/// Reader of one grid, which checks its consistency.
class GridReader {
 public:
  GridReader(const std::filesystem::path& path, const ResponseMap& map) : path_(path), map_(map) {}

  ResponseGrid read(const core::h5::Group& group) const {
    ResponseGrid grid;
    grid.part = group.string_attribute("", "part");
    grid.low = vec(group, "low_mm");
    grid.pitch = vec(group, "pitch_mm");
    require(grid.low.allFinite() && grid.pitch.allFinite() && grid.pitch.minCoeff() > 0.0,
            "the corner or the pitch of the grid of \"" + grid.part + "\" is not valid");
    core::h5::Shape cells, responses;
    grid.photons = group.read<std::uint32_t>("photons_emitted", &cells);
    grid.detected = group.read<std::uint32_t>("photons_detected", &responses);
    require(cells.size() == 3 && !grid.photons.empty(), "photons_emitted does not have three axes");
    for (std::size_t axis = 0; axis < 3; ++axis) grid.cells[axis] = static_cast<std::uint32_t>(cells[axis]);
    cells.push_back(map_.channels.size());
    require(responses == cells, "photons_detected does not match photons_emitted and the channels");
    grid.delays_ns = group.read<float>("delay_ns");
    check_counts(grid);
    if (map_.backward()) {
      grid.probabilities = probabilities(group, "probability", grid);
      grid.probability_errors = probabilities(group, "probability_error", grid);
    }
    for (const float delay : grid.delays_ns)
      require(std::isfinite(delay) && delay >= 0.0f, "delay_ns has a value that is not a time");
    return grid;
  }

 private:
  void require(bool holds, const std::string& what) const {
    if (!holds)
      throw wrong_map(path_, "this response map is inconsistent: " + what,
                      "copy it again from where it was made, or build it again");
  }

  core::Vec3 vec(const core::h5::Group& group, const std::string& name) const {
    const auto values = group.read<double>(name);
    require(values.size() == 3, name + " does not have three numbers");
    return {values[0], values[1], values[2]};
  }

  /// Probabilities of cells that are not empty; 0 for those of empty ones.
  std::vector<float> probabilities(const core::h5::Group& group, const std::string& name,
                                   const ResponseGrid& grid) const {
    std::vector<float> values = group.read<float>(name);
    require(values.size() == grid.detected.size(), name + " does not match photons_detected");
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (grid.photons[i / map_.channels.size()] == 0) values[i] = 0.0f;
      require(values[i] >= 0.0f && std::isfinite(values[i]), name + " has a value that is no probability");
      require((values[i] > 0.0f) == (grid.detected[i] > 0) || name != "probability",
              "probability does not match photons_detected");
    }
    return values;
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
    require(delays == grid.delays_ns.size(), "delay_ns does not have the length of the counts");
  }

  const std::filesystem::path& path_;
  const ResponseMap& map_;
};

std::uint32_t count_attribute(const std::filesystem::path& path, const core::h5::Group& root,
                              const std::string& name, std::int64_t least = 1) {
  const std::int64_t value = root.integer_attribute("", name);
  if (value < least || value > std::numeric_limits<std::uint32_t>::max())
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
  root.set_attribute("", "photons_per_channel", static_cast<std::int64_t>(map.photons_per_channel));
  root.set_attribute("", "delays_kept", static_cast<std::int64_t>(map.delays_kept));
  root.set_attribute("", "unpolarised", static_cast<std::int64_t>(map.unpolarised));
  root.write("seed", std::vector<std::uint64_t>{map.seed}, {});
  describe(root, "seed", "1", "seed of the random streams");
  root.write_strings("scene", {file.scene_text});
  describe(root, "scene", "", "the complete scene file");
  root.write_strings("channel_name", map.channels);
  describe(root, "channel_name", "", "name of each channel");
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
  if (version != kResponseVersion && version != kForwardVersion)
    throw wrong_map(path,
                    "this response map has format version " + std::to_string(version) +
                        " (written by ScintRay " + root.string_attribute("", "scintray_version") +
                        "), but this program reads versions " + std::to_string(kForwardVersion) + " and " +
                        std::to_string(kResponseVersion),
                    "build it again with this ScintRay");
  ResponseFile file;
  file.version = root.string_attribute("", "scintray_version");
  file.scene_file = root.string_attribute("", "scene_file");
  const auto scene = root.read_strings("scene");
  const auto seed = root.read<std::uint64_t>("seed");
  if (scene.size() != 1 || seed.size() != 1)
    throw wrong_map(path, "this response map does not state its scene or seed", "build it again");
  file.scene_text = scene.front();
  file.map.seed = seed.front();
  file.map.channels = root.read_strings("channel_name");
  if (version == kResponseVersion)
    file.map.photons_per_channel = count_attribute(path, root, "photons_per_channel", 0);
  file.map.photons_per_cell = count_attribute(path, root, "photons_per_cell", file.map.backward() ? 0 : 1);
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
