#include "scintray/mesh/import/detail/step_isolation.hpp"

#include <array>
#include <cstring>
#include <type_traits>

#include "scintray/core/error.hpp"

namespace scintray::mesh {
namespace {

class ByteWriter {
 public:
  template <typename Value>
  requires std::is_arithmetic_v<Value>
  void put(Value value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(const std::string& text) {
    put(text.size());
    bytes += text;
  }
  void put(const core::Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) put(v[axis]);
  }
  void put(const std::array<std::uint32_t, 3>& triangle) {
    for (const std::uint32_t vertex : triangle) put(vertex);
  }
  void put(const SupportSurface& surface) {
    put(surface.origin.vec());
    put(surface.axis.vec());
    for (const double number : {surface.axial, surface.slope, surface.radius2, surface.major}) put(number);
  }
  void put(const FaceTags& tags) {
    put(tags.size());
    for (const auto& [key, value] : tags) {
      put(key);
      put(value);
    }
  }
  template <typename Element>
  void put(const std::vector<Element>& list) {
    put(list.size());
    for (const Element& element : list) put(element);
  }

  std::string bytes;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename Value>
  requires std::is_arithmetic_v<Value>
  void get(Value& value) { std::memcpy(&value, take(sizeof value).data(), sizeof value); }
  void get(std::string& text) { text = take(size()); }
  void get(core::Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) get(v[axis]);
  }
  void get(std::array<std::uint32_t, 3>& triangle) {
    for (std::uint32_t& vertex : triangle) get(vertex);
  }
  void get(SupportSurface& surface) {
    core::Vec3 origin, axis;
    get(origin);
    get(axis);
    surface.origin = origin;
    surface.axis = axis;
    for (double* number : {&surface.axial, &surface.slope, &surface.radius2, &surface.major}) get(*number);
  }
  void get(FaceTags& tags) {
    for (std::size_t left = size(); left > 0; --left) {
      std::string key;
      get(key);
      get(tags[key]);
    }
  }
  template <typename Element>
  void get(std::vector<Element>& list) {
    // Every element takes a byte or more, so a count above the rest cannot be true.
    const std::size_t count = size();
    if (count > bytes_.size()) throw core::InternalError("a mesh from another process was truncated");
    list.resize(count);
    for (Element& element : list) get(element);
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::size_t size() {
    std::size_t value = 0;
    get(value);
    return value;
  }
  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) throw core::InternalError("a mesh from another process was truncated");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  std::string_view bytes_;
};

/// One list of the members for writing and reading.
template <typename Raw, typename Action>
void for_each_member(Raw& raw, Action action) {
  action(raw.mesh.vertices);
  action(raw.mesh.triangles);
  action(raw.mesh.group);
  action(raw.mesh.groups);
  action(raw.mesh.group_tags);
  action(raw.mesh.supports);
  action(raw.mesh.support);
  action(raw.unit.name);
  action(raw.unit.mm);
  action(raw.unit.written);
  action(raw.unit.read_mm);
  action(raw.notes);
  action(raw.bodies);
  action(raw.body_of);
  action(raw.points_and_lines);
  action(raw.crossing_polygons);
  action(raw.deviation_mm);
}

}  // namespace

std::string to_bytes(const RawMesh& raw) {
  ByteWriter writer;
  for_each_member(raw, [&writer](const auto& member) { writer.put(member); });
  return std::move(writer.bytes);
}

RawMesh from_bytes(std::string_view bytes) {
  ByteReader reader(bytes);
  RawMesh raw;
  for_each_member(raw, [&reader](auto& member) { reader.get(member); });
  if (!reader.at_end()) throw core::InternalError("a mesh from another process has bytes after its end");
  return raw;
}

}  // namespace scintray::mesh
