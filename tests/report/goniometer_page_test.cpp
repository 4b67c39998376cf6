#include "scintray/report/pages/pages.hpp"

#include <doctest/doctest.h>

#include "scintray/report/plots/detail/hemisphere_map.hpp"
#include "scintray/report/plots/goniometer_plots.hpp"
#include "scintray/report/plots/png_image.hpp"
#include "support/page_scripts.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::analysis;
using namespace scintray::report;
using namespace scintray::report;

namespace {

SampleSurface flat_sample() {
  SampleSurface sample;
  sample.place = {"flat <& \"clean\"", "LSO", "air", 420.0};
  sample.index = {1.82, 1.0};
  sample.sources = {"M. Born & E. Wolf"};
  return sample;
}

GoniometerReading reading(double degrees) {
  GoniometerSettings settings;
  settings.incidence_rad = degrees * kDegree;
  settings.wavelength_nm = 420.0;
  settings.rays = 20'000;
  return read_goniometer(Surface{}, {1.82, 1.0}, settings);
}

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

}  // namespace

TEST_CASE("the goniometer's page shows a map for each side that light leaves on, and escapes its text") {
  const std::string page = goniometer_page(flat_sample(), {reading(20.0), reading(45.0)}, std::nullopt);
  CHECK(times(page, "data:image/png;base64,") == 3);  // total reflection at 45 deg
  CHECK(times(page, "class=\"cross\"") == 3);
  CHECK(page.find("flat <&") == std::string::npos);
  CHECK(page.find("flat &lt;&amp; &quot;clean&quot;") != std::string::npos);
  CHECK(page.find("M. Born &amp; E. Wolf") != std::string::npos);
  CHECK(test::scripts_of(page).page.find("nan") == std::string::npos);
}

TEST_CASE("a measurement on the page has its normalisation") {
  const GoniometerReading at_20 = reading(20.0);
  MeasuredProfile measured;
  measured.angle_deg = {10.0, 20.5, 30.0};
  measured.value = {1.0, 50.0, 1.0};
  const Overlay overlay{scale_to(measured, at_20.reflected_directions, at_20.settings.rays,
                                 at_20.settings.profile_half_width_rad),
                        "bench <1>.csv"};
  const std::string page = goniometer_page(flat_sample(), {at_20}, overlay);
  CHECK(page.find("measured: bench &lt;1&gt;.csv") != std::string::npos);
  CHECK(page.find("between 10 and 30 deg (trapezoids over the measured angles)") != std::string::npos);
  CHECK(overlay_text(overlay).find("was multiplied by") == 16);
}

TEST_CASE(
    "a map of directions has its brightest colour where the light is, to the right when it is forward") {
  DirectionCounts forward, backward;
  for (int k = 0; k < 100; ++k) {
    forward.add(0.8, 0.0, 0.6, 0.1);
    backward.add(-0.8, 0.0, 0.6, 0.1);
  }
  const std::string right = hemisphere_map(forward, 1000, -1.0, "x"),
                    left = hemisphere_map(backward, 1000, -1.0, "x");
  CHECK(right != left);
  CHECK(right.find("class=\"cross\"") == std::string::npos);
  CHECK(hemisphere_map(forward, 1000, 0.5, "x").find("class=\"cross\"") != std::string::npos);
  const Colour low = viridis(-1.0), high = viridis(2.0);
  CHECK(static_cast<int>(low.red) == 68);
  CHECK(static_cast<int>(high.red) == 253);
  CHECK(hemisphere_map(DirectionCounts{}, 1000, -1.0, "no light").find("nan") == std::string::npos);
}

TEST_CASE("a plot as a file stands alone; axes, dashes and loose points are drawn as requested") {
  Plot plot = incidence_plot("R", "reflectance");
  plot.series.push_back(fresnel_series("Fresnel", 1.82, 1.0));
  plot.series.push_back({"measured", {10.0, 20.0}, {0.1, 0.2}, {}});
  plot.series.back().joined = false;
  const std::string drawing = svg_file(plot);
  CHECK(drawing.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\"", 0) == 0);
  CHECK(times(drawing, "class=\"curve dashed\"") == 2);  // the curve and its name's line
  CHECK(times(drawing, "class=\"curve\"") == 0);
  CHECK(times(drawing, "class=\"mark\"") == 3);  // two points and the name's
  for (const char* tick : {">0<", ">15<", ">90<"}) CHECK(drawing.find(tick) != std::string::npos);
  CHECK(drawing.find(">20<") == std::string::npos);
}

TEST_CASE("an error bar does not pull the axis of something positive below zero") {
  Plot plot = incidence_plot("R", "reflectance");
  plot.series.push_back({"measured", {10.0, 20.0}, {0.01, 0.9}, {0.1, 0.1}});
  const std::string positive = svg_plot(plot);
  CHECK(positive.find(">0<") != std::string::npos);
  CHECK(positive.find(">-") == std::string::npos);
  plot.series.back().y.front() = -0.01;
  CHECK(svg_plot(plot).find(">-0.5<") != std::string::npos);
}

TEST_CASE("the page of surfaces has for each its model, what it needs, or why it was not made") {
  SurfaceEntry shown, preset, failed;
  shown.name = "flat";
  shown.outline = {"smooth", {}, {}, {"Born & Wolf"}};
  shown.readings =
      SurfaceReadings{flat_sample(), {reading(0.0), reading(45.0), reading(80.0)}, reading(45.0)};
  preset.name = "preset";
  preset.outline = {"unified", {"other"}, {"unified.sigma_alpha", "gap"}, {}};
  failed.name = "failed";
  failed.not_made = "no index at <420> nm";
  const std::string page = surface_page({preset, failed, shown}, "LSO to air");
  CHECK(times(page, "<svg") == 2);
  CHECK(page.find("required parameters: unified.sigma_alpha, gap") != std::string::npos);
  CHECK(page.find("based on other") != std::string::npos);
  CHECK(page.find("not made here: no index at &lt;420&gt; nm") != std::string::npos);
  CHECK(page.find(">flat</h2>") < page.find(">preset</h2>"));  // what shows something comes first
}
