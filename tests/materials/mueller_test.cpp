// Reflectors with Mueller matrices: a made-up surface of Fresnel facets, whose polarised reflection is known,
// in the columns and the axes of NIST's data, and those data themselves.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <fstream>

#include "database_helpers.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/materials/measured_brdf.hpp"
#include "scintray/optics/elliptical.hpp"
#include "scintray/optics/fresnel.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::materials;
using namespace scintray::tables;
using namespace scintray::test;

namespace {

using Field = std::array<std::complex<double>, 2>;  ///< along s = k x n and p = k x s
constexpr double kFacetIndex = 1.5, kFromFacets = 0.6;

Eigen::Vector4d stokes_of_field(const Field& field) {
  const std::complex<double> product = std::conj(field[0]) * field[1];
  return {std::norm(field[0]) + std::norm(field[1]), std::norm(field[0]) - std::norm(field[1]),
          2.0 * product.real(), 2.0 * product.imag()};
}

Vec3 towards(double polar, double azimuth, double up) {
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), up * std::cos(polar)};
}

/// Field reflected by the facet that is a mirror between two directions, by Fresnel's equations.
Field facet_reflects(const Field& field, double in, double out, double turn) {
  const Vec3 k_in = towards(in, 0.0, -1.0), k_out = towards(out, turn, 1.0);
  const Vec3 m = (k_out - k_in).normalized();
  const auto axes = [](const Vec3& k, double azimuth) {
    const Vec3 s = Vec3(std::cos(azimuth), std::sin(azimuth), 0.0).cross(Vec3::UnitZ());
    return std::array<Vec3, 2>{s, k.cross(s)};
  };
  const auto from = axes(k_in, 0.0), to = axes(k_out, turn);
  const Vec3 across = k_in.cross(m).norm() > 1e-9 ? Vec3(k_in.cross(m).normalized()) : from[0];
  const optics::Refraction refraction(k_out.dot(m), 1.0, kFacetIndex);
  const optics::FresnelAmplitudes r(k_out.dot(m), refraction.cos_t(), 1.0, kFacetIndex);
  Field reflected{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double s = from[i].dot(across), p = from[i].dot(across.cross(k_in));
    const Vec3 leaving = r.s * s * across + r.p * p * across.cross(k_out);
    for (std::size_t j = 0; j < 2; ++j) reflected[j] += field[i] * leaving.dot(to[j]);
  }
  return reflected;
}

/// Mueller matrix of light of which a share is reflected by facets and the rest depolarised.
Eigen::Matrix4d made_up_matrix(double in, double out, double turn) {
  const double h = std::sqrt(0.5);
  const std::array<std::array<Field, 2>, 3> states{
      {{{{1.0, 0.0}, {0.0, 1.0}}},
       {{{h, h}, {h, -h}}},
       {{{h, std::complex<double>(0.0, h)}, {h, std::complex<double>(0.0, -h)}}}}};
  Eigen::Matrix4d matrix;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto& [plus, minus] = states[static_cast<std::size_t>(k)];
    const Eigen::Vector4d of_plus = stokes_of_field(facet_reflects(plus, in, out, turn)),
                          of_minus = stokes_of_field(facet_reflects(minus, in, out, turn));
    matrix.col(0) = 0.5 * (of_plus + of_minus);
    matrix.col(k + 1) = 0.5 * (of_plus - of_minus);
  }
  matrix *= kFromFacets / matrix(0, 0);
  matrix(0, 0) = 1.0;
  return matrix;
}

Eigen::Matrix4d turned_axes(double azimuth) {
  Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
  rotation(1, 1) = rotation(2, 2) = std::cos(2.0 * azimuth);
  rotation(1, 2) = std::sin(2.0 * azimuth);
  rotation(2, 1) = -std::sin(2.0 * azimuth);
  return rotation;
}

/// The made-up surface in the columns of NIST's data.
std::filesystem::path facets_csv() {
  static const auto path = [] {
    const auto file = scratch_folder("made_up_mueller") / "facets.csv";
    std::ofstream csv(file);
    csv << "lambda,thetai,phi,thetar,phir,f_r11";
    for (int e = 1; e < 16; ++e) csv << fmt::format(",m{}{}", e / 4 + 1, e % 4 + 1);
    csv << "\n";
    constexpr double kPhi = 10.0;
    for (int in = 5; in <= 85; in += 10)
      for (int out = 5; out <= 85; out += 8)
        for (int turn = -171; turn <= 180; turn += 18) {
          const Eigen::Matrix4d matrix = made_up_matrix(in * kDegree, out * kDegree, turn * kDegree);
          const Eigen::Matrix4d in_face =
              turned_axes(-(kPhi + turn) * kDegree) * matrix * turned_axes(kPhi * kDegree);
          csv << fmt::format("0.5,{},{},{},{},0.25", -in, kPhi, out, kPhi + turn);
          for (Eigen::Index e = 1; e < 16; ++e) csv << fmt::format(",{:.9g}", in_face(e / 4, e % 4));
          csv << "\n";
        }
    return file;
  }();
  return path;
}

MeasuredBrdfSurface reflector_of(const std::filesystem::path& file) {
  return microsurface_of<MeasuredBrdfSurface>(
      database_with(DefinitionKind::surface, "mine",
                    "model = \"measured_brdf\"\nmeasured_brdf = { file = \"" + file.string() + "\" }\n")
          .surface("mine"));
}

double sine2(double angle) { return std::pow(std::sin(angle), 2); }

}  // namespace

TEST_CASE(
    "a table of Mueller matrices has those of facets, by Fresnel's equations, in the axes of NIST's data") {
  const auto surface = reflector_of(facets_csv());
  REQUIRE(surface.brdf().mueller.size() == 1);
  const MuellerTable& table = surface.brdf().mueller[0];
  CHECK(table.rms() < 0.04);
  Moments off;
  for (const double in : {20.0, 40.0, 60.0})
    for (const double out : {25.0, 45.0, 65.0})
      for (const double turn : {-130.0, -60.0, -20.0, 20.0, 60.0, 130.0}) {
        const Eigen::Matrix4d expected = made_up_matrix(in * kDegree, out * kDegree, turn * kDegree),
                              found = table.matrix(sine2(in * kDegree), sine2(out * kDegree), turn * kDegree);
        CHECK((found - expected).cwiseAbs().maxCoeff() < 0.12);
        off.add((found - expected).squaredNorm() / 15.0);
      }
  CHECK(std::sqrt(off.mean().value) < 0.03);  // where single elements change by 1 over the hemisphere
  // Reciprocity, to rounding, and the mirror image.
  const Eigen::Vector4d signs(1.0, 1.0, 1.0, -1.0), mirror(1.0, 1.0, -1.0, -1.0);
  for (const double turn : {0.4, 1.0, 2.5}) {
    const Eigen::Matrix4d there = table.matrix(0.2, 0.7, turn), back = table.matrix(0.7, 0.2, turn);
    CHECK((back - signs.asDiagonal() * there.transpose() * signs.asDiagonal()).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((table.matrix(0.2, 0.7, -turn) - mirror.asDiagonal() * there * mirror.asDiagonal())
              .cwiseAbs()
              .maxCoeff() < 1e-12);
  }
}

TEST_CASE(
    "polarised light is reflected as the Mueller matrices say: how much, where to, and its polarisation") {
  const auto surface = reflector_of(facets_csv());
  const MuellerTable& table = surface.brdf().mueller[0];
  const BrdfTable& brdf = surface.brdf().tables[0];
  constexpr std::uint64_t kRays = 100'000;
  const Vec3 face(0.48, -0.6, 0.64), inward = -face;
  const Frame frame = Frame::about(inward);
  for (const bool phases : {false, true})
    for (const double degrees : {20.0, 65.0})
      for (const double from_s : {0.0, 0.4, 1.3}) {
        CAPTURE(degrees);
        CAPTURE(from_s);
        const double in = degrees * kDegree, x_in = sine2(in);
        std::array<Moments, 3> off;  // of the Stokes parameters from those of the matrix
        Moments forward_excess;
        std::uint64_t reflected = 0;
        Eigen::Vector4d incident;
        for (std::uint64_t i = 0; i < kRays; ++i) {
          Rng rng(91, StreamKind::other, i);
          optics::Ray ray;
          ray.direction = std::sin(in) * frame.x - std::cos(in) * inward;
          const Vec3 s = frame.x.cross(inward), p = ray.direction.vec().cross(s);
          ray.polarisation = std::cos(from_s) * s + std::sin(from_s) * p;
          ray.keeps_phases = phases;
          ray.ellipticity_rad = phases ? 0.3 : 0.0;
          const auto before = optics::stokes_of(ray, s);
          incident = {1.0, before.s1, -before.s2, before.s3};
          optics::SurfaceInteraction at{face, Vec3::Zero(), 500.0, rng};
          if (surface.scatter(ray, optics::Side::inside, {1.0, 1.0}, at) == optics::SurfaceOutcome::absorbed)
            continue;
          ++reflected;
          const double up = ray.direction.dot(inward);
          REQUIRE(up > 0.0);
          REQUIRE(std::abs(ray.polarisation.dot(ray.direction.vec())) < 1e-9);
          const Vec3 radial = (ray.direction.vec() - up * inward).normalized();
          const double turn = std::atan2(radial.dot(inward.cross(frame.x)), radial.dot(frame.x));
          const Eigen::Vector4d expected = table.matrix(x_in, 1.0 - up * up, turn) * incident;
          const auto after = optics::stokes_of(ray, radial.cross(inward));
          off[0].add(after.s1 - expected[1] / expected[0]);
          off[1].add(-after.s2 - expected[2] / expected[0]);
          if (phases) off[2].add(after.s3 - expected[3] / expected[0]);
          // Weighted back to unpolarised light, whose directions are the BRDF's.
          forward_excess.add((std::abs(turn) < 0.5 * kPi ? 1.0 : 0.0) / expected[0]);
        }
        CHECK(sigmas(binomial_estimate(reflected, kRays), {table.reflectance(x_in, incident[1]), 0.0}) <
              kSigmas);
        for (std::size_t k = 0; k < (phases ? 3u : 2u); ++k)
          CHECK(sigmas(off[k].mean(), {0.0, 0.0}) < kSigmas);
        // f is constant but for the fit: half of unpolarised light goes forward.
        const double scale = table.reflectance(x_in, incident[1]) / brdf.reflectance(x_in);
        const Estimate forward = forward_excess.mean();
        CHECK(sigmas({forward.value * scale, forward.error * scale}, {0.5, 0.002}) < kSigmas);
      }
}

TEST_CASE("NIST's sintered PTFE depolarises: its Mueller matrices, and their reciprocity") {
  const auto path = shared_file("data/reflectors/ptfe_nist/PTFE.data.csv");
  if (!path) return;
  const auto surface = reflector_of(*path);
  REQUIRE(surface.brdf().mueller.size() == 4);
  for (std::size_t slice = 0; slice < 4; ++slice) {
    const MuellerTable& table = surface.brdf().mueller[slice];
    CHECK(table.rms() < 0.02);
    // What is left of polarisation, from s, p and 45 deg: little but at grazing forward angles.
    const Eigen::Matrix4d steep = table.matrix(0.25, 0.25, kPi), grazing = table.matrix(0.933, 0.933, 0.0);
    for (const Eigen::Index k : {1, 2, 3}) {
      CHECK(std::abs(steep(k, k)) < 0.1);
      CHECK(grazing(k, k) > 0.15);
    }
    CHECK(std::abs(grazing(1, 2)) < 0.05);
    evidence("ptfe_mueller",
             {fmt::format("{:g}", surface.brdf().wavelengths_nm[slice]), fmt::format("{:.4f}", table.rms()),
              fmt::format("{:.3f}", steep(1, 1)), fmt::format("{:.3f}", steep(2, 2)),
              fmt::format("{:.3f}", steep(3, 3)), fmt::format("{:.3f}", grazing(1, 1)),
              fmt::format("{:.3f}", grazing(2, 2)), fmt::format("{:.3f}", grazing(3, 3)),
              fmt::format("{:.3f}", table.most_excess())});
  }
}

TEST_CASE(
    "a Mueller matrix of impossible elements is an error with its line; one that is not whole is not used") {
  const auto folder = scratch_folder("bad_mueller");
  std::ifstream good(facets_csv());
  std::string heading, row, rest;
  std::getline(good, heading);
  std::getline(good, row);
  for (std::string line; std::getline(good, line);) rest += line + "\n";
  const auto file = folder / "bad.csv";
  std::ofstream(file) << heading << "\n" << row.substr(0, row.rfind(',')) << ",7\n" << rest;
  CHECK(reports(problems_of([&] { reflector_of(file); }), 2, "bad.csv:2"));
  const auto part = folder / "part.csv";
  std::ofstream(part) << heading.substr(0, heading.rfind(',')) << ",more\n" << row << "\n" << rest;
  CHECK(reflector_of(part).brdf().mueller.empty());
}
