#pragma once
/// The variables of tallies that are built in, by file.

#include "scintray/scene_file/tally_variable.hpp"

namespace scintray::scene_file {

void add_photon_variables(TallyVariables& variables);
void add_face_variables(TallyVariables& variables);
void add_name_variables(TallyVariables& variables);

}  // namespace scintray::scene_file
