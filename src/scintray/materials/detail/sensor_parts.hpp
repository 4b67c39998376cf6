#pragma once
/// Readers of the parts of a sensor's definition that have a file of their own.

#include <optional>
#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/materials/source_rule.hpp"

namespace scintray::materials {

/// Reads [photocathode] into a sensor of which window and efficiency have been read, and turns the efficiency
/// into the probability of escape. Adds errors to the collector of the tables.
void read_photocathode(const config::TomlTable& sensor_table, const config::TomlTable& efficiency,
                       SourceRule rule, detector::Sensor& sensor);

/// Reads [uniformity] into a sensor of which everything on its efficiency has been read.
void read_face_response(const config::TomlTable& uniformity, detector::Sensor& sensor);

}  // namespace scintray::materials
