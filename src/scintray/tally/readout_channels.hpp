#pragma once
/// Readout channels of the sensors of a scene.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/tally/per_crossing.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::tally {

/// A readout channel: a part that is a sensor, or a face that is one.
struct ReadoutChannel {
  std::string name;                          ///< "pmt", or "crystal:exit" for a face
  core::PartId part;                         ///< the sensor's
  core::SensorId sensor;                     ///< the sensor's definition
  core::FaceId face;                         ///< of a face that is a sensor
  core::Vec3 position = core::Vec3::Zero();  ///< centre of the faces through which light enters, mm
  core::Vec3 normal = core::Vec3::UnitZ();   ///< of them, into the sensor; of unit length
  core::Vec3 x = core::Vec3::UnitX(),
             y = core::Vec3::UnitY();  ///< directions across `normal`, by face_axes
  double width_mm = 0.0,
         height_mm = 0.0;  ///< of the rectangle along x and y about the centre that contains them
  double area_mm2 = 0.0;   ///< of them
};

/// The channels of a scene, in the order of its interfaces, and the channel of each crossing.
struct ReadoutChannels {
  ReadoutChannels() = default;
  explicit ReadoutChannels(const scene::Scene& scene);

  /// The channel of a detected photon.
  std::uint32_t at(const transport::Step& step) const {
    return at_crossing[step.interface][step.from_back].index();
  }

  std::vector<ReadoutChannel> list;
  PerCrossing<core::Id<ReadoutChannel>> at_crossing;  ///< in `list`; none where there is no sensor
};

}  // namespace scintray::tally
