#include "scintray/scene/detail/assemble.hpp"

#include <algorithm>
#include <cmath>

namespace scintray::scene {

namespace {

/// Least length of the sum of a face's area vectors, relative to its area, with which it has a direction.
constexpr double kLeastDirection = 0.1;

/// Frame of a face without its middle: the two axes of the part that lie closest to it, in their order.
SensorFaceFrame axes_of(const FaceInfo& face, const Eigen::Matrix3d& rotation) {
  const core::Vec3 normal = rotation.transpose() * face.area_vector_mm2;
  Eigen::Index across = 0;
  normal.cwiseAbs().maxCoeff(&across);
  SensorFaceFrame frame;
  frame.x = rotation.col(across == 0 ? 1 : 0);
  frame.y = rotation.col(across == 2 ? 1 : 2);
  return frame;
}

core::Vec3 middle_of(const FaceInfo& face, const SensorFaceFrame& frame) {
  Eigen::AlignedBox3d bounds;
  const core::Vec3 z = frame.x.cross(frame.y);
  for (const core::Vec3& corner : face.corners)
    bounds.extend(core::Vec3(corner.dot(frame.x), corner.dot(frame.y), corner.dot(z)));
  const core::Vec3 middle = bounds.center();
  return middle.x() * frame.x + middle.y() * frame.y + middle.z() * z;
}

/// The face itself, or where its area vectors cancel the face of its part whose vectors have the longest sum;
/// null: every face of the part is closed.
const FaceInfo* with_direction(const Scene& scene, const FaceInfo& face) {
  const auto directed = [](const FaceInfo& f) {
    return f.triangles > 0 && f.area_vector_mm2.norm() >= kLeastDirection * f.area_mm2;
  };
  if (directed(face)) return &face;
  const FaceInfo* best = nullptr;
  for (const FaceInfo& other : scene.faces)
    if (other.part == face.part && directed(other) &&
        (!best || other.area_vector_mm2.norm() > best->area_vector_mm2.norm()))
      best = &other;
  return best;
}

/// Mean factor over a face, by the middles of equal parts of its triangles.
double mean_factor(const contact::PlacedPart& part, core::FaceId face, const detector::FaceResponse& response,
                   const SensorFaceFrame& frame) {
  const auto count = static_cast<double>(std::count(part.face.begin(), part.face.end(), face));
  const int cuts = std::clamp(static_cast<int>(256.0 / std::sqrt(count)), 1, 128);
  double sum = 0.0, all = 0.0;
  for (std::size_t t = 0; t < part.triangles.size(); ++t) {
    if (part.face[t] != face) continue;
    const auto& [a, b, c] = part.triangles[t];
    const core::Vec3 &corner = part.vertices[a], u = (part.vertices[b] - corner) / cuts,
                     v = (part.vertices[c] - corner) / cuts;
    double factors = 0.0;
    const auto add = [&](double along_u, double along_v) {
      factors += frame.factor(response, corner + along_u * u + along_v * v);
    };
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j) {
        add(i + 1.0 / 3.0, j + 1.0 / 3.0);
        if (i + j + 1 < cuts) add(i + 2.0 / 3.0, j + 2.0 / 3.0);
      }
    const double area = u.cross(v).norm();
    sum += factors * area;
    all += area * cuts * cuts;
  }
  return sum / all;
}

}  // namespace

void place_sensor_faces(const Assembly& assembly, Scene& scene, core::Problems& problems) {
  const auto varies = [](const detector::Sensor& sensor) { return sensor.over_face.has_value(); };
  if (std::none_of(assembly.sensors.begin(), assembly.sensors.end(), varies)) return;
  scene.sensor_frames.resize(scene.faces.size());
  for (const core::FaceId id : scene.faces.ids()) {
    const FaceInfo& face = scene.faces[id];
    const AssemblyPart& part = assembly.parts[face.part];
    const core::SensorId own = assembly.faces[id].sensor;
    const core::SensorId sensor = own.has_value() ? own : part.sensor;
    if (!sensor.has_value() || !varies(assembly.sensors[sensor]) || face.triangles == 0) continue;
    const FaceInfo* const directed = with_direction(scene, face);
    if (!directed) {
      problems.add(part.geometry.where,
                   "the efficiency of sensor \"" + assembly.sensors[sensor].name +
                       "\" depends on the place on its face, but \"" + face.name +
                       "\" is a closed surface, which has no middle",
                   "name the face at which light arrives by [[part.face]]");
      continue;
    }
    SensorFaceFrame frame = axes_of(*directed, part.rotation);
    frame.middle_mm = middle_of(*directed, frame);
    frame.mean_factor = mean_factor(part.geometry, id, *assembly.sensors[sensor].over_face, frame);
    scene.sensor_frames[id] = frame;
  }
}

}  // namespace scintray::scene
