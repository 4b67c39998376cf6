#include "scintray/source/detail/event_sources.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scintray/config/columns.hpp"

namespace scintray::source {

namespace {

constexpr std::size_t kMostProblems = 10;
constexpr double kGreatestEvent = 9007199254740992.0;  // 2^53: whole numbers are exact up to here

constexpr std::size_t kTime = 5, kBasic = 6;

/// The columns in the order event, x, y, z, energy, time, and those of steps; empty where not given.
struct Columns {
  std::array<std::vector<double>, kBasic + std::size(scene_file::kStepColumns)> values;
  std::vector<std::uint64_t> rows;

  const std::vector<double>& step(scene_file::StepColumn column) const {
    return values[kBasic + static_cast<std::size_t>(column)];
  }
};

/// Names of the columns in a file, in the order of Columns; empty where it has none.
std::vector<std::string> names_of(const scene_file::HitsSpec& spec) {
  std::vector<std::string> names{spec.event, spec.x,      spec.y,
                                 spec.z,     spec.energy, spec.time_ns ? spec.time : ""};
  names.insert(names.end(), spec.steps.begin(), spec.steps.end());
  return names;
}

Columns columns_of_file(const scene_file::HitsSpec& spec) {
  config::Columns read = config::read_columns({spec.file, spec.group, spec.where}, names_of(spec));
  Columns columns;
  std::move(read.values.begin(), read.values.end(), columns.values.begin());
  columns.rows = std::move(read.rows);
  return columns;
}

Columns columns_in_memory(const scene_file::HitsSpec& spec) {
  if (!spec.columns)
    throw core::InputError({spec.where, "the hits of this scene come from a program, which did not set them",
                            "run the scene from Python with run(deposits=...), or name a file of hits"});
  const scene_file::HitColumns& given = *spec.columns;
  Columns columns;
  columns.values = {given.event, given.x_mm, given.y_mm, given.z_mm, given.energy_keV, given.time_ns};
  std::copy(given.steps.begin(), given.steps.end(), columns.values.begin() + kBasic);
  for (std::size_t i = 0; i < columns.values.size(); ++i)
    if (const auto& column = columns.values[i];
        column.size() != given.event.size() && !(i >= kTime && column.empty()))
      throw core::InputError({spec.where,
                              fmt::format("the columns of hits differ in length: {} and {}",
                                          given.event.size(), columns.values[i].size()),
                              "set one number per hit in each"});
  for (std::uint64_t row = 0; row < given.event.size(); ++row) columns.rows.push_back(row);
  return columns;
}

/// Columns in mm, keV and ns, with the factors of those of a file.
struct Units {
  double mm = 1.0, keV = 1.0, ns = 1.0;
};

/// A kind of particle with its charge.
struct KnownParticle {
  optics::Particle light = optics::Particle::electron;
  double charge = 0.0;
};

/// The particle of a code of the Particle Data Group (Review of Particle Physics, "Monte Carlo particle
/// numbering scheme"); nothing for one that is not known. Light as Geant4's G4Scintillation by particle type:
/// neutrons as ions, all others as electrons.
std::optional<KnownParticle> particle_of(double code) {
  constexpr double kNucleus = 1e9;
  const double sign = code < 0.0 ? -1.0 : 1.0;
  const auto magnitude = static_cast<std::int64_t>(std::abs(code));
  if (code >= kNucleus) {  // 10LZZZAAAI
    const std::int64_t z = magnitude / 10'000 % 1000, a = magnitude / 10 % 1000;
    const optics::Particle kind = z == 1 && a == 1   ? optics::Particle::proton
                                  : z == 1 && a == 2 ? optics::Particle::deuteron
                                  : z == 1 && a == 3 ? optics::Particle::triton
                                  : z == 2 && a == 4 ? optics::Particle::alpha
                                                     : optics::Particle::ion;
    return KnownParticle{kind, static_cast<double>(z)};
  }
  switch (magnitude) {
    case 11:
    case 13:
    case 15:
      return KnownParticle{optics::Particle::electron, -sign};
    case 211:
    case 321:
      return KnownParticle{optics::Particle::electron, sign};
    case 2212:
      return KnownParticle{optics::Particle::proton, sign};
    case 2112:
      return KnownParticle{optics::Particle::ion, 0.0};
    case 12:
    case 14:
    case 16:
    case 22:
    case 111:
    case 130:
    case 310:
      return KnownParticle{};
    default:
      return std::nullopt;
  }
}

/// Number of a row in a column of steps; nothing without the column.
std::optional<double> step_value(const Columns& columns, scene_file::StepColumn column, std::size_t i) {
  const std::vector<double>& values = columns.step(column);
  return values.empty() ? std::nullopt : std::optional(values[i]);
}

/// Fault of the step of a row; empty for a valid one.
std::string fault_of_step(const Columns& columns, std::size_t i) {
  using scene_file::StepColumn;
  const auto value = [&](StepColumn column) { return step_value(columns, column, i); };
  for (const StepColumn column : {StepColumn::beta, StepColumn::beta_end})
    if (const auto beta = value(column); beta && !(*beta >= 0.0 && *beta <= 1.0))
      return fmt::format("the velocity {} is not from 0 to 1 (of that of light)", *beta);
  for (const StepColumn column : {StepColumn::kinetic, StepColumn::decay, StepColumn::rise})
    if (const auto number = value(column); number && *number < 0.0)
      return fmt::format("the energy or time {} is below 0", *number);
  for (const StepColumn column : {StepColumn::scintillation_photons, StepColumn::cherenkov_photons})
    if (const auto number = value(column);
        number && !(*number >= 0.0 && *number < kGreatestEvent && *number == std::floor(*number)))
      return fmt::format("{} photons are not a whole number from 0 on", *number);
  if (const auto code = value(StepColumn::particle); code && !particle_of(*code))
    return fmt::format("no particle with the code {:.0f} of the Particle Data Group is known", *code);
  return {};
}

/// The step of a row; nothing where no column of steps is given.
std::optional<ParticleStep> step_of(const Columns& columns, std::size_t i, double mm, double keV, double ns) {
  using scene_file::StepColumn;
  const auto value = [&](StepColumn column) { return step_value(columns, column, i); };
  const auto or_zero = [&](StepColumn column) { return value(column).value_or(0.0); };
  const auto count = [&](StepColumn column) -> std::optional<std::uint64_t> {
    const auto number = value(column);
    return number ? std::optional(static_cast<std::uint64_t>(*number)) : std::nullopt;
  };
  if (std::all_of(columns.values.begin() + kBasic, columns.values.end(),
                  [](const std::vector<double>& column) { return column.empty(); }))
    return std::nullopt;
  ParticleStep step;
  step.displacement =
      mm * core::Vec3(or_zero(StepColumn::dx), or_zero(StepColumn::dy), or_zero(StepColumn::dz));
  step.beta = or_zero(StepColumn::beta);
  step.beta_end = value(StepColumn::beta_end).value_or(step.beta);
  const KnownParticle particle =
      particle_of(value(StepColumn::particle).value_or(0.0)).value_or(KnownParticle{});
  step.particle = particle.light;
  step.charge = value(StepColumn::charge).value_or(particle.charge);
  if (const auto kinetic = value(StepColumn::kinetic)) step.kinetic_keV = keV * *kinetic;
  step.scintillation = count(StepColumn::scintillation_photons);
  step.cherenkov = count(StepColumn::cherenkov_photons);
  step.decay_ns = ns * or_zero(StepColumn::decay);
  step.rise_ns = ns * or_zero(StepColumn::rise);
  return step;
}

/// Throws InputError unless the columns of steps belong together.
void check_step_columns(const Columns& columns, const core::FileLocation& where) {
  using scene_file::StepColumn;
  const auto given = [&](StepColumn column) { return !columns.step(column).empty(); };
  core::Problems problems;
  if (given(StepColumn::dx) != given(StepColumn::dy) || given(StepColumn::dx) != given(StepColumn::dz))
    problems.add(where, "a step has one or two of its three displacements", "give dx, dy and dz, or none");
  if (given(StepColumn::beta) && !given(StepColumn::charge) && !given(StepColumn::particle))
    problems.add(where, "steps have velocities, but neither a charge nor a particle",
                 "give the column charge, or particle with codes of the Particle Data Group");
  if (given(StepColumn::beta_end) && !given(StepColumn::beta))
    problems.add(where, "steps have a velocity at their end, but none at their start", "give beta as well");
  if (given(StepColumn::beta) && !given(StepColumn::dx))
    problems.add(where, "steps have velocities, but no direction", "give dx, dy and dz");
  if (given(StepColumn::rise) && !given(StepColumn::decay))
    problems.add(where, "steps have a rise time, but no decay time", "give decay as well");
  problems.throw_if_any();
}

/// Fault of a row; empty for a valid one.
std::string fault_of(const Columns& columns, std::size_t i) {
  const double event = columns.values[0][i], energy = columns.values[4][i];
  if (!(event >= 0.0 && event < kGreatestEvent && event == std::floor(event)))
    return fmt::format("the event {} is not a whole number from 0 on", event);
  if (!(energy >= 0.0 && std::isfinite(energy))) return fmt::format("the energy {} is not from 0 on", energy);
  for (const std::vector<double>& column : columns.values)
    if (!column.empty() && !std::isfinite(column[i])) return "a number is not finite";
  return fault_of_step(columns, i);
}

}  // namespace

std::string origin_of_hits(const scene_file::HitsSpec& spec) {
  return spec.arrays ? "the calling program" : spec.file.string();
}

std::vector<Hit> read_hits(const scene_file::HitsSpec& spec) {
  const bool csv = !spec.arrays && config::column_format(spec.file) == config::ColumnFormat::csv;
  const Columns columns = spec.arrays ? columns_in_memory(spec) : columns_of_file(spec);
  const Units units =
      spec.arrays ? Units{} : Units{spec.length_mm, spec.energy_keV, spec.time_ns.value_or(0.0)};
  core::Problems problems;
  std::vector<Hit> hits;
  check_step_columns(columns, spec.where);
  const auto &event = columns.values[0], &x = columns.values[1], &y = columns.values[2],
             &z = columns.values[3], &energy = columns.values[4], &time = columns.values[kTime];
  for (std::size_t i = 0; i < columns.rows.size(); ++i) {
    const std::string fault = fault_of(columns, i);
    if (!fault.empty()) {
      if (problems.list().size() < kMostProblems)
        problems.add({origin_of_hits(spec), csv ? static_cast<long>(columns.rows[i]) : 0, 0},
                     (csv ? "" : fmt::format("row {}: ", columns.rows[i])) + fault,
                     spec.arrays ? "set whole event numbers and finite numbers in mm, keV and ns"
                                 : "check which columns are named in [source.columns]");
      continue;
    }
    hits.push_back({static_cast<std::uint64_t>(event[i]), units.mm * core::Vec3(x[i], y[i], z[i]),
                    units.keV * energy[i], time.empty() ? 0.0 : units.ns * time[i], columns.rows[i],
                    step_of(columns, i, units.mm, units.keV, spec.arrays ? 1.0 : units.ns)});
  }
  problems.throw_if_any();
  if (hits.empty())
    throw core::InputError(
        {spec.where, "there are no hits in " + origin_of_hits(spec), "give one row at least"});
  return hits;
}

}  // namespace scintray::source
