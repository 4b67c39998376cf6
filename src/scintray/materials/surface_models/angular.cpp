#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "scintray/materials/detail/forms.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/tables/geant4_finish.hpp"

namespace scintray::materials {

namespace {

/// Reflectance and transmittance against wavelength (nm) at one angle of incidence.
struct AngleRow {
  double angle_rad = 0.0;
  core::Curve reflectance, transmittance;
};

/// A face whose reflectance and transmittance are tabulated against the angle of incidence, in the medium of
/// incidence, and wavelength: dichroic filters and films whose band moves with angle. Between two angles both
/// are interpolated linearly, beyond the first and last they are constant. Light is reflected as by a mirror,
/// or by Lambert's law, or transmitted undeflected (as Geant4's dichroic surfaces do) or refracted, beyond
/// the critical angle then reflected; the rest is absorbed.
class AngularSurface : public optics::MicrosurfaceModel {
 public:
  struct Options {
    bool refracts = false;       ///< transmitted light
    bool lambertian = false;     ///< reflected light
    bool whole_degrees = false;  ///< angles are rounded, as by G4OpBoundaryProcess::DielectricDichroic
  };
  AngularSurface(std::vector<AngleRow> rows, const Options& options)
      : rows_(std::move(rows)), options_(options) {}

  optics::SurfaceOutcome scatter(optics::Ray& ray, optics::Side side, const optics::IndexPair& index,
                                 optics::SurfaceInteraction& interaction) const override {
    const core::Vec3 against =
        side == optics::Side::inside ? core::Vec3(-interaction.normal) : interaction.normal;
    double angle_rad = std::acos(std::clamp(-ray.direction.dot(against), 0.0, 1.0));
    if (options_.whole_degrees) angle_rad = std::floor(angle_rad / core::kDegree + 0.5) * core::kDegree;
    const auto above =
        std::upper_bound(rows_.begin(), rows_.end(), angle_rad,
                         [](double angle, const AngleRow& row) { return angle < row.angle_rad; });
    const AngleRow& high = above == rows_.end() ? rows_.back() : *above;
    const AngleRow& low = above == rows_.begin() ? rows_.front() : *(above - 1);
    const double span = high.angle_rad - low.angle_rad;
    const double t = span > 0.0 ? (angle_rad - low.angle_rad) / span : 0.0;
    const auto at = [&](const core::Curve AngleRow::*share) {
      const double nm = interaction.wavelength_nm;
      return (1.0 - t) * (low.*share)(nm) + t * (high.*share)(nm);
    };
    const double u = interaction.rng.uniform(), reflectance = at(&AngleRow::reflectance);
    if (u < reflectance) {
      if (options_.lambertian)
        optics::scatter_lambertian(ray, against, interaction.rng);
      else
        optics::reflect(ray, against);
      return optics::outcome_on(side);
    }
    if (u >= reflectance + at(&AngleRow::transmittance)) return optics::SurfaceOutcome::absorbed;
    if (!options_.refracts) return optics::outcome_on(other(side));
    return optics::refract_only(ray, against, index.on(side), index.on(other(side)))
               ? optics::outcome_on(other(side))
               : optics::outcome_on(side);
  }

  bool opaque() const override {
    return std::all_of(rows_.begin(), rows_.end(),
                       [](const AngleRow& row) { return row.transmittance.max_y() <= 0.0; });
  }

 private:
  std::vector<AngleRow> rows_;  ///< at rising angles
  Options options_;
};

constexpr core::Word<bool> kTransmitted[] = {{"undeflected", false}, {"refracted", true}};
constexpr core::Word<bool> kReflected[] = {{"specular", false}, {"lambertian", true}};

/// The file of `geant4_dichroic`, else that of the environment; empty, and reported, without either.
std::filesystem::path dichroic_file_of(const config::TomlTable& table) {
  if (table.has("file")) {
    const std::filesystem::path named = table.string("file");
    if (named.empty() || named.is_absolute()) return named;
    return std::filesystem::path(table.where("file").file).parent_path() / named;
  }
  const char* set = std::getenv(tables::kDichroicVariable);
  if (set != nullptr && *set != '\0') return set;
  table.report(
      "file",
      "a dichroic surface of Geant4 needs its table, and neither \"file\" nor the environment variable "
      "G4DICHROICDATA names one",
      "write file = \"FILTER.dat\" with the file that Geant4 has there, or set G4DICHROICDATA to it");
  return {};
}

/// Rows of the angles of a file of Geant4; empty, and reported, without one that can be read.
std::vector<AngleRow> read_dichroic_rows(const config::TomlTable& table) {
  std::vector<AngleRow> rows;
  const std::filesystem::path file = dichroic_file_of(table);
  if (file.empty()) return rows;
  try {
    tables::DichroicTable read = tables::read_dichroic(file);
    for (std::size_t i = 0; i < read.angle_deg.size(); ++i) {
      AngleRow row;
      row.angle_rad = read.angle_deg[i] * core::kDegree;
      std::vector<double> rest;
      for (const double share : read.transmittance[i]) rest.push_back(1.0 - share);
      row.reflectance = core::Curve(read.wavelength_nm, std::move(rest));
      row.transmittance = core::Curve(read.wavelength_nm, std::move(read.transmittance[i]));
      rows.push_back(std::move(row));
    }
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems())
      table.report("file", (problem.where.file.empty() ? "" : problem.where.file + ": ") + problem.what,
                   problem.hint);
  }
  return rows;
}

/// The share that `given` leaves of 1, at its wavelengths.
core::Curve rest_of(const core::Curve& given) {
  std::vector<double> rest;
  for (const double share : given.y()) rest.push_back(std::max(0.0, 1.0 - share));
  return {given.x(), std::move(rest)};
}

AngleRow read_row(const config::TomlTable& table) {
  AngleRow row;
  row.angle_rad = table.quantity("angle", core::Dimension::angle);
  table.expect("angle", row.angle_rad >= 0.0 && row.angle_rad <= 0.5 * core::kPi,
               "an angle of incidence lies between 0 and 90 deg");
  const auto read = [&](const char* key) {
    const core::Curve curve = table.curve(key, core::Dimension::dimensionless);
    expect_share(table, key, curve, "a share of the light");
    return curve;
  };
  const bool reflects = table.has("reflectance"), transmits = table.has("transmittance");
  if (!reflects && !transmits) {
    table.report("reflectance", "an angle without reflectance and without transmittance",
                 "give one of them, and the other is what it leaves of 1, or both");
    return row;
  }
  if (reflects) row.reflectance = read("reflectance");
  if (transmits) row.transmittance = read("transmittance");
  if (!reflects) row.reflectance = rest_of(row.transmittance);
  if (!transmits) row.transmittance = rest_of(row.reflectance);
  double most = 0.0;
  for (const core::Curve* curve : {&row.reflectance, &row.transmittance})
    for (const double nm : curve->x()) most = std::max(most, row.reflectance(nm) + row.transmittance(nm));
  table.expect("transmittance", most <= 1.0 + 1e-9,
               fmt::format("reflectance and transmittance come to {:.6g}; together they are at most 1", most),
               "what is left of 1 is absorbed");
  return row;
}

}  // namespace

SurfaceModel angular_model() {
  const auto read = [](const config::TomlTable& surface) {
    const config::TomlTable table = surface.table("angular");
    AngularSurface::Options options;
    options.refracts = table.choice("transmitted", kTransmitted);
    options.lambertian = table.choice("reflected", kReflected, false);
    std::vector<AngleRow> rows;
    std::vector<WavelengthTable> curves;
    if (const auto geant4 = table.optional_table("geant4_dichroic")) {
      options.whole_degrees = true;
      if (table.has("at"))
        table.report("at", "a surface by angle with rows and a table of Geant4", "keep one of the two");
      rows = read_dichroic_rows(*geant4);
      if (rows.empty()) rows.emplace_back();
      return FixedMicrosurface(AngularSurface(std::move(rows), options), std::nullopt, std::move(curves));
    }
    for (const config::TomlTable& row : table.tables("at")) {
      rows.push_back(read_row(row));
      curves.push_back({rows.back().reflectance, "reflectances", row.where("reflectance")});
      curves.push_back({rows.back().transmittance, "transmittances", row.where("transmittance")});
    }
    const bool rising =
        std::adjacent_find(rows.begin(), rows.end(), [](const AngleRow& a, const AngleRow& b) {
          return a.angle_rad >= b.angle_rad;
        }) == rows.end();
    table.expect("at", rising, "the angles of a surface rise, without repeats");
    if (rows.empty()) {
      table.report("at", "a surface by angle without an angle",
                   "list them, as at = [{ angle = \"0 deg\", reflectance = 0.98 }, ...]");
      rows.emplace_back();
    }
    return FixedMicrosurface(AngularSurface(std::move(rows), options), std::nullopt, std::move(curves));
  };
  return {.word = "angular", .table = "angular", .read = read};
}

}  // namespace scintray::materials
