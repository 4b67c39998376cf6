#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/materials/detail/forms.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"

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
/// or transmitted undeflected (as Geant4's dichroic surfaces do) or refracted, beyond the critical angle then
/// reflected; the rest is absorbed.
class AngularSurface : public optics::MicrosurfaceModel {
 public:
  AngularSurface(std::vector<AngleRow> rows, bool refracts) : rows_(std::move(rows)), refracts_(refracts) {}

  optics::SurfaceOutcome scatter(optics::Ray& ray, optics::Side side, const optics::IndexPair& index,
                                 optics::SurfaceInteraction& interaction) const override {
    const core::Vec3 against =
        side == optics::Side::inside ? core::Vec3(-interaction.normal) : interaction.normal;
    const double angle_rad = std::acos(std::clamp(-ray.direction.dot(against), 0.0, 1.0));
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
      optics::reflect(ray, against);
      return optics::outcome_on(side);
    }
    if (u >= reflectance + at(&AngleRow::transmittance)) return optics::SurfaceOutcome::absorbed;
    if (!refracts_) return optics::outcome_on(other(side));
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
  bool refracts_;
};

constexpr core::Word<bool> kTransmitted[] = {{"undeflected", false}, {"refracted", true}};

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
    const bool refracts = table.choice("transmitted", kTransmitted);
    std::vector<AngleRow> rows;
    std::vector<WavelengthTable> curves;
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
    return FixedMicrosurface(AngularSurface(std::move(rows), refracts), std::nullopt, std::move(curves));
  };
  return {.word = "angular", .table = "angular", .read = read};
}

}  // namespace scintray::materials
