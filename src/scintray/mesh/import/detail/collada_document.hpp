#pragma once
/// The elements of a COLLADA file, their numbers, and what they refer to.

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::mesh {

/// A COLLADA file. Every function throws InputError naming the file for content of another form.
class ColladaDocument {
 public:
  using Node = pugi::xml_node;

  ColladaDocument(const std::filesystem::path& path, const std::string& content);

  [[noreturn]] void reject(const std::string& what) const;
  Node root() const { return root_; }
  /// The element of an id; null when there is none.
  Node element(const std::string& id) const;
  /// The element that "#id" in an attribute names.
  Node referred(Node node, const char* attribute) const;

  /// Value of a text; NaN unless it is one number with or without sign, between blanks.
  static double one_number(std::string_view text);
  std::vector<double> numbers(Node node) const;
  std::vector<std::size_t> indices(Node node) const;
  std::size_t count(Node node, const char* attribute, std::size_t fallback) const;
  /// Transform of a node by its elements, which apply in order.
  Eigen::Affine3d transform_of(Node node) const;

 private:
  void remember_ids(Node start);

  const std::filesystem::path& path_;
  pugi::xml_document document_;
  Node root_;
  std::map<std::string, Node> by_id_;
};

}  // namespace scintray::mesh
