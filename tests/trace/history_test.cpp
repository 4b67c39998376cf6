// Histories of detected photons against the photons themselves.
#include "physics/traced.hpp"
#include "scintray/tally/photon_history.hpp"

using namespace scintray;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

struct Followed {
  HistorySubjects subjects;
  PhotonHistories histories;
  std::vector<DetectedPhoton> photons;
  PointResult result;
};

Followed follow(const std::string& text, bool histories) {
  SceneSpec spec = scene_spec(text);
  spec.run.photon_list = true;
  spec.run.photon_history = histories;
  const auto point = ready(std::move(spec));
  Followed followed;
  if (point->plan().history) followed.subjects = point->plan().history->subjects();
  RunHooks hooks;
  hooks.detected = [&](const std::vector<DetectedPhoton>& photons) {
    followed.photons.insert(followed.photons.end(), photons.begin(), photons.end());
  };
  hooks.histories = [&](const PhotonHistories& block) {
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(followed.histories.event, block.event);
    append(followed.histories.photon, block.photon);
    append(followed.histories.path_mm, block.path_mm);
    append(followed.histories.absorption_depth, block.absorption_depth);
    append(followed.histories.reflections, block.reflections);
    append(followed.histories.reflection_depth, block.reflection_depth);
  };
  followed.result = point->trace(hooks);
  return followed;
}

/// A crystal and a window with a dry contact between them, both wrapped, and a sensor beyond.
const std::string kWrappedPair = R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "6 mm"]
medium = "lso_absorbing"
surface = "wrapped"
[[part.face]]
name = "end"
select = { normal = [0, 0, -1] }
surface = "flat"
[[part]]
name = "window"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
medium = "n15"
surface = "wrapped"
[[part.face]]
name = "upper"
select = { normal = [0, 0, 1] }
surface = "flat"
[[part.face]]
name = "lower"
select = { normal = [0, 0, -1] }
surface = "flat"
[[part]]
name = "detector"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "window", side = "-z" }
medium = "n15"
sensor = "perfect"
[[contact]]
between = ["crystal", "window"]
kind = "dry"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 20_000
[surfaces.wrapped]
mixture = [{ surface = "loose", share = 0.7 }, { surface = "glued", share = 0.3 }]
[surfaces.loose]
model = "smooth"
gap = 1.0
reflector = "film"
[surfaces.glued]
model = "smooth"
gap = 1.6
reflector = "film"
[reflectors.film]
reflectance = { value = 0.9 }
direction = { specular_share = 0.0 }
)";

}  // namespace

TEST_CASE("A history has the photon's path in its media, and changes nothing") {
  const Followed with = follow(kWrappedPair, true), without = follow(kWrappedPair, false);
  CHECK(with.result.fates == without.result.fates);
  CHECK(without.histories.event.empty());
  REQUIRE(with.photons.size() > 1'000);
  REQUIRE(with.histories.event.size() == with.photons.size());

  const HistorySubjects& subjects = with.subjects;
  const auto medium = [&](const std::string& name) {
    const auto known = std::find(subjects.media.begin(), subjects.media.end(), name);
    REQUIRE(known != subjects.media.end());
    return static_cast<std::size_t>(known - subjects.media.begin());
  };
  const std::size_t media = subjects.media.size(), crystal = medium("lso_absorbing"), window = medium("n15");
  CHECK(subjects.absorption_per_mm[crystal].least == doctest::Approx(1.0 / 30.0));
  REQUIRE(subjects.reflectors.size() == 2);  // one definition, whatever the medium behind it
  CHECK(subjects.reflectors[0] == ReflectorSite{"wrapped", "loose", "film"});
  CHECK(subjects.reflectors[1] == ReflectorSite{"wrapped", "glued", "film"});
  std::uint64_t reflections = 0;
  for (std::size_t i = 0; i < with.photons.size(); ++i) {
    CHECK(with.histories.event[i] == with.photons[i].event);
    CHECK(with.histories.photon[i] == with.photons[i].photon);
    double path = 0.0;
    for (std::size_t m = 0; m < media; ++m) path += with.histories.path_mm[i * media + m];
    CHECK(path == doctest::Approx(with.photons[i].path_mm).epsilon(1e-5));
    const double in_crystal = with.histories.path_mm[i * media + crystal];
    CHECK(in_crystal > 0.0);
    CHECK(with.histories.path_mm[i * media + window] > 0.0f);
    CHECK(with.histories.absorption_depth[i * media + crystal] ==
          doctest::Approx(in_crystal / 30.0).epsilon(1e-5));
    CHECK(with.histories.absorption_depth[i * media + window] == 0.0f);
    for (std::size_t r = 2 * i; r < 2 * i + 2; ++r) {
      reflections += with.histories.reflections[r];
      CHECK(with.histories.reflection_depth[r] ==
            doctest::Approx(-std::log(0.9) * with.histories.reflections[r]).epsilon(1e-5));
    }
  }
  CHECK(reflections > with.photons.size() / 10);
}

TEST_CASE("Depths are those of the wavelengths that a photon had, before and after it was shifted") {
  const Followed followed = follow(R"(
ambient = "vacuum_n1"
[[part]]
name = "plate"
box = ["5 mm", "5 mm", "5 mm"]
medium = "shifting"
surface = "flat"
[[part]]
name = "detector"
box = ["5 mm", "5 mm", "1 mm"]
place = { touch = "plate", side = "-z" }
medium = "n15"
sensor = "perfect"
[source]
type = "photons"
region = { part = "plate" }
wavelength = "400 nm"
photons = 20_000
[media.shifting]
index = { n = 1.5 }
scattering = { none = true }
[media.shifting.absorption]
coefficient = { wavelength = [350, 449, 451, 550], wavelength_unit = "nm", value = [0.2, 0.2, 0.01, 0.01], value_unit = "1/mm" }
[media.shifting.wavelength_shifting]
absorption = { coefficient = { wavelength = [350, 449, 451, 550], wavelength_unit = "nm", value = [0.5, 0.5, 0, 0], value_unit = "1/mm" } }
quantum_yield = { value = 1.0 }
emission = { spectrum = { wavelength = [499, 500, 501], wavelength_unit = "nm", value = [0, 1, 0] } }
[[media.shifting.wavelength_shifting.decay]]
time = "5 ns"
rise = "0 ns"
fraction = 1.0
)",
                                   true);
  const std::size_t media = followed.subjects.media.size();
  std::size_t column = 0;
  while (followed.subjects.media[column] != "shifting") ++column;
  CHECK(followed.subjects.absorption_per_mm[column].least == doctest::Approx(0.01));
  CHECK(followed.subjects.absorption_per_mm[column].most == doctest::Approx(0.2));
  std::size_t shifted = 0;
  REQUIRE(followed.photons.size() > 1'000);
  for (std::size_t i = 0; i < followed.photons.size(); ++i) {
    const double path = followed.histories.path_mm[i * media + column];
    const double depth = followed.histories.absorption_depth[i * media + column];
    const bool blue = followed.photons[i].wavelength_nm < 450.0f;
    shifted += blue ? 0 : 1;
    if (blue) CHECK(depth == doctest::Approx(0.2 * path).epsilon(1e-4));
    if (!blue) CHECK((depth > 0.01 * path && depth < 0.2 * path));
  }
  CHECK(shifted > followed.photons.size() / 4);
}

TEST_CASE("A reflector that transmits light is named, and its reflections are not recorded") {
  std::string text = kWrappedPair;
  const std::string value = "reflectance = { value = 0.9 }";
  text.replace(text.find(value), value.size(), value + "\ntransmittance = { value = 0.05 }");
  const Followed followed = follow(text, true);
  CHECK(followed.histories.event.size() > 1'000);
  CHECK(followed.subjects.reflectors.empty());
  CHECK(followed.histories.reflections.empty());
  CHECK(followed.subjects.transmitting == std::vector<std::string>{"wrapped", "loose", "film", "glued"});
}
