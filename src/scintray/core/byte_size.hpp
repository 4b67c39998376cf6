#pragma once
/// Sizes of files as text.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace scintray::core {

/// Bytes of a size such as "500 MB", "1.5 GiB" or "0": kB, MB, GB and TB are powers of 1000, KiB, MiB, GiB
/// and TiB of 1024 (IEC 80000-13). Nothing when the text is no such size, or has no unit and is not 0.
[[nodiscard]] std::optional<std::uint64_t> parse_byte_size(std::string_view text);

/// A size in the largest of B, KiB, MiB, GiB of which it has at least one: "12.3 MiB".
std::string byte_size_text(std::uint64_t bytes);

}  // namespace scintray::core
