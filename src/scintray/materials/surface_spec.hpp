#pragma once
/// A surface as its definition states it: names looked up, nothing traced or built yet. Which surface
/// object it becomes depends on the media on its two sides, so it is made per interface.

#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/materials/microsurface_spec.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::materials {

struct SurfaceSpec;
/// A share of a surface's area that is another surface.
using ShareSpec = optics::AreaShare<SurfaceSpec>;

/// In its stack the reflector is looked up, with the surface's own specular share.
struct SurfaceSpec : optics::SurfaceStack {
  core::FileLocation where;  ///< of the definition
  MicrosurfaceSpec microsurface = FixedMicrosurface(optics::SmoothSurface());
  /// One of the two faces of a sheet: `reflector` is this face's share of it (optics/reflector.hpp).
  bool face_of_sheet = false;
  std::vector<ShareSpec> mixture;    ///< shares of 1; empty: the surface is one
  std::vector<std::string> sources;  ///< published sources, its own first, then its bases'
};

/// The surface, and those it is mixed of, with rays followed on height maps themselves, not by way of tables.
SurfaceSpec traced_on_the_spot(SurfaceSpec spec);

}  // namespace scintray::materials
