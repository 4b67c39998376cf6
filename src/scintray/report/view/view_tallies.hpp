#pragma once
/// Tallies of a run as a view paints them on faces.

#include <vector>

#include "scintray/report/view/view_page.hpp"
#include "scintray/scene_file/tally.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// Largest number of bins along each direction of a grid on faces; finer grids are joined by twos, threes,
/// ...
inline constexpr std::size_t kMostViewBins = 256;

/// What a point counted on faces, per emitted photon: detected and not detected light at each sensor face;
/// tallies over an axis of faces, one for each step event with any count; tallies over two axes of position
/// that are bound to faces. Other axes are summed over. Tallies of exit angles and grids over angles are left
/// out.
/// @param specs  the tallies of the scene file, whose names are those of the results
std::vector<ViewTally> view_tallies(const tally::RunHeader& header, const tally::PointResult& point,
                                    const std::vector<scene_file::TallySpec>& specs,
                                    const std::vector<ViewPart>& parts);

}  // namespace scintray::report
