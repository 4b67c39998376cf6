#include <fmt/format.h>

#include "scintray/core/error.hpp"
#include "scintray/core/sha256.hpp"
#include "scintray/core/version.hpp"
#include "scintray/simulation/detail/fit_journal.hpp"
#include "scintray/simulation/detail/journal_pieces.hpp"

namespace scintray::simulation::detail {

namespace {

std::string option_text(const std::optional<std::uint64_t>& option) {
  return option ? std::to_string(*option) : "of the scene";
}

}  // namespace

std::unique_ptr<core::Journal> fit_journal(const FitModelSettings& settings,
                                           const scene_file::SceneFile& file, const scene_file::FitSpec& fit,
                                           const core::InputRecord& inputs) {
  if (!settings.journal) return nullptr;
  const SimulationOptions& run = settings.run;
  std::string text = fmt::format("fit\n{}\nseed {} photons {} events {}\n", core::version(),
                                 option_text(run.seed), option_text(run.photons), option_text(run.events));
  for (const core::InputFile& input : inputs.files()) text += input.name + " " + input.sha256 + "\n";
  if (const auto measured = core::read_whole_file(fit.measurement))
    text += "measurement " + core::sha256(*measured) + "\n";
  return std::make_unique<core::Journal>(*settings.journal, text + file.text());
}

std::optional<analysis::ModelPoint> journal_point(const core::Journal* journal,
                                                  const std::vector<double>& parameters, std::uint64_t draw,
                                                  std::size_t point) {
  analysis::ModelPoint earlier;
  if (!find_piece(journal, encoded(parameters, draw, point), earlier.value.value, earlier.value.error,
                  earlier.parts))
    return std::nullopt;
  return earlier;
}

void add_to_journal(core::Journal* journal, const std::vector<double>& parameters, std::uint64_t draw,
                    std::size_t point, const analysis::ModelPoint& traced) {
  add_piece(journal, encoded(parameters, draw, point), traced.value.value, traced.value.error, traced.parts);
}

}  // namespace scintray::simulation::detail
