#pragma once
/// Registries of models that definitions name by a word.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::materials {

/// A list of models, each identified by its word. Constant once filled: many threads may then read
/// definitions with it.
/// @tparam Model type with `word`, `table` and `read`
template <typename Model>
class ModelList {
 public:
  /// Adds a model. Throws InternalError when its word is empty, when its word or table is in use, and when it
  /// has no reader.
  void add(Model model) {
    if (model.word.empty()) throw core::InternalError("a model without a word");
    if (!model.read) throw core::InternalError("a model without a reader: " + model.word);
    for (const Model& known : models_)
      if (known.word == model.word || (!known.table.empty() && known.table == model.table))
        throw core::InternalError("two models \"" + model.word + "\", or with the table \"" + model.table +
                                  "\"");
    models_.push_back(std::move(model));
  }

  /// The model of a word, or nullptr.
  const Model* find(const std::string& word) const {
    const auto model =
        std::find_if(models_.begin(), models_.end(), [&](const Model& known) { return known.word == word; });
    return model == models_.end() ? nullptr : &*model;
  }
  /// All models, built-in ones first.
  const std::vector<Model>& all() const { return models_; }
  /// Words of all models.
  std::vector<std::string> words() const {
    std::vector<std::string> list;
    for (const Model& model : models_) list.push_back(model.word);
    return list;
  }

 private:
  std::vector<Model> models_;
};

}  // namespace scintray::materials
