#pragma once
/// Errors of the dimensions of shapes.

#include <string>

namespace scintray::mesh {

/// Throws InputError without a place: the caller that read the dimensions adds it.
[[noreturn]] void reject_shape(const std::string& what, const std::string& hint = {});

}  // namespace scintray::mesh
