#include "scintray/scene_file/tally_variable.hpp"

namespace scintray::scene_file {

void add_name_variables(TallyVariables& variables) {
  variables.add({.name = "part", .kind = VariableKind::part, .place = [](const StepView& view) {
                   return place_of(view.part);
                 }});
  variables.add({.name = "source_part", .kind = VariableKind::source_part, .place = [](const StepView& view) {
                   return place_of(view.source_part);
                 }});
  variables.add(
      {.name = "face", .kind = VariableKind::face, .at_face = true, .place = [](const StepView& view) {
         return view.face.index();
       }});
  variables.add({.name = "occasion", .kind = VariableKind::event, .place = [](const StepView& view) {
                   return static_cast<std::uint32_t>(view.event);
                 }});
}

}  // namespace scintray::scene_file
