#pragma once
/// Explanation of the mistakes in a file that is not valid TOML, for readers unfamiliar with TOML.

#include <cstddef>
#include <optional>
#include <string>

#include "scintray/config/detail/text_place.hpp"
#include "scintray/config/detail/toml11.hpp"

namespace scintray::config {

/// A mistake in a text, and its correction.
struct ExplainedMistake {
  std::size_t offset = 0;  ///< of the place, in bytes
  std::string what, hint;
};

/// The mistake that made a parser stop.
/// @param offset  of the place where it stopped, in bytes
ExplainedMistake explain_mistake(const std::string& text, std::size_t offset,
                                 const toml11::SyntaxError& error);

/// The mistake of an invalid value, or of text after a value; nothing where the value itself is valid.
std::optional<ExplainedMistake> explain_value(const TextPlace& place);

}  // namespace scintray::config
