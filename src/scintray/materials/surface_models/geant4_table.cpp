#include <fmt/format.h>

#include <cstdlib>

#include "scintray/core/share_hint.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/table_key.hpp"
#include "scintray/tables/davis.hpp"
#include "scintray/tables/geant4_finish.hpp"
#include "scintray/tables/lbnl.hpp"

namespace scintray::materials {

namespace {

/// Light from outside at a surface that Geant4 has for one direction.
enum class BackOfTable {
  smooth,  ///< Fresnel's equations, as where Geant4 has no border surface of this direction
  mirror,
  absorb,
  same,  ///< the table, as Geant4 uses that of a skin surface
};

constexpr core::Word<BackOfTable> kBacks[] = {{"smooth", BackOfTable::smooth},
                                              {"mirror", BackOfTable::mirror},
                                              {"absorb", BackOfTable::absorb},
                                              {"same", BackOfTable::same}};

/// A table of Geant4's model DAVIS or LUT. Light from inside is scattered by the table, whatever the indices,
/// as in Geant4 (G4OpBoundaryProcess::DielectricLUTDAVIS and DielectricLUT); it obeys neither reciprocity nor
/// Snell's law beyond what the table has of them.
class Geant4TableSurface : public optics::MicrosurfaceModel {
 public:
  Geant4TableSurface(optics::SurfaceTable table, BackOfTable back)
      : table_(std::make_shared<const optics::SurfaceTable>(std::move(table))), back_(back) {}

  optics::SurfaceOutcome scatter(optics::Ray& ray, optics::Side side, const optics::IndexPair& index,
                                 optics::SurfaceInteraction& at) const override {
    const bool from_inside = side == optics::Side::inside;
    if (from_inside || back_ == BackOfTable::same) {
      const core::Vec3 onward = from_inside ? at.normal : core::Vec3(-at.normal);
      const optics::SurfaceOutcome outcome =
          table_->interact(ray, optics::Side::inside, onward, core::Vec3::Zero(), at.wavelength_nm, at.rng);
      if (outcome == optics::SurfaceOutcome::absorbed) return outcome;
      return optics::outcome_on(outcome == optics::SurfaceOutcome::inside ? side : optics::other(side));
    }
    if (back_ == BackOfTable::absorb) return optics::SurfaceOutcome::absorbed;
    if (back_ == BackOfTable::smooth) return optics::SmoothSurface().scatter(ray, side, index, at);
    optics::reflect(ray, at.normal);
    return optics::outcome_on(side);
  }

  bool opaque() const override { return table_->opaque(); }

 private:
  std::shared_ptr<const optics::SurfaceTable> table_;
  BackOfTable back_;
};

/// The data folder: `folder`, else that of the environment; empty, and reported, without either.
std::filesystem::path data_folder_of(const config::TomlTable& table) {
  if (table.has("folder")) {
    const std::filesystem::path named = table.string("folder");
    if (named.empty() || named.is_absolute()) return named;
    return std::filesystem::path(table.where("folder").file).parent_path() / named;
  }
  const char* set = std::getenv(tables::kSurfaceDataVariable);
  if (set != nullptr && *set != '\0') return set;
  table.report(
      "folder",
      "a finish of Geant4 needs the folder of its data, and neither \"folder\" nor the environment "
      "variable G4REALSURFACEDATA names one",
      "write folder = \"PATH/RealSurface2.2\" with the folder of Geant4's data set RealSurface, or set "
      "G4REALSURFACEDATA");
  return {};
}

std::vector<std::string> finish_names() {
  std::vector<std::string> names = tables::davis_finishes();
  for (const auto* more : {&tables::customized_finishes(), &tables::lbnl_finishes()})
    names.insert(names.end(), more->begin(), more->end());
  return names;
}

MicrosurfaceSpec read_geant4_table(const config::TomlTable& surface) {
  const config::TomlTable table = surface.table("geant4_table");
  const std::string finish = table.choice("finish", finish_names());
  const bool davis = tables::is_davis_finish(finish);
  tables::ImportSettings settings{{1.0, 1.0}, tables::FromOutside::absorb};
  settings.unreflected = table.choice("unreflected", tables::kUnreflectedWords, settings.unreflected);
  table.expect("unreflected", davis,
               "\"unreflected\" is given for \"" + finish + "\", a finish that transmits nothing",
               "remove it; what the reflectance leaves is absorbed");
  settings.reflectance = table.quantity("reflectance", core::Dimension::dimensionless, 1.0);
  table.expect("reflectance", !davis,
               "\"reflectance\" is given for \"" + finish + "\", whose table has its own", "remove it");
  table.expect("reflectance", settings.reflectance > 0.0 && settings.reflectance <= 1.0,
               fmt::format("\"reflectance\" is {:g}, but a share above 0, at most 1, is expected",
                           settings.reflectance),
               core::share_hint(settings.reflectance));
  const BackOfTable back = table.choice("from_outside", kBacks, BackOfTable::smooth);
  const std::filesystem::path folder = data_folder_of(table);
  bool good = table.good("finish") && !folder.empty();
  for (const char* key : {"unreflected", "reflectance", "from_outside", "folder"})
    good = good && (!table.has(key) || table.good(key));
  if (!good) return FixedMicrosurface(optics::SmoothSurface());
  try {
    const std::filesystem::path file = tables::finish_file(folder, finish);
    std::string key = "Geant4 table " + file_key(file);
    if (davis) key += " " + file_key(tables::davis_files(file).reflectances);
    key += fmt::format(" {} {} {:a}", core::word_of(tables::kUnreflectedWords, settings.unreflected),
                       core::word_of(kBacks, back), settings.reflectance);
    return FixedMicrosurface(
        Geant4TableSurface(davis ? tables::read_davis(file, settings) : tables::read_lbnl(file, settings),
                           back),
        std::move(key));
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems())
      table.report("finish", (problem.where.file.empty() ? "" : problem.where.file + ": ") + problem.what,
                   problem.hint);
    return FixedMicrosurface(optics::SmoothSurface());
  }
}

}  // namespace

SurfaceModel geant4_table_model() {
  return {.word = "geant4_table", .table = "geant4_table", .read = read_geant4_table};
}

}  // namespace scintray::materials
