#include <sys/utsname.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "build_facts.hpp"
#include "figures.hpp"
#include "raw_embree.hpp"

namespace scintray::bench {

namespace {

/// Name of the processor from /proc/cpuinfo; of the architecture where it has none.
std::string cpu_name(const std::string& architecture) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return architecture;
}

std::string compiler_name() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "gcc " __VERSION__;
#else
  return "unknown";
#endif
}

}  // namespace

Machine this_machine() {
  utsname system{};
  ::uname(&system);
  Machine machine;
  machine.cpu = cpu_name(system.machine);
  machine.cores = std::thread::hardware_concurrency();
  double load = 0.0;
  if (::getloadavg(&load, 1) == 1) machine.load_average = load;
  machine.system = std::string(system.sysname) + " " + system.release + " " + system.machine;
  machine.compiler = compiler_name();
  machine.flags = build_flags();
  machine.embree = embree_version();
  return machine;
}

}  // namespace scintray::bench
