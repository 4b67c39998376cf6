#pragma once
/// Surfaces that a scene wants shown on an optical bench, beside what its crystals give (docs/analysis.md).

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene/tally_spec.hpp"
#include "scintray/scene/toml_reader.hpp"

namespace scintray {

struct BenchSpec {
  std::string title;
  std::vector<NameRef> surfaces;           ///< of the library or the scene, at least one
  NameRef inside;                          ///< medium from which the light comes
  std::vector<NameRef> outside;            ///< media behind the surface, at least one
  double wavelength_nm = 0.0;              ///< above 0
  std::vector<double> incidence_rad;       ///< angles of incidence, rising, in [0, 90 deg)
  double directions_at_rad = 0.0;          ///< the incidence at which directions are kept
  std::uint64_t rays = kFewestRays * 100;  ///< per incidence
  FileLocation where;

  static constexpr std::uint64_t kFewestRays = 1'000, kMostRays = 100'000'000;
};

/// [[bench]] of a scene. Adds what is wrong to the collector of the table.
std::vector<BenchSpec> read_benches(const TomlTable& scene);

}  // namespace scintray
