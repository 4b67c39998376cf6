#include "scintray/scene_file/photon_list.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/config/columns.hpp"
#include "scintray/scene_file/detail/column_keys.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

constexpr std::size_t kMostProblems = 10;
constexpr double kGreatestEvent = 9007199254740992.0;  // 2^53: whole numbers are exact up to here
constexpr double kShortest_nm = 10.0, kLongest_nm = 1e5;
/// Least sine of the angle between direction and polarisation.
constexpr double kLeastAcross = 1e-3;

/// Polarisations of the photons of a list.
enum class Polarisation { random, unpolarised, listed };
constexpr core::Word<Polarisation> kPolarisations[] = {{"random", Polarisation::random},
                                                       {"unpolarised", Polarisation::unpolarised},
                                                       {"listed", Polarisation::listed}};

/// Units for the photons' energies: of one of two columns.
enum class Colour { wavelength, energy };
constexpr core::Word<Colour> kColours[] = {{"wavelength_unit", Colour::wavelength},
                                           {"energy_unit", Colour::energy}};

constexpr std::size_t at(PhotonColumn column) { return static_cast<std::size_t>(column); }

PhotonColumns read_file(const PhotonListSpec& spec) {
  const std::vector<std::string> names(spec.names.begin(), spec.names.end());
  config::Columns read = config::read_columns({spec.file, spec.group, spec.where}, names);
  PhotonColumns photons;
  photons.rows = std::move(read.rows);
  for (const core::Word<PhotonColumn>& column : kPhotonColumns)
    if (!names[at(column.value)].empty())
      photons.*column_member(column.value) = std::move(read.values[at(column.value)]);
  for (std::vector<double>* lengths : {&photons.x_mm, &photons.y_mm, &photons.z_mm})
    for (double& value : *lengths) value *= spec.length_mm;
  const bool energies = !spec.names[at(PhotonColumn::energy)].empty();
  for (double& value : photons.wavelength_nm)
    value = energies ? core::kHc_eV_nm / (value * spec.energy_eV) : value * spec.wavelength_nm;
  for (double& value : photons.time_ns) value *= spec.time_ns;
  return photons;
}

/// Throws InputError unless the columns are equally long, and those that are always needed are there.
void check_lengths(const PhotonColumns& photons, const PhotonListSpec& spec) {
  const std::size_t rows = photons.x_mm.size();
  if (rows == 0)
    throw core::InputError({spec.where, "there are no photons in " + spec.origin(), "give one row at least"});
  for (const core::Word<PhotonColumn>& column : kPhotonColumns) {
    const std::size_t length = (photons.*column_member(column.value)).size();
    const bool optional =
        column.value == PhotonColumn::time ||
        (column.value >= PhotonColumn::polarisation_x && column.value <= PhotonColumn::polarisation_z) ||
        (column.value == PhotonColumn::event && spec.photons_per_event > 0);
    if (length == rows || (length == 0 && optional)) continue;
    throw core::InputError({spec.where,
                            std::string("the column ") + column.word + " of the photons has " +
                                std::to_string(length) + " rows, and x has " + std::to_string(rows),
                            "set one number per photon in each"});
  }
  const std::size_t across = photons.polarisation_x.size();
  if (photons.polarisation_y.size() != across || photons.polarisation_z.size() != across)
    throw core::InputError({spec.where, "a polarisation has one or two of its three components",
                            "give polarisation_x, polarisation_y and polarisation_z, or none"});
}

/// Fault of a row; empty for a valid one.
std::string fault_of(const PhotonColumns& photons, std::size_t i) {
  for (const core::Word<PhotonColumn>& column : kPhotonColumns) {
    const std::vector<double>& values = photons.*column_member(column.value);
    // An energy of zero has no finite wavelength, and is reported below.
    if (!values.empty() && !std::isfinite(values[i]) && column.value < PhotonColumn::wavelength)
      return std::string(column.word) + " is not a finite number";
  }
  if (!photons.time_ns.empty() && !std::isfinite(photons.time_ns[i])) return "time is not a finite number";
  if (!photons.event.empty()) {
    const double event = photons.event[i];
    if (!(event >= 0.0 && event < kGreatestEvent && event == std::floor(event)))
      return "the event " + std::to_string(event) + " is not a whole number from 0 on";
  }
  const double nm = photons.wavelength_nm[i];
  if (!(nm >= kShortest_nm && nm <= kLongest_nm))
    return "the wavelength " + std::to_string(nm) + " nm is not from 10 to 100,000 nm";
  const core::Vec3 direction(photons.direction_x[i], photons.direction_y[i], photons.direction_z[i]);
  if (!(direction.norm() > 0.0)) return "the direction is zero";
  if (photons.polarisation_x.empty()) return {};
  const core::Vec3 field(photons.polarisation_x[i], photons.polarisation_y[i], photons.polarisation_z[i]);
  if (field.norm() > 0.0 && field.normalized().cross(direction.normalized()).norm() < kLeastAcross)
    return "the polarisation is along the direction, and must be across it";
  return {};
}

void check(const PhotonColumns& photons, const PhotonListSpec& spec) {
  check_lengths(photons, spec);
  core::Problems problems;
  for (std::size_t i = 0; i < photons.x_mm.size() && problems.list().size() < kMostProblems; ++i) {
    const std::string fault = fault_of(photons, i);
    if (fault.empty()) continue;
    const core::FileLocation place = spec.place_of(photons.rows.empty() ? i : photons.rows[i]);
    problems.add(place, (place.line > 0 ? "" : "row " + std::to_string(i) + ": ") + fault,
                 spec.arrays ? "set finite numbers in mm, nm and ns"
                             : "check the units, and which columns are named in [source.columns]");
  }
  problems.throw_if_any();
}

void read_columns(const config::TomlTable& table, bool polarised, PhotonListSpec& list) {
  const bool energies = table.has("energy_unit"), times = table.has("time_unit");
  const auto is_read = [&](PhotonColumn column) {
    if (column == PhotonColumn::event) return list.photons_per_event == 0;
    if (column >= PhotonColumn::polarisation_x && column <= PhotonColumn::polarisation_z) return polarised;
    if (column == PhotonColumn::wavelength) return !energies;
    if (column == PhotonColumn::energy) return energies;
    return column != PhotonColumn::time || times;
  };
  const auto remedy = [](PhotonColumn column) {
    return column == PhotonColumn::event        ? "remove photons_per_event"
           : column == PhotonColumn::wavelength ? "give wavelength_unit in place of energy_unit"
           : column == PhotonColumn::energy     ? "give energy_unit in place of wavelength_unit"
           : column == PhotonColumn::time       ? "add time_unit, as \"ns\""
                                                : "add polarisation = \"listed\"";
  };
  const std::optional<config::TomlTable> columns = table.optional_table("columns");
  for (const auto& [key, column] : kPhotonColumns) {
    const bool read = is_read(column);
    std::string name = columns ? columns->string(key, read ? key : "") : read ? key : "";
    if (columns && !read) columns->expect(key, name.empty(), "a column that is not read", remedy(column));
    if (read) list.names[at(column)] = std::move(name);
  }
}

}  // namespace

std::vector<double> PhotonColumns::*column_member(PhotonColumn column) {
  constexpr std::vector<double> PhotonColumns::*kMembers[] = {
      &PhotonColumns::event,          &PhotonColumns::x_mm,           &PhotonColumns::y_mm,
      &PhotonColumns::z_mm,           &PhotonColumns::direction_x,    &PhotonColumns::direction_y,
      &PhotonColumns::direction_z,    &PhotonColumns::polarisation_x, &PhotonColumns::polarisation_y,
      &PhotonColumns::polarisation_z, &PhotonColumns::wavelength_nm,  &PhotonColumns::wavelength_nm,
      &PhotonColumns::time_ns};
  return kMembers[at(column)];
}

core::FileLocation PhotonListSpec::place_of(std::size_t row) const {
  const bool csv = !arrays && config::column_format(file) == config::ColumnFormat::csv;
  return {origin(), csv ? static_cast<long>(row) : 0, 0};
}

const PhotonColumns& PhotonListContent::of(const PhotonListSpec& spec) {
  if (spec.arrays && !spec.columns)
    throw core::InputError(
        {spec.where, "the photons of this scene come from a program, which did not set them",
         "run the scene from Python with run(photon_list=...), or name a file of photons"});
  const std::lock_guard lock(mutex_);
  if (!columns_) {
    PhotonColumns photons = spec.arrays ? *spec.columns : read_file(spec);
    check(photons, spec);
    columns_ = std::move(photons);
  }
  return *columns_;
}

PhotonListSpec read_photon_list(const config::TomlTable& table, bool& unpolarised) {
  PhotonListSpec list;
  list.where = table.where();
  const Polarisation polarisation = table.choice("polarisation", kPolarisations, Polarisation::random);
  unpolarised = polarisation == Polarisation::unpolarised;
  list.misplaced = table.choice("misplaced", kMisplaced, Misplaced::refuse);
  if (const auto photons = table.optional_integer("photons_per_event"))
    list.photons_per_event = positive_count(table, "photons_per_event", *photons);
  list.arrays = table.boolean("arrays", false);
  if (list.arrays) {
    list.where = table.where("arrays");
    if (table.has("file"))
      table.report("file", "a file of photons beside arrays = true", "remove one of them");
    return list;
  }
  list.where = table.where("file");
  list.file = table.existing_file("file");
  list.group = read_column_group(table, list.file, "photons");
  list.length_mm = read_unit(table, "length_unit", core::Dimension::length);
  if (const core::Word<Colour>* colour = table.one_of(kColours, true)) {
    if (colour->value == Colour::wavelength)
      list.wavelength_nm = 1e6 * read_unit(table, colour->word, core::Dimension::length);
    else
      list.energy_eV = 1e3 * read_unit(table, colour->word, core::Dimension::energy);
  }
  if (table.has("time_unit")) list.time_ns = read_unit(table, "time_unit", core::Dimension::time);
  read_columns(table, polarisation == Polarisation::listed, list);
  return list;
}

}  // namespace scintray::scene_file
