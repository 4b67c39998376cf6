#pragma once
/// Surface tables whose building continues where it was stopped.

#include "scintray/core/journal.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::topography {

/// As build_table(field, spectrum, settings, provenance, progress), bit-identically: nodes in the journal are
/// taken from it, and others are added to it.
/// @param journal  of this table
/// @throws also SystemError when the journal cannot be read or written
optics::SurfaceTable build_table(const optics::HeightField& field, const std::vector<SpectralPoint>& spectrum,
                                 const TableSettings& settings, optics::TableProvenance provenance,
                                 const TableProgress& progress, core::Journal& journal);

}  // namespace scintray::topography
