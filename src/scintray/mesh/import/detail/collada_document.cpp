#include "scintray/mesh/import/detail/collada_document.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/core/words.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

/// Transform of a node: its elements, which apply in order, and the count of numbers of each.
struct Transform {
  enum class Kind { translate, rotate, scale, matrix, look_at, skew };
  Kind kind;
  std::size_t numbers;
};
constexpr core::Word<Transform> kTransforms[] = {
    {"translate", {Transform::Kind::translate, 3}}, {"rotate", {Transform::Kind::rotate, 4}},
    {"scale", {Transform::Kind::scale, 3}},         {"matrix", {Transform::Kind::matrix, 16}},
    {"lookat", {Transform::Kind::look_at, 9}},      {"skew", {Transform::Kind::skew, 7}}};

/// Displacement along `moved`, by the tangent of the angle times the distance along `across`. Nothing when
/// the angle or an axis is out of range, or all points would fall into a plane. The order of the axes is that
/// of the picture which Khronos' COLLADA Conformance Test Suite (2012) has for node_skew_cube.dae, where the
/// cube skewed by "45 1 1 0 0 0 1" is displaced along (1, 1, 0) in proportion to z.
std::optional<Eigen::Matrix3d> skew(double angle_rad, const core::Vec3& moved, const core::Vec3& across) {
  constexpr double kLeast = 1e-6;
  if (!(std::cos(angle_rad) > kLeast) || !(moved.norm() > 0.0) || !(across.norm() > 0.0)) return std::nullopt;
  const Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity() +
                                 std::tan(angle_rad) * moved.normalized() * across.normalized().transpose();
  return std::abs(matrix.determinant()) > kLeast ? std::optional(matrix) : std::nullopt;
}

/// Calls `take` for each word of the text of an element.
template <typename Take>
void for_each_word(pugi::xml_node node, Take take) {
  constexpr std::string_view kSpace = " \t\r\n";
  std::string_view text = node.text().get();
  for (;;) {
    const std::size_t start = text.find_first_not_of(kSpace);
    if (start == std::string_view::npos) return;
    const std::size_t end = std::min(text.find_first_of(kSpace, start), text.size());
    take(text.substr(start, end - start));
    text.remove_prefix(end);
  }
}

}  // namespace

ColladaDocument::ColladaDocument(const std::filesystem::path& path, const std::string& content)
    : path_(path) {
  if (xml_depth(content) > kDeepestNesting) reject("XML elements are nested more than 500 deep");
  const pugi::xml_parse_result parsed = document_.load_buffer(content.data(), content.size());
  root_ = document_.child("COLLADA");
  if (!parsed) reject(std::string("the COLLADA file is not well-formed XML: ") + parsed.description());
  if (!root_) reject("the file has no <COLLADA>");
  remember_ids(root_);
}

void ColladaDocument::reject(const std::string& what) const {
  reject_file(path_, what, "the file is damaged or not plain COLLADA; export it again");
}

void ColladaDocument::remember_ids(Node start) {
  std::vector<Node> open{start};
  while (!open.empty()) {
    const Node node = open.back();
    open.pop_back();
    if (const pugi::xml_attribute id = node.attribute("id")) by_id_.emplace(id.value(), node);
    for (const Node child : node.children())
      if (child.type() == pugi::node_element) open.push_back(child);
  }
}

ColladaDocument::Node ColladaDocument::referred(Node node, const char* attribute) const {
  const std::string_view url = node.attribute(attribute).value();
  const auto found = url.starts_with("#") ? by_id_.find(std::string(url.substr(1))) : by_id_.end();
  if (found == by_id_.end())
    reject(std::string("<") + node.name() + "> refers to " + core::in_quotes(url) +
           ", which is not in the file");
  return found->second;
}

ColladaDocument::Node ColladaDocument::element(const std::string& id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? Node() : found->second;
}

double ColladaDocument::one_number(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  text = text.substr(0, text.find_last_not_of(kSpace) + 1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : std::nan("");
}

std::vector<double> ColladaDocument::numbers(Node node) const {
  std::vector<double> values;
  for_each_word(node, [&](std::string_view word) {
    values.push_back(one_number(word));
    // Coordinates that are not finite are reported with their place later.
    if (std::isnan(values.back()) && word != "nan" && word != "NaN")
      reject(std::string("<") + node.name() + "> holds " + core::in_quotes(word) + ", which is not a number");
  });
  return values;
}

std::vector<std::size_t> ColladaDocument::indices(Node node) const {
  std::vector<std::size_t> values;
  for_each_word(node, [&](std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      reject(std::string("<") + node.name() + "> holds " + core::in_quotes(word) + ", which is not an index");
    values.push_back(value);
  });
  return values;
}

std::size_t ColladaDocument::count(Node node, const char* attribute, std::size_t fallback) const {
  if (!node.attribute(attribute)) return fallback;
  const double value = one_number(node.attribute(attribute).value());
  if (!(value >= 0.0 && value <= 1e9) || value != std::floor(value))
    reject(std::string("<") + node.name() + "> has " + attribute + "=" +
           core::in_quotes(node.attribute(attribute).value()) + ", which is not a count");
  return static_cast<std::size_t>(value);
}

Eigen::Affine3d ColladaDocument::transform_of(Node node) const {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  for (const Node step : node.children()) {
    const std::optional<Transform> known = core::find_word(kTransforms, step.name());
    if (!known) continue;
    const std::vector<double> v = numbers(step);
    if (v.size() != known->numbers)
      reject(std::string("<") + step.name() + "> has " + std::to_string(v.size()) + " numbers; expected " +
             std::to_string(known->numbers));
    switch (known->kind) {
      case Transform::Kind::translate:
        transform.translate(core::Vec3(v[0], v[1], v[2]));
        break;
      case Transform::Kind::rotate: {
        const core::Vec3 axis(v[0], v[1], v[2]);
        if (axis.norm() > 0.0) transform.rotate(Eigen::AngleAxisd(v[3] * core::kDegree, axis.normalized()));
        break;
      }
      case Transform::Kind::scale:
        transform.scale(core::Vec3(v[0], v[1], v[2]));
        break;
      case Transform::Kind::matrix: {
        Eigen::Affine3d step_matrix = Eigen::Affine3d::Identity();
        step_matrix.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
        transform = transform * step_matrix;
        break;
      }
      case Transform::Kind::look_at: {  // from v[0..2] towards v[3..5], which is along -z, and v[6..8]
                                        // upwards
        const core::Vec3 eye(v[0], v[1], v[2]), interest(v[3], v[4], v[5]), up(v[6], v[7], v[8]);
        const core::Vec3 back = eye - interest, side = up.cross(back);
        if (!(back.norm() > 0.0) || !(side.norm() > 0.0))
          reject("a <lookat> looks at itself, or along its up axis");
        Eigen::Affine3d look = Eigen::Affine3d::Identity();
        look.linear().col(0) = side.normalized();
        look.linear().col(2) = back.normalized();
        look.linear().col(1) = look.linear().col(2).cross(look.linear().col(0));
        look.translation() = eye;
        transform = transform * look;
        break;
      }
      case Transform::Kind::skew: {
        const std::optional<Eigen::Matrix3d> shear =
            skew(v[0] * core::kDegree, core::Vec3(v[1], v[2], v[3]), core::Vec3(v[4], v[5], v[6]));
        if (!shear)
          reject(
              "a <skew> by 90 deg or more, with an axis of no length, or such that all points fall into a "
              "plane");
        transform.linear() = transform.linear() * *shear;
        break;
      }
    }
  }
  return transform;
}

}  // namespace scintray::mesh
