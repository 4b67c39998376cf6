// Geant4's example OpNovice2 with wls.mac (two wavelength shifters side by side, of which the second re-emits
// three photons on average) and scint_by_particle.mac, against wls.out and scint_by_particle.out of
// Geant4 11.4 (examples/extended/optical, read).
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "io/gdml_texts.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

constexpr std::uint64_t kTheirEvents = 10'000, kOurEvents = 20'000;

/// The material "Box" of a GDML text, imported.
Medium medium_of_gdml(const GdmlText& text, const std::string& folder) {
  exchange::gdml::GdmlImport options;
  options.mesh_folder = "meshes";
  const auto file = scratch_folder(folder) / "scene.toml";
  exchange::write_scene_draft(exchange::gdml::draft_of_gdml(text.text(), "test.gdml", options), file);
  materials::MaterialDatabase database = materials::MaterialDatabase::shipped();
  scene::add_definitions(database, scene_file::SceneFile::load(file).spec(0));
  return database.medium("Box", {});
}

/// The box of wls.mac, imported from GDML with its properties.
Medium imported_box() {
  GdmlText text;
  text.define = R"(<matrix name="ABS" coldim="2" values="2*eV 1 5*eV 2 8*eV 3"/>
<matrix name="RAY" coldim="2" values="2*eV 1 8*eV 1"/><matrix name="N" coldim="2" values="2*eV 1.3 8*eV 1.4"/>
<matrix name="A1" coldim="2" values="5*eV 100000 6*eV 0.06 7*eV 0.08 8*eV 0.09 9*eV 100000"/>
<matrix name="C1" coldim="2" values="3*eV 0.1 4*eV 0.4 5*eV 0.7 6*eV 0.6 7*eV 0.1"/>
<matrix name="A2" coldim="2" values="2*eV 100000 3*eV 0.36 4*eV 0.18 5*eV 0.09 6*eV 10000"/>
<matrix name="C2" coldim="2" values="2*eV 0.1 3*eV 0.8 4*eV 0.9 5*eV 0.1"/>
<matrix name="N1" coldim="1" values="1"/><matrix name="N2" coldim="1" values="3"/>
<matrix name="T1" coldim="1" values="1"/><matrix name="T2" coldim="1" values="2"/>)";
  text.materials = R"(<material name="Box"><property name="RINDEX" ref="N"/>
<property name="ABSLENGTH" ref="ABS"/><property name="RAYLEIGH" ref="RAY"/>
<property name="WLSABSLENGTH" ref="A1"/><property name="WLSCOMPONENT" ref="C1"/>
<property name="WLSABSLENGTH2" ref="A2"/><property name="WLSCOMPONENT2" ref="C2"/>
<property name="WLSMEANNUMBERPHOTONS" ref="N1"/><property name="WLSMEANNUMBERPHOTONS2" ref="N2"/>
<property name="WLSTIMECONSTANT" ref="T1"/><property name="WLSTIMECONSTANT2" ref="T2"/></material>)";
  text.solids = R"(<box name="b" x="20" y="20" z="20"/>)";
  text.structure = gdml_volume("inner", "b", "Box");
  text.daughters = gdml_placed("inner_p", "inner");
  return medium_of_gdml(text, "opnovice2_wls");
}

/// A sum over entries, event by event: the mean of all entries has the error of independent events.
class ClusteredMean {
 public:
  void add(double value) {
    ++entries_;
    sum_ += value;
  }
  void end_event() {
    events_.push_back({static_cast<double>(entries_), sum_});
    entries_ = 0;
    sum_ = 0.0;
  }
  /// Mean over entries, with the error of so many events.
  Estimate mean(std::uint64_t of_events) const { return ratio(1, 0, of_events); }
  /// Entries per event.
  Estimate rate(std::uint64_t of_events) const {
    Moments counts;
    for (const auto& event : events_) counts.add(event[0]);
    const Estimate all = counts.mean();
    return {all.value, all.error * scale(of_events)};
  }

 private:
  double scale(std::uint64_t of_events) const {
    return std::sqrt(static_cast<double>(events_.size()) / static_cast<double>(of_events));
  }
  Estimate ratio(std::size_t over, std::size_t under, std::uint64_t of_events) const {
    double a = 0.0, b = 0.0, spread = 0.0;
    for (const auto& event : events_) {
      a += event[over];
      b += event[under];
    }
    for (const auto& event : events_) spread += std::pow(event[over] - a / b * event[under], 2);
    return {a / b, std::sqrt(spread) / b * scale(of_events)};
  }

  std::vector<std::array<double, 2>> events_;
  std::uint64_t entries_ = 0;
  double sum_ = 0.0;
};

struct Light {
  double wavelength_nm = 0.0, time_ns = 0.0;
};

/// What OpNovice2 fills for one of its shifters.
struct ShifterRecord {
  ClusteredMean absorbed_eV, emitted_eV, emitted_ns;
};

}  // namespace

TEST_CASE("OpNovice2 wls: two shifters, of which one re-emits three photons, agree with Geant4's output") {
  Medium box = imported_box();
  REQUIRE(box.shifter);
  REQUIRE(box.shifter->fluorophores().size() == 2);
  std::vector<Fluorophore> dyes = box.shifter->fluorophores();
  dyes[1].decay.front().profile = TimeProfile::exponential;  // /process/optical/wls2/setTimeProfile
  const WavelengthShifter shifter(dyes);

  std::array<ShifterRecord, 2> records;
  ClusteredMean absorbed;
  for (std::uint64_t event = 0; event < kOurEvents; ++event) {
    Rng rng(41, StreamKind::other, event);
    // The box is 2 m wide and lengths are of millimetres: no light reaches its faces.
    std::vector<Light> waiting{{1239.841984 / 7.0, 0.0}};
    while (!waiting.empty()) {
      Light light = waiting.back();
      waiting.pop_back();
      const MediumOptics at = box.at(light.wavelength_nm);
      const double path_mm = sample_exponential(rng) / at.absorption_per_mm;  // scattering does not end it
      light.time_ns += path_mm * at.group_index / 299.792458;
      if (rng.uniform() * at.absorption_per_mm >= shifter.absorption_per_mm()(light.wavelength_nm)) {
        absorbed.add(1.0);
        continue;
      }
      const std::size_t dye = shifter.pick(light.wavelength_nm, rng);
      ShifterRecord& record = records[dye];
      record.absorbed_eV.add(photon_energy_eV(light.wavelength_nm));
      ShiftCount count;
      std::vector<ShiftedLight> emitted;
      const auto first = shifter.absorb_by(dye, light.wavelength_nm, rng, count, &emitted);
      if (first) emitted.push_back(*first);
      CHECK(count.emitted + count.additional == emitted.size());
      for (const ShiftedLight& again : emitted) {
        waiting.push_back({again.wavelength_nm, light.time_ns + again.delay_ns});
        record.emitted_eV.add(photon_energy_eV(again.wavelength_nm));
        if (waiting.back().time_ns < (dye == 0 ? 10.0 : 50.0))  // the histograms' ranges
          record.emitted_ns.add(waiting.back().time_ns);
      }
    }
    for (ShifterRecord& record : records)
      for (ClusteredMean* mean : {&record.absorbed_eV, &record.emitted_eV, &record.emitted_ns})
        mean->end_event();
    absorbed.end_event();
  }

  const auto compare = [&](const char* what, double theirs, double rounding, const auto& ours) {
    const Estimate own = ours(kOurEvents), g4{theirs, std::hypot(ours(kTheirEvents).error, rounding)};
    CAPTURE(what);
    CAPTURE(own.value);
    CAPTURE(g4.value);
    CAPTURE(g4.error);
    evidence("opnovice2_wls",
             {what, fmt::format("{:.4f} ± {:.4f}", g4.value, g4.error),
              fmt::format("{:.4f} ± {:.4f}", own.value, own.error), fmt::format("{:.2f}", sigmas(g4, own))});
    CHECK(sigmas(g4, own) < kSigmas);
  };
  const auto mean_of = [](const ClusteredMean& mean) {
    return [&mean](std::uint64_t events) { return mean.mean(events); };
  };
  const auto rate_of = [](const ClusteredMean& mean) {
    return [&mean](std::uint64_t events) { return mean.rate(events); };
  };
  // Numbers per event are printed with two digits: the standard deviation of that rounding is unit /
  // sqrt(12).
  const double tenth = 0.1 / std::sqrt(12.0), one = 1.0 / std::sqrt(12.0);
  compare("WLS: energy absorbed, eV", 6.91158, 0.0, mean_of(records[0].absorbed_eV));
  compare("WLS: energy re-emitted, eV", 5.085, 0.0, mean_of(records[0].emitted_eV));
  compare("WLS: time of re-emission, ns", 1.19352, 0.0, mean_of(records[0].emitted_ns));
  compare("WLS2: energy absorbed, eV", 3.44691, 0.0, mean_of(records[1].absorbed_eV));
  compare("WLS2: energy re-emitted, eV", 2.79598, 0.0, mean_of(records[1].emitted_eV));
  compare("WLS2: time of re-emission, ns", 8.43487, 0.0, mean_of(records[1].emitted_ns));
  compare("WLS: absorbed per event", 1.2, tenth, rate_of(records[0].absorbed_eV));
  compare("WLS: re-emitted per event", 1.2, tenth, rate_of(records[0].emitted_eV));
  compare("WLS2: absorbed per event", 4.1, tenth, rate_of(records[1].absorbed_eV));
  compare("WLS2: re-emitted per event", 12.0, one, rate_of(records[1].emitted_eV));
  compare("absorbed for good per event", 9.1305, 0.0, rate_of(absorbed));
}

TEST_CASE("OpNovice2 scint_by_particle: number, spectrum and time of the light of each particle agree") {
  // scint_by_particle.mac, without its rise times, which it turns off (setFiniteRiseTime false). The electron
  // of its first run is left out: its light is below that of one that stops, since energy leaves the box
  // again.
  GdmlText text;
  text.define = R"(<matrix name="ABS" coldim="2" values="2*eV 1 5*eV 2 8*eV 3"/>
<matrix name="N" coldim="2" values="2*eV 1.3 8*eV 1.4"/>
<matrix name="C1" coldim="2" values="2*eV 1.0 5*eV 1.1 8*eV 1.3"/>
<matrix name="C2" coldim="2" values="2*eV 0.8 5*eV 0.6 8*eV 0.3"/>
<matrix name="LE" coldim="2" values="0 5000 10 500000"/><matrix name="L" coldim="2" values="0 50 10 5000"/>
<matrix name="LA" coldim="2" values="0 50 10 50000"/>
)";
  text.materials =
      R"(<material name="Box"><property name="RINDEX" ref="N"/><property name="ABSLENGTH" ref="ABS"/>
<property name="SCINTILLATIONCOMPONENT1" ref="C1"/><property name="SCINTILLATIONCOMPONENT2" ref="C2"/>
<property name="ELECTRONSCINTILLATIONYIELD" ref="LE"/><property name="PROTONSCINTILLATIONYIELD" ref="L"/>
<property name="DEUTERONSCINTILLATIONYIELD" ref="L"/><property name="ALPHASCINTILLATIONYIELD" ref="LA"/>
<property name="IONSCINTILLATIONYIELD" ref="L"/>
)";
  const auto constant = [&](const std::string& name, double value) {
    text.define += fmt::format("<matrix name=\"{}\" coldim=\"1\" values=\"{:g}\"/>\n", name, value);
    text.materials += fmt::format("<property name=\"{0}\" ref=\"{0}\"/>\n", name);
  };
  constant("SCINTILLATIONTIMECONSTANT1", 20);
  constant("SCINTILLATIONTIMECONSTANT2", 200);
  const auto particle = [&](const std::string& name, const std::vector<double>& yields,
                            const std::vector<double>& times_ns) {
    for (std::size_t i = 0; i < yields.size(); ++i)
      constant(fmt::format("{}SCINTILLATIONYIELD{}", name, i + 1), yields[i]);
    for (std::size_t i = 0; i < times_ns.size(); ++i)
      constant(fmt::format("{}SCINTILLATIONTIMECONSTANT{}", name, i + 1), times_ns[i]);
  };
  particle("PROTON", {0.3, 0.5, 0.2}, {50, 200, 500});
  particle("DEUTERON", {0.6, 0.4}, {});
  particle("ALPHA", {0.7, 0.3}, {30, 60});
  particle("ION", {1.0, 0.0}, {20, 100});
  particle("ELECTRON", {0.5, 0.5}, {50, 500});
  text.materials += "</material>";
  text.solids = R"(<box name="b" x="20" y="20" z="20"/>)";
  text.structure = gdml_volume("inner", "b", "Box");
  text.daughters = gdml_placed("inner_p", "inner");
  const Medium box = medium_of_gdml(text, "opnovice2_particles");
  REQUIRE(box.by_particle.size() == 5);

  struct Output {
    Particle particle;
    const char* name;
    double photons, rounding, mean_eV, rms_eV, mean_ns, rms_ns;
  };
  constexpr double kEvents = 100.0, kRange_ns = 200.0;
  for (const Output& g4 :
       {Output{Particle::proton, "proton", 490, 10, 4.81367, 1.72501, 68.5317, 54.0187},
        Output{Particle::alpha, "alpha", 5000, 100, 4.97429, 1.73177, 36.4284, 36.1714},
        Output{Particle::deuteron, "deuteron", 490, 10, 4.92083, 1.73346, 38.9036, 45.6316},
        Output{Particle::ion, "C12", 500, 10, 5.09787, 1.73358, 19.9906, 19.9611}}) {
    CAPTURE(g4.name);
    const auto light =
        std::find_if(box.by_particle.begin(), box.by_particle.end(),
                     [&](const ParticleLight& known) { return known.particle == g4.particle; });
    REQUIRE(light != box.by_particle.end());
    REQUIRE(light->emission.has_value());
    const CurveSampler spectrum(*light->emission);
    Moments energy_eV, time_ns;
    std::uint64_t in_range = 0;
    for (std::uint64_t i = 0; i < 200'000; ++i) {
      Rng rng(43, StreamKind::other, i);
      energy_eV.add(photon_energy_eV(spectrum.sample(rng.uniform())));
      const double delay_ns = sample_decay(light->decay, rng);
      if (delay_ns >= kRange_ns) continue;
      time_ns.add(delay_ns);
      ++in_range;
    }
    // A particle of 1 MeV stops: L(1 MeV) - L(0).
    const double photons = light->photons(1000.0) - light->photons(0.0);
    const auto compare = [&](const std::string& what, const Estimate& theirs, const Estimate& own) {
      CAPTURE(what);
      CAPTURE(theirs.value);
      CAPTURE(own.value);
      evidence(
          "opnovice2_particles",
          {std::string(g4.name) + ": " + what, fmt::format("{:.4f} ± {:.4f}", theirs.value, theirs.error),
           fmt::format("{:.4f} ± {:.4f}", own.value, own.error), fmt::format("{:.2f}", sigmas(theirs, own))});
      CHECK(sigmas(theirs, own) < kSigmas);
    };
    const double counted = kEvents * photons, share = static_cast<double>(in_range) / 200'000.0;
    compare("photons", {g4.photons, std::hypot(g4.rounding / std::sqrt(12.0), std::sqrt(photons / kEvents))},
            {photons, 0.0});
    compare("energy, eV", {g4.mean_eV, g4.rms_eV / std::sqrt(counted)}, energy_eV.mean());
    compare("time, ns", {g4.mean_ns, g4.rms_ns / std::sqrt(counted * share)}, time_ns.mean());
  }
}
