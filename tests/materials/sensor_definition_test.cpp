// The tables of a sensor's definition beside its efficiency.
#include <fmt/format.h>

#include <fstream>
#include <set>
#include <sstream>

#include "database_helpers.hpp"
#include "scintray/materials/material_forms.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::detector;
using namespace scintray::materials;

namespace {

const std::string kConverter = R"([window]
index = 1.5
[efficiency]
value = 0.3
definition = "internal"
)";

const std::string kEveryTable = kConverter + R"([angle]
factor = { angle = [0, 30, 60], angle_unit = "deg", value = [1, 0.98, 0.9] }
measured_in = "window"
definition = "internal"
[transit_time]
fwhm = "1 ns"
[single_electron]
charge_spread = "40 %"
rise = "0.7 ns"
decay = "3 ns"
[microcells]
pitch = "50 um"
recovery = "20 ns"
crosstalk = "3 %"
afterpulse = 0.01
afterpulse_time = "30 ns"
[dark_counts]
rate_per_mm2 = "50 kHz"
)";

Sensor sensor_of(const std::string& text) {
  return database_with(DefinitionKind::sensor, "mine", text).sensor("mine");
}

std::vector<Problem> mistakes_of(const std::string& text) {
  return problems_of([&] { sensor_of(text); });
}

/// The definition with one table replaced by another text; the line where that begins is returned too.
struct Edited {
  std::string text;
  long line;
};

Edited with_table(const std::string& table, const std::string& body) {
  const auto begin = kEveryTable.find("[" + table + "]");
  const auto end = std::min(kEveryTable.find("\n[", begin) + 1, kEveryTable.size());
  REQUIRE(begin != std::string::npos);
  const std::string before = kEveryTable.substr(0, begin);
  const std::string after =
      kEveryTable.find("\n[", begin) == std::string::npos ? "" : kEveryTable.substr(end);
  return {before + "[" + table + "]\n" + body + after, 1 + std::count(before.begin(), before.end(), '\n')};
}

/// Checks what is stated of a table's body, on its n-th line from 1.
void check_refused(const std::string& table, const std::string& body, long line, const std::string& words) {
  const Edited edited = with_table(table, body);
  CAPTURE(edited.text);
  CHECK(reports(mistakes_of(edited.text), edited.line + line, words));
}

}  // namespace

TEST_CASE("every table of a sensor is read in internal units") {
  const Sensor sensor = sensor_of(kEveryTable);
  REQUIRE(sensor.angle.has_value());
  CHECK(sensor.angle->factor.x().back() == doctest::Approx(60.0 * 3.14159265358979 / 180.0));
  CHECK(sensor.angle_factor(1.5 * 0.5) == doctest::Approx(0.98));
  CHECK(sensor.time_spread_ns == doctest::Approx(1.0 / 2.35482).epsilon(1e-6));
  CHECK(sensor.single_electron.charge_spread == doctest::Approx(0.4));
  CHECK(sensor.single_electron.rise_ns == 0.7);
  CHECK(sensor.single_electron.decay_ns == 3.0);
  const auto cells = microcells_of(sensor);
  REQUIRE(cells.has_value());
  CHECK(cells->pitch_mm == doctest::Approx(0.05));
  CHECK(cells->recovery_ns == 20.0);
  CHECK(cells->crosstalk == doctest::Approx(0.03));
  CHECK(cells->afterpulse == 0.01);
  CHECK(cells->afterpulse_time_ns == 30.0);
  CHECK(sensor.dark_counts.per_ns_mm2 == doctest::Approx(5e-5));
  CHECK(sensor_of(with_table("dark_counts", "rate = \"2 MHz\"\n").text).dark_counts.per_ns ==
        doctest::Approx(2e-3));
  CHECK(microcells_of(sensor_of(with_table("microcells", "count = 14331\nrecovery = \"20 ns\"\n").text))
            ->count == 14331);
  CHECK(sensor_of(with_table("transit_time", "sigma = \"70 ps\"\n").text).time_spread_ns ==
        doctest::Approx(0.07));
}

TEST_CASE("a matched window is read, and refused where a number needs the index of the window") {
  const std::string internal =
      "[efficiency]\nvalue = 0.5\ndefinition = \"internal\"\n[window]\nindex = \"matched\"\n";
  CHECK(sensor_of(internal).window_matched);
  CHECK_FALSE(sensor_of(kConverter).window_matched);
  CHECK(reports(mistakes_of("[efficiency]\nvalue = 0.5\ndefinition = \"external\"\nreference_index = 1.0\n"
                            "[window]\nindex = \"matched\"\n"),
                3, "an external efficiency includes the reflection at the window"));
  CHECK(
      reports(mistakes_of(internal + "[angle]\nfactor = { angle = [0, 60], angle_unit = \"deg\", value = [1, "
                                     "0.9] }\nmeasured_in = \"window\"\ndefinition = \"internal\"\n"),
              7, "needs the index of the window"));
  CHECK(reports(mistakes_of("[efficiency]\nvalue = 0.5\ndefinition = \"internal\"\n[window]\nindex = "
                            "\"glass\"\n"),
                5, "\"glass\" is neither a refractive index nor \"matched\""));
}

TEST_CASE("a sensor without these tables has none of it") {
  const Sensor sensor = sensor_of(kConverter);
  CHECK_FALSE(sensor.angle.has_value());
  CHECK_FALSE(microcells_of(sensor).has_value());
  CHECK(sensor.time_spread_ns == 0.0);
  CHECK(sensor.dark_counts.per_ns + sensor.dark_counts.per_ns_mm2 == 0.0);
  CHECK(sensor.conversion_probability(420.0, 1.4) == 0.3);
}

TEST_CASE("mistakes in a sensor's tables are located and mended") {
  check_refused("transit_time", "fwhm = \"1 ns\"\nsigma = \"1 ns\"\n", 2, "only one of");
  check_refused("transit_time", "sigma = \"-1 ns\"\n", 1, "above 0");
  check_refused("single_electron", "charge_spread = 40\n", 1, "lies between 0 and 3");
  check_refused("single_electron", "decay = \"-3 ns\"\n", 1, "cannot be negative");
  check_refused("microcells", "recovery = \"20 ns\"\n", 0, "pitch");
  check_refused("microcells", "pitch = \"50 um\"\n", 0, "\"recovery\"");
  check_refused("microcells", "count = 0\nrecovery = \"20 ns\"\n", 1, "1 to 10^8 cells");
  check_refused("microcells", "count = 10\nrecovery = \"0 ns\"\n", 2, "above 0");
  check_refused("microcells", "count = 10\nrecovery = \"2 ns\"\ncrosstalk = 3\n", 3, "between 0 and 60 %");
  check_refused("microcells", "count = 10\nrecovery = \"2 ns\"\nafterpulse = 0.1\n", 0, "afterpulse_time");
  check_refused("dark_counts", "rate = \"2 mm\"\n", 1, "kHz");
  check_refused("dark_counts", "rate = \"2000 GHz\"\n", 1, "between 0 and 1 GHz");
}

TEST_CASE("a dependence on angle that cannot be is refused") {
  const std::string end = "measured_in = \"window\"\ndefinition = \"internal\"\n";
  const auto factor = [](const std::string& angles, const std::string& values) {
    return "factor = { angle = [" + angles + "], angle_unit = \"deg\", value = [" + values + "] }\n";
  };
  check_refused("angle", "factor = 0.9\n" + end, 1, "needs angles");
  check_refused("angle", factor("0, 60", "2, 0.9") + end, 1, "must begin at 0 deg with 1");
  check_refused("angle", factor("10, 60", "1, 0.9") + end, 1, "must begin at 0 deg with 1");
  check_refused("angle", factor("0, 95", "1, 0.9") + end, 1, "below 90 deg");
  check_refused("angle", factor("0, 60", "1, -0.1") + end, 1, "cannot be negative");
  check_refused("angle", factor("0, 60", "1, 4") + end, 1, "more photons are converted than enter");
  check_refused("angle", factor("0, 60", "1, 0.9") + "definition = \"internal\"\n", 0, "measured_in");
  check_refused("angle", factor("0, 60", "1, 0.9") + "measured_in = \"outside\"\ndefinition = \"internal\"\n",
                0, "reference_index");
  // Light from air is bent to 41.8 deg at most in this window.
  check_refused("angle",
                factor("0, 50", "1, 0.9") +
                    "measured_in = \"window\"\ndefinition = \"external\"\nreference_index = 1.0\n",
                1, "cannot come into the window");
}

TEST_CASE("an external dependence on angle has its Fresnel loss divided out, in either angle") {
  const std::string angle = R"(factor = { angle = [0, 60], angle_unit = "deg", value = [1, 0.8] }
measured_in = "outside"
definition = "external"
reference_index = 1.0
)";
  const Sensor sensor = sensor_of(with_table("angle", angle).text);
  // Air to 1.5 at 60 deg: reflectances 0.1770 and 0.0018, by Born & Wolf 1.5.2 (21) in numbers.
  const double cos_t = std::sqrt(1.0 - 0.75 / 2.25);
  const double s = (0.5 - 1.5 * cos_t) / (0.5 + 1.5 * cos_t), p = (0.75 - cos_t) / (0.75 + cos_t);
  const double entering = 1.0 - 0.5 * (s * s + p * p), at_normal = 1.0 - 0.04;
  const double sine = std::sqrt(0.75);
  CHECK(sensor.angle_factor(sine) == doctest::Approx(0.8 * at_normal / entering).epsilon(1e-12));
  CHECK(sensor.angle_factor(0.0) == doctest::Approx(1.0));
  // Beyond the table, and where no light from air could be.
  CHECK(sensor.angle_factor(0.95) == doctest::Approx(sensor.angle_factor(sine)).epsilon(1e-12));
  CHECK(sensor.angle_factor(1.3) == doctest::Approx(sensor.angle_factor(sine)).epsilon(1e-12));
  CHECK(sensor.conversion_probability(420.0, sine) ==
        doctest::Approx(0.3 * 0.8 * at_normal / entering).epsilon(1e-12));
}

TEST_CASE("a sensor with a base takes over the tables that it does not have, with the sources of its own") {
  MaterialDatabase database = shipped_database();
  database.add(
      DefinitionKind::sensor,
      {{"mine", parse_toml("base = \"S13360_6050VE\"\n[microcells]\ncount = 10\nrecovery = \"5 ns\"\n"
                           "[dark_counts]\nrate = \"3 MHz\"\n",
                           "scene.toml")},
       {"circle", parse_toml("base = \"round\"\n", "scene.toml")},
       {"round", parse_toml("base = \"circle\"\n", "scene.toml")},
       {"lost", parse_toml("base = \"S13360\"\n", "scene.toml")},
       {"wrong", parse_toml("base = 3\n", "scene.toml")}});
  const Sensor base = database.sensor("S13360_6050VE"), heir = database.sensor("mine");
  CHECK(heir.efficiency.y() == base.efficiency.y());
  CHECK(heir.window_index == base.window_index);
  const auto cells = microcells_of(heir);
  REQUIRE(cells.has_value());
  CHECK(cells->count == 10);
  CHECK(heir.dark_counts.per_ns == doctest::Approx(3e-3));
  CHECK(heir.dark_counts.per_ns_mm2 == 0.0);
  CHECK(reports(problems_of([&] { database.sensor("circle"); }), 1,
                "is based on itself (circle, round, circle)"));
  CHECK(reports(problems_of([&] { database.sensor("lost"); }), 1, "there is no sensor \"S13360\""));
  CHECK(reports(problems_of([&] { database.sensor("wrong"); }), 1, "\"base\""));
}

TEST_CASE("docs/materials.md has every key of a sensor, and no other") {
  Problems ignored;
  std::set<std::string> read;
  for (const std::string& text :
       {kEveryTable, with_table("angle", "definition = \"external\"\n").text,
        std::string(
            "[window]\n[efficiency]\ndefinition = \"external\"\n[photocathode]\n[uniformity]\nmap = {}\n"),
        std::string("[efficiency]\n[uniformity]\nradial = 1\n")}) {
    const TomlTable table(parse_toml(text, "scene.toml"), ignored);
    read_sensor(table, "mine", SourceRule::optional);
    for (const std::string& key : table.known_keys())
      if (key.find('.') != std::string::npos && key.find("factor.") == std::string::npos) read.insert(key);
  }
  for (const char* block : {"efficiency", "window", "photocathode", "angle", "uniformity", "transit_time",
                            "single_electron", "microcells", "dark_counts"})
    CHECK(read.erase(std::string(block) + ".source") == 1);  // one row for all of them

  const std::string text = read_text_file(test::source_file("docs/materials.md"));
  const auto begin = text.find("## Sensors");
  std::istringstream lines(text.substr(begin, text.find("\n## ", begin) - begin));
  std::set<std::string> documented;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `[", 0) != 0) continue;
    std::string cell = line.substr(0, line.find('|', 1));
    const std::string block = cell.substr(4, cell.find(']') - 4);
    cell = cell.substr(cell.find(']') + 1);
    for (const char* mark : {"`", ",", "|"})
      for (auto at = cell.find(mark); at != std::string::npos; at = cell.find(mark)) cell[at] = ' ';
    std::istringstream words(cell);
    for (std::string word; words >> word;) documented.insert(block + "." + word);
  }
  CHECK(documented == read);
}

TEST_CASE("No efficiency at any angle or wavelength exceeds the sensor's bound") {
  for (const char* definition : {"internal", "external"})
    for (const char* measured_in : {"window", "outside"}) {
      const std::string text = fmt::format(
          R"([window]
index = 1.5
[efficiency]
value = {{ wavelength = [300, 400, 450, 700], wavelength_unit = "nm", value = [0.1, 0.3, 0.25, 0.02] }}
definition = "internal"
[angle]
factor = {{ angle = [0, 20, 35], angle_unit = "deg", value = [1, 1.05, 0.9] }}
measured_in = "{}"
definition = "{}"
reference_index = 1.0
)",
          measured_in, definition);
      CAPTURE(text);
      const Sensor sensor = sensor_of(text);
      for (const auto& [low, high] :
           {std::pair{310.0, 390.0}, std::pair{350.0, 480.0}, std::pair{500.0, 500.0}}) {
        const double bound = sensor.conversion_bound(low, high);
        double largest = 0.0;
        for (int i = 0; i <= 60; ++i)
          for (int j = 0; j <= 300; ++j)
            largest = std::max(largest,
                               sensor.conversion_probability(low + (high - low) * i / 60.0, 1.5 * j / 300.0));
        CHECK(largest <= bound);
        CHECK(largest > 0.85 * bound);  // and it is not far above
      }
    }
}

TEST_CASE("a photocathode has the probability of escape that its efficiency requires") {
  const std::string film = "[photocathode]\nn = 2.7\nk = 1.5\nthickness = \"26 nm\"\n";
  const std::string table =
      "value = { wavelength = [400, 500], wavelength_unit = \"nm\", value = [0.25, 0.1] }\n";
  const Sensor sensor =
      sensor_of("[window]\nindex = 1.47\n[efficiency]\ndefinition = \"internal\"\n" + table + film);
  REQUIRE(sensor.cathode.has_value());
  CHECK(sensor.converts == ConvertedLight::absorbed);
  for (const auto& [nm, efficiency] : {std::pair{400.0, 0.25}, std::pair{500.0, 0.1}})
    CHECK(sensor.conversion_probability(nm) * film_absorptance(sensor.cathode->film, 1.47, 1.0, 1.0, nm) ==
          doctest::Approx(efficiency).epsilon(1e-12));
  double highest = 0.0;
  for (double nm = 390.0; nm < 510.0; nm += 0.5)
    highest = std::max(highest, sensor.conversion_probability(nm));
  CHECK(sensor.conversion_bound(390.0, 510.0) == highest);
  const Sensor absorbed = sensor_of("[efficiency]\ndefinition = \"absorbed\"\nvalue = 0.6\n" + film);
  CHECK(absorbed.conversion_probability(420.0) == 0.6);

  const std::string internal = "[efficiency]\nvalue = 0.25\ndefinition = \"internal\"\n";
  const std::string window = "[window]\nindex = 1.47\n";
  const auto refused = [](const std::string& text, long line, const std::string& words) {
    CAPTURE(words);
    CHECK(reports(mistakes_of(text), line, words));
  };
  refused(internal + film, 4, "needs the index of the window");
  refused(internal + "[window]\nindex = \"matched\"\n" + film, 4, "lies on a window of a known index");
  refused(window + "[efficiency]\nvalue = 0.25\ndefinition = \"absorbed\"\n", 5, "needs the film");
  refused("converts = \"both\"\n" + window + internal + film, 1, "and no other");
  refused(window + internal + "[photocathode]\nn = 2.7\nk = 0\nthickness = \"26 nm\"\n", 8, "lies above 0");
  refused(window + internal + "[photocathode]\nn = 2.7\nk = 1\nthickness = \"26 um\"\n", 9, "up to 1 um");
  refused(window + internal + film +
              "[angle]\nfactor = { angle = [0, 60], angle_unit = \"deg\", value = [1, 0.9] }\nmeasured_in = "
              "\"window\"\ndefinition = \"internal\"\n",
          10, "follows from the film");
  refused(window + "[efficiency]\nvalue = 0.5\ndefinition = \"internal\"\n" +
              "[photocathode]\nn = 2.7\nk = 0.1\nthickness = \"5 nm\"\n",
          4, "less than this efficiency");
}

TEST_CASE("an efficiency over the face is read, and bounds the efficiency") {
  const auto path = test::scratch_folder("sensor_face") / "map.csv";
  const auto grid = [&](const std::string& rows) {
    std::ofstream(path) << rows;
    return kConverter + "[uniformity]\nmap = { file = \"" + path.string() + "\", unit = \"cm\" }\n";
  };
  const Sensor sensor = sensor_of(grid("y,x,factor\n0,0,1\n0,2,0.5\n1,2,0.25\n1,0,2\n"));
  REQUIRE(sensor.over_face.has_value());
  CHECK(sensor.over_face->at(20.0, 0.0) == 0.5);
  CHECK(sensor.over_face->at(0.0, 10.0) == 2.0);
  CHECK(sensor.over_face->at(10.0, 5.0) == doctest::Approx((1.0 + 0.5 + 0.25 + 2.0) / 4.0));
  CHECK(sensor.over_face->at(-50.0, 40.0) == 2.0);  // beyond the grid: its border
  CHECK(sensor.conversion_bound(400.0, 500.0) == doctest::Approx(0.6));
  const std::string radial = kConverter +
                             "[uniformity]\nradial = { length = [0, 20], length_unit = \"mm\", value = [1.2, "
                             "0.4] }\n";
  CHECK(sensor_of(radial).over_face->at(3.0, 4.0) == doctest::Approx(1.0));
  CHECK(sensor_of(radial).conversion_bound(400.0, 500.0) == doctest::Approx(0.36));

  const auto refused = [](const std::string& text, const std::string& words) {
    CAPTURE(words);
    CHECK(reports(mistakes_of(text), 7, words));
  };
  refused(grid("x,y,factor\n0,0,1\n0,1,1\n1,0,1\n"), "has none at (1, 1)");
  refused(grid("x,y,factor\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n1,1,2\n"), "(1, 1) occurs twice");
  refused(grid("x,y,factor\n0,0,1\n0,1,1\n1,0,-1\n1,1,1\n"), "map.csv:4: the factor is -1");
  refused(grid("x,y,factor\n0,0,1\n0,1,1\n0,3,1\n1,0,1\n1,1,1\n1,3,1\n"), "not equally spaced");
  refused(grid("x,y,factor\n0,0,1\n0,1,1\n"), "all values of \"x\" are the same");
  refused(grid("x,y,factor\n0,0,4\n0,1,1\n1,0,1\n1,1,1\n"), "more photons are converted than arrive");
  refused(grid("x,y,share\n0,0,4\n0,1,1\n1,0,1\n1,1,1\n"), "factor");
  refused(kConverter + "[uniformity]\nradial = 0.9\n", "needs distances");
}
