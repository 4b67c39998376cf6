#pragma once
/// Readers of round shapes, each from its table of a part or an element.

#include <string>

#include "scintray/scene_file/shape.hpp"

namespace scintray::scene_file {

/// A length above 0, of the shape `shape`.
double positive_length(const config::TomlTable& table, const std::string& key, const std::string& shape);

/// A whole number from `least` to 10,000; `what` follows the number in the message of an error.
int number_of_pieces(const config::TomlTable& table, const std::string& key, int fallback, int least,
                     const std::string& what);

SphereSpec read_sphere(const config::TomlTable& part);
SpheroidSpec read_spheroid(const config::TomlTable& part);
TorusSpec read_torus(const config::TomlTable& part);
TubeSpec read_tube(const config::TomlTable& part);
LensSpec read_lens(const config::TomlTable& part);
RevolvedSpec read_revolved(const config::TomlTable& part);
FibreSpec read_fibre(const config::TomlTable& part);

}  // namespace scintray::scene_file
