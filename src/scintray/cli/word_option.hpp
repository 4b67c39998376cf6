#pragma once
/// Command-line options whose value is one of a few words.

#include <CLI/CLI.hpp>
#include <string>

#include "scintray/core/words.hpp"
#include "scintray/optics/microsurface.hpp"

namespace scintray::cli {

/// Words of the side of the incident light.
inline constexpr core::Word<optics::Side> kSideWords[] = {{"inside", optics::Side::inside},
                                                          {"outside", optics::Side::outside}};

/// An option whose words represent values; help lists them, and another word is a usage error.
/// @param target  receives the value, must outlive the parsing: a T or an optional T
template <typename T, std::size_t N, typename Target>
CLI::Option* add_word_option(CLI::App& app, const std::string& name, Target& target,
                             const core::Word<T> (&words)[N], const std::string& description) {
  const auto assign = [&target, &words](const std::string& word) {
    if (const auto value = core::find_word(words, word)) target = *value;
  };
  return app.add_option_function<std::string>(name, assign, description)
      ->check(CLI::IsMember(core::word_list(words)));
}

}  // namespace scintray::cli
