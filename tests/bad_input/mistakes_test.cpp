// The mistakes of tests/bad_input/mistakes: each file begins with comments that state the places in its
// messages, and what these contain: what was found, what was expected, and what to write. Each problem has a
// group of its own, which begins with its place; a note, on a scene that can run, has one word of its text.
//
//     # mistake the medium in small letters
//     # place 12:10
//     # found "lyso"
//     # expected medium
//     # write "LYSO"
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/source/light_source.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

/// What one answer must hold.
struct Expected {
  std::string place;
  std::vector<std::string> found, expected, write;
};

struct Mistake {
  std::string text;
  std::vector<Expected> problems;
  std::vector<std::string> notes;
  bool accepted = false;  ///< no mistake after all: the scene is read as its writer means it
};

Mistake read_mistake(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream all;
  all << stream.rdbuf();
  Mistake mistake{all.str(), {}, {}, false};
  std::istringstream lines(mistake.text);
  for (std::string line; std::getline(lines, line) && line.rfind("# ", 0) == 0;) {
    std::istringstream words(line.substr(2));
    std::string kind, rest;
    words >> kind >> std::ws;
    std::getline(words, rest);
    if (kind == "place") mistake.problems.push_back({rest, {}, {}, {}});
    if (kind == "note") mistake.notes.push_back(rest);
    if (kind == "accepted") mistake.accepted = true;
    if (mistake.problems.empty()) continue;
    if (kind == "found") mistake.problems.back().found.push_back(rest);
    if (kind == "expected") mistake.problems.back().expected.push_back(rest);
    if (kind == "write") mistake.problems.back().write.push_back(rest);
  }
  return mistake;
}

struct Answer {
  std::vector<core::Problem> problems;
  std::vector<std::string> notes;
};

/// The messages about a scene, as of `scintray check`.
Answer answer_to(const std::string& text, const std::string& file) {
  Answer answer;
  answer.problems = problems_of([&] {
    const scene_file::SceneFile scene = scene_file::SceneFile::from_text(text, file);
    for (const scene_file::DefinitionRef& unused : scene.unused_definitions())
      answer.notes.push_back(definition_key(unused));
    scene::SceneBuilder builder;
    const scene_file::SceneSpec spec = scene.spec(0);
    const scene::BuiltScene built = builder.build(spec);
    source::make_light_source(spec, built.scene, &answer.notes);
    answer.notes.insert(answer.notes.end(), built.warnings.begin(), built.warnings.end());
  });
  return answer;
}

std::string text_of(const Answer& answer) {
  std::string all;
  for (const core::Problem& problem : answer.problems) all += problem.text() + "\n";
  for (const std::string& note : answer.notes) all += "note: " + note + "\n";
  return all;
}

bool holds(const std::string& text, const std::vector<std::string>& parts) {
  return std::all_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return contains(text, part); });
}

bool answers(const core::Problem& problem, const Expected& expected) {
  const std::string place = std::to_string(problem.where.line) + ":" + std::to_string(problem.where.column);
  return place == expected.place && holds(problem.what, expected.found) &&
         holds(problem.what + "\n" + problem.hint, expected.expected) && holds(problem.hint, expected.write);
}

}  // namespace

TEST_CASE("every mistake gets the place, what was found, what was expected and what to write") {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(source_file("tests/bad_input/mistakes")))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  CHECK(files.size() >= 42 + 40);
  for (const std::filesystem::path& file : files) {
    const Mistake mistake = read_mistake(file);
    const Answer answer = answer_to(mistake.text, file.filename().string());
    INFO(file.filename().string() << ":\n" << text_of(answer));
    CHECK((mistake.problems.size() + mistake.notes.size() > 0) != mistake.accepted);
    CHECK(answer.problems.size() == mistake.problems.size());
    for (const Expected& expected : mistake.problems) {
      CHECK_FALSE(expected.found.empty());
      CHECK_FALSE(expected.expected.empty());
      CHECK_FALSE(expected.write.empty());
      CAPTURE(expected.place);
      CHECK(std::any_of(answer.problems.begin(), answer.problems.end(),
                        [&](const core::Problem& problem) { return answers(problem, expected); }));
    }
    for (const std::string& note : mistake.notes) {
      CAPTURE(note);
      CHECK(std::any_of(answer.notes.begin(), answer.notes.end(),
                        [&](const std::string& said) { return contains(said, note); }));
    }
  }
}

TEST_CASE("a quantity without a space is that with a space") {
  const std::string text =
      read_mistake(source_file("tests/bad_input/mistakes/33_no_space_before_the_unit.toml")).text;
  const scene_file::SceneSpec spec = scene_file::SceneFile::from_text(text, "scene.toml").spec(0);
  const auto& box = std::get<scene_file::BoxSpec>(spec.parts.front().shape);
  CHECK((box.high - box.low - core::Vec3(3.0, 3.0, 20.0)).norm() < 1e-12);
}

TEST_CASE("a key that is needed is written out as it has to be, quotes and unit included") {
  const Answer answer = answer_to(
      "ambient = \"air\"\n[[part]]\nname = \"crystal\"\nsurface = \"polished\"\n"
      "cylinder = { radius = \"2 mm\" }\n",
      "few.toml");
  std::string text;
  for (const core::Problem& problem : answer.problems) text += problem.text() + "\n";
  check_contains(text, {"height = \"...\"", "length", "\"2 mm\""});
  check_contains(text, {"medium = \"...\""});
}

TEST_CASE("no answer speaks the language of a parser") {
  for (const auto& entry : std::filesystem::directory_iterator(source_file("tests/bad_input/mistakes"))) {
    const Answer answer = answer_to(read_mistake(entry.path()).text, entry.path().filename().string());
    for (const core::Problem& problem : answer.problems) {
      CAPTURE(problem.text());
      for (const char* jargon : {"toml::", "bad format", "invalid line format", "value_t", "token", "parse_"})
        CHECK_FALSE(contains(problem.text(), jargon));
    }
  }
}
