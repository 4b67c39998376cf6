#pragma once
/// --resume and --restart of commands that keep the finished pieces of their work.

#include <CLI/CLI.hpp>
#include <filesystem>

#include "scintray/core/journal.hpp"

namespace scintray::cli {

struct ResumeOptions {
  bool resume = false, restart = false;
};

/// Adds the two flags.
void add_resume_flags(CLI::App& command, ResumeOptions& options);

/// Settings of the journal beside an output, NAME.journal.
core::JournalSettings journal_settings(const ResumeOptions& options, const std::filesystem::path& output);

}  // namespace scintray::cli
