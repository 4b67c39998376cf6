#pragma once
/// Goniometer measurements of surfaces requested by a scene (docs/analysis.md).

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"

namespace scintray::scene_file {

struct GoniometerSpec {
  std::string title;
  std::vector<config::NameRef> surfaces;   ///< of the database or the scene, at least one
  config::NameRef inside;                  ///< medium of incidence
  std::vector<config::NameRef> outside;    ///< media behind the surface, at least one
  double wavelength_nm = 0.0;              ///< above 0
  std::vector<double> incidence_rad;       ///< angles of incidence, rising, in [0, 90 deg)
  double directions_at_rad = 0.0;          ///< angle of incidence at which directions are recorded
  std::uint64_t rays = kFewestRays * 100;  ///< per incidence
  core::FileLocation where;

  static constexpr std::uint64_t kFewestRays = 1'000, kMostRays = 100'000'000;
};

/// Goniometers: [[bench]] of a scene. Adds errors to the collector of the table.
std::vector<GoniometerSpec> read_goniometers(const config::TomlTable& scene);

}  // namespace scintray::scene_file
