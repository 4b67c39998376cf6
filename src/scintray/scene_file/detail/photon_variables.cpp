#include "scintray/scene_file/tally_variable.hpp"

namespace scintray::scene_file {

namespace {

using core::Dimension;
using core::Vec3;

}  // namespace

void add_photon_variables(TallyVariables& variables) {
  variables.add({.name = "wavelength",
                 .dimension = Dimension::wavelength,
                 .number = [](const StepView& view, const Vec3&) { return view.wavelength_nm; }});
  variables.add({.name = "time",
                 .dimension = Dimension::time,
                 .number = [](const StepView& view, const Vec3&) { return view.time_ns; }});
  variables.add({.name = "path",
                 .dimension = Dimension::length,
                 .number = [](const StepView& view, const Vec3&) { return view.path_mm; }});
  variables.add({.name = "interactions", .number = [](const StepView& view, const Vec3&) {
                   return static_cast<double>(view.interactions);
                 }});
  variables.add({.name = "scatterings", .number = [](const StepView& view, const Vec3&) {
                   return static_cast<double>(view.scatterings);
                 }});
  variables.add({.name = "crossings", .number = [](const StepView& view, const Vec3&) {
                   return static_cast<double>(view.crossings);
                 }});
  variables.add({.name = "position",
                 .dimension = Dimension::length,
                 .along = true,
                 .spans_face = true,
                 .number = [](const StepView& view, const Vec3& along) { return along.dot(view.position); }});
  variables.add({.name = "start",
                 .dimension = Dimension::length,
                 .along = true,
                 .number = [](const StepView& view, const Vec3& along) { return along.dot(view.start); }});
  variables.add(
      {.name = "direction",
       .low = -1.0,
       .high = 1.0,
       .along = true,
       .number = [](const StepView& view, const Vec3& along) { return along.dot(view.direction); }});
}

}  // namespace scintray::scene_file
