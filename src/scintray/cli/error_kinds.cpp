#include "scintray/cli/error_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/core/error.hpp"

namespace scintray::cli {

namespace {

const std::vector<ErrorKind>& kinds() {
  static const std::vector<ErrorKind> list{
      // Whatever else the message has: a face of a damaged mesh may have a vertex that "does not exist".
      {kDamagedFile,
       "a file is damaged",
       "The file is cut short, has flipped bits, or contradicts itself. Of a mesh or a height map the place "
       "is "
       "the line where that was found.",
       "Download or export it again. To compute a result again, use `scintray run`; --resume continues from "
       "its checkpoints.",
       {"is damaged", "or damaged", "damaged surface table", "damaged or truncated"}},
      // The text of a scene.
      {"toml-syntax",
       "the file is not TOML",
       "The text cannot be read as TOML 1.0. The place is where reading stopped, or the mistake that it "
       "follows from.",
       "Follow the hint; names and quantities stand in quotes, lists in [ ], and each key on a line of its "
       "own.",
       {"without quotes", "is not closed", "in single brackets", "is given twice", "has a colon where",
        "is no comment here", "ends with a semicolon", "without a comma", "in round brackets",
        "has a backslash", "is a calculation", "goes on in the next line", "in its name", "typographic",
        "is not UTF-8"}},
      {"wrong-file",
       "the file is of another kind",
       "The file is no scene: an XML file, a macro of another program, a results file, or a mesh.",
       "Name a scene (TOML). `scintray import` makes one of GDML, STEP and mesh files.",
       {"this is an XML file", "is a command of a Geant4", "a material database of GATE",
        "is not an HDF5 file"}},
      // Keys.
      {"unknown-key",
       "a key that is not known in its table",
       "Every key of a scene is read or refused. The place is that of the key.",
       "Take the nearest key that the hint names, or move the key to the table that it belongs to "
       "(docs/scene_files.md).",
       {"unknown key"}},
      {"missing-key",
       "a key that is needed is absent",
       "The table cannot be understood without it. The place is that of the table.",
       "Add the key there.",
       {"which is needed", "one of them is needed"}},
      {"exclusive-keys",
       "keys that exclude each other are given together",
       "Only one of them can be meant. The place is that of the second.",
       "Keep one of them.",
       {"are both given, but only one of"}},
      {"key-without-meaning",
       "a key has no meaning beside the others",
       "The key is known, but the other keys of its table leave nothing for it to do.",
       "Remove it, or change the key that makes it meaningless.",
       {"has no meaning beside"}},
      // Values.
      {"unit-missing",
       "a quantity without its unit",
       "Every quantity carries its unit, so that none is assumed. The place is that of the value.",
       "Write the number and its unit in quotes, as \"2 mm\", \"420 nm\", \"30 deg\".",
       {"with its unit, as"}},
      {"unit-unknown",
       "a unit that is not one of the quantity's dimension",
       "The unit is misspelt, or belongs to another dimension.",
       "Take one of the units that the hint lists.",
       {"is not a unit of"}},
      {"number-form",
       "a number that cannot be read",
       "A decimal comma, or a sign between number and unit.",
       "Write a decimal point, and a blank between number and unit: \"0.1 mm\".",
       {"has a comma in its number", "between number and unit"}},
      {"unknown-word",
       "a word that is none of those allowed",
       "The key takes one of a few words.",
       "Write one of the words that the message lists, in quotes.",
       {"but one of"}},
      {"wrong-type",
       "a value of another type",
       "A number, text, a list or a table stands where another is expected.",
       "Write what the message expects; text stands in quotes, numbers and true or false without.",
       {"is expected", "are expected"}},
      {"out-of-range",
       "a value out of its range",
       "The value is of the right kind, but cannot be one of this quantity. Shares are at most 1, or 100 %.",
       "Give a value within the limits of the message; \"97 %\" is a share of 0.97.",
       {"lies between", "must be", "cannot be negative", "is not positive", "lies above", "of no length",
        "come to", "sum to", "is not between"}},
      {"file-missing",
       "a file that is not there",
       "Relative paths count from the folder of the file that names them.",
       "Correct the name.",
       {"does not exist", "there is no such file", "is a folder, not a file"}},
      // Names.
      {"unknown-name",
       "a name that nothing has",
       "A medium, surface, sensor, reflector, part or face is named that is not defined in the scene or the "
       "database.",
       "Take the nearest name of the hint, or define it: [media.NAME], [surfaces.NAME] (docs/materials.md).",
       {"there is no", "is called", "has no face", "is not the name of a face"}},
      {"name-taken",
       "two things of one name",
       "Names of parts, and of the faces of a part, are unique. The place is that of the second.",
       "Rename one of them.",
       {"already taken"}},
      {"name-characters",
       "a name with characters that have a meaning",
       "\"part:face\" and \"crystal[*]\" are written with them.",
       "Take letters, digits, - and _.",
       {"contains a dot, a colon"}},
      // Geometry.
      {"touch-order",
       "a part is placed at one that stands later",
       "Parts are placed in the order of the file.",
       "Write the part that is touched first.",
       {"to be touched does not stand before"}},
      {"face-unmatched",
       "a rule matches no face",
       "Normals are outward normals in the part's own coordinates.",
       "`scintray check` prints each face with its normal; correct the selection.",
       {"matches no face"}},
      {"face-ambiguous",
       "two rules match one face",
       "The message has a point on the face.",
       "Narrow one of the two selections.",
       {"both match the triangle"}},
      {"face-bare",
       "a face has no surface",
       "Nothing is ideal by default: each face needs a surface.",
       "Give the part a surface = \"...\" of its own, for the faces that no rule matches.",
       {"has faces without a surface"}},
      {"parts-overlap",
       "two parts overlap",
       "Parts may touch, or lie one wholly inside the other. The message has the volume and a point.",
       "Move one of them, or state which of them has the space, with priority.",
       {" overlap"}},
      {"mesh-defect",
       "a mesh does not bound a volume",
       "Light would leave through what is open or crossed. The message has the number of places and some of "
       "them.",
       "Repair it: scintray repair FILE -o MENDED; `scintray check SCENE --picture scene.svg` marks the "
       "places.",
       {"open edge", "crossing", "non-manifold", "flipped edge", "without area", "inside out"}},
      {"mesh-unit",
       "a mesh file that does not state its unit",
       "STL, OBJ, PLY and OFF files hold bare numbers.",
       "Add unit = \"mm\" to the part, or --unit mm to the command.",
       {"does not state the unit"}},
      // Physics.
      {"wavelength-range",
       "light beyond the data of a medium, surface or sensor",
       "Nothing is extrapolated. The place is that of the part that uses the data.",
       "Extend the table of data, or choose other wavelengths.",
       {"but light of"}},
      {"medium-data",
       "a medium lacks data that the run needs",
       "An emission spectrum, a yield, a density or a composition is not in its definition.",
       "Add the block to [media.NAME] (docs/materials.md), or choose another source.",
       {"has no emission spectrum", "needs its density", "scintillates", "has a base, but only"}},
      {"surface-incomplete",
       "a surface is not fully described",
       "A reflector needs a direction, and a gap or paint; nothing is ideal by default.",
       "Add the keys that the hint names (docs/surfaces.md).",
       {"without \"specular_share\"", "requires parameters that are not given", "has no reflector",
        "without the gap", "a gap is given without"}},
      {"source-outside",
       "the source region lies outside its part",
       "No point of the slab or box lies inside the part that photons or energy deposits are to start in.",
       "Move the region to where the part is (`scintray check` prints its extent), mind the units.",
       {"the source region lies outside", "no point of the source region"}},
      {"no-events",
       "a result without events",
       "The command needs energy deposits, but the run was one of single photons.",
       "Run a scene whose [source] is an event source (docs/gamma_sources.md).",
       {"no events to analyse"}},
      {"file-exists",
       "a file would be replaced",
       "Nothing that the command did not write itself is replaced.",
       "Name another file, or remove this one.",
       {"is not replaced", "would replace", "not written over"}},
      // By the type of the exception.
      {kInputError,
       "the input is wrong",
       "A condition on the input that is of no other kind in this list. Exit code 1.",
       "The hint of the message is what to write.",
       {}},
      {kUsageError,
       "the command line is wrong",
       "An unknown command or option, or a value that an option does not take. Exit code 2.",
       "scintray COMMAND --help lists the options, with examples.",
       {}},
      {kSystemError,
       "the system failed",
       "A disk is full, a file cannot be read or written, memory is used up. Exit code 3. What a run had "
       "finished "
       "is kept.",
       "Mend the cause, then go on: scintray run SCENE --resume.",
       {}},
      {kDefectError,
       "a defect in ScintRay",
       "A condition that must hold does not. Exit code 4.",
       "Report it with the message, the version and the scene.",
       {}},
  };
  return list;
}

}  // namespace

std::span<const ErrorKind> error_kinds() { return kinds(); }

const char* input_error_code(std::string_view what, std::string_view hint) {
  const auto holds = [](std::string_view text, std::string_view fragment) {
    return text.find(fragment) != std::string_view::npos;
  };
  for (const ErrorKind& kind : kinds())
    for (const std::string_view fragment : kind.fragments)
      if (holds(what, fragment) || (kind.code == std::string_view(kDamagedFile) && holds(hint, fragment)))
        return kind.code;
  return kInputError;
}

std::string explanation(const std::string& code) {
  std::string list;
  std::vector<std::string> codes;
  for (const ErrorKind& kind : kinds()) {
    if (code == kind.code)
      return fmt::format("{}: {}\n\n{}\n\nWhat to do: {}\n", kind.code, kind.title, kind.why, kind.remedy);
    codes.emplace_back(kind.code);
    list += fmt::format("{:<20} {}\n", kind.code, kind.title);
  }
  if (code.empty()) return list;
  const std::string near = core::nearest_word(code, codes);
  throw core::InputError({{},
                          "there is no error code " + core::in_quotes(code),
                          (near.empty() ? "" : "did you mean " + near + "? ") +
                              std::string("scintray --explain lists them all")});
}

}  // namespace scintray::cli
