// Laws of light in fibres, tubes and other hollow or bent bodies, whose round faces are exact.
#include <algorithm>
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"
#include "support/shared.hpp"
#include "support/step_shapes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

const std::string kInVacuum = "ambient = \"vacuum_n1\"\n";

std::string clear_medium(const std::string& name, double index) {
  return fmt::format(
      "[media.{}]\nindex = {{ n = {} }}\nabsorption = {{ none = true }}\nscattering = {{ none = true }}\n",
      name, index);
}

std::string photons_of(const std::string& start, int photons, const std::string& rest = "") {
  return "[source]\ntype = \"photons\"\nwavelength = \"420 nm\"\npolarisation = \"unpolarised\"\n" + start +
         "\nphotons = " + std::to_string(law_photons(photons)) + "\n" + rest;
}

std::string round_part(const std::string& name, double radius_mm, double height_mm, int segments,
                       const std::string& medium) {
  return fmt::format(
      "[[part]]\nname = \"{}\"\ncylinder = {{ radius = \"{} mm\", height = \"{} mm\", segments = {} }}\n"
      "medium = \"{}\"\nsurface = \"flat\"\n",
      name, radius_mm, height_mm, segments, medium);
}

/// A fibre of core and two claddings along z in a black jacket, with sensors at its ends.
struct DoubleCladFibre {
  double n_core = 1.59, n_inner = 1.49, n_outer = 1.42;
  double core_mm = 0.45, inner_mm = 0.475, outer_mm = 0.5, length_mm = 400.0;

  std::string scene() const {
    const auto sensor = [](const char* name, const char* side) {
      return fmt::format(
          "[[part]]\nname = \"{}\"\nbox = [\"2 mm\", \"2 mm\", \"1 mm\"]\nplace = {{ touch = \"core\", side "
          "= "
          "\"{}\" }}\nsensor = \"matched\"\n",
          name, side);
    };
    return kInVacuum +
           fmt::format(
               "[[part]]\nname = \"jacket\"\ncylinder = {{ radius = \"0.6 mm\", height = \"{} mm\", segments "
               "= 12 "
               "}}\nmedium = \"opaque\"\n",
               length_mm) +
           round_part("outer", outer_mm, length_mm, 16, "outer") +
           round_part("inner", inner_mm, length_mm, 12, "inner") +
           round_part("core", core_mm, length_mm, 10, "core") + sensor("below", "-z") +
           sensor("above", "+z") + clear_medium("core", n_core) + clear_medium("inner", n_inner) +
           clear_medium("outer", n_outer) +
           fmt::format(
               "[sensors.matched]\nefficiency = {{ definition = \"internal\", value = 1.0 }}\n"
               "window = {{ index = {} }}\n",
               n_core);
  }

  /// Share of the light at an angle theta to the axis, emitted uniformly in the core, that is totally
  /// reflected at the wall of the core or at that of the inner cladding.
  ///
  /// Refraction at walls about one axis keeps n cos(theta) and the moment n d sin(theta), d the distance of
  /// the ray's line from the axis. At a wall of radius R light is totally reflected where
  /// (n_core cos)^2 + (n_core sin d / R)^2 is not below the square of the index beyond it. Of light
  /// emitted uniformly in a circle, d / core = sin(psi) with the density 4 / pi cos^2(psi).
  double kept(double theta) const {
    const double along = n_core * std::cos(theta), across = n_core * std::sin(theta);
    const auto least = [&](double beyond, double radius) {  // sin^2(psi)
      return (beyond * beyond - along * along) * radius * radius / (across * across * core_mm * core_mm);
    };
    const double sine2 = std::min(least(n_inner, core_mm), least(n_outer, inner_mm));
    if (sine2 <= 0.0) return 1.0;
    if (sine2 >= 1.0) return 0.0;
    const double psi = std::asin(std::sqrt(sine2));
    return 1.0 - 2.0 / kPi * (psi + 0.5 * std::sin(2.0 * psi));
  }
};

/// A round fibre along z to `straight`, along an arc of the radius `bend` towards +x, and on along x.
struct BentFibre {
  double radius = 0.5, straight = 3.0, bend = 3.0, index = 1.5;

  /// Below zero inside, of slope 1 or less, but for the flat ends.
  double wall(const Vec3& p) const {
    if (p.z() <= straight) return std::hypot(p.x(), p.y()) - radius;
    if (p.x() >= bend) return std::hypot(p.y(), p.z() - straight - bend) - radius;
    return std::hypot(std::hypot(p.x() - bend, p.z() - straight) - bend, p.y()) - radius;
  }
  Vec3 outwards(const Vec3& p) const {
    if (p.z() <= straight) return Vec3(p.x(), p.y(), 0.0).normalized();
    if (p.x() >= bend) return Vec3(0.0, p.y(), p.z() - straight - bend).normalized();
    const Vec3 to_arc(p.x() - bend, 0.0, p.z() - straight);
    return (p - (Vec3(bend, 0.0, straight) + bend * to_arc.normalized())).normalized();
  }
  double end() const { return bend + straight; }

  /// Share of a ray that arrives at one of the ends, followed by small steps from wall to wall.
  double arriving(Vec3 p, Vec3 d) const {
    double weight = 1.0;
    while (weight > 1e-4) {
      double t = 1e-7;
      while (wall(p + t * d) < 0.0) {
        const Vec3 at = p + t * d;
        if (at.z() < 0.0 || at.x() > end()) return weight;
        t += std::max(-wall(at), 1e-5);
      }
      double low = 0.0, high = t;
      if (wall(p + 1e-7 * d) >= 0.0) low = high = 0.0;
      for (int i = 0; i < 50 && high > 0.0; ++i) {
        const double middle = 0.5 * (low + high);
        (wall(p + middle * d) < 0.0 ? low : high) = middle;
      }
      p += low * d;
      const Vec3 normal = outwards(p);
      const double cosine = d.dot(normal);
      if (cosine <= 0.0) return weight;  // along the wall
      if (1.0 - cosine * cosine < 1.0 / (index * index))
        weight *= optics::fresnel(cosine, index, 1.0).unpolarised();
      d -= 2.0 * cosine * normal;
      d.normalize();
    }
    return 0.0;
  }
};

}  // namespace

TEST_CASE("Law: a fibre with two claddings keeps light of its axis up to the cosine n_outer / n_core") {
  const DoubleCladFibre fibre;
  const Traced traced = trace(
      fibre.scene() +
      photons_of(fmt::format("position = [\"0 mm\", \"0 mm\", \"{} mm\"]", 0.5 * fibre.length_mm), 60'000));
  for (const PartInfo& part : traced.built.scene.parts)
    if (part.name == "core" || part.name == "inner" || part.name == "outer") CHECK(part.curved);
  check_fraction(traced.result, Fate::detected, 1.0 - fibre.n_outer / fibre.n_core);
}

TEST_CASE("Law: a fibre with two claddings keeps meridional and skew light by the moment of its rays") {
  const DoubleCladFibre fibre;
  constexpr int kPanels = 200'000;
  double kept = 0.0;
  for (int i = 0; i < kPanels; ++i) {
    const double cosine = (i + 0.5) / kPanels;
    kept += fibre.kept(std::acos(cosine)) / kPanels;
  }
  const Traced traced =
      trace(fibre.scene() +
            photons_of(fmt::format("region = {{ part = \"core\", slab_z = [\"{} mm\", \"{} mm\"] }}",
                                   0.5 * fibre.length_mm - 1.0, 0.5 * fibre.length_mm + 1.0),
                       60'000));
  check_fraction(traced.result, Fate::detected, kept);
}

TEST_CASE("Law: light lost round the bend of a fibre, against rays followed from wall to wall") {
  const BentFibre fibre;
  constexpr double kHalfAngle = 48.0 * kDegree, kStart = 0.5;
  const int rays = law_photons(8'000);
  double sum = 0.0;
  for (int i = 0; i < rays; ++i) {
    Rng rng(31, StreamKind::other, static_cast<std::uint64_t>(i));
    // Strata of the angle to the axis.
    const double share = (i + rng.uniform()) / rays;
    const double cosine = 1.0 - share * (1.0 - std::cos(kHalfAngle)), sine = std::sqrt(1.0 - cosine * cosine);
    const double angle = kTwoPi * rng.uniform(), rho = fibre.radius * std::sqrt(rng.uniform()),
                 azimuth = kTwoPi * rng.uniform();
    sum += fibre.arriving({rho * std::cos(azimuth), rho * std::sin(azimuth), kStart},
                          {sine * std::cos(angle), sine * std::sin(angle), cosine});
  }
  const double expected = sum / rays;
  CHECK(expected < 0.95);  // enough is lost to be seen
  const std::string scene = kInVacuum + fmt::format(R"([[part]]
name = "fibre"
fibre = {{ radius = "{0} mm", x = ["0 mm", "0 mm", "{1} mm"], z = ["0 mm", "{1} mm", "{1} mm"], bend_radius = "{2} mm", segments = 16 }}
medium = "n15"
surface = "flat"
[[part]]
name = "start"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "fibre", side = "-z" }}
sensor = "perfect"
[[part]]
name = "end"
box = {{ low = ["{1} mm", "-1 mm", "{3} mm"], high = ["{4} mm", "1 mm", "{5} mm"] }}
sensor = "perfect"
)",
                                                    fibre.radius, fibre.end(), fibre.bend, fibre.end() - 1.0,
                                                    fibre.end() + 1.0, fibre.end() + 1.0);
  const Traced traced =
      trace(scene + photons_of(fmt::format("region = {{ part = \"fibre\", slab_z = [\"{} mm\", \"{} mm\"] }}",
                                           kStart - 1e-6, kStart + 1e-6),
                               30'000,
                               fmt::format("direction = {{ cone = [0, 0, 1], half_angle = \"{} deg\" }}\n",
                                           kHalfAngle / kDegree)));
  CHECK(traced.built.scene.parts.front().curved);
  check_law("detected at the ends", traced.result.fraction(Fate::detected),
            {expected, std::sqrt(expected * (1.0 - expected) / rays)});
}

TEST_CASE(
    "Law: an integrating sphere with a port sends out f / (1 - rho (1 - f)) of the light of its centre") {
  // Every reflection at a white wall of a sphere spreads light uniformly over the sphere: f of it, the port's
  // share of the area, leaves; the sum of a geometric series.
  constexpr double kPort = 0.1, kWhite = 0.9;
  const Traced traced = trace(kInVacuum + R"([[part]]
name = "ball"
sphere = { radius = "10 mm", subdivisions = 4 }
medium = "vacuum_n1"
surface = "flat"
[[part.face]]
name = "wall"
select = { group = "sphere" }
surface = "wall"
[[part]]
name = "port"
box = { low = ["-12 mm", "-12 mm", "8 mm"], high = ["12 mm", "12 mm", "12 mm"] }
priority = 2
sensor = "perfect_n1"
[surfaces.wall]
model = "painted"
reflectance = 0.9
specular_share = 0.0
)" + photons_of("position = [\"0 mm\", \"0 mm\", \"0 mm\"]", 100'000));
  CHECK(traced.built.scene.parts.front().curved);
  check_fraction(traced.result, Fate::detected, kPort / (1.0 - kWhite * (1.0 - kPort)));
}

TEST_CASE(
    "Law: a Winston cone accepts rays in planes of its axis up to its acceptance angle, and none beyond") {
  const double length = mesh::winston_length(2.0, 30.0 * kDegree);
  const scene_file::SceneSpec spec = scene_spec(kInVacuum + R"([[part]]
name = "cone"
winston = { exit_radius = "2 mm", entrance_radius = "4 mm", segments = 24, rings = 64 }
medium = "vacuum_n1"
surface = "mirror"
[[part.face]]
name = "exit"
select = { group = "-z" }
surface = "flat"
[[part.face]]
name = "entrance"
select = { group = "+z" }
surface = "flat"
[[part]]
name = "sensor"
box = ["50 mm", "50 mm", "1 mm"]
place = { touch = "cone", side = "-z" }
sensor = "perfect_n1"
[surfaces.mirror]
model = "painted"
reflectance = 1.0
specular_share = 1.0
)" + photons_of("region = { part = \"cone\" }", 1));
  SceneBuilder builder;
  const BuiltScene built = builder.build(spec);
  REQUIRE(built.scene.parts.front().curved);
  const PhotonSource source(spec.source, built.scene);
  for (const double angle_deg : {0.0, 10.0, 25.0, 29.8, 30.2, 35.0, 50.0}) {
    int detected = 0;
    constexpr int kRays = 199;
    for (int i = 0; i < kRays; ++i) {
      Rng rng(5, StreamKind::photon, static_cast<std::uint64_t>(i));
      Photon photon = source.emit(built.scene, rng);
      photon.position = Vec3(-3.99 + 7.98 * i / (kRays - 1), 0.0, length - 1e-9);
      photon.ray.direction = core::Vec3(std::sin(angle_deg * kDegree), 0.0, -std::cos(angle_deg * kDegree));
      photon.ray.polarisation = core::Vec3(0.0, 1.0, 0.0);
      photon.optical_depth = HUGE_VAL;
      transport::Step taken{};
      do taken = transport::step(built.scene, photon, rng);
      while (!is_final(taken.event));
      detected += taken.event == StepEvent::detected;
    }
    CAPTURE(angle_deg);
    CHECK(detected == (angle_deg < 30.0 ? kRays : 0));
  }
}

TEST_CASE("Fates in a tube and a torus do not depend on their facets") {
  const auto detected = [](const std::string& shape) {
    const Traced traced = trace(kInVacuum + "[[part]]\nname = \"body\"\n" + shape + R"(
medium = "lso"
surface = "flat"
)" + photons_of("region = { part = \"body\" }", 40'000));
    CHECK(traced.built.scene.parts.front().curved);
    return static_cast<double>(traced.result.count(Fate::escaped));
  };
  std::vector<double> tubes, tori;
  for (const int sides : {12, 72, 512})
    tubes.push_back(detected(fmt::format(
        "tube = {{ outer_radius = \"2 mm\", inner_radius = \"1 mm\", height = \"10 mm\", segments = {} }}",
        sides)));
  for (const auto& [sides, round] : {std::pair{12, 12}, std::pair{72, 36}})
    tori.push_back(detected(fmt::format(
        "torus = {{ radius = \"3 mm\", tube_radius = \"1 mm\", segments = {}, tube_segments = {} }}", sides,
        round)));
  for (const std::vector<double>& counts : {tubes, tori})
    for (const double count : counts)
      CHECK(std::abs(count - counts.front()) < kSigmas * std::sqrt(2.0 * count));
}

#ifdef SCINTRAY_TESTS_STEP
TEST_CASE("Core, cladding and glue in the hole of a tile: builders, STEP and GDML give the same fates") {
  const std::string media = R"([media.core]
index = { n = 1.6 }
absorption = { length = "30 mm" }
scattering = { none = true }
[media.cladding]
index = { n = 1.49 }
absorption = { none = true }
scattering = { none = true }
[media.glue]
index = { n = 1.53 }
absorption = { none = true }
scattering = { none = true }
[media.tile]
index = { n = 1.58 }
absorption = { length = "50 mm" }
scattering = { none = true }
)";
  const auto counts_of = [&](const std::string& parts, const std::string& tile) {
    const Traced traced =
        trace(kInVacuum + parts + media + photons_of("region = { part = \"" + tile + "\" }", 40'000));
    int curved = 0;
    for (const PartInfo& part : traced.built.scene.parts) curved += part.curved;
    CHECK(curved >= 3);
    return std::pair{static_cast<double>(traced.result.count(Fate::escaped)),
                     static_cast<double>(traced.result.count(Fate::absorbed_in_medium))};
  };
  struct Layer {
    const char* name;
    double radius;
  };
  constexpr Layer kLayers[] = {{"glue", 0.7}, {"cladding", 0.6}, {"core", 0.5}};
  const auto folder = scratch_folder("nested_fibre");

  std::string built_in =
      "[[part]]\nname = \"tile\"\nbox = [\"10 mm\", \"10 mm\", \"6 mm\"]\nmedium = "
      "\"tile\"\nsurface = \"flat\"\n";
  std::string in_step, in_gdml = built_in;
  for (const Layer& layer : kLayers) built_in += round_part(layer.name, layer.radius, 6.0, 20, layer.name);

  std::vector<StepBody> solids{{"tile", StepSolid::box, {10.0, 10.0, 6.0}, {-5.0, -5.0, 0.0}, {}, {}, ""}};
  for (const Layer& layer : kLayers)
    solids.push_back(
        {layer.name, StepSolid::cylinder, {layer.radius, 0.0, 6.0}, {0.0, 0.0, 0.0}, {}, {}, ""});
  const auto step = folder / "fibre.step";
  write_step(step, solids);
  for (const StepBody& body : solids)
    in_step += "[[part]]\nname = \"" + body.name + "\"\nmesh = \"" + step.string() + "\"\nbody = \"" +
               body.name + "\"\nmedium = \"" + body.name + "\"\nsurface = \"flat\"\n";

  exchange::gdml::GdmlImport options;
  options.mesh_folder = folder;
  std::string gdml_solids = "<box name=\"world_box\" x=\"100\" y=\"100\" z=\"100\"/>", volumes, inside;
  for (const char* name : {"core", "cladding", "glue"}) {
    const Layer& layer = *std::find_if(std::begin(kLayers), std::end(kLayers),
                                       [&](const Layer& l) { return std::string(l.name) == name; });
    gdml_solids += fmt::format("<tube name=\"{}_tube\" rmax=\"{}\" z=\"6\" deltaphi=\"360\" aunit=\"deg\"/>",
                               name, layer.radius);
    volumes += fmt::format(
        "<volume name=\"{0}\"><materialref ref=\"Glass\"/><solidref ref=\"{0}_tube\"/>{1}</volume>\n", name,
        inside);
    inside = fmt::format("<physvol name=\"{0}\"><volumeref ref=\"{0}\"/></physvol>", name);
  }
  gdml_solids += "<box name=\"tile_box\" x=\"10\" y=\"10\" z=\"6\"/>";
  volumes += "<volume name=\"tile\"><materialref ref=\"Glass\"/><solidref ref=\"tile_box\"/>" + inside +
             "</volume>\n<volume name=\"World\"><materialref ref=\"Vacuum\"/><solidref ref=\"world_box\"/>"
             "<physvol name=\"tile\"><volumeref ref=\"tile\"/></physvol></volume>\n";
  const std::string gdml =
      R"(<?xml version="1.0"?><gdml><define>
<matrix name="ONE" coldim="2" values="2*eV 1 4*eV 1"/><matrix name="N15" coldim="2" values="2*eV 1.5 4*eV 1.5"/></define><materials>
<material name="Vacuum"><property name="RINDEX" ref="ONE"/><D value="1e-25"/></material>
<material name="Glass"><property name="RINDEX" ref="N15"/><D value="2.5"/></material></materials><solids>)" +
      gdml_solids + "</solids>\n<structure>" + volumes +
      "</structure><setup name=\"Default\" version=\"1.0\"><world ref=\"World\"/></setup></gdml>";
  const exchange::SceneDraft draft = exchange::gdml::draft_of_gdml(gdml, "fibre.gdml", options);
  for (const auto& made : draft.meshes) mesh::write_ply(made.first, made.second);
  for (const Layer& layer : kLayers)
    in_gdml += fmt::format(
        "[[part]]\nname = \"{0}\"\nmesh = \"{1}\"\nunit = \"mm\"\ncurved = \"recognize\"\nmedium = \"{0}\"\n"
        "surface = \"flat\"\ntranslate = [\"0 mm\", \"0 mm\", \"3 mm\"]\n",
        layer.name, (folder / (std::string(layer.name) + "_tube.ply")).string());

  const auto expected = counts_of(built_in, "tile");
  for (const std::string& parts : {in_step, in_gdml}) {
    const auto counts = counts_of(parts, "tile");
    CHECK(std::abs(counts.first - expected.first) < kSigmas * std::sqrt(2.0 * expected.first));
    CHECK(std::abs(counts.second - expected.second) < kSigmas * std::sqrt(2.0 * expected.second));
  }
}
#endif
