#include "scintray/scene_file/readout.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace scintray::scene_file {

namespace {

constexpr std::int64_t kMostOrder = 10;
constexpr std::int64_t kMostBits = 24;
constexpr std::size_t kMostTimes = 100;

/// Keys for the sampling period.
constexpr core::Word<core::Dimension> kSamplings[] = {{"sampling", core::Dimension::frequency},
                                                      {"period", core::Dimension::time}};
/// Keys for the kind of shaper.
enum class Shaper { order, decay };
constexpr core::Word<Shaper> kShapers[] = {{"order", Shaper::order}, {"decay", Shaper::decay}};

constexpr core::Word<detector::TimePickoff> kTimePickoffs[] = {
    {"leading_edge", detector::TimePickoff::leading_edge},
    {"peak_fraction", detector::TimePickoff::peak_fraction},
    {"cfd", detector::TimePickoff::cfd}};

void read_sampling(const config::TomlTable& table, detector::ReadoutSpec& readout) {
  if (const auto* form = table.one_of(kSamplings, true)) {
    const std::string key = form->word;
    const double value = table.quantity(key, form->value);
    table.expect(key, value > 0.0, "\"" + key + "\" must be above 0",
                 "write sampling = \"1 GHz\", or period = \"1 ns\"");
    if (table.good(key)) readout.period_ns = form->value == core::Dimension::time ? value : 1.0 / value;
  }
  readout.before_ns = table.quantity("before", core::Dimension::time);
  table.expect("before", readout.before_ns >= 0.0, "\"before\" cannot be negative",
               "the waveform begins so long before the event, as \"20 ns\"");
  readout.window_ns = table.quantity("window", core::Dimension::time);
  const double samples = readout.window_ns / readout.period_ns;
  table.expect("window", samples >= 2.0 && samples <= static_cast<double>(detector::kMostSamples),
               "a waveform has 2 to 1000000 samples, but this window has " + std::to_string(samples),
               "change the window or the sampling");
}

void read_gate(const config::TomlTable& table, detector::ReadoutSpec& readout) {
  if (!table.has("gate")) return;
  const std::vector<double> gate = table.quantities("gate", core::Dimension::time, 2);
  if (gate.size() != 2) return;
  table.expect("gate", gate[0] < gate[1], "a gate must open before it closes",
               "give the two times, as [\"0 ns\", \"200 ns\"]");
  if (table.good("before") && table.good("window"))
    table.expect("gate", gate[0] >= -readout.before_ns && gate[1] <= readout.window_ns - readout.before_ns,
                 "this gate is not inside the waveform, which runs from " +
                     std::to_string(-readout.before_ns) + " to " +
                     std::to_string(readout.window_ns - readout.before_ns) + " ns",
                 "times count from the start of the event");
  readout.gate_ns = std::array{gate[0], gate[1]};
}

/// Time constants (ns) of the stages of the shaper.
std::vector<double> read_shaping(const config::TomlTable& table) {
  const core::Word<Shaper>* form = table.one_of(kShapers, true);
  const bool decay = form && form->value == Shaper::decay;
  const auto read_time = [&](const std::string& key) {
    const double time_ns = table.quantity(key, core::Dimension::time);
    table.expect(key, time_ns > 0.0, "\"" + key + "\" must be above 0");
    return time_ns;
  };
  const double rise_ns = table.quantity("rise", core::Dimension::time, 0.0);
  table.expect("rise", rise_ns >= 0.0, "\"rise\" cannot be negative");
  table.expect("rise", decay, "a shaper with an order has no rise", "remove it, or write decay");
  if (form && !decay) {
    const std::int64_t order = table.integer("order");
    table.expect("order", order >= 1 && order <= kMostOrder, "a shaper has 1 to 10 integrators",
                 "CR-RC is order 1, CR-RC^4 is order 4");
    return std::vector<double>(static_cast<std::size_t>(std::clamp<std::int64_t>(order, 1, kMostOrder)) + 1,
                               read_time("time_constant"));
  }
  if (decay) return {read_time("decay"), rise_ns};
  return {};
}

void read_digitizer(const config::TomlTable& table, detector::ReadoutSpec& readout) {
  readout.noise = table.number("noise", 0.0);
  table.expect("noise", readout.noise >= 0.0, "noise is a standard deviation and cannot be negative");
  if (!table.has("adc_bits") && !table.has("adc_range")) return;
  const std::int64_t bits = table.integer("adc_bits");
  table.expect("adc_bits", bits >= 1 && bits <= kMostBits, "a converter has 1 to 24 bits");
  readout.adc_bits = static_cast<int>(std::clamp<std::int64_t>(bits, 1, kMostBits));
  const std::vector<double> range = table.numbers("adc_range", 2);
  if (range.size() != 2) return;
  table.expect("adc_range", range[0] < range[1], "the range of a converter must rise",
               "give the amplitudes of the first and the last code in photoelectrons, as [-20, 4000]");
  readout.adc_range = {range[0], range[1]};
}

void read_pickoff(const config::TomlTable& table, detector::ReadoutSpec& readout) {
  readout.threshold = table.number("threshold");
  table.expect("threshold", readout.threshold > 0.0, "a threshold must be above 0",
               "give an amplitude in photoelectrons: one alone has a peak of 1");
  readout.time_pickoff = table.choice("time_pickoff", kTimePickoffs, detector::TimePickoff::leading_edge);
  const bool uses_fraction = readout.time_pickoff != detector::TimePickoff::leading_edge;
  if (uses_fraction) {
    readout.fraction = table.quantity("fraction", core::Dimension::dimensionless);
    table.expect("fraction", readout.fraction > 0.0 && readout.fraction < 1.0,
                 "a fraction lies between 0 and 1", "give a share of the pulse, as 0.2 or \"20 %\"");
  } else if (table.has("fraction")) {
    table.report("fraction", "a leading edge has no fraction",
                 "remove it, or write time_pickoff = \"peak_fraction\" or \"cfd\"");
  }
  if (readout.time_pickoff == detector::TimePickoff::cfd) {
    readout.delay_ns = table.quantity("delay", core::Dimension::time);
    table.expect("delay", readout.delay_ns > 0.0, "the delay of a CFD must be above 0",
                 "give about the rise time of the pulse");
  } else if (table.has("delay")) {
    table.report("delay", "only a CFD has a delay", "remove it, or write time_pickoff = \"cfd\"");
  }
}

void read_photon_order(const config::TomlTable& table, detector::ReadoutSpec& readout) {
  for (const double n : table.numbers("photon_order", 0, false)) {
    const bool whole = n >= 1.0 && n <= 1e9 && n == static_cast<double>(static_cast<std::uint64_t>(n));
    if (!whole) {
      table.report("photon_order", "photons are counted by whole numbers from 1",
                   "give a list, as [1, 5, 20]");
      return;
    }
    readout.photon_order.push_back(static_cast<std::uint64_t>(n));
  }
  table.expect("photon_order", readout.photon_order.size() <= kMostTimes,
               "more than 100 photon times of each channel");
}

}  // namespace

std::optional<detector::ReadoutSpec> read_readout(const config::TomlTable& scene) {
  const std::optional<config::TomlTable> table = scene.optional_table("readout");
  if (!table) return std::nullopt;
  detector::ReadoutSpec readout;
  readout.where = table->where();
  read_sampling(*table, readout);
  read_gate(*table, readout);
  if (const auto shaping = table->optional_table("shaping")) readout.shaping_ns = read_shaping(*shaping);
  read_digitizer(*table, readout);
  read_pickoff(*table, readout);
  readout.pulses = table->boolean("pulses", false);
  read_photon_order(*table, readout);
  return readout;
}

detector::ReadoutSpec readout_of_text(const std::string& text, const std::string& file) {
  core::Problems problems;
  const config::TomlTable root(config::parse_toml(text, file), problems);
  const std::optional<detector::ReadoutSpec> readout = read_readout(root);
  for (const std::string& key : root.keys())
    if (key != "readout") root.take(key);
  root.finish();
  if (!readout)
    problems.add({file}, "this file has no [readout]",
                 "write one (docs/readout.md), or name a scene with one");
  problems.throw_if_any();
  return *readout;
}

}  // namespace scintray::scene_file
