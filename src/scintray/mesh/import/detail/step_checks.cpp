#include "scintray/mesh/import/detail/step_isolation.hpp"

#include <charconv>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

/// The entities of a file by their number, and which they refer to.
struct StepReferences {
  std::unordered_map<std::uint64_t, std::size_t> index_of;
  std::vector<std::uint64_t> number;
  std::vector<std::vector<std::uint64_t>> refers_to;
};

/// Reads "#12 = NAME(#3, 'text', ...);" statements; text and comments are passed over.
class StepScanner {
 public:
  explicit StepScanner(std::string_view text) : text_(text) {}

  StepReferences scan() {
    bool begins = true;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\'') {
        skip_past("'", 1);
      } else if (text_.substr(at_, 2) == "/*") {
        skip_past("*/", 2);
      } else if (c == ';') {
        begins = true;
        in_entity_ = false;
        ++at_;
      } else if (c == '#') {
        take_number(begins);
        begins = false;
      } else {
        if (c > ' ') begins = false;
        ++at_;
      }
    }
    return std::move(found_);
  }

 private:
  void skip_past(std::string_view end, std::size_t from) {
    const std::size_t close = text_.find(end, at_ + from);
    at_ = close == std::string_view::npos ? text_.size() : close + end.size();
  }

  void take_number(bool begins) {
    std::uint64_t number = 0;
    const char* start = text_.data() + at_ + 1;
    const auto [end, error] = std::from_chars(start, text_.data() + text_.size(), number);
    at_ = static_cast<std::size_t>((error == std::errc() ? end : start) - text_.data());
    if (error != std::errc()) return;
    if (begins) {
      found_.index_of.emplace(number, found_.number.size());
      found_.number.push_back(number);
      found_.refers_to.emplace_back();
      in_entity_ = true;
    } else if (in_entity_) {
      found_.refers_to.back().push_back(number);
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool in_entity_ = false;
  StepReferences found_;
};

constexpr const char* kDamaged = "the file is damaged; export it again";

/// Follows references depth first, without recursion.
class CycleSearch {
 public:
  CycleSearch(const std::filesystem::path& path, const StepReferences& references)
      : path_(path), references_(references), state_(references.number.size(), State::unvisited) {}

  void run() {
    for (std::size_t start = 0; start < state_.size(); ++start)
      if (state_[start] == State::unvisited) follow(start);
  }

 private:
  enum class State : char { unvisited, open, done };
  struct Step {
    std::size_t entity, next;
  };

  std::string name(std::size_t entity) const { return "#" + std::to_string(references_.number[entity]); }

  void follow(std::size_t start) {
    constexpr std::size_t kDeepest = 10'000;
    std::vector<Step> way{{start, 0}};
    state_[start] = State::open;
    while (!way.empty()) {
      Step& step = way.back();
      const std::vector<std::uint64_t>& targets = references_.refers_to[step.entity];
      if (step.next == targets.size()) {
        state_[step.entity] = State::done;
        way.pop_back();
        continue;
      }
      const std::uint64_t target = targets[step.next++];
      const auto found = references_.index_of.find(target);
      if (found == references_.index_of.end())
        reject_file(
            path_, name(step.entity) + " refers to #" + std::to_string(target) + ", which is not in the file",
            kDamaged);
      const std::size_t entity = found->second;
      if (state_[entity] == State::open)
        reject_file(path_, name(step.entity) + " refers to " + name(entity) + ", which is made of it",
                    kDamaged);
      if (state_[entity] == State::done) continue;
      if (way.size() >= kDeepest) reject_file(path_, "references are nested more than 10000 deep", kDamaged);
      state_[entity] = State::open;
      way.push_back({entity, 0});
    }
  }

  const std::filesystem::path& path_;
  const StepReferences& references_;
  std::vector<State> state_;
};

}  // namespace

void check_step_references(const std::filesystem::path& path, const std::string& content) {
  const StepReferences references = StepScanner(content).scan();
  CycleSearch(path, references).run();
}

}  // namespace scintray::mesh
