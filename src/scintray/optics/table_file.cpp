/// Table files: one HDF5 group per slice, which contains one per side with one row per node.

#include <algorithm>
#include <map>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/optics/reciprocal_kernel.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/optics/table_group.hpp"

namespace scintray::optics {

namespace {

constexpr const char* kFormat = "ScintRay surface table";
constexpr const char* kFolded = "folded";
constexpr const char* kDirectional = "directional";
constexpr std::uint64_t kAzimuthRow = kPolarBins * (kAzimuthBins + 1);

/// Directions of one kind (reflected or transmitted) of all nodes; rows of empty nodes are zero.
void write_directions(core::h5::Group group, const std::vector<TableNode>& nodes,
                      DirectionQuantiles TableNode::*kind) {
  std::vector<std::uint64_t> rays;
  std::vector<std::uint8_t> present;
  std::vector<float> polar, azimuth;
  for (const TableNode& node : nodes) {
    const DirectionQuantiles& q = node.*kind;
    rays.push_back(q.rays);
    present.push_back(q.empty() ? 0 : 1);
    polar.insert(polar.end(), q.polar.begin(), q.polar.end());
    azimuth.insert(azimuth.end(), q.azimuth.begin(), q.azimuth.end());
    polar.resize(rays.size() * (kPolarBins + 1), 0.0f);
    azimuth.resize(rays.size() * kAzimuthRow, 0.0f);
  }
  group.write("rays", rays);
  group.write("present", present);
  group.write("polar_rad", polar, {nodes.size(), kPolarBins + 1});
  group.write("azimuth_rad", azimuth, {nodes.size(), kPolarBins, kAzimuthBins + 1});
}

void write_side(core::h5::Group group, const std::vector<TableNode>& nodes) {
  std::map<std::string, std::vector<double>> columns;
  std::vector<std::uint64_t> rays;
  for (const TableNode& node : nodes) {
    columns["incidence_rad"].push_back(node.incidence_rad);
    columns["traced_incidence_rad"].push_back(node.traced_incidence_rad);
    columns["reflectance"].push_back(node.reflectance);
    columns["reflectance_error"].push_back(node.reflectance_error);
    columns["absorptance"].push_back(node.absorptance);
    columns["absorptance_error"].push_back(node.absorptance_error);
    columns["mean_slope_rad"].push_back(node.mean_slope_rad);
    rays.push_back(node.rays);
  }
  for (const auto& [name, values] : columns) group.write(name, values);
  group.write("rays", rays);
  write_directions(group.create_group("reflected"), nodes, &TableNode::reflected);
  write_directions(group.create_group("transmitted"), nodes, &TableNode::transmitted);
}

void write_provenance(core::h5::Group group, const TableProvenance& p) {
  group.set_attribute("", "map", p.map);
  group.set_attribute("", "stack", p.stack);
  group.set_attribute("", "preparation", p.preparation);
  group.set_attribute("", "tiling", p.tiling);
  group.set_attribute("", "reciprocity", p.reciprocity);
  group.set_attribute("", "version", p.version);
  const std::vector<std::pair<const char*, std::uint64_t>> counts = {
      {"seed", p.seed},         {"rays_per_azimuth", p.rays_per_azimuth},
      {"azimuths", p.azimuths}, {"unclassified", p.unclassified},
      {"cut", p.cut},           {"unconverged", p.unconverged}};
  group.set_attribute("", "target_error", p.target_error);
  for (const auto& [name, value] : counts) group.write(name, std::vector<std::uint64_t>{value});
}

const core::h5::Shape kKernelShape{ReciprocalKernel::kStates, ReciprocalKernel::kStates,
                                   ReciprocalKernel::kTurns};

std::string slice_name(std::size_t slice) { return "slice_" + std::to_string(slice); }

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what,
                         const std::string& hint) {
  throw core::InputError({{path.string()}, what, hint});
}

/// Reader of a table file: checks the shapes of arrays before they are used.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path) {}

  template <typename T>
  std::vector<T> array(const core::h5::Group& group, const std::string& name,
                       const core::h5::Shape& expected) const {
    core::h5::Shape shape;
    std::vector<T> values = group.read<T>(name, &shape);
    if (shape != expected)
      damaged("dataset " + name + " has shape " + text(shape) + "; expected " + text(expected));
    return values;
  }

  core::h5::Group group(const core::h5::Group& parent, const std::string& name) const {
    if (!parent.has(name)) damaged("group " + name + " is missing");
    return parent.open_group(name);
  }

  [[noreturn]] void damaged(const std::string& what) const {
    refuse(path_, "damaged surface table: " + what, "rebuild the table with `scintray table build`");
  }

 private:
  static std::string text(const core::h5::Shape& shape) {
    std::string result = "(";
    for (std::size_t d = 0; d < shape.size(); ++d) result += (d ? ", " : "") + std::to_string(shape[d]);
    return result + ")";
  }

  const std::filesystem::path& path_;
};

void read_directions(const Reader& reader, const core::h5::Group& group, std::vector<TableNode>& nodes,
                     DirectionQuantiles TableNode::*kind) {
  const std::uint64_t n = nodes.size();
  const auto rays = reader.array<std::uint64_t>(group, "rays", {n});
  const auto present = reader.array<std::uint8_t>(group, "present", {n});
  const auto polar = reader.array<float>(group, "polar_rad", {n, kPolarBins + 1});
  const auto azimuth = reader.array<float>(group, "azimuth_rad", {n, kPolarBins, kAzimuthBins + 1});
  for (std::uint64_t k = 0; k < n; ++k) {
    DirectionQuantiles& q = nodes[k].*kind;
    q.rays = rays[k];
    if (!present[k]) continue;
    const float* first_polar = polar.data() + k * (kPolarBins + 1);
    const float* first_azimuth = azimuth.data() + k * kAzimuthRow;
    q.polar.assign(first_polar, first_polar + kPolarBins + 1);
    q.azimuth.assign(first_azimuth, first_azimuth + kAzimuthRow);
  }
}

std::vector<TableNode> read_side(const Reader& reader, const core::h5::Group& group) {
  const auto incidence = group.read<double>("incidence_rad");
  const std::uint64_t n = incidence.size();
  const auto traced = reader.array<double>(group, "traced_incidence_rad", {n});
  const auto reflectance = reader.array<double>(group, "reflectance", {n});
  const auto error = reader.array<double>(group, "reflectance_error", {n});
  const auto absorptance = reader.array<double>(group, "absorptance", {n});
  const auto absorptance_error = reader.array<double>(group, "absorptance_error", {n});
  const auto slope = reader.array<double>(group, "mean_slope_rad", {n});
  const auto rays = reader.array<std::uint64_t>(group, "rays", {n});
  std::vector<TableNode> nodes(n);
  for (std::uint64_t k = 0; k < n; ++k) {
    nodes[k].incidence_rad = incidence[k];
    nodes[k].traced_incidence_rad = traced[k];
    nodes[k].reflectance = reflectance[k];
    nodes[k].reflectance_error = error[k];
    nodes[k].absorptance = absorptance[k];
    nodes[k].absorptance_error = absorptance_error[k];
    nodes[k].mean_slope_rad = slope[k];
    nodes[k].rays = rays[k];
  }
  read_directions(reader, reader.group(group, "reflected"), nodes, &TableNode::reflected);
  read_directions(reader, reader.group(group, "transmitted"), nodes, &TableNode::transmitted);
  return nodes;
}

std::shared_ptr<const ReciprocalKernel> read_kernel(const Reader& reader, const core::h5::Group& slice) {
  if (!slice.has("reciprocal_shares")) return nullptr;
  return std::make_shared<const ReciprocalKernel>(
      reader.array<float>(slice, "reciprocal_shares", kKernelShape));
}

TableProvenance read_provenance(const Reader& reader, const core::h5::Group& group) {
  TableProvenance p;
  p.map = group.string_attribute("", "map");
  p.stack = group.string_attribute("", "stack");
  p.preparation = group.string_attribute("", "preparation");
  p.tiling = group.string_attribute("", "tiling");
  p.reciprocity = group.string_attribute("", "reciprocity");
  p.version = group.string_attribute("", "version");
  const auto count = [&](const char* name) { return reader.array<std::uint64_t>(group, name, {1}).front(); };
  p.seed = count("seed");
  p.rays_per_azimuth = count("rays_per_azimuth");
  p.azimuths = count("azimuths");
  p.unclassified = count("unclassified");
  p.cut = count("cut");
  p.unconverged = count("unconverged");
  p.target_error = group.double_attribute("", "target_error");
  return p;
}

void check_version(const std::filesystem::path& path, const core::h5::Group& root) {
  if (!root.has_attribute("", "format") || !root.has_attribute("", "format_version") ||
      root.string_attribute("", "format") != kFormat)
    refuse(path, "not a surface table of ScintRay", "build one with `scintray table build`");
  const std::int64_t version = root.integer_attribute("", "format_version");
  if (version != kTableFileVersion)
    refuse(path,
           "surface table of file version " + std::to_string(version) + "; this ScintRay reads version " +
               std::to_string(kTableFileVersion),
           "rebuild the table with `scintray table build`");
}

/// True when nothing is lost by writing a table there: no file, an empty one, or a table.
bool may_hold_table(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) || std::filesystem::is_empty(path, error)) return true;
  try {
    const core::h5::File file = core::h5::File::open(path);
    const core::h5::Group root = file.root();
    return root.has_attribute("", "format") && root.string_attribute("", "format") == kFormat;
  } catch (const core::Error&) {
    return false;
  }
}

}  // namespace

void write_table(core::h5::Group root, const SurfaceTable& table) {
  const bool directional = table.azimuth_kind() == AzimuthKind::directional;
  root.set_attribute("", "format", std::string(kFormat));
  root.set_attribute("", "format_version", kTableFileVersion);
  root.set_attribute("", "azimuths", std::string(directional ? kDirectional : kFolded));
  std::vector<double> polar, azimuth;
  for (int k = 0; k <= kPolarBins; ++k) polar.push_back(polar_level(k));
  for (int k = 0; k <= kAzimuthBins; ++k)
    azimuth.push_back(directional ? signed_azimuth_level(k) : azimuth_level(k));
  root.write("polar_levels", polar);
  root.write("azimuth_levels", azimuth);
  std::vector<double> wavelengths, azimuths, inside, outside;
  for (const TableSlice& slice : table.slices()) {
    core::h5::Group group = root.create_group(slice_name(wavelengths.size()));
    wavelengths.push_back(slice.wavelength_nm);
    azimuths.push_back(slice.azimuth_rad);
    inside.push_back(slice.index.inside);
    outside.push_back(slice.index.outside);
    write_side(group.create_group("from_inside"), slice.from_inside);
    write_side(group.create_group("from_outside"), slice.from_outside);
    if (slice.reciprocal) group.write("reciprocal_shares", slice.reciprocal->shares(), kKernelShape);
  }
  root.write("wavelength_nm", wavelengths);
  root.write("azimuth_rad", azimuths);
  root.write("index_inside", inside);
  root.write("index_outside", outside);
  write_provenance(root.create_group("provenance"), table.provenance());
}

void write_table(const std::filesystem::path& path, const SurfaceTable& table) {
  core::require_replaceable(path, "\x89HDF\r\n\x1a\n");
  if (!may_hold_table(path))
    throw core::InputError({{path.string()},
                            "this exists and is not a surface table, so it is not written over",
                            "choose another name for the table, or move what is there away"});
  core::h5::File file = core::h5::File::create(path);
  write_table(file.root(), table);
  file.commit();
}

SurfaceTable read_table(const core::h5::File& file) {
  const std::filesystem::path& path = file.path();
  const core::h5::Group root = file.root();
  check_version(path, root);
  const Reader reader(path);
  const auto wavelengths = root.read<double>("wavelength_nm");
  const std::uint64_t n = wavelengths.size();
  const auto azimuths = reader.array<double>(root, "azimuth_rad", {n});
  const auto inside = reader.array<double>(root, "index_inside", {n});
  const auto outside = reader.array<double>(root, "index_outside", {n});
  const std::string kind = root.string_attribute("", "azimuths");
  if (kind != kDirectional && kind != kFolded) reader.damaged("its azimuths are \"" + kind + "\"");
  try {
    std::vector<TableSlice> slices;
    for (std::uint64_t k = 0; k < n; ++k) {
      if (!(inside[k] > 0.0 && outside[k] > 0.0)) reader.damaged("refractive indices are not positive");
      const core::h5::Group group = reader.group(root, slice_name(k));
      slices.push_back({wavelengths[k],
                        azimuths[k],
                        {inside[k], outside[k]},
                        read_side(reader, reader.group(group, "from_inside")),
                        read_side(reader, reader.group(group, "from_outside")),
                        read_kernel(reader, group)});
    }
    return SurfaceTable(std::move(slices),
                        kind == kDirectional ? AzimuthKind::directional : AzimuthKind::folded,
                        read_provenance(reader, reader.group(root, "provenance")));
  } catch (const core::InputError& error) {
    // Adds the file, which is not available to the checks of the table itself.
    std::vector<core::Problem> problems = error.problems();
    for (core::Problem& problem : problems)
      if (problem.where.file.empty()) problem.where.file = path.string();
    throw core::InputError(std::move(problems));
  }
}

SurfaceTable read_table(const std::filesystem::path& path) { return read_table(core::h5::File::open(path)); }

}  // namespace scintray::optics
