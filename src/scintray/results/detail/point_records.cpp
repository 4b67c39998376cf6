#include "scintray/results/detail/point_records.hpp"

#include <stdexcept>
#include <string>

#include "scintray/results/detail/columns.hpp"

namespace scintray::results::format {

namespace {

void require_record(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace

tally::LightTiming get_light_timing(const core::h5::Group& point) {
  const core::h5::Group group = point.open_group("light_timing");
  const auto decay = group.read<double>("decay_ns"), rise = group.read<double>("rise_ns"),
             share = group.read<double>("decay_share"), spread = group.read<double>("time_spread_ns");
  require_record(!decay.empty() && rise.size() == decay.size() && share.size() == decay.size(),
                 "the columns of light_timing differ in length");
  require_record(spread.size() == 1, "time_spread_ns is not one number");
  tally::LightTiming timing;
  for (std::size_t i = 0; i < decay.size(); ++i) timing.decay.push_back({decay[i], rise[i], share[i]});
  timing.time_spread_ns = spread.front();
  return timing;
}

std::vector<tally::OmittedEffect> get_omitted_effects(const core::h5::Group& point) {
  const core::h5::Group group = point.open_group("omitted_effects");
  std::vector<tally::OmittedEffect> effects(group.read_strings("effect").size());
  const auto fill = [&](const char* name, auto member, const auto& values) {
    require_record(values.size() == effects.size(),
                   std::string("omitted_effects differs in length in ") + name);
    for (std::size_t i = 0; i < effects.size(); ++i) effects[i].*member = values[i];
  };
  for_each_omission_text(
      [&](const char* name, auto member) { fill(name, member, group.read_strings(name)); });
  for_each_omission_figure(
      [&](const char* name, auto member) { fill(name, member, group.read<std::uint8_t>(name)); });
  return effects;
}

tally::UntilResult get_until(const core::h5::Group& point) {
  const core::h5::Group group = point.open_group("until");
  tally::UntilResult until;
  if (group.has_attribute("", "error_of")) {
    until.of = group.string_attribute("", "error_of");
    until.unit = group.string_attribute("", "absolute_error_unit");
  } else {
    const std::string fate = group.string_attribute("", "share_of");
    int index = 0;
    while (index < core::kFateCount && fate != core::fate_name(core::fate_at(index))) ++index;
    require_record(index < core::kFateCount, "until is of a fate that does not exist");
    until.fate = core::fate_at(index);
  }
  const auto names = group.read_strings("condition");
  const auto goal = group.read<double>("goal"), reached = group.read<double>("reached");
  const auto met = group.read<std::uint8_t>("met");
  require_record(goal.size() == names.size() && reached.size() == names.size() && met.size() == names.size(),
                 "the columns of until differ in length");
  for (std::size_t i = 0; i < names.size(); ++i)
    until.conditions.push_back({names[i], goal[i], reached[i], met[i] != 0});
  return until;
}

tally::EventFates get_event_fates(const core::h5::Group& point) {
  tally::EventFates fates;
  const auto events = point.read<std::uint64_t>("events_with_photons");
  const auto products = point.read<std::uint64_t>("event_fate_products");
  const std::size_t count = fates.products.size();
  require_record(events.size() == 1 && products.size() == count * count,
                 "event_fate_products is not a square of fates");
  fates.events = events.front();
  for (std::size_t i = 0; i < products.size(); ++i) fates.products[i / count][i % count] = products[i];
  return fates;
}

std::vector<tally::EventShare> get_event_shares(const core::h5::Group& point, const std::string& name,
                                                std::size_t size) {
  std::vector<tally::EventShare> shares;
  if (!point.has(name + "_event_squares")) return shares;
  const auto squares = point.read<std::uint64_t>(name + "_event_squares"),
             products = point.read<std::uint64_t>(name + "_event_products");
  require_record(squares.size() == size && products.size() == size,
                 "the sums over events of " + name + " do not match it");
  for (std::size_t i = 0; i < size; ++i) shares.push_back({squares[i], products[i]});
  return shares;
}

}  // namespace scintray::results::format
