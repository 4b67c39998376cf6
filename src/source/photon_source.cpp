#include "scintray/source/photon_source.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/pattern.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray {

namespace {

/// Draws outside the part in a row after which its region counts as empty.
constexpr int kMostDraws = 1'000'000;

std::vector<std::string> names_of(const std::vector<PartInfo>& parts) {
  std::vector<std::string> names;
  for (const PartInfo& part : parts) names.push_back(part.name);
  return names;
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
    std::size_t found = 0;
    const PartInfo* last = nullptr;
    for (const PartInfo& part : scene.parts) {
      if (!matches_pattern(region->part.name, part.name)) continue;
      ++found;
      last = &part;
      add_origin(*region, part);
    }
    if (found == 0) throw unknown_name(region->part.where, "part", region->part.name, names_of(scene.parts));
    if (origins_.empty())
      throw InputError({region->where, "the source region lies outside part \"" + region->part.name + "\"",
                        "\"" + last->name + "\" extends from z = " + std::to_string(last->bounds.min().z()) +
                            " mm to " + std::to_string(last->bounds.max().z()) + " mm"});
  } else {
    const Vec3& point = std::get<Vec3>(spec.origin);
    point_ = true;
    origins_.push_back({scene.locate(point), Eigen::AlignedBox3d(point, point)});
  }
  double volume = 0.0;
  for (Origin& origin : origins_) origin.most = volume += origin.box.volume();
  for (Origin& origin : origins_) origin.most /= std::max(volume, 1e-300);
  check_medium(spec, scene);
  const Medium& medium = scene.media[scene.regions[origins_.front().region].medium].medium();
  if (spec.wavelength_nm)
    wavelength_nm_ = *spec.wavelength_nm;
  else
    emission_.emplace(medium.emission);
  if (spec.time_ns) {
    time_ns_ = *spec.time_ns;
  } else {
    decay_ = medium.decay;
    if (decay_.empty())
      throw InputError({spec.time_where, "medium \"" + medium.name + "\" has no scintillation decay",
                        "give time = \"0 ns\", or a decay in the medium's file"});
  }
  if (!point_) {  // shows now, not in the run, that positions can be found
    Rng rng(0, StreamKind::other, 0);
    Photon photon;
    sample_place(scene, rng, photon);
  }
}

void PhotonSource::add_origin(const RegionSpec& spec, const PartInfo& part) {
  Vec3 low = part.bounds.min(), high = part.bounds.max();
  if (spec.slab_z_mm) {
    low.z() = std::max(low.z(), (*spec.slab_z_mm)[0]);
    high.z() = std::min(high.z(), (*spec.slab_z_mm)[1]);
  }
  if (spec.box) {
    low = low.cwiseMax(spec.box->low);
    high = high.cwiseMin(spec.box->high);
  }
  if ((low.array() <= high.array()).all()) origins_.push_back({part.region, Eigen::AlignedBox3d(low, high)});
}

void PhotonSource::check_medium(const SourceSpec& spec, const Scene& scene) {
  const std::uint32_t first = scene.regions[origins_.front().region].medium;
  for (const Origin& origin : origins_) {
    const Region& region = scene.regions[origin.region];
    if (scene.media[region.medium].is_opaque())
      throw InputError({spec.origin_where, "the source lies in an opaque part",
                        "put it into a medium that transmits light"});
    if (region.medium != first)
      throw InputError({spec.origin_where,
                        "the parts of the source have different media: \"" +
                            scene.regions[origins_.front().region].name + "\" is " +
                            scene.media[first].medium().name + " and \"" + region.name + "\" is " +
                            scene.media[region.medium].medium().name,
                        "name parts of one medium; light of others is a run of its own"});
  }
}

std::vector<std::uint32_t> PhotonSource::regions() const {
  std::vector<std::uint32_t> regions;
  for (const Origin& origin : origins_) regions.push_back(origin.region);
  return regions;
}

const PhotonSource::Origin& PhotonSource::sample_origin(Rng& rng) const {
  if (origins_.size() == 1) return origins_.front();
  const double u = rng.uniform();
  const auto at = std::upper_bound(origins_.begin(), origins_.end(), u,
                                   [](double share, const Origin& origin) { return share < origin.most; });
  return at == origins_.end() ? origins_.back() : *at;
}

/// A box is chosen by its volume and a point in it; points outside the box's region are dropped, so
/// what is kept is uniform over the union of the regions.
void PhotonSource::sample_place(const Scene& scene, Rng& rng, Photon& photon) const {
  if (point_) {
    photon.position = origins_.front().box.min();
    photon.region = origins_.front().region;
    return;
  }
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const Origin& origin = sample_origin(rng);
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    photon.position = origin.box.min() + origin.box.sizes().cwiseProduct(Vec3(x, y, z));
    photon.region = origin.region;
    if (scene.region_contains(photon.region, photon.position)) return;
  }
  throw InputError(Problem{
      {},
      "no point of the source region lies inside \"" + scene.regions[origins_.front().region].name + "\"",
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
  sample_place(scene, rng, photon);
  photon.ray.direction = sample_direction(rng);
  photon.ray.polarisation =
      unpolarised_ ? Vec3(Vec3::Zero()) : sample_polarisation(photon.ray.direction, rng);
  photon.wavelength_nm = emission_ ? emission_->sample(rng.uniform()) : wavelength_nm_;
  photon.time_ns = decay_.empty() ? time_ns_ : sample_decay(decay_, rng);
  photon.optics = scene.media[scene.regions[photon.region].medium].at(photon.wavelength_nm);
  photon.optical_depth = sample_exponential(rng);
  return photon;
}

}  // namespace scintray
