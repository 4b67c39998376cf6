#pragma once
/// [source] of type = "photon_list": photons of another program.

#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"

namespace scintray::scene_file {

/// Columns of a list of photons.
enum class PhotonColumn {
  event,  ///< whole numbers from 0 on
  x,      ///< with y and z the position, world
  y,
  z,
  direction_x,  ///< with the others the direction, of any length above 0
  direction_y,
  direction_z,
  polarisation_x,  ///< with the others the electric field's direction; zero: drawn at random
  polarisation_y,
  polarisation_z,
  wavelength,  ///< in vacuum
  energy,      ///< in place of the wavelength
  time
};
inline constexpr core::Word<PhotonColumn> kPhotonColumns[] = {
    {"event", PhotonColumn::event},
    {"x", PhotonColumn::x},
    {"y", PhotonColumn::y},
    {"z", PhotonColumn::z},
    {"direction_x", PhotonColumn::direction_x},
    {"direction_y", PhotonColumn::direction_y},
    {"direction_z", PhotonColumn::direction_z},
    {"polarisation_x", PhotonColumn::polarisation_x},
    {"polarisation_y", PhotonColumn::polarisation_y},
    {"polarisation_z", PhotonColumn::polarisation_z},
    {"wavelength", PhotonColumn::wavelength},
    {"energy", PhotonColumn::energy},
    {"time", PhotonColumn::time}};
/// One of each column, by PhotonColumn.
template <typename T>
using PerPhotonColumn = std::array<T, std::size(kPhotonColumns)>;

/// Photons in memory or of a file, one row each: columns of equal length in mm, nm and ns.
struct PhotonColumns {
  std::vector<double> event;  ///< empty: consecutive rows are events of photons_per_event
  std::vector<double> x_mm, y_mm, z_mm;
  std::vector<double> direction_x, direction_y, direction_z;
  std::vector<double> polarisation_x, polarisation_y, polarisation_z;  ///< empty: drawn at random
  std::vector<double> wavelength_nm;
  std::vector<double> time_ns;      ///< empty: all 0
  std::vector<std::uint64_t> rows;  ///< line of a CSV file, else number from 0; empty: numbers from 0
};

/// The member of PhotonColumns of a column: wavelengths for an energy.
std::vector<double> PhotonColumns::*column_member(PhotonColumn column);

struct PhotonListSpec;

/// The photons of a list, read when they are first needed, once for all copies of a specification.
class PhotonListContent {
 public:
  /// Throws InputError with the first rows that are wrong.
  const PhotonColumns& of(const PhotonListSpec& spec);

 private:
  std::mutex mutex_;
  std::optional<PhotonColumns> columns_;
};

/// Treatment of photons that cannot start: those in a part that absorbs all light.
enum class Misplaced {
  refuse,    ///< an error with the first of them
  leave_out  ///< counted in a note
};
inline constexpr core::Word<Misplaced> kMisplaced[] = {{"refuse", Misplaced::refuse},
                                                       {"leave_out", Misplaced::leave_out}};

/// type = "photon_list".
struct PhotonListSpec {
  std::filesystem::path file;  ///< empty with `arrays`
  bool arrays = false;         ///< the calling program sets `columns`
  /// In place of a file; null until the calling program has set it (simulation::SimulationOptions::change).
  std::shared_ptr<const PhotonColumns> columns;
  core::FileLocation where;
  std::string group;                     ///< of an HDF5 file, with the columns; empty: its root
  PerPhotonColumn<std::string> names{};  ///< of the file's columns; empty: not read
  double length_mm = 1.0;                ///< the file's unit of length
  double wavelength_nm = 1.0;            ///< of its wavelengths, where it has them
  double energy_eV = 1.0;                ///< of its energies, where it has them
  double time_ns = 1.0;                  ///< of its times, where it has them
  /// Photons of an event where the list has no events; 0: it has.
  std::uint64_t photons_per_event = 0;
  Misplaced misplaced = Misplaced::refuse;
  std::shared_ptr<PhotonListContent> content = std::make_shared<PhotonListContent>();

  /// The photons, checked: finite numbers, whole event numbers, directions above zero, wavelengths from 10 nm
  /// to 100 um, polarisations that are not along the direction. Throws InputError with the first rows that
  /// are not, and for columns in memory that were not set.
  const PhotonColumns& photons() const { return content->of(*this); }
  /// Origin of the rows for messages: the name of the file, or "the calling program".
  std::string origin() const { return arrays ? "the calling program" : file.string(); }
  /// Place of a row for messages: "row 3", or the file with the line.
  core::FileLocation place_of(std::size_t row) const;
};

/// The keys of [source] of this type, apart from type, events and quick_events.
/// @param unpolarised  receives whether light is to be unpolarised
PhotonListSpec read_photon_list(const config::TomlTable& table, bool& unpolarised);

}  // namespace scintray::scene_file
