// Files cut short or damaged anywhere end in success or an InputError, never otherwise.
#include <filesystem>
#include <fstream>
#include <sstream>

#include "bad_input/good_scene.hpp"
#include "bad_input/marked_text.hpp"
#include "scintray/core/rng.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

#ifdef SCINTRAY_SANITIZED
constexpr int kTrials = 1000;
constexpr std::size_t kEveryMove = 4;
#else
constexpr int kTrials = 3000;
constexpr std::size_t kEveryMove = 1;
#endif

/// True when the text is refused. Every problem must state where and what.
bool refused(const std::string& text) {
  const std::vector<Problem> found = problems_of([&] { SceneFile::from_text(text, "scene.toml"); });
  for (const Problem& problem : found) {
    INFO(problem.text());
    CHECK(problem.where.line >= 1);
    CHECK(problem.where.column >= 1);
    CHECK_FALSE(problem.what.empty());
    CHECK_FALSE(problem.hint.empty());
  }
  return !found.empty();
}

}  // namespace

TEST_CASE("a scene cut short after any byte never crashes") {
  const std::string good = kGoodScene;
  std::size_t refusals = 0;
  for (std::size_t size = 0; size < good.size(); ++size) refusals += refused(good.substr(0, size)) ? 1 : 0;
  // Until the last required table, [source], is complete, every cut must be refused.
  CHECK(refusals >= good.find("photons = 1000"));
}

TEST_CASE("a scene with any bytes changed never crashes") {
  const std::string good = kGoodScene;
  Rng rng(20260101, StreamKind::other, 1);
  const std::string alphabet = "[]{}\"'=.,#\n\\ 019-+eEnaxµ\t\x01\xff";
  std::size_t refusals = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::string text = good;
    const int changes = 1 + static_cast<int>(4 * rng.uniform());
    for (int i = 0; i < changes; ++i)
      text[static_cast<std::size_t>(rng.uniform() * static_cast<double>(text.size()))] =
          alphabet[static_cast<std::size_t>(rng.uniform() * static_cast<double>(alphabet.size()))];
    refusals += refused(text) ? 1 : 0;
  }
  CHECK(refusals > std::size_t{kTrials} / 3);
}

TEST_CASE("a scene with any line left out, doubled or moved never crashes") {
  std::vector<std::string> lines;
  std::istringstream stream(kGoodScene);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  const auto text_of = [](const std::vector<std::string>& some) {
    std::string text;
    for (const std::string& line : some) text += line + "\n";
    return text;
  };
  std::size_t refusals = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::string> without = lines;
    without.erase(without.begin() + static_cast<long>(i));
    refusals += refused(text_of(without)) ? 1 : 0;
    std::vector<std::string> doubled = lines;
    doubled.insert(doubled.begin() + static_cast<long>(i), lines[i]);
    refusals += refused(text_of(doubled)) ? 1 : 0;
    for (std::size_t j = i % kEveryMove; j < lines.size(); j += kEveryMove) {
      std::vector<std::string> moved = without;
      moved.insert(moved.begin() + static_cast<long>(std::min(j, without.size())), lines[i]);
      refusals += refused(text_of(moved)) ? 1 : 0;
    }
  }
  CHECK(refusals > lines.size());
}

TEST_CASE("an error of a file that the scene names has the place that names it") {
  const std::filesystem::path folder = scratch_folder("named_file");
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("crystal.stl", "solid\nfoo");
  write("ground.gsf", "abc");
  write("table.h5", "\x89HDF\r\n\x1a\n");
  const auto crystal = [](const std::string& shape, const std::string& surface) {
    return "ambient = \"vacuum\"\n[[part]]\nname = \"crystal\"\n" + shape +
           "\nmedium = \"LSO\"\nsurface = \"" + surface +
           "\"\n[source]\ntype = \"photons\"\nregion = { part = \"crystal\" }\nwavelength = \"420 nm\"\n"
           "photons = 10\n";
  };
  const std::string box = "box = [\"2 mm\", \"2 mm\", \"20 mm\"]";
  struct Damaged {
    std::string file, scene;
  };
  const Damaged damaged[] = {
      {"crystal.stl", crystal("mesh = \"crystal.stl\"\nunit = \"mm\"", "polished")},
      {"ground.gsf", crystal(box, "mine") +
                         "[surfaces.mine]\nmodel = \"height_map\"\n[surfaces.mine.height_map]\n"
                         "file = \"ground.gsf\"\nlevel = \"plane\"\n"},
      {"table.h5", crystal(box, "mine") +
                       "[surfaces.mine]\nmodel = \"table\"\n[surfaces.mine.table]\nfile = \"table.h5\"\n"}};
  for (const Damaged& one : damaged) {
    CAPTURE(one.file);
    write("scene.toml", one.scene);
    const std::vector<Problem> found = problems_of([&] {
      scene::SceneBuilder builder;
      builder.build(SceneFile::load(folder / "scene.toml").spec(0));
    });
    REQUIRE(found.size() == 1);
    CAPTURE(found[0].text());
    CHECK(found[0].where.file.find(one.file) != std::string::npos);
    const std::size_t at = found[0].hint.find("the file is named at ");
    REQUIRE(at != std::string::npos);
    CHECK(found[0].hint.find("scene.toml:", at) != std::string::npos);
  }
}
