#include "scintray/materials/table_key.hpp"

#include <fmt/format.h>

#include "scintray/core/input_file.hpp"
#include "scintray/core/sha256.hpp"
#include "scintray/core/version.hpp"
#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/surface_spec.hpp"

namespace scintray::materials {

namespace {

// Structs are taken apart by structured bindings: a new member does not compile until it is in the key.

template <typename T>
std::string text(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : "none";
}

std::string text(const core::Curve& curve) {
  std::string points;
  for (std::size_t k = 0; k < curve.x().size(); ++k)
    points += fmt::format("{} {}, ", curve.x()[k], curve.y()[k]);
  return curve.x().size() <= 4 ? "(" + points + ")" : core::sha256(points);
}

std::string text(const optics::Reflector& reflector) {
  const auto& [name, reflectance, specular_share, volume_index, transmittance, polarisation, undeflected] =
      reflector;
  return fmt::format("reflectance {}, specular share {}, volume index {}, transmittance {}{}{}",
                     text(reflectance), specular_share, volume_index,
                     transmittance ? text(*transmittance) : "none",
                     polarisation == optics::PaintPolarisation::random ? "" : ", polarisation of Geant4",
                     undeflected ? ", undeflected" : "");
}

std::string text(const topography::TableSettings& settings) {
  const auto& [incidence_step, azimuth_step, rays, seed, refine, refine_change, refine_down_to, grazing,
               directional, target_error, most_rays, reciprocal] = settings;
  return fmt::format(
      "incidence step {} rad, azimuth step {} rad, {} rays, seed {}, refine {} {} {}, grazing {} rad, "
      "directional {}, target error {} within {}, reciprocal {}",
      incidence_step, azimuth_step, rays, seed, refine, refine_change, refine_down_to, grazing, directional,
      target_error, most_rays, reciprocal);
}

std::string text(const std::vector<topography::SpectralPoint>& spectrum) {
  std::string list;
  for (const auto& [wavelength_nm, index] : spectrum)
    list +=
        fmt::format("{}{} nm: {} {}", list.empty() ? "" : ", ", wavelength_nm, index.inside, index.outside);
  return list;
}

struct CropText {
  std::string operator()(const std::monostate&) const { return "none"; }
  std::string operator()(const topography::CropBox& box) const {
    const auto& [column, row, columns, rows] = box;
    return fmt::format("{} {} {} {} points", column, row, columns, rows);
  }
  std::string operator()(const topography::CropLengths& box) const {
    const auto& [x, y, width, height] = box;
    return fmt::format("{} {} {} {} um", x, y, width, height);
  }
};

std::string text(const topography::Preparation& preparation) {
  const auto& [crop, outlier_limit, outlier_radius, fill, median, loess, gaussian, leveling] = preparation;
  const auto& [kind, degree] = leveling;
  return fmt::format("crop {}, outliers {} {}, fill {}, median {}, LOESS {} um, Gaussian {} um, level {} {}",
                     std::visit(CropText(), crop), text(outlier_limit), outlier_radius, fill, text(median),
                     text(loess), text(gaussian), static_cast<int>(kind), degree);
}

std::string text(const topography::ReadOptions& options) {
  const auto& [pitch, width, height_unit, channel, periodic, query_gwyddion] = options;
  return fmt::format("pitch {} um, width {} um, height unit {} um, channel {}, periodic {}, Gwyddion {}",
                     text(pitch), text(width), text(height_unit), text(channel), periodic, query_gwyddion);
}

std::string text(const topography::SpectrumRelief& spectrum) {
  const auto& [frequency, density] = spectrum;
  std::string points;
  for (std::size_t k = 0; k < frequency.size() && k < density.size(); ++k)
    points += fmt::format("{} {}, ", frequency[k], density[k]);
  return core::sha256(points);
}

/// Key of the layers under a microsurface; nothing when they shift wavelengths.
std::optional<std::string> layers_key(const optics::SurfaceStack& stack) {
  const auto& [name, admission, gap, gap_index, gap_absorption, gap_shifter, gap_thickness_um, reflector,
               direction] = stack;
  if (gap_shifter) return std::nullopt;
  const std::string admitted = admission ? "admitted " + text(admission->admitted) + ", undeflected " +
                                               text(admission->undeflected) + "; "
                                         : "";
  return admitted +
         fmt::format("gap index {}, absorption {}, thickness {} um; reflector {}; direction {} {} {}",
                     text(gap_index), text(gap_absorption), text(gap_thickness_um),
                     reflector ? text(*reflector) : "none", direction.x(), direction.y(), direction.z());
}

}  // namespace

std::string file_key(const std::filesystem::path& path) {
  return core::sha256(core::read_whole_file(path).value_or(""));
}

std::string height_map_key(const MapSource& source) {
  const auto& [path, options, preparation, tiling] = source;
  return fmt::format("map {} {}; {}; {}; tiling {}", path.filename().string(), file_key(path), text(options),
                     text(preparation), static_cast<int>(tiling));
}

std::string recipe_key(const topography::SynthesisRecipe& recipe) {
  const auto& [name, gaussian, fracture, scratches, k_correlation, spectrum, columns, rows, pitch_um, seed] =
      recipe;
  const auto& [rms, correlation, lay, lay_angle] = gaussian;
  const auto& [spacing, rise, exponent, depth_spread, size_spread] = fracture;
  const auto& [scratch_spacing, scratch_length, scratch_depth, scratch_width] = scratches;
  const auto& [k_rms, k_knee, k_exponent] = k_correlation;
  return fmt::format(
      "recipe {}: {} x {} points of {} um, seed {}; Gaussian {} {} {} {}; fracture {} {} {} {} {}; scratches "
      "{} {} {} {}; K-correlation {} {} {}; spectrum {}",
      name, columns, rows, pitch_um, seed, rms, correlation, lay, lay_angle, spacing, rise, exponent,
      depth_spread, size_spread, scratch_spacing, scratch_length, scratch_depth, scratch_width, k_rms, k_knee,
      k_exponent, text(spectrum));
}

std::string tracing_key(const TracingSpec& tracing) {
  const auto& [settings, wavelengths_nm] = tracing;
  std::string key = "tabulated: " + text(settings) + ", at";
  for (const double nm : wavelengths_nm) key += fmt::format(" {} nm", nm);
  return key;
}

std::optional<std::string> stack_key(const SurfaceSpec& surface) {
  if (!surface.mixture.empty()) {
    std::string key = "mixture";
    for (const auto& [share, part] : surface.mixture) {
      const std::optional<std::string> own = stack_key(*part);
      if (!own) return std::nullopt;
      key += fmt::format(" | {} of ({})", share, *own);
    }
    return key;
  }
  const std::optional<std::string> microsurface = surface.microsurface->key();
  const std::optional<std::string> layers = layers_key(surface);
  if (!microsurface || !layers) return std::nullopt;
  return *microsurface + " | " + *layers + (surface.between_media_only ? " | between media only" : "");
}

std::string table_key(const std::string& surface, const topography::TableSettings& settings,
                      const std::vector<topography::SpectralPoint>& spectrum) {
  return fmt::format("{}; {}; indices {}; layout {}, content {}, release {}", surface, text(settings),
                     text(spectrum), optics::kTableFileVersion, topography::kTableContentVersion,
                     core::release());
}

}  // namespace scintray::materials
