#pragma once
/// Specification of a scene by its file: names and numbers, before any look-up or construction. Lengths mm,
/// wavelengths nm, times ns, angles rad.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/detector/readout_spec.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/scene_file/contact.hpp"
#include "scintray/scene_file/criterion.hpp"
#include "scintray/scene_file/fit.hpp"
#include "scintray/scene_file/gamma_source.hpp"
#include "scintray/scene_file/goniometer.hpp"
#include "scintray/scene_file/part.hpp"
#include "scintray/scene_file/run.hpp"
#include "scintray/scene_file/source.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::scene_file {

struct SceneSpec {
  std::string title;
  config::NameRef ambient;  ///< medium around all parts
  ContactKind contacts_default = ContactKind::bonded;
  bool contacts_default_given = false;
  std::vector<PartSpec> parts;
  std::vector<GroupSpec> groups;
  std::vector<ContactSpec> contacts;
  std::vector<GapSpec> gaps;
  SourceSpec source;                       ///< [source] of photons
  std::optional<GammaSpec> energy_source;  ///< event source; then there is no `source`
  RunSpec run;
  std::optional<detector::ReadoutSpec> readout;  ///< electronics of every sensor; nothing: none
  AnalysisSpec analysis;
  std::vector<CriterionSpec> criteria;
  std::vector<GoniometerSpec> goniometers;
  std::optional<FitSpec> fit;  ///< [fit]
  std::vector<TallySpec> tallies;
  InlineTables media;            ///< [media.NAME], as materials/media/NAME.toml
  InlineTables surfaces;         ///< [surfaces.NAME]
  InlineTables sensors;          ///< [sensors.NAME]
  InlineTables reflectors;       ///< [reflectors.NAME]
  std::filesystem::path file;    ///< the scene file as it was named
  std::filesystem::path folder;  ///< base of relative paths in the scene
  std::string text;              ///< the whole file
};

}  // namespace scintray::scene_file
