/// Davis pairs that are damaged, of another kind, or made to harm.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <numeric>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/tables/davis.hpp"
#include "support/deflated.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tables;
using test::check_contains;
using test::deflated;

namespace {

/// A small pair as numbers, for damage.
struct Small {
  Small() {
    layout.samples = 3;
    for (int degree = 0; degree < 90; ++degree) reflectances += "0.5\n";
    for (std::size_t k = 0; k + 1 < layout.numbers(); k += 2) {
      const bool reflected = k < layout.half();
      values.insert(values.end(), {"0.3", reflected ? "0.7" : "2.5"});
    }
    values.push_back("0");
  }
  std::string directions() const {
    return std::accumulate(values.begin(), values.end(), std::string(),
                           [](std::string text, const std::string& value) { return text + value + "\n"; });
  }
  std::string message(Unreflected unreflected = Unreflected::transmitted) const {
    return message_of(directions(), unreflected);
  }
  std::string message_of(const std::string& content,
                         Unreflected unreflected = Unreflected::transmitted) const {
    try {
      parse_davis(content, reflectances, {"X_LUT.z", "X_LUTR.z", true}, unreflected, layout);
    } catch (const InputError& error) {
      CHECK(!error.problems().front().where.file.empty());
      CHECK(!error.problems().front().hint.empty());
      return error.problems().front().where.file + ": " + error.problems().front().what;
    }
    return "";
  }

  DavisLayout layout;
  std::vector<std::string> values;
  std::string reflectances;
};

}  // namespace

TEST_CASE("damaged pairs are refused by messages with the place and the fault") {
  CHECK(Small().message().empty());
  {
    Small one_less;  // Geant4's array has one number more than two halves
    one_less.values.pop_back();
    CHECK(one_less.message().empty());
    one_less.values.pop_back();
    check_contains(one_less.message(), fmt::format("{} numbers; expected", one_less.layout.numbers() - 2));
  }
  {
    Small longer;
    longer.values.push_back("1");
    check_contains(longer.message(), "more than 1093 numbers");
  }
  for (const char* word : {"nan", "inf", "-inf", "1e99", "zero", "0x5", "1.2.3", "+-1", "\xFF"}) {
    Small odd;
    odd.values[6] = word;
    check_contains(odd.message(), "as number 7");
  }
  {
    Small tiny;
    tiny.values[0] = "1e-60";
    CHECK(tiny.message().empty());
  }
  {
    Small loud;
    loud.reflectances.replace(0, 3, "1.5");
    check_contains(loud.message(), "X_LUTR.z: reflectance 1.5");
    loud.reflectances = loud.reflectances.substr(4);
    check_contains(loud.message(), "X_LUTR.z: 89 numbers");
  }
  {
    Small degrees;  // angles in degrees
    degrees.values[1] = "45";
    check_contains(degrees.message(), {"-2 pi to 2 pi", "0 to pi"});
  }
  {
    Small through;
    through.values[1] = "2.0";
    check_contains(through.message(), {"reflected direction 1 of 1 deg", "elevation 114.59"});
  }
  {
    Small back;
    back.values[back.layout.transmitted(7) + 3] = "0.9";
    check_contains(back.message(), "transmitted direction 2 of 7 deg");
  }
  {
    Small empty;
    for (std::size_t k = 0; k < empty.layout.block(); ++k)
      empty.values[empty.layout.transmitted(7) + k] = "0";
    check_contains(empty.message(), {"no transmitted direction", "7 deg"});
    CHECK(empty.message(Unreflected::absorbed).empty());
    for (std::size_t k = 0; k < empty.layout.block(); ++k) empty.values[empty.layout.reflected(9) + k] = "0";
    check_contains(empty.message(Unreflected::absorbed), {"no reflected direction", "9 deg"});
  }
}

TEST_CASE("damaged zlib streams, other packings and files that unpack to too much are refused") {
  const Small small;
  const std::string packed = deflated(small.directions());
  CHECK(small.message_of(packed).empty());
  check_contains(small.message_of(packed.substr(0, packed.size() / 2)), {"damaged or truncated", "zlib"});
  check_contains(small.message_of(packed + "more"), "4 bytes after");
  std::string flipped = packed;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 0x55);
  CHECK(!small.message_of(flipped).empty());
  check_contains(small.message_of("\x1f\x8b" + packed), "gzip data");
  check_contains(small.message_of(deflated(std::string(10'000'000, ' '))), "unpacks to more than");
  check_contains(small.message_of(std::string(10'000'000, ' ')), "bytes; expected at most");
  check_contains(small.message_of(""), "0 numbers");
  check_contains(small.message_of(std::string(5000, '1')), "as number 1");
}
