#pragma once
/// Which channel of a file is the height map. Internal to the readers.

#include <string>
#include <vector>

#include "scintray/topography/detail/readers/raw_map.hpp"

namespace scintray::topography {

/// What a file states of one of its channels.
struct ChannelInfo {
  std::string name;
  std::string unit;       ///< as the file writes it; empty when it writes none
  bool length = false;    ///< the unit is one of length
  std::string direction;  ///< "Trace", "Retrace" where the file states it beside the name
};

/// A channel and what it is called in messages and steps.
struct ChosenChannel {
  std::size_t index = 0;
  std::string name;                ///< made distinct where the file gives one name twice
  std::vector<std::string> names;  ///< of all channels, likewise
};

/// The channel requested by name: exactly, upper and lower case alike; else the only one whose
/// name begins so. InputError lists those there when none or several fit.
///
/// When none is requested: the only channel of the file; else, among those in a unit of length or
/// without unit, the one named as the height that a sensor measured ("Height Sensor", "ZSensor",
/// "height (measured)"), else as a height ("Height", "Topography", "Topo", "Z"), else the only one
/// in a unit of length. A scan forward goes before the same scan backward. InputError lists the
/// channels when this leaves several or none.
ChosenChannel choose_channel(std::vector<ChannelInfo> channels, const ReadRequest& request);

/// Writes the choice and the unit that goes with it into a map.
void take_channel(RawMap& map, const ChosenChannel& chosen, const ChannelInfo& info);

/// For formats with one channel: `name` is what the file calls it, or empty. InputError when
/// another is requested.
void require_channel(const std::string& name, const ReadRequest& request);

}  // namespace scintray::topography
