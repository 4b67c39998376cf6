#include "scintray/scene_file/source.hpp"

#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

constexpr core::Word<OriginKind> kPhotonOrigins[] = {{"region", OriginKind::region},
                                                     {"position", OriginKind::position}};
constexpr core::Word<DirectionKind> kDirectionShapes[] = {{"cone", DirectionKind::cone},
                                                          {"lambertian", DirectionKind::lambertian}};

/// True when the value is this word, which is then read. Other values are left to be read otherwise.
bool is_word(const config::TomlTable& table, const std::string& key, const std::string& word) {
  const config::TomlNode* node = table.node()->find(key);
  if (node && (node->kind != Kind::string || node->text != word)) return false;
  return table.choice(key, {word}, "") == word;
}

}  // namespace

RegionSpec read_region(const config::TomlTable& table, const std::vector<std::string>& parts) {
  RegionSpec region;
  region.where = table.where();
  region.part = read_name(table, "part", true);
  expect_parts(table, "part", region.part, parts);
  const std::vector<double> slab = table.quantities("slab_z", core::Dimension::length, 2, false);
  if (!slab.empty()) {
    region.slab_z_mm = {slab[0], slab[1]};
    table.expect("slab_z", slab[1] > slab[0], "the slab ends at or below where it begins",
                 "give the lower z first: slab_z = [\"1 mm\", \"2 mm\"]");
  }
  region.box = read_low_high(table, "box");
  return region;
}

core::Vec3 read_position(const config::TomlTable& table) {
  return table.optional_quantity3("position", core::Dimension::length).value_or(core::Vec3::Zero());
}

DirectionSpec read_direction(const config::TomlTable& table) {
  DirectionSpec direction;
  direction.where = table.where("direction");
  const config::TomlNode* node = table.node()->find("direction");
  if (node && node->kind == Kind::array) {
    direction.kind = DirectionKind::beam;
    direction.axis = table.optional_direction("direction").value_or(core::Vec3::UnitZ());
  } else if (node && node->kind == Kind::table) {
    const config::TomlTable shape = table.table("direction");
    const core::Word<DirectionKind>* kind = shape.one_of(kDirectionShapes, true);
    shape.has("half_angle");
    if (!kind) return direction;
    direction.kind = kind->value;
    direction.axis = shape.optional_direction(kind->word).value_or(core::Vec3::UnitZ());
    if (direction.kind == DirectionKind::lambertian) return direction;
    direction.half_angle_rad = shape.quantity("half_angle", core::Dimension::angle);
    // A little above pi, so that "180 deg" is not rejected for its rounding.
    shape.expect("half_angle",
                 direction.half_angle_rad > 0.0 && direction.half_angle_rad <= core::kPi * (1.0 + 1e-12),
                 "a half angle outside 0 to 180 deg", "give the angle from the axis to the edge of the cone");
  } else if (!is_word(table, "direction", "isotropic") && table.has("direction")) {
    table.take("direction");
    table.report("direction", "\"direction\" is " + node->as_written() + ", which is not a direction",
                 "write \"isotropic\", a beam as [0, 0, 1], { cone = [0, 0, 1], half_angle = \"10 deg\" } or "
                 "{ lambertian = [0, 0, 1] }");
  } else {
    table.take("direction");
  }
  return direction;
}

namespace {

void read_wavelength(const config::TomlTable& table, SourceSpec& source) {
  source.wavelength_where = table.where("wavelength");
  if (is_word(table, "wavelength", "emission")) return;
  source.wavelength_nm = table.quantity("wavelength", core::Dimension::wavelength);
  table.expect("wavelength", *source.wavelength_nm > 0.0, "a wavelength that is not positive",
               "give a wavelength, as \"420 nm\", or \"emission\"");
}

void read_time(const config::TomlTable& table, SourceSpec& source) {
  source.time_where = table.where("time");
  if (is_word(table, "time", "decay")) {
    source.time_ns = std::nullopt;
    return;
  }
  source.time_ns = table.quantity("time", core::Dimension::time, 0.0);
}

}  // namespace

SourceSpec read_photon_source(const config::TomlTable& table, const std::vector<std::string>& parts) {
  SourceSpec source;
  source.where = table.where();
  if (const auto* kind = table.one_of(kPhotonOrigins, true)) {
    read_origin(table, kind->value, parts, source.origin);
    source.origin_where = table.where(kind->word);
  }
  source.direction = read_direction(table);
  read_wavelength(table, source);
  read_time(table, source);
  source.photons = positive_count(table, "photons", table.integer("photons"));
  if (const auto quick = table.optional_integer("quick_photons"))
    source.quick_photons = positive_count(table, "quick_photons", *quick);
  const auto standard = static_cast<std::int64_t>(source.photons_per_event);
  source.photons_per_event =
      positive_count(table, "photons_per_event", table.integer("photons_per_event", standard));
  return source;
}

}  // namespace scintray::scene_file
