#include "scintray/scene_file/detail/builder.hpp"

#include <cmath>

namespace scintray::scene_file {

ContactSpec builder_contact(const std::string& a, const std::string& b, ContactKind kind,
                            const core::FileLocation& where, const config::NameRef& surface) {
  ContactSpec contact;
  contact.between = {config::NameRef{a, where}, config::NameRef{b, where}};
  contact.kind = kind;
  if (kind == ContactKind::bonded) contact.surface = surface;
  contact.by_builder = true;
  contact.where = where;
  return contact;
}

std::array<int, 2> read_count(const config::TomlTable& table, const std::string& key) {
  const std::vector<double> numbers = table.numbers(key, 2);
  std::array<int, 2> count{1, 1};
  if (numbers.empty()) return count;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool good = numbers[i] >= 1.0 && numbers[i] <= 10000.0 && numbers[i] == std::floor(numbers[i]);
    table.expect(key, good, "a number of \"" + key + "\" that is not whole, or not in 1 to 10000",
                 "give the numbers along x and y, as " + key + " = [12, 12]");
    if (good) count[i] = static_cast<int>(numbers[i]);
  }
  table.expect(key, static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) <= kMostParts,
               "more than " + std::to_string(kMostParts) + " elements", "give fewer");
  return table.good(key) ? count : std::array<int, 2>{1, 1};
}

std::optional<std::array<double, 2>> read_length_pair(const config::TomlTable& table,
                                                      const std::string& key) {
  if (table.is_array(key)) {
    const std::vector<double> mm = table.quantities(key, core::Dimension::length, 2);
    if (mm.empty()) return std::nullopt;
    return std::array<double, 2>{mm[0], mm[1]};
  }
  const std::optional<double> mm = table.optional_quantity(key, core::Dimension::length);
  if (!mm) return std::nullopt;
  return std::array<double, 2>{*mm, *mm};
}

}  // namespace scintray::scene_file
