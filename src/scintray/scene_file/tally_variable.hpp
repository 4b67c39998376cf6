#pragma once
/// What axes, conditions and scores of a [[tally]] measure.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/core/ids.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/core/units.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::scene_file {

/// A step event and its photon: all that a variable may depend on. Lengths mm, wavelengths nm, times ns;
/// positions and directions in the world.
struct StepView {
  core::StepEvent event = core::StepEvent::emitted;
  // The photon after the event.
  double wavelength_nm = 0.0;
  double time_ns = 0.0;
  double path_mm = 0.0;            ///< since emission
  std::uint32_t interactions = 0;  ///< boundary interactions since emission
  std::uint32_t scatterings = 0;   ///< bulk scatterings since emission
  std::uint32_t crossings = 0;     ///< changes of region since emission
  core::Vec3 position = core::Vec3::Zero();
  core::Vec3 direction = core::Vec3::UnitZ();  ///< of unit length
  core::Vec3 start = core::Vec3::Zero();       ///< where it was emitted
  /// Direction before the event, of unit length. NaN in tallies whose variables do not declare that they read
  /// it (TallyVariable::direction_before).
  core::Vec3 direction_before = core::Vec3::UnitZ();
  // At a face that the tally names.
  double cos_before = 0.0;                  ///< |cosine| to the face's normal before the interaction
  core::Vec3 normal = core::Vec3::UnitZ();  ///< of the face, of unit length, out of its part
  core::FaceId face;
  core::PartId part;         ///< the part it is in, or the sensor's; none: the ambient space
  core::PartId source_part;  ///< the part it was emitted in; likewise
};

/// Place of a part among the names of parts: the ambient space, which is no part, comes first.
constexpr std::uint32_t place_of(core::PartId part) { return part.has_value() ? part.index() + 1 : 0; }

/// What the values of a variable are: numbers, or names of one kind.
enum class VariableKind {
  number,
  part,         ///< parts; an axis without names has all, or the sensors when nothing but detection counts
  source_part,  ///< parts; an axis without names has those of the source
  face,         ///< the faces that the tally names
  event,        ///< the step events that the tally counts
};

/// At a face, whether a variable is of the direction before or after the interaction.
enum class FaceSide { none, before, after };

/// A variable: a word of scene files and results files, and what it measures.
struct TallyVariable {
  std::string name;
  VariableKind kind = VariableKind::number;
  core::Dimension dimension = core::Dimension::dimensionless;  ///< of a number, which is in its internal unit
  std::optional<double> low = {}, high = {};  ///< what it cannot lie beyond; ends of an axis by default
  bool along = false;       ///< measured along a direction of unit length, which the scene has to give
  bool spans_face = false;  ///< at a face, an axis without bounds has the face's extent
  bool at_face = false;     ///< there is none away from faces
  FaceSide side = FaceSide::none;
  /// It reads StepView::direction_before. The run then visits every total reflection, which takes time.
  bool direction_before = false;
  /// Of a number: its value. `along` is zero unless the variable is measured along a direction.
  double (*number)(const StepView& view, const core::Vec3& along) = nullptr;
  /// Of a name: its place among the names of the kind, which begin with the ambient space
  /// where they are parts (place_of).
  std::uint32_t (*place)(const StepView& view) = nullptr;

  bool is_name() const { return kind != VariableKind::number; }
  /// May be summed as the score of a tally.
  bool is_score() const { return !is_name() && !along; }
  /// "mm", "ns", ...; "1" of plain numbers.
  const char* unit() const;
};
using TallyVariablePtr = std::shared_ptr<const TallyVariable>;

/// The variables that scenes may name. Constant once filled; copies share the variables.
class TallyVariables {
 public:
  /// The variables that are built in.
  TallyVariables();
  static const TallyVariables& built_in();

  /// Adds a variable. @throws InternalError when its name is none, or is taken, or it has not just the
  /// function of its kind
  void add(TallyVariable variable);

  /// The variable of a name; null when there is none.
  TallyVariablePtr find(std::string_view name) const;
  /// The same of one that is known to be there. @throws InternalError when it is not
  TallyVariablePtr at(std::string_view name) const;
  /// In the order in which they were added, built-in ones first.
  const std::vector<TallyVariablePtr>& all() const { return variables_; }
  /// Names of those that `is` accepts.
  std::vector<std::string> names(bool (*is)(const TallyVariable&)) const;

 private:
  std::vector<TallyVariablePtr> variables_;
};

}  // namespace scintray::scene_file
