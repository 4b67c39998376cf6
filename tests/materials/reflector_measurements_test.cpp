// Shipped reflectors beside measurements that are not shipped.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>

#include "database_helpers.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::test;

namespace {

/// Rows "nm, percent" of a spectrometer's file, as shares.
std::map<double, double> spectrum_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::map<double, double> shares;
  double nm = 0.0, percent = 0.0;
  char comma = ',';
  while (file >> nm >> comma >> percent) shares[nm] = 0.01 * percent;
  return shares;
}

/// Wavelength at which a rising edge from 375 to 420 nm passes the middle of its two levels.
double edge_nm(const std::function<double(double)>& reflectance) {
  const double middle = 0.5 * (reflectance(375.0) + reflectance(420.0));
  double nm = 375.0;
  while (nm < 420.0 && reflectance(nm) < middle) nm += 0.1;
  return nm;
}

}  // namespace

TEST_CASE("ESR: the edge of its band is where a spectrometer has it, its level between two calibrations") {
  const auto raw_file = shared_file("data/reflectors/esr_tyvek/PEN_ESR_Black.csv");
  const auto mirror_file = shared_file("data/reflectors/esr_tyvek/PEN_ESR_Black_Mirror_Calibrated.csv");
  if (!raw_file || !mirror_file) return;
  const MaterialDatabase database = MaterialDatabase::shipped();
  const Curve& ours = database.reflector("ESR").reflectance;
  const auto at = [&](const std::map<double, double>& measured) {
    REQUIRE(measured.size() == 601);
    return [&measured](double nm) {  // linear between two whole wavelengths
      const auto above = measured.lower_bound(nm);
      if (above->first == nm) return above->second;
      const auto below = std::prev(above);
      return std::lerp(below->second, above->second, (nm - below->first) / (above->first - below->first));
    };
  };
  const std::map<double, double> raw = spectrum_of(*raw_file), mirror = spectrum_of(*mirror_file);
  const double edge = edge_nm([&](double nm) { return ours(nm); });
  const double raw_edge = edge_nm(at(raw)), mirror_edge = edge_nm(at(mirror));
  // The shipped curve has points at 385.2, 387.6 and 400 nm: within half of a mean step between them.
  constexpr double kStep_nm = 0.5 * (400.0 - 385.2) / 2.0;
  CHECK(std::abs(edge - raw_edge) < kStep_nm);
  CHECK(std::abs(edge - mirror_edge) < kStep_nm);
  const auto row = [](const std::string& what, double without, double with, double here, const char* form) {
    const auto text = [&](double value) { return fmt::format(fmt::runtime(form), value); };
    evidence("esr_spectrum", {what, text(without), text(with), text(here)});
  };
  row("edge of the band, nm", raw_edge, mirror_edge, edge, "{:.1f}");
  for (const double nm : {420.0, 450.0, 500.0, 600.0}) {
    CAPTURE(nm);
    CHECK(ours(nm) > mirror.at(nm));
    CHECK(ours(nm) < raw.at(nm));
    row(fmt::format("reflectance at {:g} nm", nm), raw.at(nm), mirror.at(nm), ours(nm), "{:.3f}");
  }
  // The surface by angle has this curve at normal incidence.
  const SurfaceSpec by_angle = database.surface("esr_by_angle");
  const auto* surface = by_angle.microsurface.get_if<FixedMicrosurface>();
  REQUIRE(surface);
  for (const double nm : {387.6, 450.0}) {
    constexpr std::uint64_t kRays = 40'000;
    std::uint64_t reflected = 0;
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(75, StreamKind::other, i);
      Ray ray{Vec3::UnitZ(), Vec3::Zero()};
      SurfaceInteraction interaction{Vec3::UnitZ(), Vec3::Zero(), nm, rng};
      reflected += surface->microsurface()->scatter(ray, Side::inside, {1.0, 1.0}, interaction) ==
                   SurfaceOutcome::inside;
    }
    CHECK(std::abs(static_cast<double>(reflected) / kRays - ours(nm)) < 5.0 * std::sqrt(0.25 / kRays));
  }
}
