#include "scintray/tally/readout_channels.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scintray/core/face_axes.hpp"

namespace scintray::tally {

namespace {

/// Area through which light can enter each channel: the area in contact with parts, and without contact the
/// whole area.
class ChannelFaces {
 public:
  ChannelFaces(ReadoutChannels& channels, const scene::Scene& scene)
      : channels_(channels),
        scene_(scene),
        ambient_(&scene.regions[scene::kAmbientRegion]),
        in_contact_(channels.list.size(), false),
        moments_(channels.list.size(), core::Vec3::Zero()),
        vectors_(moments_) {
    for (const scene::Region& region : scene.regions)
      if (&region != ambient_)
        for_each_triangle(region,
                          [&](std::size_t at, const scene::BoundaryTriangle&) { in_contact_[at] = true; });
  }

  void add(const scene::Region& region) {
    for_each_triangle(region, [&](std::size_t at, const scene::BoundaryTriangle& t) {
      const core::Vec3 twice = (t[1] - t[0]).cross(t[2] - t[0]);
      const double area = 0.5 * twice.norm();
      channels_.list[at].area_mm2 += area;
      moments_[at] += area * (t[0] + t[1] + t[2]) / 3.0;
      vectors_[at] += 0.5 * twice;
    });
  }

  void place() {
    for (std::size_t i = 0; i < channels_.list.size(); ++i) {
      ReadoutChannel& channel = channels_.list[i];
      if (channel.area_mm2 > 0.0) channel.position = moments_[i] / channel.area_mm2;
      // Light incident from all sides has no mean direction: the normal stays z.
      if (vectors_[i].norm() > 1e-6 * channel.area_mm2) channel.normal = vectors_[i].normalized();
      const std::array<core::Vec3, 2> across = core::face_axes(channel.normal);
      channel.x = across[0];
      channel.y = across[1];
    }
  }

  /// The rectangle about the centre that contains the faces.
  void measure(const scene::Region& region) {
    for_each_triangle(region, [&](std::size_t at, const scene::BoundaryTriangle& t) {
      ReadoutChannel& channel = channels_.list[at];
      for (const core::Vec3& corner : t) {
        const core::Vec3 from = corner - channel.position;
        channel.width_mm = std::max(channel.width_mm, 2.0 * std::abs(from.dot(channel.x)));
        channel.height_mm = std::max(channel.height_mm, 2.0 * std::abs(from.dot(channel.y)));
      }
    });
  }

 private:
  /// Calls visit(channel, triangle in the world) for the triangles that lead to sensors.
  template <typename Visit>
  void for_each_triangle(const scene::Region& region, const Visit& visit) const {
    const auto triangles = static_cast<std::uint32_t>(scene_.accelerator(region).size());
    for (std::uint32_t i = 0; i < triangles; ++i) {
      const scene::BoundaryLink& link = scene_.link(region, i);
      const core::Id<ReadoutChannel> channel = channels_.at_crossing[link.interface][link.from_back];
      if (!channel.has_value() || (&region == ambient_ && in_contact_[channel.index()])) continue;
      // A photocathode on a face has light from beyond too, which adds no area.
      const ReadoutChannel& own = channels_.list[channel.index()];
      if (own.face.has_value() && region.part != own.part) continue;
      visit(std::size_t{channel.index()}, scene_.triangle(region, i));
    }
  }

  ReadoutChannels& channels_;
  const scene::Scene& scene_;
  const scene::Region* ambient_;
  std::vector<bool> in_contact_;
  std::vector<core::Vec3> moments_, vectors_;
};

}  // namespace

ReadoutChannels::ReadoutChannels(const scene::Scene& scene) : at_crossing(scene.interfaces.size()) {
  std::map<std::pair<core::PartId, core::FaceId>, core::Id<ReadoutChannel>> known;
  for (const core::InterfaceId id : scene.interfaces.ids()) {
    const scene::Interface& interface = scene.interfaces[id];
    for (const bool from_back : {false, true}) {
      const core::SensorId sensor = from_back ? interface.front_sensor : interface.back_sensor;
      if (!sensor.has_value()) continue;
      const core::PartId part = from_back ? interface.front_sensor_part : interface.back_sensor_part;
      const bool whole = scene.parts[part].sensor.has_value();
      const core::FaceId face = whole ? core::FaceId::none() : scene.sensor_face(interface, part);
      const auto [channel, is_new] = known.try_emplace({part, face}, core::Id<ReadoutChannel>(list.size()));
      if (is_new) {
        list.push_back({});
        list.back().name = whole ? scene.parts[part].name : scene.faces[face].name;
        list.back().part = part;
        list.back().sensor = sensor;
        list.back().face = face;
      }
      at_crossing[id][from_back] = channel->second;
    }
  }
  ChannelFaces faces(*this, scene);
  for (const scene::Region& region : scene.regions) faces.add(region);
  faces.place();
  for (const scene::Region& region : scene.regions) faces.measure(region);
}

}  // namespace scintray::tally
