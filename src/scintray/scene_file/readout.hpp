#pragma once
/// Reads [readout] (docs/readout.md).

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/readout_spec.hpp"

namespace scintray::scene_file {

/// The electronics that a scene requests; nothing when it has no [readout]. Adds what is wrong to the
/// collector of the table.
/// @param scene  the outermost table
std::optional<detector::ReadoutSpec> read_readout(const config::TomlTable& scene);

/// The same of a file's text, of which only [readout] is read. @throws InputError with all that is wrong, and
/// without a [readout]
detector::ReadoutSpec readout_of_text(const std::string& text, const std::string& file);

}  // namespace scintray::scene_file
