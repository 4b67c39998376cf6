#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/core/byte_size.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/words.hpp"
#include "scintray/materials/table_cache.hpp"

namespace scintray::cli {

namespace {

using Clock = std::chrono::system_clock;

constexpr core::Word<double> kHours[] = {{"h", 1.0},     {"hours", 1.0},  {"d", 24.0},     {"day", 24.0},
                                         {"days", 24.0}, {"week", 168.0}, {"weeks", 168.0}};
constexpr double kMostHours = 876'600.0;  // a century: well within the range of the clock

/// A time before now, as "30 days".
Clock::time_point before_now(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  const std::optional<double> hours = core::find_word(kHours, unit);
  if (error != std::errc() || !hours || !(number >= 0.0) || !(number * *hours <= kMostHours))
    throw core::InputError(
        {{},
         "--older-than is " + core::in_quotes(text) + "; expected a time",
         "write it as \"30 days\"; the units are " + core::list_of(core::word_list(kHours))});
  return Clock::now() - std::chrono::seconds(std::llround(3600.0 * number * *hours));
}

void clear(const std::string& older_than, bool json) {
  const JsonAnswer answer(json);
  const Clock::time_point before = older_than.empty() ? Clock::time_point::max() : before_now(older_than);
  const std::filesystem::path folder = materials::default_table_cache();
  if (folder.empty()) {
    std::cout << "no cache: neither SCINTRAY_CACHE, XDG_CACHE_HOME nor HOME is set\n";
    return;
  }
  const materials::RemovedFiles removed = materials::CacheFolder(folder).remove_before(before);
  std::cout << fmt::format("removed      {} table{}, {}, from {}\n", removed.files,
                           removed.files == 1 ? "" : "s", core::byte_size_text(removed.bytes),
                           folder.string());
  answer.print([&] {
    return Json{{"folder", folder.string()}, {"removed", removed.files}, {"bytes", removed.bytes}};
  });
  if (removed.refused > 0)
    throw core::SystemError(fmt::format("{}: {} tables cannot be removed; is there permission?",
                                        folder.string(), removed.refused));
}

}  // namespace

void add_cache_clear_command(CLI::App& cache) {
  auto older_than = std::make_shared<std::string>();
  CLI::App* command = cache.add_subcommand("clear", "Remove the tables that are kept; other files stay");
  command->add_option("--older-than", *older_than, "only those not used for this time, as \"30 days\"");
  auto json = std::make_shared<bool>(false);
  add_json_flag(*command, *json);
  command->footer("Example: scintray cache clear --older-than \"30 days\"");
  command->callback([older_than, json] { clear(*older_than, *json); });
}

}  // namespace scintray::cli
