#pragma once
/// Geant4's finishes that are tables: names of G4OpticalSurfaceFinish, and the files of their data in the
/// folder that the environment variable G4REALSURFACEDATA names.
///
/// Source: G4OpticalSurface.hh and G4OpticalSurface.cc (ReadLUTFile, ReadLUTDAVISFile), release 11.

#include <filesystem>
#include <optional>
#include <string>
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

/// True for one of the names of davis_finishes().
bool is_davis_finish(const std::string& finish);

/// Stem of the file of a finish, as "PolishedLumirror" or "Rough_LUT". Nothing for the bare finishes of LBNL,
/// and for other names.
std::optional<std::string> data_stem(const std::string& finish);

/// File of a finish in a folder: STEM.z, or STEM.dat where there is no such file (data sets up to 2.1).
/// Throws InputError with the folder, the expected names and a hint when the folder or the
/// file does not exist, and for the bare finishes.
std::filesystem::path finish_file(const std::filesystem::path& folder, const std::string& finish);

}  // namespace scintray::tables
