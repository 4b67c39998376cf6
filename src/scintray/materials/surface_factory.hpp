#pragma once
/// From a surface's definition to the surface between two given media: loads and traces height maps,
/// builds tables, and keeps them.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::materials {

/// A surface and what the factory noticed.
struct MadeSurface {
  optics::Surface surface;
  std::vector<std::string> warnings;
};

class SurfaceFactory {
 public:
  struct Hooks {
    /// Called while a table is built: the surface's name and the share done, 0 to 1.
    std::function<void(const std::string& surface, double done)> table_progress;
    /// Called while a table is built; true stops with TableStopped.
    std::function<bool()> stop;
    /// Folder in which built tables are kept between runs; empty: none are.
    std::filesystem::path cache = default_cache();
  };

  SurfaceFactory();
  explicit SurfaceFactory(Hooks hooks) : hooks_(std::move(hooks)) {}

  /// The surface between two media. Tables are for the indices at `reference_nm`, or at the wavelengths that
  /// the surface names; a warning states so when the ratio of indices departs from the table's by more than
  /// kIndexTolerance over [low_nm, high_nm].
  /// @throws InputError for a table file of other indices, an unreadable map, or bad settings.
  MadeSurface make(const SurfaceSpec& spec, const optics::Medium& inside, const optics::Medium& outside,
                   double reference_nm, double low_nm, double high_nm);

  /// Relative change of an index ratio that a table may be used over.
  static constexpr double kIndexTolerance = 0.01;

  /// $SCINTRAY_CACHE, $XDG_CACHE_HOME/scintray or $HOME/.cache/scintray; empty without any of them.
  static std::filesystem::path default_cache();

 private:
  struct Relief {
    std::string key;  ///< everything the height field depends on
    optics::TableProvenance provenance;
    std::shared_ptr<const optics::HeightField> field;
  };
  Relief relief(const HeightMapSpec& spec);
  Relief relief(const RecipeSpec& spec);
  std::shared_ptr<const optics::SurfaceTable> table(const std::string& surface, const Relief& relief,
                                                    const topography::TableSettings& settings,
                                                    const std::vector<topography::SpectralPoint>& spectrum);

  Hooks hooks_;
  std::map<std::string, std::shared_ptr<const optics::HeightField>> fields_;
  std::map<std::string, std::shared_ptr<const optics::SurfaceTable>> tables_;
};

}  // namespace scintray::materials
