#pragma once
/// Lists of points x y z. Internal to the readers.

#include "scintray/topography/detail/readers/raw_map.hpp"

namespace scintray::topography {

/// True for a matrix of numbers with three columns and at least four rows: no height map is as
/// narrow.
bool is_xyz_list(const RawMap& matrix);

/// The height map whose points the list gives, in any order; points of the grid that it lacks are
/// NaN. x and y have no unit, so only the ratio of the pitches is known. InputError unless the
/// points lie, within 1 % of its step, on a regular grid of which they fill at least half.
/// @param values x y z, x y z, ...
RawMap grid_of_xyz(const std::vector<double>& values, const std::string& file);

}  // namespace scintray::topography
