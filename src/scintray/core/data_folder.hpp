#pragma once
/// Location of the data installed with ScintRay: materials/, scenes/, geometry/.

#include <filesystem>

namespace scintray::core {

/// The folder that holds `materials/`. The first that exists of: the environment variable
/// SCINTRAY_DATA; ../share/scintray beside the running program; the source tree this library was
/// built from; share/scintray below the prefix it was configured for.
///
/// Throws InputError when SCINTRAY_DATA names a folder without `materials/`, and SystemError, with
/// the list of folders tried, when there is none.
std::filesystem::path data_folder();

}  // namespace scintray::core
