#pragma once
/// STEP files made by Open CASCADE, as a CAD program would write them.

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace scintray::test {

enum class StepSolid { box, cylinder, sphere, drilled_box };

/// One solid. A box has one corner at `at` and the sizes a, b, c along x, y, z; a cylinder has radius a and
/// height c about the z axis through `at`; a sphere has radius a about `at`; a drilled box is a box with a
/// round hole of radius b / 4 through its middle, along z.
struct StepBody {
  std::string name;
  StepSolid solid = StepSolid::box;
  std::array<double, 3> size{1.0, 1.0, 1.0};
  std::array<double, 3> at{0.0, 0.0, 0.0};
  std::map<int, std::string> face_names;    ///< by number of the face in the solid, from 1
  std::map<int, std::string> face_colours;  ///< "#rrggbb"
  std::string colour;                       ///< of the whole solid; empty: none
};

/// Writes the bodies, their sizes being in `unit` ("MM", "INCH", "M"...), side by side in one file.
void write_step(const std::filesystem::path& path, const std::vector<StepBody>& bodies,
                const std::string& unit = "MM");

}  // namespace scintray::test
