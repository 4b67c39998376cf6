#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/journal.hpp"
#include "scintray/topography/detail/node_bytes.hpp"

namespace scintray::topography::detail {

namespace {

/// Calls visit(number) for each number of a node but those of its directions.
template <typename Node, typename Visit>
void for_each_number(Node& node, const Visit& visit) {
  visit(node.incidence_rad);
  visit(node.reflectance);
  visit(node.reflectance_error);
  visit(node.absorptance);
  visit(node.absorptance_error);
  visit(node.mean_slope_rad);
  visit(node.traced_incidence_rad);
}

/// Reader of numbers in their order.
class Numbers {
 public:
  explicit Numbers(std::string_view bytes) : numbers_(core::numbers_of<double>(bytes)) {}

  double next() {
    if (at_ == numbers_.size()) throw core::InternalError("a node of a journal is too short");
    return numbers_[at_++];
  }
  std::uint64_t count() {
    const double number = next();
    if (!(number >= 0.0 && number < 1e15)) throw core::InternalError("a node of a journal has no such count");
    return static_cast<std::uint64_t>(number);
  }
  bool at_end() const { return at_ == numbers_.size(); }

 private:
  std::vector<double> numbers_;
  std::size_t at_ = 0;
};

void append(std::vector<double>& to, const optics::DirectionQuantiles& from) {
  to.push_back(static_cast<double>(from.rays));
  for (const std::vector<float>* list : {&from.polar, &from.azimuth}) {
    to.push_back(static_cast<double>(list->size()));
    to.insert(to.end(), list->begin(), list->end());
  }
}

optics::DirectionQuantiles directions(Numbers& from) {
  optics::DirectionQuantiles directions;
  directions.rays = from.count();
  for (std::vector<float>* list : {&directions.polar, &directions.azimuth})
    for (std::uint64_t left = from.count(); left > 0; --left)
      list->push_back(static_cast<float>(from.next()));
  return directions;
}

}  // namespace

std::string node_key(std::uint64_t slice, std::uint64_t side, std::uint64_t position) {
  return core::bytes_of(std::vector<std::uint64_t>{slice, side, position});
}

std::string encoded_node(const TracedNode& traced) {
  std::vector<double> numbers{static_cast<double>(traced.cut), static_cast<double>(traced.unconverged),
                              static_cast<double>(traced.node.rays)};
  for_each_number(traced.node, [&](double number) { numbers.push_back(number); });
  append(numbers, traced.node.reflected);
  append(numbers, traced.node.transmitted);
  return core::bytes_of(numbers);
}

TracedNode decoded_node(std::string_view bytes) {
  Numbers numbers(bytes);
  TracedNode traced;
  traced.cut = numbers.count();
  traced.unconverged = numbers.count();
  traced.node.rays = numbers.count();
  for_each_number(traced.node, [&](double& number) { number = numbers.next(); });
  traced.node.reflected = directions(numbers);
  traced.node.transmitted = directions(numbers);
  if (!numbers.at_end()) throw core::InternalError("a node of a journal is too long");
  return traced;
}

}  // namespace scintray::topography::detail
