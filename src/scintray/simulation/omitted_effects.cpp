#include <fmt/format.h>

#include <algorithm>

#include "scintray/detector/microcells.hpp"
#include "scintray/scene/facet_faces.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::simulation {

namespace {

using tally::OmittedEffect;

/// The figures that an effect would change.
enum class Figures { resolution, timing, both, fraction };

OmittedEffect effect(const std::string& name, const std::string& subject, Figures figures,
                     const std::string& remedy) {
  return {name,
          subject,
          remedy,
          figures == Figures::resolution || figures == Figures::both,
          figures == Figures::timing || figures == Figures::both,
          figures == Figures::fraction};
}

std::string in_medium(const std::string& block, const std::string& medium) {
  return block + " in the definition of the medium \"" + medium + "\"";
}

std::string in_sensor(const std::string& block, const std::string& sensor) {
  return block + " in a sensor with base = \"" + sensor + "\"";
}

void add_medium(const optics::Medium& medium, std::vector<OmittedEffect>& effects) {
  if (!(medium.intrinsic_fwhm > 0.0))
    effects.push_back(effect("intrinsic resolution", medium.name, Figures::resolution,
                             in_medium("[intrinsic_resolution]", medium.name)));
  if (medium.relative_yield.is_constant())
    effects.push_back(effect("non-proportionality", medium.name, Figures::resolution,
                             in_medium("[non_proportionality]", medium.name)));
  const bool rises = std::any_of(medium.decay.begin(), medium.decay.end(),
                                 [](const optics::DecayComponent& part) { return part.rise_ns > 0.0; });
  if (!rises)
    effects.push_back(effect("rise time of the light", medium.name, Figures::timing,
                             in_medium("[[decay]] rise", medium.name)));
}

/// Effects of the avalanches of a sensor, which appear behind a readout only.
void add_response(const detector::Sensor& sensor, std::vector<OmittedEffect>& effects) {
  const auto add = [&](const char* name, Figures figures, const char* block) {
    effects.push_back(effect(name, sensor.name, figures, in_sensor(block, sensor.name)));
  };
  if (!(sensor.time_spread_ns > 0.0)) add("time spread of single photons", Figures::timing, "[transit_time]");
  if (!(sensor.single_electron.charge_spread > 0.0))
    add("charge spread", Figures::both, "[single_electron] charge_spread");
  if (!(sensor.dark_counts.per_ns > 0.0) && !(sensor.dark_counts.per_ns_mm2 > 0.0))
    add("dark counts", Figures::both, "[dark_counts]");
  const auto* cells = sensor.avalanches.get_if<detector::MicrocellModel>();
  const bool proportional = sensor.avalanches.get_if<detector::ProportionalModel>() != nullptr;
  if (proportional) add("saturation, if it is a SiPM", Figures::resolution, "[microcells]");
  if (proportional || (cells && !(cells->cells.crosstalk > 0.0)))
    add(proportional ? "crosstalk, if it is a SiPM" : "crosstalk", Figures::both, "[microcells] crosstalk");
  if (proportional || (cells && !(cells->cells.afterpulse > 0.0)))
    add(proportional ? "afterpulses, if it is a SiPM" : "afterpulses", Figures::both,
        "[microcells] afterpulse");
}

/// Effects on the share of the light that a sensor detects.
void add_detection(const detector::Sensor& sensor, std::vector<OmittedEffect>& effects) {
  if (sensor.efficiency.min_y() >= 1.0) return;  // nothing is left to be reflected
  if (sensor.cathode) return;                    // its film reflects, and converts by the angle
  effects.push_back(effect("reflection behind the sensor's window, back into the detector", sensor.name,
                           Figures::fraction, ""));
  if (!sensor.angle)
    effects.push_back(effect("dependence of the efficiency on angle", sensor.name, Figures::fraction,
                             in_sensor("[angle]", sensor.name)));
}

void add_electronics(const std::optional<detector::ReadoutSpec>& readout,
                     std::vector<OmittedEffect>& effects) {
  if (!readout)
    effects.push_back(
        effect("electronics and response of the sensors (time and charge spread, crosstalk, "
               "afterpulses, dark counts, noise, pick-off)",
               "", Figures::both, "[readout]"));
  else if (!(readout->noise > 0.0))
    effects.push_back(effect("electronic noise", "", Figures::both, "[readout] noise"));
}

/// Birefringent media, in which the two waves of one photon do not interfere (optics/birefringence.hpp).
void add_birefringence(const scene::Scene& scene, std::vector<OmittedEffect>& effects) {
  std::vector<std::string> names;
  for (const scene::SceneMedium& scene_medium : scene.media) {
    const optics::Medium& medium = scene_medium.medium();
    if (!medium.birefringence || std::find(names.begin(), names.end(), medium.name) != names.end()) continue;
    names.push_back(medium.name);
    effects.push_back(effect("interference of the two waves of a birefringent medium, as in wave plates",
                             medium.name, Figures::fraction, ""));
  }
}

/// Round faces whose triangles are traced: how many, how far the steepest is from its surface, and what light
/// may escape through them.
void add_facets(const scene::BuiltScene& built, std::vector<OmittedEffect>& effects) {
  struct Faces {
    std::size_t count = 0;
    double angle_rad = 0.0, let_out = 0.0;

    std::string text() const {
      const std::string faces = fmt::format("{} face{}, facets up to {:.2g} deg from it", count,
                                            count == 1 ? "" : "s", angle_rad / core::kDegree);
      if (!(let_out > 0.0)) return faces;
      return faces +
             fmt::format(", which may let out up to {:.2g} % of the light of a part", 100.0 * let_out);
    }
  };
  Faces known, unknown;
  for (const scene::FacetFace& face : scene::facet_faces(built)) {
    Faces& faces = face.surface_known ? known : unknown;
    ++faces.count;
    faces.angle_rad = std::max(faces.angle_rad, face.deviation.angle_rad);
    faces.let_out = std::max(faces.let_out, face.let_out);
  }
  if (known.count > 0)
    effects.push_back(effect("the true surface of round faces", known.text(), Figures::fraction,
                             "scintray check lists them with the reason why facets stay"));
  if (unknown.count > 0)
    effects.push_back(effect(
        "the true surface of smooth faces of meshes", unknown.text(), Figures::fraction,
        "curved = \"recognize\" of a mesh of triangles, where they are spheres, cylinders, cones or tori"));
}

}  // namespace

std::vector<tally::OmittedEffect> SimulationPoint::omitted() const {
  std::vector<OmittedEffect> effects;
  std::vector<core::SensorId> sensors;
  for (const tally::ReadoutChannel& channel : plan_.channels.list)
    if (std::find(sensors.begin(), sensors.end(), channel.sensor) == sensors.end())
      sensors.push_back(channel.sensor);
  if (source_->has_energy()) {
    std::vector<core::MediumId> media;
    // The light of a list of photons was made elsewhere.
    const bool listed = std::holds_alternative<scene_file::PhotonListSpec>(spec_.energy_source->kind);
    for (const core::RegionId region : listed ? std::vector<core::RegionId>{} : source_->regions()) {
      const core::MediumId medium = scene().regions[region].medium;
      if (std::find(media.begin(), media.end(), medium) != media.end()) continue;
      media.push_back(medium);
      add_medium(scene().media[medium].medium(), effects);
    }
    if (!sensors.empty()) add_electronics(spec_.readout, effects);
    if (spec_.readout)
      for (const core::SensorId sensor : sensors) add_response(scene().sensors[sensor], effects);
  }
  add_birefringence(scene(), effects);
  for (const core::SensorId sensor : sensors) add_detection(scene().sensors[sensor], effects);
  add_facets(*built_, effects);
  return effects;
}

}  // namespace scintray::simulation
