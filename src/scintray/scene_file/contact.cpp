#include "scintray/scene_file/contact.hpp"

#include <algorithm>
#include <set>

#include "scintray/core/pattern.hpp"
#include "scintray/scene_file/detail/face_path.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

std::vector<ContactSpec> read_contacts(const config::TomlTable& scene,
                                       const std::vector<std::string>& part_names,
                                       const std::vector<PartSpec>& parts) {
  std::vector<ContactSpec> contacts;
  std::set<std::pair<std::string, std::string>> pairs;
  const std::set<std::string> known(part_names.begin(), part_names.end());
  // "part" or "part:face".
  const auto read_side = [&](const config::TomlTable& table, const std::string& text, ContactSpec& contact,
                             std::size_t side) {
    if (text.find(':') == std::string::npos) {
      contact.between[side] = {text, table.where("between")};
      if (!known.contains(text)) expect_parts(table, "between", contact.between[side], part_names);
    } else if (const auto path = read_face_path(table, "between", text, part_names, parts, true)) {
      contact.between[side] = path->part;
      contact.faces[side] = path->face.name;
    }
  };
  for (const config::TomlTable& table : scene.tables("contact")) {
    ContactSpec contact;
    contact.where = table.where();
    const std::vector<std::string> names = table.strings("between", 2);
    for (std::size_t i = 0; i < names.size(); ++i) read_side(table, names[i], contact, i);
    contact.kind = table.choice("kind", kContactKinds);
    contact.surface = read_name(table, "surface", false);
    contact.leaving = {read_name(table, "leaving_first", false), read_name(table, "leaving_second", false)};
    for (const char* key : {"leaving_first", "leaving_second"})
      table.expect(key, contact.kind == ContactKind::each_side,
                   "a surface for one direction belongs to a contact with a surface for each",
                   "write kind = \"each_side\", or surface = \"...\" for both directions");
    table.expect("surface", contact.kind != ContactKind::each_side,
                 "a contact of kind \"each_side\" has a surface for each direction",
                 "give leaving_first and leaving_second, or write kind = \"bonded\"");
    table.expect("surface", contact.kind != ContactKind::dry,
                 "a dry contact has no surface of its own: each part keeps the one of its face",
                 "remove surface, or write kind = \"bonded\"");
    contact.tolerance_mm = table.optional_quantity("tolerance", core::Dimension::length);
    table.expect("tolerance", contact.tolerance_mm.value_or(1.0) > 0.0, "a tolerance that is not positive",
                 "give a length above 0, as \"20 um\"");
    const bool plain = std::none_of(names.begin(), names.end(), [](const std::string& name) {
      return core::is_pattern(name) || name.find(':') != std::string::npos;
    });
    table.expect("tolerance", plain,
                 "a tolerance belongs to one pair of parts, not to faces or to many parts",
                 "give it in a [[contact]] between = [\"part\", \"part\"]");
    if (table.good("between")) {
      const auto& [a, b] = std::minmax(names[0], names[1]);
      const std::string& first = contact.between[0].name;
      table.expect("between", first != contact.between[1].name || core::is_pattern(first),
                   "a contact of the part \"" + first + "\" with itself", "name two parts");
      table.expect("between", pairs.insert({a, b}).second,
                   "the contact between \"" + a + "\" and \"" + b + "\" is described twice",
                   "keep one [[contact]]");
    }
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

std::vector<GapSpec> read_gaps(const config::TomlTable& scene, const std::vector<std::string>& part_names) {
  std::vector<GapSpec> gaps;
  for (const config::TomlTable& table : scene.tables("gap")) {
    GapSpec gap;
    gap.where = table.where();
    const std::vector<std::string> names = table.strings("between", 2);
    for (std::size_t i = 0; i < names.size(); ++i) {
      gap.between[i] = {names[i], table.where("between")};
      expect_parts(table, "between", gap.between[i], part_names);
    }
    gaps.push_back(std::move(gap));
  }
  return gaps;
}

}  // namespace scintray::scene_file
