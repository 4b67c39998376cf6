#include "scintray/simulation/detail/backward_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/core/count_sampling.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::simulation {

namespace {

/// Address of the random stream of a channel's times of flight, which no photon has.
constexpr std::uint64_t kTimes = std::numeric_limits<std::uint64_t>::max();

/// Chooses `count` of `slots` numbers, each set of that size alike (D. E. Knuth's selection sampling), and
/// passes them on.
template <typename Visit>
void choose(std::uint64_t count, std::uint32_t slots, core::Rng& rng, const Visit& visit) {
  for (std::uint32_t slot = 0; slot < slots && count > 0; ++slot) {
    if (rng.uniform() * (slots - slot) >= static_cast<double>(count)) continue;
    visit(slot);
    --count;
  }
}

core::Vec3 point_on(const scene::BoundaryTriangle& triangle, core::Rng& rng) {
  const double root = std::sqrt(rng.uniform()), v = rng.uniform();
  return (1.0 - root) * triangle[0] + root * (1.0 - v) * triangle[1] + root * v * triangle[2];
}

}  // namespace

/// One photon on its way back: its paths through the cells of the grids.
class BackwardPhoton {
 public:
  BackwardPhoton(const BackwardTracer& tracer, ChannelLight& light, core::Rng times)
      : tracer_(tracer),
        light_(light),
        times_(times),
        own_(tracer.cells()),
        limits_(limits_of(tracer.run_)) {}

  void trace(std::size_t channel, core::Rng rng) {
    const double weight = start(channel, rng);
    if (weight <= 0.0) return;
    const auto pass = [&](const source::Photon& photon, const transport::Step&) { move_to(photon, weight); };
    limits_.passed = pass;
    while (!limits_.reached(photon_)) {
      leave_from(photon_);
      const transport::Step taken = transport::step(tracer_.scene_, photon_, rng, limits_);
      move_to(photon_, weight);
      if (core::is_final(taken.event)) break;
    }
    finish();
  }

 private:
  /// Starts the photon at a window of the channel, by Lambert's law inside the sensor, and takes it across.
  /// @return etendue of the channel times the probability of conversion, mm2 sr; 0: it does not get across
  double start(std::size_t channel, core::Rng& rng) {
    const scene::Scene& scene = tracer_.scene_;
    const std::vector<BackwardTracer::Window>& windows = tracer_.windows_[channel];
    const double area = windows.back().area_below_mm2, at = rng.uniform() * area;
    const auto window = std::upper_bound(
        windows.begin(), windows.end() - 1, at,
        [](double value, const BackwardTracer::Window& entry) { return value < entry.area_below_mm2; });
    const scene::Region& region = scene.regions[window->region];
    photon_ = {};
    photon_.region = window->region;
    photon_.position = point_on(scene.triangle(region, window->triangle), rng);
    photon_.wavelength_nm = tracer_.emission_.sample(rng.uniform());
    photon_.optics = {};
    photon_.optics.index = photon_.optics.group_index = index_at(region, window->triangle);
    const core::Vec3 outward = scene.normal(region, window->triangle);
    photon_.ray.direction = core::sample_lambertian(outward, rng);
    photon_.ray.polarisation = tracer_.map_.unpolarised
                                   ? core::Vec3(core::Vec3::Zero())
                                   : core::sample_polarisation(photon_.ray.direction, rng);
    photon_.optical_depth = core::sample_exponential(rng);
    const double index = photon_.optics.index;
    const double cosine = photon_.ray.direction.dot(outward);
    const double converted = scene.sensors[tracer_.sensors_[channel]].conversion_probability(
        photon_.wavelength_nm, index * std::sqrt(std::max(0.0, 1.0 - cosine * cosine)));
    const transport::Step entered = transport::interact_at(scene, window->triangle, photon_, rng);
    if (entered.event != core::StepEvent::transmitted) return 0.0;
    return area * core::kPi * index * index * converted;
  }

  /// Index in which light reaches a sensor through a triangle of the boundary of the region it enters. An
  /// opaque region has that of what is before it.
  double index_at(const scene::Region& region, std::uint32_t triangle) const {
    const scene::Scene& scene = tracer_.scene_;
    core::MediumId medium = region.medium;
    if (scene.optics.is_opaque(medium)) {
      const scene::BoundaryLink& link = scene.link(region, triangle);
      const scene::Interface& interface = scene.interfaces[link.interface];
      medium = interface.gap_medium.has_value()
                   ? interface.gap_medium
                   : scene.regions[link.from_back ? interface.front : interface.back].medium;
    }
    return scene.optics.index(medium, photon_.wavelength_nm);
  }

  void leave_from(const source::Photon& photon) {
    from_ = photon.position;
    from_ns_ = photon.time_ns;
    from_region_ = photon.region;
    from_index_ = photon.optics.index;
  }

  /// Scores the straight path to where the photon is now.
  void move_to(const source::Photon& photon, double weight) {
    const std::int32_t grid = tracer_.grid_of_[from_region_];
    if (grid >= 0) {
      const core::Vec3 way = photon.position - from_;
      const double length = way.norm();
      if (length > 0.0)
        score(static_cast<std::size_t>(grid), {way / length, length, photon.time_ns - from_ns_, weight});
    }
    from_ = photon.position;
    from_ns_ = photon.time_ns;
  }

  /// A straight path from `from_`.
  struct Path {
    core::Vec3 direction;
    double length_mm, time_ns, weight;
  };

  void score(std::size_t number, const Path& path) {
    const ResponseGrid& grid = *tracer_.grids_[number];
    const double per_mm = path.weight / (4.0 * core::kPi * from_index_ * from_index_);
    const core::Vec3 local = from_ - grid.low;
    std::array<std::int64_t, 3> cell{}, step{};
    std::array<double, 3> next{}, between{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      const double at = local[i] / grid.pitch[i], d = path.direction[i];
      cell[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(at)), 0,
                                            std::int64_t{grid.cells[axis]} - 1);
      step[axis] = d > 0.0 ? 1 : -1;
      const double wall = static_cast<double>(cell[axis] + (d > 0.0 ? 1 : 0)) * grid.pitch[i];
      next[axis] = d == 0.0 ? std::numeric_limits<double>::infinity() : std::max(0.0, (wall - local[i]) / d);
      between[axis] = d == 0.0 ? 0.0 : grid.pitch[i] / std::abs(d);
    }
    for (double done = 0.0; done < path.length_mm;) {
      const auto axis = static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
      const double end = std::min(next[axis], path.length_mm);
      if (end > done) {
        const auto flat =
            static_cast<std::size_t>((cell[0] * grid.cells[1] + cell[1]) * grid.cells[2] + cell[2]);
        const double volume = tracer_.volumes_mm3_[number][flat];
        if (volume > 0.0)
          add(tracer_.first_cell_[number] + flat, per_mm * (end - done) / volume, path, done, end);
        done = end;
      }
      cell[axis] += step[axis];
      next[axis] += between[axis];
      if (cell[axis] < 0 || cell[axis] >= grid.cells[axis]) return;
    }
  }

  void add(std::size_t cell, double contribution, const Path& path, double begin_mm, double end_mm) {
    if (own_[cell] == 0.0) touched_.push_back(cell);
    own_[cell] += contribution;
    const std::uint32_t kept = tracer_.map_.delays_kept;
    const double all = light_.sum[cell] + own_[cell];
    const std::uint64_t replaced = core::sample_binomial(kept, std::min(1.0, contribution / all), times_);
    float* const slots = light_.delays_ns.data() + cell * kept;
    choose(replaced, kept, times_, [&](std::uint32_t slot) {
      const double at_mm = begin_mm + times_.uniform() * (end_mm - begin_mm);
      slots[slot] = static_cast<float>(from_ns_ + path.time_ns * at_mm / path.length_mm);
    });
  }

  void finish() {
    for (const std::size_t cell : touched_) {
      light_.sum[cell] += own_[cell];
      light_.squares[cell] += own_[cell] * own_[cell];
      ++light_.photons[cell];
      own_[cell] = 0.0;
    }
    touched_.clear();
  }

  const BackwardTracer& tracer_;
  ChannelLight& light_;
  core::Rng times_;
  std::vector<double> own_;  ///< contributions of the present photon, per cell
  std::vector<std::size_t> touched_;
  transport::PropagationLimits limits_;
  source::Photon photon_;
  core::Vec3 from_ = core::Vec3::Zero();
  double from_ns_ = 0.0, from_index_ = 1.0;
  core::RegionId from_region_;
};

void ChannelLight::add(const ChannelLight& other, std::uint32_t delays_kept, core::Rng& rng) {
  for (std::size_t cell = 0; cell < sum.size(); ++cell) {
    if (other.photons[cell] == 0) continue;
    const double share = other.sum[cell] / (sum[cell] + other.sum[cell]);
    choose(core::sample_binomial(delays_kept, share, rng), delays_kept, rng, [&](std::uint32_t slot) {
      delays_ns[cell * delays_kept + slot] = other.delays_ns[cell * delays_kept + slot];
    });
    sum[cell] += other.sum[cell];
    squares[cell] += other.squares[cell];
    photons[cell] += other.photons[cell];
  }
}

BackwardTracer::BackwardTracer(const scene::Scene& scene, const tally::ReadoutChannels& channels,
                               const ResponseMap& map, std::vector<const ResponseGrid*> grids,
                               std::vector<std::vector<double>> volumes_mm3, const RunSettings& run)
    : scene_(scene),
      map_(map),
      run_(run),
      grids_(std::move(grids)),
      volumes_mm3_(std::move(volumes_mm3)),
      grid_of_(scene.regions.size(), -1) {
  std::size_t cells = 0;
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    first_cell_.push_back(cells);
    cells += grids_[i]->size();
    grid_of_[grids_[i]->region] = static_cast<std::int32_t>(i);
  }
  first_cell_.push_back(cells);
  const core::MediumId medium = scene.regions[grids_.front()->region].medium;
  emission_ = core::CurveSampler(scene.media[medium].medium().emission);
  for (const tally::ReadoutChannel& channel : channels.list) sensors_.push_back(channel.sensor);
  find_windows(channels);
}

void BackwardTracer::find_windows(const tally::ReadoutChannels& channels) {
  windows_.resize(channels.list.size());
  for (const core::RegionId id : scene_.regions.ids()) {
    const scene::Region& region = scene_.regions[id];
    const std::size_t triangles = scene_.accelerator(region).boundary().size();
    for (std::uint32_t triangle = 0; triangle < triangles; ++triangle) {
      const scene::BoundaryLink& link = scene_.link(region, triangle);
      const auto channel = channels.at_crossing[link.interface][link.from_back ? 0 : 1];
      if (!channel.has_value()) continue;
      std::vector<Window>& windows = windows_[channel.index()];
      const double below = windows.empty() ? 0.0 : windows.back().area_below_mm2;
      windows.push_back({id, triangle, below + scene::area_of(scene_.triangle(region, triangle))});
    }
  }
}

ChannelLight BackwardTracer::trace(std::size_t channel, std::uint64_t stream, std::uint64_t first,
                                   std::uint64_t last) const {
  ChannelLight light;
  light.sum.resize(cells());
  light.squares.resize(cells());
  light.photons.resize(cells());
  light.delays_ns.resize(cells() * map_.delays_kept);
  if (windows_[channel].empty()) return light;
  BackwardPhoton photon(*this, light, core::Rng(run_.seed, core::StreamKind::cell, stream, kTimes - first));
  for (std::uint64_t number = first; number < last; ++number)
    photon.trace(channel, core::Rng(run_.seed, core::StreamKind::cell, stream, number));
  return light;
}

}  // namespace scintray::simulation
