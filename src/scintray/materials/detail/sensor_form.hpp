#pragma once
/// The tables of a sensor's file beside its efficiency and window (docs/readout.md).

#include "scintray/materials/material_forms.hpp"

namespace scintray::materials {

/// Reads [angle], [transit_time], [single_electron], [microcells] and [dark_counts], each of which may be
/// absent, and adds what is wrong to the collector of the table.
/// @param sensor  its efficiency and window have been read
void read_sensor_response(const config::TomlTable& table, SourceRule rule, detector::Sensor& sensor);

}  // namespace scintray::materials
