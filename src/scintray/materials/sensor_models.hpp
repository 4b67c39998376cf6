#pragma once
/// The sensor models that a definition may name.

#include <functional>
#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/avalanche_model.hpp"
#include "scintray/materials/model_list.hpp"
#include "scintray/materials/source_rule.hpp"

namespace scintray::materials {

/// One sensor model: how the carriers in a sensor trigger avalanches.
struct SensorModel {
  std::string word;   ///< model = "word"
  std::string table;  ///< key of the model's own table in a sensor's definition; empty: none
  /// Reads the model's keys from a sensor's definition, and appends their sources. Errors are added to the
  /// collector of the table; the result is then not used. Efficiency, window, angle, spreads and dark counts
  /// are read by the caller.
  std::function<core::Shared<detector::AvalancheModel>(const config::TomlTable& sensor, SourceRule rule,
                                                       std::vector<std::string>& sources)>
      read;
};

/// Registry of sensor models, which initially contains the built-in ones.
class SensorModels : public ModelList<SensorModel> {
 public:
  SensorModels();

  /// The word of the model that a definition selects by `model`, or by a model's own table; empty without
  /// either.
  std::string stated_by(const config::TomlNode& sensor) const;
  /// False for a key of a definition that belongs to a model other than that of the word: the other model's
  /// word or own table. True when the word is empty.
  bool belongs_to(const config::TomlNode& item, const std::string& word) const;
};

}  // namespace scintray::materials
