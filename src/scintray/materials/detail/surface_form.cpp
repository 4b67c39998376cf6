#include "scintray/materials/detail/forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/text.hpp"
#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/material_forms.hpp"

namespace scintray::materials {

namespace {

using Kind = config::TomlNode::Kind;

constexpr core::Word<optics::PaintPolarisation> kPaintPolarisations[] = {
    {"random", optics::PaintPolarisation::random}, {"geant4", optics::PaintPolarisation::geant4}};

/// Direction of the light that a reflector transmits: Reflector::undeflected.
constexpr core::Word<bool> kTransmittedLight[] = {{"as_reflected", false}, {"undeflected", true}};

void drop(config::TomlNode& table, const std::string& key) {
  std::erase_if(table.items, [&](const config::TomlNode& member) { return member.key == key; });
}

/// The value at a dotted key, or nullptr.
const config::TomlNode* find_path(const config::TomlNode& table, const std::string& path) {
  const config::TomlNode* node = &table;
  for (std::size_t start = 0; node && start <= path.size();) {
    const std::size_t end = std::min(path.find('.', start), path.size());
    node = node->kind == Kind::table ? node->find(path.substr(start, end - start)) : nullptr;
    start = end + 1;
  }
  return node;
}

/// mixture = [{ surface = "NAME", share = 0.6 }, { surface = "OTHER" }]: one may take the remaining share.
std::vector<ShareSpec> read_mixture(const config::TomlTable& table, const SurfaceLookup& lookup,
                                    core::Problems& problems) {
  constexpr double kRounding = 1e-9;
  const std::vector<config::TomlTable> parts = table.tables("mixture");
  std::vector<double> shares;
  std::optional<std::size_t> rest;
  double sum = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool given = parts[i].has("share");
    shares.push_back(given ? read_share(parts[i], "share", std::nullopt) : 0.0);
    sum += shares.back();
    if (!given && rest)
      parts[i].report("share", "two surfaces of a mixture have no share, but only one can take what is left",
                      "give all but one their share");
    if (!given) rest = i;
  }
  const bool whole = rest ? sum <= 1.0 + kRounding : std::abs(sum - 1.0) <= kRounding;
  table.expect(
      "mixture", parts.empty() || whole,
      "the shares of a mixture sum to " + std::to_string(sum) + "; expected " + (rest ? "at most 1" : "1"),
      "one surface without a share takes what the others leave");
  if (rest) shares[*rest] = std::max(0.0, 1.0 - sum);
  std::vector<ShareSpec> mixture;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string name = parts[i].string("surface");
    if (name.empty()) continue;
    try {
      mixture.push_back(
          {shares[i], std::make_shared<const SurfaceSpec>(lookup.surface(name, parts[i].where("surface")))});
    } catch (const core::InputError& error) {
      problems.add(error);
    }
  }
  return mixture;
}

MicrosurfaceSpec read_microsurface(const config::TomlTable& table, const SurfaceModels& models) {
  for (const SurfaceModel& model : models.all())
    if (!model.table.empty()) table.has(model.table);
  table.has("tracing");
  if (!table.has("model")) {
    table.report("model", "this surface has neither \"model\" nor \"base\"",
                 "add model = " + core::list_of(models.words(), " or ", [](const std::string& word) {
                   return '"' + word + '"';
                 }) + ", or the base = \"...\" of another surface");
    return FixedMicrosurface(optics::SmoothSurface());
  }
  const std::string word = table.choice("model", models.words());
  const SurfaceModel* model = table.good("model") ? models.find(word) : nullptr;
  return model ? model->read(table) : FixedMicrosurface(optics::SmoothSurface());
}

bool is_painted(const SurfaceSpec& surface) {
  return surface.microsurface->kind() == optics::MicrosurfaceKind::painted;
}

void read_gap(const config::TomlTable& table, const SurfaceLookup& lookup, core::Problems& problems,
              SurfaceSpec& surface) {
  const config::TomlNode* value = table.has("gap") ? table.node()->find("gap") : nullptr;
  if (!value) return;
  surface.gap = value->as_written();
  if (value->kind == Kind::string) {
    surface.gap = table.string("gap");
    if (surface.gap.empty()) return;
    try {
      const optics::Medium medium = lookup.medium(surface.gap, value->where);
      if (medium.birefringence)
        table.report("gap", "the gap's medium \"" + surface.gap + "\" is birefringent, which a gap cannot be",
                     "give the mean index, as gap = 1.57, or place the medium as a part of its own");
      surface.gap_index = medium.index;
      surface.gap_absorption_per_mm = medium.absorption_per_mm;
      surface.gap_shifter = medium.shifter;
    } catch (const core::InputError& error) {
      problems.add(error);
    }
    return;
  }
  const double index = table.number("gap");
  table.expect("gap", index >= 1.0 && index <= 5.0, "the index of a gap lies between 1 and 5",
               "give an index, or the name of a medium, as gap = \"air\"");
  surface.gap_index = core::Curve::constant(index);
}

/// Reports a face of a sheet that is not painted, or whose reflector is volume-like and transmits light.
void check_face_of_sheet(const config::TomlTable& table, const SurfaceSpec& surface,
                         const optics::Reflector& reflector) {
  table.expect("face_of_sheet", is_painted(surface),
               "only a painted surface is a face of a sheet: there is nothing else between the two faces",
               "use model = \"painted\", or remove face_of_sheet and give this face's own reflectance and "
               "transmittance");
  table.expect("face_of_sheet", !reflector.transmittance || reflector.volume_index <= 0.0,
               "reflector \"" + reflector.name +
                   "\" is volume-like and lets light through, which cannot be shared between two faces with "
                   "a space between them",
               "use a reflector without [volume], or paint one face only with it");
}

/// reflector = "NAME", with the surface's own specular share where present.
std::optional<optics::Reflector> read_named_reflector(const config::TomlTable& table, const SurfaceSpec&,
                                                      const SurfaceLookup& lookup, core::Problems& problems) {
  const std::string name = table.string("reflector");
  if (name.empty()) return std::nullopt;
  optics::Reflector reflector;
  try {
    reflector = lookup.reflector(name, table.where("reflector"));
  } catch (const core::InputError& error) {
    problems.add(error);
  }
  if (table.has("specular_share"))
    reflector.specular_share = read_share(table, "specular_share", std::nullopt);
  return reflector;
}

/// reflectance = CURVE, and the specular share.
std::optional<optics::Reflector> read_own_reflector(const config::TomlTable& table,
                                                    const SurfaceSpec& surface, const SurfaceLookup&,
                                                    core::Problems&) {
  optics::Reflector reflector;
  reflector.name = surface.name;
  reflector.reflectance = table.curve("reflectance", core::Dimension::dimensionless);
  expect_share(table, "reflectance", reflector.reflectance, "a reflectance");
  if (!table.has("specular_share")) {
    table.report("specular_share", "a reflectance is given without \"specular_share\", its direction",
                 "add specular_share = 0 for diffuse light (paint, PTFE), 1 for a mirror (foil), or between");
    return reflector;
  }
  reflector.specular_share = read_share(table, "specular_share", std::nullopt);
  return reflector;
}

using ReflectorReader = decltype(&read_named_reflector);
constexpr core::Word<ReflectorReader> kReflectorForms[] = {{"reflector", read_named_reflector},
                                                           {"reflectance", read_own_reflector}};

void read_surface_reflector(const config::TomlTable& table, const SurfaceLookup& lookup,
                            core::Problems& problems, SurfaceSpec& surface) {
  const core::Word<ReflectorReader>* form = table.one_of(kReflectorForms, false);
  for (const char* key :
       {"specular_share", "transmittance", "face_of_sheet", "polarisation_at_paint", "transmitted_light"})
    table.has(key);
  if (!form) return;
  std::optional<optics::Reflector> read = form->value(table, surface, lookup, problems);
  if (!read) return;
  optics::Reflector& reflector = *read;
  if (table.has("transmittance")) {
    reflector.transmittance = table.curve("transmittance", core::Dimension::dimensionless);
    expect_share(table, "transmittance", *reflector.transmittance, "a transmittance");
    expect_sheet(table, "transmittance", reflector);
  }
  if (reflector.transmittance && reflector.transmittance->max_y() <= 0.0) reflector.transmittance.reset();
  reflector.polarisation = table.choice("polarisation_at_paint", kPaintPolarisations, reflector.polarisation);
  table.expect("polarisation_at_paint",
               reflector.polarisation == optics::PaintPolarisation::random || reflector.volume_index <= 0.0,
               "Geant4 has no volume-like reflector",
               "write polarisation_at_paint = \"random\", or remove it");
  reflector.undeflected = table.choice("transmitted_light", kTransmittedLight, false);
  table.expect("transmitted_light", !reflector.undeflected || reflector.volume_index <= 0.0,
               "light that passes a volume-like reflector has no direction left to keep",
               "write transmitted_light = \"as_reflected\", or remove it");
  surface.face_of_sheet = table.boolean("face_of_sheet", false);
  if (surface.face_of_sheet) check_face_of_sheet(table, surface, reflector);
  surface.reflector = surface.face_of_sheet ? optics::face_of_sheet(reflector) : std::move(reflector);
}

/// Reports layers of a stack that are missing or that exclude each other.
void check_stack(const config::TomlTable& table, const SurfaceSpec& surface) {
  const bool painted = is_painted(surface);
  const bool reflector = table.has("reflector") || table.has("reflectance");
  if (painted && !reflector)
    table.report("reflector", "a painted surface has no reflector",
                 "give reflector = \"NAME\", or reflectance and specular_share");
  if (painted && table.has("gap"))
    table.report("gap", "a painted surface has a gap, but paint lies on the face itself",
                 "remove the gap, or use model = \"smooth\" under it");
  if (!painted && reflector && !table.has("gap"))
    table.report(
        "gap", "a reflector is given without the gap that separates it from the face",
        "give gap = \"air\", the medium of a glue, or an index; paint on the face is model = \"painted\"");
  const bool thick = table.has("gap_thickness");
  if (surface.gap_shifter && surface.gap_shifter->multiplies())
    table.report("gap",
                 "the gap's medium \"" + surface.gap +
                     "\" may re-emit several photons for one, which the layers of a surface cannot",
                 "make the coating a part of its own, or state statistics = \"single\" in it");
  if (surface.gap_shifter && !thick)
    table.report("gap",
                 "the gap's medium \"" + surface.gap +
                     "\" shifts wavelengths, but a gap without a thickness absorbs nothing",
                 "give the layer a gap_thickness: it is this over the absorption length optically thick");
  if (!reflector && table.has("gap") && !painted && !thick)
    table.report(
        "gap", "a gap is given without a reflector behind it",
        "what lies behind a surface without a reflector is the neighbouring part: remove the gap, give a "
        "reflector, or give the layer a gap_thickness");
  if (thick && !table.has("gap"))
    table.report("gap_thickness", "a gap_thickness is given without a gap",
                 "give gap = \"MEDIUM\", or remove it");
}

/// admitted = CURVE and undeflected = CURVE: what happens to light before it reaches the microsurface.
void read_admission(const config::TomlTable& table, SurfaceSpec& surface) {
  if (!table.has("admitted") && !table.has("undeflected")) return;
  optics::Admission admission{core::Curve::constant(1.0)};
  for (const auto& [key, curve] :
       {std::pair{"admitted", &admission.admitted}, std::pair{"undeflected", &admission.undeflected}}) {
    if (!table.has(key)) continue;
    *curve = table.curve(key, core::Dimension::dimensionless);
    expect_share(table, key, *curve, "a share of the light");
  }
  if (!table.has("admitted")) {
    table.report("admitted", "\"undeflected\" is given without \"admitted\"",
                 "give the share of the light that the surface reflects or refracts, as admitted = 0.9");
    return;
  }
  constexpr double kRounding = 1e-9;
  double most = 0.0;
  for (const core::Curve* curve : {&admission.admitted, &admission.undeflected})
    for (const double nm : curve->x())
      most = std::max(most, admission.admitted(nm) + admission.undeflected(nm));
  table.expect(
      table.has("undeflected") ? "undeflected" : "admitted", most <= 1.0 + kRounding,
      fmt::format("admitted and undeflected light come to {:.6g}; together they are at most 1", most),
      "what is left of 1 is absorbed: lower one of them where they exceed 1");
  surface.admission = std::move(admission);
}

}  // namespace

config::TomlNode merge_over_base(const config::TomlNode& base, const config::TomlNode& over,
                                 const SurfaceModels& models) {
  config::TomlNode merged = base;
  merged.key = over.key;
  merged.where = over.where;
  merged.key_where = over.key_where;
  const config::TomlNode* model = over.find("model");
  for (const SurfaceModel& known : models.all())
    if (model && !known.table.empty() && model->text != known.word) drop(merged, known.table);
  // Keys of a base on the light of its sheet are removed with that sheet.
  if (over.find("reflector") || (over.find("reflectance") && base.find("reflector")))
    drop(merged, "transmittance");
  if (over.find("reflector")) drop(merged, "reflectance");
  if (over.find("reflectance")) drop(merged, "reflector");
  for (const config::TomlNode& member : over.items) {
    config::TomlNode* old = merged.find(member.key);
    if (!old) {
      merged.items.push_back(member);
    } else if (old->kind == Kind::table && member.kind == Kind::table) {
      const config::TomlNode inner = merge_over_base(*old, member, models);
      *old = inner;
    } else {
      *old = member;
    }
  }
  return merged;
}

std::vector<std::string> missing_needs(const config::TomlNode& definition) {
  std::vector<std::string> missing;
  const config::TomlNode* needs = definition.find("needs");
  if (!needs || needs->kind != Kind::array) return missing;
  for (const config::TomlNode& need : needs->items) {
    bool present = false;
    for (std::size_t start = 0; start <= need.text.size() && !present;) {
      const std::size_t end = std::min(need.text.find(" or ", start), need.text.size());
      present = find_path(definition, need.text.substr(start, end - start)) != nullptr;
      start = end + 4;
    }
    if (!present) missing.push_back(need.text);
  }
  return missing;
}

SurfaceSpec read_surface(const config::TomlTable& table, const std::string& name, const SurfaceLookup& lookup,
                         core::Problems& problems) {
  SurfaceSpec surface;
  surface.name = name;
  surface.where = table.where();
  table.optional_string("base");
  table.optional_string("source");
  table.strings("needs", 0, false);
  surface.direction = table.optional_direction("direction").value_or(core::Vec3::Zero());
  if (table.has("mixture")) {
    surface.mixture = read_mixture(table, lookup, problems);
    for (const char* key : {"model", "gap", "gap_thickness", "reflector", "reflectance", "transmittance",
                            "direction", "admitted", "undeflected", "between_media_only"})
      if (table.has(key))
        table.report(key,
                     "a mixture is made of whole surfaces, and has no " + std::string(key) + " of its own",
                     "give it to the surfaces that the mixture names");
    return surface;
  }
  surface.gap_thickness_um = read_optional_um(table, "gap_thickness");
  surface.between_media_only = table.boolean("between_media_only", false);
  read_admission(table, surface);
  surface.microsurface = read_microsurface(table, lookup.models);
  read_gap(table, lookup, problems, surface);
  read_surface_reflector(table, lookup, problems, surface);
  check_stack(table, surface);
  return surface;
}

}  // namespace scintray::materials
