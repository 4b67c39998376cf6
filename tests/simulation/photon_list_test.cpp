// Photons of a list through a scene: closed forms, and the same bits however they are divided.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "scenes.hpp"
#include "scintray/simulation/memory_sink.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// A plate of index 1.5 between two sensors, without anything that absorbs.
const std::string kPlate = R"(
ambient = "space"
[[part]]
name = "plate"
box = { low = ["-900 mm", "-900 mm", "0 mm"], high = ["900 mm", "900 mm", "0.5 mm"] }
medium = "glass"
surface = "flat"
[[part]]
name = "above"
box = { low = ["-900 mm", "-900 mm", "2 mm"], high = ["900 mm", "900 mm", "3 mm"] }
medium = "space"
sensor = "all"
surface = "flat"
[[part]]
name = "below"
box = { low = ["-900 mm", "-900 mm", "-3 mm"], high = ["900 mm", "900 mm", "-2 mm"] }
medium = "space"
sensor = "all"
surface = "flat"
[surfaces.flat]
model = "smooth"
[media.space]
index = { n = 1.0 }
absorption = { none = true }
scattering = { none = true }
[media.glass]
index = { n = 1.5 }
absorption = { none = true }
scattering = { none = true }
[sensors.all]
efficiency = { definition = "internal", value = 1.0 }
window = { index = 1.0 }
[source]
type = "photon_list"
file = "@FILE"
length_unit = "mm"
wavelength_unit = "nm"
time_unit = "ns"
@MORE
)";

std::string scene_with(const std::string& name, const std::string& csv, const std::string& more) {
  const std::filesystem::path file = scratch_folder("photon_list_run") / name;
  std::ofstream(file) << csv;
  std::string text = kPlate;
  text.replace(text.find("@FILE"), 5, file.string());
  text.replace(text.find("@MORE"), 5, more);
  return text;
}

std::uint64_t detected(const tally::EventRecord& event, std::size_t channel) {
  return event.channels.at(channel).detected;
}

}  // namespace

TEST_CASE("Law: listed polarisations at Brewster's angle: all of p passes a plate, (1 - R) / (1 + R) of s") {
  // ((n^2 - 1) / (n^2 + 1))^2 is R of s, and p is not reflected; both reflections of the plate are summed.
  constexpr int kListPhotons = 4000;
  const double n2 = 1.5 * 1.5, reflectance = std::pow((n2 - 1.0) / (n2 + 1.0), 2);
  const double sine = 1.5 / std::sqrt(1.0 + n2), cosine = 1.0 / std::sqrt(1.0 + n2);
  std::string csv =
      "event,x,y,z,direction_x,direction_y,direction_z,polarisation_x,polarisation_y,polarisation_z,"
      "wavelength,time\n";
  for (int i = 0; i < 2 * kListPhotons; ++i) {
    const bool p = i % 2 == 0;
    csv += fmt::format("{},0,0,-1,{:.17g},0,{:.17g},{:.17g},{},{:.17g},420,{}\n", p ? 0 : 1, sine, cosine,
                       p ? cosine : 0.0, p ? 0 : 1, p ? -sine : 0.0, 7);
  }
  MemorySink memory;
  Simulation(scene_of(scene_with("brewster.csv", csv, "polarisation = \"listed\""))).run_all(memory);
  REQUIRE(memory.event_list.size() == 2);
  const auto& channels = memory.readouts.at(0).channels;
  REQUIRE(channels.size() >= 2);
  std::uint64_t above[2] = {}, below[2] = {};
  for (const std::size_t event : {0, 1})
    for (std::size_t i = 0; i < channels.size(); ++i)
      (channels[i].name.starts_with("above") ? above : below)[event] += detected(memory.event_list[event], i);
  CHECK(above[0] == kListPhotons);
  CHECK(above[1] + below[1] == kListPhotons);
  const double share = (1.0 - reflectance) / (1.0 + reflectance);
  // Five standard errors: a correct program fails once in 1.7 million.
  CHECK(std::abs(static_cast<double>(above[1]) - share * kListPhotons) <
        5.0 * std::sqrt(kListPhotons * share * (1.0 - share)));
  const tally::PointResult& point = memory.result.points.at(0);
  CHECK(point.energy.events == 2);
  CHECK(point.energy.silent == 0);
  CHECK(point.energy.detected.count == 2);
  CHECK(memory.event_list[0].energy_keV == 0.0F);
  CHECK(memory.event_list[0].emitted == kListPhotons);
}

TEST_CASE("Law: a listed photon arrives after its own time and its way over c / n") {
  // One starts 1 mm above the plate at 25 ns, one on its lower face, into it. Outside of the plate light goes
  // 1.5 mm to the sensor above it, 2 mm to the one below; the rest of its way is glass of index 1.5.
  const std::string csv =
      "event,x,y,z,direction_x,direction_y,direction_z,wavelength,time\n3,0,0,1.5,0,0,-1,420,25\n"
      "9,1,1,0,0,0,1,400,0\n";
  MemorySink memory;
  Simulation(scene_of(scene_with("time.csv", csv, "[run]\nphoton_list = true\n"))).run_all(memory);
  CHECK(memory.result.points.at(0).photons == 2);
  constexpr double kSpeed = 299.792458;  // mm/ns
  for (const tally::DetectedPhoton& photon : memory.photon_list) {
    const bool listed_late = photon.event == 0;
    const double outside_mm = (photon.position_mm[2] > 0.0F ? 1.5 : 2.0) + (listed_late ? 1.0 : 0.0);
    const double glass_mm = static_cast<double>(photon.path_mm) - outside_mm;
    CHECK(photon.time_ns ==
          doctest::Approx((listed_late ? 25.0 : 0.0) + (outside_mm + 1.5 * glass_mm) / kSpeed).epsilon(1e-5));
  }
  CHECK(memory.photon_list.size() == 2);
}

TEST_CASE("A list of photons gives the same bits for any number of threads, and in shards") {
  std::string csv = "event,x,y,z,direction_x,direction_y,direction_z,wavelength,time\n";
  for (int i = 0; i < 3000; ++i)
    csv += fmt::format("{},{},{},{},{},{},{},{},{}\n", i * 7 % 40, 0.1 * (i % 11), -0.2 * (i % 7),
                       -1.0 + 0.4 * (i % 6), std::sin(i), std::cos(3 * i), std::sin(2 * i + 1), 400 + i % 50,
                       0.01 * i);
  const std::string text = scene_with("divided.csv", csv, "[run]\nphoton_list = true\n");
  const auto run = [&](int threads) {
    SimulationOptions options;
    options.threads = threads;
    auto memory = std::make_unique<MemorySink>();
    Simulation(scene_of(text), options).run_all(*memory);
    return memory;
  };
  const auto one = run(1), three = run(3);
  std::vector<std::filesystem::path> files;
  for (const std::uint64_t number : {3, 1, 2}) {
    files.push_back(scratch_folder("photon_list_" + std::to_string(number)) / "a.shard");
    RangeFile file(files.back(), Shard{number, 3});
    Simulation(scene_of(text)).run_all(file, {}, Shard{number, 3});
  }
  MemorySink merged;
  merge_ranges(files, merged);
  CHECK(one->event_list.size() == 40);
  for (const MemorySink* other :
       {static_cast<const MemorySink*>(three.get()), static_cast<const MemorySink*>(&merged)}) {
    CHECK(other->result.points.at(0).fates == one->result.points.at(0).fates);
    REQUIRE(other->photon_list.size() == one->photon_list.size());
    for (std::size_t i = 0; i < one->photon_list.size(); ++i) {
      CHECK(other->photon_list[i].event == one->photon_list[i].event);
      CHECK(other->photon_list[i].time_ns == one->photon_list[i].time_ns);
      CHECK(other->photon_list[i].position_mm == one->photon_list[i].position_mm);
    }
    REQUIRE(other->event_list.size() == 40);
    for (std::size_t i = 0; i < 40; ++i) CHECK(other->event_list[i].detected == one->event_list[i].detected);
  }
}

TEST_CASE("What needs energies refuses a list of photons") {
  const std::string csv = "event,x,y,z,direction_x,direction_y,direction_z,wavelength\n0,0,0,-1,0,0,1,420\n";
  const std::string text = scene_with("map.csv", csv, "");
  try {
    SimulationOptions options;
    options.photons = 5;
    Simulation simulation(scene_of(text), options);
    simulation.point(0);
    FAIL("a number of photons was accepted");
  } catch (const InputError& error) {
    CHECK(error.problems().front().what.find("--photons") != std::string::npos);
  }
}
