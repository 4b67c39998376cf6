#pragma once
/// A reflector that scatters by a measured BRDF.

#include <filesystem>
#include <memory>
#include <vector>

#include "scintray/optics/opaque_face.hpp"
#include "scintray/tables/mueller_table.hpp"

namespace scintray::materials {

/// The values of a file: a CSV in the columns of T. A. Germer's data of sintered PTFE (2017), with the
/// elements of the Mueller matrix where the file has them all, or Zemax' tabular BSDF, by the ending of its
/// name. InputError, at the file's lines.
std::vector<tables::BrdfPoint> read_brdf_points(const std::filesystem::path& path);

/// Reflects by a table of a BRDF; the rest is absorbed. Between two wavelengths one of the tables is drawn
/// with the weights of linear interpolation. A polarised ray is reflected by the table's Mueller matrices,
/// into a pure state drawn for the partly polarised light; without matrices it has a new polarisation.
class MeasuredBrdfSurface : public optics::OpaqueFace {
 public:
  /// @param gap_index  as of OpaqueFace
  MeasuredBrdfSurface(std::shared_ptr<const tables::MeasuredBrdf> brdf, double gap_index)
      : OpaqueFace(gap_index), brdf_(std::move(brdf)) {}

  const tables::MeasuredBrdf& brdf() const { return *brdf_; }

 protected:
  bool reflect_light(optics::Ray& ray, const core::Vec3& normal, double index,
                     optics::SurfaceInteraction& at) const override;

 private:
  std::shared_ptr<const tables::MeasuredBrdf> brdf_;
};

}  // namespace scintray::materials
