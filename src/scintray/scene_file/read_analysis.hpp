#pragma once
/// Reads [analysis] (docs/analysis.md).

#include <filesystem>
#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/scene_file/analysis_spec.hpp"

namespace scintray::scene_file {

/// How a scene's events are to be looked at; as AnalysisSpec has it where [analysis] or a key is not given.
/// Adds what is wrong to the collector of the table. The caller looks at what is unknown.
AnalysisSpec read_analysis(const config::TomlTable& scene);

/// The same of a file's text, of which only [analysis] is read. @throws InputError with all that is wrong
AnalysisSpec analysis_of_text(const std::string& text, const std::string& file);

}  // namespace scintray::scene_file
