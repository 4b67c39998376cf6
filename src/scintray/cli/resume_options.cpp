#include "scintray/cli/resume_options.hpp"

namespace scintray::cli {

void add_resume_flags(CLI::App& command, ResumeOptions& options) {
  CLI::Option* resume = command.add_flag("--resume", options.resume,
                                         "go on after what was finished when this was stopped or killed");
  command
      .add_flag("--restart", options.restart,
                "remove what was finished before (OUTPUT.journal), and begin anew")
      ->excludes(resume);
}

core::JournalSettings journal_settings(const ResumeOptions& options, const std::filesystem::path& output) {
  core::JournalSettings settings;
  settings.path = output;
  settings.path += ".journal";
  if (options.resume) settings.start = core::JournalStart::resume;
  if (options.restart) settings.start = core::JournalStart::restart;
  return settings;
}

}  // namespace scintray::cli
