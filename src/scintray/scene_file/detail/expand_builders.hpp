#pragma once
/// From [[array]] and [[light_guide]] to parts.

#include "scintray/scene_file/detail/builder_spec.hpp"

namespace scintray::scene_file {

/// Elements "NAME[i,j]" (column i along x, row j along y, from 0; "NAME[k,i,j]" in layers), sheets
/// "NAME_septum_x[..]", "NAME_septum_y[..]", "NAME_wrap[-x]"..., glue "NAME_glue[k]" above layer k, and
/// fillers "NAME_filler" or "NAME_filler[k]". The lowest layer stands on z = 0; layers are centred on x =
/// y = 0 but for their offsets.
BuiltBody expand(const ArraySpec& array);

/// Segments "NAME[i,j]", the part that joins them "NAME_base" (none when the slits go through), and sheets
/// in the slits, "NAME_slit_x[..]" and "NAME_slit_y[..]". Stands on z = 0, centred on x = y = 0.
BuiltBody expand(const LightGuideSpec& guide);

}  // namespace scintray::scene_file
