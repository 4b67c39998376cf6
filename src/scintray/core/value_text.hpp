#pragma once
/// Numbers with a unit as a scene file has them, where their dimension is not known.

#include <charconv>
#include <optional>
#include <string>

namespace scintray::core {

/// A number and the unit as written; no unit for a plain number.
struct ValueText {
  double value = 0.0;
  std::string unit;
};

/// "2 mm" as 2 and "mm"; nothing for text that does not begin with a number.
inline std::optional<ValueText> value_of_text(const std::string& text) {
  ValueText found;
  const char* last = text.data() + text.size();
  const auto [end, status] = std::from_chars(text.data(), last, found.value);
  if (status != std::errc{}) return std::nullopt;
  found.unit.assign(end, last);
  const std::size_t start = found.unit.find_first_not_of(' ');
  found.unit.erase(0, start == std::string::npos ? found.unit.size() : start);
  return found;
}

}  // namespace scintray::core
