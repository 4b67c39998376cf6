#pragma once
/// The <define> section of a GDML file, and the expressions in the file.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scintray/core/vec.hpp"
#include "scintray/exchange/gdml/detail/gdml_file.hpp"

namespace scintray::exchange::gdml {

/// Numbers of a <matrix>, row by row, in Geant4's units (mm, ns, MeV, rad).
struct Matrix {
  std::size_t columns = 1;
  std::vector<double> values;
};

/// Variables of the loops around an element, each of the file with this number, with the values that they had
/// when it was read. A later evaluation restores them.
using LoopVariables = std::map<std::pair<std::size_t, std::string>, double>;

/// Definitions and expressions of a file and its modules, of which each has its own, as in Geant4: names are
/// those of the file of the element. Values are in Geant4's units: mm, ns, MeV, rad, MeV ns2/mm2 (mass).
class Definitions {
 public:
  /// Reads <define>, loops expanded. Throws InputError at the first expression that cannot be evaluated.
  explicit Definitions(const GdmlFile& file);
  ~Definitions();
  Definitions(const Definitions&) = delete;
  Definitions& operator=(const Definitions&) = delete;

  /// Value of an expression: + - * / ^, parentheses, functions, names of constants, units ("2.034*eV").
  double evaluate(const std::string& expression, Node where) const;
  /// An attribute's value, or the fallback when it is absent.
  double number(Node node, const char* attribute, double fallback) const;
  double number(Node node, const char* attribute) const;
  /// An attribute times the node's unit: `lunit` or `unit`, mm when absent.
  double length(Node node, const char* attribute, double fallback = 0.0) const;
  /// An attribute times the node's `aunit`, rad when absent.
  double angle(Node node, const char* attribute, double fallback = 0.0) const;
  /// x, y, z of a node times its `unit`.
  core::Vec3 vector(Node node, const char* default_unit, double fallback = 0.0) const;

  /// A name, with every [expression] in it (as in loops) replaced by _ and its whole number.
  std::string name(const std::string& text, Node where) const;

  /// The position under `node`, as <position> or <positionref>, for example; zero when there is none.
  core::Vec3 position(Node node, const std::string& tag = "position") const;
  core::Vec3 rotation(Node node, const std::string& tag = "rotation") const;
  core::Vec3 scale(Node node) const;
  const core::Vec3& position_named(const std::string& name, Node where) const;
  /// nullptr, or empty, when there is none of that name.
  const Matrix* matrix(const std::string& name, Node where) const;
  std::optional<double> constant(const std::string& name, Node where) const;

  /// Calls `action` for the children of a node, those in <loop>s once for every value of the loop's variable.
  void for_each_child(Node parent, const std::function<void(Node)>& action) const;
  /// The same for all sections of a name, of the file and its modules.
  void for_each_of(const std::string& section, const std::function<void(Node)>& action) const;

  /// Entries that Geant4 reads differently from their apparent meaning.
  const std::vector<std::string>& notes() const { return notes_; }

  const LoopVariables& loop_variables() const { return loops_->variables; }
  void set_loop_variables(const LoopVariables& variables) const;

 private:
  class Evaluator;
  /// What one file defines.
  struct Scope {
    std::unique_ptr<Evaluator> evaluator;
    std::map<std::string, core::Vec3> positions, rotations, scales;
    std::map<std::string, Matrix> matrices;
  };
  const Scope& scope(Node node) const { return scopes_[file_.document_of(node)]; }
  void define(Node node);
  /// Elements of a matrix by name in expressions: NAME_0 of a row or column, else NAME_0_1 (GDML User's
  /// Guide, section "Matrices").
  static void name_elements(const std::string& name, const Matrix& matrix, Evaluator& evaluator);
  core::Vec3 referred(const std::map<std::string, core::Vec3>& known, Node node, const std::string& tag,
                      const char* default_unit, double fallback) const;

  /// Loops of all files together.
  struct Loops {
    LoopVariables variables;
    double steps = 0.0;
  };

  const GdmlFile& file_;
  std::vector<Scope> scopes_;  ///< by the number of the file
  std::unique_ptr<Loops> loops_;
  std::vector<std::string> notes_;
};

/// Restores loop variables during its lifetime.
class LoopScope {
 public:
  LoopScope(const Definitions& definitions, const LoopVariables& variables)
      : definitions_(definitions), before_(definitions.loop_variables()) {
    definitions_.set_loop_variables(variables);
  }
  LoopScope(const LoopScope&) = delete;
  LoopScope& operator=(const LoopScope&) = delete;
  ~LoopScope() { definitions_.set_loop_variables(before_); }

 private:
  const Definitions& definitions_;
  LoopVariables before_;
};

/// An element and the loop variables at the time it was read.
struct LoopedNode {
  Node node;
  LoopVariables variables;
};

}  // namespace scintray::exchange::gdml
