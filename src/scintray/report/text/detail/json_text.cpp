#include "scintray/report/text/detail/json_text.hpp"

#include <algorithm>

namespace scintray::report {

namespace {

using Json = nlohmann::ordered_json;

std::string on_one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void add(const Json& json, std::size_t depth, std::string& text) {
  const bool plain = !json.is_structured() ||
                     (json.is_array() && std::none_of(json.begin(), json.end(), [](const Json& element) {
                        return element.is_structured();
                      }));
  if (plain || json.empty()) {
    text += on_one_line(json);
    return;
  }
  text += json.is_object() ? '{' : '[';
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    text += (first ? "\n" : ",\n") + std::string(depth + 1, ' ');
    if (json.is_object()) text += on_one_line(key) + ": ";
    add(value, depth + 1, text);
    first = false;
  }
  text += '\n' + std::string(depth, ' ');
  text += json.is_object() ? '}' : ']';
}

}  // namespace

std::string json_text(const Json& json) {
  std::string text;
  add(json, 0, text);
  return text;
}

}  // namespace scintray::report
