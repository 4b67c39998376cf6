#include "scintray/simulation/range_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scintray/core/output_file.hpp"
#include "scintray/core/text.hpp"
#include "scintray/simulation/detail/range_stream.hpp"

namespace scintray::simulation {

using detail::encoded;
using detail::Record;

namespace {

std::uint64_t blocks_of_run(const RunOutline& run) {
  std::uint64_t blocks = 0;
  for (const PointOutline& point : run.points) blocks += point.blocks;
  return blocks;
}

/// a * b / c without overflow of the product.
std::uint64_t share_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  __extension__ using Wide = unsigned __int128;
  return static_cast<std::uint64_t>(static_cast<Wide>(a) * b / c);
}

/// Names of files of `from` that `of` does not have with the same content.
std::vector<std::string> other_files(const RunOutline& of, const RunOutline& from) {
  std::vector<std::string> names;
  for (const core::InputFile& file : from.inputs)
    if (std::find(of.inputs.begin(), of.inputs.end(), file) == of.inputs.end()) names.push_back(file.name);
  return names;
}

/// The outline without what may differ: its file's path, and warnings.
std::string identity(RunOutline run) {
  run.header.scene_file.clear();
  run.header.note.clear();
  return encoded(run);
}

std::string counted_work(const RunOutline& run) {
  std::uint64_t work = 0;
  for (const PointOutline& point : run.points) work += point.work;
  return fmt::format("{} {} in {} point{}", work, run.has_energy ? "events" : "photons", run.points.size(),
                     run.points.size() == 1 ? "" : "s");
}

}  // namespace

tally::BlockRange part_of(const Shard& shard, std::uint64_t blocks) {
  return {share_of(blocks, shard.number - 1, shard.of), share_of(blocks, shard.number, shard.of)};
}

std::string list_of_first(std::vector<std::string> names) {
  constexpr std::size_t kMostNamed = 20;
  const bool more = names.size() > kMostNamed;
  names.resize(std::min(names.size(), kMostNamed));
  return core::list_of(names) + (more ? " and more" : "");
}

std::string missing_shards(const std::vector<Shard>& there,
                           const std::function<bool(const Shard&)>& is_missing) {
  constexpr std::size_t kMostExamined = 21;         // one more than are named
  constexpr std::uint64_t kMostShards = 1'000'000;  // examined one by one
  const std::uint64_t of = there.empty() ? 0 : there.front().of;
  const bool alike =
      std::all_of(there.begin(), there.end(), [&](const Shard& shard) { return shard.of == of; });
  if (of <= 1 || of > kMostShards || !alike) return {};
  std::vector<std::string> names;
  for (std::uint64_t number = 1; number <= of && names.size() < kMostExamined; ++number)
    if (is_missing({number, of})) names.push_back(std::to_string(number));
  const bool one = names.size() == 1;
  return fmt::format("shard{} {} of {}", one ? "" : "s", list_of_first(std::move(names)), of);
}

tally::BlockRange blocks_of(const Shard& shard, const RunOutline& run) {
  return part_of(shard, blocks_of_run(run));
}

tally::BlockRange blocks_of_point(const tally::BlockRange& of_run, const RunOutline& run, std::size_t point) {
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < point; ++i) before += run.points[i].blocks;
  const auto within = [&](std::uint64_t block) {
    return block < before ? 0 : std::min(block - before, run.points[point].blocks);
  };
  return {within(of_run.first), within(of_run.last)};
}

std::string difference(const RunOutline& of, const RunOutline& from) {
  if (of.header.version != from.header.version)
    return fmt::format("the version of ScintRay is {}, not {}", of.header.version, from.header.version);
  if (of.header.scene_text != from.header.scene_text) return "the scene file has another text";
  if (of.header.seed != from.header.seed)
    return fmt::format("the seed is {}, not {}", of.header.seed, from.header.seed);
  if (counted_work(of) != counted_work(from))
    return fmt::format("there are {}, not {}", counted_work(of), counted_work(from));
  if (of.inputs != from.inputs) {
    std::vector<std::string> names = other_files(of, from);
    if (names.empty()) names = other_files(from, of);
    return "input files differ: " + core::list_quoted(names);
  }
  return identity(of) == identity(from) ? "" : "the limits of photons, or the names in the results, differ";
}

struct RangeFile::State {
  State(const std::filesystem::path& path, const results::PhotonListLayout& photons)
      : file(path, core::Container::plain),
        records([this](std::string_view bytes) { file.write(bytes); }, photons) {}

  core::OutputFile file;
  detail::RangeWriter records;
};

RangeFile::RangeFile(std::filesystem::path path, const Shard& shard)
    : path_(std::move(path)), shard_(shard) {}

RangeFile::~RangeFile() = default;

void RangeFile::begin(const RunOutline& run) {
  state_ = std::make_unique<State>(path_, run.photons);
  state_->file.write(detail::kMagic);
  state_->file.write(encoded(detail::kRangesVersion));
  state_->records.write(Record::outline, encoded(shard_, run));
}

void RangeFile::surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) {
  state_->records.surfaces(analyses);
}

void RangeFile::paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) {
  state_->records.paths(point, paths);
}

void RangeFile::begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                             const std::optional<detector::ReadoutSpec>& readout) {
  state_->records.begin_events(point, channels, readout);
}

void RangeFile::photons(const std::vector<tally::DetectedPhoton>& photons) {
  state_->records.photons(photons);
}

void RangeFile::histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) {
  state_->records.histories(histories, of_point);
}

void RangeFile::events(const std::vector<tally::EventRecord>& events) { state_->records.events(events); }

void RangeFile::range(const PointRange& of, const tally::PointSums& sums) { state_->records.range(of, sums); }

void RangeFile::commit(bool complete, const std::string&) {
  if (complete) {
    state_->records.write(Record::end, {});
    state_->file.commit();
  }
  state_.reset();
}

tally::PointResult finished_point(const tally::PointSums& sums, const RunOutline& run, std::size_t point,
                                  bool complete) {
  tally::PointResult result = sums.result();
  const PointOutline& outline = run.points[point];
  result.parameters = outline.parameters;
  result.complete = complete;
  result.photons_requested = run.has_energy ? result.emitted : outline.work;
  result.energy.events_requested = run.has_energy ? outline.work : 0;
  return result;
}

}  // namespace scintray::simulation
