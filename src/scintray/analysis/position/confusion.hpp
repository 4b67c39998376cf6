#pragma once
/// Confusion matrices of classifications.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scintray/core/statistics.hpp"

namespace scintray::analysis {

struct Confusion {
  std::size_t classes = 0;
  std::vector<std::uint64_t> counts;  ///< classes x classes, row-major: [true][assigned]

  std::uint64_t at(std::size_t truth, std::size_t assigned) const {
    return counts[truth * classes + assigned];
  }
  std::uint64_t total() const;
  core::Estimate share_right() const;                      ///< of all events
  core::Estimate share_right_of(std::size_t truth) const;  ///< of the events of one class
};

/// Confusion matrix of two classifications of the same events.
/// @throws std::invalid_argument when the sizes differ or a class is not below `classes`
Confusion confusion_of(std::span<const std::size_t> truth, std::span<const std::size_t> assigned,
                       std::size_t classes);

/// Classification of layers by one number (a ratio, a decay time) between thresholds.
struct LayerAnalysis {
  std::vector<double> thresholds;  ///< rising, between neighbouring layers in order of their means
  std::vector<std::size_t> order;  ///< layers by rising mean of the number
  Confusion confusion;             ///< of the events that did not set the thresholds
};

/// Thresholds that minimise the misclassifications between neighbouring layers of the even events, evaluated
/// on the odd ones. @param layer  of each event, 0 to layers - 1  @param value  of each event, finite
/// @throws std::invalid_argument when sizes differ, a layer is not below `layers`, or a layer has no event
/// among the even ones
LayerAnalysis classify_layers(std::span<const std::size_t> layer, std::span<const double> value,
                              std::size_t layers);

}  // namespace scintray::analysis
