#include "exchange_entries.hpp"
#include "require.hpp"

#include <cmath>
#include <stdexcept>

#include "scintray/core/error.hpp"
#include "scintray/tables/davis.hpp"
#include "scintray/tables/geant4_finish.hpp"
#include "scintray/tables/lbnl.hpp"
#include "support/deflated.hpp"

namespace scintray::fuzz {

namespace {

using test::deflated;

constexpr tables::DavisLayout kDavis{2};
constexpr tables::LbnlLayout kLbnl{2, 45, 37};

template <class Read>
bool expect_numbers_or_input_error(Read read) {
  try {
    read();
    return true;
  } catch (const core::InputError& error) {
    require_words(error);
    return false;
  }
}

std::string directions() {
  std::string text;
  for (std::size_t k = 0; k + 1 < kDavis.numbers(); k += 2)
    text += k < kDavis.half() ? "-.3 0.7\n" : "6e-1 2.50\n";
  return text + "0\n";
}

std::string reflectances() {
  std::string text;
  for (int degree = 0; degree < tables::kDavisDegrees; ++degree) text += degree < 30 ? "0.25 " : "+1e0\n";
  return text;
}

bool parse_pair(std::string_view lut, std::string_view shares) {
  return expect_numbers_or_input_error([&] {
    const tables::DavisPair pair =
        tables::parse_davis(lut, shares, {"fuzz", "fuzz", false}, tables::Unreflected::transmitted, kDavis);
    require(pair.reflectances.size() == tables::kDavisDegrees, "a wrong number of reflectances");
    require(pair.directions.size() >= kDavis.numbers() - 1 && pair.directions.size() <= kDavis.numbers(),
            "a wrong number of directions");
    for (const float r : pair.reflectances) require(r >= 0.0f && r <= 1.0f, "a reflectance out of range");
    for (const float angle : pair.directions) require(std::isfinite(angle), "an angle that is not finite");
  });
}

std::string_view view(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

bool run_davis(const std::uint8_t* data, std::size_t size) {
  static const std::string sound = reflectances();
  return parse_pair(view(data, size), sound);
}

bool run_davis_reflectances(const std::uint8_t* data, std::size_t size) {
  static const std::string sound = directions();
  return parse_pair(sound, view(data, size));
}

bool run_lbnl(const std::uint8_t* data, std::size_t size) {
  return expect_numbers_or_input_error([&] {
    const std::vector<float> values = tables::parse_lbnl(view(data, size), "fuzz", kLbnl);
    require(values.size() == kLbnl.numbers(), "a wrong number of values");
    for (const float value : values) require(value >= 0.0f && value <= 1.0f, "a value out of range");
  });
}

bool run_dichroic(const std::uint8_t* data, std::size_t size) {
  return expect_numbers_or_input_error([&] {
    const tables::DichroicTable table = tables::parse_dichroic(view(data, size), "fuzz");
    require(table.transmittance.size() == table.angle_deg.size(), "a wrong number of rows");
    for (const auto& row : table.transmittance) {
      require(row.size() == table.wavelength_nm.size(), "a wrong number of values");
      for (const double share : row) require(share >= 0.0 && share <= 1.0, "a value out of range");
    }
  });
}

std::vector<std::string> dichroic_seeds() { return {"4 3 2\n400 450 500.5\n0 60\n90 50 1e1\n0 100 .5\n"}; }

std::vector<std::string> davis_seeds() { return {directions(), deflated(directions())}; }

std::vector<std::string> davis_reflectance_seeds() { return {reflectances(), deflated(reflectances())}; }

std::vector<std::string> lbnl_seeds() {
  std::string text;
  for (std::size_t k = 0; k < kLbnl.numbers(); ++k) text += k % 7 == 0 ? ".5\n" : "0 ";
  return {text, deflated(text)};
}

}  // namespace scintray::fuzz
