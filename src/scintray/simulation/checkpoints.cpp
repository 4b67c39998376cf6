#include "scintray/simulation/checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scintray::simulation {

namespace {

constexpr const char* kEnding = ".ranges";
/// Share of the time that checkpoints may take: the next is due after this many times the last one's cost.
constexpr int kLeastRatio = 100;

/// Files of checkpoints in a folder, by their numbers. Empty for a folder that is not there.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::filesystem::path& path = entry->path();
    if (path.extension() == kEnding && !path.filename().string().starts_with('.')) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

core::InputError refused(const std::filesystem::path& folder, const std::string& what,
                         const std::string& hint) {
  return core::InputError({{folder.string()}, what, hint});
}

/// Removes what ScintRay wrote there, and the folder if nothing else is in it.
void clear(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> mine;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool unfinished = name.starts_with('.') && name.ends_with(".unfinished");
    if (entry->path().extension() == kEnding || unfinished) mine.push_back(entry->path());
  }
  for (const std::filesystem::path& path : mine) std::filesystem::remove(path, error);
  std::filesystem::remove(folder, error);
}

}  // namespace

std::vector<std::filesystem::path> range_files(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return {path};
  return files_in(path);
}

Checkpoints::~Checkpoints() = default;

void Checkpoints::open(const RunOutline& run, const Shard& shard) {
  run_ = run;
  shard_ = shard;
  last_ = Clock::now();
  const std::filesystem::path& folder = settings_.folder;
  const std::vector<std::filesystem::path> files = files_in(folder);
  if (settings_.resume == Resume::restart || files.empty()) return clear(folder);
  std::string other;
  for (const std::filesystem::path& file : files) {
    earlier_.emplace_back(file);
    if (other.empty()) other = difference(run_, earlier_.back().outline());
    if (other.empty() && earlier_.back().shard() != shard_)
      other = fmt::format("the shard is {}/{}, not {}/{}", shard_.number, shard_.of,
                          earlier_.back().shard().number, earlier_.back().shard().of);
  }
  if (settings_.resume == Resume::refuse) {
    earlier_.clear();
    if (!other.empty()) return clear(folder);
    throw refused(folder, "an unfinished run of this scene has left its checkpoints here",
                  "add --resume to go on after them, or --restart to begin anew");
  }
  if (!other.empty())
    throw refused(folder, "these are the checkpoints of another run: here " + other,
                  "run what they are of, or add --restart to begin anew");
  const tally::BlockRange wanted = blocks_of(shard_, run_);
  for (std::size_t point = 0; point < run_.points.size(); ++point) {
    const tally::BlockRange blocks = blocks_of_point(wanted, run_, point);
    std::uint64_t next = blocks.first;
    for (const RangeReader& reader : earlier_)
      for (const StoredRange& range : reader.ranges()) {
        if (range.point != point) continue;
        if (range.blocks.first != next || range.blocks.last > blocks.last)
          throw refused(reader.path(), "blocks are missing before those of this checkpoint",
                        "restore the files that were removed, or add --restart to begin anew");
        next = range.blocks.last;
      }
  }
  const std::string last = files.back().stem().string();
  files_ = std::max<std::size_t>(files.size(), std::strtoul(last.c_str(), nullptr, 10));
}

std::uint64_t Checkpoints::next_block(std::size_t point, std::uint64_t first) const {
  std::uint64_t next = first;
  for (const RangeReader& reader : earlier_)
    for (const StoredRange& range : reader.ranges())
      if (range.point == point) next = std::max(next, range.blocks.last);
  return next;
}

std::uint64_t Checkpoints::earlier_blocks() const {
  std::uint64_t blocks = 0;
  for (const RangeReader& reader : earlier_)
    for (const StoredRange& range : reader.ranges()) blocks += range.blocks.count();
  return blocks;
}

void Checkpoints::replay(std::size_t point, ResultSink& sink) const {
  for (const RangeReader& reader : earlier_)
    for (const StoredRange& range : reader.ranges())
      if (range.point == point) reader.replay(range, sink, false);
}

bool Checkpoints::due() const {
  if (settings_.every.count() == 0) return true;
  const auto interval = std::max<Clock::duration>(settings_.every, kLeastRatio * cost_);
  return Clock::now() - last_ >= interval;
}

RangeFile& Checkpoints::file() {
  if (!file_) {
    std::error_code error;
    std::filesystem::create_directories(settings_.folder, error);
    if (error)
      throw core::SystemError(settings_.folder.string() + ": cannot make the folder: " + error.message());
    file_ =
        std::make_unique<RangeFile>(settings_.folder / fmt::format("{:06}{}", files_ + 1, kEnding), shard_);
    file_->begin(run_);
    if (readout_) file_->begin_events(readout_->point, readout_->channels, readout_->readout);
  }
  return *file_;
}

void Checkpoints::seal() {
  if (!has_range_) return;
  const Clock::time_point start = Clock::now();
  file_->commit(true, {});
  file_.reset();
  ++files_;
  has_range_ = false;
  last_ = Clock::now();
  cost_ = last_ - start;
}

void Checkpoints::remove() {
  file_.reset();
  earlier_.clear();
  clear(settings_.folder);
}

void Checkpoints::surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) {
  if (earlier_.empty()) file().surfaces(analyses);  // else the first of them has these
}

void Checkpoints::paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) {
  file().paths(point, paths);
}

void Checkpoints::begin_events(std::size_t point, const std::vector<tally::ReadoutChannel>& channels,
                               const std::optional<detector::ReadoutSpec>& readout) {
  readout_ = {point, channels, readout};
  if (file_) file_->begin_events(point, channels, readout);
}

void Checkpoints::photons(const std::vector<tally::DetectedPhoton>& photons) { file().photons(photons); }

void Checkpoints::histories(const tally::PhotonHistories& histories, const tally::HistorySubjects& of_point) {
  file().histories(histories, of_point);
}

void Checkpoints::events(const std::vector<tally::EventRecord>& events) { file().events(events); }

void Checkpoints::range(const PointRange& of, const tally::PointSums& sums) {
  file().range(of, sums);
  has_range_ = true;
}

}  // namespace scintray::simulation
