#pragma once
/// Specification of a surface: names are looked up, nothing is traced or built. The surface itself depends on
/// the media on its two sides, and is therefore made per interface.

#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/materials/microsurface_spec.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::materials {

struct SurfaceSpec;
/// A share of a surface's area that is another surface.
using ShareSpec = optics::AreaShare<SurfaceSpec>;

/// Specification of a surface. The reflector of its stack is looked up, with the surface's own specular
/// share.
struct SurfaceSpec : optics::SurfaceStack {
  core::FileLocation where;  ///< of the definition
  MicrosurfaceSpec microsurface = FixedMicrosurface(optics::SmoothSurface(), "smooth");
  /// One of the two faces of a sheet: `reflector` is this face's share of it (optics/reflector.hpp).
  bool face_of_sheet = false;
  /// Without effect, smooth, between two parts of one medium, as Geant4's polished and ground finishes.
  bool between_media_only = false;
  std::vector<ShareSpec> mixture;    ///< shares with a sum of 1; empty: not a mixture
  std::vector<std::string> sources;  ///< published sources, its own first, then its bases'
};

/// The surface, and the shares of its mixture, with rays traced on the height maps instead of tables.
SurfaceSpec traced_on_the_spot(SurfaceSpec spec);

}  // namespace scintray::materials
