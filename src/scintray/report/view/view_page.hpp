#pragma once
/// A scene in three dimensions: parts, faces with their surfaces, paths of photons. On a self-contained page
/// of its own, or as a section of another page.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene_file/tally.hpp"
#include "scintray/tally/photon_path.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

struct ViewFace {
  std::string name;       ///< within the part
  std::string surface;    ///< empty: smooth
  std::string sensor;     ///< empty: none
  std::string stated_at;  ///< place of the rule that sets its surface, "scene.toml:12"; empty: none
};

struct ViewPart {
  std::string name, medium;
  const mesh::TriMesh* mesh = nullptr;  ///< world, mm
  std::vector<ViewFace> faces;
  std::vector<std::uint32_t> face_of;  ///< per triangle, index into `faces`
};

/// A finding of `scintray check`, with its places.
struct ViewMark {
  std::string text;
  std::vector<core::Vec3> places;  ///< mm
};

/// Values over a grid across faces: positions along two directions.
struct ViewGrid {
  std::array<std::array<double, 3>, 2> along{};  ///< unit vectors of the axes of measurement
  std::array<double, 2> low_mm{}, high_mm{};     ///< ends of the positions along them
  std::array<std::size_t, 2> bins{};
  std::vector<double> values;  ///< per bin, the second axis fastest
};

/// Counts of a run on faces, which a view shows as colours.
struct ViewTally {
  std::string name, unit;
  /// Per face, over the parts in their order; not a number for a face without a value. Empty with a grid.
  std::vector<double> of_faces;
  std::optional<ViewGrid> grid;
  std::vector<std::uint32_t> faces;  ///< with a grid: the faces that it lies on, by the same numbers
};

struct SceneView {
  std::string title;
  std::vector<ViewPart> parts;
  std::vector<tally::PhotonPath> paths;
  std::vector<ViewMark> marks;
  std::vector<ViewTally> tallies{};
};

/// The scene of a run on its page: a view of it, or the reason why there is none, or (both empty) nothing.
struct RunView {
  std::optional<SceneView> view;
  std::string missing;  ///< one sentence
};

/// Steps of photon paths that a page holds, at most; later paths are left out, and the page has their number.
inline constexpr std::size_t kMostViewSteps = 150'000;

/// True when this build has three.js, which draws the page.
bool can_view();

/// The page. Parts of equal shape are stored once. @throws SystemError without three.js
std::string view_page(const SceneView& view);

/// The section of the page of a run, HTML; empty without a view or a reason.
std::string view_section(const RunView& view, const tally::RunResult& run);
/// CSS of the section.
std::string_view view_style();
/// Scripts that a page with a view needs after it, in their order; empty without three.js.
std::vector<std::string_view> view_scripts();

/// Largest number of bins along each direction of a grid on faces; finer grids are joined by twos, threes,
/// ...
inline constexpr std::size_t kMostViewBins = 256;

/// Counts of a point on faces, per emitted photon: detected and not detected light at each sensor face;
/// tallies over an axis of faces, one for each step event with any count; tallies over two axes of position
/// that are bound to faces. Other axes are summed over. Tallies of exit angles and grids over angles are
/// omitted.
/// @param specs  the tallies of the scene file, whose names are those of the results
std::vector<ViewTally> view_tallies(const tally::RunHeader& header, const tally::PointResult& point,
                                    const std::vector<scene_file::TallySpec>& specs,
                                    const std::vector<ViewPart>& parts);

}  // namespace scintray::report
