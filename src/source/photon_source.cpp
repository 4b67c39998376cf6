#include "scintray/source/photon_source.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/sampling.hpp"

namespace scintray {

namespace {

/// Draws outside the part in a row after which its region counts as empty.
constexpr int kMostDraws = 1'000'000;

std::uint32_t find_part(const NameRef& name, const Scene& scene) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].name == name.name) return i;
    names.push_back(scene.parts[i].name);
  }
  const std::string near = nearest_word(name.name, names);
  throw InputError({name.where, "no part is called \"" + name.name + "\"",
                    near.empty() ? "name a [[part]] of this scene" : "did you mean \"" + near + "\"?"});
}

/// A time after excitation: the rise and the decay are two exponential steps, so their sum has the
/// bi-exponential density (exp(-t/decay) - exp(-t/rise)) / (decay - rise).
double sample_decay(const std::vector<DecayComponent>& components, Rng& rng) {
  double u = rng.uniform();
  for (const DecayComponent& component : components) {
    if (u < component.fraction || &component == &components.back()) {
      double time = component.decay_ns * sample_exponential(rng);
      if (component.rise_ns > 0.0) time += component.rise_ns * sample_exponential(rng);
      return time;
    }
    u -= component.fraction;
  }
  throw InternalError("a decay without components was sampled");
}

}  // namespace

PhotonSource::PhotonSource(const SourceSpec& spec, const Scene& scene)
    : direction_(spec.direction),
      unpolarised_(spec.unpolarised),
      photons_(spec.photons),
      photons_per_event_(spec.photons_per_event) {
  if (const auto* region = std::get_if<RegionSpec>(&spec.origin)) {
    const PartInfo& part = scene.parts[find_part(region->part, scene)];
    region_ = part.region;
    bounds_ = part.bounds;
    Vec3 low = bounds_.min(), high = bounds_.max();
    if (region->slab_z_mm) {
      low.z() = std::max(low.z(), (*region->slab_z_mm)[0]);
      high.z() = std::min(high.z(), (*region->slab_z_mm)[1]);
    }
    if (region->box) {
      low = low.cwiseMax(region->box->low);
      high = high.cwiseMin(region->box->high);
    }
    bounds_ = Eigen::AlignedBox3d(low, high);
    if ((low.array() > high.array()).any())
      throw InputError({region->where, "the source region lies outside part \"" + part.name + "\"",
                        "the part extends from z = " + std::to_string(part.bounds.min().z()) + " mm to " +
                            std::to_string(part.bounds.max().z()) + " mm"});
  } else {
    const Vec3& point = std::get<Vec3>(spec.origin);
    point_ = true;
    bounds_ = Eigen::AlignedBox3d(point, point);
    region_ = scene.locate(point);
  }
  const SceneMedium& medium = scene.media[scene.regions[region_].medium];
  if (medium.is_opaque())
    throw InputError({spec.origin_where, "the source lies in an opaque part",
                      "put it into a medium that transmits light"});
  if (spec.wavelength_nm)
    wavelength_nm_ = *spec.wavelength_nm;
  else
    emission_.emplace(medium.medium().emission);
  if (spec.time_ns) {
    time_ns_ = *spec.time_ns;
  } else {
    decay_ = medium.medium().decay;
    if (decay_.empty())
      throw InputError({spec.time_where, "medium \"" + medium.medium().name + "\" has no scintillation decay",
                        "give time = \"0 ns\", or a decay in the medium's file"});
  }
  if (!point_) {  // shows now, not in the run, that positions can be found
    Rng rng(0, StreamKind::other, 0);
    sample_position(scene, rng);
  }
}

Vec3 PhotonSource::sample_position(const Scene& scene, Rng& rng) const {
  if (point_) return bounds_.min();
  const Vec3 size = bounds_.sizes();
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    const Vec3 point = bounds_.min() + size.cwiseProduct(Vec3(x, y, z));
    if (scene.region_contains(region_, point)) return point;
  }
  throw InputError(
      Problem{{},
              "no point of the source region lies inside \"" + scene.regions[region_].name + "\"",
              "check slab_z or box against the part's position (scintray check prints it)"});
}

Vec3 PhotonSource::sample_direction(Rng& rng) const {
  switch (direction_.kind) {
    case DirectionKind::isotropic:
      return sample_isotropic(rng);
    case DirectionKind::beam:
      return direction_.axis;
    case DirectionKind::lambertian:
      return sample_lambertian(direction_.axis, rng);
    case DirectionKind::cone:
      break;
  }
  const double cosine = 1.0 - rng.uniform() * (1.0 - std::cos(direction_.half_angle_rad));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double azimuth = kTwoPi * rng.uniform();
  const Frame frame = Frame::about(direction_.axis);
  return (sine * std::cos(azimuth) * frame.x + sine * std::sin(azimuth) * frame.y + cosine * frame.z)
      .normalized();
}

Photon PhotonSource::emit(const Scene& scene, Rng& rng) const {
  Photon photon;
  photon.position = sample_position(scene, rng);
  photon.ray.direction = sample_direction(rng);
  photon.ray.polarisation =
      unpolarised_ ? Vec3(Vec3::Zero()) : sample_polarisation(photon.ray.direction, rng);
  photon.wavelength_nm = emission_ ? emission_->sample(rng.uniform()) : wavelength_nm_;
  photon.time_ns = decay_.empty() ? time_ns_ : sample_decay(decay_, rng);
  photon.region = region_;
  photon.optics = scene.media[scene.regions[region_].medium].at(photon.wavelength_nm);
  photon.optical_depth = sample_exponential(rng);
  return photon;
}

}  // namespace scintray
