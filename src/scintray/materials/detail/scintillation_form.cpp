#include <algorithm>
#include <cmath>

#include "scintray/materials/detail/forms.hpp"

namespace scintray::materials {

namespace {

constexpr double kFractionTolerance = 1e-6;

constexpr core::Word<optics::TimeProfile> kProfiles[] = {{"exponential", optics::TimeProfile::exponential},
                                                         {"delta", optics::TimeProfile::delta}};

constexpr core::Word<optics::Particle> kParticles[] = {
    {"electron", optics::Particle::electron}, {"proton", optics::Particle::proton},
    {"deuteron", optics::Particle::deuteron}, {"triton", optics::Particle::triton},
    {"alpha", optics::Particle::alpha},       {"ion", optics::Particle::ion}};

/// [birks]: quenching by the density of ionisation.
void read_birks(const config::TomlTable& table, SourceRule rule, optics::Medium& medium) {
  const std::optional<config::TomlTable> block = table.optional_table("birks");
  if (!block) return;
  read_source(*block, rule, medium.sources);
  medium.birks_mm_per_keV = block->quantity("value", core::Dimension::length_per_energy);
  block->expect("value", medium.birks_mm_per_keV > 0.0, "a Birks constant must be positive",
                "for light proportional to the energy leave [birks] out");
  if (table.has("non_proportionality"))
    table.report("birks", "Birks' law beside a response to energy: both describe the same quenching",
                 "keep [birks] or [non_proportionality]");
}

/// [[particle_light]]: the light of kinds of particles.
void read_particle_light(const config::TomlTable& table, SourceRule rule, optics::Medium& medium) {
  for (const config::TomlTable& block : table.tables("particle_light")) {
    read_source(block, rule, medium.sources);
    optics::ParticleLight light;
    light.particle = block.choice("particle", kParticles);
    light.photons = block.curve("photons", core::Dimension::dimensionless, core::Dimension::energy);
    const std::vector<double>& photons = light.photons.y();
    block.expect(
        "photons", !light.photons.is_constant() && light.photons.x().front() >= 0.0,
        "the light of a particle needs energies, but this is one value",
        "write { energy = [0, 10], energy_unit = \"MeV\", value = [0, 50000] }: the photons of a particle "
        "that stops");
    block.expect("photons", photons.front() >= 0.0 && std::is_sorted(photons.begin(), photons.end()),
                 "a particle of more energy has less light", "the numbers are from 0 on, and do not fall");
    if (const std::optional<config::TomlTable> emission = block.optional_table("emission"))
      light.emission = read_emission(*emission);
    light.decay = read_decay(block, rule, medium.sources);
    for (const optics::ParticleLight& other : medium.by_particle)
      block.expect("particle", other.particle != light.particle, "this particle has its light twice");
    medium.by_particle.push_back(std::move(light));
  }
}

}  // namespace

core::Curve read_emission(const config::TomlTable& block) {
  const core::Curve spectrum = block.curve("spectrum", core::Dimension::dimensionless);
  block.expect("spectrum", spectrum.x().front() > 0.0,
               "an emission spectrum needs wavelengths, but this is one value",
               "write { wavelength = [...], wavelength_unit = \"nm\", value = [...] }");
  block.expect("spectrum", spectrum.min_y() >= 0.0, "an emission spectrum cannot be negative");
  block.expect("spectrum", spectrum.max_y() > 0.0, "this emission spectrum is zero everywhere");
  return spectrum;
}

std::vector<optics::DecayComponent> read_decay(const config::TomlTable& table, SourceRule rule,
                                               std::vector<std::string>& sources) {
  std::vector<optics::DecayComponent> components;
  double sum = 0.0;
  const std::vector<config::TomlTable> blocks = table.tables("decay");
  for (const config::TomlTable& block : blocks) {
    read_source(block, rule, sources);
    optics::DecayComponent component;
    component.decay_ns = block.quantity("time", core::Dimension::time);
    component.rise_ns = block.quantity("rise", core::Dimension::time);
    component.fraction = block.quantity("fraction", core::Dimension::dimensionless);
    component.profile = block.choice("profile", kProfiles, optics::TimeProfile::exponential);
    if (component.profile == optics::TimeProfile::delta)
      block.expect("rise", component.rise_ns == 0.0, "a delay that is the same for all light has a rise time",
                   "write rise = \"0 ns\", or profile = \"exponential\"");
    block.expect("time", component.decay_ns > 0.0, "a decay time must be positive");
    block.expect("rise", component.rise_ns >= 0.0, "a rise time cannot be negative");
    block.expect("fraction", component.fraction > 0.0 && component.fraction <= 1.0,
                 "a fraction lies above 0 and up to 1");
    sum += component.fraction;
    components.push_back(component);
  }
  if (!components.empty() && std::abs(sum - 1.0) > kFractionTolerance)
    table.report("decay",
                 "the fractions of the decay components sum to " + std::to_string(sum) + ", not to 1",
                 "give shares of all the light");
  return components;
}

void read_scintillation(const config::TomlTable& table, SourceRule rule, optics::Medium& medium) {
  const bool any = table.has("yield") || table.has("emission") || table.has("decay");
  if (!any) {
    refuse_light_response(table);
    return;
  }
  for (const char* key : {"yield", "emission", "decay"})
    if (!table.has(key))
      table.report(key, std::string("a medium that scintillates needs \"") + key + "\" too",
                   "give [yield], [emission] and [[decay]], or none of them");
  if (const std::optional<config::TomlTable> block = table.optional_table("yield")) {
    read_source(*block, rule, medium.sources);
    medium.yield_per_keV = block->quantity("value", core::Dimension::photons_per_energy);
    block->expect("value", medium.yield_per_keV > 0.0, "a light yield must be positive",
                  "a medium that does not scintillate has no [yield], [emission] and [[decay]]");
  }
  if (const std::optional<config::TomlTable> block = table.optional_table("emission")) {
    read_source(*block, rule, medium.sources);
    medium.emission = read_emission(*block);
  }
  medium.decay = read_decay(table, rule, medium.sources);
  read_light_response(table, rule, medium);
  read_birks(table, rule, medium);
  read_particle_light(table, rule, medium);
}

}  // namespace scintray::materials
