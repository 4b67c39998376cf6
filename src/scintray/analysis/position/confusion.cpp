#include "scintray/analysis/position/confusion.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace scintray::analysis {

namespace {

/// The threshold between the values of a lower and a higher layer with the fewest wrong decisions.
double best_threshold(const std::vector<double>& lower, const std::vector<double>& higher) {
  std::vector<std::pair<double, bool>> all;  // value, true for the higher layer
  for (const double value : lower) all.emplace_back(value, false);
  for (const double value : higher) all.emplace_back(value, true);
  std::sort(all.begin(), all.end());
  // With a threshold below all values, all of the lower layer are wrong.
  auto wrong = static_cast<long>(lower.size());
  long fewest = wrong;
  double threshold = all.front().first;
  for (std::size_t i = 0; i < all.size(); ++i) {
    wrong += all[i].second ? 1 : -1;
    if (wrong >= fewest) continue;
    fewest = wrong;
    threshold = i + 1 < all.size() ? 0.5 * (all[i].first + all[i + 1].first) : all[i].first;
  }
  return threshold;
}

}  // namespace

std::uint64_t Confusion::total() const {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

core::Estimate Confusion::share_right() const {
  std::uint64_t right = 0;
  for (std::size_t i = 0; i < classes; ++i) right += at(i, i);
  return core::binomial_estimate(right, total());
}

core::Estimate Confusion::share_right_of(std::size_t truth) const {
  std::uint64_t events = 0;
  for (std::size_t assigned = 0; assigned < classes; ++assigned) events += at(truth, assigned);
  return core::binomial_estimate(at(truth, truth), events);
}

Confusion confusion_of(std::span<const std::size_t> truth, std::span<const std::size_t> assigned,
                       std::size_t classes) {
  if (truth.size() != assigned.size())
    throw std::invalid_argument("true and assigned classes differ in number");
  Confusion confusion;
  confusion.classes = classes;
  confusion.counts.assign(classes * classes, 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] >= classes || assigned[i] >= classes)
      throw std::invalid_argument("a class that does not exist");
    ++confusion.counts[truth[i] * classes + assigned[i]];
  }
  return confusion;
}

LayerAnalysis classify_layers(std::span<const std::size_t> layer, std::span<const double> value,
                              std::size_t layers) {
  if (layer.size() != value.size()) throw std::invalid_argument("layers and values differ in number");
  std::vector<std::vector<double>> values(layers);
  for (std::size_t i = 0; i < layer.size(); ++i) {
    if (layer[i] >= layers) throw std::invalid_argument("a layer that does not exist");
    if (i % 2 == 0) values[layer[i]].push_back(value[i]);
  }
  std::vector<double> means;
  for (const std::vector<double>& of_layer : values) {
    if (of_layer.empty()) throw std::invalid_argument("a layer without events");
    means.push_back(std::accumulate(of_layer.begin(), of_layer.end(), 0.0) /
                    static_cast<double>(of_layer.size()));
  }
  LayerAnalysis analysis;
  analysis.order.resize(layers);
  std::iota(analysis.order.begin(), analysis.order.end(), std::size_t{0});
  std::sort(analysis.order.begin(), analysis.order.end(),
            [&](std::size_t a, std::size_t b) { return means[a] < means[b]; });
  for (std::size_t i = 0; i + 1 < layers; ++i)
    analysis.thresholds.push_back(best_threshold(values[analysis.order[i]], values[analysis.order[i + 1]]));
  // Where layers overlap completely, two thresholds may be in the wrong order.
  std::sort(analysis.thresholds.begin(), analysis.thresholds.end());
  std::vector<std::size_t> truth, assigned;
  for (std::size_t i = 1; i < layer.size(); i += 2) {
    const auto rank = static_cast<std::size_t>(
        std::upper_bound(analysis.thresholds.begin(), analysis.thresholds.end(), value[i]) -
        analysis.thresholds.begin());
    truth.push_back(layer[i]);
    assigned.push_back(analysis.order[rank]);
  }
  analysis.confusion = confusion_of(truth, assigned, layers);
  return analysis;
}

}  // namespace scintray::analysis
