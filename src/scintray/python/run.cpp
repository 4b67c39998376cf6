/// Scenes and runs.

#include <chrono>
#include <map>
#include <string>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/words.hpp"
#include "scintray/python/detail/bindings.hpp"

namespace scintray::python {

namespace {

using Text = std::string;
using HitsPtr = std::shared_ptr<const scene_file::HitColumns>;
using PhotonsPtr = std::shared_ptr<const scene_file::PhotonColumns>;

/// Keeps a run in memory: events in columns.
class ColumnSink : public simulation::ResultSink {
 public:
  explicit ColumnSink(RunData& data) : data_(data) {}

  void begin(const simulation::RunOutline& run) override {
    data_.result.header = run.header;
    data_.photon_list = run.photon_list;
  }
  void surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) override {
    data_.surfaces = analyses;
  }
  void begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                    const std::optional<detector::ReadoutSpec>& readout) override {
    data_.events.resize(std::max(data_.events.size(), point + 1));
    data_.events[point].channels = channels;
    data_.events[point].readout = readout;
    if (readout) data_.events[point].photon_order = readout->photon_order;
  }
  void photons(const std::vector<tally::DetectedPhoton>& photons) override {
    data_.photons.insert(data_.photons.end(), photons.begin(), photons.end());
  }
  void events(const std::vector<tally::EventRecord>& events) override {
    for (const tally::EventRecord& event : events) data_.events.at(event.point).add(event);
  }

 private:
  RunData& data_;
};

/// A scene and its simulation, with one run at a time.
class Session {
 public:
  Session(const Text& text, const Text& file, simulation::SimulationOptions options)
      : file_(scene_file::SceneFile::from_text(text, file)), options_(std::move(options)) {}

  std::size_t points() const { return file_.points(); }
  std::vector<Text> sweep_keys() const { return file_.sweep_keys(); }
  std::vector<Text> parameters(std::size_t point) const {
    expect_point(point);
    return file_.parameters(point);
  }
  /// Sets the deposits of a scene whose source takes arrays.
  void set_hits(HitsPtr hits) {
    const Lock lock(*this);
    expect_arrays<scene_file::HitsSpec>("hits", "hits");
    hits_ = std::move(hits);
    simulation_.reset();
  }
  /// Sets the photons of a scene whose source takes arrays.
  void set_photons(PhotonsPtr photons) {
    const Lock lock(*this);
    expect_arrays<scene_file::PhotonListSpec>("photons", "photon_list");
    photons_ = std::move(photons);
    simulation_.reset();
  }

  /// Warnings about the scene, built.
  std::vector<Text> check() {
    const Lock lock(*this);
    WatchedWork work;
    std::vector<Text> notes;
    const py::object error = work.run([&] {
      simulation::Simulation& simulation = prepared(work);
      simulation.build(hooks_of(work));
      for (const auto* list : {&simulation.point(0)->warnings(), &simulation.point(0)->source_notes()})
        notes.insert(notes.end(), list->begin(), list->end());
    });
    raise_if(error);
    return notes;
  }

  /// Runs the scene: the data, and the exception that stopped it or None.
  py::tuple run(const py::object& progress, const std::optional<Text>& output) {
    const Lock lock(*this);
    auto data = std::make_shared<RunData>();
    WatchedWork work;
    work.progress = progress;
    const py::object error = work.run([&] {
      simulation::Simulation& simulation = prepared(work);
      if (output) {
        simulation::ResultsFile file(*output);
        simulation.run_all(file, hooks_of(work));
        data = open_results(*output);
      } else {
        ColumnSink sink(*data);
        data->result = simulation.run_all(sink, hooks_of(work));
      }
    });
    return py::make_tuple(data, error);
  }

  /// The parts of a point as placed: names, media, vertices, triangles and faces.
  py::list parts(std::size_t point) {
    const Lock lock(*this);
    expect_point(point);
    WatchedWork work;
    std::shared_ptr<const simulation::SimulationPoint> ready;
    const py::object error = work.run([&] { ready = prepared(work).point(point); });
    raise_if(error);
    const py::capsule owner(new auto(ready->built()), [](void* held) {
      delete static_cast<std::shared_ptr<const scene::BuiltScene>*>(held);
    });
    py::list parts;
    for (const contact::PlacedMesh& part : ready->built()->placed) {
      py::dict entry;
      entry["name"] = part.name;
      entry["medium"] = part.medium.name;
      entry["sensor"] = part.sensor.name;
      const auto rows = [](std::size_t count) { return static_cast<py::ssize_t>(count); };
      entry["vertices"] = view(reinterpret_cast<const double*>(part.mesh.vertices.data()),
                               {rows(part.mesh.vertices.size()), 3}, owner);
      entry["triangles"] = view(reinterpret_cast<const std::uint32_t*>(part.mesh.triangles.data()),
                                {rows(part.mesh.triangles.size()), 3}, owner);
      entry["face_of_triangle"] = view(part.face_of, owner);
      std::vector<Text> faces, surfaces;
      for (const contact::PlacedFace& face : part.faces) {
        faces.push_back(face.name);
        surfaces.push_back(face.surface.name);
      }
      entry["faces"] = faces;
      entry["surfaces"] = surfaces;
      parts.append(entry);
    }
    return parts;
  }

 private:
  /// One call at a time: others are refused, since a simulation is for one thread.
  class Lock {
   public:
    explicit Lock(Session& session) : session_(session) {
      if (session_.busy_)
        throw core::InputError(core::Problem{
            {}, "this simulation is running in another thread", "wait for it, or make another Simulation"});
      session_.busy_ = true;
    }
    ~Lock() { session_.busy_ = false; }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    Session& session_;
  };

  /// Throws InputError unless the source is of a type and takes arrays.
  template <typename Spec>
  void expect_arrays(const Text& rows, const Text& type) const {
    const scene_file::SceneSpec spec = file_.spec(0);
    const auto* source = spec.energy_source ? std::get_if<Spec>(&spec.energy_source->kind) : nullptr;
    if (source != nullptr && source->arrays) return;
    throw core::InputError(core::Problem{spec.energy_source ? spec.energy_source->where : spec.source.where,
                                         "the source of this scene takes no " + rows,
                                         "write type = \"" + type + "\" and arrays = true in [source]"});
  }

  void expect_point(std::size_t point) const {
    if (point >= points())
      throw core::InputError(core::Problem{
          {},
          "there is no point " + std::to_string(point) + "; the scene has " + std::to_string(points()),
          "points count from 0"});
  }

  simulation::Simulation& prepared(WatchedWork& work) {
    work_ = &work;
    if (!simulation_) {
      simulation::SimulationOptions options = options_;
      if (hits_ || photons_)
        options.change = [hits = hits_, photons = photons_](scene_file::SceneSpec& spec) {
          if (!spec.energy_source) return;
          if (auto* source = std::get_if<scene_file::HitsSpec>(&spec.energy_source->kind))
            source->columns = hits;
          if (auto* source = std::get_if<scene_file::PhotonListSpec>(&spec.energy_source->kind))
            source->columns = photons;
        };
      options.surface_hooks.stop = [this] { return work_->stop.load(); };
      options.surface_hooks.table_progress = [this](const Text& surface, double done) {
        work_->report(static_cast<std::uint64_t>(100.0 * done), 100, "% of the table of " + surface);
      };
      simulation_.emplace(file_, std::move(options));
    }
    return *simulation_;
  }

  static simulation::SimulationHooks hooks_of(WatchedWork& work) {
    simulation::SimulationHooks hooks;
    hooks.stop = &work.stop;
    if (!work.progress.is_none())
      hooks.progress = [&work](const simulation::SimulationProgress& p) {
        work.report(p.done, p.total, p.thing);
      };
    return hooks;
  }

  scene_file::SceneFile file_;
  simulation::SimulationOptions options_;
  HitsPtr hits_;
  PhotonsPtr photons_;
  std::optional<simulation::Simulation> simulation_;
  WatchedWork* work_ = nullptr;  ///< of the present call
  bool busy_ = false;            ///< read and written with the interpreter's lock
};

using Column = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<double> values_of(const Column& column) { return {column.data(), column.data() + column.size()}; }

/// @param steps  columns of steps by their names
HitsPtr hits_of(const Column& event, const Column& position_mm, const Column& energy_keV,
                const Column& time_ns, const std::map<std::string, Column>& steps) {
  auto hits = std::make_shared<scene_file::HitColumns>();
  hits->event = values_of(event);
  for (py::ssize_t i = 0; i < position_mm.shape(0); ++i) {
    hits->x_mm.push_back(position_mm.at(i, 0));
    hits->y_mm.push_back(position_mm.at(i, 1));
    hits->z_mm.push_back(position_mm.at(i, 2));
  }
  hits->energy_keV = values_of(energy_keV);
  hits->time_ns = values_of(time_ns);
  for (const auto& [name, column] : steps) {
    const auto known = core::find_word(scene_file::kStepColumns, name);
    if (!known)
      throw core::unknown_name({}, "column of steps", name, core::word_list(scene_file::kStepColumns));
    hits->steps[static_cast<std::size_t>(*known)] = values_of(column);
  }
  return hits;
}

/// @param columns  by their names, in mm, nm and ns
PhotonsPtr photons_of(const std::map<std::string, Column>& columns) {
  auto photons = std::make_shared<scene_file::PhotonColumns>();
  for (const auto& [name, column] : columns) {
    const auto known = core::find_word(scene_file::kPhotonColumns, name);
    if (!known || *known == scene_file::PhotonColumn::energy)
      throw core::unknown_name({}, "column of photons", name, core::word_list(scene_file::kPhotonColumns));
    (*photons).*scene_file::column_member(*known) = values_of(column);
  }
  return photons;
}

}  // namespace

void add_run(py::module_& module) {
  py::class_<Session>(module, "Session")
      .def(py::init([](const Text& text, const Text& file, std::optional<int> threads,
                       std::optional<std::uint64_t> seed, std::optional<std::uint64_t> photons,
                       std::optional<std::uint64_t> events, bool quick) {
        simulation::SimulationOptions options;
        options.threads = threads;
        options.seed = seed;
        options.photons = photons;
        options.events = events;
        options.quick = quick;
        const py::gil_scoped_release released;
        return std::make_unique<Session>(text, file, std::move(options));
      }))
      .def("points", &Session::points)
      .def("sweep_keys", &Session::sweep_keys)
      .def("parameters", &Session::parameters)
      .def("check", &Session::check)
      .def("parts", &Session::parts)
      .def("set_hits",
           [](Session& session, const Column& event, const Column& position, const Column& energy,
              const Column& time, const std::map<std::string, Column>& steps) {
             session.set_hits(hits_of(event, position, energy, time, steps));
           })
      .def("set_photons",
           [](Session& session, const std::map<std::string, Column>& columns) {
             session.set_photons(photons_of(columns));
           })
      .def("run", &Session::run);
}

}  // namespace scintray::python
