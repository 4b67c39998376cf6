#include "scintray/scene_file/fit.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <set>

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

constexpr std::uint64_t kRays = 100'000;

constexpr core::Word<bool> kFromInside[] = {{"inside", true}, {"outside", false}};
constexpr core::Word<bool> kFreeScale[] = {{"fixed", false}, {"free", true}};
constexpr core::Word<bool> kErrorsFromScatter[] = {{"measured", false}, {"from_scatter", true}};

/// A number with its unit, as written.
struct Written {
  double value = 0.0;
  std::string unit;
};

std::optional<Written> number_and_unit(const config::TomlNode& node) {
  if (node.kind == Kind::integer || node.kind == Kind::number) return Written{node.number, ""};
  if (node.kind != Kind::string) return std::nullopt;
  Written result;
  const char* last = node.text.data() + node.text.size();
  const auto [end, status] = std::from_chars(node.text.data(), last, result.value);
  if (status != std::errc{} || !std::isfinite(result.value)) return std::nullopt;
  result.unit.assign(end, last);
  const auto first = result.unit.find_first_not_of(' ');
  result.unit.erase(0, first);
  return result;
}

/// A value in the form of a scene file: a plain number, or a string with its unit.
config::TomlNode value_node(double value, const std::string& unit, const core::FileLocation& where) {
  config::TomlNode node;
  node.where = node.key_where = where;
  node.text = fmt::format("{}", value);
  if (unit.empty()) {
    node.kind = Kind::number;
    node.number = value;
  } else {
    node.kind = Kind::string;
    node.text += " " + unit;
  }
  return node;
}

/// Start, low or high of a parameter, whose unit is that of the start.
double read_limit(const config::TomlTable& table, const std::string& key,
                  const std::optional<std::string>& unit, std::string* its_unit = nullptr) {
  const config::TomlNodePtr node = table.take(key);
  if (!node) {
    table.report(key, fmt::format("[[fit.parameter]] has no \"{}\", which is needed", key),
                 "add start, low and high, as \"12 deg\" or 0.95");
    return 0.0;
  }
  const auto value = number_and_unit(*node);
  if (!value) {
    table.report(key, fmt::format("{} is not a number with its unit", node->as_written()),
                 "write it as \"12 deg\", or 0.95 where the key takes a plain number");
    return 0.0;
  }
  if (unit)
    table.expect(key, value->unit == *unit,
                 fmt::format("\"{}\" is in {}, but \"start\" is in {}", key,
                             value->unit.empty() ? "no unit" : "\"" + value->unit + "\"",
                             unit->empty() ? "no unit" : "\"" + *unit + "\""),
                 "write start, low and high in one unit");
  if (its_unit) *its_unit = value->unit;
  return value->value;
}

KeyPath read_path(const config::TomlTable& table, const std::string& key, const std::string& role) {
  KeyPath path;
  path.key = table.string(key);
  path.where = table.where(key);
  path.role = role;
  table.expect(key, may_be_set(path.key),
               "\"" + path.key + "\" says nothing of the scene and cannot be set here",
               "name a key of the scene, as surfaces.wrapped.reflectance");
  return path;
}

/// Inverse for lengths of absorption and scattering, as far as their bounds are above 0.
FitVariable usual_variable(const FitParameterSpec& parameter) {
  const std::string& key = parameter.path.key;
  const bool is_path = key.ends_with("absorption.length") || key.ends_with("scattering.length");
  return is_path && parameter.low > 0.0 ? FitVariable::inverse : FitVariable::value;
}

FitParameterSpec read_parameter(const config::TomlTable& table) {
  FitParameterSpec parameter;
  parameter.path = read_path(table, "key", "fitted key");
  parameter.path.also = table.strings("also", 0, false);
  parameter.label = table.string("label", parameter.path.key);
  parameter.where = table.where("start");
  std::string unit;
  parameter.start = read_limit(table, "start", std::nullopt, &unit);
  parameter.unit = unit;
  parameter.low = read_limit(table, "low", unit);
  parameter.high = read_limit(table, "high", unit);
  if (table.good("start") && table.good("low") && table.good("high")) {
    table.expect(
        "high", parameter.low < parameter.high,
        fmt::format("\"high\" is {:g}, which is not above \"low\" at {:g}", parameter.high, parameter.low));
    table.expect("start", parameter.low < parameter.start && parameter.start < parameter.high,
                 fmt::format("the start, {:g}, does not lie between low, {:g}, and high, {:g}",
                             parameter.start, parameter.low, parameter.high),
                 "start within the bounds, not on them: the search begins there");
  }
  parameter.variable = table.choice("variable", kFitVariables, usual_variable(parameter));
  table.expect(
      "variable", parameter.variable == FitVariable::value || parameter.low > 0.0,
      fmt::format("the inverse of {} is fitted, but \"low\" is {:g}", parameter.label, parameter.low),
      "give a low above 0, or write variable = \"value\"");
  return parameter;
}

std::vector<FitParameterSpec> read_parameters(const config::TomlTable& fit) {
  std::vector<FitParameterSpec> parameters;
  std::set<std::string> keys;
  for (const config::TomlTable& table : fit.tables("parameter")) {
    FitParameterSpec parameter = read_parameter(table);
    std::vector<std::string> set = parameter.path.also;
    set.push_back(parameter.path.key);
    for (const std::string& key : set)
      table.expect(key == parameter.path.key ? "key" : "also", keys.insert(key).second,
                   "\"" + key + "\" is fitted twice", "give it one [[fit.parameter]]");
    if (table.good("key") && table.good("start") && table.good("low") && table.good("high"))
      parameters.push_back(std::move(parameter));
  }
  if (!fit.has("parameter"))
    fit.report("parameter", "[fit] has no [[fit.parameter]], so there is nothing to find",
               "add [[fit.parameter]] with key, start, low and high");
  return parameters;
}

FitGoniometerSpec read_goniometer_spec(const config::TomlTable& table) {
  const auto name = [&](const char* key) { return config::NameRef{table.string(key), table.where(key)}; };
  FitGoniometerSpec spec;
  spec.surface = name("surface");
  spec.inside = name("inside");
  spec.outside = name("outside");
  spec.wavelength_nm = table.quantity("wavelength", core::Dimension::wavelength);
  table.expect("wavelength", spec.wavelength_nm > 0.0, "a wavelength must be positive", "as \"420 nm\"");
  spec.from_inside = table.choice("side", kFromInside);
  const std::int64_t rays = table.integer("rays", kRays);
  table.expect("rays", rays > 0, "\"rays\" must be positive");
  spec.rays = rays > 0 ? static_cast<std::uint64_t>(rays) : kRays;
  return spec;
}

/// Reads the keys that belong to the quantity.
void read_fit_place(const config::TomlTable& table, FitSpec& fit) {
  const bool reflectance = fit.quantity == FitQuantity::reflectance;
  const char* wanted = reflectance ? "goniometer" : "at";
  const char* other = reflectance ? "at" : "goniometer";
  if (!table.good("quantity")) {
    table.take("at");
    table.take("goniometer");
    return;
  }
  if (table.take(other))
    table.report(other,
                 fmt::format("\"{}\" is given, but a fit of {} has none", other, quantity_name(fit.quantity)),
                 fmt::format("remove it; {} says where the measurement was made",
                             reflectance ? "[fit.goniometer]" : "\"at\""));
  if (!table.has(wanted)) {
    table.report(
        wanted,
        fmt::format("[fit] has no \"{}\", which a fit of {} needs", wanted, quantity_name(fit.quantity)),
        reflectance ? "add [fit.goniometer] with surface, inside, outside, wavelength and side"
                    : "name the key that takes the measured positions, as "
                      "at = \"source.region.slab_z.center\"");
    return;
  }
  if (reflectance)
    fit.goniometer = read_goniometer_spec(table.table("goniometer"));
  else
    fit.at = read_path(table, "at", "key that takes the measured positions,");
}

/// Reports a unit that no quantity has; the required kind of quantity depends on the key `at`.
void check_unit(const config::TomlTable& table, const FitSpec& fit) {
  if (fit.quantity != FitQuantity::reflectance) return;
  try {
    core::unit_factor(fit.unit, core::Dimension::angle);
  } catch (const core::InputError& error) {
    table.expect("unit", false, error.problems().front().what,
                 "a reflectance is against an angle, as unit = \"deg\"");
  }
}

}  // namespace

const char* quantity_name(FitQuantity quantity) { return core::word_of(kFitQuantities, quantity); }

KeySetting FitParameterSpec::setting(double value) const { return {path, value_node(value, unit, where)}; }

KeySetting FitSpec::position(double value, const core::FileLocation& row) const {
  return {at, value_node(value, unit, row)};
}

std::optional<FitSpec> read_fit(const config::TomlTable& scene) {
  const std::optional<config::TomlTable> table = scene.optional_table("fit");
  if (!table) return std::nullopt;
  FitSpec fit;
  fit.where = table->where();
  fit.measurement = table->existing_file("measurement");
  fit.measurement_where = table->where("measurement");
  fit.quantity = table->choice("quantity", kFitQuantities);
  fit.unit = table->string("unit");
  check_unit(*table, fit);
  read_fit_place(*table, fit);
  fit.free_scale = table->choice("scale", kFreeScale);
  fit.errors_from_scatter = table->choice("errors", kErrorsFromScatter, false);
  fit.parameters = read_parameters(*table);
  return fit;
}

}  // namespace scintray::scene_file
