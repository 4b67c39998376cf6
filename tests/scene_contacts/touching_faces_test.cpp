// Selection of the faces that touch another part.
#include <doctest/doctest.h>

#include "scintray/scene/place_parts.hpp"
#include "scintray/scene_file/read_scene.hpp"

using namespace scintray;
using namespace scintray::core;

namespace {

constexpr const char* kSource = R"([source]
type = "photons"
region = { part = "guide" }
wavelength = "420 nm"
photons = 1
)";

std::vector<contact::PlacedMesh> placed(const std::string& parts, Problems& problems) {
  const auto file = scene_file::SceneFile::from_text("ambient = \"air\"\n" + parts + kSource, "scene.toml");
  return scene::place_parts(file.spec(0), problems);
}

/// Area (mm2) of a face of the first part.
double area_of(const contact::PlacedMesh& part, const std::string& face) {
  double area = 0.0;
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t)
    if (part.faces[part.face_of[t]].name == face) area += part.mesh.area_vector(t).norm();
  return area;
}

std::string guide(const std::string& shape, const std::string& select) {
  return "[[part]]\nname = \"guide\"\n" + shape +
         "\nmedium = \"glass\"\nsurface = \"polished\"\n[[part.face]]\nselect = " + select +
         "\nsurface = \"geant4_ground\"\n";
}

const std::string kBox = R"(box = { low = ["0 mm", "0 mm", "0 mm"], high = ["4 mm", "3 mm", "10 mm"] })";

std::string block(const std::string& name, const std::string& low, const std::string& high) {
  return "[[part]]\nname = \"" + name + "\"\nmedium = \"glass\"\nsurface = \"polished\"\nbox = { low = [" +
         low + "], high = [" + high + "] }\n";
}

const std::string kPmt = block("pmt", R"("1 mm", "1 mm", "-1 mm")", R"("2 mm", "2 mm", "0 mm")");
const std::string kWing = block("wing", R"("4 mm", "0 mm", "2 mm")", R"("5 mm", "3 mm", "4 mm")");

}  // namespace

TEST_CASE(
    "The whole face that a smaller part touches is selected, whether that part stands before or after") {
  for (const bool before : {false, true}) {
    Problems problems;
    const std::string rules = guide(kBox, R"({ touches = "pmt" })");
    const auto parts = placed(before ? kPmt + rules : rules + kPmt, problems);
    REQUIRE(problems.empty());
    const contact::PlacedMesh& part = parts[before ? 1 : 0];
    CHECK(area_of(part, "pmt") == doctest::Approx(12.0));  // named after the part
    CHECK(area_of(part, "other") == doctest::Approx(2 * (12.0 + 30.0 + 40.0) - 12.0));
  }
}

TEST_CASE("A pattern selects the faces of several parts, and further conditions narrow them") {
  Problems problems;
  const auto both = placed(guide(kBox, R"({ touches = "*" })") + kPmt + kWing, problems);
  REQUIRE(problems.empty());
  CHECK(area_of(both[0], "face1") == doctest::Approx(12.0 + 30.0));
  const auto one = placed(guide(kBox, R"({ touches = "*", normal = [0, 0, -1] })") + kPmt + kWing, problems);
  REQUIRE(problems.empty());
  CHECK(area_of(one[0], "face1") == doctest::Approx(12.0));
}

TEST_CASE("A face goes around a round wall, up to the edge angle") {
  const std::string rod = R"(cylinder = { radius = "2 mm", height = "10 mm", segments = 24 })";
  const std::string foot = block("pmt", R"("-1 mm", "-1 mm", "-1 mm")", R"("1 mm", "1 mm", "0 mm")");
  // A pad on the facet towards +x, 1.9829 mm from the axis (2 cos 7.5 deg), 0.5221 mm wide.
  const std::string turned =
      "[[part]]\nname = \"pad\"\nmedium = \"glass\"\nsurface = \"polished\"\n"
      "box = { low = [\"1.982889722747621 mm\", \"-0.1 mm\", \"4 mm\"], high = [\"3 mm\", \"0.1 mm\", \"5 "
      "mm\"] }\n"
      "rotate = { axis = [0, 0, 1], angle = \"7.5 deg\" }\n";
  Problems problems;
  const double facet = 4.0 * std::sin(7.5 * kDegree) * 10.0;
  const auto wall = placed(guide(rod, R"({ touches = "pad" })") + turned + foot, problems);
  REQUIRE(problems.empty());
  CHECK(area_of(wall[0], "pad") == doctest::Approx(24 * facet));
  const auto strip = placed(guide(rod, R"({ touches = "pad", edge_angle = "10 deg" })") + turned, problems);
  REQUIRE(problems.empty());
  CHECK(area_of(strip[0], "pad") == doctest::Approx(facet));
}

TEST_CASE("Faces that only share an edge with a part, or lie away from it, do not touch it") {
  Problems problems;
  const std::string beside = block("pmt", R"("4 mm", "3 mm", "0 mm")", R"("5 mm", "4 mm", "10 mm")");
  const std::string far = block("far", R"("9 mm", "0 mm", "0 mm")", R"("10 mm", "1 mm", "1 mm")");
  (void)placed(guide(kBox, R"({ touches = "pmt" })") + beside + far + kWing, problems);
  REQUIRE(problems.list().size() == 1);
  const Problem& problem = problems.list().front();
  CHECK(problem.what.find("no face of part \"guide\" touches \"pmt\"") != std::string::npos);
  CHECK(problem.hint.find("it touches wing;") != std::string::npos);
  CHECK(problem.where.text() == "scene.toml:8:22");
}

TEST_CASE("A part that is not there is refused with the nearest name") {
  Problems problems;
  (void)placed(guide(kBox, R"({ touches = "pnt" })") + kPmt, problems);
  REQUIRE(problems.list().size() == 1);
  CHECK(problems.list().front().hint.find("\"pmt\"") != std::string::npos);
}

TEST_CASE("The smooth surface around a point or a group is selected, the ends of a rod are not") {
  const std::string rod = R"(cylinder = { radius = "2 mm", height = "10 mm", segments = 24 })";
  const double wall = 24 * 4.0 * std::sin(7.5 * kDegree) * 10.0;
  for (const char* select :
       {R"({ smooth_region = ["2 mm", "0.1 mm", "5 mm"] })", R"({ smooth_around = "side" })"}) {
    CAPTURE(select);
    Problems problems;
    const auto parts = placed(guide(rod, select), problems);
    REQUIRE(problems.empty());
    CHECK(area_of(parts[0], "face1") == doctest::Approx(wall));
  }
}

TEST_CASE("An edge angle without a region that it ends, or outside its range, is refused") {
  const auto problem = [](const std::string& select) {
    Problems problems;
    try {
      (void)placed(guide(kBox, select), problems);
    } catch (const InputError& error) {
      return error.problems().front();
    }
    return Problem{};
  };
  CHECK(problem(R"({ group = "-z", edge_angle = "10 deg" })").hint.find("touches") != std::string::npos);
  CHECK(problem(R"({ touches = "pmt", edge_angle = "200 deg" })").what.find("0 to 180 deg") !=
        std::string::npos);
}
