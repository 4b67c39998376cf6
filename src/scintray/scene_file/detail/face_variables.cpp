#include <algorithm>
#include <cmath>

#include "scintray/core/face_axes.hpp"
#include "scintray/scene_file/tally_variable.hpp"

namespace scintray::scene_file {

namespace {

using core::Vec3;

double angle(double cosine) { return std::acos(std::min(1.0, std::abs(cosine))); }

/// Sine squared of an angle: equal bins of it have equal projected solid angles.
double sine_squared(double cosine) { return std::max(0.0, 1.0 - cosine * cosine); }

/// Azimuth (rad) about the normal, from the first of the face's axes.
double azimuth(const Vec3& direction, const Vec3& normal) {
  const auto [x, y] = core::face_axes(normal);
  return std::atan2(direction.dot(y), direction.dot(x));
}

TallyVariable of_side(const char* name, FaceSide side) {
  TallyVariable variable;
  variable.name = name;
  variable.at_face = true;
  variable.side = side;
  return variable;
}

TallyVariable angle_of(const char* name, FaceSide side) {
  TallyVariable variable = of_side(name, side);
  variable.dimension = core::Dimension::angle;
  variable.low = 0.0;
  variable.high = 0.5 * core::kPi;
  return variable;
}

TallyVariable sine_squared_of(const char* name, FaceSide side) {
  TallyVariable variable = of_side(name, side);
  variable.low = 0.0;
  variable.high = 1.0;
  return variable;
}

TallyVariable azimuth_of(const char* name, FaceSide side) {
  TallyVariable variable = of_side(name, side);
  variable.dimension = core::Dimension::angle;
  variable.low = -core::kPi;
  variable.high = core::kPi;
  return variable;
}

}  // namespace

void add_face_variables(TallyVariables& variables) {
  TallyVariable before = angle_of("angle_before", FaceSide::before);
  before.number = [](const StepView& view, const Vec3&) { return angle(view.cos_before); };
  variables.add(before);
  TallyVariable after = angle_of("angle_after", FaceSide::after);
  after.number = [](const StepView& view, const Vec3&) { return angle(view.direction.dot(view.normal)); };
  variables.add(after);

  before = sine_squared_of("sin2_before", FaceSide::before);
  before.number = [](const StepView& view, const Vec3&) { return sine_squared(view.cos_before); };
  variables.add(before);
  after = sine_squared_of("sin2_after", FaceSide::after);
  after.number = [](const StepView& view, const Vec3&) {
    return sine_squared(view.direction.dot(view.normal));
  };
  variables.add(after);

  before = azimuth_of("azimuth_before", FaceSide::before);
  before.direction_before = true;
  before.number = [](const StepView& view, const Vec3&) {
    return azimuth(view.direction_before, view.normal);
  };
  variables.add(before);
  after = azimuth_of("azimuth_after", FaceSide::after);
  after.number = [](const StepView& view, const Vec3&) { return azimuth(view.direction, view.normal); };
  variables.add(after);
}

}  // namespace scintray::scene_file
