#pragma once
/// Drawing directions from a surface table, laid out for speed.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/optics/table_nodes.hpp"

namespace scintray::optics {

/// One slice of a table as met from one side.
///
/// What a meeting needs lies together: an interval between two nodes is one cache line, the edges of
/// one quantile bin of neighbouring nodes are neighbours, and azimuths are 16 bit wide (steps of half a
/// turn over 65535; angles of 2000 rays are known to about 1e-3 rad). A table of 41 nodes takes 0.2 MB for
/// each way that light leaves, which a core's own cache holds.
class TableSampler {
 private:
  /// Between two nodes. Positions are in a measure of the incidence angle that needs no arc function,
  /// sin / (sin + cos), and `bend` states how the share of the way in angle departs from that in this
  /// measure: by bend x (1 - x). Nodes 2.25 deg apart: right to 5e-5 of the way.
  struct alignas(64) Interval {
    double start = 0.0;  ///< of the lower node
    double per_length = 0.0;
    double bend = 0.0;
    double reflectance = 0.0, reflectance_step = 0.0;
    double absorptance = 0.0, absorptance_step = 0.0;
    /// Which nodes' directions to use, counted from the lower: a node that light never leaves that way has
    /// none of its own. Reflected, transmitted.
    std::array<std::uint8_t, 2> low{0, 0}, high{1, 1};
    bool transmits = false;  ///< some light at one of its nodes does
  };

 public:
  /// Nodes as SurfaceTable checks them.
  TableSampler(const std::vector<TableNode>& nodes, AzimuthKind kind);

  /// Where an incidence angle falls between two nodes, and the shares there, linear between them.
  class Place {
   public:
    double reflectance() const { return interval_->reflectance + share_ * interval_->reflectance_step; }
    double absorptance() const { return interval_->absorptance + share_ * interval_->absorptance_step; }
    bool transmits() const { return interval_->transmits; }

   private:
    friend class TableSampler;
    Place(const Interval* interval, double share) : interval_(interval), share_(share) {}
    const Interval* interval_;
    double share_;  ///< of the way to the next node, in [0, 1]
  };
  Place place(double sine, double cosine) const;

  std::size_t bytes() const;  ///< it takes

  /// Polar angle and azimuth from the plane of incidence, either side of it.
  ExitAngles sample(const Place& place, bool reflected, core::Rng& rng) const;

 private:
  /// The quantiles of all nodes, of light that leaves one way.
  struct Directions {
    std::vector<float> polar;            ///< [polar edge][node], rad
    std::vector<std::uint16_t> azimuth;  ///< [polar bin][node][azimuth edge]
  };
  Directions pack(const std::vector<TableNode>& nodes, DirectionQuantiles TableNode::*way) const;

  AzimuthKind kind_;
  std::size_t nodes_;
  std::vector<Interval> intervals_;
  std::vector<std::uint32_t> lookup_;     ///< first candidate interval for equal steps of the measure
  std::array<Directions, 2> directions_;  ///< transmitted, reflected
};

}  // namespace scintray::optics
