// A pile of plates at Brewster's angle, which polarises light.
#include <cmath>

#include "physics/traced.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

TEST_CASE(
    "Law: a pile of m plates at Brewster's angle transmits all of p, and (1 - R) / (1 + (2 m - 1) R) of s") {
  // 2 m surfaces of reflectance R that neither absorb nor interfere: the sum over all reflections between
  // them. At Brewster's angle R of s is ((n^2 - 1) / (n^2 + 1))^2, and p is not reflected.
  constexpr double kIndex = 1.5;
  const double n2 = kIndex * kIndex, reflectance = std::pow((n2 - 1.0) / (n2 + 1.0), 2);
  const double sine = kIndex / std::sqrt(1.0 + n2), cosine = 1.0 / std::sqrt(1.0 + n2);
  for (const int plates : {1, 4, 12}) {
    std::string text = "ambient = \"vacuum_n1\"\n";
    const auto slab = [&](const std::string& name, double low, double high, const std::string& more) {
      text += fmt::format(
          "[[part]]\nname = \"{}\"\nbox = {{ low = [\"-900 mm\", \"-900 mm\", \"{} mm\"], high = [\"900 "
          "mm\", \"900 "
          "mm\", \"{} mm\"] }}\nsurface = \"flat\"\n{}\n",
          name, low, high, more);
    };
    for (int i = 0; i < plates; ++i) slab("plate" + std::to_string(i), i, i + 0.5, "medium = \"n15\"");
    slab("above", plates + 1.0, plates + 2.0, "medium = \"vacuum_n1\"\nsensor = \"perfect_n1\"");
    slab("below", -3.0, -2.0, "medium = \"vacuum_n1\"\nsensor = \"perfect_n1\"");
    const Traced traced = trace(text + fmt::format(R"(
[source]
type = "photons"
position = ["0 mm", "0 mm", "-1 mm"]
direction = [{:.17g}, 0, {:.17g}]
wavelength = "420 nm"
photons = 200_000
)",
                                                   sine, cosine));
    std::uint64_t above = 0;
    for (const SensorFaceCount& count : traced.result.sensor_faces)
      if (traced.built.scene.parts[count.part].name == "above") above += count.detected;
    const double s = (1.0 - reflectance) / (1.0 + (2.0 * plates - 1.0) * reflectance);
    check_law(fmt::format("{} plates", plates), binomial_estimate(above, traced.result.photons),
              {0.5 * (1.0 + s), 0.0});
    CHECK(traced.result.count(Fate::detected) == traced.result.photons);
  }
}
