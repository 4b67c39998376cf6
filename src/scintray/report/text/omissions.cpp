#include "scintray/report/text/omissions.hpp"

#include <algorithm>
#include <utility>

#include "scintray/core/text.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

using Effects = std::optional<std::vector<tally::OmittedEffect>>;

bool concerns(const tally::OmittedEffect& effect, Figure figure) {
  switch (figure) {
    case Figure::resolution:
      return effect.in_resolution;
    case Figure::timing:
      return effect.in_timing;
    case Figure::fraction:
      return effect.in_fraction;
  }
  return false;
}

/// Effects that concern a figure, each with the media and sensors that lack it, in order of appearance.
std::vector<std::pair<std::string, std::vector<std::string>>> by_effect(
    const std::vector<tally::OmittedEffect>& effects, Figure figure) {
  std::vector<std::pair<std::string, std::vector<std::string>>> found;
  for (const tally::OmittedEffect& effect : effects) {
    if (!concerns(effect, figure)) continue;
    auto at =
        std::find_if(found.begin(), found.end(), [&](const auto& one) { return one.first == effect.effect; });
    if (at == found.end()) at = found.insert(found.end(), {effect.effect, {}});
    if (!effect.subject.empty()) at->second.push_back(effect.subject);
  }
  return found;
}

}  // namespace

const char* figure_name(Figure figure) {
  switch (figure) {
    case Figure::resolution:
      return "energy resolution";
    case Figure::timing:
      return "CTR";
    case Figure::fraction:
      return "detected fraction";
  }
  return "";
}

Effects omitted_anywhere(const tally::RunResult& run) {
  std::vector<Effects> points;
  for (const tally::PointResult& point : run.points) points.push_back(point.omitted);
  return omitted_anywhere(points);
}

Effects omitted_anywhere(const std::vector<Effects>& points) {
  std::vector<std::pair<tally::OmittedEffect, std::size_t>> found;
  for (const Effects& point : points) {
    if (!point) return std::nullopt;
    for (const tally::OmittedEffect& effect : *point) {
      const auto at = std::find_if(found.begin(), found.end(), [&](const auto& one) {
        return one.first.effect == effect.effect && one.first.subject == effect.subject;
      });
      if (at == found.end())
        found.emplace_back(effect, 1);
      else
        ++at->second;
    }
  }
  std::vector<tally::OmittedEffect> effects;
  for (auto& [effect, count] : found) {
    if (count < points.size()) effect.effect += " at some points";
    effects.push_back(effect);
  }
  return effects;
}

std::string omission_sentence(const Effects& effects, Figure figure) {
  const std::string name = figure_name(figure);
  if (!effects) return "What the " + name + " does not include is not recorded in this result.";
  std::string list;
  for (const auto& [effect, subjects] : by_effect(*effects, figure))
    list +=
        (list.empty() ? "" : "; ") + effect + (subjects.empty() ? "" : " (" + core::list_of(subjects) + ")");
  if (list.empty()) return "The " + name + " includes every effect that is modelled.";
  return "The " + name + " does not include: " + list + ".";
}

std::string omission_note(const Effects& effects, Figure figure) {
  std::string note = "<p class=\"omitted\">" + escape_html(omission_sentence(effects, figure)) + "</p>\n";
  if (!effects) return note;
  std::string items;
  for (const tally::OmittedEffect& effect : *effects)
    if (concerns(effect, figure))
      items += "<li>" +
               escape_html(effect.effect + (effect.subject.empty() ? "" : " (" + effect.subject + ")") +
                           ": " + (effect.remedy.empty() ? "no model of it exists" : effect.remedy)) +
               "</li>\n";
  if (items.empty()) return note;
  return note + "<details class=\"omitted\"><summary>How a scene includes them</summary>\n<ul>\n" + items +
         "</ul></details>\n";
}

}  // namespace scintray::report
