#include "scintray/cli/table_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "scintray/cli/count_option.hpp"
#include "scintray/cli/interrupt.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/wavelength_cover.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"

namespace scintray::cli {

namespace {

optics::Medium side_medium(const materials::MaterialDatabase& database, const std::string& name, double index,
                           const std::string& side) {
  if (name.empty() == (index == 0.0))
    throw core::InputError({{},
                            "the medium " + side + " is " + (name.empty() ? "not given" : "given twice"),
                            "give either --" + side + " MEDIUM, as LSO, or --" + side + "-index, as 1.82"});
  if (!name.empty()) return database.medium(name);
  optics::Medium medium;
  medium.name = fmt::format("index {:g}", index);
  medium.index = core::Curve::constant(index);
  return medium;
}

}  // namespace

void add_tracing_options(CLI::App& app, TracingOptions& options) {
  app.add_option("--scene", options.scene,
                 "Scene file, or file of definitions, whose own media and surfaces are used as well");
  app.add_option("--inside", options.inside, "Medium of the part with the face, as LSO");
  app.add_option("--inside-index", options.inside_index, "... or its refractive index")->check(above_zero());
  app.add_option("--outside", options.outside, "Medium outside, as air");
  app.add_option("--outside-index", options.outside_index, "... or its refractive index")
      ->check(above_zero());
  app.add_option("--wavelength", options.wavelengths,
                 "Wavelengths to tabulate, as \"420 nm\"; required with media")
      ->delimiter(',');
  app.add_option("--rays", options.settings.rays, "Rays per incidence angle and azimuth")
      ->capture_default_str();
  app.add_option("--target-error", options.settings.target_error,
                 "Add rays until the reflectance of every node has this standard error")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--most-rays", options.settings.most_rays, "... at most this many times --rays")
      ->capture_default_str();
  app.add_flag("--directional", options.settings.directional,
               "For anisotropic surfaces: a slice of the table for every azimuth of incidence");
  app.add_flag("--reciprocal", options.settings.reciprocal,
               "Make the table of a lossless surface exactly reciprocal, and print its deviation before");
  app.add_option("--seed", options.settings.seed, "Seed of the random numbers")->capture_default_str();
  app.add_option("--incidence-step", options.incidence_step, "Step of incidence, \"2.25 deg\" unless given");
  app.add_option("--azimuth-step", options.azimuth_step, "Step of azimuth, \"9 deg\" unless given");
  app.add_flag("--no-refine", options.no_refine, "No extra nodes where the reflectance changes fast");
}

materials::MaterialDatabase database_of(const TracingOptions& options) {
  return options.scene.empty() ? materials::MaterialDatabase::shipped()
                               : scene::database_for(scene_file::SceneFile::load_definitions(options.scene));
}

Between between(const TracingOptions& options, const materials::MaterialDatabase& database) {
  Between result{side_medium(database, options.inside, options.inside_index, "inside"),
                 side_medium(database, options.outside, options.outside_index, "outside"),
                 {}};
  for (const std::string& text : options.wavelengths)
    result.wavelengths_nm.push_back(core::parse_quantity(text, core::Dimension::wavelength));
  std::sort(result.wavelengths_nm.begin(), result.wavelengths_nm.end());
  if (result.wavelengths_nm.empty() && !(options.inside.empty() && options.outside.empty()))
    throw core::InputError({{},
                            "media are given, but no wavelength",
                            "give --wavelength \"420 nm\", or several: --wavelength \"400 nm,420 nm\""});
  core::Problems problems;
  for (const optics::Medium* medium : {&result.inside, &result.outside})
    for (const double nm : result.wavelengths_nm) materials::check_cover(problems, {}, *medium, nm, nm);
  problems.throw_if_any();
  return result;
}

std::vector<topography::SpectralPoint> Between::spectrum() const {
  if (wavelengths_nm.empty()) return {{0.0, {inside.index(0.0), outside.index(0.0)}}};
  std::vector<topography::SpectralPoint> points;
  for (const double nm : wavelengths_nm) points.push_back({nm, {inside.index(nm), outside.index(nm)}});
  return points;
}

topography::TableSettings settings_of(const TracingOptions& options) {
  topography::TableSettings settings = options.settings;
  if (!options.incidence_step.empty())
    settings.incidence_step_rad = core::parse_quantity(options.incidence_step, core::Dimension::angle);
  if (!options.azimuth_step.empty())
    settings.azimuth_step_rad = core::parse_quantity(options.azimuth_step, core::Dimension::angle);
  settings.refine = !options.no_refine;
  return settings;
}

std::shared_ptr<const optics::SurfaceTable> table_with_progress(
    const std::optional<materials::CacheEntry>& entry, const BuildTable& build) {
  const InterruptGuard guard;
  ProgressLine line(true);
  const ActivityWatch watch(line);
  const auto traced = [&] {
    return build([&](double share) {
      InterruptGuard::keeps_results(true);  // in the journal
      line.show("table", 100.0 * share, 100.0, "percent");
      return !InterruptGuard::requested();
    });
  };
  auto table = entry ? materials::TableCache(watched_surfaces(line)).get(*entry, traced)
                     : std::make_shared<const optics::SurfaceTable>(traced());
  line.clear();
  return table;
}

Json table_json(const optics::SurfaceTable& table) {
  const optics::TableProvenance& p = table.provenance();
  Json slices = Json::array();
  for (const optics::TableSlice& slice : table.slices()) {
    Json one = {{"index_inside", json_of(slice.index.inside)},
                {"index_outside", json_of(slice.index.outside)},
                {"wavelength_nm", slice.wavelength_nm > 0.0 ? Json(slice.wavelength_nm) : Json(nullptr)},
                {"azimuth_deg", json_of(slice.azimuth_rad / core::kDegree)}};
    for (const optics::Side side : {optics::Side::inside, optics::Side::outside}) {
      Json nodes = Json::array();
      for (const optics::TableNode& node : slice.nodes(side))
        nodes.push_back({{"incidence_deg", json_of(node.incidence_rad / core::kDegree)},
                         {"reflectance", json_of(node.reflectance)},
                         {"reflectance_error", json_of(node.reflectance_error)},
                         {"absorptance", json_of(node.absorptance)},
                         {"mean_slope_deg", json_of(node.mean_slope_rad / core::kDegree)}});
      one[side == optics::Side::inside ? "from_inside" : "from_outside"] = std::move(nodes);
    }
    slices.push_back(std::move(one));
  }
  return {{"map", p.map},
          {"stack", p.stack},
          {"rays_per_azimuth", p.rays_per_azimuth},
          {"azimuths", p.azimuths},
          {"seed", p.seed},
          {"unclassified", p.unclassified},
          {"cut", p.cut},
          {"unconverged", p.unconverged},
          {"version", p.version},
          {"slices", slices}};
}

void write_and_report(const std::string& path, const optics::SurfaceTable& table) {
  optics::write_table(path, table);
  const optics::TableProvenance& p = table.provenance();
  std::size_t nodes = 0;
  for (const optics::TableSlice& slice : table.slices())
    nodes += slice.from_inside.size() + slice.from_outside.size();
  std::cout << fmt::format(
      "table        {} wavelengths, {} azimuths, {} nodes in all; {} rays unclassified, {} cut\n",
      table.wavelengths_nm().size(), table.azimuths(), nodes, p.unclassified, p.cut);
  if (p.unconverged > 0)
    std::cout << fmt::format(
        "warning      {} nodes have a larger error than {:g} at the most rays allowed; raise --most-rays\n",
        p.unconverged, p.target_error);
  if (!p.reciprocity.empty()) std::cout << "reciprocal   " << p.reciprocity << "\n";
  std::cout << "written      " << path << "\n";
}

}  // namespace scintray::cli
