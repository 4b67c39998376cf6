// Pictures of scenes: the numbers of marks.
#include "scintray/report/plots/scene_picture.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "scintray/mesh/shapes/primitives.hpp"

using namespace scintray;
using namespace scintray::report;

namespace {

struct Label {
  double x, y;
  std::string numbers;
};

/// Labels of the marks, which are red.
std::vector<Label> labels_of(const std::string& svg) {
  static const std::regex kLabel(
      "<text x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" fill=\"#b00000\"[^>]*>([0-9,]+)</text>");
  std::vector<Label> labels;
  for (std::sregex_iterator it(svg.begin(), svg.end(), kLabel), end; it != end; ++it)
    labels.push_back({std::stod((*it)[1]), std::stod((*it)[2]), (*it)[3]});
  return labels;
}

}  // namespace

TEST_CASE("Numbers of marks cover no other, and each is there, however dense the marks are") {
  const mesh::TriMesh box = mesh::make_box({-5, -5, -5}, {5, 5, 5});
  std::vector<PictureMark> marks;
  for (int i = 0; i < 40; ++i) {
    // A spiral about the middle, closer than the numbers are wide.
    const double angle = 0.7 * i, radius = 0.02 * i;
    marks.push_back({"gap", {{radius * std::cos(angle), radius * std::sin(angle), 0.05 * i}}});
  }
  const std::vector<Label> labels = labels_of(scene_svg({{"box", "LSO", &box}}, marks));
  std::multiset<int> seen;
  for (const Label& label : labels) {
    std::stringstream list(label.numbers);
    for (std::string number; std::getline(list, number, ',');) seen.insert(std::stoi(number));
  }
  for (int number = 1; number <= 40; ++number)
    CHECK(seen.count(number) == 4);  // in each view, and before its text
  // The widths that the letters take in a bold sans-serif of 13 px, about 7.5 px a digit.
  constexpr double kDigit = 7.5, kHeight = 10.0;
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Label &a = labels[i], &b = labels[k];
      const bool apart = a.x >= b.x + kDigit * static_cast<double>(b.numbers.size()) ||
                         b.x >= a.x + kDigit * static_cast<double>(a.numbers.size()) ||
                         std::abs(a.y - b.y) >= kHeight;
      CAPTURE(a.numbers);
      CAPTURE(b.numbers);
      CHECK(apart);
    }
}
