#include "scintray/materials/sensor_models.hpp"

namespace scintray::materials {

SensorModel proportional_model() {
  const auto read = [](const config::TomlTable&, SourceRule, std::vector<std::string>&) {
    return detector::ProportionalModel();
  };
  return {.word = "proportional", .table = "", .read = read};
}

}  // namespace scintray::materials
