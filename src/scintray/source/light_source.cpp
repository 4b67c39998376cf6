#include "scintray/source/light_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scintray/core/curve.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/optics/decay_time.hpp"
#include "scintray/source/detail/emission_lanes.hpp"
#include "scintray/source/detail/origin.hpp"
#include "scintray/source/detail/photon_list_source.hpp"
#include "scintray/source/detail/scintillation_source.hpp"
#include "scintray/source/photon_optics.hpp"

namespace scintray::source {

namespace {

/// Number of photons in a block; results depend on it, so it is fixed.
constexpr std::uint64_t kBlockPhotons = 1024;

/// Photons without events of their own; each depends on its random stream only. Immutable.
class PhotonSource : public LightSource {
 public:
  /// Source of a specification in a built scene. A pattern of parts is the union of those that overlap the
  /// source's box. Throws InputError when the region is empty, when no part has that name, when the media
  /// there differ, and when they lack a requested emission or decay time.
  PhotonSource(const scene_file::SourceSpec& spec, const scene::Scene& scene);

  std::uint64_t events() const override;
  bool has_energy() const override { return false; }
  std::uint64_t blocks() const override;
  std::vector<PhotonSpan> block(std::uint64_t number) const override;
  std::uint64_t photons() const override { return photons_; }
  void begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
             EventLight& light) const override;
  Photon emit(const scene::Scene& scene, const EventLight& light, std::uint64_t photon,
              core::Rng& rng) const override;
  void emit_together(const scene::Scene& scene, const EventLight& light,
                     std::span<EmittedPhoton* const> photons, int lane_width) const override;
  std::vector<core::RegionId> regions() const override { return origin_.regions(); }

 private:
  /// The photon's place, in the state before its emission.
  void set_place(const scene::Scene& scene, Photon& photon, core::Rng& rng) const;
  /// Direction and polarisation.
  void set_ray(Photon& photon, core::Rng& rng) const;
  /// Wavelength, time, and the optics of the medium for them.
  void set_colour(const scene::Scene& scene, Photon& photon, core::Rng& rng) const;
  /// True when light is emitted in all directions alike, with any polarisation or none.
  bool is_isotropic() const {
    return direction_.kind == scene_file::DirectionKind::isotropic && !polarisation_;
  }
  void check_medium(const scene_file::SourceSpec& spec, const scene::Scene& scene);

  Origin origin_;
  scene_file::DirectionSpec direction_;
  double wavelength_nm_ = 0.0;
  std::optional<core::CurveSampler> emission_;
  double time_ns_ = 0.0;
  std::vector<optics::DecayComponent> decay_;
  bool unpolarised_ = false;
  std::optional<core::Vec3> polarisation_;
  std::uint64_t photons_ = 0, photons_per_event_ = 1;
};

/// The part of a field across a direction, of unit length; drawn where there is none.
core::Vec3 polarisation_across(const core::PlainVec3& direction, const core::Vec3& field, core::Rng& rng) {
  constexpr double kLeast = 1e-9;
  const core::Vec3 across = field - field.dot(direction.vec()) * direction.vec();
  return across.norm() > kLeast ? core::Vec3(across.normalized()) : core::sample_polarisation(direction, rng);
}

PhotonSource::PhotonSource(const scene_file::SourceSpec& spec, const scene::Scene& scene)
    : origin_(spec.origin, scene),
      direction_(spec.direction),
      unpolarised_(spec.unpolarised),
      polarisation_(spec.polarisation),
      photons_(spec.photons),
      photons_per_event_(spec.photons_per_event) {
  check_medium(spec, scene);
  const optics::Medium& medium = scene.media[scene.regions[regions().front()].medium].medium();
  if (spec.wavelength_nm)
    wavelength_nm_ = *spec.wavelength_nm;
  else
    emission_.emplace(medium.emission);
  if (spec.time_ns) {
    time_ns_ = *spec.time_ns;
  } else {
    decay_ = medium.decay;
    if (decay_.empty())
      throw core::InputError({spec.time_where, "medium \"" + medium.name + "\" has no scintillation decay",
                              "give time = \"0 ns\", or a decay in the medium's file"});
  }
}

void PhotonSource::check_medium(const scene_file::SourceSpec& spec, const scene::Scene& scene) {
  const std::vector<core::RegionId> regions = origin_.regions();
  const core::MediumId first = scene.regions[regions.front()].medium;
  for (const core::RegionId id : regions) {
    const scene::Region& region = scene.regions[id];
    if (scene.media[region.medium].is_opaque())
      throw core::InputError({spec.origin_where, "the source lies in an opaque part",
                              "put it into a medium that transmits light"});
    if (scene.media[region.medium].medium().name != scene.media[first].medium().name)
      throw core::InputError({spec.origin_where,
                              "the parts of the source have different media: \"" +
                                  scene.region_names[regions.front()] + "\" is " +
                                  scene.media[first].medium().name + " and \"" + scene.region_names[id] +
                                  "\" is " + scene.media[region.medium].medium().name,
                              "name parts of one medium; light of others is a run of its own"});
  }
}

std::uint64_t PhotonSource::events() const {
  return (photons_ + photons_per_event_ - 1) / photons_per_event_;
}

std::uint64_t PhotonSource::blocks() const { return (photons_ + kBlockPhotons - 1) / kBlockPhotons; }

std::vector<PhotonSpan> PhotonSource::block(std::uint64_t number) const {
  std::vector<PhotonSpan> spans;
  const std::uint64_t last = std::min(photons_, (number + 1) * kBlockPhotons);
  for (std::uint64_t i = number * kBlockPhotons; i < last;) {
    const std::uint64_t event = i / photons_per_event_, first = i % photons_per_event_;
    spans.push_back({event, first, std::min(photons_per_event_ - first, last - i)});
    i += spans.back().count;
  }
  return spans;
}

void PhotonSource::begin(const scene::Scene&, std::uint64_t event, core::Rng&, EventLight& light) const {
  light.photons = std::min(photons_per_event_, photons_ - std::min(photons_, event * photons_per_event_));
}

void PhotonSource::set_place(const scene::Scene& scene, Photon& photon, core::Rng& rng) const {
  const Place place = origin_.sample(scene, rng);
  photon.position = place.position;
  photon.region = place.region;
  photon.ray.keeps_phases = scene.keeps_phases;
}

void PhotonSource::set_ray(Photon& photon, core::Rng& rng) const {
  photon.ray.direction = sample_direction(direction_, rng);
  photon.ray.polarisation = polarisation_  ? polarisation_across(photon.ray.direction, *polarisation_, rng)
                            : unpolarised_ ? core::Vec3(core::Vec3::Zero())
                                           : core::sample_polarisation(photon.ray.direction, rng);
}

void PhotonSource::set_colour(const scene::Scene& scene, Photon& photon, core::Rng& rng) const {
  photon.wavelength_nm = emission_ ? emission_->sample(rng.uniform()) : wavelength_nm_;
  photon.time_ns = decay_.empty() ? time_ns_ : optics::sample_decay(decay_, rng);
  photon.optics = scene.optics.at(scene.regions[photon.region].medium, photon.wavelength_nm);
}

Photon PhotonSource::emit(const scene::Scene& scene, const EventLight&, std::uint64_t, core::Rng& rng) const {
  Photon photon;
  set_place(scene, photon, rng);
  set_ray(photon, rng);
  set_colour(scene, photon, rng);
  photon.optical_depth = core::sample_exponential(rng);
  // Light that is to have a direction or a polarisation keeps that of its ray.
  if (is_isotropic())
    emit_isotropic(scene, photon, rng);
  else
    take_mode(scene, photon, rng);
  return photon;
}

void PhotonSource::emit_together(const scene::Scene& scene, const EventLight& light,
                                 std::span<EmittedPhoton* const> photons, int lane_width) const {
  const EmissionLanes lanes(lane_width);
  if (!is_isotropic() || !lanes.take(photons.size()))
    return LightSource::emit_together(scene, light, photons, lane_width);
  for (EmittedPhoton* const emitted : photons) {
    emitted->photon = {};
    set_place(scene, emitted->photon, emitted->rng);
  }
  lanes.emit_isotropic(photons, unpolarised_);
  for (EmittedPhoton* const emitted : photons) set_colour(scene, emitted->photon, emitted->rng);
  lanes.draw_depths(photons);
  for (EmittedPhoton* const emitted : photons) emit_isotropic(scene, emitted->photon, emitted->rng);
}

/// A note on the wavelengths of Cherenkov light that the scene does not state.
std::string cherenkov_note(const scene::Scene& scene) {
  return fmt::format(
      "Cherenkov light is emitted at the wavelengths of the scintillation alone, {:g} to {:g} nm; it is not "
      "limited to these, and cherenkov_range = [\"310 nm\", \"750 nm\"] in [source] sets others",
      scene.low_nm, scene.high_nm);
}

/// A note on photons that start outside every part.
void note_outside(const PhotonSource& source, const scene_file::SceneSpec& spec, const scene::Scene& scene,
                  std::vector<std::string>& notes) {
  const std::vector<core::RegionId> regions = source.regions();
  if (std::find(regions.begin(), regions.end(), scene::kAmbientRegion) == regions.end()) return;
  notes.push_back("the photons start outside every part, in the ambient medium (" +
                  scene.media[scene.regions[scene::kAmbientRegion].medium].medium().name +
                  "), by [source] at " + spec.source.where.text() +
                  ": for light from inside a part give a position within one, or region = { part = \"" +
                  (spec.parts.empty() ? "NAME" : spec.parts.front().name.name) + "\" }");
}

}  // namespace

void LightSource::emit_together(const scene::Scene& scene, const EventLight& light,
                                std::span<EmittedPhoton* const> photons, int) const {
  for (EmittedPhoton* const emitted : photons)
    emitted->photon = emit(scene, light, emitted->number, emitted->rng);
}

std::unique_ptr<LightSource> make_light_source(const scene_file::SceneSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes) {
  if (!spec.energy_source) {
    auto photons = std::make_unique<PhotonSource>(spec.source, scene);
    if (notes) note_outside(*photons, spec, scene, *notes);
    return photons;
  }
  const scene_file::GammaSpec& source = *spec.energy_source;
  if (notes && source.cherenkov && !source.cherenkov_nm) notes->push_back(cherenkov_note(scene));
  if (const auto* list = std::get_if<scene_file::PhotonListSpec>(&source.kind)) {
    auto photons = std::make_unique<PhotonListSource>(*list, source.events, source.unpolarised, scene);
    const std::vector<std::string> said = photons->notes();
    if (notes) notes->insert(notes->end(), said.begin(), said.end());
    return photons;
  }
  try {
    return std::make_unique<ScintillationSource>(
        make_event_source(source, scene, notes), scene,
        LightOptions{source.unpolarised, source.cherenkov, source.cherenkov_nm});
  } catch (const core::InputError& error) {
    core::Problems problems;
    for (core::Problem problem : error.problems()) {
      if (problem.where.file.empty()) problem.where = source.where;
      problems.add(problem);
    }
    problems.throw_if_any();
    throw;
  }
}

}  // namespace scintray::source
