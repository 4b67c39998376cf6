#pragma once
/// Options of every command that measures surfaces of the database on the goniometer.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/cli/progress.hpp"

namespace scintray::cli {

struct SampleOptions {
  std::string inside = "LSO", wavelength = "420 nm", scene;
  std::uint64_t rays = 0;  ///< 0: the command's own number
  std::uint64_t seed = 1;
};
/// `rays` is the command's default number.
void add_sample_options(CLI::App& app, SampleOptions& options, std::uint64_t rays);

/// The shipped database, with the definitions of the scene file where one is named.
materials::MaterialDatabase database_of(const SampleOptions& options);
/// Adds to a database, under its path, the surface of a table (.h5) or height map, levelled by a plane, where
/// `surface` is the path of a file.
void add_file_surface(materials::MaterialDatabase& database, const std::string& surface);
analysis::SamplePlace place_of(const SampleOptions& options, const std::string& surface,
                               const std::string& outside);
double angle_rad(const std::string& text);

/// A factory that shows its progress on the line, and stops at the user's request.
materials::SurfaceFactory watched_factory(ProgressLine& line);

/// Text of an estimate: "0.12345 +- 0.00050".
std::string share_text(const core::Estimate& share);

}  // namespace scintray::cli
