#pragma once
/// Choice of the channel of a file that is the height map.

#include <string>
#include <vector>

#include "scintray/topography/detail/readers/raw_map.hpp"

namespace scintray::topography {

/// Information of a file about one of its channels.
struct ChannelInfo {
  std::string name;
  std::string unit;       ///< as in the file; empty when it has none
  bool length = false;    ///< the unit is one of length
  std::string direction;  ///< "Trace", "Retrace" where the file states it beside the name
};

/// A channel and its name in messages and steps.
struct ChosenChannel {
  std::size_t index = 0;
  std::string name;                ///< made distinct where the file has one name twice
  std::vector<std::string> names;  ///< of all channels, likewise
};

/// The channel requested by name: exactly, ignoring case; else the only one whose name begins with it.
/// InputError with the list of channels when none or several match.
///
/// When none is requested: the only channel of the file; else, among those in a unit of length or
/// without unit, the one named as the height that a sensor measured ("Height Sensor", "ZSensor",
/// "height (measured)"), else as a height ("Height", "Topography", "Topo", "Z"), else the only one
/// in a unit of length. A forward scan has precedence over the same scan backward. InputError lists the
/// channels when this leaves several or none.
ChosenChannel choose_channel(std::vector<ChannelInfo> channels, const ReadRequest& request);

/// Stores the chosen channel and its unit in a map.
void take_channel(RawMap& map, const ChosenChannel& chosen, const ChannelInfo& info);

/// The same for formats with one channel: `name` is that in the file, or empty. InputError when
/// another is requested.
void require_channel(const std::string& name, const ReadRequest& request);

}  // namespace scintray::topography
