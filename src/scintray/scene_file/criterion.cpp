#include "scintray/scene_file/criterion.hpp"

namespace scintray::scene_file {

namespace {

bool compares(CriterionQuantity quantity) {
  return quantity == CriterionQuantity::fall_difference || quantity == CriterionQuantity::maximum_ratio ||
         quantity == CriterionQuantity::time_ratio;
}

void read_subject_surface(const config::TomlTable& table, CriterionSpec& criterion) {
  criterion.surface = {table.string("surface"), table.where("surface")};
  criterion.outside = {table.string("outside"), table.where("outside")};
  criterion.incidence_rad = table.quantity("incidence", core::Dimension::angle);
}

void read_subject_curves(const config::TomlTable& table, CriterionSpec& criterion) {
  criterion.curve = {table.string("curve", ""), table.where("curve")};
  criterion.over = {table.string("over", ""), table.where("over")};
  const bool two = compares(criterion.quantity);
  if (table.good("quantity") && two != table.has("over"))
    table.report("over",
                 "\"" + std::string(core::word_of(kCriterionQuantities, criterion.quantity)) +
                     (two ? "\" compares two curves" : "\" is of one curve"),
                 two ? "name the second one with over" : "remove over");
}

CriterionSpec read_criterion(const config::TomlTable& table) {
  CriterionSpec criterion;
  criterion.where = table.where();
  criterion.text = table.string("text");
  criterion.published = table.string("published", "");
  criterion.note = table.string("note", "");
  criterion.quantity = table.choice("quantity", kCriterionQuantities);
  if (is_of_surface(criterion.quantity))
    read_subject_surface(table, criterion);
  else
    read_subject_curves(table, criterion);
  const core::Dimension dimension =
      is_angle(criterion.quantity) ? core::Dimension::angle : core::Dimension::dimensionless;
  criterion.at_least = table.optional_quantity("at_least", dimension);
  criterion.at_most = table.optional_quantity("at_most", dimension);
  if (!criterion.at_least && !criterion.at_most)
    table.report("at_least", "a [[claim]] without bounds cannot fail", "give at_least, at_most, or both");
  return criterion;
}

}  // namespace

bool is_of_surface(CriterionQuantity quantity) {
  return is_angle(quantity) || quantity == CriterionQuantity::reflectance ||
         quantity == CriterionQuantity::over_fresnel;
}

bool is_angle(CriterionQuantity quantity) {
  return quantity == CriterionQuantity::mean_slope || quantity == CriterionQuantity::lobe_width;
}

std::vector<CriterionSpec> read_criteria(const config::TomlTable& scene) {
  std::vector<CriterionSpec> criteria;
  for (const config::TomlTable& table : scene.tables("claim")) criteria.push_back(read_criterion(table));
  return criteria;
}

std::vector<CriterionSpec> criteria_of_text(const std::string& text, const std::string& file) {
  core::Problems problems;
  const config::TomlTable root(config::parse_toml(text, file), problems);
  std::vector<CriterionSpec> criteria = read_criteria(root);
  problems.throw_if_any();
  return criteria;
}

}  // namespace scintray::scene_file
