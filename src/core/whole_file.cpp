#include "scintray/core/whole_file.hpp"

#include <fstream>
#include <string>
#include <system_error>

#include "scintray/core/error.hpp"

namespace scintray {

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  auto temporary = path;
  temporary += ".part";
  std::error_code error;
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) {
      std::filesystem::remove(temporary, error);
      throw SystemError("cannot write " + temporary.string() +
                        ": check that the folder exists and has space");
    }
  }
  std::filesystem::rename(temporary, path, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(temporary, error);
    throw SystemError("cannot write " + path.string() + ": " + reason);
  }
}

}  // namespace scintray
