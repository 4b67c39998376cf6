#pragma once
/// Running an entry under watch.

#include <string>

#include "entries.hpp"

namespace scintray::fuzz {

/// True when all of the content was read. Fails the test when anything but an input error escapes, or when
/// more memory is requested at once than the entry allows for so much input.
bool watched_run(const Entry& entry, const std::string& content);

}  // namespace scintray::fuzz
