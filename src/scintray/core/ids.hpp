#pragma once
/// Ids of what a scene consists of. The objects themselves are in scene::Scene; results number them by the
/// names in tally::RunHeader.

#include "scintray/core/id.hpp"

namespace scintray::core {

using PartId = Id<struct PartTag>;
/// Over the faces of all parts.
using FaceId = Id<struct FaceTag>;
using MediumId = Id<struct MediumTag>;
using SurfaceId = Id<struct SurfaceTag>;
using SensorId = Id<struct SensorTag>;
using RegionId = Id<struct RegionTag>;
using InterfaceId = Id<struct InterfaceTag>;
using AcceleratorId = Id<struct AcceleratorTag>;

}  // namespace scintray::core
