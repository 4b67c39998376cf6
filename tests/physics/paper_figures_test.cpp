/// What E. Roncali and S. R. Cherry 2013, Phys. Med. Biol. 58, 2185, state in figures 6 to 8 and section 3.1
/// of measured LSO crystals, as claims about the shipped surfaces. The maps are traced on the spot.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/optics/fresnel.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

constexpr double kStep_deg = 2.5;
/// Slopes of 1.25 deg on average blur the critical angle of polished faces: within this distance of it they
/// are not compared with Fresnel.
constexpr double kBlur_deg = 5.0;

const SampleSurface& sample(const std::string& surface, const std::string& outside) {
  static SurfaceFactory factory;
  static std::map<std::string, SampleSurface> made;
  const std::string key = surface + "|" + outside;
  if (const auto found = made.find(key); found != made.end()) return found->second;
  return made
      .emplace(key, make_sample_surface(MaterialDatabase::shipped(), factory,
                                        {surface, "LSO_roncali2013", outside, 420.0}, true))
      .first->second;
}

Estimate slope_deg(const std::string& surface, double incidence_deg) {
  const Estimate slope =
      mean_visible_slope(sample(surface, "vacuum").surface, Side::inside, incidence_deg * kDegree);
  return {slope.value / kDegree, slope.error / kDegree};
}

/// A published number, rounded to `rounding` on either side.
void check_published(const std::string& what, const Estimate& measured, double published, double rounding) {
  evidence("paper_figures", {what, fmt::format("{:.3f} ± {:.3f}", measured.value, measured.error),
                             fmt::format("{:g} ± {:g}", published, rounding)});
  CAPTURE(what);
  CAPTURE(measured.value);
  CHECK(std::abs(measured.value - published) < rounding + kSigmas * measured.error);
}

struct Point {
  double incidence_deg;
  Estimate reflectance;
  double fresnel;
};

/// Reflectance from inside at steps of 2.5 deg up to 85 deg.
std::vector<Point> reflectances(const std::string& surface, const std::string& outside) {
  const SampleSurface& sample_there = sample(surface, outside);
  GoniometerSettings settings;
  settings.wavelength_nm = 420.0;
  settings.rays = 100'000;
  std::vector<double> angles;
  for (double angle = 0.0; angle < 86.0; angle += kStep_deg) angles.push_back(angle * kDegree);
  std::vector<Point> points;
  for (const GoniometerReading& reading :
       sweep_incidence(sample_there.surface, sample_there.index, settings, angles)) {
    const double cosine = std::cos(reading.settings.incidence_rad);
    points.push_back({reading.settings.incidence_rad / kDegree, reading.reflectance(),
                      fresnel(cosine, sample_there.index.inside, sample_there.index.outside).unpolarised()});
  }
  return points;
}

double critical_deg(const std::string& outside) {
  const IndexPair& index = sample("polished", outside).index;
  return std::asin(index.outside / index.inside) / kDegree;
}

const std::string kAir = "vacuum", kGrease = "optical_grease_roncali2013";

}  // namespace

TEST_CASE(
    "Roncali and Cherry 2013, figure 6: rough faces have 18 deg at normal incidence and 35 deg at grazing") {
  check_published("ground: mean slope met at 0 deg", slope_deg("lso_ground_30um", 0.0), 18.0, 0.5);
  check_published("ground: mean slope met at 88.5 deg", slope_deg("lso_ground_30um", 88.5), 35.0, 0.5);
  Estimate before = slope_deg("lso_ground_30um", 60.0);
  for (const double incidence : {70.0, 80.0, 85.0, 88.5}) {
    const Estimate slope = slope_deg("lso_ground_30um", incidence);
    CHECK(slope.value - before.value > kSigmas * std::hypot(slope.error, before.error));
    before = slope;
  }
}

TEST_CASE("Roncali and Cherry 2013, figure 6: polished faces have 1.25 deg at any incidence up to 85 deg") {
  for (const double incidence : {0.0, 30.0, 60.0, 80.0, 85.0})
    check_published(fmt::format("polished: mean slope met at {:g} deg", incidence),
                    slope_deg("lso_polished", incidence), 1.25, 0.005);
}

TEST_CASE(
    "Roncali and Cherry 2013, figure 7: the critical angles are 33.3 deg into air and 55.5 deg into grease") {
  CHECK(critical_deg(kAir) == doctest::Approx(33.3).epsilon(0.05 / 33.3));
  CHECK(critical_deg(kGrease) == doctest::Approx(55.5).epsilon(0.05 / 55.5));
}

TEST_CASE(
    "Roncali and Cherry 2013, figure 7: rough faces reflect more than Fresnel below the critical angle") {
  for (const std::string& outside : {kAir, kGrease}) {
    double least = 1.0;
    for (const Point& p : reflectances("lso_ground_30um", outside)) {
      if (p.incidence_deg > critical_deg(outside) - kStep_deg) continue;
      CAPTURE(outside);
      CAPTURE(p.incidence_deg);
      CHECK(p.reflectance.value - p.fresnel > kSigmas * p.reflectance.error);
      least = std::min(least, p.reflectance.value - p.fresnel);
    }
    evidence("paper_figures",
             {"ground into " + outside +
                  ": least reflectance above Fresnel's, more than 2.5 deg below the critical angle",
              fmt::format("{:.4f}", least), "above 0"});
  }
}

TEST_CASE(
    "Roncali and Cherry 2013, figure 7: rough faces stay below 1 above the critical angle, without a step") {
  for (const std::string& outside : {kAir, kGrease}) {
    const std::vector<Point> points = reflectances("lso_ground_30um", outside);
    double steepest = 0.0, steepest_fresnel = 0.0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      CAPTURE(outside);
      CAPTURE(points[k].incidence_deg);
      if (points[k].incidence_deg > critical_deg(outside))
        CHECK(1.0 - points[k].reflectance.value > kSigmas * points[k].reflectance.error);
      steepest = std::max(steepest, points[k].reflectance.value - points[k - 1].reflectance.value);
      steepest_fresnel = std::max(steepest_fresnel, points[k].fresnel - points[k - 1].fresnel);
    }
    evidence("paper_figures",
             {"ground into " + outside + ": steepest rise of reflectance over 2.5 deg",
              fmt::format("{:.3f}", steepest), fmt::format("Fresnel: {:.3f}", steepest_fresnel)});
    CHECK(steepest < 0.25 * steepest_fresnel);
  }
}

TEST_CASE("Roncali and Cherry 2013, figure 7: polished faces reflect by Fresnel within 0.01") {
  for (const std::string& outside : {kAir, kGrease}) {
    double worst = 0.0;
    for (const Point& p : reflectances("lso_polished", outside)) {
      if (std::abs(p.incidence_deg - critical_deg(outside)) < kBlur_deg) continue;
      CAPTURE(outside);
      CAPTURE(p.incidence_deg);
      CHECK(std::abs(p.reflectance.value - p.fresnel) < 0.01);
      worst = std::max(worst, std::abs(p.reflectance.value - p.fresnel));
    }
    evidence("paper_figures", {"polished into " + outside +
                                   ": largest distance from Fresnel, 5 deg and more from the critical angle",
                               fmt::format("{:.4f}", worst), "below 0.01"});
  }
}

TEST_CASE(
    "Roncali and Cherry 2013, figure 8: at 45 deg polished faces reflect specularly, rough ones diffusely") {
  GoniometerSettings settings;
  settings.wavelength_nm = 420.0;
  settings.incidence_rad = 45.0 * kDegree;
  settings.rays = 200'000;
  const auto read = [&](const std::string& surface) {
    const SampleSurface& sample_there = sample(surface, kAir);
    return read_goniometer(sample_there.surface, sample_there.index, settings);
  };
  const GoniometerReading polished = read("lso_polished"), rough = read("lso_ground_30um");
  for (const auto& [name, reading] : {std::pair("polished", &polished), std::pair("ground", &rough)})
    evidence("paper_figures",
             {std::string(name) + ": rms width of the light reflected at 45 deg, in the plane of incidence",
              fmt::format("{:.2f} deg", std::asin(reading->reflected_lobe.width_in_plane) / kDegree),
              name == std::string("polished") ? "a narrow lobe" : "a broad lobe"});
  CHECK(std::abs(polished.reflected_lobe.in_plane_rad.value - 45.0 * kDegree) < 0.1 * kDegree);
  CHECK(polished.reflected_lobe.width_in_plane < 3.0 * kDegree);
  CHECK(rough.reflected_lobe.width_in_plane > 5.0 * polished.reflected_lobe.width_in_plane);
  // The mirror direction is still the brightest of the rough face's: its largest bin is within 5 deg of it.
  const auto& profile = rough.reflected_directions.profile;
  const auto largest = std::max_element(profile.begin(), profile.end()) - profile.begin();
  CHECK(std::abs(profile_edge_deg(static_cast<int>(largest)) + 0.5 - 45.0) <= 5.0);
}
