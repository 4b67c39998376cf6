#include "scintray/cli/shard_option.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string>

namespace scintray::cli {

namespace {

/// The shard of "17/400"; nothing for other text.
std::optional<simulation::Shard> shard_of(const std::string& text) {
  simulation::Shard shard;
  const char* end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool slash = number.ec == std::errc{} && number.ptr != end && *number.ptr == '/';
  const auto of = slash ? std::from_chars(number.ptr + 1, end, shard.of) : number;
  if (!slash || of.ec != std::errc{} || of.ptr != end || shard.number < 1 || shard.number > shard.of)
    return std::nullopt;
  return shard;
}

}  // namespace

void add_shard_option(CLI::App& command, std::optional<simulation::Shard>& shard) {
  command.add_option_function<std::string>(
      "--shard",
      [&shard](const std::string& text) {
        shard = shard_of(text);
        if (!shard)
          throw CLI::ValidationError("--shard", "\"" + text + "\" is no K/N with K from 1 to N, as 17/400");
      },
      "compute part K of N, as 17/400, for `scintray merge` (docs/scaling.md)");
}

std::filesystem::path shard_path(std::filesystem::path output, const simulation::Shard& shard) {
  const std::size_t digits = std::to_string(shard.of).size();
  return output.replace_extension(fmt::format("{:0{}}-of-{}.shard", shard.number, digits, shard.of));
}

}  // namespace scintray::cli
