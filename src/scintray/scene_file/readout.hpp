#pragma once
/// [readout]: the readout electronics of a scene (docs/readout.md).

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/readout_spec.hpp"

namespace scintray::scene_file {

/// Readout electronics of a scene; nothing without [readout]. Adds errors to the collector of the table.
/// @param scene  the outermost table
std::optional<detector::ReadoutSpec> read_readout(const config::TomlTable& scene);

/// Readout electronics of a file's text, of which only [readout] is read. @throws InputError with every
/// error, and without a [readout]
detector::ReadoutSpec readout_of_text(const std::string& text, const std::string& file);

}  // namespace scintray::scene_file
