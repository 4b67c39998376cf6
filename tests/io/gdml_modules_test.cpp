// GDML in several files: entities of the DOCTYPE, and modules of <file> in <physvol>.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "io/gdml_texts.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::exchange;
using namespace scintray::test;

namespace {

/// A folder of files by name, the first file of which is "main.gdml".
class ModuleFolder {
 public:
  explicit ModuleFolder(const std::string& name) : path_(scratch_folder("gdml_modules_" + name)) {}

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
  }
  std::filesystem::path path(const std::string& name) const { return path_ / name; }

  SceneDraft draft() const {
    gdml::GdmlImport options;
    options.mesh_folder = "meshes";
    std::ifstream file(path_ / "main.gdml", std::ios::binary);
    return gdml::draft_of_gdml({std::istreambuf_iterator<char>(file), {}}, (path_ / "main.gdml").string(),
                               options);
  }

  /// What an import finds wrong: every error has a hint.
  std::string complaint() const {
    for (const core::Problem& problem : problems_of([&] { draft(); })) {
      CAPTURE(problem.what);
      CHECK_FALSE(problem.hint.empty());
    }
    return complaint_of([&] { draft(); });
  }

  scene_file::SceneSpec spec() const {
    const auto file = path_ / "written" / "scene.toml";
    std::filesystem::remove_all(file.parent_path());
    write_scene_draft(draft(), file);
    return scene_file::SceneFile::load(file).spec(0);
  }

 private:
  std::filesystem::path path_;
};

/// The text with a DOCTYPE of these declarations.
std::string with_doctype(const GdmlText& text, const std::string& declarations) {
  std::string all = text.text();
  all.insert(all.find("<gdml>"),
             "<!DOCTYPE gdml [\n<!-- <!ENTITY no SYSTEM \"no.xml\"> -->\n" + declarations + "]>\n");
  return all;
}

const scene_file::PartSpec& part_named(const scene_file::SceneSpec& spec, const std::string& name) {
  const auto found = std::find_if(spec.parts.begin(), spec.parts.end(),
                                  [&](const auto& known) { return known.name.name == name; });
  REQUIRE(found != spec.parts.end());
  return *found;
}

std::string all_notes(const SceneDraft& draft) {
  std::string all;
  for (const std::string& note : draft.notes) all += note + "\n";
  return all;
}

}  // namespace

TEST_CASE("GDML: entities of files, of texts, within each other and in attributes are replaced") {
  const ModuleFolder folder("entities");
  GdmlText text;
  text.define = "<constant name=\"size\" value=\"&size;\"/>\n";
  text.materials = "&materials;\n";
  text.solids = "<!-- &nothing; --><box name=\"it\" x=\"size\" y='&size;' z=\"&size; + 0\"/>\n";
  text.structure = "&volumes;";
  text.daughters = gdml_placed("p", "body", R"(<position x="&far; mm"/>)");
  text.daughters.replace(text.daughters.find(" mm"), 3, "");
  folder.write("main.gdml", with_doctype(text, R"(<!ENTITY size "2">
<!ENTITY size "a second one does not count">
<!ENTITY far '&size;*10'>
<!ENTITY materials SYSTEM "parts/materials.xml">
<!ENTITY volumes PUBLIC "-//some//volumes" 'parts/volumes.xml'>
)"));
  folder.write("parts/materials.xml",
               "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<material name=\"Acryl &amp; more\"><property "
               "name=\"RINDEX\" "
               "ref=\"N15\"/><D value=\"1.2\"/></material>\n");
  folder.write("parts/volumes.xml",
               "<!-- a comment & its sign -->\n" + gdml_volume("body", "it", "Acryl &amp; more"));
  const scene_file::SceneSpec spec = folder.spec();
  REQUIRE(spec.parts.size() == 1);
  CHECK(spec.parts[0].placement.translate.isApprox(core::Vec3(20, 0, 0)));
  check_contains(folder.draft().toml, "medium = \"Acryl & more\"");
  check_contains(folder.draft().toml, "box = { low = [\"-1 mm\", \"-1 mm\", \"-1 mm\"]");
}

TEST_CASE("GDML: parameter entities declare the entities of a detector in files of their own") {
  const ModuleFolder folder("parameter_entities");
  GdmlText text;
  text.define = "<constant name=\"size\" value=\"&size;\"/>\n";
  text.materials = "&materials;\n";
  text.solids = "<box name=\"it\" x=\"size\" y=\"&size;\" z=\"&size;\"/>\n";
  text.structure = gdml_volume("body", "it", "Glass");
  text.daughters = gdml_placed("p", "body", "<position x=\"&far;\"/>");
  folder.write("main.gdml", with_doctype(text, R"(<!ENTITY % shared SYSTEM "parts/shared.ent">
<!ENTITY size "2">
%shared;
<!ENTITY % one "<!ENTITY far '20'>">
%one;
)"));
  // Files are named from the folder of the file that names them.
  folder.write("parts/shared.ent",
               "<?xml version=\"1.0\"?>\n<!ENTITY size \"7: the first counts\">\n<!ENTITY % base \"ma\">\n"
               "<!ENTITY materials SYSTEM \"materials.xml\">\n<!ENTITY % more SYSTEM \"more.ent\">\n%more;\n"
               "<!ENTITY named \"%base;terial\">\n");
  folder.write("parts/more.ent", "<!-- nothing --> <!ENTITY far \"30\">\n");
  folder.write("parts/materials.xml",
               "<material name=\"Glass\"><!-- &named; --><property name=\"RINDEX\" ref=\"N15\"/><D "
               "value=\"1.2\"/></material>\n");
  const scene_file::SceneSpec spec = folder.spec();
  REQUIRE(spec.parts.size() == 1);
  CHECK(spec.parts[0].placement.translate.isApprox(core::Vec3(30, 0, 0)));
  check_contains(folder.draft().toml, "box = { low = [\"-1 mm\", \"-1 mm\", \"-1 mm\"]");
}

TEST_CASE("GDML: an error in an included file is at that file's line") {
  const ModuleFolder folder("places");
  GdmlText text;
  text.solids = "&solids;\n";
  text.structure = gdml_volume("body", "it");
  text.daughters = gdml_placed("p", "body");
  folder.write("main.gdml", with_doctype(text, "<!ENTITY solids SYSTEM \"solids.xml\">\n"));
  folder.write(
      "solids.xml",
      "<box name=\"other\" x=\"1\" y=\"1\" z=\"1\"/>\n\n  <box name=\"it\" x=\"1\" y=\"1\" z=\"-1\"/>\n");
  check_contains(folder.complaint(), {"solids.xml:3:4: error:", "solid \"it\" (box)"});
  folder.write("solids.xml", "<box name=\"it\" x=\"1\" y=\"1\" z=\"1\">\n</bow>");
  check_contains(folder.complaint(), {"solids.xml:2:", "not well-formed"});
  // After the entity the lines are those of the file itself.
  folder.write("solids.xml", "<box name=\"it\" x=\"1\" y=\"1\" z=\"1\"/>\n\n\n\n");
  CHECK(folder.complaint().empty());
  text.daughters = "\n" + gdml_placed("p", "gone");
  const std::string all = with_doctype(text, "<!ENTITY solids SYSTEM \"solids.xml\">\n");
  folder.write("main.gdml", all);
  const auto line =
      1 + std::count(all.begin(), all.begin() + static_cast<long>(all.find("ref=\"gone\"")), '\n');
  check_contains(folder.complaint(), {"main.gdml:" + std::to_string(line) + ":", "\"gone\""});

  // A module: its own file, and its own entity.
  text.daughters = R"(<physvol name="m"><file name="module.gdml" volname="inner"/></physvol>)";
  folder.write("main.gdml", with_doctype(text, "<!ENTITY solids SYSTEM \"solids.xml\">\n"));
  GdmlText module;
  module.define = "<constant name=\"wide\" value=\"2*undefined\"/>\n";
  module.structure = gdml_volume("inner", "it");
  folder.write("module.gdml", module.text());
  check_contains(folder.complaint(), {"module.gdml:6:2: error:", "2*undefined"});
}

TEST_CASE("GDML: a module is placed with its own definitions, its surfaces and its sensitive volumes") {
  const ModuleFolder folder("module");
  GdmlText text = gdml_solid(R"(<box name="it" x="L" y="2" z="2"/>)");
  text.define = "<constant name=\"L\" value=\"4\"/>\n";
  text.daughters += R"(<physvol name="left"><file name="sub/module.gdml"/><position x="-50"/></physvol>
<physvol name="right"><file name="sub/module.gdml" volname="cell"/><position x="50"/></physvol>)";
  folder.write("main.gdml", text.text());
  // The same names for other values, a matrix of its own, and a world of its own name.
  folder.write("sub/module.gdml", R"(<gdml><define><constant name="L" value="7"/>
<matrix name="N15" coldim="2" values="2*eV 1.8 4*eV 1.8"/><matrix name="E" coldim="2" values="2*eV 0.5 4*eV 0.5"/></define>
<materials><material name="Crystal"><property name="RINDEX" ref="N15"/><D value="7"/></material></materials>
<solids><box name="cell_box" x="L" y="L" z="L"/><box name="tray_box" x="2*L" y="2*L" z="2*L"/>
<opticalsurface name="black" model="unified" finish="polished" type="dielectric_metal" value="0"><property name="EFFICIENCY" ref="E"/></opticalsurface></solids>
<structure><volume name="cell"><materialref ref="Crystal"/><solidref ref="cell_box"/></volume>
<volume name="tray"><materialref ref="Vacuum"/><solidref ref="tray_box"/>
<physvol name="in_tray"><volumeref ref="cell"/></physvol></volume>
<skinsurface name="s" surfaceproperty="black"><volumeref ref="cell"/></skinsurface></structure>
<setup name="Default" version="1.0"><world ref="tray"/></setup></gdml>)");
  const SceneDraft draft = folder.draft();
  CHECK(draft.missing.empty());
  const scene_file::SceneSpec spec = folder.spec();
  CHECK(spec.parts.size() == 4);  // the body, the tray with its cell, and the cell alone
  CHECK(part_named(spec, "left").placement.translate.isApprox(core::Vec3(-50, 0, 0)));
  const scene::BuiltScene scene = scene::SceneBuilder().build(spec);
  const auto volume = [&](const std::string& name) {
    for (const scene::PartInfo& known : scene.scene.parts)
      if (known.name == name) return known.volume_mm3;
    return 0.0;
  };
  CHECK(volume("body_phys") == doctest::Approx(16.0));
  CHECK(volume("right") == doctest::Approx(343.0));
  CHECK(volume("in_tray") == doctest::Approx(343.0));
  check_contains(draft.toml, "[media.\"Crystal\"]");
  check_contains(draft.toml.substr(draft.toml.find("[media.\"Crystal\"]")), "value = [1.8, 1.8]");
  check_contains(draft.toml, "[sensors.\"black sensor\"]");
  check_contains(draft.toml.substr(draft.toml.find("[surfaces.\"black\"]")), "geant4_polished");
}

TEST_CASE("GDML: names are those of all files together, the first counts, and this is listed") {
  const ModuleFolder folder("names");
  GdmlText text = gdml_solid(R"(<box name="it" x="4" y="2" z="2"/>)");
  text.daughters +=
      R"(<physvol name="m"><file name="module.gdml" volname="own"/><position x="50"/></physvol>)";
  folder.write("main.gdml", text.text());
  // Geant4 keeps solids and volumes in stores of the whole program (G4SolidStore, G4LogicalVolumeStore).
  GdmlText module = gdml_solid(R"(<box name="it" x="9" y="9" z="9"/>)");
  module.structure += gdml_volume("own", "it");
  folder.write("module.gdml", module.text());
  const SceneDraft draft = folder.draft();
  const scene::BuiltScene scene = scene::SceneBuilder().build(folder.spec());
  REQUIRE(scene.scene.parts.size() == 2);
  for (const scene::PartInfo& known : scene.scene.parts) CHECK(known.volume_mm3 == doctest::Approx(16.0));
  check_contains(all_notes(draft), {"second solid \"it\"", "the first is used"});
  check_contains(all_notes(draft), {"second volume \"body\"", "the first is used"});
  check_contains(all_notes(draft), {"Glass", "the first is used"});
  // The module's world has the name of the first file's: Geant4 would place this in itself.
  text.daughters = R"(<physvol name="m"><file name="module.gdml"/></physvol>)";
  folder.write("main.gdml", text.text());
  check_contains(folder.complaint(), {"\"World\"", "inside itself"});
}

TEST_CASE(
    "GDML: files that are not there, lie elsewhere, or include themselves are refused with their place") {
  const ModuleFolder folder("refused");
  GdmlText text = gdml_solid(R"(<box name="it" x="4" y="2" z="2"/>)");
  const auto module = [&](const std::string& name) {
    text.daughters = "<physvol name=\"m\"><file name=\"" + name + "\"/></physvol>";
    folder.write("main.gdml", text.text());
    return folder.complaint();
  };
  check_contains(module("gone.gdml"), {"main.gdml:18:", "\"gone.gdml\"", "does not exist"});
  check_contains(module(""), "no name of a file");
  check_contains(module("/etc/hostname"), {"main.gdml:18:", "not in the folder", "not opened"});
  check_contains(module("../outside.gdml"), "not in the folder");
  check_contains(module("https://example.org/a.gdml"), "nothing is fetched");
  std::filesystem::create_directories(folder.path("a_folder"));
  check_contains(module("a_folder"), "not a file");
  std::filesystem::create_symlink("/etc/hostname", folder.path("link.gdml"));
  check_contains(module("link.gdml"), "not in the folder");
  check_contains(module("main.gdml"), {"main.gdml:18:", "includes itself"});
  GdmlText back = text;
  back.daughters = R"(<physvol name="b"><file name="main.gdml"/></physvol>)";
  folder.write("back.gdml", back.text());
  check_contains(module("back.gdml"), {"back.gdml:18:", "includes itself"});

  const auto entities = [&](const std::string& declarations, const std::string& use) {
    text = gdml_solid(R"(<box name="it" x="4" y="2" z="2"/>)" + use);
    folder.write("main.gdml", with_doctype(text, declarations));
    return folder.complaint();
  };
  check_contains(entities("<!ENTITY a SYSTEM \"gone.xml\">", "&a;"),
                 {"main.gdml:4:1:", "gone.xml", "does not exist"});
  check_contains(entities("<!ENTITY a SYSTEM \"/etc/hostname\">", "&a;"), "not in the folder");
  check_contains(entities("<!ENTITY a \"\">", "&b;"), {"main.gdml:17:35:", "&b;", "not declared"});
  check_contains(entities("<!ENTITY a \"&b;\"><!ENTITY b \"&a;\">", "&a;"), "contains itself");
  folder.write("self.xml", "<!-- --> &a;");
  check_contains(entities("<!ENTITY a SYSTEM \"self.xml\">", "&a;"), {"self.xml:1:10:", "contains itself"});
  check_contains(entities("<!ENTITY a SYSTEM \"self.xml\">", "<box name=\"&a;\"/>"), "in an attribute");
  check_contains(entities("<!ENTITY a SYSTEM>", ""), "of a form that is not read");
  check_contains(entities("%a;", ""), {"main.gdml:4:1:", "parameter entity", "%a;", "not declared"});
  folder.write("loop.ent", "\n%a;");
  check_contains(entities("<!ENTITY % a SYSTEM \"loop.ent\">%a;", ""), {"loop.ent:2:1:", "contains itself"});
  check_contains(entities("<!ENTITY % a SYSTEM \"/etc/hostname\">%a;", ""), "not in the folder");
  folder.write("sections.ent", "<![IGNORE[ ]]>");
  check_contains(entities("<!ENTITY % a SYSTEM \"sections.ent\">%a;", ""),
                 {"sections.ent:1:1:", "conditional section"});
  folder.write("file_within.ent", "<!ENTITY % f SYSTEM \"self.xml\"><!ENTITY b \"%f;\">");
  check_contains(entities("<!ENTITY % a SYSTEM \"file_within.ent\">%a;", ""), "within the text of an entity");
  std::string many = "<!ENTITY % m0 \"<!-- many and many -->\">\n";
  for (int i = 1; i < 12; ++i) {
    many += "<!ENTITY % m" + std::to_string(i) + " \"";
    for (int copy = 0; copy < 10; ++copy) many += "%m" + std::to_string(i - 1) + ";";
    many += "\">\n";
  }
  folder.write("many.ent", many + "%m11;");
  check_contains(entities("<!ENTITY % a SYSTEM \"many.ent\">%a;", ""), {"many.ent:", "over 8 MiB"});
  // A billion laughs: each entity is ten of the one before.
  std::string laughs = "<!ENTITY l0 \"<!-- laughs and laughs -->\">\n";
  for (int i = 1; i < 12; ++i) {
    laughs += "<!ENTITY l" + std::to_string(i) + " \"";
    for (int copy = 0; copy < 10; ++copy) laughs += "&l" + std::to_string(i - 1) + ";";
    laughs += "\">\n";
  }
  check_contains(entities(laughs, "&l11;"), {"main.gdml:29:35:", "over 100 times"});
  std::string deep = "<!ENTITY d0 \"\">\n";
  for (int i = 1; i < 100; ++i)
    deep += "<!ENTITY d" + std::to_string(i) + " \"&d" + std::to_string(i - 1) + ";\">\n";
  check_contains(entities(deep, "&d99;"), "nested more than 50 deep");
  check_contains(entities(deep, "<box name=\"x\" x=\"&d99;\" y=\"1\" z=\"1\"/>"), "nested more than 50 deep");
}
