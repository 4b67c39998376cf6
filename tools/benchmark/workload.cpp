#include "workload.hpp"

#include <malloc.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "clock.hpp"
#include "scintray/mesh/export/triangle_files.hpp"

namespace scintray::bench {

namespace {

/// Resident memory of this program now.
double resident_megabytes() {
  ::malloc_trim(0);
  std::ifstream file("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  file >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// A mesh made in code, as the file that a part's shape is; removed when the scene has been built.
class MeshFile {
 public:
  explicit MeshFile(const mesh::TriMesh& mesh)
      : path_(std::filesystem::temp_directory_path() /
              ("scintray_bench_" + std::to_string(::getpid()) + ".ply")) {
    mesh::write_ply(path_, mesh);
  }
  ~MeshFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  MeshFile(const MeshFile&) = delete;
  MeshFile& operator=(const MeshFile&) = delete;

  scene_file::MeshFileSpec shape() const {
    scene_file::MeshFileSpec shape;
    shape.path = path_;
    shape.unit_mm = 1.0;
    return shape;
  }

 private:
  std::filesystem::path path_;
};

std::unique_ptr<const simulation::SimulationPoint> build_point(scene_file::SceneSpec spec) {
  scene::SceneBuilder builder;
  return std::make_unique<const simulation::SimulationPoint>(std::move(spec), builder);
}

std::unique_ptr<const simulation::SimulationPoint> build_scene(const BenchScene& scene,
                                                               std::optional<int> lane_width) {
  scene_file::SceneSpec spec = spec_of(scene);
  spec.run.lane_width = lane_width;
  if (!scene.mesh) return build_point(std::move(spec));
  const MeshFile file(scene.mesh());
  spec.parts.front().shape = file.shape();
  return build_point(std::move(spec));
}

}  // namespace

Workload::Workload(const BenchScene& scene, std::optional<int> lane_width) {
  const double before_MB = resident_megabytes();
  const double start = clock_seconds(CLOCK_MONOTONIC);
  point_ = build_scene(scene, lane_width);
  build_.seconds = clock_seconds(CLOCK_MONOTONIC) - start;
  build_.megabytes = resident_megabytes() - before_MB;
}

Trace Workload::trace(std::uint64_t work, int threads, std::optional<int> lane_width) const {
  scene_file::SceneSpec spec = point_->spec();
  spec.run.threads = threads;
  if (lane_width) spec.run.lane_width = lane_width;
  if (spec.energy_source)
    spec.energy_source->events = work;
  else
    spec.source.photons = work;
  const simulation::SimulationPoint point(std::move(spec), point_->built());
  std::uint64_t records = 0;
  simulation::RunHooks hooks;
  hooks.events = [&](const std::vector<tally::EventRecord>& events) { records += events.size(); };

  // One thread's own clock does not count what idle threads of an earlier trace do before they sleep.
  const clockid_t clock = threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID;
  const double cpu_start = clock_seconds(clock);
  const double start = clock_seconds(CLOCK_MONOTONIC);
  const tally::PointResult result = point.trace(hooks);
  Trace trace;
  trace.wall_s = clock_seconds(CLOCK_MONOTONIC) - start;
  trace.cpu_s = clock_seconds(clock) - cpu_start;
  trace.segments = result.segments;
  trace.photons = result.emitted;
  trace.events = result.energy.events;
  trace.lost = result.lost;
  trace.lane_width = point.lane_width();
  return trace;
}

std::size_t Workload::triangles() const {
  std::size_t count = 0;
  for (const auto& accelerator : point_->scene().accelerators) count += accelerator->size();
  return count;
}

}  // namespace scintray::bench
