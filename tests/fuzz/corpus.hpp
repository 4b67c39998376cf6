#pragma once
/// Files for the readers in this folder: corpus/TARGET has sound ones of formats that are text, found/TARGET
/// those on which a reader once failed.

#include <filesystem>
#include <string>
#include <vector>

#include "entries.hpp"

namespace scintray::fuzz {

/// Contents of the files in corpus/TARGET, sorted by name; none without such a folder.
std::vector<std::string> corpus(const std::string& target);
/// Contents of those in found/TARGET.
std::vector<std::string> found(const std::string& target);

/// Folder of the repository's scenes, and contents of its files.
std::filesystem::path scene_folder();
std::vector<std::string> scene_files();

/// Sound files of an entry: its own seeds, then its corpus.
std::vector<std::string> sound_seeds(const Entry& entry);

/// What is damaged further: the sound files, then those found.
std::vector<std::string> all_seeds(const Entry& entry);

}  // namespace scintray::fuzz
