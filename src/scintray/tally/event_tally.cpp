#include "scintray/tally/event_tally.hpp"

#include <algorithm>

namespace scintray::tally {

void EventTally::begin(std::uint64_t event, std::uint32_t point, const source::EventLight& light) {
  EventRecord record;
  record.event = event;
  record.point = point;
  record.emitted = light.photons;
  record.escaped_keV = static_cast<float>(light.event.escaped_keV);
  record.non_scintillating_keV = static_cast<float>(light.event.non_scintillating_keV);
  record.channels.resize(plan_.channels.list.size());
  double energy = 0.0, most = 0.0;
  core::Vec3 moment = core::Vec3::Zero();
  for (const source::Deposit& deposit : light.event.deposits) {
    energy += deposit.energy_keV;
    moment += deposit.energy_keV * deposit.position;
    const core::PartId part = scene_.regions[deposit.region].part;
    if (deposit.energy_keV <= most || !part.has_value()) continue;
    most = deposit.energy_keV;
    record.part = part;
  }
  record.energy_keV = static_cast<float>(energy);
  ++balance_.events;
  has_light_ = energy > 0.0 || (light.event.deposits.empty() && light.photons > 0);
  balance_.silent += has_light_ ? 0 : 1;
  balance_.started += light.event.energy_keV;
  balance_.deposited += energy;
  balance_.escaped += light.event.escaped_keV;
  balance_.non_scintillating += light.event.non_scintillating_keV;
  if (energy > 0.0) {
    const core::Vec3 mean = moment / energy;
    record.position_mm = {static_cast<float>(mean.x()), static_cast<float>(mean.y()),
                          static_cast<float>(mean.z())};
  }
  events_.push_back(std::move(record));
}

void EventTally::detected(std::uint32_t channel, const source::Photon& photon) {
  detected(channel, 1, photon.time_ns);
  if (!wants_arrivals()) return;
  const ReadoutChannel& at = plan_.channels.list[channel];
  const core::Vec3 from = photon.position - at.position;
  arrived(channel, {photon.time_ns, from.dot(at.x), from.dot(at.y)});
}

void EventTally::detected(std::uint32_t channel, std::uint64_t count, double first_ns) {
  EventRecord& record = events_.back();
  record.detected += count;
  ChannelRecord& seen = record.channels[channel];
  const auto time = static_cast<float>(first_ns);
  seen.first_ns = seen.detected == 0 ? time : std::min(seen.first_ns, time);
  seen.detected += static_cast<std::uint32_t>(count);
}

void write_signal(detector::ChannelSignal signal, ChannelRecord& record) {
  constexpr float kNone_ns = std::numeric_limits<float>::quiet_NaN();
  const auto time = [](const std::optional<double>& ns) { return ns ? static_cast<float>(*ns) : kNone_ns; };
  record.charge = static_cast<float>(signal.charge);
  record.amplitude = static_cast<float>(signal.amplitude);
  record.first_ns = time(signal.first_photon_ns);
  record.time_ns = time(signal.time_ns);
  for (const std::optional<double>& ns : signal.order_times_ns) record.order_ns.push_back(time(ns));
  record.waveform = std::move(signal.waveform);
}

void EventTally::read_out(std::uint32_t channel, core::Rng rng) {
  write_signal(plan_.readout[channel].respond(arrivals_[channel], rng), events_.back().channels[channel]);
  arrivals_[channel].clear();
}

void EventTally::end(const std::function<core::Rng(std::uint32_t)>& stream) {
  for (std::uint32_t channel = 0; channel < arrivals_.size(); ++channel) read_out(channel, stream(channel));
  if (has_light_) balance_.detected.add(static_cast<double>(events_.back().detected));
}

}  // namespace scintray::tally
