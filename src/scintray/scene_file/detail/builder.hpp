#pragma once
/// Common parts of [[array]] and [[light_guide]]: both make many parts that are placed as one body.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scintray/scene_file/contact.hpp"
#include "scintray/scene_file/part.hpp"

namespace scintray::scene_file {

/// Largest accepted number of parts of one builder.
inline constexpr std::size_t kMostParts = 200000;

/// The parts of one body, in its own frame, and their contacts.
struct BuiltBody {
  std::vector<PartSpec> parts;
  std::vector<ContactSpec> contacts;
};

/// A contact made with a builder's parts.
ContactSpec builder_contact(const std::string& a, const std::string& b, ContactKind kind,
                            const core::FileLocation& where, const config::NameRef& surface = {});

/// Two whole numbers from 1 to 10000; {1, 1} on an error or when absent.
std::array<int, 2> read_count(const config::TomlTable& table, const std::string& key);

/// A length for both x and y, or two; nothing when absent or on an error.
std::optional<std::array<double, 2>> read_length_pair(const config::TomlTable& table, const std::string& key);

}  // namespace scintray::scene_file
