#pragma once
/// Smoothing of histograms and maps with a Gaussian.

#include <cstddef>
#include <vector>

namespace scintray::analysis {

/// Weights of a Gaussian with a standard deviation in cells, out to 4 of them on either side; they sum to 1.
std::vector<double> gaussian_kernel(double sigma_cells);

/// Lines of cells of a map along which to smooth.
struct CellLines {
  std::size_t count = 1, length = 0;
  std::size_t step = 0;       ///< between the first cells of two lines
  std::size_t cell_step = 1;  ///< between two cells of a line
};

/// Every line convolved with the kernel (an odd number of weights), with zeros beyond its ends.
std::vector<double> convolved(const std::vector<double>& map, const std::vector<double>& kernel,
                              const CellLines& lines);

}  // namespace scintray::analysis
