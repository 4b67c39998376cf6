#pragma once
/// Lists of hits that other programs write.

#include <cstdint>
#include <vector>

#include "scintray/scene_file/gamma_source.hpp"

namespace scintray::source {

/// One row of a list of hits.
struct Hit {
  std::uint64_t event = 0;
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  double energy_keV = 0.0;
  double time_ns = 0.0;   ///< as the file has it; 0 when it has no times
  std::uint64_t row = 0;  ///< line of a CSV file; place in the columns of an HDF5 file, from 0
};

/// Reads the columns that the specification names, in the file's order. Throws InputError with the first
/// rows that are no hits (an event number that is not a whole number from 0 on, a negative energy), and
/// for missing columns and columns of unequal length.
std::vector<Hit> read_hits_file(const scene_file::HitsSpec& spec);

}  // namespace scintray::source
