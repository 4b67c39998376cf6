#pragma once
/// Fits in files: HDF5, described field by field in docs/fit.md.

#include <filesystem>

#include "scintray/analysis/fit/fit_record.hpp"

namespace scintray::simulation {

/// Version of the layout; grows when a reader of the older one would misread the newer.
inline constexpr std::int64_t kFitVersion = 1;

/// Throws InputError when `path` is taken by something that is not a fit.
void check_fit_path(const std::filesystem::path& path);

/// Throws what check_fit_path does, and SystemError when the file cannot be written.
void write_fit(const std::filesystem::path& path, const analysis::FitRecord& record);

}  // namespace scintray::simulation
