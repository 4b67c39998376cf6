#pragma once
/// Pages and the scripts in them, apart.

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace scintray::test {

/// A page without the contents of its scripts, and these: data (JSON) and code.
struct PageScripts {
  std::string page;
  std::vector<std::string> data, code;
};

inline PageScripts scripts_of(const std::string& page) {
  PageScripts scripts;
  std::size_t done = 0;
  for (std::size_t at = page.find("<script"); at != std::string::npos; at = page.find("<script", done)) {
    const std::size_t begin = page.find('>', at) + 1, end = page.find("</script>", begin);
    const std::string tag = page.substr(at, begin - at);
    const bool json = tag.find("type=\"application/json\"") != std::string::npos;
    CHECK((json || tag == "<script>"));
    (json ? scripts.data : scripts.code).push_back(page.substr(begin, end - begin));
    scripts.page += page.substr(done, begin - done);
    done = end;
  }
  scripts.page += page.substr(done);
  return scripts;
}

}  // namespace scintray::test
