#include "scintray/report/pages/detail/html_document.hpp"

#include <array>
#include <charconv>
#include <cstddef>

#include "scintray/core/sha256.hpp"
#include "scintray/report/detail/embedded_file.hpp"
#include "scintray/report/plots/png_image.hpp"
#include "scintray/report/text/format.hpp"

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

/// The script of pages, with the D3 modules that it uses; empty in a build without them.
std::string_view page_script() {
#ifdef SCINTRAY_PAGE_SCRIPT
  return {scintray_page_script, scintray_page_script_end};
#else
  return {};
#endif
}

/// The policy of a document with the script of pages and others.
std::string content_policy(const std::vector<std::string_view>& others) {
  std::string scripts;
#ifdef SCINTRAY_PAGE_SCRIPT
  scripts += " " + hash_source(SCINTRAY_PAGE_SCRIPT_SHA256);
#endif
  for (const std::string_view script : others) scripts += " " + hash_source(core::sha256(script));
  return "default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; script-src" +
         (scripts.empty() ? " 'none'" : scripts);
}

}  // namespace

std::string_view page_script_style() {
#ifdef SCINTRAY_PAGE_SCRIPT
  return {scintray_page_script_style, scintray_page_script_style_end};
#else
  return {};
#endif
}

std::string html_document(const HtmlDocument& document) {
  std::vector<std::string_view> scripts = document.scripts;
  if (document.page_script && !page_script().empty()) scripts.push_back(page_script());
  std::string elements;
  for (const std::string_view script : scripts)
    elements.append("<script>").append(script).append("</script>\n");
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
         content_policy(document.scripts) +
         "\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
         escape_html(document.title) + "</title>\n<style>" + document.style + "</style>\n</head>\n<body>\n" +
         document.body + elements + "</body>\n</html>\n";
}

}  // namespace scintray::report
