/// tools/bench [arrays] [crystal] [tables]: everything, or what is named.

#include <cstdlib>
#include <iostream>
#include <map>
#include <string>

#include "bench.hpp"

int main(int argc, char** argv) {
  const std::map<std::string, void (*)()> benches{{"arrays", scintray::bench::bench_arrays},
                                                  {"crystal", scintray::bench::bench_crystal},
                                                  {"tables", scintray::bench::bench_tables}};
  std::vector<std::string> wanted(argv + 1, argv + argc);
  if (wanted.empty())
    for (const auto& [name, run] : benches) wanted.push_back(name);
  for (const std::string& name : wanted) {
    if (!benches.contains(name)) {
      std::cerr << "error: there is no bench \"" << name << "\"\n  hint: arrays, crystal or tables\n";
      return EXIT_FAILURE;
    }
    benches.at(name)();
    std::cout << std::endl;
  }
  return EXIT_SUCCESS;
}
