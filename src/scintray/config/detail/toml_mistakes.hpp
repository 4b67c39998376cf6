#pragma once
/// Mistakes of writing in a file that is not valid TOML, in words for readers who know nothing of TOML.

#include <cstddef>
#include <optional>
#include <string>

#include "scintray/config/detail/text_place.hpp"
#include "scintray/config/detail/toml11.hpp"

namespace scintray::config {

/// What is wrong in a text, and what to write instead.
struct ExplainedMistake {
  std::size_t offset = 0;  ///< of the place, in bytes
  std::string what, hint;
};

/// The mistake that made a parser stop.
/// @param offset  of the place where it stopped, in bytes
ExplainedMistake explain_mistake(const std::string& text, std::size_t offset,
                                 const toml11::SyntaxError& error);

/// A value that is none, or is followed by something; nothing where the value itself is sound.
std::optional<ExplainedMistake> explain_value(const TextPlace& place);

}  // namespace scintray::config
