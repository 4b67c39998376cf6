#include "scintray/mesh/import/detail/gltf_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/core/text.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

/// The JSON text: a .glb file's first chunk, whose length is at byte 12 (section 4.4).
std::string json_part(const std::string& content, bool binary) {
  constexpr std::size_t kHeader = 20;  // magic, version, length; chunk length, chunk type
  if (!binary) return content;
  if (content.size() < kHeader) return {};
  std::size_t length = 0;
  for (std::size_t byte = 0; byte < 4; ++byte) {
    length |= static_cast<std::size_t>(static_cast<unsigned char>(content[12 + byte])) << (8 * byte);
  }
  return content.substr(kHeader, length);
}

std::string little_endian(std::size_t value) {
  std::string bytes;
  for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(value >> (8 * byte) & 0xFF);
  return bytes;
}

/// The file without its images, which do not concern the geometry: a missing one would be an error, a pipe
/// would block. Content that is not JSON is unchanged.
std::string without_pictures(const std::string& content, bool binary) {
  const std::string json = json_part(content, binary);
  if (json.find("\"images\"") == std::string::npos) return content;
  nlohmann::json document = nlohmann::json::parse(json, nullptr, false);
  if (!document.is_object()) return content;
  for (const char* key : {"images", "textures", "samplers"}) document.erase(key);
  std::string kept = document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (!binary) return kept;
  constexpr std::size_t kHeader = 20;
  kept.resize((kept.size() + 3) / 4 * 4, ' ');
  const std::string rest = content.substr(std::min(content.size(), kHeader + json.size()));
  return content.substr(0, 8) + little_endian(kHeader + kept.size() + rest.size()) +
         little_endian(kept.size()) + content.substr(16, 4) + kept + rest;
}

/// Reads the file of a buffer, which must lie beside the glTF file. The functions are called through
/// pointers.
struct BufferFiles {
  const std::filesystem::path& path;
  std::string trouble;  ///< with the last file

  tinygltf::FsCallbacks callbacks() {
    tinygltf::FsCallbacks calls{};
    calls.FileExists = [](const std::string&, void*) { return true; };  // reading reports a missing file
    calls.ExpandFilePath = [](const std::string& name, void*) { return name; };
    calls.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* error, const std::string& name,
                             void* self) {
      return static_cast<BufferFiles*>(self)->read(name, *bytes, *error);
    };
    calls.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
      return false;
    };
    calls.user_data = this;
    return calls;
  }

  bool read(const std::string& name, std::vector<unsigned char>& bytes, std::string& error) {
    // tinygltf joins the folder and the name with a slash.
    const std::string folder = path.parent_path().string();
    const std::string own =
        !folder.empty() && name.starts_with(folder + "/") ? name.substr(folder.size() + 1) : name;
    try {
      const std::optional<std::string> content = core::read_whole_file(file_beside(path, own));
      if (content) bytes.assign(content->begin(), content->end());
      if (!content) trouble = "the buffer " + core::in_quotes(own) + " cannot be read";
    } catch (const core::InputError& wrong) {
      trouble = wrong.problems().front().what;
    }
    error = trouble;
    return trouble.empty();
  }
};

}  // namespace

tinygltf::Model load_gltf(const std::filesystem::path& path, const std::string& whole, bool binary,
                          std::vector<std::string>& notes) {
  if (whole.size() > 0xFFFFFFFFULL)
    reject_file(path, "the glTF file is larger than 4 GiB", "split it in several");
  if (json_depth(json_part(whole, binary)) > kDeepestNesting) {
    reject_file(path, "JSON values are nested more than " + std::to_string(kDeepestNesting) + " deep");
  }
  const std::string content = without_pictures(whole, binary);
  BufferFiles buffers{path, {}};
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(buffers.callbacks());
  loader.SetImageLoader([](auto...) { return true; }, nullptr);  // images are accepted unread
  tinygltf::Model model;
  std::string error, warning;
  bool good = false;
  try {
    const auto size = static_cast<unsigned>(content.size());
    const std::string folder = path.parent_path().string();
    good = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                                reinterpret_cast<const unsigned char*>(content.data()), size,
                                                folder)
                  : loader.LoadASCIIFromString(&model, &error, &warning, content.data(), size, folder);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  while (!error.empty() && error.back() == '\n') error.pop_back();
  while (!warning.empty() && warning.back() == '\n') warning.pop_back();
  if (!buffers.trouble.empty())
    reject_file(path, buffers.trouble,
                "put the file beside the glTF file, or export with everything embedded");
  std::replace(warning.begin(), warning.end(), '\n', ' ');
  if (!good) {
    reject_file(path, "cannot read the glTF file: " + (error.empty() ? "tinygltf reports no reason" : error),
                "expected glTF 2.0; export it again");
  }
  if (!warning.empty()) notes.push_back("tinygltf: " + warning);
  for (const tinygltf::Buffer& buffer : model.buffers)
    if (!buffer.uri.empty())
      core::InputRecord::add(path.parent_path() / buffer.uri,
                             {reinterpret_cast<const char*>(buffer.data.data()), buffer.data.size()});
  return model;
}

}  // namespace scintray::mesh
