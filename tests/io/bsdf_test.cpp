#include "scintray/tables/bsdf_text.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <tuple>

#include "io/tabulated.hpp"
#include "scintray/core/error.hpp"
#include "scintray/tables/import_settings.hpp"
#include "scintray/tables/table_csv.hpp"
#include "scintray/tables/table_side.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::tables;
using namespace scintray::test;

namespace {

/// A reader of the format for this test alone, from its public description.
struct BsdfFile {
  explicit BsdfFile(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string line;
    std::vector<std::string> words;
    while (std::getline(file, line)) {
      if (line.starts_with("#")) continue;
      std::istringstream text(line);
      for (std::string word; text >> word;) words.push_back(word);
    }
    std::size_t at = 0;
    const auto expect = [&](const std::string& word) { REQUIRE(words.at(at++) == word); };
    const auto list = [&](const std::string& name) {
      expect(name);
      std::vector<double> numbers(std::stoul(words.at(at++)));
      for (double& number : numbers) number = std::stod(words.at(at++));
      return numbers;
    };
    for (const char* word : {"Source", "Measured", "Symmetry", "PlaneSymmetrical", "SpectralContent",
                             "Monochrome", "ScatterType"})
      expect(word);
    kind = words.at(at++);
    list("SampleRotation");
    incidence = list("AngleOfIncidence");
    azimuth = list("ScatterAzimuth");
    radial = list("ScatterRadial");
    expect("Monochrome");
    expect("DataBegin");
    for (std::size_t k = 0; k < incidence.size(); ++k) {
      expect("TIS");
      total.push_back(std::stod(words.at(at++)));
      std::vector<double> block(azimuth.size() * radial.size());
      for (double& value : block) value = std::stod(words.at(at++));
      values.push_back(block);
    }
    expect("DataEnd");
    REQUIRE(at == words.size());
  }

  /// Sum over a fine mesh of directions about the specular one, each with the value of the nearest angles.
  double integral(std::size_t k) const {
    const auto nearest = [](const std::vector<double>& points, double x) {
      std::size_t best = 0;
      for (std::size_t i = 1; i < points.size(); ++i)
        if (std::abs(points[i] - x) < std::abs(points[best] - x)) best = i;
      return best;
    };
    const double specular = incidence[k] * kDegree;
    double sum = 0.0;
    // Steps of 0.05 deg fit between the borders of the cells.
    for (double r = 0.025; r < 180.0; r += 0.05)
      for (double a = 0.5; a < 180.0; a += 1.0) {
        const double cosine = std::cos(specular) * std::cos(r * kDegree) +
                              std::sin(specular) * std::sin(r * kDegree) * std::cos(a * kDegree);
        if (cosine <= 0.0) continue;
        sum += values[k][nearest(azimuth, a) * radial.size() + nearest(radial, r)] * cosine *
               std::sin(r * kDegree) * 0.05 * kDegree * 1.0 * kDegree * 2.0;
      }
    return sum;
  }

  std::string kind;
  std::vector<double> incidence, azimuth, radial, total;
  std::vector<std::vector<double>> values;
};

BsdfFile written(const SurfaceTable& table, const BsdfSettings& settings) {
  const auto path = scratch_folder("bsdf") / "a.bsdf";
  write_bsdf(path, bsdf_of(table, settings), table, settings);
  return BsdfFile(path);
}

}  // namespace

TEST_CASE("a file's numbers add up to the reflectance, or the transmittance") {
  BsdfSettings settings;
  settings.angles.specular = {0.0, 20.0, 35.0, 60.0, 85.0};
  for (const SurfaceTable* table : {&rough_table(), &nearly_polished_table()})
    for (const Side side : {Side::inside, Side::outside})
      for (const Leaving way : {Leaving::reflected, Leaving::transmitted}) {
        settings.side = side;
        settings.way = way;
        const BsdfFile file = written(*table, settings);
        CHECK(file.kind == (way == Leaving::reflected ? "BRDF" : "BTDF"));
        const double before = kLsoToAir.on(side), behind = kLsoToAir.on(other(side));
        for (std::size_t k = 0; k < file.incidence.size(); ++k) {
          const double sine = std::sin(file.incidence[k] * kDegree);
          const double sine_incident = way == Leaving::reflected ? sine : sine * behind / before;
          const double reflectance = table->reflectance(side, std::asin(sine_incident));
          const double light = way == Leaving::reflected ? reflectance : 1.0 - reflectance;
          CAPTURE(file.incidence[k]);
          CAPTURE(static_cast<int>(side));
          CHECK(file.total[k] == doctest::Approx(light).epsilon(1e-5));
          // The two sums differ in cells that the horizon cuts.
          CHECK(std::abs(file.integral(k) - light) < 0.01 * light + 1e-4);
        }
      }
}

TEST_CASE("a Lambertian table has the same value everywhere: reflectance / pi") {
  std::vector<ExitAngles> sample;
  for (int k = 0; k < 80000; ++k)
    sample.push_back({static_cast<float>(std::asin(std::sqrt((k + 0.5) / 80000))),
                      static_cast<float>(kPi * std::fmod(k * 0.6180339887498949, 1.0))});
  TableNode node;
  node.reflectance = 0.6;
  node.reflected = node.transmitted = quantiles_of(sample);
  TableNode last = node;
  last.incidence_rad = 0.5 * kPi;
  const SurfaceTable table({1.5, 1.0}, {node, last}, {node, last}, {});
  BsdfSettings settings;
  settings.rays = 1'000'000;
  settings.angles = {{30.0}, {0.0, 45.0, 90.0, 135.0, 180.0}, {0.0, 20.0, 40.0, 60.0, 80.0, 100.0}};
  const Bsdf bsdf = bsdf_of(table, settings);
  const std::vector<double> cells = projected_cells(bsdf.angles, 30.0 * kDegree);
  int checked = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (cells[k] < 0.02) continue;
    ++checked;
    CHECK(bsdf.values[k] == doctest::Approx(0.6 / kPi).epsilon(0.02));
  }
  CHECK(checked > 15);
}

TEST_CASE("a lobe about the mirrored ray is at radial angle 0, and tilts towards the normal at azimuth 0") {
  BsdfSettings settings;
  settings.angles.specular = {45.0};
  const BsdfFile polished = written(nearly_polished_table(), settings);
  const auto& block = polished.values.front();
  CHECK(block.front() == *std::max_element(block.begin(), block.end()));
  // Light at 45 deg that leaves along the normal: radial 45, azimuth 0.
  TableNode node;
  node.reflectance = 1.0;
  std::vector<ExitAngles> along_normal(1000, ExitAngles{0.0f, 0.0f});
  node.reflected = quantiles_of(along_normal);
  TableNode last = node;
  last.incidence_rad = 0.5 * kPi;
  const Bsdf bsdf = bsdf_of(SurfaceTable({1.5, 1.0}, {node, last}, {node, last}, {}), settings);
  const auto brightest = std::max_element(bsdf.values.begin(), bsdf.values.end()) - bsdf.values.begin();
  const auto columns = static_cast<std::ptrdiff_t>(bsdf.angles.radial.size());
  CHECK(bsdf.angles.azimuth[static_cast<std::size_t>(brightest / columns)] == 0.0);
  CHECK(bsdf.angles.radial[static_cast<std::size_t>(brightest % columns)] == 45.0);
}

TEST_CASE("transmitted angles that no refracted ray has are left out") {
  BsdfSettings settings;
  settings.side = Side::outside;  // air to LSO: refracted up to 33.3 deg
  settings.way = Leaving::transmitted;
  CHECK(bsdf_of(rough_table(), settings).angles.specular.back() == 30.0);
  settings.angles.specular = {40.0, 60.0};
  CHECK_THROWS_AS(bsdf_of(rough_table(), settings), InputError);
}

TEST_CASE("densities of the CSV times the cells' solid angles add up to reflectance and transmittance") {
  const auto path = scratch_folder("table_csv") / "a.csv";
  write_table_csv(path, rough_table());
  std::ifstream file(path);
  std::string line;
  std::map<std::tuple<std::string, std::string, std::string>, double> sums;
  std::size_t rows = 0;
  double error_squares = 0.0;
  while (std::getline(file, line)) {
    if (line.starts_with("#") || line.starts_with("wavelength_nm,")) continue;
    std::istringstream text(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    REQUIRE(cells.size() == 8);
    cells.erase(cells.begin());
    const double polar = std::stod(cells[3]),
                 solid_angle = 2.0 * 15.0 * kDegree *
                               (std::cos((polar - 2.5) * kDegree) - std::cos((polar + 2.5) * kDegree));
    sums[{cells[0], cells[1], cells[2]}] += std::stod(cells[5]) * solid_angle;
    error_squares += std::stod(cells[6]) * std::stod(cells[6]);
    ++rows;
  }
  CHECK(rows == sums.size() * 18 * 12);
  CHECK(error_squares > 0.0);
  for (const auto& [key, sum] : sums) {
    const auto& [side, incidence, kind] = key;
    const double reflectance = rough_table().reflectance(side == "inside" ? Side::inside : Side::outside,
                                                         std::stod(incidence) * kDegree);
    CHECK(sum == doctest::Approx(kind == "reflected" ? reflectance : 1.0 - reflectance).epsilon(1e-4));
  }
}

TEST_CASE("a BRDF and a BTDF that were written are read back to a table of the same light") {
  const auto folder = scratch_folder("bsdf_round_trip");
  BsdfSettings settings;
  const auto parsed = [&](const SurfaceTable& table, Leaving way) {
    settings.way = way;
    const auto path = folder / "a.bsdf";
    write_bsdf(path, bsdf_of(table, settings), table, settings);
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return parse_bsdf(text, "a.bsdf", way);
  };
  ImportSettings indices;
  indices.index = kLsoToAir;
  indices.from_outside = FromOutside::absorb;
  const SurfaceTable& before = rough_table();
  const Bsdf brdf = parsed(before, Leaving::reflected), btdf = parsed(before, Leaving::transmitted);
  const SurfaceTable after = bsdf_table(brdf, &btdf, indices, "a");
  const double critical = std::asin(1.0 / 1.82);
  for (const double degrees : {0.0, 12.0, 20.0, 30.0, 47.0, 70.0}) {
    CAPTURE(degrees);
    const double incidence = degrees * kDegree;
    const TableSide was(before, Side::inside), is(after, Side::inside);
    CHECK(std::abs(is.share(Leaving::reflected, incidence) - was.share(Leaving::reflected, incidence)) <
          0.01);
    const double passed = is.share(Leaving::transmitted, incidence);
    // Rough faces transmit beyond the critical angle, too, where the format has no ray to refer to.
    if (incidence > critical)
      CHECK(passed == 0.0);
    else
      CHECK(std::abs(passed - was.share(Leaving::transmitted, incidence)) < 0.01);
    for (const Leaving way : {Leaving::reflected, Leaving::transmitted}) {
      if (way == Leaving::transmitted && incidence > critical) continue;
      const auto means = [&](const TableSide& side) {
        double x = 0.0, z = 0.0;
        constexpr int kPoints = 20'000;
        for (int k = 0; k < kPoints; ++k) {
          const CubePoint at = cube_point(static_cast<std::uint64_t>(k), {0.1, 0.2, 0.3});
          const ExitAngles exit = side.direction(way, incidence, at.u, at.v);
          x += std::sin(exit.polar) * std::cos(exit.azimuth) / kPoints;
          z += std::cos(exit.polar) / kPoints;
        }
        return std::pair(x, z);
      };
      const auto first = means(was), second = means(is);
      // Cells are 10 deg wide where lobes are broad, and angles between two nodes are interpolated.
      CHECK(std::abs(first.first - second.first) < 0.02);
      CHECK(std::abs(first.second - second.second) < 0.02);
    }
  }
  CHECK(bsdf_table(brdf, nullptr, indices, "a").reflectance(Side::inside, 0.3) ==
        doctest::Approx(after.reflectance(Side::inside, 0.3)));
  CHECK(bsdf_table(brdf, nullptr, indices, "a").opaque());
  std::ifstream file(folder / "a.bsdf");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  CHECK_THROWS_WITH_AS(parse_bsdf(text, "a.bsdf"), doctest::Contains("transmitted light (BTDF)"), InputError);
  settings.way = Leaving::reflected;
  write_bsdf(folder / "b.bsdf", bsdf_of(before, settings), before, settings);
  std::ifstream other_file(folder / "b.bsdf");
  const std::string other_text{std::istreambuf_iterator<char>(other_file), {}};
  CHECK_THROWS_WITH_AS(parse_bsdf(other_text, "b.bsdf", Leaving::transmitted),
                       doctest::Contains("reflected light (BRDF)"), InputError);
}
