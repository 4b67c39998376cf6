#include "scintray/report/pages/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "scintray/analysis/timing/coincidence_timing.hpp"
#include "scintray/core/text.hpp"
#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/text/detail/json_text.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/omissions.hpp"
#include "scintray/report/text/sweep_view.hpp"

namespace scintray::report {

namespace {

using Value = std::optional<core::Estimate>;

/// A point of a result, and its analysis where it has one.
struct PointOfResult {
  const tally::PointResult* point = nullptr;
  const analysis::EventAnalysis* analysis = nullptr;
};

PointOfResult point_of(const NamedResult& result, std::size_t number) {
  return {&result.run.points[number],
          number < result.analyses.points.size() ? &result.analyses.points[number] : nullptr};
}

/// The point with the same swept values; the only one where both results have one.
PointOfResult matching_point(const NamedResult& result, const std::string& label, bool single) {
  if (single && result.run.points.size() == 1) return point_of(result, 0);
  for (std::size_t i = 0; i < result.run.points.size(); ++i)
    if (point_label(result.run.points[i]) == label) return point_of(result, i);
  return {};
}

struct Quantity {
  std::string name;
  Value (*value)(const PointOfResult&);
  std::optional<Figure> figure{};  ///< where effects that are not included change it
};

template <int kFate>
Value share_of(const PointOfResult& at) {
  if (at.point->photons == 0) return std::nullopt;
  return at.point->fraction(core::fate_at(kFate));
}

template <std::size_t... kFates>
std::vector<Quantity> shares(std::index_sequence<kFates...>) {
  return {{fate_text(core::fate_at(static_cast<int>(kFates))) + ", share of the photons",
           share_of<static_cast<int>(kFates)>}...};
}

std::vector<Quantity> quantities() {
  std::vector<Quantity> all = shares(std::make_index_sequence<core::kFateCount>());
  all[core::fate_index(core::Fate::detected)].figure = Figure::fraction;
  const auto add = [&](const char* name, Value (*value)(const PointOfResult&),
                       std::optional<Figure> figure = {}) {
    all.push_back({name, value, figure});
  };
  add("photons detected per event", [](const PointOfResult& at) -> Value {
    if (at.point->energy.detected.count == 0) return std::nullopt;
    return at.point->energy.detected.mean();
  });
  add("mean light of a pulse", [](const PointOfResult& at) -> Value {
    if (!at.analysis || at.analysis->pulses == 0) return std::nullopt;
    return at.analysis->mean_light;
  });
  add("photopeak", [](const PointOfResult& at) -> Value {
    if (!at.analysis || !at.analysis->peak.has_numbers()) return std::nullopt;
    return at.analysis->peak.fit.position;
  });
  const auto resolution = [](const PointOfResult& at) -> Value {
    if (!at.analysis || !at.analysis->peak.has_numbers()) return std::nullopt;
    return at.analysis->peak.fit.relative_fwhm;
  };
  add("energy resolution (FWHM)", resolution, Figure::resolution);
  add("depth of interaction, FWHM (mm)", [](const PointOfResult& at) -> Value {
    if (!at.analysis || !at.analysis->doi) return std::nullopt;
    return at.analysis->doi->residual.quantile_fwhm;
  });
  add("flood map, share assigned rightly", [](const PointOfResult& at) -> Value {
    if (!at.analysis || !at.analysis->flood || at.analysis->flood->crystals.empty()) return std::nullopt;
    return at.analysis->flood->share_right;
  });
  const auto timing = [](const PointOfResult& at) -> Value {
    if (!at.analysis || !at.analysis->pair_difference_ns) return std::nullopt;
    return analysis::quoted_fwhm(*at.analysis->pair_difference_ns);
  };
  add("CTR, FWHM (ns)", timing, Figure::timing);
  return all;
}

std::optional<double> sigmas_between(const Value& a, const Value& b) {
  if (!a || !b) return std::nullopt;
  const double error = std::hypot(a->error, b->error);
  if (!(error > 0.0) || !std::isfinite(b->value - a->value)) return std::nullopt;
  return (b->value - a->value) / error;
}

std::string sigma_text(const std::optional<double>& sigmas) {
  return sigmas ? fmt::format("{:+.1f}", *sigmas) : "none";
}

std::vector<std::string> head_of(const std::vector<NamedResult>& results) {
  std::vector<std::string> head{"point", "quantity", results.front().name};
  for (std::size_t i = 1; i < results.size(); ++i)
    head.insert(head.end(), {results[i].name, "difference, sigma"});
  return head;
}

std::vector<std::string> row_of(const ComparedNumber& number) {
  std::vector<std::string> row{number.point, number.quantity};
  for (std::size_t i = 0; i < number.values.size(); ++i) {
    row.push_back(number.values[i] ? with_error(*number.values[i]) : "none");
    if (i > 0) row.push_back(sigma_text(number.sigmas[i]));
  }
  return row;
}

/// The largest difference, and the share of comparisons as large a difference of equal results would have by
/// chance: with N of them, 1 - (1 - p)^N with p that of a normal distribution.
std::string conclusion(const std::vector<NamedResult>& results, const std::vector<ComparedNumber>& numbers) {
  std::size_t count = 0;
  double largest = 0.0, squares = 0.0;
  std::string where;
  for (const ComparedNumber& number : numbers)
    for (std::size_t i = 1; i < number.sigmas.size(); ++i) {
      if (!number.sigmas[i]) continue;
      ++count;
      squares += *number.sigmas[i] * *number.sigmas[i];
      if (std::abs(*number.sigmas[i]) <= largest) continue;
      largest = std::abs(*number.sigmas[i]);
      where = number.point + ", " + number.quantity + ", " + results[i].name;
    }
  if (count == 0) return "No number is in two of the results.";
  const double alone = std::erfc(largest / std::sqrt(2.0));
  const double chance = -std::expm1(static_cast<double>(count) * std::log1p(-std::min(alone, 1.0 - 1e-15)));
  return fmt::format(
      "{} differences from {}: root mean square {:.2f} sigma, the largest {:.1f} sigma ({}); of as many "
      "independent differences of equal results the largest is so large with a probability of {:.2g}. The "
      "shares of one "
      "point depend on each other.",
      count, results.front().name, std::sqrt(squares / static_cast<double>(count)), largest, where, chance);
}

/// What the figures in the table do not include: a sentence for each figure, or for each result where they
/// differ.
std::vector<std::string> omissions(const std::vector<NamedResult>& results,
                                   const std::vector<ComparedNumber>& numbers) {
  std::vector<std::string> found;
  for (const Quantity& quantity : quantities()) {
    if (!quantity.figure) continue;
    std::vector<std::pair<std::string, std::vector<std::string>>> sentences;  // each with its results
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (std::none_of(numbers.begin(), numbers.end(), [&](const ComparedNumber& number) {
            return number.quantity == quantity.name && number.values[i];
          }))
        continue;
      const std::string sentence = omission_sentence(omitted_anywhere(results[i].run), *quantity.figure);
      auto at = std::find_if(sentences.begin(), sentences.end(),
                             [&](const auto& one) { return one.first == sentence; });
      if (at == sentences.end()) at = sentences.insert(sentences.end(), {sentence, {}});
      at->second.push_back(results[i].name);
    }
    for (const auto& [sentence, names] : sentences)
      found.push_back(sentences.size() > 1 ? core::list_of(names) + ": " + sentence : sentence);
  }
  return found;
}

/// Warnings about conditions that make differences in sigma meaningless or biased.
std::vector<std::string> cautions(const std::vector<NamedResult>& results) {
  std::vector<std::string> found;
  std::set<std::uint64_t> seeds;
  for (const NamedResult& result : results) {
    if (!seeds.insert(result.run.header.seed).second)
      found.push_back(result.name +
                      " has the seed of a result before it: where the scenes agree, so do the photons, and "
                      "differences are smaller than their errors");
    if (!result.run.complete()) found.push_back(result.name + " is partial: " + result.run.partial_reason);
  }
  return found;
}

}  // namespace

std::vector<ComparedNumber> compare_results(const std::vector<NamedResult>& results) {
  if (results.empty()) throw std::invalid_argument("no results to compare");
  const std::vector<Quantity> all = quantities();
  const NamedResult& first = results.front();
  std::vector<ComparedNumber> numbers;
  for (std::size_t i = 0; i < first.run.points.size(); ++i) {
    const std::string label = point_label(first.run.points[i]);
    std::vector<PointOfResult> points{point_of(first, i)};
    for (std::size_t k = 1; k < results.size(); ++k)
      points.push_back(matching_point(results[k], label, first.run.points.size() == 1));
    for (const Quantity& quantity : all) {
      ComparedNumber number{label, quantity.name, {}, {}};
      std::size_t known = 0;
      bool all_zero = true;
      for (const PointOfResult& at : points) {
        number.values.push_back(at.point ? quantity.value(at) : std::nullopt);
        known += number.values.back() ? 1 : 0;
        all_zero = all_zero && !(number.values.back() && number.values.back()->value != 0.0);
        number.sigmas.push_back(number.values.size() > 1
                                    ? sigmas_between(number.values.front(), number.values.back())
                                    : std::nullopt);
      }
      if (known > 1 && !all_zero) numbers.push_back(std::move(number));
    }
  }
  return numbers;
}

std::string comparison_text(const std::vector<NamedResult>& results) {
  const std::vector<ComparedNumber> numbers = compare_results(results);
  std::vector<std::vector<std::string>> table{head_of(results)};
  for (const ComparedNumber& number : numbers) table.push_back(row_of(number));
  std::string text = aligned(table);
  for (const std::string& sentence : omissions(results, numbers)) text += sentence + "\n";
  text += conclusion(results, numbers) + "\n";
  for (const std::string& caution : cautions(results)) text += "note: " + caution + "\n";
  return text;
}

std::string comparison_json(const std::vector<NamedResult>& results) {
  using Json = nlohmann::ordered_json;
  const auto number_json = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
  };
  const std::vector<ComparedNumber> numbers = compare_results(results);
  Json json = {{"results", Json::array()}, {"numbers", Json::array()}};
  for (const NamedResult& result : results)
    json["results"].push_back({{"name", result.name},
                               {"title", result.run.header.title},
                               {"scene", result.run.header.scene_file},
                               {"seed", result.run.header.seed},
                               {"complete", result.run.complete()}});
  for (const ComparedNumber& number : numbers) {
    Json entry = {{"point", number.point},
                  {"quantity", number.quantity},
                  {"values", Json::array()},
                  {"sigmas", Json::array()}};
    for (const std::optional<core::Estimate>& value : number.values)
      entry["values"].push_back(
          !value ? Json(nullptr)
                 : Json{{"value", number_json(value->value)}, {"error", number_json(value->error)}});
    for (const std::optional<double>& sigmas : number.sigmas) entry["sigmas"].push_back(number_json(sigmas));
    json["numbers"].push_back(std::move(entry));
  }
  json["not_included"] = omissions(results, numbers);
  json["cautions"] = cautions(results);
  return json_text(json) + "\n";
}

std::string comparison_page(const std::vector<NamedResult>& results) {
  const std::vector<ComparedNumber> numbers = compare_results(results);
  std::string about, rows, notes, names, left_out;
  for (const NamedResult& result : results) {
    names += (names.empty() ? "" : ", ") + result.name;
    about += "<tr>" + cell(result.name, "th") + cell(result.run.header.title) +
             cell(result.run.header.scene_file) + number_cell(std::to_string(result.run.header.seed)) +
             number_cell(grouped(result.run.points.size())) + "</tr>\n";
  }
  for (const ComparedNumber& number : numbers) {
    const std::vector<std::string> cells = row_of(number);
    rows += "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i)
      rows += i < 2 ? cell(cells[i], i == 0 ? "th" : "td") : number_cell(cells[i]);
    rows += "</tr>\n";
  }
  for (const std::string& caution : cautions(results)) notes += "<li>" + escape_html(caution) + "</li>\n";
  for (const std::string& sentence : omissions(results, numbers))
    left_out += "<p>" + escape_html(sentence) + "</p>\n";
  std::string body = section("Differences", "<p>" + escape_html(conclusion(results, numbers)) + "</p>\n" +
                                                (notes.empty() ? "" : "<ul>\n" + notes + "</ul>\n") +
                                                table(head_of(results), rows, 2) + left_out);
  body += section("Results", table({"result", "title", "scene", "seed", "points"}, about, 3));
  return html_page("Comparison of results", names, "", body);
}

}  // namespace scintray::report
