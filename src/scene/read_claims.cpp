#include <array>
#include <utility>

#include "scintray/scene/claim_spec.hpp"

namespace scintray {

namespace {

constexpr std::array kQuantities{std::pair{"range", ClaimQuantity::range},
                                 std::pair{"fall", ClaimQuantity::fall},
                                 std::pair{"fall_difference", ClaimQuantity::fall_difference},
                                 std::pair{"light", ClaimQuantity::light},
                                 std::pair{"maximum_ratio", ClaimQuantity::maximum_ratio},
                                 std::pair{"resolution", ClaimQuantity::resolution},
                                 std::pair{"time_ratio", ClaimQuantity::time_ratio}};

bool compares(ClaimQuantity quantity) {
  return quantity == ClaimQuantity::fall_difference || quantity == ClaimQuantity::maximum_ratio ||
         quantity == ClaimQuantity::time_ratio;
}

ClaimSpec read_claim(const TomlTable& table) {
  ClaimSpec claim;
  claim.where = table.where();
  claim.text = table.string("text");
  claim.published = table.string("published", "");
  claim.note = table.string("note", "");
  std::vector<std::string> words;
  for (const auto& [word, quantity] : kQuantities) words.emplace_back(word);
  const std::string chosen = table.choice("quantity", words);
  for (const auto& [word, quantity] : kQuantities)
    if (chosen == word) claim.quantity = quantity;
  claim.curve = {table.string("curve", ""), table.where("curve")};
  claim.over = {table.string("over", ""), table.where("over")};
  const bool two = compares(claim.quantity);
  if (table.good("quantity") && two != table.has("over"))
    table.report("over", "\"" + chosen + (two ? "\" compares two curves" : "\" is of one curve"),
                 two ? "name the second one with over" : "remove over");
  claim.at_least = table.optional_quantity("at_least", Dimension::dimensionless);
  claim.at_most = table.optional_quantity("at_most", Dimension::dimensionless);
  if (!claim.at_least && !claim.at_most)
    table.report("at_least", "a claim without bounds cannot fail", "give at_least, at_most, or both");
  return claim;
}

}  // namespace

std::vector<ClaimSpec> read_claims(const TomlTable& scene) {
  std::vector<ClaimSpec> claims;
  for (const TomlTable& table : scene.tables("claim")) claims.push_back(read_claim(table));
  return claims;
}

std::vector<ClaimSpec> claims_of_text(const std::string& text, const std::string& file) {
  Problems problems;
  const TomlTable root(parse_toml(text, file), problems);
  std::vector<ClaimSpec> claims = read_claims(root);
  problems.throw_if_any();
  return claims;
}

}  // namespace scintray
