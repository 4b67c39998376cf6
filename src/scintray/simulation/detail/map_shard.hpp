#pragma once
/// Files of shards of response maps (docs/scaling.md): a range of the pieces of a map.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scintray/core/input_file.hpp"
#include "scintray/simulation/detail/response_pieces.hpp"
#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation {

/// All that a map depends on.
struct MapOrigin {
  std::string version;     ///< of ScintRay
  std::string scene_file;  ///< name as stated
  std::string scene_text;
  std::vector<core::InputFile> inputs;  ///< files that were read
};

/// What a shard is of.
struct MapOutline {
  Shard shard;
  MapOrigin origin;
  ResponseMap map;                   ///< with grids without counts; traced backward, with their `photons`
  std::vector<std::uint32_t> media;  ///< of each grid: number of its medium
};

/// Writer of a shard. There is no file at its path before commit(), each record has a checksum, and a record
/// ends the file.
class MapShardWriter {
 public:
  MapShardWriter(std::filesystem::path path, const Shard& shard, MapOrigin origin);
  ~MapShardWriter();

  /// @param map    as of MapOutline
  /// @throws InputError and SystemError for a path that cannot be written
  void begin(const ResponseMap& map, const std::vector<std::uint32_t>& media);
  /// The pieces of the shard, of all of the map.
  tally::BlockRange of(std::uint64_t pieces) const { return part_of(shard_, pieces); }
  /// Adds the next piece.
  void add(std::uint64_t piece, const CellResponse& response);
  void add(std::uint64_t piece, const ChannelLight& light);
  void commit();

 private:
  struct State;
  std::filesystem::path path_;
  Shard shard_;
  MapOrigin origin_;
  std::unique_ptr<State> state_;
};

}  // namespace scintray::simulation
