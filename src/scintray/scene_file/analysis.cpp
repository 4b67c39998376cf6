#include "scintray/scene_file/analysis.hpp"

namespace scintray::scene_file {

namespace {

constexpr std::int64_t kMostSlices = 1000;
constexpr std::int64_t kMostPeaks = 100'000;

constexpr core::Word<bool> kLogRatio[] = {{"share", false}, {"logarithm", true}};
constexpr core::Word<bool> kLinearCalibration[] = {{"monotone", false}, {"linear", true}};

std::optional<DepthSpec> read_depth(const config::TomlTable& table) {
  const std::optional<config::TomlTable> depth = table.optional_table("depth");
  if (!depth) return std::nullopt;
  DepthSpec spec;
  spec.origin = depth->optional_quantity3("from", core::Dimension::length).value_or(spec.origin);
  if (!depth->has("along"))
    depth->report("along", "a depth needs its direction",
                  "give along = [0, 0, 1]; depths count from the point \"from\"");
  spec.along = depth->optional_direction("along").value_or(spec.along);
  return spec;
}

std::vector<std::vector<config::NameRef>> read_layers(const config::TomlTable& table) {
  std::vector<std::vector<config::NameRef>> layers;
  for (const config::TomlTable& layer : table.tables("layer")) {
    layers.emplace_back();
    for (const std::string& part : layer.strings("parts"))
      layers.back().push_back({part, layer.where("parts")});
    layer.expect("parts", !layers.back().empty(), "a layer without parts",
                 "name them, as parts = [\"crystal[*,*,0]\"]");
  }
  table.expect("layer", layers.size() != 1, "one layer alone tells nothing apart",
               "give a [[analysis.layer]] for each layer, or none");
  return layers;
}

}  // namespace

AnalysisSpec read_analysis(const config::TomlTable& scene) {
  AnalysisSpec spec;
  const std::optional<config::TomlTable> table = scene.optional_table("analysis");
  if (!table) return spec;
  spec.where = table->where();
  spec.depth = read_depth(*table);
  if (table->has("photopeak")) {
    const std::vector<double> window = table->numbers("photopeak");
    const bool good = window.size() == 2 && window[0] < window[1];
    table->expect("photopeak", good, "\"photopeak\" is not two numbers, the lower first",
                  "give the light between which the peak lies, as [500, 1200]");
    if (good) spec.photopeak = {window[0], window[1]};
  }
  spec.log_ratio = table->choice("ratio", kLogRatio, false);
  spec.linear_calibration = table->choice("calibration", kLinearCalibration, false);
  const std::int64_t slices = table->integer("slices", static_cast<std::int64_t>(spec.slices));
  table->expect("slices", slices >= 2 && slices <= kMostSlices, "the number of slices is not in 2 to 1000");
  if (slices >= 2 && slices <= kMostSlices) spec.slices = static_cast<std::size_t>(slices);
  spec.anger_power = table->number("anger_power", spec.anger_power);
  table->expect("anger_power", spec.anger_power > 0.0, "a power of the light must be above 0");
  spec.anger_threshold =
      table->quantity("anger_threshold", core::Dimension::dimensionless, spec.anger_threshold);
  table->expect("anger_threshold", spec.anger_threshold >= 0.0 && spec.anger_threshold < 1.0,
                "a threshold lies from 0 to below 1", "give a share of the brightest channel, as \"5 %\"");
  if (const auto peaks = table->optional_integer("peaks")) {
    table->expect("peaks", *peaks >= 1 && *peaks <= kMostPeaks, "the number of peaks is not in 1 to 100000");
    if (*peaks >= 1 && *peaks <= kMostPeaks) spec.peaks = static_cast<std::size_t>(*peaks);
  }
  spec.layers = read_layers(*table);
  spec.reference = {table->string("reference", ""), table->where("reference")};
  spec.photopeak_only = table->boolean("photopeak_only", spec.photopeak_only);
  return spec;
}

AnalysisSpec analysis_of_text(const std::string& text, const std::string& file) {
  core::Problems problems;
  const config::TomlTable root(config::parse_toml(text, file), problems);
  const AnalysisSpec spec = read_analysis(root);
  for (const std::string& key : root.keys())
    if (key != "analysis") root.take(key);
  root.finish();
  problems.throw_if_any();
  return spec;
}

}  // namespace scintray::scene_file
