#pragma once
/// Surface tables whose building goes on where it was stopped.

#include "scintray/core/journal.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::topography {

/// As build_table(field, spectrum, settings, provenance, progress), with the same bits: nodes that a journal
/// has are taken from there, and others are added to it.
/// @param journal  of this very table
/// @throws also SystemError when the journal cannot be read or written
optics::SurfaceTable build_table(const optics::HeightField& field, const std::vector<SpectralPoint>& spectrum,
                                 const TableSettings& settings, optics::TableProvenance provenance,
                                 const TableProgress& progress, core::Journal& journal);

}  // namespace scintray::topography
