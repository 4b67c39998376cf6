#include "scintray/scene_file/part.hpp"

#include <cstdlib>

#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

void read_body(const config::TomlTable& table, PartSpec& part) {
  part.shape = read_shape(table);
  part.sensor = read_name(table, "sensor", false);
  part.medium = read_name(table, "medium", !table.has("sensor"));
  part.surface = read_name(table, "surface", false);
  part.priority = static_cast<int>(table.integer("priority", 0));
  table.expect("priority", std::abs(table.integer("priority", 0)) <= kHighestPriority,
               "a priority beyond " + std::to_string(kHighestPriority), "give a smaller number");
  part.faces = read_faces(table);
}

PartSpec read_part(const config::TomlTable& table, const std::vector<std::string>& earlier) {
  PartSpec part;
  part.where = table.where();
  part.name = read_name(table, "name", true);
  expect_plain_name(table, "name", part.name.name);
  part.placement = read_placement(table, earlier);
  read_body(table, part);
  return part;
}

}  // namespace scintray::scene_file
