#include <algorithm>
#include <functional>

#include "scintray/core/words.hpp"
#include "scintray/exchange/gate/detail/gate.hpp"

namespace scintray::exchange::gate {

namespace {

/// Commands that are not converted, by the beginning of their path, and what that changes.
struct Effect {
  const char* path;
  const char* effect;  ///< empty: none on results, not listed
};
constexpr Effect kEffects[] = {
    {"/gate/source/", "sources are not converted; light starts as in the example [source]"},
    {"/gate/digitizer", "electronics is not converted; each sensor counts the light that it detects"},
    {"/digitizer/", "electronics is not converted; each sensor counts the light that it detects"},
    {"/gate/physics/",
     "processes are not switched on or off; all that the properties of materials and surfaces describe take "
     "place"},
    {"/gate/output/", "output is not converted; results are in the results file"},
    {"/gate/actor/", "actors are not converted; [[tally]] counts what is asked for"},
    {"/gate/application/", "the run is not converted; photons and seed are those of the scene"},
    {"/gate/systems/", "systems are not converted; channels are the sensors of the scene"},
    {"/gate/random/", "the generator is not converted; the seed is that of the scene"},
    {"/gate/verbose", ""},
    {"/gate/cuts/", "cuts are not converted; deposits follow from [source]"},
    {"/gate/timing/", "the run is not converted; times begin at each event"},
    {"/gate/geometry/", ""},
    {"/gate/stacking/", ""},
    {"/run/", ""},
    {"/vis/", ""},
    {"/tracking/", ""},
    {"/event/", ""},
    {"/process/",
     "processes are not set; shifted light is delayed as setTimeProfile delta has it, light by particle is "
     "used where it is stated, and light that surfaces of sensitive volumes absorb is detected"},
    {"/control/verbose", ""},
    {"/control/saveHistory", ""},
    {"/control/", "this control command is not followed: what it repeats, chooses or computes is missing"},
    {"/random/", "the generator is not converted; the seed is that of the scene"}};

constexpr core::Word<Repeater::Kind> kRepeaters[] = {{"cubicArray", Repeater::Kind::cubic},
                                                     {"linear", Repeater::Kind::linear},
                                                     {"ring", Repeater::Kind::ring},
                                                     {"genericRepeater", Repeater::Kind::generic}};

std::vector<std::string> steps_of(const std::string& path) {
  std::vector<std::string> steps;
  for (std::size_t begin = 1; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    steps.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return steps;
}

[[noreturn]] void reject(const Command& command, const std::string& what, const std::string& hint) {
  throw core::InputError(core::Problem{command.where, what, hint});
}

const std::string& word(const Command& command) {
  if (command.words.empty()) reject(command, command.path + " has no value", "write it after the command");
  return command.words[0];
}

class DetectorReader {
 public:
  Detector read(const std::filesystem::path& macro) {
    detector_.folder = macro.parent_path();
    Volume world;
    world.name = "world";
    world.type = "box";
    world.material = "worldDefaultAir";
    world.where = {macro.string(), 0, 0};
    detector_.volumes.push_back(std::move(world));
    for (const Command& command : read_macro(macro)) {
      try {
        take(command);
      } catch (const core::InputError& error) {
        detector_.problems.add(error);
      }
    }
    for (const auto& [effect, listed] : listed_)
      detector_.notes.push_back(listed.first.where.text() + ": " + listed.first.path +
                                (listed.count > 1
                                     ? " and " + std::to_string(listed.count - 1) + " more such commands"
                                     : std::string()) +
                                ": " + effect);
    return std::move(detector_);
  }

 private:
  struct Listed {
    Command first;
    std::size_t count = 0;
  };

  Volume* find(const std::string& name) {
    const auto found = std::find_if(detector_.volumes.begin(), detector_.volumes.end(),
                                    [&](const Volume& volume) { return volume.name == name; });
    return found == detector_.volumes.end() ? nullptr : &*found;
  }

  void list(const Command& command, const std::string& effect) {
    if (effect.empty()) return;
    Listed& listed = listed_[effect];
    if (listed.count++ == 0) listed.first = command;
  }

  void take(const Command& command) {
    const std::vector<std::string> steps = steps_of(command.path);
    if (command.path == "/gate/geometry/setMaterialDatabase") {
      detector_.material_database = command;
      return;
    }
    if (steps.size() >= 3 && steps[0] == "gate")
      if (Volume* volume = find(steps[1])) return take(*volume, command, {steps.begin() + 2, steps.end()});
    for (const Effect& known : kEffects)
      if (command.path.starts_with(known.path)) return list(command, known.effect);
    if (steps.size() < 3 || steps[0] != "gate")
      return list(command, "a command that is not known here: it has no effect");
    std::vector<std::string> names;
    for (const Volume& volume : detector_.volumes) names.push_back(volume.name);
    throw core::unknown_name(command.where, "volume", steps[1], names);
  }

  void take(Volume& volume, const Command& command, const std::vector<std::string>& steps) {
    const std::string& group = steps[0];
    if (steps.size() == 1) return take_own(volume, command, group);
    if (group == "daughters") return take_daughter(volume, command, steps[1]);
    if (group == "geometry") {
      volume.dimensions[steps[1]] = command;
    } else if (group == "placement") {
      place(volume, command, steps[1]);
    } else if (group == "repeaters") {
      insert_repeater(volume, command, steps[1]);
    } else if (group == "surfaces") {
      take_surface(volume, command, {steps.begin() + 1, steps.end()});
    } else if (group == "vis") {
      return;
    } else if (group == "moves") {
      list(command, "movement is not converted; the volume stays where it is placed");
    } else {
      const auto repeater = std::find_if(volume.repeaters.begin(), volume.repeaters.end(),
                                         [&](const Repeater& known) { return known.name == group; });
      if (repeater != volume.repeaters.end())
        repeater->settings[steps[1]] = command;
      else
        list(command, "a command of a volume that is not known here: it has no effect");
    }
  }

  void take_own(Volume& volume, const Command& command, const std::string& name) {
    if (name == "setMaterial")
      volume.material = word(command);
    else if (name == "attachCrystalSD" || name == "attachCrystalSDnoSystem")
      volume.sensitive = true;
    else if (name != "attachPhantomSD" && name != "describe" && name != "enable")
      list(command, "a command of a volume that is not known here: it has no effect");
  }

  /// Name that the next object of a list gets, or `base` with a number where that is taken.
  std::string next_name(const std::string& list_name, const std::string& base,
                        const std::function<bool(const std::string&)>& taken) {
    std::string name = base;
    if (const auto given = names_.find(list_name); given != names_.end()) {
      name = given->second;
      names_.erase(given);
    }
    const std::string first = name;
    for (int copy = 2; taken(name); ++copy) name = first + std::to_string(copy);
    return name;
  }

  void take_daughter(Volume& mother, const Command& command, const std::string& action) {
    const std::string list_name = mother.name + "/daughters";
    if (action == "name") {
      names_[list_name] = word(command);
    } else if (action == "insert") {
      Volume daughter;
      daughter.type = word(command);
      daughter.where = command.where;
      daughter.mother = mother.name;
      daughter.name = next_name(list_name, daughter.type,
                                [this](const std::string& name) { return find(name) != nullptr; });
      detector_.volumes.push_back(std::move(daughter));
    }
  }

  void place(Volume& volume, const Command& command, const std::string& action) {
    const auto length = [&](std::size_t i) { return quantity(command, i, core::Dimension::length); };
    if (action == "setTranslation") {
      volume.placement.position_mm = core::Vec3(length(0), length(1), length(2));
    } else if (action == "setRotationAxis") {
      volume.rotation_axis = core::Vec3(number(command, 0), number(command, 1), number(command, 2));
      if (!(volume.rotation_axis.norm() > 0.0))
        reject(command, command.path + ": an axis of no length", "give an axis as 0 0 1");
    } else if (action == "setRotationAngle") {
      volume.rotation_rad = quantity(command, 0, core::Dimension::angle);
    } else if (action == "alignToX") {
      volume.rotation_axis = core::Vec3::UnitY();
      volume.rotation_rad = 0.5 * core::kPi;
    } else if (action == "alignToY") {
      volume.rotation_axis = core::Vec3::UnitX();
      volume.rotation_rad = -0.5 * core::kPi;
    } else if (action == "alignToZ") {
      volume.rotation_rad = 0.0;
    } else if (action == "setPhiOfTranslation" || action == "setThetaOfTranslation" ||
               action == "setMagOfTranslation") {
      reject(command, command.path + " is not read", "write the translation as setTranslation X Y Z mm");
    }
  }

  void insert_repeater(Volume& volume, const Command& command, const std::string& action) {
    const std::string list_name = volume.name + "/repeaters";
    if (action == "name") {
      names_[list_name] = word(command);
    } else if (action == "insert") {
      const std::optional<Repeater::Kind> kind = core::find_word(kRepeaters, word(command));
      if (!kind)
        reject(command, "the repeater " + core::in_quotes(command.words[0]) + " is not read",
               "expected cubicArray, linear, ring or genericRepeater; write its copies as a genericRepeater");
      const std::string name = next_name(list_name, command.words[0], [&](const std::string& wanted) {
        return std::any_of(volume.repeaters.begin(), volume.repeaters.end(),
                           [&](const Repeater& known) { return known.name == wanted; });
      });
      volume.repeaters.push_back({*kind, name, {}});
    }
  }

  void take_surface(Volume& volume, const Command& command, const std::vector<std::string>& steps) {
    const std::string list_name = volume.name + "/surfaces";
    const auto named = [&](const std::string& name) {
      return std::find_if(volume.surfaces.begin(), volume.surfaces.end(),
                          [&](const BorderCommand& known) { return known.name == name; });
    };
    if (steps[0] == "name") {
      names_[list_name] = word(command);
    } else if (steps[0] == "insert") {
      const std::string& other = word(command);
      if (!find(other)) {
        std::vector<std::string> names;
        for (const Volume& known : detector_.volumes) names.push_back(known.name);
        throw core::unknown_name(command.where, "volume", other, names);
      }
      const std::string name = next_name(list_name, other, [&](const std::string& wanted) {
        return named(wanted) != volume.surfaces.end();
      });
      volume.surfaces.push_back({name, other, "", command.where});
    } else if (steps.size() == 2 && (steps[1] == "setSurface" || steps[1] == "SetSurface")) {
      const auto surface = named(steps[0]);
      if (surface == volume.surfaces.end())
        reject(command, "volume \"" + volume.name + "\" has no surface " + core::in_quotes(steps[0]),
               "insert it first: /gate/" + volume.name + "/surfaces/name " + steps[0] + ", /gate/" +
                   volume.name + "/surfaces/insert OTHER_VOLUME");
      surface->property = word(command);
      surface->where = command.where;
    }
  }

  Detector detector_;
  std::map<std::string, std::string> names_;  ///< that the next object gets, by its list
  std::map<std::string, Listed> listed_;      ///< by effect
};

}  // namespace

const Volume* Detector::find(const std::string& name) const {
  const auto found =
      std::find_if(volumes.begin(), volumes.end(), [&](const Volume& volume) { return volume.name == name; });
  return found == volumes.end() ? nullptr : &*found;
}

Detector read_detector(const std::filesystem::path& macro) { return DetectorReader().read(macro); }

}  // namespace scintray::exchange::gate
