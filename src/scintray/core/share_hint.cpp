#include "scintray/core/share_hint.hpp"

#include <array>
#include <charconv>

namespace scintray::core {

std::string share_hint(double value) {
  std::array<char, 32> digits{};
  const auto text = [&digits](double number) {
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, 6)
            .ptr;
    return std::string(digits.data(), end);
  };
  if (value > 1.0 && value <= 100.0)
    return "per cent carry their sign: write \"" + text(value) + " %\", or " + text(0.01 * value);
  return "write a share, as 0.97, or per cent, as \"97 %\"";
}

}  // namespace scintray::core
