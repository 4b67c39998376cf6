#include "scintray/scene_file/detail/read_parts.hpp"
#include "scintray/scene_file/detail/read_shapes.hpp"
#include "scintray/scene_file/read_gamma_source.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

bool is_word(const config::TomlTable& table, const std::string& key, const std::string& word) {
  const config::TomlNode* node = table.node()->find(key);
  return node && node->kind == Kind::string && node->text == word;
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

namespace {

void read_origin(const config::TomlTable& table, const std::vector<std::string>& parts, SourceSpec& source) {
  const std::optional<std::string> kind = table.one_of({"region", "position"}, true);
  if (kind == "region") source.origin = read_region(table.table("region"), parts);
  if (kind == "position")
    source.origin =
        table.optional_quantity3("position", core::Dimension::length).value_or(core::Vec3::Zero());
  if (kind) source.origin_where = table.where(*kind);
}

}  // namespace

DirectionSpec read_direction(const config::TomlTable& table) {
  DirectionSpec direction;
  direction.where = table.where("direction");
  const config::TomlNode* node = table.node()->find("direction");
  if (node && node->kind == Kind::array) {
    direction.kind = DirectionKind::beam;
    direction.axis = table.optional_direction("direction").value_or(core::Vec3::UnitZ());
  } else if (node && node->kind == Kind::table) {
    const config::TomlTable shape = table.table("direction");
    const std::optional<std::string> kind = shape.one_of({"cone", "lambertian"}, true);
    shape.has("half_angle");
    if (!kind) return direction;
    direction.kind = kind == "cone" ? DirectionKind::cone : DirectionKind::lambertian;
    direction.axis = shape.optional_direction(*kind).value_or(core::Vec3::UnitZ());
    if (kind == "lambertian") return direction;
    direction.half_angle_rad = shape.quantity("half_angle", core::Dimension::angle);
    // A little above pi, so that "180 deg" is not refused for its rounding.
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
  if (is_word(table, "wavelength", "emission")) {
    table.take("wavelength");
    return;
  }
  source.wavelength_nm = table.quantity("wavelength", core::Dimension::wavelength);
  table.expect("wavelength", *source.wavelength_nm > 0.0, "a wavelength that is not positive",
               "give a wavelength, as \"420 nm\", or \"emission\"");
}

void read_time(const config::TomlTable& table, SourceSpec& source) {
  source.time_where = table.where("time");
  if (is_word(table, "time", "decay")) {
    table.take("time");
    source.time_ns = std::nullopt;
    return;
  }
  source.time_ns = table.quantity("time", core::Dimension::time, 0.0);
}

}  // namespace

std::uint64_t positive_count(const config::TomlTable& table, const std::string& key, std::int64_t value) {
  table.expect(key, value > 0, "\"" + key + "\" is " + std::to_string(value) + ", but at least 1 is expected",
               "give a positive integer");
  return value > 0 ? static_cast<std::uint64_t>(value) : 1;
}

namespace {

SourceSpec read_photon_source(const config::TomlTable& table, const std::vector<std::string>& parts) {
  SourceSpec source;
  source.where = table.where();
  read_origin(table, parts, source);
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

}  // namespace

void read_source(const config::TomlTable& scene, const std::vector<std::string>& parts, SceneSpec& spec) {
  const config::TomlTable table = scene.table("source");
  spec.source.where = table.where();
  std::vector<std::string> types{"photons"};
  types.insert(types.end(), kGammaSourceTypes.begin(), kGammaSourceTypes.end());
  const std::string type = table.choice("type", types);
  if (table.has("type") && !table.good("type")) {
    table.skip();
    return;
  }
  const bool unpolarised = table.choice("polarisation", {"random", "unpolarised"}, "random") == "unpolarised";
  if (type == "photons" || !table.has("type")) {
    spec.source = read_photon_source(table, parts);
    spec.source.unpolarised = unpolarised;
  } else {
    spec.energy_source = read_gamma_source(table, parts);
    spec.energy_source->unpolarised = unpolarised;
  }
}

RunSpec read_run(const config::TomlTable& scene) {
  RunSpec run;
  const std::optional<config::TomlTable> table = scene.optional_table("run");
  if (!table) return run;
  run.where = table->where();
  const std::int64_t seed = table->integer("seed", static_cast<std::int64_t>(run.seed));
  table->expect("seed", seed >= 0, "a seed below 0", "give an integer from 0 to 9223372036854775807");
  run.seed = static_cast<std::uint64_t>(seed);
  const auto limit = static_cast<std::int64_t>(run.max_interactions);
  run.max_interactions =
      positive_count(*table, "max_interactions", table->integer("max_interactions", limit));
  run.max_time_ns = table->optional_quantity("max_time", core::Dimension::time);
  table->expect("max_time", run.max_time_ns.value_or(1.0) > 0.0, "a time limit that is not positive",
                "give a time after emission, as \"500 ns\", or remove it");
  if (const auto threads = table->optional_integer("threads")) {
    table->expect("threads", *threads >= 1 && *threads <= 4096, "the number of threads is not in 1 to 4096",
                  "give a number of threads, or remove it to use all cores");
    run.threads = static_cast<int>(*threads);
  }
  run.contact_tolerance_mm =
      table->quantity("contact_tolerance", core::Dimension::length, run.contact_tolerance_mm);
  table->expect("contact_tolerance", run.contact_tolerance_mm > 0.0,
                "a contact tolerance that is not positive",
                "give the distance below which faces touch, as \"0.1 um\"");
  const std::string accelerator = table->choice("accelerator", {"auto", "embree", "planes"}, "auto");
  run.accelerator = accelerator == "embree"   ? AcceleratorKind::embree
                    : accelerator == "planes" ? AcceleratorKind::planes
                                              : AcceleratorKind::automatic;
  run.photon_list = table->boolean("photon_list", false);
  run.photon_history = table->boolean("photon_history", false);
  run.output = table->string("output", "");
  if (!run.output.empty() && run.output.is_relative())
    run.output = std::filesystem::path(table->where("output").file).parent_path() / run.output;
  return run;
}

}  // namespace scintray::scene_file
