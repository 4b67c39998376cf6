#include <fmt/format.h>

#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/tables/geant4_finish.hpp"
#include "scintray/tables/number_text.hpp"

namespace scintray::tables {

namespace {

constexpr const char* kFormat =
    "expected: a number, the numbers of wavelengths and of angles, the wavelengths (nm), the angles (deg), "
    "and "
    "for each angle the transmittance (percent) at every wavelength";

constexpr std::size_t kHead = 3;
constexpr NumberCount kCount{kHead + 2 + 2 + 4, 10'000'000};

/// A size of the table, a whole number from 2 on.
std::size_t size_of(float number, const char* of, const std::string& file) {
  constexpr float kMost = 1e6F;
  if (!(number >= 2.0F && number <= kMost) || number != std::floor(number))
    throw core::InputError(
        core::Problem{{file}, fmt::format("{} {} where 2 or more are expected", number, of), kFormat});
  return static_cast<std::size_t>(number);
}

/// `count` numbers that rise from above or at `least`, up to `most`.
std::vector<double> rising(const float* from, std::size_t count, double least, double most,
                           const core::Problem& otherwise) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = from[i];
    if (value < least || value > most || (i > 0 && !(value > values.back()))) {
      core::Problem problem = otherwise;
      problem.what += fmt::format("; number {} is {:g}", i + 1, value);
      throw core::InputError(std::move(problem));
    }
    values.push_back(value);
  }
  return values;
}

}  // namespace

DichroicTable read_dichroic(const std::filesystem::path& file) {
  return parse_dichroic(load_number_file(file, kCount), file.string());
}

DichroicTable parse_dichroic(std::string_view content, const std::string& file) {
  const std::vector<float> numbers = parse_numbers(content, file, kCount);
  const std::size_t wavelengths = size_of(numbers[1], "wavelengths", file),
                    angles = size_of(numbers[2], "angles", file);
  if (const std::size_t expected = kHead + wavelengths + angles + wavelengths * angles;
      numbers.size() != expected)
    throw core::InputError(
        core::Problem{{file},
                      fmt::format("{} wavelengths and {} angles need {} numbers, but the file has {}",
                                  wavelengths, angles, expected, numbers.size()),
                      kFormat});
  DichroicTable table;
  const float* next = numbers.data() + kHead;
  table.wavelength_nm = rising(next, wavelengths, 1.0, 1e6,
                               {{file}, "wavelengths (nm) have to rise, from 1 to 1000000", kFormat});
  next += wavelengths;
  table.angle_deg =
      rising(next, angles, 0.0, 90.0, {{file}, "angles (deg) have to rise, from 0 to 90", kFormat});
  next += angles;
  for (std::size_t row = 0; row < angles; ++row) {
    std::vector<double>& shares = table.transmittance.emplace_back();
    for (std::size_t column = 0; column < wavelengths; ++column, ++next) {
      if (!(*next >= 0.0F && *next <= 100.0F))
        throw core::InputError(core::Problem{
            {file},
            fmt::format("the transmittance at {:g} nm and {:g} deg is {:g}, not between 0 and 100 percent",
                        table.wavelength_nm[column], table.angle_deg[row], *next),
            kFormat});
      shares.push_back(0.01 * static_cast<double>(*next));
    }
  }
  return table;
}

}  // namespace scintray::tables
