#include <fmt/format.h>

#include "scintray/core/error.hpp"
#include "scintray/core/sha256.hpp"
#include "scintray/core/version.hpp"
#include "scintray/simulation/detail/fit_journal.hpp"

namespace scintray::simulation::detail {

namespace {

std::string key_of(const std::vector<double>& parameters, std::uint64_t draw, std::size_t point) {
  return core::bytes_of(parameters) + core::bytes_of(std::vector<std::uint64_t>{draw, point});
}

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
  if (!journal) return std::nullopt;
  const std::optional<std::string> bytes = journal->find(key_of(parameters, draw, point));
  if (!bytes) return std::nullopt;
  const auto numbers = core::numbers_of<double>(*bytes);
  if (numbers.size() < 2) throw core::InternalError("a point of a journal is too short");
  return analysis::ModelPoint{{numbers[0], numbers[1]}, {numbers.begin() + 2, numbers.end()}};
}

void add_to_journal(core::Journal* journal, const std::vector<double>& parameters, std::uint64_t draw,
                    std::size_t point, const analysis::ModelPoint& traced) {
  if (!journal) return;
  std::vector<double> numbers{traced.value.value, traced.value.error};
  numbers.insert(numbers.end(), traced.parts.begin(), traced.parts.end());
  journal->add(key_of(parameters, draw, point), core::bytes_of(numbers));
}

}  // namespace scintray::simulation::detail
