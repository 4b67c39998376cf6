#include <array>
#include <charconv>
#include <cstddef>

#include "scintray/report/detail/embedded_file.hpp"
#include "scintray/report/pages/detail/page_script.hpp"
#include "scintray/report/plots/png_image.hpp"

#ifdef SCINTRAY_PAGE_SCRIPT
SCINTRAY_EMBED(scintray_page_script, SCINTRAY_PAGE_SCRIPT);
SCINTRAY_EMBED(scintray_page_script_style, SCINTRAY_PAGE_SCRIPT_STYLE);
#endif

namespace scintray::report {

namespace {

/// "'sha256-...'" of the hash in hexadecimal digits (Content Security Policy Level 3, section 2.3.1).
std::string hash_source(std::string_view hex) {
  std::array<std::byte, 32> hash{};
  for (std::size_t i = 0; i < hash.size(); ++i) {
    unsigned value = 0;
    std::from_chars(hex.data() + 2 * i, hex.data() + 2 * i + 2, value, 16);
    hash[i] = static_cast<std::byte>(value);
  }
  return "'sha256-" + base64(hash) + "'";
}

}  // namespace

std::string_view page_script() {
#ifdef SCINTRAY_PAGE_SCRIPT
  return {scintray_page_script, scintray_page_script_end};
#else
  return {};
#endif
}

std::string_view page_script_style() {
#ifdef SCINTRAY_PAGE_SCRIPT
  return {scintray_page_script_style, scintray_page_script_style_end};
#else
  return {};
#endif
}

std::string content_policy(std::string_view more) {
  constexpr std::size_t kDigits = 64;
  std::string scripts;
#ifdef SCINTRAY_PAGE_SCRIPT
  scripts += " " + hash_source(SCINTRAY_PAGE_SCRIPT_SHA256);
#endif
  for (std::size_t at = 0; at + kDigits <= more.size(); at += kDigits + 1)
    scripts += " " + hash_source(more.substr(at, kDigits));
  return "default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; script-src" +
         (scripts.empty() ? " 'none'" : scripts);
}

}  // namespace scintray::report
