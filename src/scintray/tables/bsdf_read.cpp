#include "scintray/tables/bsdf_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::tables {

namespace {

constexpr std::size_t kMostAngles = 10'000;
constexpr double kGreatestBsdf_per_sr = 1e9;

struct TextWord {
  std::string_view text;
  long line = 0;
};

/// Words of a text, with their lines, without comments.
class Words {
 public:
  Words(std::string_view content, std::string file) : rest_(content), file_(std::move(file)) { next_line(); }

  bool done() const { return line_words_.empty(); }
  TextWord peek() const { return {done() ? std::string_view() : line_words_.substr(0, length()), line_}; }
  TextWord take() {
    const TextWord word = peek();
    if (done()) fail(word, "the file ends here", "it ends with DataEnd");
    line_words_.remove_prefix(length());
    skip_space();
    return word;
  }
  void expect(std::string_view wanted) {
    const TextWord word = take();
    if (word.text != wanted)
      fail(word, fmt::format("\"{}\" is in the place of \"{}\"", shortened(word.text), wanted), kLayout);
  }
  double number(double least, double most, const char* what) {
    const TextWord word = take();
    std::string_view digits = word.text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !(value >= least && value <= most))
      fail(word, fmt::format("\"{}\" is in the place of {}", shortened(word.text), what),
           fmt::format("{} lies between {:g} and {:g}", what, least, most));
    return value;
  }
  [[noreturn]] void fail(const TextWord& at, std::string what, std::string hint) const {
    throw core::InputError({{file_, at.line}, std::move(what), std::move(hint)});
  }

  static constexpr const char* kLayout =
      "the lines are Source, Symmetry, SpectralContent, ScatterType, SampleRotation, AngleOfIncidence, "
      "ScatterAzimuth and ScatterRadial with their angles, Monochrome, DataBegin, blocks that begin with "
      "TIS, "
      "and DataEnd";

 private:
  static constexpr std::string_view kSpace = " \t\r\f\v";

  static std::string shortened(std::string_view text) {
    constexpr std::size_t kMost = 40;
    std::string plain;
    for (const char c : text.substr(0, kMost)) plain += c >= ' ' && c < 127 ? c : '?';
    return plain + (text.size() > kMost ? "..." : "");
  }
  std::size_t length() const { return std::min(line_words_.find_first_of(kSpace), line_words_.size()); }
  void skip_space() {
    const std::size_t next = line_words_.find_first_not_of(kSpace);
    line_words_.remove_prefix(std::min(next, line_words_.size()));
    if (line_words_.empty()) next_line();
  }
  void next_line() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_words_ = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_;
      const std::size_t first = line_words_.find_first_not_of(kSpace);
      if (first == std::string_view::npos || line_words_[first] == '#') continue;
      line_words_.remove_prefix(first);
      return;
    }
    line_words_ = {};
  }

  std::string_view rest_, line_words_;
  std::string file_;
  long line_ = 0;
};

/// Angles after their name and their number, deg, rising.
std::vector<double> read_angles(Words& words, const char* name, double most) {
  words.expect(name);
  const auto count = static_cast<std::size_t>(words.number(1.0, kMostAngles, "the number of angles"));
  std::vector<double> angles;
  for (std::size_t k = 0; k < count; ++k) {
    const TextWord at = words.peek();
    angles.push_back(words.number(-most, most, "an angle, in degrees,"));
    if (k > 0 && !(angles[k] > angles[k - 1]))
      words.fail(at, fmt::format("the angle {:g} of {} follows {:g}", angles[k], name, angles[k - 1]),
                 "angles rise from one to the next");
  }
  return angles;
}

void read_kind(Words& words, Leaving way) {
  words.expect("Source");
  words.take();
  words.expect("Symmetry");
  words.take();
  words.expect("SpectralContent");
  const TextWord spectral = words.peek();
  if (spectral.text == "XYZ")
    words.fail(spectral, "the values are those of an eye (XYZ), not of a wavelength",
               "export the measurement as Monochrome");
  words.expect("Monochrome");
  words.expect("ScatterType");
  const TextWord type = words.peek();
  if (way == Leaving::reflected && type.text == "BTDF")
    words.fail(type, "the values are of transmitted light (BTDF)",
               "a measured BRDF is of reflected light; give the BRDF of the same sample");
  if (way == Leaving::transmitted && type.text == "BRDF")
    words.fail(type, "the values are of reflected light (BRDF)", "give the BTDF of the same sample here");
  words.expect(way == Leaving::reflected ? "BRDF" : "BTDF");
}

/// Sum of a block's values times the projected solid angles of their cells.
double total_of(const Bsdf& bsdf, std::size_t block) {
  const BsdfAngles& angles = bsdf.angles;
  std::vector<double> azimuths;  // of one half, as projected_cells takes them
  for (const double azimuth : angles.azimuth)
    if (azimuth <= 180.0) azimuths.push_back(azimuth);
  constexpr int kParts = 4;
  const std::vector<double> cells =
      projected_cells({{}, azimuths, angles.radial}, angles.specular[block] * core::kDegree, kParts);
  const std::size_t columns = angles.radial.size();
  const double* const values = bsdf.values.data() + block * angles.azimuth.size() * columns;
  double sum = 0.0;
  for (std::size_t k = 0; k < azimuths.size() * columns; ++k) sum += cells[k] * values[k];
  return sum;
}

}  // namespace

Bsdf parse_bsdf(std::string_view content, const std::string& file, Leaving way) {
  Words words(content, file);
  read_kind(words, way);
  const TextWord rotations = words.peek();
  if (read_angles(words, "SampleRotation", 360.0).size() > 1)
    words.fail(rotations, "the values depend on the orientation of the sample",
               "a measured BRDF is of a surface without direction: give one SampleRotation");
  Bsdf bsdf;
  BsdfAngles& angles = bsdf.angles;
  angles.specular = read_angles(words, "AngleOfIncidence", 89.999);
  angles.azimuth = read_angles(words, "ScatterAzimuth", 360.0);
  angles.radial = read_angles(words, "ScatterRadial", 180.0);
  if (angles.specular.front() < 0.0 || angles.azimuth.front() != 0.0 || angles.radial.front() < 0.0)
    words.fail(rotations, "an angle is below 0, or the azimuths do not begin at 0",
               "angles of incidence and radial angles are 0 or more, and azimuths begin at 0");
  words.expect("Monochrome");
  words.expect("DataBegin");
  const std::size_t block = angles.azimuth.size() * angles.radial.size();
  for (std::size_t k = 0; k < angles.specular.size(); ++k) {
    const TextWord at = words.peek();
    words.expect("TIS");
    bsdf.total.push_back(words.number(0.0, 1.0 + 1e-3, "the share of the light that is scattered (TIS)"));
    for (std::size_t i = 0; i < block; ++i)
      bsdf.values.push_back(words.number(0.0, kGreatestBsdf_per_sr, "a value of the BSDF, in 1/sr,"));
    constexpr double kMostDeviation = 0.2;
    const double sum = total_of(bsdf, k);
    if (std::abs(sum - bsdf.total.back()) > kMostDeviation * bsdf.total.back())
      words.fail(at,
                 fmt::format("at {:g} deg the values add up to {:.3g} of the light, but TIS is {:g}",
                             angles.specular[k], sum, bsdf.total.back()),
                 "values are radiance over irradiance, in 1/sr, at angles from the specular ray");
  }
  words.expect("DataEnd");
  return bsdf;
}

std::vector<BrdfPoint> brdf_points(const Bsdf& bsdf) {
  const BsdfAngles& angles = bsdf.angles;
  std::vector<BrdfPoint> points;
  const double* value = bsdf.values.data();
  for (const double specular_deg : angles.specular) {
    const double specular = specular_deg * core::kDegree;
    for (const double azimuth_deg : angles.azimuth)
      for (const double radial_deg : angles.radial) {
        const double azimuth = azimuth_deg * core::kDegree, radial = radial_deg * core::kDegree;
        // From the specular ray, at azimuth 0 towards the normal.
        const double to_normal = std::sin(radial) * std::cos(azimuth);
        const double x = std::cos(radial) * std::sin(specular) - to_normal * std::cos(specular);
        const double z = std::cos(radial) * std::cos(specular) + to_normal * std::sin(specular);
        const double y = std::sin(radial) * std::sin(azimuth);
        constexpr double kHorizon = 1e-6;
        if (*value > 0.0 && z > kHorizon)
          points.push_back({0.0, specular, std::acos(std::min(1.0, z)), std::atan2(std::abs(y), x), *value});
        ++value;
      }
  }
  return points;
}

}  // namespace scintray::tables
