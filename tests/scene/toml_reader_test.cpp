#include "scintray/config/toml_reader.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "bad_input/marked_text.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::test;

namespace {

struct Reading {
  Problems problems;
  TomlTable table;
  explicit Reading(const std::string& text, const std::string& file = "file.toml")
      : table(parse_toml(text, file), problems) {}
};

/// Expects one problem, at the mark, in what `read` does with the marked text.
template <typename Read>
void check_reading(const std::string& marked, Read read, const Fragments& what, const Fragments& hint) {
  const MarkedText input(marked);
  Reading reading(input.text);
  read(reading.table);
  check_one_problem(input, reading.problems.list(), what, hint);
}

}  // namespace

TEST_CASE("every dimension is read in its internal unit") {
  Reading reading(R"(
length = "2 cm"
inverse = "0.5 1/cm"
wavelength = "2.0 eV"
time = "3 us"
angle = "180 deg"
energy = "0.511 MeV"
density = "7.4 g/cm3"
yield = "25000 photons/MeV"
share = "97 %"
plain = 0.97
)");
  const TomlTable& table = reading.table;
  CHECK(table.quantity("length", Dimension::length) == doctest::Approx(20.0));
  CHECK(table.quantity("inverse", Dimension::inverse_length) == doctest::Approx(0.05));
  CHECK(table.quantity("wavelength", Dimension::wavelength) == doctest::Approx(kHc_eV_nm / 2.0));
  CHECK(table.quantity("time", Dimension::time) == doctest::Approx(3000.0));
  CHECK(table.quantity("angle", Dimension::angle) == doctest::Approx(kPi));
  CHECK(table.quantity("energy", Dimension::energy) == doctest::Approx(511.0));
  CHECK(table.quantity("density", Dimension::density) == doctest::Approx(7.4));
  CHECK(table.quantity("yield", Dimension::photons_per_energy) == doctest::Approx(25.0));
  CHECK(table.quantity("share", Dimension::dimensionless) == doctest::Approx(0.97));
  CHECK(table.quantity("plain", Dimension::dimensionless) == doctest::Approx(0.97));
  table.finish();
  CHECK(reading.problems.empty());
}

TEST_CASE("a bare number is refused in every dimension that has a unit") {
  for (const Dimension dimension :
       {Dimension::length, Dimension::inverse_length, Dimension::wavelength, Dimension::time,
        Dimension::angle, Dimension::energy, Dimension::density, Dimension::photons_per_energy}) {
    check_reading(
        "x = @@5", [&](const TomlTable& table) { CHECK(table.quantity("x", dimension) == 0.0); }, "but a",
        "write it as a string with its unit, as \"5 ");
  }
}

TEST_CASE("the quantity that is expected has a number that it may have") {
  check_reading(
      "x = @@5", [](const TomlTable& table) { table.quantity("x", Dimension::wavelength); },
      "a wavelength with its unit, as \"420 nm\"", "unit");
  check_reading(
      "x = @@5", [](const TomlTable& table) { table.quantity("x", Dimension::angle); },
      "an angle with its unit, as \"30 deg\"", "unit");
}

TEST_CASE("a bare number gets the units that its size allows") {
  const auto hint = [](const std::string& number, Dimension dimension) {
    Reading reading("x = " + number);
    reading.table.quantity("x", dimension);
    REQUIRE(reading.problems.list().size() == 1);
    return reading.problems.list().front().hint;
  };
  const std::string nm = hint("1_050", Dimension::wavelength), eV = hint("2.95", Dimension::wavelength),
                    um = hint("0.42", Dimension::wavelength), any = hint("50", Dimension::wavelength);
  check_contains(nm, "nm\"");
  CHECK_FALSE(contains(nm, "eV"));
  check_contains(eV, {"\"2.95 eV\"", "photon energy"});
  CHECK_FALSE(contains(eV, "nm\""));
  check_contains(um, {"\"0.42 um\"", "\"0.42 eV\""});
  check_contains(any, {"\"50 nm\"", "\"50 eV\""});
  check_contains(hint("0.17", Dimension::angle), {"\"0.17 deg\"", "\"0.17 rad\""});
  check_contains(hint("-90", Dimension::angle), "\"-90 deg\"");
  CHECK_FALSE(contains(hint("-90", Dimension::angle), "rad"));
}

TEST_CASE("a table that is missing is reported once, not once for each key in it") {
  check_reading(
      "@@x = 1",
      [](const TomlTable& table) {
        table.integer("x");
        table.table("source").quantity("gap", Dimension::length);
        table.finish();
      },
      "has no \"source\"", "add source");
}

TEST_CASE("a wrong value is not also reported as out of range") {
  check_reading(
      "x = @@\"5 kg\"",
      [](const TomlTable& table) {
        const double x = table.quantity("x", Dimension::length);
        table.expect("x", x > 0.0, "not positive");
      },
      {"not a unit", "length"}, "mm");
}

TEST_CASE("curves in each form are the same") {
  const std::filesystem::path folder = scratch_folder("toml_reader_curves");
  std::ofstream(folder / "n.csv") << "# measured\nn, lambda\n1.82, 400\n1.80, 500\n";
  Reading reading(R"(
a = { wavelength = ["400 nm", "0.5 um"], value = [1.82, 1.80] }
b = { wavelength = [400, 500], wavelength_unit = "nm", value = ["182 %", "180 %"] }
c = { file = "n.csv", wavelength_unit = "nm", wavelength_column = "lambda", value_column = "n" }
d = { wavelength = ["500 nm", "400 nm"], value = [180, 182], value_unit = "%" }
)",
                  (folder / "file.toml").string());
  for (const char* key : {"a", "b", "c", "d"}) {
    INFO(key);
    const Curve curve = reading.table.curve(key, Dimension::dimensionless);
    REQUIRE(curve.x().size() == 2);
    CHECK(curve.x()[0] == doctest::Approx(400.0));
    CHECK(curve(450.0) == doctest::Approx(1.81));
  }
  reading.table.finish();
  for (const Problem& problem : reading.problems.list()) INFO(problem.text());
  CHECK(reading.problems.empty());
}

TEST_CASE("photon energies, which rise while wavelengths fall, make a curve") {
  Reading reading("a = { wavelength = [2.0, 3.0], wavelength_unit = \"eV\", value = [\"1 m\", \"2 m\"] }");
  const Curve curve = reading.table.curve("a", Dimension::length);
  REQUIRE(curve.x().size() == 2);
  CHECK(curve.x()[0] == doctest::Approx(kHc_eV_nm / 3.0));
  CHECK(curve.y()[0] == doctest::Approx(2000.0));
  CHECK(curve.y()[1] == doctest::Approx(1000.0));
}

TEST_CASE("wrong curves") {
  const auto read = [](const TomlTable& table) { table.curve("a", Dimension::dimensionless); };
  check_reading("a = @@{ wavelength = [\"400 nm\", \"500 nm\"], value = [1.8] }", read,
                {"2 values", "wavelength", "1"}, "one value for every");
  check_reading("a = { wavelength = [\"400 nm\", \"500 nm\", @@\"450 nm\"], value = [1, 2, 3] }", read,
                "not in order", "sort");
  check_reading("a = { wavelength = [\"400 nm\", @@\"400 nm\"], value = [1, 2] }", read, "not in order",
                "each once");
  check_reading("a = { wavelength = [\"400 nm\", @@\"5 ns\"], value = [1, 2] }", read,
                {"not a unit", "wavelength"}, "nm");
  check_reading("a = { wavelength = [400], wavelength_unit = @@\"mm\", value = [1] }", read, "not a unit",
                "nm");
  check_reading("a = @@[1, 2]", read, {"an array", "one value", "table"}, "value = [...]");
  check_reading("a = @@{ value = [1, 2] }\n", read, "none of \"wavelength\", \"file\"", "add one");
  check_reading("a = { file = @@\"no.csv\", wavelength_unit = \"nm\" }", read, "\"no.csv\" does not exist",
                "relative");
}

TEST_CASE("every bad row of a CSV table is reported at its line and column") {
  const std::filesystem::path folder = scratch_folder("toml_reader_csv");
  std::ofstream(folder / "n.csv") << "lambda,n\n400,1.8\n450, x\n500\n550,1.7\n";
  Reading reading("a = { file = \"n.csv\", wavelength_unit = \"nm\" }", (folder / "file.toml").string());
  reading.table.curve("a", Dimension::dimensionless);
  const std::vector<Problem>& found = reading.problems.list();
  REQUIRE(found.size() == 2);
  CHECK(found[0].where.text() == (folder / "n.csv").string() + ":3:6");
  check_contains(found[0].what, {"\"x\"", "not a finite number"});
  CHECK(found[1].where.text() == (folder / "n.csv").string() + ":4:1");
  check_contains(found[1].what, {"1 values", "2"});
}

TEST_CASE("places of keys and values, however they are written") {
  const TomlNodePtr root = parse_toml("[a.b]\nc.d = 'x'\n\"e f\" = [\n  2, 3]\n[[g]]\nh = {i = 1}\n", "f");
  const TomlNode* b = root->find("a")->find("b");
  CHECK(b->where.text() == "f:1:1");
  const TomlNode* d = b->find("c")->find("d");
  CHECK(d->key_where.text() == "f:2:3");
  CHECK(d->where.text() == "f:2:7");
  const TomlNode* ef = b->find("e f");
  CHECK(ef->key_where.text() == "f:3:1");
  CHECK(ef->items[1].where.text() == "f:4:6");
  const TomlNode& g = root->find("g")->items[0];
  CHECK(g.where.text() == "f:5:1");
  CHECK(g.find("h")->find("i")->key_where.text() == "f:6:6");
}

namespace {

enum class Shade { dark, light };
constexpr Word<Shade> kShades[] = {{"dark", Shade::dark}, {"light", Shade::light}, {"pale", Shade::light}};

}  // namespace

TEST_CASE("words and the values that they stand for") {
  CHECK(find_word(kShades, "light") == Shade::light);
  CHECK(find_word(kShades, "pale") == Shade::light);
  CHECK_FALSE(find_word(kShades, "Light").has_value());
  CHECK_FALSE(find_word(kShades, "").has_value());
  CHECK(word_of(kShades, Shade::light) == std::string("light"));
  CHECK_THROWS_AS(static_cast<void>(word_of(kShades, static_cast<Shade>(7))), InternalError);
  CHECK(word_list(kShades) == std::vector<std::string>{"dark", "light", "pale"});
}

TEST_CASE("a choice of words returns the value of the word") {
  Reading reading("a = 'pale'");
  CHECK(reading.table.choice("a", kShades) == Shade::light);
  CHECK(reading.table.choice("a", kShades, Shade::dark) == Shade::light);
  CHECK(reading.table.choice("b", kShades, Shade::light) == Shade::light);
  CHECK(reading.problems.empty());
  CHECK(reading.table.choice("b", kShades) == Shade::dark);
  CHECK(reading.problems.list().size() == 1);

  // The same messages as for words alone.
  check_reading(
      "a = @@'lihgt'", [](const TomlTable& table) { table.choice("a", kShades); },
      {"\"dark\", \"light\", \"pale\"", "is expected"}, "did you mean \"light\"?");
  check_reading(
      "a = @@2", [](const TomlTable& table) { table.choice("a", kShades, Shade::light); },
      {"the integer 2", "\"dark\""}, "in quotes");
}

TEST_CASE("one of several keys stands for a value") {
  Reading reading("pale = 1");
  const Word<Shade>* one = reading.table.one_of(kShades, true);
  REQUIRE(one != nullptr);
  CHECK(one->word == std::string("pale"));
  CHECK(one->value == Shade::light);
  Reading none("");
  CHECK(none.table.one_of(kShades, false) == nullptr);
  CHECK(none.problems.empty());
  CHECK(none.table.one_of(kShades, true) == nullptr);
  CHECK(none.problems.list().size() == 1);
}

TEST_CASE("whether a value is an array") {
  const Reading reading("a = [1, 2]\nb = 1");
  CHECK(reading.table.is_array("a"));
  CHECK_FALSE(reading.table.is_array("b"));
  CHECK_FALSE(reading.table.is_array("c"));
}

TEST_CASE("a long list on one line is refused where reading it would take minutes") {
  std::string list, lines;
  for (int i = 0; i < 16'000; ++i) list += "{ name = \"a\", at = 1 }, ";
  for (int i = 0; i < 16'000; ++i) lines += "{ name = \"a\", at = 1 },\n";
  const MarkedText one("a = 1\n@@rows = [" + list + "]\n");
  const auto problems = problems_of([&] { Reading reading(one.text); });
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].where.line == 2);
  CHECK(contains(problems[0].hint, "several lines"));
  const MarkedText many("a = 1\nrows = [@@" + lines + "]\n");
  Reading reading(many.text);
  CHECK(reading.table.node()->find("rows")->items.size() == 16'000);
}

TEST_CASE("places in a long line count characters, not bytes") {
  std::string list;
  const int values = 2'000;
  for (int i = 0; i < values; ++i) list += "{ name = \"µm\", at = 1 }, ";
  const MarkedText input("rows = [" + list + "{ name = @@7 }]\n");
  Reading reading(input.text);
  const TomlNode* rows = reading.table.node()->find("rows");
  REQUIRE(rows->items.size() == values + 1);
  const std::size_t each = std::string_view("{ name = \"m\", at = 1 }, ").size() + 1;
  CHECK(rows->items[1].where.column == static_cast<long>(10 + each - 1));
  CHECK(rows->items[values].where.column == static_cast<long>(9 + values * each));
  CHECK(rows->items[values].where.line == 1);
}
