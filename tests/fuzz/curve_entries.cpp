#include "curve_entries.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "corpus.hpp"
#include "require.hpp"
#include "scintray/analysis/fit/measured_curve.hpp"
#include "scintray/analysis/goniometer/measured_profile.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/measured_brdf.hpp"
#include "scintray/materials/power_spectrum.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/scene_file/readout.hpp"
#include "scratch_file.hpp"

namespace scintray::fuzz {

namespace {

using materials::DefinitionKind;

std::vector<std::string> no_seeds() { return {}; }

/// Reads a file of the bytes, and checks that what is refused is so with a place and words.
template <typename Read>
bool read_csv_or_input_error(const std::uint8_t* data, std::size_t size, const Read& read) {
  const ScratchFile file(data, size, ".csv");
  try {
    read(file.path());
    return true;
  } catch (const core::InputError& error) {
    require(!error.problems().empty(), "an error without problems");
    for (const core::Problem& problem : error.problems())
      require(!problem.where.file.empty() && !problem.what.empty(), "an error without place or words");
    return false;
  }
}

/// The shipped database with definitions of a scene, which names files by their path.
materials::MaterialDatabase with_own(DefinitionKind kind, const std::string& text) {
  static const materials::MaterialDatabase shipped = materials::MaterialDatabase::shipped();
  materials::MaterialDatabase database = shipped;
  const std::filesystem::path place = scene_folder() / "../materials/media/fuzz.toml";
  database.add(kind, {{"own", config::parse_toml(text, place.string())}});
  return database;
}

/// All points of a curve are numbers.
void require_finite(const core::Curve& curve) {
  for (const double value : curve.y()) require(std::isfinite(value), "a value that is no number");
  for (const double x : curve.x()) require(std::isfinite(x), "an abscissa that is no number");
}

bool run_curves(const std::uint8_t* data, std::size_t size) {
  return read_csv_or_input_error(data, size, [](const std::filesystem::path& path) {
    const std::string file = "{ file = \"" + path.string() + "\", wavelength_unit = \"nm\", value_column = ";
    const auto database = with_own(DefinitionKind::medium,
                                   "index = { n = " + file + "\"n\" } }\nabsorption = { length = " + file +
                                       "\"length\", value_unit = \"mm\" } }\nscattering = { none = true }\n" +
                                       "yield = { value = \"10 1/keV\" }\nemission = { spectrum = " + file +
                                       "\"light\" } }\ndecay = [{ time = \"40 ns\", rise = \"0 ns\", "
                                       "fraction = 1 }]\n");
    const optics::Medium& medium = database.medium("own");
    for (const core::Curve* curve : {&medium.index, &medium.absorption_per_mm, &medium.emission})
      require_finite(*curve);
  });
}

bool run_fit_data(const std::uint8_t* data, std::size_t size) {
  return read_csv_or_input_error(data, size, [](const std::filesystem::path& path) {
    const analysis::MeasuredCurve curve = analysis::read_measured_curve(path);
    require(!curve.points.empty(), "a curve without points");
    for (const auto& point : curve.points)
      require(point.y.value >= 0.0 && std::isfinite(point.y.value) && std::isfinite(point.x) &&
                  (curve.has_errors ? point.y.error > 0.0 : point.y.error == 0.0),
              "a point out of range");
  });
}

bool run_profile(const std::uint8_t* data, std::size_t size) {
  return read_csv_or_input_error(data, size, [](const std::filesystem::path& path) {
    const analysis::MeasuredProfile profile = analysis::read_measured_profile(path);
    require(profile.angle_deg.size() >= 2 && profile.value.size() == profile.angle_deg.size() &&
                (profile.error.empty() || profile.error.size() == profile.value.size()),
            "columns of unequal length");
    for (std::size_t k = 1; k < profile.angle_deg.size(); ++k)
      require(profile.angle_deg[k] > profile.angle_deg[k - 1], "angles that do not increase");
  });
}

bool run_face_response(const std::uint8_t* data, std::size_t size) {
  return read_csv_or_input_error(data, size, [](const std::filesystem::path& path) {
    const auto database = with_own(DefinitionKind::sensor,
                                   "efficiency = { definition = \"internal\", value = 0.5 }\nwindow = { "
                                   "index = 1.5 }\nuniformity = { map = "
                                   "{ file = \"" +
                                       path.string() + "\", unit = \"mm\" } }\n");
    require(database.sensor("own").over_face.has_value(), "a sensor without its response over the face");
  });
}

bool run_power_spectrum(const std::uint8_t* data, std::size_t size) {
  return read_csv_or_input_error(data, size, [](const std::filesystem::path& path) {
    const auto spectrum = materials::read_power_spectrum(path, "1/um", "um4");
    require(spectrum.frequency_per_um.size() >= 2 &&
                spectrum.density_um4.size() == spectrum.frequency_per_um.size(),
            "columns of unequal length");
    for (const double density : spectrum.density_um4)
      require(density >= 0.0 && std::isfinite(density), "a negative density, or one that is no number");
  });
}

/// The values of every file; their table, whose time depends on its nodes alone, of one file in 500.
bool run_measured_brdf(const std::uint8_t* data, std::size_t size) {
  return read_csv_or_input_error(data, size, [&](const std::filesystem::path& path) {
    for (const tables::BrdfPoint& point : materials::read_brdf_points(path)) {
      require(point.value_per_sr >= 0.0 && std::isfinite(point.value_per_sr), "a BRDF below 0, or no number");
      require(point.incidence_rad >= 0.0 && point.polar_rad >= 0.0 && point.turn_rad >= 0.0 &&
                  std::max(point.incidence_rad, point.polar_rad) < 0.5 * core::kPi &&
                  point.turn_rad <= core::kPi,
              "a direction that is none");
      require(!point.mueller || point.mueller->allFinite(), "an element that is no number");
    }
    std::size_t sum = 0;
    for (std::size_t k = 0; k < size; ++k) sum = 31 * sum + data[k];
    if (sum % 500 != 0) return;
    with_own(DefinitionKind::surface,
             "model = \"measured_brdf\"\nmeasured_brdf = { file = \"" + path.string() + "\", gap = 1.0 }\n")
        .surface("own");
  });
}

/// A file of the material database, of any kind.
bool run_definition(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto reads = [&](DefinitionKind kind, const auto& read) {
    try {
      read(with_own(kind, text));
      return true;
    } catch (const core::InputError& error) {
      require(!error.problems().empty() && !error.problems().front().what.empty(), "an error without words");
      return false;
    }
  };
  using Database = materials::MaterialDatabase;
  return reads(DefinitionKind::medium,
               [](const Database& all) { require_finite(all.medium("own").index); }) ||
         reads(DefinitionKind::sensor, [](const Database& all) { all.sensor("own"); }) ||
         reads(DefinitionKind::reflector, [](const Database& all) { all.reflector("own"); }) ||
         reads(DefinitionKind::surface, [](const Database& all) { all.surface("own"); });
}

std::vector<std::string> definition_seeds() {
  std::vector<std::string> seeds;
  for (const char* name : {"media/LSO", "media/BGO", "media/calcite", "sensors/R6231",
                           "sensors/S13360_6050VE", "sensors/MicroFC_10035", "reflectors/ESR",
                           "reflectors/PTFE", "surfaces/detect_ground", "surfaces/esr_by_angle"}) {
    std::ifstream file(scene_folder() / "../materials" / (std::string(name) + ".toml"), std::ios::binary);
    if (file) seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

/// The files of `scintray analyze`: electronics, and settings of the analysis.
template <typename Read>
bool run_settings(const std::uint8_t* data, std::size_t size, const Read& read) {
  try {
    read(std::string(reinterpret_cast<const char*>(data), size));
    return true;
  } catch (const core::InputError& error) {
    require_words(error);
    return false;
  }
}

bool run_readout(const std::uint8_t* data, std::size_t size) {
  return run_settings(data, size, [](const std::string& text) { scene_file::readout_of_text(text, "fuzz"); });
}

bool run_analysis(const std::uint8_t* data, std::size_t size) {
  return run_settings(data, size,
                      [](const std::string& text) { scene_file::analysis_of_text(text, "fuzz"); });
}

constexpr std::size_t kPerCurveByte = 512, kCurveAlways = std::size_t{1} << 22;
/// A measured BRDF is fitted with tables of a fixed size for each wavelength.
constexpr std::size_t kBrdfAlways = std::size_t{1} << 26;

constexpr Entry kCurveEntries[] = {
    {"curves_csv", run_curves, no_seeds, kPerCurveByte, kCurveAlways},
    {"fit_data", run_fit_data, no_seeds, kPerCurveByte, kCurveAlways},
    {"goniometer_profile", run_profile, no_seeds, kPerCurveByte, kCurveAlways},
    {"face_response", run_face_response, no_seeds, kPerCurveByte, kCurveAlways},
    {"power_spectrum", run_power_spectrum, no_seeds, kPerCurveByte, kCurveAlways},
    {"measured_brdf", run_measured_brdf, no_seeds, kPerCurveByte, kBrdfAlways},
    {"definition", run_definition, definition_seeds, kPerCurveByte, kBrdfAlways},
    {"readout", run_readout, no_seeds, kPerCurveByte, kCurveAlways},
    {"analysis", run_analysis, no_seeds, kPerCurveByte, kCurveAlways}};

}  // namespace

std::span<const Entry> curve_entries() { return kCurveEntries; }

}  // namespace scintray::fuzz
