#include "scintray/scene_file/criterion.hpp"

namespace scintray::scene_file {

namespace {

bool compares(ClaimQuantity quantity) {
  return quantity == ClaimQuantity::fall_difference || quantity == ClaimQuantity::maximum_ratio ||
         quantity == ClaimQuantity::time_ratio;
}

void read_subject_surface(const config::TomlTable& table, ClaimSpec& claim) {
  claim.surface = {table.string("surface"), table.where("surface")};
  claim.outside = {table.string("outside"), table.where("outside")};
  claim.incidence_rad = table.quantity("incidence", core::Dimension::angle);
}

void read_subject_curves(const config::TomlTable& table, ClaimSpec& claim) {
  claim.curve = {table.string("curve", ""), table.where("curve")};
  claim.over = {table.string("over", ""), table.where("over")};
  const bool two = compares(claim.quantity);
  if (table.good("quantity") && two != table.has("over"))
    table.report("over",
                 "\"" + std::string(config::word_of(kClaimQuantities, claim.quantity)) +
                     (two ? "\" compares two curves" : "\" is of one curve"),
                 two ? "name the second one with over" : "remove over");
}

ClaimSpec read_claim(const config::TomlTable& table) {
  ClaimSpec claim;
  claim.where = table.where();
  claim.text = table.string("text");
  claim.published = table.string("published", "");
  claim.note = table.string("note", "");
  claim.quantity = table.choice("quantity", kClaimQuantities);
  if (is_of_surface(claim.quantity))
    read_subject_surface(table, claim);
  else
    read_subject_curves(table, claim);
  const core::Dimension dimension =
      is_angle(claim.quantity) ? core::Dimension::angle : core::Dimension::dimensionless;
  claim.at_least = table.optional_quantity("at_least", dimension);
  claim.at_most = table.optional_quantity("at_most", dimension);
  if (!claim.at_least && !claim.at_most)
    table.report("at_least", "a claim without bounds cannot fail", "give at_least, at_most, or both");
  return claim;
}

}  // namespace

bool is_of_surface(ClaimQuantity quantity) {
  return is_angle(quantity) || quantity == ClaimQuantity::reflectance ||
         quantity == ClaimQuantity::over_fresnel;
}

bool is_angle(ClaimQuantity quantity) {
  return quantity == ClaimQuantity::mean_slope || quantity == ClaimQuantity::lobe_width;
}

std::vector<ClaimSpec> read_claims(const config::TomlTable& scene) {
  std::vector<ClaimSpec> claims;
  for (const config::TomlTable& table : scene.tables("claim")) claims.push_back(read_claim(table));
  return claims;
}

std::vector<ClaimSpec> claims_of_text(const std::string& text, const std::string& file) {
  core::Problems problems;
  const config::TomlTable root(config::parse_toml(text, file), problems);
  std::vector<ClaimSpec> claims = read_claims(root);
  problems.throw_if_any();
  return claims;
}

}  // namespace scintray::scene_file
