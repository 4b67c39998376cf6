#pragma once
/// Variables of the axes, conditions and scores of a [[tally]].

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

/// A step event and the state of its photon, on which variables depend. Lengths mm, wavelengths nm, times ns;
/// positions and directions in the world.
struct StepView {
  core::StepEvent event = core::StepEvent::emitted;
  // The photon after the event.
  double wavelength_nm = 0.0;
  double time_ns = 0.0;            ///< since the event, or the pulse of light, began
  double path_mm = 0.0;            ///< since emission
  std::uint32_t interactions = 0;  ///< boundary interactions since emission
  std::uint32_t scatterings = 0;   ///< bulk scatterings since emission
  std::uint32_t crossings = 0;     ///< changes of region since emission
  core::Vec3 position = core::Vec3::Zero();
  core::Vec3 direction = core::Vec3::UnitZ();  ///< of unit length
  core::Vec3 start = core::Vec3::Zero();       ///< position of emission
  /// Direction before the event, of unit length. NaN in tallies none of whose variables declares its use
  /// (TallyVariable::direction_before).
  core::Vec3 direction_before = core::Vec3::UnitZ();
  // At a face that the tally names.
  double cos_before = 0.0;                  ///< |cosine| to the face's normal before the interaction
  core::Vec3 normal = core::Vec3::UnitZ();  ///< of the face, of unit length, out of its part
  core::FaceId face;
  core::PartId part;         ///< the part of the event, or the sensor's; none: the ambient space
  core::PartId source_part;  ///< the part of emission; likewise
};

/// Place of a part among the names of parts; the ambient space, which is not a part, comes first.
constexpr std::uint32_t place_of(core::PartId part) { return part.has_value() ? part.index() + 1 : 0; }

/// Kind of a variable's values: numbers, or names of one kind.
enum class VariableKind {
  number,
  part,         ///< parts; an axis without names has all, or the sensors when only detection counts
  source_part,  ///< parts; an axis without names has those of the source
  face,         ///< the faces to which the tally is bound
  event,        ///< the step events that the tally counts
};

/// At a face, whether a variable is of the direction before or after the interaction.
enum class FaceSide { none, before, after };

/// A variable of tallies: its word in scene files and results files, and its value.
struct TallyVariable {
  std::string name;
  VariableKind kind = VariableKind::number;
  core::Dimension dimension = core::Dimension::dimensionless;  ///< of a number, which is in its internal unit
  std::optional<double> low = {}, high = {};  ///< bounds of its values; ends of an axis by default
  bool along = false;       ///< measured along a direction (unit vector) that the scene must define
  bool spans_face = false;  ///< at a face, an axis without bounds has the face's extent
  bool at_face = false;     ///< defined at faces only
  FaceSide side = FaceSide::none;
  /// True when it depends on StepView::direction_before. The run then visits every total reflection, which is
  /// slower.
  bool direction_before = false;
  /// Of a number: its value. `along` is zero unless the variable is measured along a direction.
  double (*number)(const StepView& view, const core::Vec3& along) = nullptr;
  /// Of a name: its place among the names of the kind; those of parts begin with the ambient space
  /// (place_of).
  std::uint32_t (*place)(const StepView& view) = nullptr;

  bool is_name() const { return kind != VariableKind::number; }
  /// True when it may be summed as the score of a tally.
  bool is_score() const { return !is_name() && !along; }
  /// Unit of a number: "mm", "ns", ...; "1" for plain numbers.
  const char* unit() const;
};
using TallyVariablePtr = std::shared_ptr<const TallyVariable>;

/// Registry of the variables that scenes may name. Constant once filled; copies share the variables.
class TallyVariables {
 public:
  /// The variables that are built in.
  TallyVariables();
  static const TallyVariables& built_in();

  /// Adds a variable. @throws InternalError when its name is empty or in use, or when it has other functions
  /// than that of its kind
  void add(TallyVariable variable);

  /// The variable of a name; null when there is none.
  TallyVariablePtr find(std::string_view name) const;
  /// The variable of an existing name. @throws InternalError when there is none
  TallyVariablePtr at(std::string_view name) const;
  /// All variables in the order of addition, built-in ones first.
  const std::vector<TallyVariablePtr>& all() const { return variables_; }
  /// Names of those that `is` accepts.
  std::vector<std::string> names(bool (*is)(const TallyVariable&)) const;

 private:
  std::vector<TallyVariablePtr> variables_;
};

}  // namespace scintray::scene_file
