#pragma once
/// Nodes of a table as pieces of a journal.

#include <cstdint>
#include <string>
#include <string_view>

#include "scintray/optics/table_nodes.hpp"

namespace scintray::topography::detail {

/// A node and the counts of its tracing.
struct TracedNode {
  optics::TableNode node;
  std::uint64_t cut = 0, unconverged = 0;
};

/// Key of a node of a slice of a table, by its side and position.
std::string node_key(std::uint64_t slice, std::uint64_t side, std::uint64_t position);
std::string encoded_node(const TracedNode& traced);
/// @throws InternalError for bytes that are not those of a node
TracedNode decoded_node(std::string_view bytes);

}  // namespace scintray::topography::detail
