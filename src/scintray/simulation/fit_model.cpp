#include "scintray/simulation/fit.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>

#include "scintray/analysis/goniometer/goniometer.hpp"
#include "scintray/analysis/goniometer/sample_surface.hpp"
#include "scintray/analysis/ratio.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/core/units.hpp"
#include "scintray/simulation/detail/fit_journal.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::simulation {

namespace {

/// Number of equal shares of the photons, from which the noise of differences is measured, and the fewest
/// photons or rays, or events of many photons, that a share must have.
constexpr std::uint64_t kFitParts = 20, kLeastInPart = 20, kLeastEventsInPart = 2;

/// The scene at given parameters, without a position.
std::vector<scene_file::KeySetting> settings_of(const scene_file::FitSpec& fit,
                                                const std::vector<double>& parameters) {
  std::vector<scene_file::KeySetting> settings;
  for (std::size_t j = 0; j < parameters.size(); ++j)
    settings.push_back(fit.parameters[j].setting(parameters[j]));
  return settings;
}

std::vector<double> starts_of(const scene_file::FitSpec& fit) {
  std::vector<double> starts;
  for (const scene_file::FitParameterSpec& parameter : fit.parameters) starts.push_back(parameter.start);
  return starts;
}

/// The start, and the start with each parameter at each of its bounds.
std::vector<std::vector<double>> corners_of(const scene_file::FitSpec& fit) {
  const std::vector<double> starts = starts_of(fit);
  std::vector<std::vector<double>> corners{starts};
  for (std::size_t j = 0; j < starts.size(); ++j)
    for (const double bound : {fit.parameters[j].low, fit.parameters[j].high}) {
      corners.push_back(starts);
      corners.back()[j] = bound;
    }
  return corners;
}

void refuse_open_sweeps(const scene_file::SceneFile& file, const scene_file::FitSpec& fit) {
  core::Problems problems;
  const std::vector<scene_file::KeyPath> paths = file.sweep_paths();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool no_matter =
        fit.quantity == scene_file::FitQuantity::reflectance && paths[i].key.rfind("source.", 0) == 0;
    if (paths[i].key == fit.at.key || no_matter || file.sweep_values(i) == 1) continue;
    problems.add(paths[i].where,
                 fmt::format("a fit is of one scene, but the sweep over \"{}\" has {} values", paths[i].key,
                             file.sweep_values(i)),
                 "reduce it to one value, or remove the sweep");
  }
  problems.throw_if_any();
}

/// Result of one share of the photons, or of all of them, at a point.
class SceneCurve : public FitModel {
 public:
  SceneCurve(const scene_file::SceneFile& file, const scene_file::FitSpec& fit,
             const analysis::MeasuredCurve& measured, const FitModelSettings& settings)
      : file_(file),
        fit_(fit),
        measured_(measured),
        settings_(settings),
        builder_(settings.run.surface_hooks, settings.run.models, mesh_formats_of(settings.run, &file_)) {
    check();
    journal_ = detail::fit_journal(settings_, file_, fit_, inputs_);
  }

  std::optional<analysis::ModelCurve> trace(const std::vector<double>& parameters,
                                            std::uint64_t draw) override {
    analysis::ModelCurve curve;
    std::unique_ptr<const SimulationPoint> ready;
    for (std::size_t i = 0; i < measured_.points.size(); ++i) {
      if (const auto earlier = detail::journal_point(journal_.get(), parameters, draw, i)) {
        curve.push_back(*earlier);
        continue;
      }
      const auto stream = static_cast<std::uint32_t>(draw * measured_.points.size() + i);
      ready = point_at(parameters, i, ready.get(), stream);
      const std::optional<analysis::ModelPoint> point = trace_point(*ready, i);
      if (!point) return std::nullopt;
      curve.push_back(*point);
      detail::add_to_journal(journal_.get(), parameters, draw, i, *point);
    }
    return curve;
  }

  std::uint64_t count() const override { return count_; }
  std::string thing() const override { return energy() ? "events" : "photons"; }
  std::uint64_t seed() const override { return seed_; }
  std::vector<std::string> notes() const override { return notes_; }
  std::optional<std::vector<tally::OmittedEffect>> omitted() const override { return checked_->omitted(); }

 private:
  bool energy() const { return fit_.quantity == scene_file::FitQuantity::light_per_keV; }

  scene_file::SceneSpec spec_at(const std::vector<double>& parameters, std::size_t point) const {
    std::vector<scene_file::KeySetting> settings = settings_of(fit_, parameters);
    settings.push_back(fit_.position(measured_.points[point].x, measured_.points[point].where));
    scene_file::SceneSpec spec = with_options(file_.spec(0, settings), settings_.run);
    spec.tallies.clear();
    spec.run.photon_list = !energy();
    spec.run.paths = 0;
    return spec;
  }

  /// @param previous  at another position, whose scene is shared where it is the same; null: none yet
  std::unique_ptr<const SimulationPoint> point_at(const std::vector<double>& parameters, std::size_t point,
                                                  const SimulationPoint* previous, std::uint32_t stream = 0) {
    scene_file::SceneSpec spec = spec_at(parameters, point);
    if (previous && builder_.serves(*previous->built(), previous->spec(), spec))
      return std::make_unique<const SimulationPoint>(std::move(spec), previous->built(), stream);
    return std::make_unique<const SimulationPoint>(std::move(spec), builder_, stream);
  }

  void check() {
    const std::vector<double> starts = starts_of(fit_);
    check_quantity(spec_at(starts, 0));
    for (std::size_t i = 0; i < measured_.points.size(); ++i) check_position(starts, i);
    for (const std::vector<double>& corner : corners_of(fit_)) {
      const auto ready = point_at(corner, 0, nullptr);
      count_ = ready->work();
      seed_ = ready->settings().seed;
      for (const std::string& note : ready->warnings())
        if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
    }
  }

  /// Adds the measured position to an error, since light may have no place to start there.
  void check_position(const std::vector<double>& starts, std::size_t point) {
    const analysis::MeasuredCurve::Point& measured = measured_.points[point];
    try {
      checked_ = point_at(starts, point, checked_.get());
    } catch (const core::InputError& error) {
      std::vector<core::Problem> problems = error.problems();
      for (core::Problem& problem : problems)
        problem.what = fmt::format("at the measured position {:g} {} ({}): {}", measured.x, fit_.unit,
                                   measured.where.text(), problem.what);
      throw core::InputError(std::move(problems));
    }
  }

  void check_quantity(const scene_file::SceneSpec& spec) const {
    if (spec.energy_source && std::holds_alternative<scene_file::PhotonListSpec>(spec.energy_source->kind))
      throw core::InputError({fit_.where, "a fit, but [source] is a list of photons",
                              "use an event source with energies, or type = \"photons\" in [source]"});
    if (energy() == spec.energy_source.has_value()) return;
    throw core::InputError(
        {fit_.where,
         fmt::format("a fit of {}, but [source] is one of {}", scene_file::quantity_name(fit_.quantity),
                     energy() ? "photons" : "energy"),
         energy() ? "use quantity = \"detected_fraction\", or an event source (docs/gamma_sources.md)"
                  : "use quantity = \"light_per_keV\", or type = \"photons\" in [source]"});
  }

  std::optional<analysis::ModelPoint> trace_point(const SimulationPoint& ready, std::size_t point) const {
    const scene_file::SceneSpec& spec = ready.spec();
    RunHooks hooks;
    hooks.stop = settings_.stop;
    hooks.progress = [&](std::uint64_t done) {
      if (settings_.progress) settings_.progress(point * count_ + done, measured_.points.size() * count_);
    };
    std::vector<std::uint64_t> detected(kFitParts, 0);
    hooks.detected = [&](const std::vector<tally::DetectedPhoton>& photons) {
      for (const tally::DetectedPhoton& photon : photons)
        ++detected[(photon.event * spec.source.photons_per_event + photon.photon) % kFitParts];
    };
    analysis::RatioOfSums all;
    std::vector<analysis::RatioOfSums> shares(kFitParts);
    hooks.events = [&](const std::vector<tally::EventRecord>& events) {
      for (const tally::EventRecord& event : events) {
        const double light = light_of_event(event, spec.readout.has_value());
        all.add(static_cast<double>(event.energy_keV), light);
        shares[event.event % kFitParts].add(static_cast<double>(event.energy_keV), light);
      }
    };
    const tally::PointResult result = ready.trace(hooks);
    if (!result.complete) return std::nullopt;
    analysis::ModelPoint out;
    out.value = energy() ? all.ratio() : result.fraction(core::Fate::detected);
    if (count_ < kFitParts * (energy() ? kLeastEventsInPart : kLeastInPart)) return out;
    for (std::uint64_t part = 0; part < kFitParts; ++part) {
      const std::uint64_t photons = (count_ - part + kFitParts - 1) / kFitParts;
      out.parts.push_back(energy() ? shares[part].ratio().value
                                   : static_cast<double>(detected[part]) / static_cast<double>(photons));
    }
    return out;
  }

  static double light_of_event(const tally::EventRecord& event, bool readout) {
    double sum = 0.0;
    for (const tally::ChannelRecord& channel : event.channels) sum += tally::light_of(channel, readout);
    return sum;
  }

  const scene_file::SceneFile& file_;
  const scene_file::FitSpec& fit_;
  const analysis::MeasuredCurve& measured_;
  const FitModelSettings& settings_;
  core::InputRecord inputs_;  ///< before what reads files
  std::unique_ptr<core::Journal> journal_;
  scene::SceneBuilder builder_;
  std::unique_ptr<const SimulationPoint> checked_;  ///< at the last position that was checked
  std::uint64_t count_ = 0, seed_ = 0;
  std::vector<std::string> notes_;
};

/// The reflectance of a surface of the scene on the goniometer.
class ReflectanceCurve : public FitModel {
 public:
  ReflectanceCurve(const scene_file::SceneFile& file, const scene_file::FitSpec& fit,
                   const analysis::MeasuredCurve& measured, const FitModelSettings& settings)
      : file_(file),
        fit_(fit),
        measured_(measured),
        settings_(settings),
        factory_(settings.run.surface_hooks),
        shipped_(materials::MaterialDatabase::shipped(settings.run.models)),
        rays_(settings.run.photons.value_or(fit.goniometer->rays)) {
    check();
    journal_ = detail::fit_journal(settings_, file_, fit_, inputs_);
  }

  std::optional<analysis::ModelCurve> trace(const std::vector<double>& parameters,
                                            std::uint64_t draw) override {
    const analysis::SampleSurface sample = sample_at(parameters);
    const int threads = settings_.run.threads ? *settings_.run.threads : int{tbb::task_arena::automatic};
    tbb::task_arena arena(threads);
    analysis::ModelCurve curve;
    for (std::size_t i = 0; i < measured_.points.size(); ++i) {
      if (settings_.stop && settings_.stop->load()) return std::nullopt;
      if (const auto earlier = detail::journal_point(journal_.get(), parameters, draw, i)) {
        curve.push_back(*earlier);
        continue;
      }
      arena.execute([&] { curve.push_back(reflectance(sample, i, draw)); });
      detail::add_to_journal(journal_.get(), parameters, draw, i, curve.back());
      if (settings_.progress) settings_.progress((i + 1) * rays_, measured_.points.size() * rays_);
    }
    return curve;
  }

  std::uint64_t count() const override { return rays_; }
  std::string thing() const override { return "rays"; }
  std::uint64_t seed() const override { return seed_; }
  std::vector<std::string> notes() const override { return notes_; }
  std::optional<std::vector<tally::OmittedEffect>> omitted() const override { return std::nullopt; }

 private:
  double angle_rad(std::size_t point) const {
    return measured_.points[point].x * core::unit_factor(fit_.unit, core::Dimension::angle);
  }

  analysis::SampleSurface sample_at(const std::vector<double>& parameters) {
    materials::MaterialDatabase database = shipped_;
    scene::add_definitions(database, file_.spec(0, settings_of(fit_, parameters)));
    const scene_file::FitGoniometerSpec& place = *fit_.goniometer;
    return analysis::make_sample_surface(
        database, factory_, {place.surface.name, place.inside.name, place.outside.name, place.wavelength_nm});
  }

  void check() {
    if (settings_.run.events)
      throw core::InputError(
          {fit_.where, "--events is given, but a reflectance is measured with rays", "use --photons"});
    core::Problems problems;
    for (std::size_t i = 0; i < measured_.points.size(); ++i)
      if (!(angle_rad(i) >= 0.0 && angle_rad(i) < 0.5 * core::kPi))
        problems.add(measured_.points[i].where,
                     fmt::format("an incidence of {:g} {}; expected at least 0 and less than 90 deg",
                                 measured_.points[i].x, fit_.unit),
                     "angles are from the surface's normal");
    problems.throw_if_any();
    seed_ = settings_.run.seed.value_or(file_.spec(0).run.seed);
    for (const std::vector<double>& corner : corners_of(fit_))
      for (const std::string& note : sample_at(corner).warnings)
        if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
  }

  analysis::ModelPoint reflectance(const analysis::SampleSurface& sample, std::size_t point,
                                   std::uint64_t draw) const {
    analysis::GoniometerSettings settings;
    settings.side = fit_.goniometer->from_inside ? optics::Side::inside : optics::Side::outside;
    settings.incidence_rad = angle_rad(point);
    settings.wavelength_nm = sample.place.wavelength_nm;
    settings.seed = seed_;
    const std::uint64_t parts = rays_ < kFitParts * kLeastInPart ? 1 : kFitParts;
    analysis::ModelPoint out;
    std::uint64_t reflected = 0;
    for (std::uint64_t part = 0; part < parts; ++part) {
      settings.stream = (draw * measured_.points.size() + point) * kFitParts + part;
      settings.rays = (rays_ - part + parts - 1) / parts;
      const analysis::GoniometerReading reading =
          analysis::read_goniometer(sample.surface, sample.index, settings);
      reflected += reading.reflected;
      if (parts > 1) out.parts.push_back(reading.reflectance().value);
    }
    out.value = core::binomial_estimate(reflected, rays_);
    return out;
  }

  const scene_file::SceneFile& file_;
  const scene_file::FitSpec& fit_;
  const analysis::MeasuredCurve& measured_;
  const FitModelSettings& settings_;
  core::InputRecord inputs_;  ///< before what reads files
  std::unique_ptr<core::Journal> journal_;
  materials::SurfaceFactory factory_;
  materials::MaterialDatabase shipped_;
  std::uint64_t rays_, seed_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<FitModel> make_fit_model(const scene_file::SceneFile& file, const scene_file::FitSpec& fit,
                                         const analysis::MeasuredCurve& measured,
                                         const FitModelSettings& settings) {
  refuse_open_sweeps(file, fit);
  if (fit.quantity == scene_file::FitQuantity::reflectance)
    return std::make_unique<ReflectanceCurve>(file, fit, measured, settings);
  return std::make_unique<SceneCurve>(file, fit, measured, settings);
}

}  // namespace scintray::simulation
