// Photons that are emitted together, in lanes: each the same, to the last bit, as emitted alone.
#include <array>
#include <string>
#include <vector>

#include "physics/traced.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/source/light_source.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::source;
using namespace scintray::test;

namespace {

/// Two boxes of LSO, a ball of it, and a crystal of two indices, with a [source].
std::string scene_emitting(const std::string& source) {
  return R"(
ambient = "air"
[[part]]
name = "box_a"
box = ["2 mm", "3 mm", "20 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "box_b"
box = ["2 mm", "1 mm", "5 mm"]
translate = ["10 mm", "0 mm", "0 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "ball"
sphere = { radius = "4 mm" }
translate = ["0 mm", "20 mm", "0 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "twofold"
box = ["2 mm", "2 mm", "2 mm"]
translate = ["0 mm", "-20 mm", "0 mm"]
medium = "uniaxial"
surface = "polished"
[media.uniaxial]
index = { n = 1.9, z = { n = 1.8 } }
absorption = { length = "300 mm" }
scattering = { none = true }
[source]
)" + source;
}

struct Emitting {
  scene::Scene scene;
  std::unique_ptr<LightSource> source;
};
Emitting emitting(const std::string& source) {
  const scene_file::SceneSpec spec =
      scene_file::SceneFile::from_text(scene_emitting(source), source_file("test.toml").string()).spec(0);
  Emitting of{scene::SceneBuilder(tables_of_this_build()).build(spec).scene, nullptr};
  of.source = make_light_source(spec, of.scene);
  return of;
}

std::string photon_keys(const std::string& keys) { return "type = \"photons\"\nphotons = 1000\n" + keys; }
/// Deposits of many photons each.
std::string energy_keys(const std::string& keys) {
  return "type = \"gamma_events\"\nevents = 3\nenergy = \"511 keV\"\nregion = { part = \"box_a\" }\n" + keys;
}

void check_same_start(const Photon& a, const Photon& b) {
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(a.position[axis] == b.position[axis]);
    CHECK(a.ray.direction[axis] == b.ray.direction[axis]);
    CHECK(a.ray.polarisation[axis] == b.ray.polarisation[axis]);
  }
  CHECK(a.region == b.region);
  CHECK(a.wavelength_nm == b.wavelength_nm);
  CHECK(a.time_ns == b.time_ns);
  CHECK(a.path_mm == b.path_mm);
  CHECK(a.optical_depth == b.optical_depth);
  CHECK(a.optics.index == b.optics.index);
  CHECK(a.optics.group_index == b.optics.group_index);
  CHECK(a.interactions == b.interactions);
}

/// Emits the photons of an event in groups of all sizes, in places that other photons had before, and with
/// streams of two seeds.
void check_together(const Emitting& of, std::uint64_t event, int lane_width) {
  const auto stream = [&](std::uint64_t i) {
    return core::Rng(7 + i / 3 % 2, core::StreamKind::photon, event, i);
  };
  EventLight light;
  core::Rng event_rng(7, core::StreamKind::event, event);
  of.source->begin(of.scene, event, event_rng, light);
  const std::uint64_t count = std::min<std::uint64_t>(light.photons, 2000);
  REQUIRE(count >= 1000);
  std::array<EmittedPhoton, 9> places;  // more than are emitted in lanes too
  std::size_t size = 1;
  for (std::uint64_t next = 0; next < count; size = size % places.size() + 1) {
    std::vector<EmittedPhoton*> group;
    for (; group.size() < size && next < count; ++next) {
      EmittedPhoton& emitted = places[group.size()];
      emitted.number = next;
      emitted.rng = stream(next);
      group.push_back(&emitted);
    }
    of.source->emit_together(of.scene, light, group, lane_width);
    for (EmittedPhoton* const emitted : group) {
      CAPTURE(emitted->number);
      core::Rng rng = stream(emitted->number);
      check_same_start(emitted->photon, of.source->emit(of.scene, light, emitted->number, rng));
      for (int i = 0; i < 9; ++i) CHECK(emitted->rng.bits() == rng.bits());
      emitted->photon.path_mm = 1.0;  // as after its way
      emitted->photon.interactions = 3;
    }
  }
}

}  // namespace

TEST_CASE("photons emitted together are those emitted one by one, to the last bit") {
  const std::vector<std::string> sources = {
      photon_keys("region = { part = \"box_a\" }\nwavelength = \"420 nm\"\ntime = \"0 ns\"\n"),
      photon_keys("region = { part = \"box_*\" }\nwavelength = \"emission\"\n"),
      photon_keys("region = { part = \"ball\" }\nwavelength = \"emission\"\n"),  // places are drawn again
      photon_keys(
          "region = { part = \"box_a\" }\nwavelength = \"emission\"\npolarisation = \"unpolarised\"\n"),
      photon_keys("region = { part = \"twofold\" }\nwavelength = \"420 nm\"\ntime = \"0 ns\"\n"),
      photon_keys("position = [\"0 mm\", \"0 mm\", \"0 mm\"]\ndirection = [0, 0, 1]\n"
                  "wavelength = \"420 nm\"\n"),
      energy_keys(""),
      energy_keys("cherenkov = true\n"),
  };
  for (const std::string& source : sources) {
    CAPTURE(source);
    const Emitting of = emitting(source);
    for (const int width : core::lane_widths()) {
      CAPTURE(width);
      for (std::uint64_t event = 0; event < std::min<std::uint64_t>(of.source->events(), 3); ++event)
        check_together(of, event, width);
    }
  }
}
