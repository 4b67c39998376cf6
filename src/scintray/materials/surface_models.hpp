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
  std::string table;  ///< key of the model's own table in a surface's definition; empty: none
  /// Reads the model's keys from a surface's definition. Errors are added to the collector of the table; the
  /// result is then not used. Gap, reflector and direction are read by the caller.
  std::function<MicrosurfaceSpec(const config::TomlTable& surface)> read;
};

/// Registry of surface models, which initially contains the built-in ones.
class SurfaceModels : public ModelList<SurfaceModel> {
 public:
  SurfaceModels();
};

}  // namespace scintray::materials
