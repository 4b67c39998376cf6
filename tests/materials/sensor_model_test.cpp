// A sensor model from outside: nothing of ScintRay knows it but the list that the caller passes.
#include "scintray/materials/sensor_models.hpp"

#include <algorithm>

#include "database_helpers.hpp"
#include "scintray/detector/channel.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::detector;
using namespace scintray::materials;

namespace {

/// One avalanche at a time: a carrier fires unless one firing_times within the dead time before it.
class ToyProcess : public AvalancheProcess {
 public:
  explicit ToyProcess(double dead_ns) : dead_ns_(dead_ns) {}
  double memory_ns() const override { return dead_ns_; }
  void fire(std::vector<Carrier>& carriers, double end_ns, Rng&,
            const AvalancheSink& deliver) const override {
    std::sort(carriers.begin(), carriers.end(),
              [](const Carrier& a, const Carrier& b) { return a.time_ns < b.time_ns; });
    double ready_ns = -1e9;
    for (const Carrier& carrier : carriers)
      if (carrier.time_ns >= ready_ns && carrier.time_ns < end_ns) {
        deliver(carrier.time_ns, 1.0, carrier.cause);
        ready_ns = carrier.time_ns + dead_ns_;
      }
  }

 private:
  double dead_ns_;
};

class ToySensor : public AvalancheModel {
 public:
  explicit ToySensor(double dead_ns) : dead_ns_(dead_ns) {}
  std::unique_ptr<const AvalancheProcess> on(const SensorFace&) const override {
    return std::make_unique<const ToyProcess>(dead_ns_);
  }

 private:
  double dead_ns_;
};

SensorModel toy_sensor_model() {
  const auto read = [](const TomlTable& sensor, SourceRule rule, std::vector<std::string>& sources) {
    const TomlTable toy = sensor.table("toy");
    read_source(toy, rule, sources);
    return ToySensor(toy.quantity("dead_time", Dimension::time));
  };
  return {.word = "toy", .table = "toy", .read = read};
}

MaterialDatabase with_sensors(const std::map<std::string, std::string>& sensors) {
  DefinitionModels models;
  models.sensors.add(toy_sensor_model());
  MaterialDatabase database({test::source_file("materials")}, models);
  for (const auto& [name, text] : sensors)
    database.add(DefinitionKind::sensor, {{name, parse_toml(text, "scene.toml")}});
  return database;
}

const std::string kPlainSensor = R"([window]
index = 1.5
[efficiency]
value = 0.3
definition = "internal"
)";
const std::string kToySensor =
    "model = \"toy\"\n" + kPlainSensor + "[toy]\nsource = \"here\"\ndead_time = \"10 ns\"\n";
const std::string kCellTable = "[microcells]\npitch = \"50 um\"\nrecovery = \"20 ns\"\n";

/// Times of the avalanches that photons at these times fire.
std::vector<double> firing_times(const Sensor& sensor, const std::vector<double>& photons_ns) {
  std::vector<Arrival> arrivals;
  for (const double ns : photons_ns) arrivals.push_back({ns});
  Rng rng(1, StreamKind::other, 0);
  std::vector<double> times;
  for (const Avalanche& avalanche : SensorResponse(sensor, {3.0, 3.0}).avalanches(arrivals, 0.0, 100.0, rng))
    times.push_back(avalanche.time_ns);
  return times;
}

}  // namespace

TEST_CASE("A sensor model from outside fires avalanches as a definition names it") {
  const Sensor sensor = with_sensors({{"mine", kToySensor}}).sensor("mine");
  CHECK(sensor.avalanches.get_if<ToySensor>() != nullptr);
  CHECK(sensor.sources == std::vector<std::string>{"toy: here"});
  CHECK(firing_times(sensor, {30.0, 0.0, 9.0, 12.0, 21.0, 22.0}) == std::vector<double>{0.0, 12.0, 22.0});
}

TEST_CASE("Without the key, the sensor model is that of the table that the definition has, or proportional") {
  const MaterialDatabase database =
      with_sensors({{"bare", kPlainSensor},
                    {"cells", kPlainSensor + kCellTable},
                    {"toy", kToySensor.substr(kToySensor.find('\n') + 1)},
                    {"stated", "model = \"proportional\"\n" + kPlainSensor},
                    {"stated_cells", "model = \"microcells\"\n" + kPlainSensor + kCellTable}});
  CHECK(database.sensor("bare").avalanches.get_if<ProportionalModel>() != nullptr);
  CHECK(database.sensor("stated").avalanches.get_if<ProportionalModel>() != nullptr);
  CHECK(microcells_of(database.sensor("cells")).has_value());
  CHECK(microcells_of(database.sensor("stated_cells")).has_value());
  CHECK(database.sensor("toy").avalanches.get_if<ToySensor>() != nullptr);
}

TEST_CASE("An heir's sensor model drops what its base has of another model") {
  const MaterialDatabase database =
      with_sensors({{"cells", kPlainSensor + kCellTable},
                    {"toy", kToySensor},
                    {"plain_heir", "model = \"proportional\"\nbase = \"cells\"\n"},
                    {"cell_heir", "base = \"toy\"\n" + kCellTable},
                    {"toy_heir", "base = \"toy\"\n"}});
  CHECK(database.sensor("plain_heir").avalanches.get_if<ProportionalModel>() != nullptr);
  CHECK(microcells_of(database.sensor("cell_heir")).has_value());
  CHECK(database.sensor("toy_heir").avalanches.get_if<ToySensor>() != nullptr);
}

TEST_CASE("Mistakes in a sensor model are reported where they are") {
  const auto mistakes = [](const std::string& text) {
    return problems_of([&] { with_sensors({{"mine", text}}).sensor("mine"); });
  };
  CHECK(reports(mistakes("model = \"toys\"\n" + kPlainSensor), 1, "\"toy\""));
  CHECK(reports(mistakes("model = \"toy\"\n" + kPlainSensor), 0, "\"toy\""));
  CHECK(reports(mistakes("model = \"proportional\"\n" + kPlainSensor + kCellTable), 7, "microcells"));
  CHECK(reports(problems_of([] { database_with(DefinitionKind::sensor, "mine", kToySensor).sensor("mine"); }),
                1, "\"toy\""));
  SensorModels models;
  models.add(toy_sensor_model());
  CHECK_THROWS_AS(models.add(toy_sensor_model()), InternalError);
}
