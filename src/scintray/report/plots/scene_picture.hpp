#pragma once
/// Three views of a scene, as SVG.

#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"
#include "scintray/report/plots/png_image.hpp"

namespace scintray::report {

struct PicturePart {
  std::string name;
  std::string medium;  ///< determines the colour
  const mesh::TriMesh* mesh = nullptr;
};

/// A mark in the picture.
struct PictureMark {
  std::string text;
  std::vector<core::Vec3> places;  ///< mm
};

/// Colour of the `index`th medium in order of appearance (Okabe and Ito 2008, without the red of the marks;
/// repeated after six).
Colour picture_colour(std::size_t index);

/// Front, side and top view in one scale: parts translucent, farther ones first, with their edges and
/// outlines; each mark a numbered red ring; and below the media and the texts of the marks.
std::string scene_svg(const std::vector<PicturePart>& parts, const std::vector<PictureMark>& marks);

}  // namespace scintray::report
