#pragma once
/// The surface models that a definition may name.

#include <functional>
#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/materials/microsurface_spec.hpp"
#include "scintray/materials/model_list.hpp"

namespace scintray::materials {

/// One surface model.
struct SurfaceModel {
  std::string word;   ///< model = "word"
  std::string table;  ///< the key of a surface that belongs to it alone, its own table; empty: none
  /// Reads what belongs to the model from a surface's definition. What is wrong is added to the collector of
  /// the table; the result is then not used. Gap, reflector and direction are read for it.
  std::function<MicrosurfaceSpec(const config::TomlTable& surface)> read;
};

/// Surface models; those that are built in are there from the start.
class SurfaceModels : public ModelList<SurfaceModel> {
 public:
  SurfaceModels();
};

}  // namespace scintray::materials
