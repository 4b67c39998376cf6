#pragma once
/// Options of every command that puts surfaces of the library on the goniometer.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/cli/progress.hpp"

namespace scintray::cli {

struct BenchOptions {
  std::string inside = "LSO", wavelength = "420 nm", scene;
  std::uint64_t rays = 0;  ///< 0: as the command says
  std::uint64_t seed = 1;
};
/// `rays` is what the command shoots unless told.
void add_bench_options(CLI::App& app, BenchOptions& options, std::uint64_t rays);

/// The shipped library, with the definitions of the scene file where one is named.
materials::Library library_of(const BenchOptions& options);
analysis::BenchPlace place_of(const BenchOptions& options, const std::string& surface,
                              const std::string& outside);
double angle_rad(const std::string& text);

/// A maker that shows its progress on the line, and stops when the user asks.
materials::SurfaceMaker watched_maker(ProgressLine& line);

/// "0.12345 +- 0.00050".
std::string share_text(const core::Estimate& share);

}  // namespace scintray::cli
