// Wavelength shifters that re-emit several photons for one, side by side, and by Kasha's rule.
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/simulation/response_map.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

constexpr std::uint64_t kPhotons = 50'000;

/// Light of 400 nm along z in a wide slab of 2 mm between two sensors of its index, with these shifters.
std::string slab(const std::string& shifters) {
  return R"(
ambient = "vacuum_n1"
[[part]]
name = "slab"
box = { low = ["-500 mm", "-500 mm", "0 mm"], high = ["500 mm", "500 mm", "2 mm"] }
medium = "dyed"
surface = "flat"
[[part]]
name = "below"
box = { low = ["-500 mm", "-500 mm", "-1 mm"], high = ["500 mm", "500 mm", "0 mm"] }
medium = "vacuum_n1"
sensor = "perfect_n1"
[[part]]
name = "above"
box = { low = ["-500 mm", "-500 mm", "2 mm"], high = ["500 mm", "500 mm", "3 mm"] }
medium = "vacuum_n1"
sensor = "perfect_n1"
[source]
type = "photons"
position = ["0 mm", "0 mm", "1e-9 mm"]
direction = [0, 0, 1]
wavelength = "400 nm"
photons = )" +
         std::to_string(kPhotons) +
         R"(
[media.dyed]
index = { n = 1.0 }
absorption = { none = true }
scattering = { none = true }
wavelength_shifting = [)" +
         shifters + "]\n";
}

/// A dye that absorbs within `length_mm` from 390 to 410 nm alone.
std::string dye(double length_mm, const std::string& quantum_yield, const std::string& emission,
                const std::string& decay) {
  return fmt::format(
      "{{ absorption = {{ coefficient = {{ wavelength = [370, 389, 390, 410, 411, 600], wavelength_unit = "
      "\"nm\", "
      "value "
      "= [0, 0, {0}, {0}, 0, 0], value_unit = \"1/mm\" }} }}, quantum_yield = {{ {1} }}, emission = {{ {2} "
      "}}, "
      "decay = [{{ {3} }}] "
      "}}",
      1.0 / length_mm, quantum_yield, emission, decay);
}

const std::string kGreen =
    "spectrum = { wavelength = [480, 520, 560], wavelength_unit = \"nm\", value = [0, 1, 0] }";
const std::string kAtOnce = "time = \"1 ns\", rise = \"0 ns\", fraction = 1, profile = \"delta\"";

const ShiftCount& shifted_in(const Traced& traced) {
  for (const MediumId id : traced.built.scene.media.ids())
    if (traced.built.scene.media[id].medium().name == "dyed") return traced.result.shifted_in_medium[id];
  FAIL("no dyed medium");
  return traced.result.shifted_in_medium[MediumId(0)];
}

}  // namespace

TEST_CASE("Law: a Poisson number of photons is re-emitted for each, and each has its fate") {
  const std::string text = slab(dye(0.1, "value = 1.7, statistics = \"poisson\"", kGreen, kAtOnce));
  const Traced traced = trace(text, 1);
  const PointResult& result = traced.result;
  const ShiftCount& shifted = shifted_in(traced);
  CHECK(shifted.absorbed == kPhotons);  // 20 absorption lengths: one in 5e8 passes
  CHECK(result.photons == kPhotons + shifted.additional);
  CHECK(result.emitted == result.photons);
  // What is re-emitted is not absorbed again: it is detected, or the photon was kept.
  CHECK(result.count(Fate::detected) + result.count(Fate::escaped) == shifted.emitted + shifted.additional);
  CHECK(result.count(Fate::absorbed_in_medium) == kPhotons - shifted.emitted);
  check_law("photons re-emitted per photon",
            {static_cast<double>(shifted.emitted + shifted.additional) / kPhotons, std::sqrt(1.7 / kPhotons)},
            {1.7, 0.0});
  check_law("photons not re-emitted", binomial_estimate(kPhotons - shifted.emitted, kPhotons),
            {std::exp(-1.7), 0.0});
  // The same bits from three threads.
  const Traced again = trace(text, 3);
  CHECK(shifted_in(again) == shifted);
  CHECK(again.result.detected_time_ns.sum == result.detected_time_ns.sum);
  CHECK(again.result.fates == result.fates);
}

TEST_CASE("Law: two shifters share the light by their coefficients, each with its own spectrum and decay") {
  const std::string blue =
      "spectrum = { wavelength = [420, 430, 440], wavelength_unit = \"nm\", value = [0, 1, 0] }";
  const Traced traced =
      trace(slab(dye(0.1, "value = 1", kGreen, kAtOnce) + ", " +
                 dye(0.3, "value = 1", blue,
                     "time = \"50 ns\", rise = \"0 ns\", fraction = 1, profile = \"delta\"")) +
            "[run]\nphoton_list = true\n");
  simulation::RunHooks hooks;
  std::uint64_t late = 0, of_blue = 0, all = 0;
  hooks.detected = [&](const std::vector<DetectedPhoton>& photons) {
    for (const DetectedPhoton& photon : photons) {
      ++all;
      late += photon.time_ns > 49.0f ? 1 : 0;
      of_blue += photon.wavelength_nm < 450.0f ? 1 : 0;
      CHECK((photon.time_ns > 49.0f) == (photon.wavelength_nm < 450.0f));
    }
  };
  traced.point->trace(hooks);
  CHECK(all > 0.99 * kPhotons);  // the others leave between the sensors, whatever they were absorbed by
  check_law("share of the weaker", binomial_estimate(of_blue, all), {0.25, 0.0});
}

TEST_CASE("Law: by Kasha's rule the spectrum does not depend on what was absorbed") {
  // The spectrum is even from 380 to 460 nm; of the light of 400 nm 1 / 4 is re-emitted below, and of that
  // below 389 nm none is absorbed again.
  const std::string wide = "spectrum = { wavelength = [380, 460], wavelength_unit = \"nm\", value = [1, 1] }";
  const auto mean_nm = [&](const std::string& rule) {
    const Traced traced =
        trace(slab(dye(0.1, "value = 1", wide + rule, kAtOnce)) + "[run]\nphoton_list = true\n");
    Moments below;
    simulation::RunHooks hooks;
    hooks.detected = [&](const std::vector<DetectedPhoton>& photons) {
      for (const DetectedPhoton& photon : photons) below.add(photon.wavelength_nm < 395.0f ? 1.0 : 0.0);
    };
    traced.point->trace(hooks);
    return below.mean();
  };
  CHECK(mean_nm("").value == 0.0);
  const Estimate kasha = mean_nm(", rule = \"kasha\"");
  // Detected are those re-emitted outside the absorbed band of 389 to 411 nm, whose edges fall over 1 nm: 9
  // to 10 nm below and 49 to 50 nm above.
  CHECK(kasha.value > 9.0 / 59.0 - kSigmas * kasha.error);
  CHECK(kasha.value < 10.0 / 59.0 + kSigmas * kasha.error);
}

TEST_CASE("light that multiplies without end is an error, not a run without end") {
  const std::string same =
      "spectrum = { wavelength = [395, 405], wavelength_unit = \"nm\", value = [1, 1] }, rule = \"kasha\"";
  bool refused = false;
  try {
    std::string scene = slab(dye(0.1, "value = 3, statistics = \"poisson\"", same, kAtOnce));
    const std::string many = fmt::format("photons = {}", kPhotons);
    trace(scene.replace(scene.find(many), many.size(), "photons = 1"),
          1);  // one is enough, and each takes seconds
  } catch (const InputError& error) {
    refused = std::string(error.what()).find("multiplies light without end") != std::string::npos;
  }
  CHECK(refused);
}

TEST_CASE("histories of photons that may become several are refused") {
  const std::string green = dye(0.1, "value = 1.5, statistics = \"poisson\"", kGreen, kAtOnce);
  const std::string single = dye(0.1, "value = 0.9", kGreen, kAtOnce);
  const std::string history = "[run]\nphoton_history = true\nphoton_list = true\n";
  CHECK_NOTHROW(trace(slab(single) + history, 1));
  CHECK_THROWS_WITH_AS(trace(slab(green) + history, 1), doctest::Contains("several photons for one"),
                       InputError);
}
