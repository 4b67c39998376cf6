#pragma once
/// Values as pieces of a journal.

#include <optional>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/core/journal.hpp"
#include "scintray/simulation/detail/byte_archive.hpp"

namespace scintray::simulation::detail {

/// Reads the values of an earlier piece. Returns false where the journal does not have it, or is null.
template <typename... T>
[[nodiscard]] bool find_piece(const core::Journal* journal, const std::string& key, T&... values) {
  const std::optional<std::string> bytes = journal ? journal->find(key) : std::nullopt;
  if (!bytes) return false;
  try {
    Decoder decoder(*bytes);
    pass(decoder, values...);
    if (decoder.at_end()) return true;
  } catch (const Undecodable&) {
  }
  throw core::InternalError("a piece of a journal does not hold what this version adds");
}

/// Adds the values as a piece; does nothing without a journal.
template <typename... T>
void add_piece(core::Journal* journal, const std::string& key, const T&... values) {
  if (journal) journal->add(key, encoded(values...));
}

}  // namespace scintray::simulation::detail
