#pragma once
/// What the sources of the Python module share: arrays over memory of the library, work that Ctrl-C stops,
/// and the data of a run.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/simulation.hpp"

namespace scintray::python {

namespace py = pybind11;

/// A read-only array over memory that `owner` keeps alive; nothing is copied.
template <typename T>
py::array view(const T* data, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array array(py::dtype::of<T>(), std::move(shape), data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
template <typename T>
py::array view(const std::vector<T>& values, const py::object& owner) {
  return view(values.data(), {static_cast<py::ssize_t>(values.size())}, owner);
}

/// An array that takes over the values.
template <typename T>
py::array array_of(std::vector<T> values, std::vector<py::ssize_t> shape = {}) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  if (shape.empty()) shape = {static_cast<py::ssize_t>(kept->size())};
  const T* data = kept->data();
  const py::capsule owner(kept.release(), [](void* held) { delete static_cast<std::vector<T>*>(held); });
  return py::array(py::dtype::of<T>(), std::move(shape), data, owner);
}

/// A value with its standard error, as (value, error).
inline py::tuple estimate(const core::Estimate& of) { return py::make_tuple(of.value, of.error); }

/// An array (n, 2) of values and errors.
py::array estimates(const std::vector<core::Estimate>& values);

/// The dictionary of an optional value, or None.
template <typename T, typename Convert>
py::object optional(const std::optional<T>& thing, Convert convert) {
  return thing ? py::object(convert(*thing)) : py::none();
}

/// Work on another thread, during which the calling one, a thread of Python, runs the signal handlers and
/// `progress`. An exception of either stops the work.
struct WatchedWork {
  /// Called with the numbers of finished and of all units, and their name; returns False to stop.
  py::object progress;
  std::atomic<bool> stop{false};

  /// Sets what `progress` is called with next; from any thread.
  void report(std::uint64_t done, std::uint64_t of, const std::string& thing);
  /// Does the work without the interpreter's lock.
  /// @return the exception of a signal handler (KeyboardInterrupt) or of `progress`, or None
  py::object run(const std::function<void()>& work);

 private:
  void call_progress();

  std::mutex mutex_;
  std::uint64_t done_ = 0, of_ = 0;
  std::string thing_;
  bool fresh_ = false;
};

/// Raises an exception of WatchedWork::run, unless it is None.
void raise_if(const py::object& error);

/// Events of one point, in columns.
struct EventColumns {
  std::vector<tally::ReadoutChannel> channels;
  std::optional<detector::ReadoutSpec> readout;
  std::vector<std::uint64_t> photon_order;
  std::vector<std::uint64_t> event, emitted, detected;
  std::vector<float> energy_keV, escaped_keV, non_scintillating_keV,
      position_mm;                 ///< position: three an event
  std::vector<std::int32_t> part;  ///< -1: none
  /// An event's channels one after the other; n-th photons and samples of a channel likewise.
  std::vector<std::uint32_t> channel_detected;
  std::vector<float> first_ns, charge, amplitude, time_ns, order_ns, waveform;

  void add(const tally::EventRecord& event);
  std::size_t size() const { return event.size(); }
  /// One event again as a record, without its waveforms.
  tally::EventRecord record(std::size_t row, std::uint32_t point) const;
};

/// Data of a run, from memory or from a results file.
struct RunData {
  tally::RunResult result;
  bool photon_list = false;
  std::vector<tally::DetectedPhoton> photons;
  std::vector<EventColumns> events;  ///< per point; empty for a source of photons
  std::vector<analysis::SurfaceAnalysis> surfaces;
  std::filesystem::path file;  ///< from which photons and events are still to be read; empty: none are
  bool events_read = false;    ///< from the file

  /// Reads the events that are still in the file. @throws InputError
  void read_all_events();
};

/// The data of a results file, without its lists of photons and events, which are read when they are used.
/// @throws InputError
std::shared_ptr<RunData> open_results(const std::string& path);

void add_run(py::module_& module);
void add_results(py::module_& module);
void add_analysis(py::module_& module);
void add_surfaces(py::module_& module);
void add_mapping(py::module_& module);

}  // namespace scintray::python
