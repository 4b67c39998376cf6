#pragma once
/// Sampling of directions from a surface table, in a layout for speed.

#include <array>
#include <cstdint>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/optics/table_nodes.hpp"
#include "scintray/optics/table_view.hpp"

namespace scintray::optics {

/// Sampler of one slice of a table for incidence from one side.
///
/// The data of one interaction are contiguous: an interval between two nodes is one cache line, the edges of
/// one quantile bin of neighbouring nodes are neighbours, and azimuths are 16 bit wide (steps of half a turn
/// over 65535; angles of 2000 rays are known to about 1e-3 rad). A table of 41 nodes takes 0.2 MB for each
/// side on which light leaves, which fits the private cache of a core.
class TableSampler {
 public:
  /// @param nodes as checked by SurfaceTable
  TableSampler(const std::vector<TableNode>& nodes, AzimuthKind kind);

  using Place = TablePlace<double>;
  Place place(double sine, double cosine) const { return {view(), slant_of(sine, cosine)}; }

  std::size_t bytes() const;  ///< memory

  /// Direction of exit: polar angle, and azimuth from the plane of incidence, on either side of it.
  ExitAngles sample(const Place& place, bool reflected, core::Rng& rng) const;

  /// Its numbers; valid as long as the sampler.
  TableView view() const {
    TableView view;
    view.intervals = intervals_.data();
    view.lookup = lookup_.data();
    view.nodes = nodes_;
    for (std::size_t way = 0; way < 2; ++way) {
      view.polar[way] = directions_[way].polar.data();
      view.azimuth[way] = directions_[way].azimuth.data();
    }
    view.azimuth_zero = code_.zero;
    view.azimuth_step = code_.step;
    view.folded = kind_ == AzimuthKind::folded;
    return view;
  }

 private:
  /// Coding of azimuths in 16 bits: 0 and half a turn, of either sign for signed ones, are exact.
  struct AzimuthCode {
    float zero, step;
    explicit AzimuthCode(AzimuthKind kind);
    std::uint16_t encode(float azimuth) const;
  };

  /// Quantiles of all nodes, of light that leaves on one side.
  struct Directions {
    std::vector<float> polar;            ///< [polar edge][node], rad
    std::vector<std::uint16_t> azimuth;  ///< [polar bin][node][azimuth edge]
  };
  Directions pack(const std::vector<TableNode>& nodes, DirectionQuantiles TableNode::*way) const;

  AzimuthKind kind_;
  AzimuthCode code_;
  std::size_t nodes_;
  std::vector<TableInterval> intervals_;
  std::vector<std::uint32_t> lookup_;     ///< first candidate interval for equal steps of the measure
  std::array<Directions, 2> directions_;  ///< transmitted, reflected
};

}  // namespace scintray::optics
