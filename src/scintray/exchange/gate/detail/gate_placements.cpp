#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "scintray/exchange/gate/detail/gate.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gate {

namespace {

constexpr double kMostCopies = 200'000;

/// Matrix of a rotation about an axis of any length; the identity for an axis of length zero.
Eigen::Matrix3d turn(double angle_rad, const core::Vec3& axis) {
  if (!(axis.norm() > 0.0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
}

/// The settings of one repeater, with GATE's defaults.
class Settings {
 public:
  explicit Settings(const Repeater& repeater) : settings_(repeater.settings) {}

  int count(const std::string& name, int fallback) const {
    const Command* command = find(name);
    if (!command) return fallback;
    const double value = number(*command, 0);
    if (!(value >= 1.0 && value <= kMostCopies) || value != std::floor(value))
      throw core::InputError(core::Problem{command->where, command->path + " is no whole number from 1 on",
                                           "give the number of copies"});
    return static_cast<int>(value);
  }
  double angle(const std::string& name, double fallback_rad) const {
    const Command* command = find(name);
    return command ? quantity(*command, 0, core::Dimension::angle) : fallback_rad;
  }
  double length(const std::string& name) const {
    const Command* command = find(name);
    return command ? quantity(*command, 0, core::Dimension::length) : 0.0;
  }
  core::Vec3 lengths(const std::string& name) const {
    const Command* command = find(name);
    if (!command) return core::Vec3::Zero();
    core::Vec3 result;
    for (int axis = 0; axis < 3; ++axis)
      result[axis] = quantity(*command, static_cast<std::size_t>(axis), core::Dimension::length);
    return result;
  }
  /// Three numbers without a unit, in mm.
  core::Vec3 point(const std::string& name, const core::Vec3& fallback) const {
    const Command* command = find(name);
    return command ? core::Vec3(number(*command, 0), number(*command, 1), number(*command, 2)) : fallback;
  }
  bool flag(const std::string& name, bool fallback) const {
    const Command* command = find(name);
    if (!command) return fallback;
    if (command->words.empty()) return true;
    const char first = command->words[0][0];
    return first == '1' || first == 't' || first == 'T' || first == 'y' || first == 'Y';
  }
  const Command* find(const std::string& name) const {
    const auto found = settings_.find(name);
    return found == settings_.end() ? nullptr : &found->second;
  }

 private:
  const std::map<std::string, Command>& settings_;
};

using Placements = std::vector<Placement>;

void repeat_cubic(const Settings& settings, const Placement& original, Placements& result) {
  const core::Vec3 step = settings.lengths("setRepeatVector");
  const Eigen::Vector3i counts(settings.count("setRepeatNumberX", 1), settings.count("setRepeatNumberY", 1),
                               settings.count("setRepeatNumberZ", 1));
  core::Vec3 first = original.position_mm;
  if (settings.flag("autoCenter", true))
    first -= 0.5 * step.cwiseProduct((counts.array() - 1).matrix().cast<double>());
  for (int k = 0; k < counts.z(); ++k)
    for (int j = 0; j < counts.y(); ++j)
      for (int i = 0; i < counts.x(); ++i)
        result.push_back({original.axes, first + core::Vec3(i, j, k).cwiseProduct(step)});
}

void repeat_linear(const Settings& settings, const Placement& original, Placements& result) {
  const core::Vec3 step = settings.lengths("setRepeatVector");
  const int count = settings.count("setRepeatNumber", 1);
  const double first = settings.flag("autoCenter", true) ? -0.5 * (count - 1) : 0.0;
  for (int i = 0; i < count; ++i)
    result.push_back({original.axes, original.position_mm + (first + i) * step});
}

/// GateAngularRepeater::PushMyPlacements.
void repeat_ring(const Settings& settings, const Placement& original, Placements& result) {
  constexpr int kMostShifts = 8;
  const int count = settings.count("setRepeatNumber", 1);
  int modulo = settings.count("setModuloNumber", 1);
  if (modulo > kMostShifts) modulo = 1;
  const core::Vec3 start = settings.point("setPoint1", core::Vec3::Zero());
  const core::Vec3 axis = settings.point("setPoint2", core::Vec3::UnitZ()) - start;
  const double span = settings.angle("setAngularSpan", 2.0 * core::kPi);
  const double full = 0.0005 * core::kDegree;
  const double step = std::abs(span - 2.0 * core::kPi) < full ? span / count : span / std::max(1, count - 1);
  const bool turns =
      settings.flag("enableAutoRotation", true) && !settings.flag("disableAutoRotation", false);
  for (int i = 0; i < count; ++i) {
    const double angle = settings.angle("setFirstAngle", 0.0) + step * i;
    const core::Vec3 shift(0.0, 0.0, settings.length("setZShift" + std::to_string(i % modulo + 1)));
    Placement copy;
    copy.position_mm = start + turn(angle, axis) * (original.position_mm + shift - start);
    copy.axes = original.axes;
    if (turns)
      copy.axes = settings.flag("combineWithRotationFirst", false) ? copy.axes * turn(-angle, axis)
                                                                   : turn(-angle, axis) * copy.axes;
    result.push_back(copy);
  }
}

/// The numbers of a file of placements, with their lines; # begins a comment.
class PlacementFile {
 public:
  explicit PlacementFile(const std::filesystem::path& path) : where_{path.string(), 0, 0} {
    std::istringstream lines(mesh::read_mesh_file(path));
    for (std::string line; std::getline(lines, line);) {
      ++where_.line;
      std::istringstream words(line.substr(0, line.find('#')));
      std::vector<std::string> row{std::istream_iterator<std::string>(words), {}};
      if (!row.empty()) rows_.push_back({"a row", std::move(row), where_});
    }
  }

  /// Unit of a column, from the beginning of the file; empty when the file has no such column.
  std::optional<double> unit(const std::string& column, core::Dimension dimension) {
    if (at_ >= rows_.size() || rows_[at_].words[0] != column) return std::nullopt;
    Command one = rows_[at_++];
    one.path = column;
    one.words[0] = "1";
    return quantity(one, 0, dimension);
  }

  std::vector<Command> rest() const {
    return {rows_.begin() + static_cast<std::ptrdiff_t>(at_), rows_.end()};
  }
  const core::FileLocation& where() const { return where_; }

 private:
  core::FileLocation where_;
  std::vector<Command> rows_;
  std::size_t at_ = 0;
};

void repeat_generic(const Settings& settings, const Placement& original, const std::filesystem::path& folder,
                    Placements& result) {
  const Command* name = settings.find("setPlacementsFilename");
  if (!name || name->words.empty()) return;
  PlacementFile file(find_file(folder, name->words[0], name->where));
  file.unit("Time", core::Dimension::time);
  const std::optional<double> angle = file.unit("Rotation", core::Dimension::angle);
  const std::optional<double> length = file.unit("Translation", core::Dimension::length);
  if (!angle || !length)
    throw core::InputError(
        core::Problem{file.where(), "a list of placements without its columns Rotation and Translation",
                      "begin with the lines: Time s, Rotation deg, Translation mm. Of a file with one of the "
                      "two, GATE uses neither: it takes one for the other"});
  const bool relative = settings.flag("useRelativeTranslation", true);
  for (const Command& row : file.rest()) {
    Placement copy;
    copy.axes = turn(number(row, 1) * *angle, core::Vec3(number(row, 2), number(row, 3), number(row, 4)));
    copy.position_mm = *length * core::Vec3(number(row, 5), number(row, 6), number(row, 7));
    if (relative) copy.position_mm += original.position_mm;
    result.push_back(copy);
  }
}

}  // namespace

std::vector<Placement> copies(const Volume& volume, const std::filesystem::path& folder) {
  Placement placed = volume.placement;
  placed.axes = turn(-volume.rotation_rad, volume.rotation_axis);
  Placements result{placed};
  for (const Repeater& repeater : volume.repeaters) {
    Placements repeated;
    const Settings settings(repeater);
    for (const Placement& original : result) {
      switch (repeater.kind) {
        case Repeater::Kind::cubic:
          repeat_cubic(settings, original, repeated);
          break;
        case Repeater::Kind::linear:
          repeat_linear(settings, original, repeated);
          break;
        case Repeater::Kind::ring:
          repeat_ring(settings, original, repeated);
          break;
        case Repeater::Kind::generic:
          repeat_generic(settings, original, folder, repeated);
          break;
      }
      if (static_cast<double>(repeated.size()) > kMostCopies)
        throw core::InputError(core::Problem{volume.where,
                                             "volume \"" + volume.name + "\" has more than 200000 copies",
                                             "check the numbers of its repeaters"});
    }
    result = std::move(repeated);
  }
  if (result.empty())
    throw core::InputError(core::Problem{volume.where, "no copy of volume \"" + volume.name + "\" is placed",
                                         "give its genericRepeater a file: setPlacementsFilename"});
  return result;
}

}  // namespace scintray::exchange::gate
