#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "scintray/cli/json_answer.hpp"
#include "scintray/cli/map_options.hpp"
#include "scintray/cli/map_text.hpp"
#include "scintray/cli/progress.hpp"
#include "scintray/report/pages/pages.hpp"
#include "scintray/report/text/map_numbers.hpp"

namespace scintray::cli {

namespace {

struct PrepareArguments {
  MapOptions map;
  PreparationOptions preparation;
  std::string output, page;
  bool json = false;
};

void print_before_and_after(const topography::HeightMap& before, const topography::HeightMap& after) {
  const auto old_numbers = report::map_numbers(before), new_numbers = report::map_numbers(after);
  std::cout << fmt::format("{:<20}{:>16}{:>16}\n", "", "before", "after");
  for (std::size_t k = 0; k < new_numbers.size(); ++k)
    std::cout << fmt::format("{:<20}{:>16}{:>16}\n", new_numbers[k].name, old_numbers[k].value,
                             new_numbers[k].value);
}

void prepare_map(const PrepareArguments& arguments) {
  const JsonAnswer answer(arguments.json);
  // "before" is the part that is kept, as measured: both show the same surface.
  topography::Preparation cropping, preparation = preparation_of(arguments.preparation);
  std::swap(cropping.crop, preparation.crop);
  cropping.leveling.kind = topography::Leveling::Kind::none;
  topography::HeightMap before = read_map(arguments.map);
  topography::prepare(before, cropping);
  topography::HeightMap after = before;
  with_progress("preparing the map", [&] { topography::prepare(after, preparation); });
  print_before_and_after(before, after);
  std::cout << "\n";
  for (const std::string& step : after.steps) std::cout << step << "\n";
  print_warnings(after);
  topography::write_gsf(arguments.output, after);
  std::cout << "written      " << arguments.output << "\n";
  answer.print([&] { return Json{{"before", map_json(before)}, {"after", map_json(after)}}; });
  if (arguments.page.empty()) return;
  report::write_map_page(arguments.page, std::filesystem::path(arguments.map.map).filename().string(), before,
                         after);
  std::cout << "written      " << arguments.page << "\n";
}

}  // namespace

void add_map_prepare_command(CLI::App& map) {
  auto arguments = std::make_shared<PrepareArguments>();
  CLI::App* app = map.add_subcommand(
      "prepare", "Crop, mend, filter and level a map, in that order, and print the result");
  add_map_options(*app, arguments->map);
  app->add_option("-o,--output", arguments->output, "Height map to write (.gsf)")->required();
  add_preparation_options(*app, arguments->preparation);
  app->add_option("--page", arguments->page, "HTML page with the map before and after, and profiles");
  add_json_flag(*app, arguments->json);
  app->footer(
      "Example: scintray map prepare measured.gsf --level plane -o prepared.gsf --page prepared.html");
  app->callback([arguments] { prepare_map(*arguments); });
}

}  // namespace scintray::cli
