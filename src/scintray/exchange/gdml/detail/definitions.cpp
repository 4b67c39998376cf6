#include "scintray/exchange/gdml/detail/definitions.hpp"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "scintray/core/words.hpp"

namespace scintray::exchange::gdml {

namespace {

/// Of all loops of a file together.
constexpr double kMostSteps = 200'000;
constexpr std::size_t kMostMatrixNumbers = 10'000'000;

/// Geant4's units (Book For Application Developers, section "System of units"): mm, ns, MeV, rad and their
/// derivatives are 1. Masses follow from 1 kg = 1 J s2/m2, with 1 J = 1 / 1.602176634e-13 MeV (CODATA 2018).
constexpr double kKilogram = 1e-6 * 1e18 / 1.602176634e-13;
constexpr std::array<std::pair<const char*, double>, 59> kUnits{{
    {"pi", core::kPi},
    {"twopi", core::kTwoPi},
    {"halfpi", core::kPi / 2},
    {"mm", 1.0},
    {"millimeter", 1.0},
    {"cm", 10.0},
    {"centimeter", 10.0},
    {"m", 1e3},
    {"meter", 1e3},
    {"km", 1e6},
    {"kilometer", 1e6},
    {"um", 1e-3},
    {"micrometer", 1e-3},
    {"nm", 1e-6},
    {"nanometer", 1e-6},
    {"angstrom", 1e-7},
    {"fermi", 1e-12},
    {"inch", 25.4},
    {"mm2", 1.0},
    {"cm2", 1e2},
    {"m2", 1e6},
    {"mm3", 1.0},
    {"cm3", 1e3},
    {"m3", 1e9},
    {"rad", 1.0},
    {"radian", 1.0},
    {"mrad", 1e-3},
    {"milliradian", 1e-3},
    {"deg", core::kDegree},
    {"degree", core::kDegree},
    {"sr", 1.0},
    {"steradian", 1.0},
    {"ns", 1.0},
    {"nanosecond", 1.0},
    {"s", 1e9},
    {"second", 1e9},
    {"ms", 1e6},
    {"millisecond", 1e6},
    {"us", 1e3},
    {"microsecond", 1e3},
    {"ps", 1e-3},
    {"picosecond", 1e-3},
    {"eV", 1e-6},
    {"electronvolt", 1e-6},
    {"keV", 1e-3},
    {"kiloelectronvolt", 1e-3},
    {"MeV", 1.0},
    {"megaelectronvolt", 1.0},
    {"GeV", 1e3},
    {"gigaelectronvolt", 1e3},
    {"TeV", 1e6},
    {"kg", kKilogram},
    {"kilogram", kKilogram},
    {"g", 1e-3 * kKilogram},
    {"gram", 1e-3 * kKilogram},
    {"mg", 1e-6 * kKilogram},
    {"milligram", 1e-6 * kKilogram},
    {"kelvin", 1.0},
    {"K", 1.0},
}};

}  // namespace

/// Names and their values, through muParser.
class Definitions::Evaluator {
 public:
  Evaluator() {
    parser_.DefineFun(
        "pow", +[](double x, double y) { return std::pow(x, y); });
    for (const auto& [name, value] : kUnits) set(name, value);
  }

  /// Names that expressions cannot use are left out: nothing can refer to them.
  void set(const std::string& name, double value) {
    try {
      parser_.DefineConst(name, value);
      values_[name] = value;
    } catch (const mu::Parser::exception_type&) {
      values_[name] = value;
    }
  }

  const double* find(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? nullptr : &found->second;
  }

  /// Evaluates the expression; returns a message when that fails, else empty.
  std::string evaluate(const std::string& expression, double& value) {
    std::string text = expression;
    for (std::size_t at = text.find("**"); at != std::string::npos; at = text.find("**"))
      text.replace(at, 2, "^");
    try {
      parser_.SetExpr(text);
      value = parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
      return error.GetMsg();
    }
    return std::isfinite(value) ? "" : "it is not a finite number";
  }

 private:
  mu::Parser parser_;
  std::map<std::string, double> values_;
};

Definitions::~Definitions() = default;

Definitions::Definitions(const GdmlFile& file) : file_(file), loops_(std::make_unique<Loops>()) {
  scopes_.resize(file.document_count());
  for (Scope& scope : scopes_) scope.evaluator = std::make_unique<Evaluator>();
  for_each_of("define", [this](Node node) { define(node); });
}

void Definitions::define(Node node) {
  enum class Kind { number, quantity, expression, position, rotation, scale, matrix };
  static constexpr core::Word<Kind> kKinds[] = {
      {"constant", Kind::number},       {"variable", Kind::number},   {"quantity", Kind::quantity},
      {"expression", Kind::expression}, {"position", Kind::position}, {"rotation", Kind::rotation},
      {"scale", Kind::scale},           {"matrix", Kind::matrix}};
  const std::optional<Kind> kind = core::find_word(kKinds, node.name());
  const std::string own = name(node.attribute("name").value(), node);
  Scope& scope = scopes_[file_.document_of(node)];
  if (kind == Kind::number) {
    scope.evaluator->set(own, number(node, "value"));
  } else if (kind == Kind::quantity) {
    scope.evaluator->set(own, number(node, "value") * (node.attribute("unit") ? number(node, "unit") : 1.0));
  } else if (kind == Kind::expression) {
    scope.evaluator->set(own, evaluate(node.text().as_string(), node));
  } else if (kind == Kind::position) {
    scope.positions[own] = vector(node, "mm");
  } else if (kind == Kind::rotation) {
    scope.rotations[own] = vector(node, "rad");
  } else if (kind == Kind::scale) {
    scope.scales[own] = vector(node, "1", 1.0);
  } else if (kind == Kind::matrix) {
    Matrix& matrix = scope.matrices[own];
    const double columns = number(node, "coldim");
    if (!(columns >= 1.0 && columns <= 1000.0))
      file_.reject(node, "a matrix of no columns, or of over 1000",
                   "give coldim=\"2\" to a table of energies and values, coldim=\"1\" to a number");
    matrix.columns = static_cast<std::size_t>(columns);
    matrix.values.clear();
    if (!node.attribute("values") && matrix.columns == 1) {
      matrix.values = {0.0};
      notes_.push_back("matrix " + own + " has no \"values\"" +
                       (node.attribute("value") ? " (it has \"value\")" : "") +
                       ": Geant4 reads it as the number 0, and so it is here");
      return;
    }
    std::istringstream words(file_.required(node, "values"));
    for (std::string word; words >> word;) {
      if (matrix.values.size() >= kMostMatrixNumbers)
        file_.reject(node, "a matrix of over 10 million numbers", "give fewer rows");
      matrix.values.push_back(evaluate(word, node));
    }
    if (matrix.values.empty() || matrix.values.size() % matrix.columns != 0)
      file_.reject(node,
                   "matrix \"" + own + "\" has " + std::to_string(matrix.values.size()) +
                       " numbers, which do not fill " + std::to_string(matrix.columns) + " columns",
                   "give every row all its numbers");
    name_elements(own, matrix, *scope.evaluator);
  } else {
    file_.reject(
        node, std::string("<") + node.name() + "> in <define> is not known",
        "expected constant, variable, quantity, expression, position, rotation, scale, matrix, loop");
  }
}

void Definitions::name_elements(const std::string& name, const Matrix& matrix, Evaluator& evaluator) {
  const std::size_t rows = matrix.values.size() / matrix.columns;
  constexpr std::size_t kMostNamed = 10'000;
  if (matrix.values.size() > kMostNamed) return;
  const bool one_index = rows == 1 || matrix.columns == 1;
  for (std::size_t i = 0; i < matrix.values.size(); ++i)
    evaluator.set(one_index ? name + "_" + std::to_string(i)
                            : name + "_" + std::to_string(i / matrix.columns) + "_" +
                                  std::to_string(i % matrix.columns),
                  matrix.values[i]);
}

double Definitions::evaluate(const std::string& expression, Node where) const {
  double value = 0.0;
  const std::string trouble = scope(where).evaluator->evaluate(expression, value);
  if (!trouble.empty())
    file_.reject(where, "cannot evaluate \"" + expression + "\": " + trouble,
                 "expected numbers, names defined above, units as in 2*mm, and + - * / ^ ( )");
  return value;
}

double Definitions::number(Node node, const char* attribute) const {
  return evaluate(file_.required(node, attribute), node);
}

double Definitions::number(Node node, const char* attribute, double fallback) const {
  return node.attribute(attribute) ? number(node, attribute) : fallback;
}

double Definitions::length(Node node, const char* attribute, double fallback) const {
  if (!node.attribute(attribute)) return fallback;
  const char* unit = node.attribute("lunit") ? "lunit" : "unit";
  return number(node, attribute) * number(node, unit, 1.0);
}

double Definitions::angle(Node node, const char* attribute, double fallback) const {
  return node.attribute(attribute) ? number(node, attribute) * number(node, "aunit", 1.0) : fallback;
}

core::Vec3 Definitions::vector(Node node, const char* default_unit, double fallback) const {
  const double unit = node.attribute("unit") ? number(node, "unit") : evaluate(default_unit, node);
  return unit *
         core::Vec3(number(node, "x", fallback), number(node, "y", fallback), number(node, "z", fallback));
}

std::string Definitions::name(const std::string& text, Node where) const {
  std::string result = text;
  for (std::size_t open = result.find('['); open != std::string::npos; open = result.find('[')) {
    const std::size_t close = result.find(']', open);
    if (close == std::string::npos)
      file_.reject(where, "\"" + text + "\" has a [ without its ]",
                   "write name[i] for the variable i of a loop");
    const double value = evaluate(result.substr(open + 1, close - open - 1), where);
    if (std::abs(value) > 1e9)
      file_.reject(where, "\"" + text + "\" has an index above 1e9",
                   "check the limits of the loop around it");
    result.replace(open, close - open + 1, "_" + std::to_string(std::lround(value)));
  }
  return result;
}

core::Vec3 Definitions::referred(const std::map<std::string, core::Vec3>& known, Node node,
                                 const std::string& tag, const char* default_unit, double fallback) const {
  if (const Node own = node.child(tag.c_str())) return vector(own, default_unit, fallback);
  const Node reference = node.child((tag + "ref").c_str());
  if (!reference) return core::Vec3::Constant(fallback);
  const std::string wanted = name(file_.required(reference, "ref"), reference);
  const auto found = known.find(wanted);
  if (found == known.end())
    file_.reject(reference, "no " + tag + " is called \"" + wanted + "\"", "define it in <define>");
  return found->second;
}

core::Vec3 Definitions::position(Node node, const std::string& tag) const {
  return referred(scope(node).positions, node, tag, "mm", 0.0);
}
core::Vec3 Definitions::rotation(Node node, const std::string& tag) const {
  return referred(scope(node).rotations, node, tag, "rad", 0.0);
}
core::Vec3 Definitions::scale(Node node) const {
  return referred(scope(node).scales, node, "scale", "1", 1.0);
}

const core::Vec3& Definitions::position_named(const std::string& wanted, Node where) const {
  const auto& positions = scope(where).positions;
  const auto found = positions.find(wanted);
  if (found == positions.end())
    file_.reject(where, "no position is called \"" + wanted + "\"", "define it in <define>");
  return found->second;
}

const Matrix* Definitions::matrix(const std::string& wanted, Node where) const {
  const auto& matrices = scope(where).matrices;
  const auto found = matrices.find(wanted);
  return found == matrices.end() ? nullptr : &found->second;
}

std::optional<double> Definitions::constant(const std::string& wanted, Node where) const {
  const double* value = scope(where).evaluator->find(wanted);
  return value ? std::optional(*value) : std::nullopt;
}

void Definitions::set_loop_variables(const LoopVariables& variables) const {
  loops_->variables = variables;
  for (const auto& [variable, value] : variables)
    scopes_[variable.first].evaluator->set(variable.second, value);
}

void Definitions::for_each_of(const std::string& section, const std::function<void(Node)>& action) const {
  for (const Node node : file_.sections(section)) for_each_child(node, action);
}

void Definitions::for_each_child(Node parent, const std::function<void(Node)>& action) const {
  for (const Node child : parent.children()) {
    if (child.type() != pugi::node_element) continue;
    if (std::string(child.name()) != "loop") {
      action(child);
      continue;
    }
    const std::size_t document = file_.document_of(child);
    const std::string variable = file_.required(child, "for");
    const double from = number(child, "from", 0.0), to = number(child, "to"),
                 step = number(child, "step", 1.0);
    if (!(step > 0.0)) file_.reject(child, "a loop whose step is not above 0", "give step=\"1\"");
    // Refused before the first step, as each may take a moment. A step that ends within rounding of `to`
    // counts.
    const double steps = std::max(0.0, std::floor((to - from) / step + 1e-9) + 1.0);
    loops_->steps += steps;
    if (!(loops_->steps <= kMostSteps))
      file_.reject(child, "the loops of the file have over 200000 steps together",
                   "check \"to\" and \"step\": 200000 volumes is the most that a scene of GDML places");
    for (double done = 0.0; done < steps; ++done) {
      const double value = from + done * step;
      scopes_[document].evaluator->set(variable, value);
      loops_->variables[{document, variable}] = value;
      for_each_child(child, action);
    }
    loops_->variables.erase({document, variable});
  }
}

}  // namespace scintray::exchange::gdml
