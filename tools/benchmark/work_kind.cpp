#include "work_kind.hpp"

#include <cctype>
#include <optional>

namespace scintray::bench {

namespace {

/// Sources, as the paths that includes have and without their suffix, and the kind of their work. The first
/// that a path begins with counts. What is missing here does the work of its caller.
constexpr core::Word<WorkKind> kSources[] = {
    {"scintray/core/philox", WorkKind::random},
    {"scintray/core/rng", WorkKind::random},
    {"scintray/core/xoroshiro", WorkKind::random},
    {"scintray/core/elementary", WorkKind::elementary},
    {"scintray/scene/accelerator", WorkKind::ray_query},
    {"scintray/scene/", WorkKind::propagation},
    {"scintray/core/in_order", WorkKind::other},
    {"scintray/transport/", WorkKind::propagation},
    {"scintray/optics/", WorkKind::surface},
    {"scintray/source/", WorkKind::emission},
    {"scintray/tally/event_tally", WorkKind::readout},
    {"scintray/tally/readout_channels", WorkKind::readout},
    {"scintray/tally/", WorkKind::tally},
    {"scintray/detector/", WorkKind::readout},
    {"scintray/simulation/", WorkKind::other},
};

/// Libraries by the beginning of their file's name.
constexpr core::Word<WorkKind> kLibraries[] = {
    {"libembree", WorkKind::ray_query},
    {"libm.", WorkKind::elementary},
    {"libm-", WorkKind::elementary},
    {"libmvec", WorkKind::elementary},
};

template <std::size_t N>
std::optional<WorkKind> find_beginning(const core::Word<WorkKind> (&words)[N], const std::string& text) {
  for (const core::Word<WorkKind>& known : words)
    if (text.starts_with(known.word)) return known.value;
  return std::nullopt;
}

/// "double scintray::core::Rng::uniform()" as "scintray/core/rng/uniform": without the type of the result,
/// which ends at the last space, template arguments, and the arguments from the first parenthesis on.
std::string path_of_function(std::string function) {
  const std::string unnamed = "(anonymous namespace)::";
  for (std::size_t at = 0; (at = function.find(unnamed)) != std::string::npos;)
    function.erase(at, unnamed.size());
  std::string path;
  int depth = 0;
  for (const char c : function) {
    if (c == '(') break;
    depth += c == '<' ? 1 : 0;
    if (c == ' ' && depth == 0) path.clear();
    if (c == ':' && depth == 0 && !path.empty() && path.back() != '/')
      path += '/';
    else if (c != ':' && c != ' ' && depth == 0)
      path += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    depth -= c == '>' ? 1 : 0;
  }
  return path;
}

/// "/somewhere/src/scintray/optics/fresnel.hpp" as "scintray/optics/fresnel.hpp"; empty for others' files.
std::string path_of_file(const std::string& file) {
  const std::size_t at = file.rfind("src/scintray/");
  return at == std::string::npos ? "" : file.substr(at + 4);
}

}  // namespace

WorkKind kind_of_library(const std::string& library) {
  return find_beginning(kLibraries, library).value_or(WorkKind::other);
}

WorkKind kind_of_code(const std::vector<CodeFrame>& frames) {
  for (const CodeFrame& frame : frames) {
    const std::string path = frame.file.empty() ? path_of_function(frame.function) : path_of_file(frame.file);
    if (const auto kind = find_beginning(kSources, path)) return *kind;
  }
  return WorkKind::other;
}

}  // namespace scintray::bench
