#pragma once
/// Hash of the content of surface tables.

#include <string>
#include <type_traits>
#include <vector>

#include "scintray/core/sha256.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::test {

/// Hash of values in their order, each array after its length.
class TableDigest {
 public:
  template <typename T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    hash_.add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void add(const std::string& text) {
    add(text.size());
    hash_.add(text);
  }
  void add(const std::vector<float>& values) {
    add(values.size());
    hash_.add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
  }
  void add(const optics::DirectionQuantiles& q) {
    add(q.rays);
    add(q.polar);
    add(q.azimuth);
  }
  void add(const std::vector<optics::TableNode>& nodes) {
    add(nodes.size());
    for (const optics::TableNode& node : nodes) {
      const auto& [incidence, reflectance, reflectance_error, absorptance, absorptance_error, slope, traced,
                   rays, reflected, transmitted] = node;
      for (const double value :
           {incidence, reflectance, reflectance_error, absorptance, absorptance_error, slope, traced})
        add(value);
      add(rays);
      add(reflected);
      add(transmitted);
    }
  }
  void add(const optics::TableSlice& slice) {
    for (const double value :
         {slice.wavelength_nm, slice.azimuth_rad, slice.index.inside, slice.index.outside})
      add(value);
    add(slice.from_inside);
    add(slice.from_outside);
    add(slice.reciprocal ? slice.reciprocal->shares() : std::vector<float>());
  }
  void add(const optics::TableProvenance& provenance) {
    const auto& [map, stack, preparation, tiling, seed, rays, azimuths, unclassified, cut, target_error,
                 unconverged, reciprocity, version] = provenance;
    for (const std::string& text : {map, stack, preparation, tiling, reciprocity}) add(text);
    for (const std::uint64_t count : {seed, rays, azimuths, unclassified, cut, unconverged}) add(count);
    add(target_error);
  }

  std::string hex() { return hash_.hex(); }

 private:
  core::Sha256 hash_;
};

/// SHA-256 of all numbers of a table and of its provenance, apart from the version of ScintRay that built it:
/// equal for tables of the same bits.
inline std::string content_digest(const optics::SurfaceTable& table) {
  TableDigest digest;
  digest.add(table.azimuth_kind());
  digest.add(table.slices().size());
  for (const optics::TableSlice& slice : table.slices()) digest.add(slice);
  digest.add(table.provenance());
  return digest.hex();
}

}  // namespace scintray::test
