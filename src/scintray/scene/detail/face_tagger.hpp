#pragma once
/// Face tags of placed parts.

#include <string>
#include <vector>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// What one part's faces touch, among all placed parts.
class TouchingFaces {
 public:
  /// The part is that of number `own`.
  TouchingFaces(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& parts,
                std::size_t own)
      : spec_(spec), parts_(parts), own_(own) {}

  /// Mask of the part's triangles in faces that touch a part of the selection: whole smooth regions, each
  /// within one group of the mesh.
  /// @throws InputError at the selection for names of no part, and where no face touches one
  [[nodiscard]] std::vector<char> mask(const scene_file::FaceSelectorSpec& select) const;

 private:
  std::vector<char> touching(std::size_t other) const;
  std::string touched_parts() const;
  double tolerance_of_contact(const std::string& other) const;

  const scene_file::SceneSpec& spec_;
  const std::vector<contact::PlacedMesh>& parts_;
  std::size_t own_;
};

/// Assigns every triangle of a part to a face by the part's rules.
class FaceTagger {
 public:
  /// @param touching  required when a rule names a part that is touched
  FaceTagger(const scene_file::PartSpec& part, contact::PlacedMesh& placed, core::Problems& problems,
             const TouchingFaces* touching = nullptr);

  /// Fills the part's faces and the face of each triangle. Adds to the problems: faces that two rules match,
  /// rules that match nothing, faces without a surface.
  void tag();

 private:
  std::size_t first_unmatched() const;
  std::vector<char> selected(const scene_file::FaceSelectorSpec& select) const;
  void add_side(const scene_file::FaceRuleSpec& side);
  void apply(const scene_file::FaceRuleSpec& spec);
  void expect_surface_of_rest();

  const scene_file::PartSpec& part_;
  contact::PlacedMesh& placed_;
  core::Problems& problems_;
  const TouchingFaces* touching_;
  std::vector<std::uint32_t> rule_of_;
};

}  // namespace scintray::scene
