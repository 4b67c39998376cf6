#pragma once
/// Histograms of equal bins.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace scintray::analysis {

struct Histogram {
  double low = 0.0;            ///< lower edge of the first bin
  double width = 1.0;          ///< of every bin
  std::vector<double> counts;  ///< per bin
  double below = 0.0;          ///< counts under the first bin
  double above = 0.0;          ///< counts at or over the end of the last

  double edge(std::size_t i) const { return low + width * static_cast<double>(i); }
  double centre(std::size_t i) const { return low + width * (static_cast<double>(i) + 0.5); }
  double high() const { return edge(counts.size()); }
  std::vector<double> edges() const;  ///< bins + 1
  double total() const;               ///< inside the bins
};

/// Counts of `values` in `bins` bins from `low` to `high`; values that are not finite are left out.
/// @throws std::invalid_argument without bins or without a range
Histogram make_histogram(std::span<const double> values, double low, double high, std::size_t bins);

/// Histogram with bins of about `width` over the values from `low` to `high`. Whole numbers (photons counted)
/// get bins of a whole width with edges halfway between numbers: other bins would contain unequal numbers of
/// integers, a comb that is not in the data. At most 10,000 bins.
Histogram make_histogram_of_width(std::span<const double> values, double low, double high, double width);

/// Histogram with the bin width of Freedman and Diaconis: twice the distance between the quartiles over the
/// cube root of the number (D. Freedman and P. Diaconis 1981, Z. Wahrscheinlichkeitstheorie 57, 453), over
/// all values but the outermost thousandth at each end where these are outliers. Empty without two different
/// finite values.
std::optional<Histogram> automatic_histogram(std::span<const double> values);

/// Quantile: the value below which a share of `sorted` lies, linear between values. `sorted` rises and is not
/// empty.
double sorted_quantile(std::span<const double> sorted, double share);

/// The finite ones of `values`, sorted.
std::vector<double> sorted_finite(std::span<const double> values);

}  // namespace scintray::analysis
