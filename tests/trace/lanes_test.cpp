#include "crystal_on_sensor.hpp"
#include "io/tabulated.hpp"
#include "physics/traced.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/transport/batch.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// The crystal in dry contact with one of the same medium, whose surface ends in a reflector.
std::string beside_a_wrapped_one(const std::string& surface) {
  return crystal(surface, R"(
[[part]]
name = "other"
box = ["2 mm", "3 mm", "20 mm"]
place = { touch = "crystal", side = "+x" }
medium = "LSO_roncali2013"
surface = "polished_lambertian_097"
[[contact]]
between = ["crystal", "other"]
kind = "dry"
)");
}

/// The crystal in a block of glass; its medium is birefringent, and the glass beside it is not.
std::string birefringent_crystal(const std::string& surface) {
  return R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "3 mm", "20 mm"]
medium = "spar"
surface = ")" +
         surface + R"("
principal_axes = { z = [1, 2, 3], x = [3, 0, -1] }
[[part]]
name = "slab"
box = ["2 mm", "3 mm", "2 mm"]
place = { touch = "crystal", side = "+z" }
medium = "glass"
surface = ")" +
         surface + "\"\n" + sensor_and_source("2 mm") +
         R"([media.spar]
index = { n = 1.66, y = { n = 1.6 }, z = { n = 1.49 } }
absorption = { length = "200 mm" }
scattering = { length = "100 mm", kind = "rayleigh" }
)";
}

/// Five faces, of which no two are parallel, and two that are.
std::string prism(const std::string& surface, const std::string& sensor_side, const std::string& more = "") {
  return R"(
ambient = "vacuum"
[[part]]
name = "crystal"
prism = { sides = 5, radius = "1.8 mm", height = "8 mm" }
medium = "LSO_roncali2013"
surface = ")" +
         surface + "\"\n" + sensor_and_source(sensor_side) + more;
}

/// A polished crystal with round walls, exact, on a sensor of the whole face.
std::string round_crystal(const std::string& shape, const std::string& side, const std::string& more = "") {
  return R"(
ambient = "vacuum"
[[part]]
name = "crystal"
medium = "LSO_roncali2013"
surface = "polished"
)" + shape +
         "\n" + sensor_and_source(side) + more;
}
const char* const kThinRod = R"(cylinder = { radius = "1 mm", height = "20 mm", segments = 24 })";

/// Facets of UNIFIED, weighted by area, in a scene of crystal().
std::string by_area(const std::string& sigma_alpha) {
  return R"([surfaces.rough]
model = "unified"
[surfaces.rough.unified]
sigma_alpha = ")" +
         sigma_alpha + R"("
definition = "solid_angle"
facets = "projected_area"
lobe = 1.0
)";
}
const char* const kBacked = R"([surfaces.backed]
base = "roncali2013_unified_rough"
gap = "air"
reflector = "ESR"
)";
const char* const kEmission = R"([source]
type = "photons"
region = { part = "crystal[*]" }
wavelength = "emission"
photons = 3_000
)";

const char* const kTableBacked = R"([surfaces.backed]
base = "lso_ground_30um_420nm"
gap = "air"
reflector = "ESR"
)";

/// A table between two wavelengths, in a scene of crystal().
std::string two_wavelengths() {
  static const auto file = [] {
    const optics::SurfaceTable rough = tabulated(18.0 * kDegree), smoother = tabulated(8.0 * kDegree);
    const auto slice = [](const optics::SurfaceTable& of, double wavelength_nm) {
      return optics::TableSlice{wavelength_nm,
                                0.0,
                                of.index_pair(),
                                of.nodes(optics::Side::inside),
                                of.nodes(optics::Side::outside),
                                nullptr};
    };
    const auto path = scratch_folder("lanes_table") / "two.h5";
    optics::write_table(path, optics::SurfaceTable({slice(rough, 400.0), slice(smoother, 450.0)},
                                                   optics::AzimuthKind::folded, {}));
    return path;
  }();
  return crystal("two", "[surfaces.two]\nmodel = \"table\"\ntable = { file = \"" + file.string() + "\" }\n");
}

/// The wavelengths of the crystal's emission in place of one.
std::string with_emission(const std::string& scene) {
  return replaced(scene, "wavelength = \"420 nm\"", "wavelength = \"emission\"");
}

/// A crystal of a medium with dispersion, three kinds of faces, and the wavelengths of its emission.
std::string three_surfaces() {
  const std::string faces = R"([[part.face]]
name = "top"
select = { normal = [0, 0, 1] }
surface = "paint"
[[part.face]]
name = "side"
select = { normal = [1, 0, 0] }
surface = "two"
)";
  std::string scene = with_emission(replaced(two_wavelengths(), "LSO_roncali2013", "LSO"));
  scene = replaced(scene, "surface = \"two\"", "surface = \"backed\"");
  return replaced(scene, "[[part.face]]\n", faces + "[[part.face]]\n") + kBacked + kPaint;
}

/// Light along the normal of two faces with a table, where there is no plane of incidence.
std::string along_the_normal(const std::string& surface, const std::string& more) {
  return replaced(crystal(surface, more), "photons = 3_000\n", "photons = 3_000\ndirection = [1, 0, 0]\n");
}

/// Bare crystals that share their light, and one that is turned.
std::string array(const std::string& source, const std::string& surface = "polished") {
  return R"(
ambient = "vacuum"
[[array]]
name = "crystal"
count = [3, 2]
gap = "0.1 mm"
[array.element]
box = ["2 mm", "2 mm", "10 mm"]
medium = "LSO"
surface = ")" +
         surface + R"("
[[part]]
name = "turned"
box = ["3 mm", "2 mm", "4 mm"]
rotate = { axis = [0.3, 0.5, 1.0], angle = "25 deg" }
translate = ["0 mm", "9 mm", "0 mm"]
medium = "LSO"
surface = "polished"
[[array]]
name = "sipm"
count = [3, 2]
gap = "0.1 mm"
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "optical_grease" }
[array.element]
box = ["2 mm", "2 mm", "0.3 mm"]
sensor = "ideal"
)" + source;
}

}  // namespace

TEST_CASE("Results and photons are the same to the last bit for every width of the lanes") {
  std::string scene;
  SUBCASE("polished") { scene = crystal("polished"); }
  SUBCASE("facets") { scene = crystal("roncali2013_unified_rough"); }
  SUBCASE("facets weighted by area") { scene = crystal("rough", by_area("12 deg")); }
  SUBCASE("wide facets weighted by area") { scene = crystal("rough", by_area("25 deg")); }
  SUBCASE("facets, a gap and a reflector") { scene = crystal("backed", kBacked); }
  SUBCASE("paint, in part specular") { scene = crystal("paint", kPaint); }
  SUBCASE("polished, a gap and a Lambertian reflector") { scene = crystal("polished_lambertian_097"); }
  SUBCASE("polished, a gap and a reflector, cut by interactions") {
    scene = crystal("polished_lambertian_097", "[run]\nmax_interactions = 12\n");
  }
  SUBCASE("polished, a gap and a reflector, cut by time") {
    scene = crystal("polished_lambertian_097", "[run]\nmax_time = \"0.3 ns\"\n");
  }
  SUBCASE("polished, in dry contact with a wrapped one") { scene = beside_a_wrapped_one("polished"); }
  SUBCASE("rough, in dry contact with a wrapped one") {
    scene = beside_a_wrapped_one("roncali2013_unified_rough");
  }
  SUBCASE("unpolarised") { scene = crystal("roncali2013_unified_rough", "polarisation = \"unpolarised\"\n"); }
  SUBCASE("birefringent") { scene = birefringent_crystal("polished"); }
  SUBCASE("birefringent, facets") { scene = birefringent_crystal("roncali2013_unified_rough"); }
  SUBCASE("rough prism") { scene = prism("roncali2013_unified_rough", "6 mm"); }
  SUBCASE("polished prism") { scene = prism("polished", "6 mm"); }
  SUBCASE("polished prism, its end over two regions, cut by interactions") {
    scene = prism("polished", "1 mm", "[run]\nmax_interactions = 9\n");
  }
  SUBCASE("polished prism, cut by time") {
    scene = prism("polished", "6 mm", "[run]\nmax_time = \"0.3 ns\"\n");
  }
  SUBCASE("rough, cut by interactions") {
    scene = crystal("backed", std::string(kBacked) + "[run]\nmax_interactions = 7\n");
  }
  SUBCASE("rough, cut by time") {
    scene = crystal("backed", std::string(kBacked) + "[run]\nmax_time = \"0.3 ns\"\n");
  }
  SUBCASE("table") { scene = crystal("lso_ground_30um_420nm"); }
  SUBCASE("table, unpolarised") {
    scene = crystal("lso_ground_30um_420nm", "polarisation = \"unpolarised\"\n");
  }
  SUBCASE("table, a gap and a reflector") { scene = crystal("backed", kTableBacked); }
  SUBCASE("table of a stack, which absorbs") { scene = crystal("lso_ground_30um_esr_air_420nm"); }
  SUBCASE("table of two wavelengths") {
    scene = replaced(two_wavelengths(), "wavelength = \"420 nm\"", "wavelength = \"430 nm\"");
  }
  SUBCASE("table of two wavelengths, beyond the last") {
    scene = replaced(two_wavelengths(), "wavelength = \"420 nm\"", "wavelength = \"470 nm\"");
  }
  SUBCASE("table of two wavelengths, between and beyond them") { scene = with_emission(two_wavelengths()); }
  SUBCASE("facets, a gap and a reflector, wavelengths of the emission") {
    scene = with_emission(crystal("backed", kBacked));
  }
  SUBCASE("facets, paint and a table, wavelengths of the emission") { scene = three_surfaces(); }
  SUBCASE("table, along its normal") { scene = along_the_normal("backed", kTableBacked); }
  SUBCASE("through Embree") { scene = crystal("polished", "[run]\naccelerator = \"embree\"\n"); }
  SUBCASE("rod") { scene = round_crystal(kThinRod, "6 mm"); }
  SUBCASE("rod, its end over two regions") { scene = round_crystal(kThinRod, "1 mm"); }
  SUBCASE("rod, unpolarised") { scene = round_crystal(kThinRod, "6 mm", "polarisation = \"unpolarised\"\n"); }
  SUBCASE("rod, cut by interactions") {
    scene = round_crystal(kThinRod, "6 mm", "[run]\nmax_interactions = 7\n");
  }
  SUBCASE("rod, cut by time") { scene = round_crystal(kThinRod, "6 mm", "[run]\nmax_time = \"0.3 ns\"\n"); }
  SUBCASE("cone, far from the origin") {
    scene = round_crystal(R"(cone = { bottom_radius = "2 mm", top_radius = "0.5 mm", height = "9 mm" }
translate = ["3000 mm", "-2000 mm", "1000 mm"])",
                          "6 mm");
  }
  SUBCASE("lens") {
    scene = round_crystal(
        R"(lens = { diameter = "6 mm", thickness = "4 mm", bottom_radius = "8 mm", top_radius = "20 mm" })",
        "6 mm");
  }
  SUBCASE("sphere") { scene = round_crystal(R"(sphere = { radius = "2 mm", subdivisions = 6 })", "6 mm"); }
  SUBCASE("turned rod") {
    scene =
        round_crystal(std::string(kThinRod) + "\nrotate = { axis = [1, 1, 0], angle = \"90 deg\" }", "6 mm");
  }
  SUBCASE("elliptical polarisation") {
    scene = crystal("polished", "[run]\npolarisation = \"elliptical\"\n");
  }
  SUBCASE("facets, elliptical polarisation") {
    scene = crystal("roncali2013_unified_rough", "[run]\npolarisation = \"elliptical\"\n");
  }
  SUBCASE("height map on the spot") {
    scene = crystal("spot", R"([surfaces.spot]
base = "lso_ground_30um"
tracing = { mode = "on_the_spot" }
)");
  }
  SUBCASE("shares of the area") {
    scene = crystal("in_parts", std::string(kBacked) + R"([surfaces.in_parts]
mixture = [{ surface = "backed", share = 0.4 }, { surface = "polished", share = 0.6 }]
)");
  }
  SUBCASE("thin film") {
    scene = crystal("coated", R"([surfaces.coated]
model = "thin_film"
thin_film = { layers = [{ index = 1.38, thickness = "99.6 nm" }] }
)");
  }
  SUBCASE("cut by interactions") { scene = crystal("polished", "[run]\nmax_interactions = 20\n"); }
  SUBCASE("cut by time") { scene = crystal("polished", "[run]\nmax_time = \"0.3 ns\"\n"); }
  SUBCASE("array with the spectrum of its light") { scene = array(kEmission); }
  SUBCASE("wrapped array with the spectrum of its light") {
    scene = replaced(array(kEmission, "polished_lambertian_097"), "\n[[part]]\nname = \"turned\"", R"(
[[array.element.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"
[[part]]
name = "turned")");
  }
  SUBCASE("rough array with the spectrum of its light") {
    scene = array(kEmission, "roncali2013_unified_rough");
  }
  SUBCASE("events of energy") {
    scene = array(R"([source]
type = "gammas"
events = 3
emission = "gamma"
energy = "60 keV"
plane = { center = ["0 mm", "0 mm", "30 mm"], x = ["6 mm", "0 mm", "0 mm"], y = ["0 mm", "4 mm", "0 mm"] }
direction = [0, 0, -1]
vacuum = ["sipm[*]"]
)");
  }
  const TracedPhotons alone = trace_with(scene, 1);
  REQUIRE(alone.result.photons >= 3'000);
  REQUIRE(alone.result.segments > 3'000);
  for (const int width : core::lane_widths()) {
    CAPTURE(width);
    check_same(alone, trace_with(scene, width));
  }
}

TEST_CASE("Photons stay in lanes at facets, tables and reflectors, and each is replayed alone") {
  std::string scene;
  SUBCASE("facets") { scene = crystal("rough", by_area("18 deg")); }
  SUBCASE("facets, a gap and a reflector") { scene = crystal("backed", kBacked); }
  SUBCASE("paint, in part specular") { scene = crystal("paint", kPaint); }
  SUBCASE("polished, a gap and a Lambertian reflector") { scene = crystal("polished_lambertian_097"); }
  SUBCASE("table, a gap and a reflector") { scene = crystal("backed", kTableBacked); }
  SUBCASE("table of two wavelengths") { scene = two_wavelengths(); }
  const auto point = ready(scene_spec(scene));
  for (const int width : core::lane_widths()) {
    CAPTURE(width);
    const auto kind = width < 4 ? transport::LaneKind::none : transport::LaneKind::surfaces;
    CHECK(transport::lane_kinds(point->scene(), width)[point->start(0, 0).region] == kind);
    const TracedPhotons traced = trace_with(scene, width);
    REQUIRE(traced.list.size() > 100);
    for (std::size_t i = 0; i < traced.list.size(); i += 31) {
      const DetectedPhoton& seen = traced.list[i];
      const source::Photon end =
          point->replay(seen.event, seen.photon, [](const source::Photon&, const transport::Step&) {});
      CHECK(static_cast<float>(end.path_mm) == seen.path_mm);
      CHECK(static_cast<float>(end.position.x()) == seen.position_mm[0]);
      CHECK(static_cast<float>(end.ray.direction.y()) == seen.direction[1]);
      CHECK(end.interactions == seen.interactions);
    }
  }
}

TEST_CASE("Polished convex bodies of planes and quadrics are traced in lanes, others one by one") {
  const auto kind_of = [](const std::string& scene) {
    const auto point = ready(scene_spec(scene));
    const int widest = core::lane_widths().back();
    return transport::lane_kinds(point->scene(), widest)[point->start(0, 0).region];
  };
  const auto in_lanes =
      core::lane_widths().size() > 1 ? transport::LaneKind::smooth : transport::LaneKind::none;
  CHECK(kind_of(round_crystal(kThinRod, "6 mm")) == in_lanes);
  CHECK(kind_of(round_crystal(R"(sphere = { radius = "2 mm" })", "6 mm")) == in_lanes);
  CHECK(kind_of(round_crystal(std::string(kThinRod) + "\nrotate = { axis = [1, 1, 0], angle = \"90 deg\" }",
                              "6 mm")) == transport::LaneKind::none);
  CHECK(kind_of(replaced(round_crystal(kThinRod, "6 mm"), "surface = \"polished\"",
                         "surface = \"roncali2013_unified_rough\"")) == transport::LaneKind::none);
  CHECK(kind_of(round_crystal(R"(tube = { outer_radius = "2 mm", inner_radius = "1 mm", height = "10 mm" })",
                              "6 mm")) == transport::LaneKind::none);
}

TEST_CASE("A width that the processor has not is refused") {
  CHECK_THROWS_AS(trace_with(crystal("polished"), 3), InternalError);
}
