#pragma once
/// Surface tables in HDF5 files that hold something else beside them.

#include "scintray/core/h5.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::optics {

/// Writes a table into the root group of a file. Throws SystemError as Group does.
void write_table(core::h5::Group root, const SurfaceTable& table);
/// The table of an open file, with the errors of read_table.
SurfaceTable read_table(const core::h5::File& file);

}  // namespace scintray::optics
