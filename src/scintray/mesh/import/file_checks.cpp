#include "scintray/mesh/import/file_checks.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <sstream>
#include <string_view>
#include <system_error>

#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"

namespace scintray::mesh {
namespace {

std::uint32_t little_endian(std::string_view bytes, std::size_t offset, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  }
  return value;
}

/// Non-negative integer at the start of `text`, saturating; false when there is none.
bool read_count(std::string_view text, std::uint64_t& count) {
  std::size_t i = 0;
  while (i < text.size() && (text[i] == ' ' || text[i] == '\t' || text[i] == '+')) ++i;
  if (i == text.size() || std::isdigit(static_cast<unsigned char>(text[i])) == 0) return false;
  count = 0;
  for (; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0; ++i) {
    count = std::min<std::uint64_t>(count * 10 + static_cast<std::uint64_t>(text[i] - '0'), 1ULL << 50);
  }
  return true;
}

void check_count(const std::filesystem::path& path, const std::string& what, std::uint64_t count,
                 std::uint64_t least_bytes_each, const std::string& content) {
  if (count > content.size() / least_bytes_each) {
    reject_file(path,
                "the file announces " + std::to_string(count) + " " + what + " but is only " +
                    std::to_string(content.size()) + " bytes long",
                "the file is cut short or damaged; export it again");
  }
}

void check_stl(const std::filesystem::path& path, const std::string& content) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  // ASCII files begin with "solid", but so do some binary ones; those hold bytes that text does not.
  const std::string_view start(content.data(), std::min<std::size_t>(content.size(), 1000));
  const bool text = std::all_of(start.begin(), start.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 32 || std::isspace(byte) != 0;
  });
  if (text) return;
  if (content.size() < kHeader) {
    reject_file(path,
                "a binary STL has a header of 84 bytes, but the file is " + std::to_string(content.size()) +
                    " bytes long",
                "the file is cut short or damaged; export it again");
  }
  const std::uint64_t triangles = little_endian(content, 80, 4);
  if (kHeader + triangles * kTriangle > content.size()) {
    reject_file(path,
                "the binary STL announces " + std::to_string(triangles) + " triangles, which take " +
                    std::to_string(kHeader + triangles * kTriangle) + " bytes, but the file is " +
                    std::to_string(content.size()) + " bytes long",
                "the file is cut short or damaged; export it again");
  }
}

void check_off(const std::filesystem::path& path, const std::string& content) {
  // The counts follow the keyword (OFF, COFF, ...), possibly without a space; '#' begins a comment.
  const std::size_t keyword = content.find("OFF");
  if (keyword == std::string::npos || keyword > 1000) {
    reject_file(path, "not an OFF file: the keyword OFF is missing", "export the mesh again as OFF");
  }
  std::string counts;
  bool comment = false;
  for (std::size_t i = keyword + 3; i < content.size() && counts.size() < 200; ++i) {
    if (content[i] == '#') comment = true;
    if (content[i] == '\n') comment = false;
    if (!comment) counts.push_back(content[i]);
  }
  std::istringstream stream(counts);
  std::string vertices, faces;
  stream >> vertices >> faces;
  std::uint64_t vertex_count = 0, face_count = 0;
  if (!read_count(vertices, vertex_count) || !read_count(faces, face_count)) {
    reject_file(path, "the OFF file does not begin with its numbers of vertices and faces",
                "expected for example \"OFF\" and then \"8 6 12\"");
  }
  check_count(path, "vertices", vertex_count, 6, content);  // "0 0 0\n"
  check_count(path, "faces", face_count, 2, content);       // "0\n"
}

}  // namespace

std::size_t xml_depth(std::string_view text) {
  std::size_t depth = 0, deepest = 0;
  std::size_t close = 0;  ///< the first ">" after `at`; it moves forward only, so that the cost is linear
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--") || rest.starts_with("<![CDATA[")) {
      at = text.find(rest[2] == '-' ? "-->" : "]]>", at);
      if (at == std::string_view::npos) break;
      continue;
    }
    const char next = rest.size() > 1 ? rest[1] : '\0';
    if (next == '/') {
      if (depth > 0) --depth;
      continue;
    }
    if (next == '!' || next == '?') continue;
    if (close <= at) close = text.find('>', at);
    if (close == std::string_view::npos) break;
    if (text[close - 1] != '/') deepest = std::max(deepest, ++depth);
  }
  return deepest;
}

void reject_file(const std::filesystem::path& path, const std::string& what, const std::string& hint) {
  throw core::InputError(core::Problem{{path.string(), 0, 0}, what, hint});
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string read_mesh_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    reject_file(path, "there is no such file",
                "check the name and the folder; a path that a scene names counts from the scene's folder");
  }
  if (!std::filesystem::is_regular_file(path, error))
    reject_file(path, "this is a folder or device, not a mesh file");
  std::optional<std::string> content = core::read_whole_file(path);
  if (!content) reject_file(path, "the mesh file cannot be read", "check its permissions");
  if (content->empty()) reject_file(path, "the mesh file is empty", "export it again");
  return *std::move(content);
}

std::filesystem::path file_beside(const std::filesystem::path& path, const std::string& name) {
  const auto reject = [&](const std::string& what) {
    reject_file(path, "the file names " + core::in_quotes(name) + ", " + what,
                "put the file beside the mesh file, or export with everything embedded");
  };
  std::error_code error;
  const auto folder =
      std::filesystem::weakly_canonical(path.parent_path().empty() ? "." : path.parent_path(), error);
  const auto there = std::filesystem::weakly_canonical(folder / name, error);  // without links
  if (error || std::filesystem::path(name).is_absolute() ||
      std::mismatch(folder.begin(), folder.end(), there.begin(), there.end()).first != folder.end())
    reject("which is not in its folder or below, and is not opened");
  if (!std::filesystem::exists(there, error)) reject("which does not exist");
  if (!std::filesystem::is_regular_file(there, error)) reject("which is not a file");
  return there;
}

void check_stated_sizes(const std::filesystem::path& path, const std::string& extension,
                        const std::string& content) {
  if (content.starts_with("\xFE\xFF") || content.starts_with("\xFF\xFE"))
    reject_file(path, "the file is text in UTF-16, which is not read", "save it as UTF-8 or ASCII");
  if (extension == ".stl") check_stl(path, content);
  if (extension == ".off") check_off(path, content);
}

std::size_t json_depth(const std::string& text) {
  std::size_t depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if ((c == ']' || c == '}') && depth > 0) --depth;
  }
  return deepest;
}

}  // namespace scintray::mesh
