#pragma once
/// Entries for the files that ScintRay itself writes, and for scene files: results, response maps, surface
/// tables, files of block ranges. HDF5 files are without their seal, as damage in transit would leave nothing
/// to read.

#include "entries.hpp"

namespace scintray::fuzz {

std::span<const Entry> own_entries();

}  // namespace scintray::fuzz
