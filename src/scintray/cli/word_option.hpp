#pragma once
/// Options whose value is one of a few words.

#include <CLI/CLI.hpp>
#include <string>

#include "scintray/core/words.hpp"
#include "scintray/optics/microsurface.hpp"

namespace scintray::cli {

/// The side that light comes from.
inline constexpr core::Word<optics::Side> kSideWords[] = {{"inside", optics::Side::inside},
                                                          {"outside", optics::Side::outside}};

/// An option whose words stand for values; help lists them, and another one is a wrong command line.
/// @param target  takes the value, lives as long as the command line is read: a T, or an optional one
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
