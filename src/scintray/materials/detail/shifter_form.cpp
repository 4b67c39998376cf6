#include <fmt/format.h>

#include "scintray/core/share_hint.hpp"
#include "scintray/materials/detail/forms.hpp"

namespace scintray::materials {

namespace {

/// Largest mean number of photons re-emitted per photon absorbed.
constexpr double kGreatestYield = 100.0;

constexpr core::Word<optics::ShiftStatistics> kStatistics[] = {{"single", optics::ShiftStatistics::single},
                                                               {"poisson", optics::ShiftStatistics::poisson}};
constexpr core::Word<optics::ShiftRule> kRules[] = {{"no_gain", optics::ShiftRule::no_gain},
                                                    {"kasha", optics::ShiftRule::kasha}};

void read_quantum_yield(const config::TomlTable& block, optics::Fluorophore& fluorophore) {
  fluorophore.quantum_yield = block.curve("value", core::Dimension::dimensionless);
  fluorophore.statistics = block.choice("statistics", kStatistics, optics::ShiftStatistics::single);
  const double low = fluorophore.quantum_yield.min_y(), high = fluorophore.quantum_yield.max_y();
  if (fluorophore.statistics == optics::ShiftStatistics::poisson) {
    block.expect(
        "value", low >= 0.0 && high <= kGreatestYield,
        fmt::format("a mean number of photons lies between 0 and {:g}, but this one runs from {:g} to "
                    "{:g}",
                    kGreatestYield, low, high));
  } else if (low >= 0.0 && high > 1.0) {
    block.expect("value", false,
                 fmt::format("a quantum yield lies between 0 and 1, but this one is {:g}", high),
                 core::share_hint(high) +
                     "; where several photons may be re-emitted for one, write statistics = \"poisson\"");
  } else {
    expect_share(block, "value", fluorophore.quantum_yield, "a quantum yield");
  }
}

optics::Fluorophore read_fluorophore(const config::TomlTable& table, SourceRule rule,
                                     std::vector<std::string>& sources) {
  optics::Fluorophore fluorophore;
  const auto block = [&](const char* key) {
    const config::TomlTable found = table.table(key);
    if (table.has(key)) read_source(found, rule, sources);
    return found;
  };
  const config::TomlTable absorption = block("absorption");
  if (table.has("absorption")) fluorophore.absorption_per_mm = read_extinction(absorption);
  absorption.expect("none", false, "a wavelength shifter that absorbs nothing shifts nothing",
                    "give a length or a coefficient, or leave [wavelength_shifting] out");
  const config::TomlTable yield = block("quantum_yield");
  if (table.has("quantum_yield")) read_quantum_yield(yield, fluorophore);
  const config::TomlTable emission = block("emission");
  if (table.has("emission")) {
    fluorophore.emission = read_emission(emission);
    fluorophore.rule = emission.choice("rule", kRules, optics::ShiftRule::no_gain);
  }
  fluorophore.decay = read_decay(table, rule, sources);
  if (!table.has("decay"))
    table.report("decay", "a wavelength shifter does not say when it gives light back",
                 "add [[" + table.path() + ".decay]] with time, rise and fraction");
  return fluorophore;
}

}  // namespace

std::shared_ptr<const optics::WavelengthShifter> read_shifter(const config::TomlTable& medium,
                                                              SourceRule rule,
                                                              std::vector<std::string>& sources) {
  if (!medium.has("wavelength_shifting")) return nullptr;
  const std::size_t problems = medium.problem_count();
  const std::vector<config::TomlTable> tables =
      medium.is_array("wavelength_shifting")
          ? medium.tables("wavelength_shifting")
          : std::vector<config::TomlTable>{medium.table("wavelength_shifting")};
  std::vector<optics::Fluorophore> fluorophores;
  for (const config::TomlTable& table : tables)
    fluorophores.push_back(read_fluorophore(table, rule, sources));
  if (fluorophores.empty() || medium.problem_count() > problems) return nullptr;
  return std::make_shared<const optics::WavelengthShifter>(std::move(fluorophores));
}

}  // namespace scintray::materials
