// Measured BRDFs in Zemax' text format.
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "database_helpers.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/materials/measured_brdf.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/tables/bsdf_text.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::tables;
using namespace scintray::test;

namespace {

/// A reciprocal BRDF that depends on all three angles, 1/sr.
double reciprocal_brdf(const Vec3& in, const Vec3& out) {
  const double forward = -(in.x() * out.x() + in.y() * out.y());
  return 0.2 * (1.0 + 0.3 * forward + 0.2 * in.z() * out.z());
}

std::string list(const char* name, const std::vector<double>& angles) {
  std::string text = fmt::format("{}\t{}\n", name, angles.size());
  for (const double angle : angles) text += fmt::format("{:g}\t", angle);
  return text + "\n";
}

struct BsdfText {
  std::string symmetry = "PlaneSymmetrical";
  std::vector<double> incidence{0, 15, 30, 45, 60, 75}, azimuth, radial;
  double scale = 1.0, tis_scale = 1.0;

  BsdfText() {
    for (int k = 0; k <= 180; k += 15) azimuth.push_back(k);
    for (int k = 0; k <= 165; k += 5) radial.push_back(k);
  }

  /// The file: angles about the specular ray, at azimuth 0 towards the normal.
  std::string text() const {
    std::string all = "# Made by a test\nSource\tMeasured\nSymmetry\t" + symmetry +
                      "\nSpectralContent\tMonochrome\nScatterType\tBRDF\nSampleRotation\t1\n0\n" +
                      list("AngleOfIncidence", incidence) + list("ScatterAzimuth", azimuth) +
                      list("ScatterRadial", radial) + "\r\nMonochrome\nDataBegin\n";
    for (const double degrees : incidence) {
      const double angle = degrees * kDegree;
      const Vec3 back(-std::sin(angle), 0.0, std::cos(angle)),
          specular(std::sin(angle), 0.0, std::cos(angle)), to_normal(-std::cos(angle), 0.0, std::sin(angle));
      all += fmt::format("TIS {:.4f}\n", tis_scale * scale * total(back));
      for (const double a : azimuth) {
        for (const double r : radial) {
          const Vec3 out = std::cos(r * kDegree) * specular +
                           std::sin(r * kDegree) *
                               (std::cos(a * kDegree) * to_normal + std::sin(a * kDegree) * Vec3::UnitY());
          all += fmt::format("{:.5E}\t", out.z() > 0.0 ? scale * reciprocal_brdf(back, out) : 0.0);
        }
        all += "\n";
      }
    }
    return all + "DataEnd\n";
  }

  /// Reflectance: the forward term vanishes in the mean over azimuths.
  static double total(const Vec3& back) { return 0.2 * (kPi + 0.2 * back.z() * kTwoPi / 3.0); }
};

std::filesystem::path bsdf_file(const std::string& name, const std::string& text) {
  static const auto folder = scratch_folder("zemax_bsdf");
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

}  // namespace

TEST_CASE("A BRDF in Zemax' format is read back as the function it was written from") {
  for (const bool whole_turn : {false, true}) {
    BsdfText file;
    if (whole_turn) {
      file.symmetry = "ASymmetrical";
      for (int k = 195; k < 360; k += 15) file.azimuth.push_back(k);
    }
    const Bsdf bsdf = parse_bsdf(file.text(), "test.bsdf");
    CHECK(bsdf.angles.specular == file.incidence);
    const BrdfTable table = BrdfTable::fitted(brdf_points(bsdf));
    CHECK(table.residuals().rms < 0.01);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      Rng rng(9, StreamKind::other, static_cast<std::uint64_t>(i));
      const double in = 75.0 * kDegree * rng.uniform(), out = 75.0 * kDegree * rng.uniform(),
                   turn = kPi * rng.uniform();
      // Light from -x, so that forward is +x; `back` points to where it comes from.
      const Vec3 back(-std::sin(in), 0.0, std::cos(in));
      const Vec3 leaving(std::sin(out) * std::cos(turn), std::sin(out) * std::sin(turn), std::cos(out));
      const double value = table.value_per_sr(std::pow(std::sin(in), 2), std::pow(std::sin(out), 2), turn);
      worst = std::max(worst, std::abs(value / reciprocal_brdf(back, leaving) - 1.0));
    }
    CHECK(worst < 0.03);
  }
}

TEST_CASE("A surface with a Zemax BRDF reflects the share of the light that its values add up to") {
  const auto path = bsdf_file("lambert.BSDF", BsdfText().text());
  const MaterialDatabase database =
      database_with(DefinitionKind::surface, "mine",
                    "model = \"measured_brdf\"\nmeasured_brdf = { file = \"" + path.string() + "\" }\n");
  Medium air;
  air.index = Curve::constant(1.0);
  SurfaceFactory factory;
  const Surface surface = factory.make(database.surface("mine"), air, air, 500.0, 400.0, 600.0).surface;
  constexpr std::uint64_t kRays = 40'000;
  for (const double angle : {0.0, 0.6, 1.1}) {
    const Vec3 direction(std::sin(angle), 0.0, std::cos(angle));
    std::uint64_t reflected = 0;
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(10, StreamKind::other, i);
      Ray ray{direction, Vec3::Zero()};
      reflected +=
          surface.interact(ray, Side::inside, Vec3::UnitZ(), {1.0, 1.0}, 500.0, rng) == SurfaceOutcome::inside
              ? 1
              : 0;
    }
    // The table's nodes lie 5 deg apart: its own error is below 0.005.
    const Estimate share = binomial_estimate(reflected, kRays);
    CHECK(std::abs(share.value - BsdfText::total(direction)) < kSigmas * share.error + 0.005);
  }
}

TEST_CASE("Mistakes in a Zemax BRDF are found at their line") {
  const std::string sound = BsdfText().text();
  const auto refused = [](const std::string& text, long line, const std::string& words) {
    CAPTURE(words);
    CHECK(reports(problems_of([&] { parse_bsdf(text, "scene.toml"); }), line, words));
  };
  refused(first_replaced(sound, "BRDF", "BTDF"), 5, "transmitted light");
  refused(first_replaced(sound, "Monochrome", "XYZ"), 4, "those of an eye");
  refused(first_replaced(sound, "SampleRotation\t1\n0", "SampleRotation\t2\n0 90"), 6,
          "orientation of the sample");
  refused(first_replaced(sound, "0\t15\t30\t45", "0\t30\t15\t45"), 9,
          "the angle 15 of AngleOfIncidence follows 30");
  refused(first_replaced(sound, "ScatterRadial", "Radial"), 12,
          "\"Radial\" is in the place of \"ScatterRadial\"");
  refused(first_replaced(sound, "TIS", "TXS"), 17, "in the place of \"TIS\"");
  refused(first_replaced(sound, "DataEnd", ""), 101, "the file ends here");
  refused(sound.substr(0, sound.rfind('\n', sound.size() / 2) + 1), 0, "the file ends here");
  BsdfText wrong;
  wrong.tis_scale = 0.6;
  refused(wrong.text(), 17, "but TIS is");
}

TEST_CASE("A damaged Zemax BRDF is read or refused in words, whatever stands in it") {
  const std::string sound = BsdfText().text();
  constexpr std::string_view kBytes = "0159eE+-. \n\t#TI\xff";
  int refused = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Rng rng(11, StreamKind::other, i);
    std::string text = sound;
    const auto below = [&](std::size_t count) {
      return static_cast<std::size_t>(rng.uniform() * static_cast<double>(count));
    };
    for (int k = 0; k < 3; ++k) text[below(i % 2 == 0 ? text.size() : 300)] = kBytes[below(kBytes.size())];
    if (i % 5 == 0) text.resize(below(text.size()));
    try {
      const Bsdf bsdf = parse_bsdf(text, "damaged.bsdf");
      CHECK(bsdf.values.size() ==
            bsdf.angles.specular.size() * bsdf.angles.azimuth.size() * bsdf.angles.radial.size());
    } catch (const InputError& error) {
      ++refused;
      CHECK(!error.problems().front().what.empty());
      CHECK(error.problems().front().where.line > 0);
    }
  }
  CHECK(refused > 20);
}
