#include "physics/traced.hpp"
#include "scintray/optics/fresnel.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

/// Two slabs in contact, a beam through both at 20 deg, and a sensor over the far side.
std::string slabs(const std::string& contact) {
  return R"(
ambient = "vacuum_n1"
[[part]]
name = "first"
box = { low = ["-50 mm", "-50 mm", "0 mm"], high = ["50 mm", "50 mm", "1 mm"] }
medium = "lso_clear"
surface = "flat"
[[part]]
name = "second"
box = { low = ["-50 mm", "-50 mm", "1 mm"], high = ["50 mm", "50 mm", "2 mm"] }
medium = "lso_clear"
surface = "flat"
[[part]]
name = "sensor"
box = { low = ["-50 mm", "-50 mm", "2 mm"], high = ["50 mm", "50 mm", "3 mm"] }
medium = "lso_clear"
sensor = "perfect"
[[contact]]
between = ["first", "second"]
kind = ")" +
         contact + R"("
[source]
type = "photons"
position = ["0 mm", "0 mm", "0.5 mm"]
direction = [0.34202014, 0, 0.93969262]
wavelength = "420 nm"
polarisation = "unpolarised"
photons = 100_000
)";
}

}  // namespace

TEST_CASE("A bonded contact of equal media transmits all light") {
  CHECK(trace(slabs("bonded")).result.count(Fate::detected) == 100'000);
}

TEST_CASE("A dry contact reflects as two surfaces with a gap of no thickness") {
  // Incoherent sum over the gap: R2 = 2 R / (1 + R); then light is reflected to and fro in `first`.
  const double r = fresnel(std::cos(20.0 * kDegree), 1.82, 1.0).unpolarised();
  const double gap = 2.0 * r / (1.0 + r);
  const double detected = (1.0 - gap) / (1.0 - gap * r);
  check_fraction(trace(slabs("dry")).result, Fate::detected, detected);
}

TEST_CASE("Identical parts share an accelerator, wherever and however turned they are") {
  std::string scene = "ambient = \"vacuum_n1\"\n";
  for (int i = 0; i < 9; ++i)
    scene += "[[part]]\nname = \"c" + std::to_string(i) +
             "\"\nbox = [\"2 mm\", \"3 mm\", \"5 mm\"]\nmedium = \"lso\"\nsurface = \"flat\"\n"
             "rotate = { axis = [1, 2, 3], angle = \"" +
             std::to_string(40 * i) +
             " deg\" }\n"
             "translate = [\"" +
             std::to_string(10 * i) + ".3 mm\", \"10 m\", \"0.1 mm\"]\n";
  scene += R"(
[source]
type = "photons"
region = { part = "c3" }
wavelength = "420 nm"
photons = 20_000
)";
  const Traced traced = trace(scene);
  CHECK(traced.built.scene.accelerators.size() == 2);
  CHECK(traced.result.count(Fate::escaped) > 0);
}

TEST_CASE("An opaque part absorbs all light that is incident on it bare") {
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "hollow"
box = ["4 mm", "4 mm", "4 mm"]
medium = "opaque"
[[part]]
name = "air"
box = { low = ["-1 mm", "-1 mm", "1 mm"], high = ["1 mm", "1 mm", "3 mm"] }
medium = "vacuum_n1"
surface = "flat"
[source]
type = "photons"
region = { part = "air" }
wavelength = "420 nm"
photons = 10_000
)");
  CHECK(traced.result.count(Fate::absorbed_in_medium) == 10'000);
}

TEST_CASE("A sensor behind opaque surfaces is an error that names it") {
  CHECK_THROWS_WITH_AS(trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "2 mm"]
medium = "lso"
surface = "white"
[[part]]
name = "eye"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "perfect"
[[contact]]
between = ["crystal", "eye"]
kind = "dry"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 10
)"),
                       doctest::Contains("no light from the source can reach sensor \"eye\""), InputError);
}

TEST_CASE("A mixture, and a layer on a smooth face, act in scenes and are not taken for a bare face") {
  // A beam leaves a box of vacuum through one face: what is lost is lost there.
  const auto box = [](const std::string& surface) {
    return R"(
ambient = "vacuum_n1"
[[part]]
name = "box"
box = ["2 mm", "2 mm", "2 mm"]
medium = "vacuum_n1"
surface = "special"
[source]
type = "photons"
position = ["0 mm", "0 mm", "1 mm"]
direction = [0, 0, 1]
wavelength = "420 nm"
photons = 100_000
[media.grey_n1]
index = { n = 1.0 }
absorption = { length = "1 mm" }
scattering = { none = true }
[surfaces.black]
model = "painted"
reflectance = 0.0
specular_share = 0.0
[surfaces.special]
)" + surface;
  };
  check_fraction(
      trace(box("mixture = [{ surface = \"black\", share = 0.3 }, { surface = \"flat\" }]\n")).result,
      Fate::absorbed_at_surface, 0.3);
  check_fraction(trace(box("model = \"smooth\"\ngap = \"grey_n1\"\ngap_thickness = \"1 mm\"\n")).result,
                 Fate::absorbed_at_surface, 1.0 - std::exp(-1.0));
}
