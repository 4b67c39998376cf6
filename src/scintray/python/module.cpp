#include <filesystem>

#include "scintray/core/cancelled.hpp"
#include "scintray/core/data_folder.hpp"
#include "scintray/core/version.hpp"
#include "scintray/python/detail/bindings.hpp"

namespace scintray::python {

namespace {

/// Raises the class of scintray.errors of this name.
template <typename... Arguments>
void raise(const char* name, Arguments&&... arguments) {
  const py::object type = py::module_::import("scintray.errors").attr(name);
  PyErr_SetObject(type.ptr(), type(std::forward<Arguments>(arguments)...).ptr());
}

py::list problems_of(const core::InputError& error) {
  const py::object type = py::module_::import("scintray.errors").attr("Problem");
  py::list problems;
  for (const core::Problem& problem : error.problems())
    problems.append(type(problem.what, problem.hint, problem.where.file, problem.where.line,
                         problem.where.column, problem.places_mm));
  return problems;
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const core::InputError& error) {
    raise("InputError", problems_of(error));
  } catch (const core::Cancelled& error) {
    raise("Cancelled", error.what());
  } catch (const core::SystemError& error) {
    raise("SystemFailure", error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    raise("SystemFailure", error.what());
  } catch (const core::InternalError& error) {
    raise("InternalError", error.what());
  }
}

}  // namespace

py::array estimates(const std::vector<core::Estimate>& values) {
  std::vector<double> numbers;
  numbers.reserve(2 * values.size());
  for (const core::Estimate& of : values) {
    numbers.push_back(of.value);
    numbers.push_back(of.error);
  }
  return array_of(std::move(numbers), {static_cast<py::ssize_t>(values.size()), 2});
}

void WatchedWork::report(std::uint64_t done, std::uint64_t of, const std::string& thing) {
  const std::lock_guard guard(mutex_);
  done_ = done;
  of_ = of;
  thing_ = thing;
  fresh_ = true;
}

void WatchedWork::call_progress() {
  std::uint64_t done = 0, of = 0;
  std::string thing;
  {
    const std::lock_guard guard(mutex_);
    if (!fresh_) return;
    fresh_ = false;
    done = done_;
    of = of_;
    thing = thing_;
  }
  const py::object answer = progress(done, of, thing);
  if (answer.is(py::bool_(false))) stop.store(true);
}

py::object WatchedWork::run(const std::function<void()>& work) {
  constexpr std::chrono::milliseconds kInterval{50};
  std::future<void> future = std::async(std::launch::async, work);
  py::object error = py::none();
  const auto attend = [&] {
    if (!error.is_none()) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!progress.is_none() && !stop.load()) call_progress();
    } catch (py::error_already_set& raised) {
      error = raised.value();
      if (raised.trace()) error.attr("__traceback__") = raised.trace();
      stop.store(true);
    }
  };
  for (bool ready = false; !ready;) {
    {
      const py::gil_scoped_release released;
      ready = future.wait_for(kInterval) == std::future_status::ready;
    }
    attend();
  }
  try {
    future.get();
  } catch (const core::Cancelled&) {
    raise_if(error);
    throw;
  }
  return error;
}

void raise_if(const py::object& error) {
  if (error.is_none()) return;
  PyErr_SetObject(py::type::of(error).ptr(), error.ptr());
  throw py::error_already_set();
}

}  // namespace scintray::python

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  using namespace scintray;
  module.doc() = "The library behind the package scintray, which documents it.";
  py::register_exception_translator(&python::translate);
  module.def("version", [] { return core::version(); });
  module.def("data_folder", [] { return core::data_folder().string(); });
  python::add_run(module);
  python::add_results(module);
  python::add_analysis(module);
  python::add_surfaces(module);
  python::add_mapping(module);
}
