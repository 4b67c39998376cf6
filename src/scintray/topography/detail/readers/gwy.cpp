/// Gwyddion's own format, http://gwyddion.net/documentation/user-guide-en/gwyfile-format.html,
/// version 2 ("GWYP") and, as found in files, version 1 ("GWYO"), whose container differs only in
/// that a GLib type number stands before each key.
///
/// Numbers are in base units whatever prefix the unit's text has: the description states that
/// prefixes are ignored, and files with xreal = 8e-05 and "µm" for 80 um exist.

#include <cmath>
#include <map>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/bytes.hpp"
#include "scintray/topography/detail/readers/channels.hpp"
#include "scintray/topography/detail/readers/formats.hpp"

namespace scintray::topography {

namespace {

/// One component: a text, an object's content, or the place of a number or array.
struct Component {
  char type = 0;
  std::string_view text;     ///< of 's'; the class name of 'o'
  std::string_view content;  ///< bytes of the value; of 'o' without its class name and size
  std::size_t count = 0;     ///< elements of an array
  std::size_t place = 0;     ///< of `content` in the file
};

std::size_t element_size(char type, const Bytes& bytes) {
  switch (type) {
    case 'b':
    case 'c':
    case 'C':
      return 1;
    case 'i':
    case 'I':
      return 4;
    case 'q':
    case 'Q':
    case 'd':
    case 'D':
      return 8;
    default:
      throw core::InputError({{bytes.file()},
                              "component of type " + core::in_quotes(std::string(1, type)) + " at byte " +
                                  std::to_string(bytes.place()) +
                                  "; expected one of b c i q d s o C I Q D S O",
                              "the file is damaged"});
  }
}

Component take_object(Bytes& bytes) {
  Component object{'o', {}, {}, 0, 0};
  object.text = bytes.take_string();
  const auto size = bytes.take<std::uint32_t>();
  object.place = bytes.place();
  object.content = bytes.take_view(size);
  return object;
}

Component take_value(Bytes& bytes, char type) {
  Component value{type, {}, {}, 1, bytes.place()};
  if (type == 's') {
    value.text = bytes.take_string();
    return value;
  }
  if (type == 'o') return take_object(bytes);
  if (type >= 'A' && type <= 'Z') value.count = bytes.take<std::uint32_t>();
  value.place = bytes.place();
  if (type == 'S' || type == 'O') {
    for (std::size_t k = 0; k < value.count; ++k)
      type == 'S' ? void(bytes.take_string()) : void(take_object(bytes));
    return value;
  }
  value.content = bytes.take_view(value.count * element_size(type, bytes));
  return value;
}

using Components = std::map<std::string, Component, std::less<>>;

Components take_components(Bytes bytes) {
  Components result;
  while (bytes.left() > 0) {
    std::string name(bytes.take_string());
    const char type = bytes.take<char>();
    result[std::move(name)] = take_value(bytes, type);
  }
  return result;
}

/// The container of version 1. GLib's fundamental types are multiples of four (gtype.h).
Components take_old_container(Bytes bytes) {
  static const std::map<std::uint32_t, char> kTypes{
      {3 << 2, 'c'},  {4 << 2, 'c'},  {5 << 2, 'b'},  {6 << 2, 'i'},  {7 << 2, 'i'},
      {10 << 2, 'q'}, {11 << 2, 'q'}, {15 << 2, 'd'}, {16 << 2, 's'}, {20 << 2, 'o'}};
  Components result;
  while (bytes.left() > 0) {
    const std::size_t place = bytes.place();
    const auto type = kTypes.find(bytes.take<std::uint32_t>());
    if (type == kTypes.end())
      throw core::InputError({{bytes.file()},
                              "unknown type of a component at byte " + std::to_string(place),
                              "the file is damaged; open it in Gwyddion and save it again"});
    std::string name(bytes.take_string());
    result[std::move(name)] = take_value(bytes, type->second);
  }
  return result;
}

/// A part of the file: its container's components, or those of an object inside.
struct Reader {
  const std::string& file;

  const Component* find(const Components& in, std::string_view name, char type) const {
    const auto found = in.find(name);
    if (found == in.end()) return nullptr;
    if (found->second.type == type) return &found->second;
    throw core::InputError({{file},
                            "component " + core::in_quotes(name) + " has the type " +
                                core::in_quotes(std::string(1, found->second.type)) + "; expected " +
                                core::in_quotes(std::string(1, type)),
                            "the file is damaged"});
  }

  Components components(const Component& object) const {
    return take_components(Bytes(object.content, file, object.place));
  }

  template <class T>
  T number(const Components& in, std::string_view name, char type) const {
    const Component* found = find(in, name, type);
    if (!found)
      throw core::InputError(
          {{file}, "a data field without " + core::in_quotes(name), "the file is damaged"});
    return Bytes(found->content, file, found->place).take<T>();
  }

  /// Text of a GwySIUnit; empty when there is none.
  std::string unit(const Components& field, std::string_view name) const {
    const Component* object = find(field, name, 'o');
    if (!object) return {};
    const Components inside = components(*object);
    const Component* text = find(inside, "unitstr", 's');
    return text ? std::string(text->text) : std::string();
  }
};

/// The number N of a key "/N/data"; empty for other keys.
std::optional<long> field_number(std::string_view key) {
  constexpr std::string_view kEnd = "/data";
  if (!key.starts_with('/') || !key.ends_with(kEnd) || key.size() <= kEnd.size() + 1) return std::nullopt;
  long number = 0;
  for (const char c : key.substr(1, key.size() - kEnd.size() - 1)) {
    if (c < '0' || c > '9' || number > 1000000) return std::nullopt;
    number = 10 * number + (c - '0');
  }
  return number;
}

struct Field {
  std::string key;  ///< "/N"
  Components parts;
  ChannelInfo info;
};

std::vector<Field> data_fields(const Components& container, const Reader& reader) {
  std::map<long, Field> fields;
  for (const auto& [key, component] : container) {
    const auto number = field_number(key);
    if (!number || component.type != 'o' || component.text != "GwyDataField") continue;
    Field field{"/" + std::to_string(*number), reader.components(component), {}};
    if (const Component* title = reader.find(container, key + "/title", 's'))
      field.info.name = std::string(title->text);
    field.info.unit = reader.unit(field.parts, "si_unit_z");
    field.info.length = length_unit_um(field.info.unit).has_value();
    fields[*number] = std::move(field);
  }
  std::vector<Field> result;
  for (auto& [number, field] : fields) result.push_back(std::move(field));
  return result;
}

double pitch_um(const Reader& reader, const Components& field, const char* name, std::uint32_t points) {
  const auto extent = reader.number<double>(field, name, 'd');
  if (!(extent > 0.0) || !std::isfinite(extent * kUmPerMetre))
    throw core::InputError({{reader.file},
                            "component \"" + std::string(name) + "\" is " + std::to_string(extent) +
                                "; expected a positive size",
                            "the file is damaged"});
  return extent * kUmPerMetre / points;
}

void read_field(const Reader& reader, const Components& field, RawMap& map) {
  const auto columns = reader.number<std::int32_t>(field, "xres", 'i');
  const auto rows = reader.number<std::int32_t>(field, "yres", 'i');
  const Component* data = reader.find(field, "data", 'D');
  if (!data) throw core::InputError({{reader.file}, "a data field without \"data\"", "the file is damaged"});
  const std::size_t points = checked_points(columns, rows, data->content.size(), sizeof(double), reader.file);
  if (points != data->count)
    throw core::InputError({{reader.file},
                            std::to_string(data->count) + " heights; expected " + std::to_string(columns) +
                                " x " + std::to_string(rows),
                            "the file is damaged"});
  map.columns = static_cast<std::uint32_t>(columns);
  map.rows = static_cast<std::uint32_t>(rows);
  map.values = decode_samples(data->content, SampleType::float64);
  const double pitch_x = pitch_um(reader, field, "xreal", map.columns);
  const double pitch_y = pitch_um(reader, field, "yreal", map.rows);
  map.pitch_ratio = pitch_y / pitch_x;
  if (length_unit_um(reader.unit(field, "si_unit_xy"))) {
    map.pitch_x_um = pitch_x;
    map.pitch_y_um = pitch_y;
  }
}

/// The meaning of a mask is up to the user: points to leave out, grains, or a scratch to examine.
void read_mask(const Reader& reader, const Component& mask, bool marks_missing, RawMap& map) {
  if (!marks_missing) {
    map.notes.push_back("the mask in the file was not applied");
    return;
  }
  const Components parts = reader.components(mask);
  const Component* data = reader.find(parts, "data", 'D');
  if (!data || data->count != map.values.size()) return;
  Bytes bytes(data->content, reader.file, data->place);
  for (double& value : map.values)
    if (bytes.take<double>() != 0.0) value = std::nan("");
}

RawMap parse(std::string_view content, const ReadRequest& request, bool masks_mark_missing) {
  constexpr std::size_t kMagicSize = 4;
  const Reader reader{request.file};
  Bytes bytes(content, request.file);
  const bool old = bytes.take_view(kMagicSize) == "GWYO";
  const Component root = take_object(bytes);
  if (root.text != "GwyContainer")
    throw core::InputError(
        {{request.file},
         "the file holds a " + core::in_quotes(root.text) + "; expected a \"GwyContainer\"",
         "the file is damaged"});
  const Bytes inside(root.content, request.file, root.place);
  const Components container = old ? take_old_container(inside) : take_components(inside);
  const std::vector<Field> fields = data_fields(container, reader);
  std::vector<ChannelInfo> channels;
  for (const Field& field : fields) channels.push_back(field.info);
  const ChosenChannel chosen = choose_channel(channels, request);
  const Field& field = fields[chosen.index];
  RawMap map;
  map.format = old ? "Gwyddion 1" : "Gwyddion";
  map.title = field.info.name;
  take_channel(map, chosen, field.info);
  if (field.info.length) map.height_unit_um = kUmPerMetre;
  read_field(reader, field.parts, map);
  if (const Component* mask = reader.find(container, field.key + "/mask", 'o'))
    read_mask(reader, *mask, masks_mark_missing, map);
  return map;
}

}  // namespace

bool is_gwy(std::string_view content) { return content.starts_with("GWYP") || content.starts_with("GWYO"); }

RawMap parse_gwy(std::string_view content, const ReadRequest& request) {
  return parse(content, request, false);
}

RawMap parse_converted_gwy(std::string_view content, const ReadRequest& request) {
  return parse(content, request, true);
}

}  // namespace scintray::topography
