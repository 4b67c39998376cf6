#include "scintray/transport/batch.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/detail/photon_numbers.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

/// Photons in flight at once, at most: enough to fill the lanes with photons of one kind of region, few
/// enough for the first level of the cache.
constexpr std::size_t kTravellers = 128;
/// Those where none is propagated through total reflections alone: a few more than the pool has.
constexpr std::size_t kPoolTravellers = 64;
static_assert(kPoolTravellers > LanePool::kPhotons && kPoolTravellers <= kTravellers);

}  // namespace

/// Ends of photons, which arrive in any order, to be handed over by number.
class Batch::EndsInOrder {
 public:
  void begin() { first_ = 0; }
  /// Makes room for the end of a photon, numbered one above the last.
  void expect(std::uint64_t number) {
    if (number - first_ == ends_.size()) grow(number);
    known_[place(number)] = false;
  }
  /// The end of a photon, to be set.
  TracedPhoton& at(std::uint64_t number) {
    known_[place(number)] = true;
    return ends_[place(number)];
  }
  /// True when it is time to hand some over: all at once is faster than each as it comes.
  bool expects_many(std::uint64_t next) const { return next - first_ > ends_.size() - kTravellers; }
  /// Hands over those before which none is missing.
  /// @param next  one above the last number expected
  void hand_over(std::uint64_t next, Batch::End end) {
    for (; first_ < next && known_[place(first_)]; ++first_) end(first_, ends_[place(first_)]);
  }

 private:
  std::size_t place(std::uint64_t number) const { return number & (ends_.size() - 1); }
  void grow(std::uint64_t next) {
    std::vector<TracedPhoton> ends(2 * ends_.size());
    std::vector<char> known(ends.size());
    for (std::uint64_t number = first_; number < next; ++number) {
      ends[number & (ends.size() - 1)] = ends_[place(number)];
      known[number & (ends.size() - 1)] = known_[place(number)];
    }
    ends_.swap(ends);
    known_.swap(known);
  }

  static constexpr std::size_t kFew = 4 * kTravellers;                ///< a power of two, as all sizes
  std::vector<TracedPhoton> ends_ = std::vector<TracedPhoton>(kFew);  ///< by number modulo size
  std::vector<char> known_ = std::vector<char>(kFew);
  std::uint64_t first_ = 0;  ///< number of the next to be handed over
};

class Batch::Tracing {
 public:
  Tracing(const scene::Scene& scene, const PropagationLimits& limits, const LanePlan& lanes);

  void trace(std::uint64_t count, Emit emit, End end);
  const BatchCounts& counts() const { return counts_; }

 private:
  /// A photon in flight.
  struct Traveller : source::EmittedPhoton {
    std::uint64_t index = 0;                                 ///< of all photons
    std::uint32_t segments = 0;                              ///< of the present step so far
    std::uint64_t segments_before = 0, resolved_before = 0;  ///< as of TracedPhoton
    core::RegionId faces_of;  ///< region and wavelength of its numbers of faces; none: not set
    double faces_nm = 0.0;
  };
  /// A photon to be propagated in lanes.
  struct Waiting {
    core::AcceleratorId accelerator;
    std::uint32_t traveller = 0;
  };

  bool in_flight() const {
    return !alone_.empty() || !waiting_.empty() || !for_surface_lanes_.empty() || !surface_lanes_.empty();
  }
  LaneKind kind_of(const Traveller& traveller) const {
    const LaneKind kind = lanes_.kind(traveller.photon.region);
    const bool taken = kind != LaneKind::surfaces || surface_lanes_.takes(traveller.photon);
    return taken ? kind : LaneKind::none;
  }
  void enqueue(std::uint32_t traveller);
  void trace_in_surface_lanes();
  void trace_alone(std::uint32_t traveller);
  void trace_in_lanes();
  void propagate(const Waiting* first, const Waiting* last);
  /// Sets all of a traveller's work but the results, in place: copying what was just written would stall.
  void set_work(std::uint32_t traveller);
  /// Reflects or refracts those of refracted_.
  void refract(core::AcceleratorId accelerator);
  void finish(const LaneFaces& faces, std::uint32_t traveller);
  /// Sets a photon, its stream and segments to what the lanes have made of it.
  void take_back(std::uint32_t traveller);
  /// True when the photon continues after the step; else its end is recorded, and the next photon replaces
  /// it.
  bool goes_on(Traveller& traveller, const Step& taken);
  /// Enqueues a traveller that goes_on() after the step, else its place is free.
  void go_on(std::uint32_t traveller, const Step& taken);
  /// Starts the next photons in place of those that have ended.
  void start();

  const scene::Scene& scene_;
  PropagationLimits limits_;
  const LanePlan& lanes_;
  LaneKernels kernels_;
  std::optional<Eigen::AlignedBox3d> reachable_;  ///< ambient_bounds()
  SurfaceLanes surface_lanes_;
  core::IdVector<core::AcceleratorId, LaneFaces> faces_;  ///< of those of LaneKind::smooth
  std::size_t most_faces_ = 0;
  std::vector<Traveller> travellers_;
  std::vector<LaneWork> work_;  ///< per traveller
  /// As of LaneWork, per traveller and face, most_faces_ each.
  std::vector<double> least_sin2_, index_behind_;
  std::vector<std::uint32_t> ended_, alone_, for_surface_lanes_, refracted_;
  std::vector<Waiting> waiting_, in_lanes_;
  std::vector<LaneWork*> together_;  ///< the work of a kernel
  EndsInOrder ends_;
  BatchCounts counts_;
  std::uint64_t next_ = 0, count_ = 0;  ///< number of the next photon to start, and of all
  Emit emit_;
};

Batch::Batch(const scene::Scene& scene, const PropagationLimits& limits, const LanePlan& lanes)
    : tracing_(std::make_unique<Tracing>(scene, limits, lanes)) {}

Batch::~Batch() = default;

void Batch::trace(std::uint64_t count, Emit emit, End end) { tracing_->trace(count, emit, end); }

const BatchCounts& Batch::counts() const { return tracing_->counts(); }

Batch::Tracing::Tracing(const scene::Scene& scene, const PropagationLimits& limits, const LanePlan& lanes)
    : scene_(scene),
      limits_(limits),
      lanes_(lanes),
      kernels_(lane_kernels(lanes.width())),
      reachable_(ambient_bounds(scene)),
      surface_lanes_(scene, lanes.scene(), limits, kernels_.run) {
  faces_.resize(scene.accelerators.size());
  for (std::uint32_t i = 0; i < scene.regions.size(); ++i) {
    const core::RegionId region(i);
    const core::AcceleratorId accelerator = scene.regions[region].accelerator;
    if (lanes.kind(region) != LaneKind::smooth || !faces_[accelerator].list().empty()) continue;
    faces_[accelerator] = LaneFaces(scene, scene.regions[region]);
    most_faces_ = std::max(most_faces_, faces_[accelerator].list().size());
  }
}

void Batch::Tracing::trace(std::uint64_t count, Emit emit, End end) {
  counts_ = {};
  next_ = 0;
  count_ = count;
  emit_ = emit;
  ends_.begin();
  const std::size_t most = most_faces_ > 0 ? kTravellers : kPoolTravellers;
  travellers_.resize(std::min<std::uint64_t>(count, most));
  if (most_faces_ > 0) work_.resize(travellers_.size());
  least_sin2_.resize(travellers_.size() * most_faces_);
  index_behind_.resize(travellers_.size() * most_faces_);
  ended_.clear();
  for (std::uint32_t i = 0; i < travellers_.size(); ++i) ended_.push_back(i);
  for (start(); in_flight(); start()) {
    while (!alone_.empty()) {
      const std::uint32_t traveller = alone_.back();
      alone_.pop_back();
      trace_alone(traveller);
    }
    if (!waiting_.empty()) trace_in_lanes();
    trace_in_surface_lanes();
    if (ends_.expects_many(next_)) ends_.hand_over(next_, end);
  }
  ends_.hand_over(next_, end);
}

void Batch::Tracing::start() {
  // Some wait until they are enough to be emitted together, unless nothing else is in flight.
  while (next_ < count_ && (ended_.size() >= kTogether || (!ended_.empty() && !in_flight()))) {
    source::EmittedPhoton* starting[kTogether];
    const std::size_t count =
        std::min<std::size_t>({kTogether, ended_.size(), static_cast<std::size_t>(count_ - next_)});
    const std::span<const std::uint32_t> places(ended_.end() - static_cast<std::ptrdiff_t>(count),
                                                ended_.end());
    for (std::size_t i = 0; i < count; ++i) starting[i] = &travellers_[places[i]];
    emit_(next_, {starting, count});
    for (const std::uint32_t place : places) {
      Traveller& traveller = travellers_[place];
      ends_.expect(next_);
      traveller.index = next_++;
      traveller.segments = 0;
      traveller.segments_before = traveller.resolved_before = 0;
      enqueue(place);
    }
    ended_.resize(ended_.size() - count);
  }
}

void Batch::Tracing::go_on(std::uint32_t index, const Step& taken) {
  if (goes_on(travellers_[index], taken))
    enqueue(index);
  else
    ended_.push_back(index);
}

void Batch::Tracing::enqueue(std::uint32_t index) {
  const source::Photon& photon = travellers_[index].photon;
  switch (kind_of(travellers_[index])) {
    case LaneKind::none:
      alone_.push_back(index);
      break;
    case LaneKind::smooth:
      set_work(index);
      waiting_.push_back({scene_.regions[photon.region].accelerator, index});
      break;
    case LaneKind::surfaces:
      for_surface_lanes_.push_back(index);
      break;
  }
}

void Batch::Tracing::trace_alone(std::uint32_t index) {
  Traveller& traveller = travellers_[index];
  do {
    if (!goes_on(traveller, step(scene_, traveller.photon, traveller.rng, limits_)))
      return ended_.push_back(index);
  } while (kind_of(traveller) == LaneKind::none);
  enqueue(index);
}

void Batch::Tracing::trace_in_surface_lanes() {
  while (!for_surface_lanes_.empty() && surface_lanes_.has_room()) {
    const std::uint32_t index = for_surface_lanes_.back();
    for_surface_lanes_.pop_back();
    surface_lanes_.enter(index, travellers_[index].photon, travellers_[index].rng);
  }
  if (surface_lanes_.empty()) return;
  for (const SurfaceLanes::Left& left : surface_lanes_.run()) {
    Traveller& traveller = travellers_[left.name];
    traveller.segments += left.segments;
    go_on(left.name, surface_lanes_.finish(left, traveller.photon, traveller.rng));
  }
}

void Batch::Tracing::trace_in_lanes() {
  in_lanes_.swap(waiting_);
  waiting_.clear();
  const auto before = [](const Waiting& a, const Waiting& b) { return a.accelerator < b.accelerator; };
  if (!std::is_sorted(in_lanes_.begin(), in_lanes_.end(), before))
    std::sort(in_lanes_.begin(), in_lanes_.end(), before);
  for (auto first = in_lanes_.begin(); first != in_lanes_.end();) {
    const auto last = std::find_if(first, in_lanes_.end(), [&](const Waiting& waiting) {
      return waiting.accelerator != first->accelerator;
    });
    propagate(&*first, &*first + (last - first));
    first = last;
  }
}

void Batch::Tracing::propagate(const Waiting* first, const Waiting* last) {
  const LaneFaces& faces = faces_[first->accelerator];
  const LaneLimits limits{static_cast<double>(limits_.interactions), limits_.time_ns};
  const auto count = static_cast<std::size_t>(last - first);
  counts_.grouped += count;
  ++counts_.groups;
  together_.clear();
  for (const Waiting* waiting = first; waiting != last; ++waiting)
    together_.push_back(&work_[waiting->traveller]);
  if (faces.has_quadrics())
    kernels_.propagate_in_body(faces.body(), limits, together_.data(), count);
  else
    kernels_.propagate(faces.planes(), limits, together_.data(), count);
  refracted_.clear();
  for (const Waiting* waiting = first; waiting != last; ++waiting) {
    LaneWork& work = work_[waiting->traveller];
    if (work.end == LaneEnd::unfinished) {
      travellers_[waiting->traveller].segments += work.segments;
      waiting_.push_back(*waiting);
    } else if (work.end == LaneEnd::boundary && work.index_behind[work.face] > 0.0) {
      work.index_there = work.index_behind[work.face];
      refracted_.push_back(waiting->traveller);
    } else {
      finish(faces, waiting->traveller);
    }
  }
  if (!refracted_.empty()) refract(first->accelerator);
}

void Batch::Tracing::refract(core::AcceleratorId accelerator) {
  const LaneFaces& faces = faces_[accelerator];
  together_.clear();
  for (const std::uint32_t index : refracted_) together_.push_back(&work_[index]);
  kernels_.refract(faces.normals(), together_.data(), together_.size());
  for (const std::uint32_t index : refracted_) {
    Traveller& traveller = travellers_[index];
    LaneWork& work = work_[index];
    if (work.index != work.index_there) work.interactions += 1.0;
    if (work.transmitted == 0 && limits_.allow(static_cast<std::uint64_t>(work.interactions), work.time_ns)) {
      traveller.segments_before += work.segments + std::exchange(traveller.segments, 0);
      waiting_.push_back({accelerator, index});
      continue;
    }
    take_back(index);
    const BoundaryPlace at{faces.list()[work.face].triangle, work.cosine};
    go_on(index, work.transmitted != 0 ? cross_boundary(scene_, at, traveller.photon) : reflected_in_lanes());
  }
}

void Batch::Tracing::set_work(std::uint32_t index) {
  Traveller& traveller = travellers_[index];
  const source::Photon& photon = traveller.photon;
  const LaneFaces& faces = faces_[scene_.regions[photon.region].accelerator];
  double* const least_sin2 = least_sin2_.data() + index * most_faces_;
  double* const index_behind = index_behind_.data() + index * most_faces_;
  if (traveller.faces_of != photon.region || traveller.faces_nm != photon.wavelength_nm) {
    faces.set_optics(scene_, photon, kernels_.refract != nullptr, {least_sin2, index_behind});
    traveller.faces_of = photon.region;
    traveller.faces_nm = photon.wavelength_nm;
  }
  LaneWork& work = work_[index];
  give_photon(scene_, photon, work);
  work.index = photon.optics.index;
  work.stream[0] = traveller.rng.state().first;
  work.stream[1] = traveller.rng.state().second;
  work.least_sin2 = least_sin2;
  work.index_behind = index_behind;
  work.left = faces.left_at(photon.on_triangle);
}

void Batch::Tracing::take_back(std::uint32_t index) {
  Traveller& traveller = travellers_[index];
  const LaneWork& work = work_[index];
  take_photon(work, traveller.photon);
  traveller.rng.go_on_from({work.stream[0], work.stream[1]});
  traveller.segments += work.segments;
}

void Batch::Tracing::finish(const LaneFaces& faces, std::uint32_t index) {
  Traveller& traveller = travellers_[index];
  source::Photon& photon = traveller.photon;
  const LaneWork& work = work_[index];
  take_back(index);
  if (faces.has_quadrics() && work.left != faces.left_at(photon.on_triangle))
    photon.on_triangle = faces.list()[static_cast<std::size_t>(work.left)].triangle;
  if (work.end == LaneEnd::unclear) return alone_.push_back(index);
  Propagation propagation;
  if (work.end != LaneEnd::bulk) {
    propagation.end = work.end == LaneEnd::total ? PropagationEnd::total : PropagationEnd::boundary;
    propagation.triangle = faces.list()[work.face].triangle;
    propagation.cosine = work.cosine;
  } else {
    propagation.end = PropagationEnd::bulk;
  }
  go_on(index, end_of_step(scene_, propagation, photon, traveller.rng, nullptr));
}

bool Batch::Tracing::goes_on(Traveller& traveller, const Step& taken) {
  const std::uint32_t segments = taken.segments + std::exchange(traveller.segments, 0);
  const bool ends = core::is_final(taken.event);
  const std::optional<core::Fate> cut = ends ? std::nullopt : limits_.reached(traveller.photon);
  if (!ends) {
    traveller.segments_before += segments;
    traveller.resolved_before += taken.resolved;
    if (!cut && !leaves_the_scene(scene_, reachable_, traveller.photon, taken)) return true;
  }
  TracedPhoton& traced = ends_.at(traveller.index);
  traced = {traveller.photon, taken, cut, traveller.segments_before, traveller.resolved_before};
  traced.last.segments = segments;
  if (!ends && !cut) traced.last = step_out_of_scene();
  return false;
}

}  // namespace scintray::transport
