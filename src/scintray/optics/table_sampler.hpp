#pragma once
/// Sampling of directions from a surface table, in a layout for speed.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/optics/table_laws.hpp"
#include "scintray/optics/table_nodes.hpp"

namespace scintray::optics {

/// Direction of exit, rad: polar angle, and azimuth from the plane of incidence, on either side of it.
struct TableExit {
  double polar, azimuth;
};

/// Sampler of one slice of a table for incidence from one side.
///
/// The data of one interaction are contiguous: an interval between two nodes is one cache line, the edges of
/// one quantile bin at both nodes are neighbours, and azimuths are 16 bit wide (steps of half a turn over
/// 65535, over 32767 for signed ones; angles of 2000 rays are known to about 1e-3 rad). A table of 41 nodes
/// takes 0.4 MB for each side on which light leaves.
class TableSampler {
 public:
  /// @param nodes as checked by SurfaceTable
  /// @param absorbs  some node of the whole table has an absorptance
  TableSampler(const std::vector<TableNode>& nodes, AzimuthKind kind, bool absorbs);

  /// Position of an incidence angle between two nodes, and the shares there, linear between them.
  class Place {
   public:
    double reflectance() const { return interval_->reflectance + share_ * interval_->reflectance_step; }
    /// @param u  a number of at least reflectance()
    bool absorbs(double u) const {
      return u < reflectance() + (interval_->absorptance + share_ * interval_->absorptance_step);
    }

   private:
    friend class TableSampler;
    Place(const TableInterval* interval, double share) : interval_(interval), share_(share) {}
    const TableInterval* interval_;
    double share_;  ///< relative position towards the next node, in [0, 1]
  };
  Place place(double sine, double cosine) const;

  std::size_t bytes() const;  ///< memory
  /// Its numbers, for lanes; valid as long as this is.
  TableView view() const;

  TableExit sample(const Place& place, bool reflected, core::Rng& rng) const;

 private:
  /// Quantiles of all intervals, of light that leaves on one side, as of TableView.
  struct Directions {
    std::vector<float> polar;
    std::vector<std::uint16_t> azimuth;
  };
  Directions pack(const std::vector<TableNode>& nodes, DirectionQuantiles TableNode::*way) const;

  AzimuthKind kind_;
  std::vector<TableInterval> intervals_;
  std::vector<std::uint32_t> lookup_;     ///< first candidate interval for equal steps of the measure
  std::array<Directions, 2> directions_;  ///< transmitted, reflected
};

}  // namespace scintray::optics
