/// What every command has: examples in its help that parse, JSON where it prints numbers, error codes, exit
/// codes.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/program.hpp"
#include "scintray/cli/commands.hpp"
#include "scintray/cli/error_kinds.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/optics/table.hpp"
#include "scintray/report/text/result_json.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

std::vector<CLI::App*> subcommands_of(CLI::App& command) {
  return command.get_subcommands([](CLI::App*) { return true; });
}

/// All commands of the program; a command line that parses ends with CLI::Success before any of them runs.
class IdleProgram {
 public:
  IdleProgram() {
    app_.require_subcommand(1);
    for (const cli::AddCommand add : cli::commands()) add(app_);
    app_.parse_complete_callback([] { throw CLI::Success(); });
  }
  CLI::App& app() { return app_; }

 private:
  CLI::App app_{"", "scintray"};
};

void collect(CLI::App& command, const std::string& before, std::map<std::string, std::string>& footers) {
  for (CLI::App* one : subcommands_of(command)) {
    const std::string name = before + " " + one->get_name();
    footers[name] = one->get_footer();
    collect(*one, name, footers);
  }
}

/// The command lines of a footer, less what a shell would consume and the remarks behind three blanks.
std::vector<std::string> examples(const std::string& footer) {
  std::vector<std::string> found;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find("scintray ");
    if (at == std::string::npos ||
        (at > 0 && line.substr(0, at).find_first_not_of(" ") != std::string::npos &&
         !contains(line.substr(0, at), "Example")))
      continue;
    line = line.substr(at);
    for (const char* end : {" > ", "   "}) line = line.substr(0, line.find(end));
    found.push_back(line);
  }
  return found;
}

/// Standard output alone of a command that succeeds.
std::string standard_output(const std::string& arguments, const std::filesystem::path& folder) {
  const std::string line = "cd " + folder.string() + " && SCINTRAY_CACHE_SIZE=0 " + program_file().string() +
                           " " + arguments + " > out.json 2> err.txt";
  CAPTURE(arguments);
  const int status = std::system(line.c_str());
  CAPTURE(config::read_text_file(folder / "err.txt"));
  CHECK(status == 0);
  return config::read_text_file(folder / "out.json");
}

}  // namespace

TEST_CASE("the help of every command has examples, and each of them parses") {
  std::map<std::string, std::string> footers;
  collect(IdleProgram().app(), "scintray", footers);
  CHECK(footers.size() > 30);
  for (const auto& [command_name, footer] : footers) {
    const std::string& name = command_name;
    CAPTURE(name);
    const std::vector<std::string> lines = examples(footer);
    CHECK_FALSE(lines.empty());
    for (const std::string& line : lines) {
      CAPTURE(line);
      CHECK(line.rfind(name, 0) == 0);
      IdleProgram program;
      CHECK_THROWS_AS(program.app().parse(line, true), CLI::Success);
    }
  }
}

TEST_CASE("every command line of the pages parses") {
  std::size_t lines = 0;
  std::vector<std::filesystem::path> pages{source_file("README.md")};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_file("docs")))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  for (const std::filesystem::path& page : pages) {
    CAPTURE(page.string());
    std::istringstream text(config::read_text_file(page));
    for (std::string line; std::getline(text, line);) {
      const std::size_t at = line.find_first_not_of(' ');
      if (at == std::string::npos || (at != 0 && at != 4)) continue;
      line = line.substr(at);
      if (line.rfind("build/release/bin/scintray ", 0) == 0) line = line.substr(18);
      if (line.rfind("scintray ", 0) != 0 || line.rfind("scintray --", 0) == 0) continue;
      for (std::string rest; line.ends_with("\\") && std::getline(text, rest);)
        line = line.substr(0, line.size() - 1) + rest;
      for (const char* end : {" > ", " #", " | ", " && ", " 2>"}) line = line.substr(0, line.find(end));
      if (contains(line, "COMMAND") || contains(line, "...") || contains(line, "$")) continue;
      CAPTURE(line);
      ++lines;
      IdleProgram program;
      CHECK_THROWS_AS(program.app().parse(line, true), CLI::Success);
    }
  }
  CHECK(lines > 60);
}

TEST_CASE("every command that prints numbers prints them as JSON on request") {
  const std::set<std::string> without{// they print no numbers
                                      "scintray new",          "scintray manual",      "scintray completion",
                                      "scintray schema",       "scintray view",        "scintray export",
                                      "scintray table export", "scintray table import"};
  std::map<std::string, std::string> footers;
  IdleProgram program;
  collect(program.app(), "scintray", footers);
  for (const auto& [command_name, footer] : footers) {
    const std::string& name = command_name;
    CAPTURE(name);
    CLI::App* command = &program.app();
    std::istringstream words(name.substr(std::string("scintray ").size()));
    for (std::string word; words >> word;) command = command->get_subcommand(word);
    if (!subcommands_of(*command).empty()) continue;
    CHECK((command->get_option_no_throw("--json") != nullptr) != (without.count(name) > 0));
  }
}

TEST_CASE("with --json standard output is one JSON value, and the text is on standard error") {
  const auto folder = scratch_folder("json");
  REQUIRE(run_program({"new", "crystal"}, folder).exit_code == cli::kSuccess);
  using nlohmann::json;
  const json run = json::parse(standard_output("run crystal.toml --photons 1000 --json", folder));
  CHECK(run["points"].size() == 5);
  CHECK(contains(config::read_text_file(folder / "err.txt"), "results  crystal.h5"));
  CHECK(json::parse(standard_output("report crystal.h5 --json", folder)) == run);
  const json both = json::parse(standard_output("report crystal.h5 crystal.h5 --json", folder));
  CHECK(both["numbers"][0]["sigmas"][1] == 0.0);
  std::filesystem::copy_file(folder / "crystal.toml", folder / "again.toml");
  const json several =
      json::parse(standard_output("run crystal.toml again.toml --photons 1000 --json", folder));
  REQUIRE(several.size() == 2);
  CHECK(several[1]["points"][0]["fates"] == run["points"][0]["fates"]);
  const json check = json::parse(standard_output("check crystal.toml --json", folder));
  CHECK(check["points"][0]["parts"].size() >= 2);
  CHECK(check["points"][0]["parts"][0]["volume_mm3"].get<double>() == doctest::Approx(180.0));
  const json steps = json::parse(standard_output("replay crystal.h5 --event 0 --photon 1 --json", folder));
  CHECK(steps["steps"].size() >= 2);
  const json map = json::parse(standard_output(
      "map synthesize gaussian --rms-height '0.5 um' --correlation-length '5 um' --points 256 -o m.gsf "
      "--json",
      folder));
  CHECK(map["sq_um"].get<double>() == doctest::Approx(0.5).epsilon(0.5));
  CHECK(json::parse(standard_output("map describe m.gsf --json", folder))["columns"] == 256);
  const json table =
      json::parse(standard_output("table stack lso_polished_esr_air --inside LSO --outside air --wavelength "
                                  "'420 nm' --rays 3 --incidence-step "
                                  "'45 deg' --no-refine -o t.h5 --json",
                                  folder));
  CHECK(table["slices"].size() == 1);
  CHECK(json::parse(standard_output("table show t.h5 --json", folder)) == table);
  const optics::SurfaceTable read = optics::read_table(folder / "t.h5");
  optics::TableProvenance provenance = read.provenance();
  CHECK(provenance.unclassified == 0);
  provenance.unclassified = 7;  // no builder makes such a table
  optics::write_table(folder / "u.h5", optics::SurfaceTable(read.slices(), read.azimuth_kind(), provenance));
  CHECK(json::parse(standard_output("table show u.h5 --json", folder))["unclassified"] == 7);
  CHECK(contains(standard_output("table show u.h5", folder), "7 unclassified"));
  const json readings =
      json::parse(standard_output("goniometer polished --angle '20 deg' --rays 1000 --json", folder));
  CHECK(readings["readings"][0]["rays"] == 1000);
  CHECK(json::parse(standard_output("cache list --json", folder)).contains("tables"));
  std::ofstream(folder / "open.stl") << "solid s\nendsolid s\n";
  CHECK(run_program({"repair", "open.stl", "--unit", "mm", "-o", "x.stl"}, folder).exit_code ==
        cli::kBadInput);
}

TEST_CASE("codes of errors are unique, explained, and behind the messages") {
  std::set<std::string> codes;
  for (const cli::ErrorKind& kind : cli::error_kinds()) {
    CAPTURE(kind.code);
    CHECK(codes.insert(kind.code).second);
    CHECK(std::string(kind.code).find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos);
    const std::string text = cli::explanation(kind.code);
    for (const char* part : {kind.code, kind.title, kind.why, kind.remedy}) {
      CHECK(std::string(part).size() > 3);
      CHECK(contains(text, part));
    }
  }
  const auto folder = scratch_folder("explain");
  const Ended explained = run_program({"--explain", "unknown-key"}, folder);
  CHECK(explained.exit_code == cli::kSuccess);
  CHECK(contains(explained.output, "unknown-key: "));
  const Ended list = run_program({"--explain"}, folder);
  CHECK(list.exit_code == cli::kSuccess);
  for (const std::string& code : codes) CHECK(contains(list.output, code + " "));
  const Ended unknown = run_program({"--explain", "unknwon-key"}, folder);
  CHECK(unknown.exit_code == cli::kBadInput);
  CHECK(contains(unknown.output, "did you mean unknown-key?"));
  std::ofstream(folder / "bad.toml") << "ambient = \"air\"\nambiant = 3\n";
  CHECK(contains(run_program({"check", "bad.toml"}, folder).output,
                 "unknown key \"ambiant\" at the top of the file "
                 "[unknown-key]\n"));
}

TEST_CASE("an error of a damaged file has the code of one, whatever else its message has") {
  const auto folder = scratch_folder("damaged_code");
  std::ofstream(folder / "mesh.off") << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n";
  const Ended ended = run_program({"repair", "mesh.off", "--unit", "mm", "-o", "out.ply"}, folder);
  CHECK(contains(ended.output, "does not exist"));
  CHECK(contains(ended.output, "[file-damaged]"));
  CHECK(cli::input_error_code("no vertex", "the file is cut short or damaged; export it again") ==
        std::string("file-damaged"));
  CHECK(cli::input_error_code("there is no part \"a\"", "the parts are \"damaged\"") ==
        std::string("unknown-name"));
}

TEST_CASE("every fragment by which a kind of error is known stands in the sources") {
  std::string sources;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_file("src/scintray"))) {
    if (entry.path().extension() != ".cpp" || entry.path().filename() == "error_kinds.cpp") continue;
    sources += config::read_text_file(entry.path());
  }
  // Literals of C++ that follow each other are one.
  std::string joined;
  bool closed = false;
  std::size_t kept = 0;
  for (const char c : sources) {
    if (closed && (c == ' ' || c == '\n')) {
      joined += c;
      continue;
    }
    if (closed && c == '"') {
      joined.resize(kept);
      closed = false;
      continue;
    }
    closed = c == '"';
    if (closed) kept = joined.size();
    joined += c;
  }
  for (const cli::ErrorKind& kind : cli::error_kinds())
    for (const std::string_view fragment : kind.fragments) {
      CAPTURE(std::string(kind.code));
      CAPTURE(fragment);
      std::string written;
      for (const char c : fragment) written += c == '"' ? std::string("\\\"") : std::string(1, c);
      CHECK((contains(joined, written) || contains(sources, written)));
    }
}

TEST_CASE("each error of the mistakes has a code of its own kind") {
  const auto folder = scratch_folder("mistake_codes");
  std::istringstream page(config::read_text_file(source_file("docs/mistakes.md")));
  std::size_t errors = 0, general = 0;
  for (std::string line; std::getline(page, line);) {
    const std::size_t at = line.find(": error: ");
    if (at == std::string::npos) continue;
    const std::string what = line.substr(at + 9);
    CAPTURE(what);
    ++errors;
    if (cli::input_error_code(what) == std::string(cli::kInputError)) {
      ++general;
      MESSAGE("no kind: " << what);
    }
  }
  CHECK(errors > 90);
  CHECK(general == 0);
}

TEST_CASE("the README and the manual list the exit codes of the program") {
  const std::string readme = config::read_text_file(source_file("README.md"));
  const auto folder = scratch_folder("exit_codes");
  REQUIRE(run_program({"manual", "pages"}, folder).exit_code == cli::kSuccess);
  const std::string manual = config::read_text_file(folder / "pages/scintray.1");
  for (const int code : {cli::kSuccess, cli::kBadInput, cli::kBadUsage, cli::kSystemFailure, cli::kDefect,
                         cli::kInterrupted}) {
    CHECK(contains(readme, "| " + std::to_string(code) + " | "));
    CHECK(contains(manual, ".TP\n" + std::to_string(code) + "\n"));
  }
  std::ofstream(folder / "bad.toml") << "ambient = 3\n";
  CHECK(run_program({"check", "bad.toml"}, folder).exit_code == cli::kBadInput);
  CHECK(run_program({"chekc", "bad.toml"}, folder).exit_code == cli::kBadUsage);
  CHECK(run_program({"new", "crystal", "-o", "nowhere/crystal.toml"}, folder).exit_code ==
        cli::kSystemFailure);
}
