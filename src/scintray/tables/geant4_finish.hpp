#pragma once
/// Geant4's finishes that are tables: names of G4OpticalSurfaceFinish, and the files of their data in the
/// folder that the environment variable G4REALSURFACEDATA names.
///
/// Source: G4OpticalSurface.hh and G4OpticalSurface.cc (ReadLUTFile, ReadLUTDAVISFile, ReadDichroicFile),
/// release 11.4.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::tables {

/// Environment variable with the folder of Geant4's surface data.
inline constexpr const char* kSurfaceDataVariable = "G4REALSURFACEDATA";

/// Names of the finishes of the model LUT in the order of Geant4's enumeration, 24: {polished, etched,
/// ground} x {lumirrorair, lumirrorglue, air, teflonair, tioair, tyvekair, vm2000air, vm2000glue}. Those of
/// bare faces, as polishedair, have no data.
const std::vector<std::string>& lbnl_finishes();
/// Names of the finishes of the model DAVIS in the order of Geant4's enumeration, 9: Rough_LUT to
/// Detector_LUT.
const std::vector<std::string>& davis_finishes();

/// Names of finishes of the model DAVIS that Surfaces.xml of GATE 9 and SurfaceProperties.xml of GATE 10 have
/// beside Geant4's own, for tables of the user's: Customized_LUT to Customized5_LUT, CustomizedDetector_LUT.
/// Geant4 itself does not know them, and GATE 10 with it refuses them (opengate, physics.py); programs whose
/// Geant4 was extended read the pair of this name.
const std::vector<std::string>& customized_finishes();

/// True for one of the names of davis_finishes() and customized_finishes().
bool is_davis_finish(const std::string& finish);

/// Stem of the file of a finish, as "PolishedLumirror" or "Rough_LUT". Nothing for the bare finishes of LBNL,
/// and for other names.
std::optional<std::string> data_stem(const std::string& finish);

/// File of a finish in a folder: STEM.z, or STEM.dat where there is no such file (data sets up to 2.1).
/// Throws InputError with the folder, the expected names and a hint when the folder or the
/// file does not exist, and for the bare finishes.
std::filesystem::path finish_file(const std::filesystem::path& folder, const std::string& finish);

/// Environment variable with the file of a dichroic surface.
inline constexpr const char* kDichroicVariable = "G4DICHROICDATA";

/// Transmittance of a dichroic surface.
struct DichroicTable {
  std::vector<double> wavelength_nm, angle_deg;  ///< rising, two each at least; angles of incidence up to 90
  std::vector<std::vector<double>> transmittance;  ///< shares 0 to 1 by angle, then by wavelength
};

/// The file of Geant4's type dielectric_dichroic, a text of numbers as G4Physics2DVector::Retrieve reads it:
/// a number without effect, the numbers of wavelengths and of angles, the wavelengths (nm), the angles (deg),
/// and for each angle the transmittances in percent.
/// Throws InputError, naming the file, as parse_numbers; for sizes below 2 or that differ from the count of
/// the numbers; for wavelengths or angles that do not rise or are out of range, and percents beyond 0 to 100.
DichroicTable read_dichroic(const std::filesystem::path& file);
/// The same of the content of a file, whose name is for messages.
DichroicTable parse_dichroic(std::string_view content, const std::string& file);

}  // namespace scintray::tables
