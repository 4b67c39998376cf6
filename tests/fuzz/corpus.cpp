#include "corpus.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace scintray::fuzz {

namespace {

std::vector<std::string> contents_of(const std::filesystem::path& folder, const std::string& extension = {}) {
  if (!std::filesystem::is_directory(folder)) return {};
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file() && (extension.empty() || entry.path().extension() == extension))
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> contents;
  for (const std::filesystem::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    contents.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return contents;
}

std::filesystem::path here() { return SCINTRAY_FUZZ_FOLDER; }

}  // namespace

std::vector<std::string> corpus(const std::string& target) { return contents_of(here() / "corpus" / target); }

std::vector<std::string> found(const std::string& target) { return contents_of(here() / "found" / target); }

std::filesystem::path scene_folder() { return here() / "../../scenes"; }

std::vector<std::string> scene_files() { return contents_of(scene_folder(), ".toml"); }

std::vector<std::string> sound_seeds(const Entry& entry) {
  std::vector<std::string> seeds = entry.seeds();
  for (std::string& content : corpus(entry.name)) seeds.push_back(std::move(content));
  return seeds;
}

std::vector<std::string> all_seeds(const Entry& entry) {
  std::vector<std::string> seeds = sound_seeds(entry);
  for (std::string& content : found(entry.name)) seeds.push_back(std::move(content));
  return seeds;
}

}  // namespace scintray::fuzz
