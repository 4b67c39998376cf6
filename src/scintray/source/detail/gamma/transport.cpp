#include "scintray/source/detail/gamma/transport.hpp"

#include <limits>
#include <map>

#include "scintray/core/pattern.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/text.hpp"
#include "scintray/scene/accelerator.hpp"
#include "scintray/source/detail/scintillation.hpp"

namespace scintray::source {

namespace {

/// Number of steps of one gamma beyond which the geometry is faulty.
constexpr int kMostSteps = 1'000'000;

/// The last specification that names the region, or nullptr.
const scene_file::MatterSpec* matter_named(const std::vector<scene_file::MatterSpec>& matter,
                                           const scene::Scene& scene, core::RegionId region) {
  const core::PartId part = scene.regions[region].part;
  const std::string& name = part.has_value() ? scene.parts[part].name : scene_file::kAmbientName;
  const scene_file::MatterSpec* found = nullptr;
  for (const scene_file::MatterSpec& one : matter)
    if (core::matches_pattern(one.part.name, name)) found = &one;
  return found;
}

}  // namespace

/// State shared by all gammas of an event.
struct GammaTransport::Walk {
  const scene::Scene& scene;
  core::Rng& rng;
  Event& event;
  std::vector<Gamma> waiting;

  void leave(const Gamma& at, double energy_keV) {
    leave_energy(scene, {at.position, at.region, energy_keV, at.time_ns}, event);
  }
};

namespace {

/// Names of parts by their pattern.
using PartGroups = std::map<std::string, std::vector<std::string>>;

/// One name or pattern for each group.
std::vector<std::string> patterns_of(const PartGroups& groups) {
  std::vector<std::string> patterns;
  for (const auto& [pattern, names] : groups) patterns.push_back(names.size() > 1 ? pattern : names.front());
  return patterns;
}

/// "\"guide\", 64 parts \"crystal[*]\"".
std::string parts_text(const PartGroups& groups) {
  std::string text;
  for (const auto& [pattern, names] : groups)
    text += (text.empty() ? "" : ", ") + (names.size() > 1
                                              ? std::to_string(names.size()) + " parts \"" + pattern + "\""
                                              : "\"" + names.front() + "\"");
  return text;
}

}  // namespace

GammaTransport::GammaTransport(const scene::Scene& scene, const std::vector<scene_file::MatterSpec>& matter,
                               bool fluorescence, const core::FileLocation& where)
    : fluorescence_(fluorescence) {
  std::map<core::MediumId, std::shared_ptr<const GammaMatter>> by_medium;
  std::map<const scene_file::MatterSpec*, std::shared_ptr<const GammaMatter>> by_spec;
  // Media, with the parts that consist of each: parts of one pattern once, with their number.
  std::map<core::MediumId, PartGroups> unknown;
  for (const core::RegionId region : scene.regions.ids()) {
    matter_.push_back(nullptr);
    if (const scene_file::MatterSpec* named = matter_named(matter, scene, region)) {
      if (named->composition.empty()) continue;
      std::shared_ptr<const GammaMatter>& known = by_spec[named];
      if (!known) known = std::make_shared<GammaMatter>(named->composition, named->density_g_per_cm3);
      matter_.back() = known;
      continue;
    }
    const core::MediumId id = scene.regions[region].medium;
    const optics::Medium& medium = scene.media[id].medium();
    if (medium.empty_space) continue;
    if (medium.composition.empty()) {
      const std::string& name = scene.region_names[region];
      unknown[id][core::pattern_of(name)].push_back(name);
      continue;
    }
    std::shared_ptr<const GammaMatter>& known = by_medium[id];
    if (!known) known = std::make_shared<GammaMatter>(medium.composition, medium.density_g_per_cm3);
    matter_.back() = known;
  }
  core::Problems problems;
  for (const auto& [medium, parts] : unknown)
    problems.add(where,
                 "gammas come through the medium \"" + scene.media[medium].medium().name + "\" of " +
                     parts_text(parts) + ", but it does not say what it is made of",
                 "add [composition] and [density] to the medium, or to [source] either [[source.matter]] "
                 "with part, formula and density, or, for parts that gammas are to pass, vacuum = [" +
                     core::list_of(patterns_of(parts), ", ",
                                   [](const std::string& name) { return "\"" + name + "\""; }) +
                     "]; a * stands for any characters");
  problems.throw_if_any();
}

GammaTransport::GammaTransport(const scene::Scene& scene, const std::vector<core::RegionId>& regions) {
  matter_.resize(scene.regions.size());
  std::map<core::MediumId, std::shared_ptr<const GammaMatter>> by_medium;
  for (const core::RegionId region : regions) {
    const core::MediumId id = scene.regions[region].medium;
    const optics::Medium& medium = scene.media[id].medium();
    if (medium.composition.empty()) throw core::InternalError("gammas in matter that is not known");
    std::shared_ptr<const GammaMatter>& known = by_medium[id];
    if (!known) known = std::make_shared<GammaMatter>(medium.composition, medium.density_g_per_cm3);
    matter_[region] = known;
  }
}

void GammaTransport::absorb_all(const scene::Scene& scene, const Gamma& gamma, core::Rng& rng,
                                Event& event) const {
  Walk walk{scene, rng, event, {gamma}};
  while (!walk.waiting.empty()) {
    Gamma next = walk.waiting.back();
    walk.waiting.pop_back();
    bool goes_on = true;
    while (goes_on && next.energy_keV >= scene_file::kLowestGamma_keV) goes_on = interact(walk, next);
    if (goes_on) walk.leave(next, next.energy_keV);
  }
}

void GammaTransport::follow(const scene::Scene& scene, std::vector<Gamma> gammas, core::Rng& rng,
                            Event& event) const {
  Walk walk{scene, rng, event, std::move(gammas)};
  while (!walk.waiting.empty()) {
    const Gamma next = walk.waiting.back();
    walk.waiting.pop_back();
    follow_one(walk, next);
  }
}

void GammaTransport::follow_one(Walk& walk, Gamma gamma) const {
  for (int step = 0; step < kMostSteps; ++step) {
    if (gamma.energy_keV < scene_file::kLowestGamma_keV) {
      walk.leave(gamma, gamma.energy_keV);
      return;
    }
    const scene::Region& region = walk.scene.regions[gamma.region];
    const scene::Exit exit = walk.scene.find_exit(region, gamma.position, gamma.direction);
    if (exit.triangle == scene::kNoTriangle) {
      walk.event.escaped_keV += gamma.energy_keV;
      return;
    }
    const GammaMatter* const matter = matter_[gamma.region].get();
    const double free_mm = matter
                               ? core::sample_exponential(walk.rng) / matter->total_per_mm(gamma.energy_keV)
                               : std::numeric_limits<double>::infinity();
    const bool leaves = exit.distance_mm <= free_mm;
    const double distance_mm = leaves ? exit.distance_mm : free_mm;
    gamma.position += distance_mm * gamma.direction;
    gamma.time_ns += distance_mm / core::kSpeedOfLight_mm_per_ns;
    if (leaves) {
      const scene::BoundaryLink link = walk.scene.link(region, exit.triangle);
      const scene::Interface& interface = walk.scene.interfaces[link.interface];
      gamma.region = link.from_back ? interface.front : interface.back;
    } else if (!interact(walk, gamma)) {
      return;
    }
  }
  throw core::InternalError("a gamma goes to and fro in \"" + walk.scene.region_names[gamma.region] + "\"");
}

/// Interaction of the gamma at its position. False when the gamma is absorbed.
bool GammaTransport::interact(Walk& walk, Gamma& gamma) const {
  const GammaEncounter encounter = matter_[gamma.region]->sample(gamma.energy_keV, walk.rng);
  switch (encounter.process) {
    case GammaProcess::photoelectric:
      absorb(walk, gamma, *encounter.element);
      return false;
    case GammaProcess::pair:
      make_pair(walk, gamma);
      return false;
    case GammaProcess::rayleigh:
      gamma.direction =
          core::turned(gamma.direction, encounter.element->sample_rayleigh_cosine(gamma.energy_keV, walk.rng),
                       core::kTwoPi * walk.rng.uniform());
      return true;
    case GammaProcess::compton:
      break;
  }
  const ComptonScattering scattering = sample_compton(*encounter.element, gamma.energy_keV, walk.rng);
  walk.leave(gamma, gamma.energy_keV - scattering.energy_keV);
  gamma.energy_keV = scattering.energy_keV;
  gamma.direction = core::turned(gamma.direction, scattering.cosine, core::kTwoPi * walk.rng.uniform());
  return true;
}

/// The photoelectron has the gamma's energy less the binding energy of the K shell, with the share of that
/// shell in the absorptions, else all of it (other shells bind with a few keV; light atoms' K shells do too).
/// What the K X-ray does not take of the binding energy is a deposit of its own, of Auger electrons and soft
/// X-rays.
void GammaTransport::absorb(Walk& walk, const Gamma& gamma, const ElementData& element) const {
  const KShell& k = element.k_shell();
  if (k.lines.empty() || gamma.energy_keV <= k.edge_keV ||
      k.lines.back().energy_keV < scene_file::kLowestGamma_keV) {
    walk.leave(gamma, gamma.energy_keV);
    return;
  }
  const double shell = walk.rng.uniform();  // below share * yield: an X-ray; below share: Auger electrons
  const double electron_keV = gamma.energy_keV - (shell < k.share ? k.edge_keV : 0.0);
  double atom_keV = gamma.energy_keV - electron_keV;
  if (fluorescence_ && shell < k.share * k.yield) {
    const double u = walk.rng.uniform();
    std::size_t line = 0;
    while (line + 1 < k.lines.size() && u >= k.lines[line].most) ++line;
    Gamma xray = gamma;
    xray.energy_keV = k.lines[line].energy_keV;
    xray.direction = core::sample_isotropic(walk.rng);
    walk.waiting.push_back(xray);
    atom_keV -= xray.energy_keV;
  }
  walk.leave(gamma, electron_keV);
  walk.leave(gamma, atom_keV);
}

void GammaTransport::make_pair(Walk& walk, const Gamma& gamma) const {
  Gamma annihilation = gamma;
  annihilation.energy_keV = core::kElectronMass_keV;
  annihilation.direction = core::sample_isotropic(walk.rng);
  walk.waiting.push_back(annihilation);
  annihilation.direction = -annihilation.direction;
  walk.waiting.push_back(annihilation);
  // Of electron and positron; that all shares of the energy are equally likely is assumed.
  const double both_keV = gamma.energy_keV - 2.0 * core::kElectronMass_keV;
  const double electron_keV = both_keV * walk.rng.uniform();
  walk.leave(gamma, electron_keV);
  walk.leave(gamma, both_keV - electron_keV);
}

}  // namespace scintray::source
