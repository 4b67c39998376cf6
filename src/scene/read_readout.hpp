#pragma once
/// Reads [readout] (docs/readout.md).

#include "scintray/detector/readout_spec.hpp"
#include "scintray/scene/toml_reader.hpp"

namespace scintray {

/// The electronics that a scene asks for; nothing when it has no [readout]. Adds what is wrong to the
/// collector of the table.
/// @param scene  the outermost table
std::optional<ReadoutSpec> read_readout(const TomlTable& scene);

/// The same of a file's text, of which only [readout] is read. @throws InputError with all that is wrong, and
/// without a [readout]
ReadoutSpec readout_of_text(const std::string& text, const std::string& file);

}  // namespace scintray
