#pragma once
/// The choice of ray query, as [run] accelerator in a scene file.

namespace scintray::scene_file {

/// Which algorithm answers ray queries.
enum class AcceleratorKind {
  automatic,  ///< planes where they apply, else Embree
  embree,     ///< Embree's bounding volume hierarchy, single rays, corrected in double precision
  planes,     ///< the nearest plane ahead, for closed regions: all must be convex with few planes
};

}  // namespace scintray::scene_file
