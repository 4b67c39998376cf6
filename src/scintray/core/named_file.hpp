#pragma once
/// Errors of a file that another file names: a scene's mesh, table, height map or measured curve.

#include "scintray/core/error.hpp"

namespace scintray::core {

/// The same problems; the hint of each ends with the place at which the file is named. Unchanged where that
/// place is not known, as for a scene made in code.
[[nodiscard]] InputError named_at(const FileLocation& where, const InputError& error);

/// What `read` returns; an InputError that it throws has the place at which its file is named.
template <typename Read>
auto read_named_file(const FileLocation& where, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw named_at(where, error);
  }
}

}  // namespace scintray::core
