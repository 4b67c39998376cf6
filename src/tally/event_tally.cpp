#include "scintray/tally/event_tally.hpp"

#include <algorithm>

namespace scintray {

void EventTally::begin(std::uint64_t event, std::uint32_t point, const EventLight& light) {
  EventRecord record;
  record.event = event;
  record.point = point;
  record.emitted = light.photons;
  record.escaped_keV = static_cast<float>(light.event.escaped_keV);
  record.unseen_keV = static_cast<float>(light.event.unseen_keV);
  record.channels.resize(plan_.channels.list.size());
  double energy = 0.0, most = 0.0;
  Vec3 moment = Vec3::Zero();
  for (const Deposit& deposit : light.event.deposits) {
    energy += deposit.energy_keV;
    moment += deposit.energy_keV * deposit.position;
    const std::int32_t part = scene_.regions[deposit.region].part;
    if (deposit.energy_keV <= most || part == kNone) continue;
    most = deposit.energy_keV;
    record.part = static_cast<std::uint32_t>(part);
  }
  record.energy_keV = static_cast<float>(energy);
  ++balance_.events;
  balance_.silent += energy > 0.0 ? 0 : 1;
  balance_.started += light.event.energy_keV;
  balance_.deposited += energy;
  balance_.escaped += light.event.escaped_keV;
  balance_.unseen += light.event.unseen_keV;
  if (energy > 0.0) {
    const Vec3 mean = moment / energy;
    record.position_mm = {static_cast<float>(mean.x()), static_cast<float>(mean.y()),
                          static_cast<float>(mean.z())};
  }
  events_.push_back(std::move(record));
}

void EventTally::detected(std::uint32_t channel, const Photon& photon) {
  EventRecord& record = events_.back();
  ++record.detected;
  ChannelRecord& seen = record.channels[channel];
  const auto time = static_cast<float>(photon.time_ns);
  seen.first_ns = seen.detected == 0 ? time : std::min(seen.first_ns, time);
  ++seen.detected;
}

void EventTally::end() {
  const EventRecord& record = events_.back();
  if (record.energy_keV > 0.0f) balance_.detected.add(static_cast<double>(record.detected));
}

void EventTally::add_to(EnergyBalance& total) const {
  total.events += balance_.events;
  total.silent += balance_.silent;
  total.started += balance_.started;
  total.deposited += balance_.deposited;
  total.escaped += balance_.escaped;
  total.unseen += balance_.unseen;
  total.detected.merge(balance_.detected);
}

}  // namespace scintray
