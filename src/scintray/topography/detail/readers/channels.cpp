#include "scintray/topography/detail/readers/channels.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"

namespace scintray::topography {

namespace {

/// Letters only, in lower case.
std::string letters_of(std::string_view name) {
  std::string result;
  for (const char c : lower_case(name))
    if (c >= 'a' && c <= 'z') result += c;
  return result;
}

/// Removes one of `endings`; true when there was one.
template <std::size_t N>
bool strip(std::string& name, const std::array<std::string_view, N>& endings) {
  for (const std::string_view ending : endings)
    if (name.size() > ending.size() && name.ends_with(ending)) {
      name.resize(name.size() - ending.size());
      return true;
    }
  return false;
}

/// Rank of a channel as the height map; less is better.
struct Rank {
  int kind = 2;  ///< 0: height measured by a sensor, 1: height, 2: something else
  bool backward = false;
};

Rank rank_of(const ChannelInfo& channel) {
  constexpr std::array<std::string_view, 3> kBackward{"retrace", "backward", "bwd"};
  constexpr std::array<std::string_view, 3> kForward{"trace", "forward", "fwd"};
  constexpr std::array<std::string_view, 4> kSensor{"heightsensor", "zsensor", "heightmeasured",
                                                    "measuredheight"};
  constexpr std::array<std::string_view, 5> kHeight{"height", "topography", "topo", "z", "zheight"};
  std::string name = letters_of(channel.name);
  Rank rank;
  rank.backward = strip(name, kBackward) || lower_case(channel.direction) == "retrace";
  strip(name, kForward);
  if (std::find(kSensor.begin(), kSensor.end(), name) != kSensor.end()) rank.kind = 0;
  if (std::find(kHeight.begin(), kHeight.end(), name) != kHeight.end()) rank.kind = 1;
  return rank;
}

void make_distinct(std::vector<ChannelInfo>& channels) {
  std::map<std::string, int> uses;
  for (const ChannelInfo& channel : channels) ++uses[lower_case(channel.name)];
  for (ChannelInfo& channel : channels)
    if (uses[lower_case(channel.name)] > 1 && !channel.direction.empty())
      channel.name += " (" + channel.direction + ")";
  std::map<std::string, int> seen;
  for (ChannelInfo& channel : channels)
    if (const int before = seen[lower_case(channel.name)]++; before > 0)
      channel.name += " (" + std::to_string(before + 1) + ")";
}

std::string listed(const std::vector<std::string>& names) {
  return core::list_of(names, ", ", core::in_quotes);
}

/// Those of `which` that are scanned forward, or all of them when none is.
std::vector<std::size_t> forward_first(const std::vector<std::size_t>& which,
                                       const std::vector<ChannelInfo>& channels) {
  std::vector<std::size_t> forward;
  std::copy_if(which.begin(), which.end(), std::back_inserter(forward),
               [&](std::size_t k) { return !rank_of(channels[k]).backward; });
  return forward.empty() ? which : forward;
}

std::size_t by_rule(const std::vector<ChannelInfo>& channels, const std::vector<std::string>& names,
                    const std::string& file) {
  if (channels.size() == 1) return 0;
  for (const int kind : {0, 1, 2}) {
    std::vector<std::size_t> fitting;
    for (std::size_t k = 0; k < channels.size(); ++k)
      if (rank_of(channels[k]).kind == kind && (channels[k].length || (kind < 2 && channels[k].unit.empty())))
        fitting.push_back(k);
    fitting = forward_first(fitting, channels);
    if (fitting.size() == 1) return fitting.front();
    if (fitting.empty()) continue;
    throw core::InputError({{file},
                            "several channels may be the height map; the channels are " + listed(names),
                            "choose one: --channel " + core::in_quotes(names[fitting.front()])});
  }
  throw core::InputError({{file},
                          "no channel is in a unit of length; the channels are " + listed(names),
                          "choose the height map: --channel NAME"});
}

std::size_t by_name(const std::string& wanted, const std::vector<std::string>& names,
                    const std::string& file) {
  std::vector<std::size_t> begins;
  const std::string low = lower_case(trimmed(wanted));
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string name = lower_case(names[k]);
    if (name == low) return k;
    if (!low.empty() && name.starts_with(low)) begins.push_back(k);
  }
  if (begins.size() == 1) return begins.front();
  const std::string near = core::nearest_word(wanted, names);
  throw core::InputError(
      {{file},
       begins.empty() ? "no channel " + core::in_quotes(wanted) + "; the channels are " + listed(names)
                      : core::in_quotes(wanted) + " fits several channels; the channels are " + listed(names),
       near.empty() ? "give one of these names" : "did you mean " + core::in_quotes(near) + "?"});
}

}  // namespace

ChosenChannel choose_channel(std::vector<ChannelInfo> channels, const ReadRequest& request) {
  if (channels.empty())
    throw core::InputError({{request.file}, "the file holds no image channel; expected a height map", ""});
  for (std::size_t k = 0; k < channels.size(); ++k)
    if (trimmed(channels[k].name).empty() && channels.size() > 1)
      channels[k].name = "channel " + std::to_string(k + 1);
  make_distinct(channels);
  ChosenChannel chosen;
  for (const ChannelInfo& channel : channels) chosen.names.push_back(channel.name);
  if (channels.size() == 1 && channels.front().name.empty()) {
    require_channel({}, request);
    return chosen;
  }
  chosen.index = request.channel ? by_name(*request.channel, chosen.names, request.file)
                                 : by_rule(channels, chosen.names, request.file);
  chosen.name = chosen.names[chosen.index];
  return chosen;
}

void take_channel(RawMap& map, const ChosenChannel& chosen, const ChannelInfo& info) {
  map.channel = chosen.name;
  map.channels = chosen.names;
  map.height_unit = info.unit;
}

void require_channel(const std::string& name, const ReadRequest& request) {
  if (!request.channel) return;
  if (name.empty())
    throw core::InputError({{request.file},
                            "channel " + core::in_quotes(*request.channel) +
                                " is requested, but the file holds one height map and no names",
                            "leave the channel out"});
  by_name(*request.channel, {name}, request.file);
}

}  // namespace scintray::topography
