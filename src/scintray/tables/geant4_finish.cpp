#include "scintray/tables/geant4_finish.hpp"

#include <algorithm>
#include <array>

#include "scintray/core/error.hpp"

namespace scintray::tables {

namespace {

struct FinishPart {
  const char *word, *file;
};

constexpr std::array<FinishPart, 3> kTreatments{
    {{"polished", "Polished"}, {"etched", "Etched"}, {"ground", "Ground"}}};
constexpr std::array<FinishPart, 8> kWrappings{{{"lumirrorair", "Lumirror"},
                                                {"lumirrorglue", "LumirrorGlue"},
                                                {"air", ""},
                                                {"teflonair", "Teflon"},
                                                {"tioair", "TiO"},
                                                {"tyvekair", "Tyvek"},
                                                {"vm2000air", "VM2000"},
                                                {"vm2000glue", "VM2000Glue"}}};

}  // namespace

const std::vector<std::string>& lbnl_finishes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const FinishPart& treatment : kTreatments)
      for (const FinishPart& wrapping : kWrappings)
        all.push_back(std::string(treatment.word) + wrapping.word);
    return all;
  }();
  return names;
}

const std::vector<std::string>& davis_finishes() {
  static const std::vector<std::string> names{
      "Rough_LUT",          "RoughTeflon_LUT", "RoughESR_LUT",          "RoughESRGrease_LUT", "Polished_LUT",
      "PolishedTeflon_LUT", "PolishedESR_LUT", "PolishedESRGrease_LUT", "Detector_LUT"};
  return names;
}

const std::vector<std::string>& customized_finishes() {
  static const std::vector<std::string> names{"Customized_LUT",  "Customized2_LUT", "Customized3_LUT",
                                              "Customized4_LUT", "Customized5_LUT", "CustomizedDetector_LUT"};
  return names;
}

bool is_davis_finish(const std::string& finish) {
  const auto is_one_of = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), finish) != names.end();
  };
  return is_one_of(davis_finishes()) || is_one_of(customized_finishes());
}

std::optional<std::string> data_stem(const std::string& finish) {
  if (is_davis_finish(finish)) return finish;
  for (const FinishPart& treatment : kTreatments)
    for (const FinishPart& wrapping : kWrappings)
      if (*wrapping.file != '\0' && finish == std::string(treatment.word) + wrapping.word)
        return std::string(treatment.file) + wrapping.file;
  return std::nullopt;
}

std::filesystem::path finish_file(const std::filesystem::path& folder, const std::string& finish) {
  const std::optional<std::string> stem = data_stem(finish);
  if (!stem)
    throw core::InputError(
        {{},
         "no data exist for the finish \"" + finish +
             "\" of a bare face; Geant4's reader leaves its table empty",
         "write a model of your own, as model = \"smooth\", or a finish with a reflector, as "
         "finish = \"polishedteflonair\""});
  std::error_code status;
  if (!std::filesystem::is_directory(folder, status))
    throw core::InputError({{},
                            "the folder \"" + folder.string() + "\" of Geant4's surface data does not exist",
                            "write folder = \"PATH/RealSurface2.2\" with the folder of Geant4's data set "
                            "RealSurface, or set the environment variable G4REALSURFACEDATA"});
  for (const char* extension : {".z", ".dat"})
    if (std::filesystem::path file = folder / (*stem + extension);
        std::filesystem::is_regular_file(file, status))
      return file;
  throw core::InputError(
      {{},
       "the folder \"" + folder.string() + "\" has neither \"" + *stem + ".z\" nor \"" + *stem +
           ".dat\", the table of the finish \"" + finish + "\"",
       "name the folder of Geant4's data set RealSurface, which has it, or put a table of this "
       "name there (scintray table export --format davis)"});
}

}  // namespace scintray::tables
