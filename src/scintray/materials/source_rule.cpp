#include "scintray/materials/source_rule.hpp"

namespace scintray::materials {

void read_source(const config::TomlTable& block, SourceRule rule, std::vector<std::string>& sources) {
  const std::string prefix = block.path().empty() ? "" : block.path() + ": ";
  if (const std::optional<std::string> source = block.optional_string("source")) {
    sources.push_back(prefix + *source);
  } else if (rule == SourceRule::required && !block.has("source")) {
    block.report("source",
                 (block.path().empty() ? "the file" : "[" + block.path() + "]") +
                     " does not say where its numbers were published",
                 "add source = \"author or maker, year, table or figure, DOI\", or \"assumed: why\"");
  }
}

}  // namespace scintray::materials
