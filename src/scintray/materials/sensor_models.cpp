#include "scintray/materials/sensor_models.hpp"

namespace scintray::materials {

// The models that are built in, a line each: NAME is the function NAME_model that sensor_models/NAME.cpp
// defines.
#define SCINTRAY_SENSOR_MODELS(ADD) \
  ADD(proportional)                 \
  ADD(microcells)

#define SCINTRAY_DECLARE(name) SensorModel name##_model();
SCINTRAY_SENSOR_MODELS(SCINTRAY_DECLARE)
#undef SCINTRAY_DECLARE

namespace {

constexpr const char* kModelKey = "model";

}  // namespace

SensorModels::SensorModels() {
#define SCINTRAY_ADD(name) add(name##_model());
  SCINTRAY_SENSOR_MODELS(SCINTRAY_ADD)
#undef SCINTRAY_ADD
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
