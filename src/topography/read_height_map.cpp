#include <zlib.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "scintray/core/error.hpp"
#include "scintray/topography/height_map.hpp"
#include "scintray/topography/raw_map.hpp"

namespace scintray {

namespace {

/// Largest uncompressed height map that is read: 16,384 x 16,384 points in single precision.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

std::string file_content(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError({{path.string()}, "no such file; expected a height map", ""});
  if (std::filesystem::file_size(path) > kMostBytes)
    throw InputError({{path.string()}, "file larger than 1 GiB; expected a height map", "crop the map"});
  std::ifstream file(path, std::ios::binary);
  std::string content((std::istreambuf_iterator<char>(file)), {});
  if (!file) throw SystemError("cannot read " + path.string());
  return content;
}

std::string gunzip(const std::string& packed, const std::string& file) {
  z_stream stream{};
  constexpr int kGzipOnly = 15 + 16;
  if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw SystemError("cannot start zlib");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string content, part(1 << 16, '\0');
  int state = Z_OK;
  while (state == Z_OK && content.size() <= kMostBytes) {
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    state = inflate(&stream, Z_NO_FLUSH);
    content.append(part, 0, part.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (content.size() > kMostBytes)
    throw InputError({{file}, "more than 1 GiB when unpacked; expected a height map", "crop the map"});
  if (state != Z_STREAM_END) throw InputError({{file}, "damaged or truncated gzip data", ""});
  return content;
}

RawMap parse(const std::string& content, const std::string& file) {
  if (content.empty()) throw InputError({{file}, "the file is empty; expected a height map", ""});
  if (is_gsf(content)) return parse_gsf(content, file);
  if (content.starts_with("GWYP") || content.starts_with("GWYO") ||
      content.substr(0, 4096).find('\0') != std::string::npos)
    throw InputError({{file},
                      "binary data of an unknown format; expected .gsf or a text matrix",
                      "export the height channel from Gwyddion as simple field (.gsf)"});
  return parse_text_map(content, file);
}

void apply(const ReadOptions& options, RawMap& map, const std::string& file) {
  Problems problems;
  const auto positive = [&](const std::optional<double>& value, const std::string& name) {
    if (value && !(*value > 0.0 && std::isfinite(*value)))
      problems.add({file}, name + " is " + std::to_string(*value) + "; expected a positive length");
  };
  positive(options.pitch_um, "pitch");
  positive(options.width_um, "width");
  positive(options.height_unit_um, "height unit");
  if (options.pitch_um && options.width_um)
    problems.add({file}, "both pitch and width are given", "give one of them");
  if (options.pitch_um) map.pitch_x_um = map.pitch_y_um = options.pitch_um;
  if (options.width_um) map.pitch_x_um = map.pitch_y_um = *options.width_um / map.columns;
  if (options.height_unit_um) map.height_unit_um = options.height_unit_um;
  if (!map.pitch_x_um || !map.pitch_y_um)
    problems.add({file}, "the file gives no lateral size in a unit of length",
                 "give it: --pitch \"0.175 um\" or --width \"90 um\"");
  if (!map.height_unit_um)
    problems.add({file}, "the file gives no unit of length for heights", "give it: --unit um");
  problems.throw_if_any();
}

void require_all_pixels(const RawMap& map, const std::string& file) {
  std::size_t missing = 0, first = 0;
  for (std::size_t k = 0; k < map.values.size(); ++k)
    if (!std::isfinite(map.values[k]) && missing++ == 0) first = k;
  if (missing > 0)
    throw InputError({{file},
                      std::to_string(missing) + " pixels have no height, the first at column " +
                          std::to_string(first % map.columns + 1) + ", row " +
                          std::to_string(first / map.columns + 1) + "; expected finite numbers",
                      "fill or crop them, for example in Gwyddion"});
}

std::string shortest(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string file = path.string();
  std::string content = file_content(path);
  if (content.starts_with("\x1F\x8B")) content = gunzip(content, file);
  RawMap raw = parse(content, file);
  apply(options, raw, file);
  require_all_pixels(raw, file);

  HeightMap map;
  map.columns = raw.columns;
  map.rows = raw.rows;
  map.pitch_x_um = *raw.pitch_x_um;
  map.pitch_y_um = *raw.pitch_y_um;
  map.title = raw.title;
  map.periodic = options.periodic;
  map.heights_um = std::move(raw.values);
  for (double& height : map.heights_um) height *= *raw.height_unit_um;
  map.steps.push_back("read " + path.filename().string() + " (" + raw.format + "), " +
                      std::to_string(map.columns) + " x " + std::to_string(map.rows) + " points, pitch " +
                      shortest(map.pitch_x_um) + " x " + shortest(map.pitch_y_um) + " um");
  return map;
}

}  // namespace scintray
