#pragma once
/// Sums over blocks of photons that can be merged in any order.

#include <cstdint>
#include <vector>

#include "scintray/core/exact_sum.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::tally {

/// Consecutive blocks of a point: the unit of work and of storage.
struct BlockRange {
  std::uint64_t first = 0, last = 0;  ///< one past the last

  std::uint64_t count() const { return last - first; }
  bool operator==(const BlockRange&) const = default;
};

/// Sums of core::Moments.
struct MomentSums {
  std::uint64_t count = 0;
  core::ExactSum sum, sum_of_squares;

  void add(const core::Moments& block);
  void merge(const MomentSums& other);
  core::Moments value() const;
  bool operator==(const MomentSums&) const = default;
};

/// Sums of PhotonMoments.
struct PhotonMomentSums {
  MomentSums photons;
  std::uint64_t events = 0, count_squares = 0;
  core::ExactSum squares, products;

  /// @param is_event  the block is one event of an event source
  void add(const core::Moments& block, bool is_event);
  void merge(const PhotonMomentSums& other);
  PhotonMoments value() const;
  bool operator==(const PhotonMomentSums&) const = default;
};

/// Sums of optics::ShiftCount.
struct ShiftSums {
  std::uint64_t absorbed = 0, emitted = 0, additional = 0;
  core::ExactSum before_eV, after_eV, kept_eV;

  void add(const optics::ShiftCount& block);
  ShiftSums& operator+=(const ShiftSums& other);
  optics::ShiftCount value() const;
  bool operator==(const ShiftSums&) const = default;
};

/// Sums of EnergyBalance (keV), without what was requested.
struct EnergySums {
  std::uint64_t events = 0, silent = 0;
  core::ExactSum started, deposited, escaped, non_scintillating;
  MomentSums detected;

  void add(const EnergyBalance& block);
  void merge(const EnergySums& other);
  EnergyBalance value() const;
  bool operator==(const EnergySums&) const = default;
};

/// Sums of TallyResult. Photons are counted in integers; scores of other kinds are summed exactly.
class TallySums {
 public:
  TallySums() = default;
  /// @param empty  name, axes and zeros
  explicit TallySums(const TallyResult& empty);

  /// Adds the score of one photon in a bin.
  void add(std::size_t bin, double score);
  /// Adds a score beyond the axes.
  void add_outside(double score);
  /// Adds the score of one event in a bin, beside its photons.
  /// @param event    its number
  /// @param photons  traced of it
  void add_event(std::size_t bin, double score, std::uint64_t event, std::uint64_t photons);
  /// @pre those of the same tally
  void merge(const TallySums& other);
  TallyResult value() const;

  /// Of counts of photons, per bin: count, then sum of squares. Empty for other scores.
  std::vector<std::uint64_t> counts, count_squares;
  /// Of other scores, per bin. Empty for photons.
  std::vector<core::ExactSum> sums, sum_squares;
  /// Per bin, over events: of the square of an event's score, and of its product with the photons traced of
  /// it. Integers for photons, else exact sums; all zero for a source of photons.
  std::vector<std::uint64_t> event_count_squares, event_count_products;
  std::vector<core::ExactSum> event_squares, event_products;
  /// TallyResult::group_sums; empty: zeros, or not grouped.
  std::vector<std::uint64_t> group_counts;
  core::ExactSum outside;
  TallyResult empty;  ///< name and axes; its sums are empty

 private:
  bool grouped_ = false;
};

/// Sums over any blocks of a point. Each photon's contribution depends on the photon alone, or on its block;
/// all else is integers and exact sums. Those of parts of a point, merged in any order, are thus those of the
/// whole, to the last bit.
struct PointSums {
  /// Integers, names and wall time. Its floating sums and tallies are unused: they are in the sums below.
  PointResult counts;
  core::IdVector<core::MediumId, ShiftSums> shifted_in_medium;
  core::IdVector<core::SurfaceId, ShiftSums> shifted_at_surface;
  PhotonMomentSums interactions, detected_path_mm, detected_time_ns, detected_interactions;
  EnergySums energy;
  std::vector<TallySums> tallies;

  /// Adds the result of a block, but for its tallies and energy. @pre of the same point
  /// @param is_event  the block is one event of an event source, the photons of which are not independent
  void add(const PointResult& block, bool is_event);
  /// @pre of the same point
  void merge(const PointSums& other);
  /// True when both have media, surfaces, sensor faces, tallies and bins alike, so that they can be merged.
  bool alike(const PointSums& other) const;
  /// The result, each sum rounded once.
  PointResult result() const;
};

}  // namespace scintray::tally
