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

/// One sensor model: how the carriers in a sensor fire avalanches.
struct SensorModel {
  std::string word;   ///< model = "word"
  std::string table;  ///< the key of a sensor that belongs to it alone, its own table; empty: none
  /// Reads what belongs to the model from a sensor's definition, and appends the sources of what it reads.
  /// What is wrong is added to the collector of the table; the result is then not used. Efficiency, window,
  /// angle, spreads and dark counts are read for it.
  std::function<core::Shared<detector::AvalancheModel>(const config::TomlTable& sensor, SourceRule rule,
                                                       std::vector<std::string>& sources)>
      read;
};

/// Sensor models; those that are built in are there from the start.
class SensorModels : public ModelList<SensorModel> {
 public:
  SensorModels();

  /// The word of the model that a definition states by `model`, or by a model's own table; empty when it
  /// states none.
  std::string stated_by(const config::TomlNode& sensor) const;
  /// False for a key of a definition that belongs to another model than that of the word: that model's word
  /// or own table. True when the word is empty.
  bool belongs_to(const config::TomlNode& item, const std::string& word) const;
};

}  // namespace scintray::materials
