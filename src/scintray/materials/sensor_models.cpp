#include "scintray/materials/sensor_models.hpp"

namespace scintray::materials {

// Each is defined in sensor_models/NAME.cpp.
SensorModel proportional_model();
SensorModel microcells_model();

namespace {

constexpr const char* kModelKey = "model";

}  // namespace

SensorModels::SensorModels() {
  for (const auto model : {proportional_model, microcells_model}) add(model());
}

std::string SensorModels::stated_by(const config::TomlNode& sensor) const {
  if (const config::TomlNode* word = sensor.find(kModelKey)) return word->text;
  for (const SensorModel& model : all())
    if (!model.table.empty() && sensor.find(model.table)) return model.word;
  return {};
}

bool SensorModels::belongs_to(const config::TomlNode& item, const std::string& word) const {
  if (word.empty()) return true;
  if (item.key == kModelKey) return item.text == word;
  return std::none_of(all().begin(), all().end(), [&](const SensorModel& model) {
    return model.word != word && !model.table.empty() && model.table == item.key;
  });
}

}  // namespace scintray::materials
