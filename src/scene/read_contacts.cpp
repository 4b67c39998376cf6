#include <set>

#include "scintray/scene/face_path.hpp"
#include "scintray/scene/read_parts.hpp"

namespace scintray {

namespace {

/// "part" or "part:face".
void read_side(const TomlTable& table, const std::string& text, const std::vector<PartSpec>& parts,
               ContactSpec& contact, std::size_t side) {
  if (text.find(':') == std::string::npos) {
    contact.between[side] = {text, table.where("between")};
    expect_part(table, "between", contact.between[side], part_names(parts));
  } else if (const auto path = read_face_path(table, "between", text, parts)) {
    contact.between[side] = path->part;
    contact.faces[side] = path->face.name;
  }
}

}  // namespace

ContactKind contact_kind(const std::string& word) {
  return word == "dry" ? ContactKind::dry : ContactKind::bonded;
}

std::vector<ContactSpec> read_contacts(const TomlTable& scene, const std::vector<PartSpec>& parts) {
  std::vector<ContactSpec> contacts;
  std::set<std::pair<std::string, std::string>> pairs;
  for (const TomlTable& table : scene.tables("contact")) {
    ContactSpec contact;
    contact.where = table.where();
    const std::vector<std::string> names = table.strings("between", 2);
    for (std::size_t i = 0; i < names.size(); ++i) read_side(table, names[i], parts, contact, i);
    contact.kind = contact_kind(table.choice("kind", {"bonded", "dry"}));
    contact.surface = read_name(table, "surface", false);
    table.expect("surface", contact.kind == ContactKind::bonded,
                 "a dry contact has no surface of its own: each part keeps the one of its face",
                 "remove surface, or write kind = \"bonded\"");
    contact.tolerance_mm = table.optional_quantity("tolerance", Dimension::length);
    table.expect("tolerance", contact.tolerance_mm.value_or(1.0) > 0.0, "a tolerance that is not positive",
                 "give a length above 0, as \"20 um\"");
    table.expect("tolerance", contact.faces[0].empty() && contact.faces[1].empty(),
                 "a tolerance belongs to a pair of parts, not to single faces of them",
                 "give it in a [[contact]] between = [\"part\", \"part\"]");
    if (table.good("between")) {
      const auto& [a, b] = std::minmax(names[0], names[1]);
      table.expect("between", contact.between[0].name != contact.between[1].name,
                   "a contact of the part \"" + contact.between[0].name + "\" with itself", "name two parts");
      table.expect("between", pairs.insert({a, b}).second,
                   "the contact between \"" + a + "\" and \"" + b + "\" is described twice",
                   "keep one [[contact]]");
    }
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

}  // namespace scintray
