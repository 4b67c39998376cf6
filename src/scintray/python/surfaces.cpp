/// Media, surfaces on the goniometer, surface tables and height maps.

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/hemisphere.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/core/units.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/python/detail/bindings.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::python {

namespace {

using materials::DefinitionKind;

constexpr core::Word<DefinitionKind> kKinds[] = {{"media", DefinitionKind::medium},
                                                 {"surfaces", DefinitionKind::surface},
                                                 {"sensors", DefinitionKind::sensor},
                                                 {"reflectors", DefinitionKind::reflector}};

/// The shipped database with the definitions of a text, [surfaces.NAME] and the like.
materials::MaterialDatabase database_with(const std::string& own) {
  materials::MaterialDatabase database = materials::MaterialDatabase::shipped();
  if (own.empty()) return database;
  core::Problems problems;
  const config::TomlTable root(config::parse_toml(own, "the definitions"), problems);
  for (const core::Word<DefinitionKind>& kind : kKinds) {
    const std::optional<config::TomlTable> tables = root.optional_table(std::string(kind.word));
    if (!tables) continue;
    std::map<std::string, config::TomlNodePtr> definitions;
    for (const std::string& name : tables->keys()) definitions.emplace(name, tables->take(name));
    database.add(kind.value, definitions);
  }
  root.finish();
  problems.throw_if_any();
  return database;
}

py::dict medium_of(const std::string& name, const std::vector<double>& wavelengths_nm,
                   const std::string& own) {
  const materials::MaterialDatabase database = database_with(own);
  const optics::Medium& medium = database.medium(name);
  std::vector<double> index, group, absorption, scattering, emission;
  for (const double nm : wavelengths_nm) {
    const optics::MediumOptics at = medium.at(nm);
    index.push_back(at.index);
    group.push_back(at.group_index);
    absorption.push_back(1.0 / at.absorption_per_mm);
    scattering.push_back(1.0 / at.scattering_per_mm);
    emission.push_back(medium.yield_per_keV > 0.0 ? medium.emission(nm) : 0.0);
  }
  py::dict entry;
  entry["index"] = array_of(std::move(index));
  entry["group_index"] = array_of(std::move(group));
  entry["absorption_length_mm"] = array_of(std::move(absorption));
  entry["scattering_length_mm"] = array_of(std::move(scattering));
  entry["emission"] = array_of(std::move(emission));
  entry["yield_per_keV"] = medium.yield_per_keV;
  entry["density_g_per_cm3"] = medium.density_g_per_cm3;
  std::vector<std::tuple<double, double, double>> decay;
  for (const optics::DecayComponent& part : medium.decay)
    decay.emplace_back(part.decay_ns, part.rise_ns, part.fraction);
  entry["decay"] = decay;
  entry["sources"] = medium.sources;
  return entry;
}

py::dict lobe_of(const analysis::Lobe& lobe) {
  py::dict entry;
  entry["rays"] = lobe.rays;
  entry["in_plane_rad"] = estimate(lobe.in_plane_rad);
  entry["across_rad"] = estimate(lobe.across_rad);
  entry["width_in_plane"] = lobe.width_in_plane;
  entry["width_across"] = lobe.width_across;
  return entry;
}

py::array profile_of(const analysis::DirectionCounts& counts, const analysis::GoniometerSettings& settings) {
  const double solid_angle = analysis::profile_bin_sr(settings.profile_half_width_rad);
  std::vector<core::Estimate> density;
  for (const std::uint64_t count : counts.profile)
    density.push_back(analysis::density_per_sr(count, settings.rays, solid_angle));
  return estimates(density);
}

struct GoniometerRequest {
  std::string surface, inside, outside, own;
  double wavelength_nm = 0.0;
  std::vector<double> incidence_rad;
};

py::dict goniometer_of(const GoniometerRequest& request, analysis::GoniometerSettings settings) {
  std::vector<analysis::GoniometerReading> readings;
  std::vector<core::Estimate> slope;
  std::vector<std::string> warnings;
  optics::IndexPair index;
  WatchedWork work;
  const py::object error = work.run([&] {
    materials::SurfaceFactory::Hooks hooks;
    hooks.stop = [&] { return work.stop.load(); };
    materials::SurfaceFactory factory(hooks);
    const analysis::SampleSurface sample = analysis::make_sample_surface(
        database_with(request.own), factory,
        {request.surface, request.inside, request.outside, request.wavelength_nm});
    warnings = sample.warnings;
    index = sample.index;
    settings.wavelength_nm = request.wavelength_nm;
    for (const double angle : request.incidence_rad) {
      if (work.stop.load()) throw core::Cancelled("the goniometer was stopped");
      settings.incidence_rad = angle;
      readings.push_back(analysis::read_goniometer(sample.surface, sample.index, settings));
      ++settings.stream;
      if (analysis::has_facets(sample.surface))
        slope.push_back(analysis::mean_visible_slope(sample.surface, settings.side, angle));
    }
  });
  raise_if(error);
  std::vector<core::Estimate> reflectance, transmittance, absorptance;
  py::list directions;
  for (const analysis::GoniometerReading& reading : readings) {
    reflectance.push_back(reading.reflectance());
    transmittance.push_back(reading.transmittance());
    absorptance.push_back(reading.absorptance());
    py::dict entry;
    entry["reflected_per_sr"] = profile_of(reading.reflected_directions, settings);
    entry["transmitted_per_sr"] = profile_of(reading.transmitted_directions, settings);
    entry["reflected_cells"] = array_of(reading.reflected_directions.cells);
    entry["transmitted_cells"] = array_of(reading.transmitted_directions.cells);
    entry["reflected_lobe"] = lobe_of(reading.reflected_lobe);
    entry["transmitted_lobe"] = lobe_of(reading.transmitted_lobe);
    directions.append(entry);
  }
  py::dict result;
  result["incidence_rad"] = array_of(request.incidence_rad);
  result["reflectance"] = estimates(reflectance);
  result["transmittance"] = estimates(transmittance);
  result["absorptance"] = estimates(absorptance);
  result["slope_rad"] = slope.empty() ? py::object(py::none()) : py::object(estimates(slope));
  result["directions"] = directions;
  result["index"] = py::make_tuple(index.inside, index.outside);
  result["warnings"] = warnings;
  return result;
}

/// Nodes of one side of a slice, in columns.
py::dict nodes_of(const std::vector<optics::TableNode>& nodes) {
  std::vector<double> incidence, slope;
  std::vector<core::Estimate> reflectance, absorptance;
  for (const optics::TableNode& node : nodes) {
    incidence.push_back(node.incidence_rad);
    slope.push_back(node.mean_slope_rad);
    reflectance.push_back({node.reflectance, node.reflectance_error});
    absorptance.push_back({node.absorptance, node.absorptance_error});
  }
  py::dict entry;
  entry["incidence_rad"] = array_of(std::move(incidence));
  entry["reflectance"] = estimates(reflectance);
  entry["absorptance"] = estimates(absorptance);
  entry["mean_slope_rad"] = array_of(std::move(slope));
  return entry;
}

py::dict slice_of(const optics::SurfaceTable& table, std::size_t number) {
  const optics::TableSlice& slice = table.slices().at(number);
  py::dict entry;
  entry["wavelength_nm"] = slice.wavelength_nm;
  entry["azimuth_rad"] = slice.azimuth_rad;
  entry["index"] = py::make_tuple(slice.index.inside, slice.index.outside);
  entry["inside"] = nodes_of(slice.from_inside);
  entry["outside"] = nodes_of(slice.from_outside);
  return entry;
}

optics::SurfaceTable build(const topography::HeightMap& map, double inside, double outside,
                           const topography::TableSettings& settings, const py::object& progress) {
  optics::SurfaceTable table;
  WatchedWork work;
  work.progress = progress;
  const py::object error = work.run([&] {
    optics::TableProvenance provenance;
    provenance.map = map.title;
    provenance.preparation = map.history();
    provenance.tiling = topography::tiling_name(map, topography::Tiling::automatic);
    table = topography::build_table(topography::make_height_field(map), {inside, outside}, settings,
                                    provenance, [&](double share) {
                                      work.report(static_cast<std::uint64_t>(100.0 * share), 100, "%");
                                      return !work.stop.load();
                                    });
  });
  raise_if(error);
  return table;
}

using MapPtr = std::shared_ptr<topography::HeightMap>;

py::dict statistics_of(const topography::HeightMap& map) {
  const topography::MapStatistics s = topography::map_statistics(map);
  py::dict entry;
  entry["points"] = s.points;
  entry["missing"] = s.missing;
  entry["sa_um"] = s.sa_um;
  entry["sq_um"] = s.sq_um;
  entry["sz_um"] = s.sz_um;
  entry["highest_um"] = s.highest_um;
  entry["lowest_um"] = s.lowest_um;
  entry["ssk"] = s.ssk;
  entry["sku"] = s.sku;
  entry["sdq"] = s.sdq;
  entry["sdr"] = s.sdr;
  entry["mean_slope_rad"] = s.mean_slope_rad;
  entry["rms_slope_rad"] = s.rms_slope_rad;
  entry["slope_histogram"] =
      array_of(std::vector<double>(s.slope_histogram.begin(), s.slope_histogram.end()));
  entry["slope_ratio_at_two_pitches"] = s.slope_ratio_at_two_pitches;
  return entry;
}

py::array heights_of(const MapPtr& map) {
  const py::capsule owner(new MapPtr(map), [](void* held) { delete static_cast<MapPtr*>(held); });
  return view(map->heights_um.data(),
              {static_cast<py::ssize_t>(map->rows), static_cast<py::ssize_t>(map->columns)}, owner);
}

MapPtr map_from(const py::array_t<double, py::array::c_style | py::array::forcecast>& heights_um,
                double pitch_x_um, double pitch_y_um, bool periodic, const std::string& title) {
  auto map = std::make_shared<topography::HeightMap>();
  map->rows = static_cast<std::uint32_t>(heights_um.shape(0));
  map->columns = static_cast<std::uint32_t>(heights_um.shape(1));
  map->heights_um.assign(heights_um.data(), heights_um.data() + heights_um.size());
  map->pitch_x_um = pitch_x_um;
  map->pitch_y_um = pitch_y_um;
  map->periodic = periodic;
  map->title = title;
  map->steps.emplace_back("set from Python");
  return map;
}

enum class RecipeKind { ground, polished, gaussian, k_correlation };
constexpr core::Word<RecipeKind> kRecipes[] = {{"ground", RecipeKind::ground},
                                               {"polished", RecipeKind::polished},
                                               {"gaussian", RecipeKind::gaussian},
                                               {"k_correlation", RecipeKind::k_correlation}};

MapPtr synthesized(const std::string& kind, const std::map<std::string, double>& lengths, std::uint64_t seed,
                   std::uint32_t points) {
  topography::SynthesisRecipe recipe;
  const RecipeKind recipe_kind = core::find_word(kRecipes, kind).value();
  if (recipe_kind == RecipeKind::ground) recipe = topography::ground_recipe();
  if (recipe_kind == RecipeKind::polished) recipe = topography::polished_recipe();
  recipe.name = kind;
  recipe.seed = seed;
  if (points > 0) recipe.columns = recipe.rows = points;
  const auto set = [&](const char* name, double& value) {
    const auto found = lengths.find(name);
    if (found != lengths.end()) value = found->second;
  };
  set("pitch_um", recipe.pitch_um);
  if (recipe_kind == RecipeKind::k_correlation) {
    set("rms_height_um", recipe.k_correlation.rms_height_um);
    set("knee_length_um", recipe.k_correlation.knee_length_um);
    set("exponent", recipe.k_correlation.exponent);
  } else {
    set("rms_height_um", recipe.gaussian.rms_height_um);
    set("correlation_length_um", recipe.gaussian.correlation_length_um);
    set("lay_length_um", recipe.gaussian.lay_length_um);
    set("lay_angle_rad", recipe.gaussian.lay_angle_rad);
  }
  return std::make_shared<topography::HeightMap>(topography::synthesize(recipe));
}

MapPtr prepared(const topography::HeightMap& map, const std::optional<int>& degree,
                const std::optional<double>& gaussian_um, const std::optional<int>& median_radius,
                const std::optional<double>& outlier_limit, bool fill_missing) {
  topography::Preparation preparation;
  preparation.leveling = degree ? topography::Leveling{*degree == 0 ? topography::Leveling::Kind::mean
                                                                    : topography::Leveling::Kind::polynomial,
                                                       *degree}
                                : topography::Leveling{topography::Leveling::Kind::none, 0};
  preparation.gaussian_um = gaussian_um;
  preparation.median_radius = median_radius;
  preparation.outlier_limit = outlier_limit;
  preparation.fill_missing = fill_missing;
  auto result = std::make_shared<topography::HeightMap>(map);
  topography::prepare(*result, preparation);
  return result;
}

MapPtr read_map(const std::string& path, const std::optional<double>& pitch_um,
                const std::optional<double>& height_unit_um, const std::optional<std::string>& channel,
                bool periodic) {
  topography::ReadOptions options;
  options.pitch_um = pitch_um;
  options.height_unit_um = height_unit_um;
  options.channel = channel;
  options.periodic = periodic;
  return std::make_shared<topography::HeightMap>(topography::read_height_map(path, options));
}

void add_tables(py::module_& module) {
  using Table = optics::SurfaceTable;
  const py::call_guard<py::gil_scoped_release> released;
  py::class_<Table>(module, "Table")
      .def("slices", [](const Table& table) { return table.slices().size(); })
      .def("slice", &slice_of)
      .def("write", [](const Table& table, const std::string& path) { optics::write_table(path, table); })
      .def("provenance", [](const Table& table) {
        const optics::TableProvenance& of = table.provenance();
        py::dict entry;
        entry["map"] = of.map;
        entry["stack"] = of.stack;
        entry["preparation"] = of.preparation;
        entry["tiling"] = of.tiling;
        entry["seed"] = of.seed;
        entry["rays_per_azimuth"] = of.rays_per_azimuth;
        entry["reciprocity"] = of.reciprocity;
        entry["version"] = of.version;
        return entry;
      });
  module.def(
      "read_table", [](const std::string& path) { return optics::read_table(path); }, released);
  module.def("build_table",
             [](const topography::HeightMap& map, double inside, double outside, std::uint64_t rays,
                std::uint64_t seed, bool directional, bool reciprocal, const py::object& progress) {
               topography::TableSettings settings;
               settings.rays = rays;
               settings.seed = seed;
               settings.directional = directional;
               settings.reciprocal = reciprocal;
               return build(map, inside, outside, settings, progress);
             });
}

void add_maps(py::module_& module) {
  using Map = topography::HeightMap;
  const py::call_guard<py::gil_scoped_release> released;
  py::class_<Map, MapPtr>(module, "HeightMap")
      .def("heights", &heights_of)
      .def("pitch_um", [](const Map& map) { return py::make_tuple(map.pitch_x_um, map.pitch_y_um); })
      .def("periodic", [](const Map& map) { return map.periodic; })
      .def("title", [](const Map& map) { return map.title; })
      .def("steps", [](const Map& map) { return map.steps; })
      .def("statistics", &statistics_of)
      .def("prepared", &prepared, released)
      .def("write", [](const Map& map, const std::string& path) { topography::write_gsf(path, map); })
      .def("visible_slope", [](const Map& map, double incidence_rad, std::uint64_t rays) {
        core::Estimate slope;
        WatchedWork work;
        raise_if(work.run([&] {
          slope = topography::mean_visible_slope(topography::make_height_field(map), optics::Side::inside,
                                                 incidence_rad, rays);
        }));
        return estimate(slope);
      });
  module.def("read_map", &read_map, released);
  module.def("map_from", &map_from);
  module.def("synthesize_map", &synthesized, released);
}

}  // namespace

void add_surfaces(py::module_& module) {
  add_tables(module);
  add_maps(module);
  module.def("definitions", [](const std::string& kind, const std::string& own) {
    return database_with(own).names(core::find_word(kKinds, kind).value());
  });
  module.def("medium", &medium_of);
  module.def("goniometer",
             [](const std::string& surface, const std::string& inside, const std::string& outside,
                double wavelength_nm, const std::vector<double>& incidence_rad, bool from_inside,
                std::uint64_t rays, std::uint64_t seed, double half_width_rad, const std::string& own) {
               analysis::GoniometerSettings settings;
               settings.side = from_inside ? optics::Side::inside : optics::Side::outside;
               settings.rays = rays;
               settings.seed = seed;
               settings.profile_half_width_rad = half_width_rad;
               return goniometer_of({surface, inside, outside, own, wavelength_nm, incidence_rad}, settings);
             });
}

}  // namespace scintray::python
