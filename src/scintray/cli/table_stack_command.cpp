#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/table_options.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/materials/table_key.hpp"
#include "scintray/materials/wavelength_cover.hpp"

namespace scintray::cli {

namespace {

struct StackArguments {
  bool json = false;
  std::string surface, output;
  TracingOptions tracing;
};

std::string describe(const materials::SurfaceSpec& spec) {
  if (!spec.mixture.empty()) {
    std::string text;
    for (const materials::ShareSpec& part : spec.mixture)
      text += fmt::format("{}{:g} of {}", text.empty() ? "" : ", ", part.share, describe(*part.surface));
    return text;
  }
  std::string text = spec.name;
  if (!spec.gap.empty()) text += " | " + spec.gap;
  if (spec.gap_thickness_um) text += fmt::format(" {:g} um", *spec.gap_thickness_um);
  if (spec.reflector) text += " | " + spec.reflector->name;
  return text;
}

/// The surface between the media, with its height maps. @throws InputError when it shifts wavelengths
optics::Surface surface_of(const materials::SurfaceSpec& spec, const Between& media) {
  const double nm = media.wavelengths_nm.empty() ? 0.0 : media.wavelengths_nm.front();
  optics::Surface surface =
      materials::SurfaceFactory().make(spec, media.inside, media.outside, nm, nm, nm).surface;
  if (surface.shifts())
    throw core::InputError(core::Problem{
        spec.where,
        "surface \"" + spec.name + "\" re-emits light at other wavelengths, which a table cannot represent",
        "use the surface itself in a scene"});
  return surface;
}

optics::TableProvenance provenance_of(const materials::SurfaceSpec& spec) {
  optics::TableProvenance provenance;
  provenance.map = spec.name;
  provenance.stack = describe(spec);
  provenance.preparation = "as in the surface's definition";
  provenance.tiling = "as in the surface's definition";
  return provenance;
}

void build(const StackArguments& arguments) {
  const JsonAnswer answer(arguments.json);
  const materials::MaterialDatabase database = database_of(arguments.tracing);
  const materials::SurfaceSpec spec = materials::traced_on_the_spot(database.surface(arguments.surface));
  const Between media = between(arguments.tracing, database);
  core::Problems problems;
  for (const double at : media.wavelengths_nm) materials::check_cover(problems, spec, at, at);
  problems.throw_if_any();
  const std::vector<topography::SpectralPoint> spectrum = media.spectrum();
  const topography::TableSettings settings = settings_of(arguments.tracing);
  std::optional<materials::CacheEntry> entry;
  if (const std::optional<std::string> stack = materials::stack_key(spec)) {
    const std::string named = fmt::format("stack {}, {}: {}", spec.name, describe(spec), *stack);
    entry = {materials::table_key(named, settings, spectrum), spec.name, media.names()};
  }
  const auto trace = [&](const topography::TableProgress& progress) {
    return topography::build_stack_table(surface_of(spec, media), spectrum, settings, provenance_of(spec),
                                         progress);
  };
  const std::shared_ptr<const optics::SurfaceTable> built = table_with_progress(entry, trace);
  write_and_report(arguments.output, *built);
  answer.print([&] { return table_json(*built); });
}

}  // namespace

void add_table_stack_command(CLI::App& table) {
  auto arguments = std::make_shared<StackArguments>();
  CLI::App* app = table.add_subcommand("stack",
                                       "Trace a complete surface of the material database, with its gap, "
                                       "reflector and shares, into one table");
  app->add_option("surface", arguments->surface, "Name of the surface")->required();
  app->add_option("-o,--output", arguments->output, "Table file to write (HDF5)")->required();
  add_tracing_options(*app, arguments->tracing);
  add_json_flag(*app, arguments->json);
  app->footer(
      "Example: scintray table stack lso_polished_esr_air --inside LSO --outside air --wavelength \"420 nm\" "
      "-o polished.h5");
  app->callback([arguments] { build(*arguments); });
}

}  // namespace scintray::cli
