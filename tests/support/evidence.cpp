#include "support/evidence.hpp"

#include <cstdlib>
#include <fstream>

namespace scintray::test {

void evidence(const std::string& table, std::initializer_list<std::string> row) {
  const char* path = std::getenv("SCINTRAY_EVIDENCE");
  if (!path) return;
  std::ofstream file(path, std::ios::app);
  file << table;
  for (const std::string& cell : row) file << '\t' << cell;
  file << '\n';
}

}  // namespace scintray::test
