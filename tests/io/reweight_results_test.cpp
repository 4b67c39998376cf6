// Reweighting of results files: what is read, what is refused. Physics is in physics/reweighting_test.cpp.
#include "scintray/simulation/reweight.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/results/results.hpp"
#include "support/made_up_result.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::results;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

using enum OpticalProperty;

/// Two points; the second has another surface. Photons of the first: ways of 10 and 20 mm with 1 and 2
/// reflections, by turns; of the second: 30 mm with none.
struct MadeUp {
  RunResult run = made_up_run();
  HistorySubjects first{{"LSO", "air"},
                        {{0.01, 0.01}, {0.0, 0.0}},
                        {{"rough", "rough", "PTFE"}, {"mixed", "glued", "paint"}},
                        {{0.8, 0.9}, {0.5, 0.5}},
                        {"leaky"},
                        {"optical_grease"}};
  HistorySubjects second{{"LSO"}, {{0.01, 0.02}}, {{"film", "film", "film"}}, {{0.9, 0.9}}, {}, {}};

  MadeUp() {
    run.points.resize(2);
    for (PointResult& point : run.points) {
      point.fates = {};
      point.fates[0] = 600;
      point.fates[4] = point.photons - 600;
      for (std::uint64_t& count : point.absorbed_in_medium) count = 0;
      for (std::uint64_t& count : point.absorbed_at_surface) count = 0;
      point.sensor_faces = {{PartId(1), FaceId(2), 600, 0}};
      point.detected_path_histogram = {};
    }
    run.header.surfaces = {"rough (LSO to air)", "bare (LSO to air)"};
  }

  std::filesystem::path write(const std::string& name, std::size_t rows_of_second = 600) const {
    const auto path = scratch_folder("reweigh_" + name) / "run.h5";
    ResultsWriter writer(path, run.header, false);
    HistoryColumns columns;
    columns.add(first);
    columns.add(second);
    writer.begin_histories(columns);
    PhotonHistories rows;
    for (std::uint32_t i = 0; i < 600; ++i) {
      rows.point.push_back(0);
      rows.event.push_back(i);
      rows.photon.push_back(0);
      const std::uint32_t turns = 1 + i % 2;
      const auto path_mm = static_cast<float>(10 * turns);
      rows.path_mm.insert(rows.path_mm.end(), {path_mm, 1.0f});
      rows.absorption_depth.insert(rows.absorption_depth.end(), {0.01f * path_mm, 0.0f});
      rows.reflections.insert(rows.reflections.end(), {turns, 0});
      const auto depth = static_cast<float>(-std::log(0.85) * turns);
      rows.reflection_depth.insert(rows.reflection_depth.end(), {depth, 0.0f});
    }
    writer.append_histories(rows, first);
    writer.add_point(run.points[0], &first);
    rows = {};
    for (std::size_t i = 0; i < rows_of_second; ++i) {
      rows.point.push_back(1);
      rows.event.push_back(i);
      rows.photon.push_back(0);
      rows.path_mm.push_back(30.0f);
      rows.absorption_depth.push_back(0.45f);
      rows.reflections.push_back(0);
      rows.reflection_depth.push_back(0.0f);
    }
    writer.append_histories(rows, second);
    writer.add_point(run.points[1], &second);
    writer.commit(true);
    return path;
  }
};

std::string refusal(const std::filesystem::path& path, const std::vector<PropertyScan>& scans) {
  try {
    static_cast<void>(reweight_results(path, read_results(path), scans));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Every point is reweighted for all combinations, in its own media and reflectors") {
  const MadeUp made;
  const auto path = made.write("combinations");
  const auto results =
      reweight_results(path, read_results(path),
                       {{absorption_length, "LSO", false, {200.0, std::numeric_limits<double>::infinity()}},
                        {reflectance, "PTFE", true, {1.0, 0.9}}});
  REQUIRE(results.size() == 8);
  const double photons = 187'500;
  CHECK(results[0].values == std::vector<double>{200.0, 1.0});
  CHECK(results[1].values == std::vector<double>{200.0, 0.9});
  for (std::size_t i = 0; i < 4; ++i) {
    const double mu = i < 2 ? 0.005 : 0.0, factor = i % 2 == 0 ? 1.0 : 0.9;
    const auto weight = [&](double turns) {
      return std::exp((0.01 - mu) * 10.0 * turns) * std::pow(factor, turns);
    };
    CHECK(results[i].point == 0);
    CHECK(results[i].light.detected_fraction.value ==
          doctest::Approx(300.0 * (weight(1) + weight(2)) / photons).epsilon(1e-5));
    CHECK(results[i].light.valid);
    // No PTFE there, and traced depths of its own.
    CHECK(results[4 + i].point == 1);
    CHECK(results[4 + i].light.detected_fraction.value ==
          doctest::Approx(600.0 * std::exp(0.45 - 30.0 * mu) / photons).epsilon(1e-5));
  }
  CHECK_FALSE(results[0].per_event);

  // A constant in place of what varies with wavelength; by the names of the stack and of the mixture.
  for (const char* name : {"rough", "PTFE"}) {
    const auto constant = reweight_results(path, read_results(path), {{reflectance, name, false, {0.8}}});
    const double step = 0.8 / 0.85;
    CHECK(constant.at(0).light.relative.value == doctest::Approx(0.5 * (step + step * step)).epsilon(1e-5));
    CHECK(constant.at(1).light.relative.value == doctest::Approx(1.0));
  }
  for (const char* name : {"mixed", "glued", "paint"})
    CHECK(reweight_results(path, read_results(path), {{reflectance, name, false, {0.4}}}).size() == 2);
}

TEST_CASE("What a result cannot be reweighted for is refused with the reason") {
  const MadeUp made;
  const auto path = made.write("refused");
  const auto says = [&](const PropertyScan& scan, const Fragments& fragments) {
    check_contains(refusal(path, {scan}), fragments);
  };
  says({absorption_length, "LS0", false, {200.0}}, "did you mean \"LSO\"");
  says({absorption_length, "optical_grease", false, {200.0}}, {"fills the gap", "surface"});
  says({absorption_length, "LSO", false, {0.0}}, {"absorption length", "above 0"});
  says({absorption_length, "LSO", true, {-1.0}}, {"factor", "above 0"});
  says({absorption_length, "LSO", false, {}}, "no value");
  says({reflectance, "PTFF", false, {0.9}}, "did you mean \"PTFE\"");
  says({reflectance, "leaky", false, {0.9}}, "transmits light");
  says({reflectance, "bare", false, {0.9}}, "no reflectance");
  says({reflectance, "PTFE", false, {1.2}}, {"reflectance", "0 to 1"});
  says({reflectance, "PTFE", true, {1.2}}, {"0.9 times 1.2", "above 1"});
  check_contains(refusal(path, {}), "no absorption length or reflectance to change");
  check_contains(refusal(path, {{reflectance, "PTFE", false, {0.9}}, {reflectance, "rough", false, {0.8}}}),
                 {"reflectance", "same item"});
  check_contains(refusal(path, {{absorption_length, "LSO", true, std::vector<double>(101, 1.0)},
                                {reflectance, "PTFE", true, std::vector<double>(100, 1.0)}}),
                 "more than 10000 combinations");

  check_contains(refusal(made.write("short", 599), {{absorption_length, "LSO", true, {1.0}}}),
                 {"599 histories", "600 detected photons"});
  const auto bare = scratch_folder("reweigh_bare") / "run.h5";
  ResultsWriter writer(bare, made.run.header, false);
  writer.commit(true);
  check_contains(refusal(bare, {{absorption_length, "LSO", true, {1.0}}}), "photon_history = true");
}
