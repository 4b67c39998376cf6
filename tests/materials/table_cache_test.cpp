/// Tables kept between runs: what is kept, and what is built again.

#include "scintray/materials/table_cache.hpp"

#include <doctest/doctest.h>

#include <chrono>

#include "materials/small_tables.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/materials/built_in_microsurfaces.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/optics/table_group.hpp"
#include "scintray/topography/build_table.hpp"
#include "support/environment.hpp"
#include "support/shared.hpp"
#include "support/table_digest.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::materials;
using namespace scintray::optics;
using namespace scintray::test;
using namespace scintray::topography;

namespace {

void set_age(const Path& file, std::chrono::hours age) {
  std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - age);
}

}  // namespace

TEST_CASE("a table is built once, and then read with the same bits") {
  Cache cache(test::scratch_folder("cache_once") / "made" / "by" / "the cache");
  const auto built = cache.get("a"), read = cache.get("a");
  CHECK(cache.built == 1);
  CHECK(built != read);
  CHECK(content_digest(*read) == content_digest(*built));
  CHECK(content_digest(*read) == content_digest(small_table()));
  CHECK(content_digest(small_table(2)) != content_digest(*read));
  CHECK(read->provenance().version == built->provenance().version);
  cache.get("b");
  CHECK(cache.built == 2);
  CHECK(cache.warnings.empty());
  CHECK(entries(cache.hooks.cache) == 2);  // neither locks nor unfinished files are left
}

TEST_CASE("the description of a kept table") {
  Cache cache(test::scratch_folder("cache_description"));
  const auto table = cache.get("a");
  const std::vector<CacheFile> files = CacheFolder(cache.hooks.cache).files();
  REQUIRE(files.size() == 1);
  CHECK(files[0].bytes == std::filesystem::file_size(files[0].path));
  const auto described = describe_cached(files[0].path);
  REQUIRE(described.has_value());
  CHECK(described->surface == "ground");
  CHECK(described->media == "LSO to air");
  CHECK(described->version == table->provenance().version);
  REQUIRE(described->spectrum.size() == 1);
  CHECK(described->spectrum[0].wavelength_nm == 420.0);
  CHECK(described->spectrum[0].index.inside == 1.8);
  write_table(cache.hooks.cache / "plain.h5", *table);
  CHECK_FALSE(describe_cached(cache.hooks.cache / "plain.h5").has_value());
}

TEST_CASE("a file of another key is no hit, though its name is that of this one") {
  Cache cache(test::scratch_folder("cache_collision"));
  const CacheFolder folder(cache.hooks.cache);
  cache.get("a");
  std::filesystem::rename(folder.file_of("a"), folder.file_of("b"));
  cache.get("b");
  CHECK(cache.built == 2);
  cache.get("b");
  CHECK(cache.built == 2);
}

TEST_CASE("a damaged file is built again and replaced, wherever the damage is") {
  Cache cache(test::scratch_folder("cache_damage"));
  const Path file = CacheFolder(cache.hooks.cache).file_of("a");
  const std::string digest = content_digest(*cache.get("a")), whole = content_of(file);
  REQUIRE(cache.built == 1);
  for (const std::string& damaged :
       {std::string(), std::string("no table"), whole.substr(0, whole.size() / 2), whole.substr(0, 100)}) {
    const int before = cache.built;
    write(file, damaged);
    CHECK(content_digest(*cache.get("a")) == digest);
    CHECK(cache.built == before + 1);
    CHECK(content_digest(*cache.get("a")) == digest);
    CHECK(cache.built == before + 1);
  }
  CHECK(cache.warnings.size() == 4);
}

TEST_CASE("every flipped bit is noticed") {
  Cache cache(test::scratch_folder("cache_flips"));
  const Path file = CacheFolder(cache.hooks.cache).file_of("a");
  const auto table = cache.get("a");
  const std::string digest = content_digest(*table), whole = content_of(file);
  const auto built_again = [&](std::size_t place) {
    std::string flipped = whole;
    flipped[place] ^= 0x10;
    write(file, flipped);
    const int before = cache.built;
    CHECK(content_digest(*cache.get("a")) == digest);
    return cache.built > before;
  };
  constexpr std::size_t kFlips = 97;
  for (std::size_t k = 0; k < kFlips; ++k) CHECK(built_again(k * whole.size() / kFlips));
  CHECK(built_again(whole.size() - 1));
}

TEST_CASE("the least recently used tables are removed beyond the limit, and other files stay") {
  const Path folder = test::scratch_folder("cache_limit");
  Cache cache(folder);
  cache.get("a");
  const std::uint64_t one = std::filesystem::file_size(CacheFolder(folder).file_of("a"));
  cache.hooks.cache_bytes = 2 * one + one / 2;
  cache.get("b");
  const std::string foreign = "table-0123456789abcdef0123456789abcdef";
  for (const std::string name : {"notes.txt", "table-mine.h5", "table-0123456789ABCDEF0123456789ABCDEF.h5"})
    write(folder / name, std::string(one, 'x'));
  std::filesystem::create_directory(folder / (foreign + ".h5"));
  std::filesystem::create_symlink(folder / "notes.txt", folder / "table-fedcba9876543210fedcba9876543210.h5");
  set_age(CacheFolder(folder).file_of("a"), std::chrono::hours(3));
  set_age(CacheFolder(folder).file_of("b"), std::chrono::hours(2));
  cache.get("a");  // its use is what counts, not when it was made
  CHECK(cache.built == 2);
  const h5::File reader = h5::File::open(CacheFolder(folder).file_of("b"));
  cache.get("c");
  CHECK(cache.built == 3);
  CHECK(std::filesystem::exists(CacheFolder(folder).file_of("a")));
  CHECK_FALSE(std::filesystem::exists(CacheFolder(folder).file_of("b")));
  CHECK(std::filesystem::exists(CacheFolder(folder).file_of("c")));
  CHECK(content_digest(read_table(reader)) == content_digest(small_table()));  // still open here
  CHECK(entries(folder) == 7);
  CHECK(cache.warnings.empty());

  CHECK(CacheFolder(folder).remove_before(std::chrono::system_clock::time_point::max()).files == 2);
  CHECK(entries(folder) == 5);
}

TEST_CASE("files of earlier versions count and are removed") {
  const Path folder = test::scratch_folder("cache_earlier");
  write(folder / "table-0123456789abcdef.h5", std::string(1000, 'x'));
  const auto files = CacheFolder(folder).files();
  REQUIRE(files.size() == 1);
  CHECK_FALSE(describe_cached(files[0].path).has_value());
  const auto removed = CacheFolder(folder).remove_before(std::chrono::system_clock::time_point::max());
  CHECK(removed.files == 1);
  CHECK(removed.bytes == 1000);
}

TEST_CASE("tables last used before a time are removed") {
  const Path folder = test::scratch_folder("cache_old");
  Cache cache(folder);
  cache.get("a");
  cache.get("b");
  set_age(CacheFolder(folder).file_of("a"), std::chrono::hours(48));
  const auto day_ago = std::chrono::system_clock::now() - std::chrono::hours(24);
  CHECK(CacheFolder(folder).remove_before(day_ago).files == 1);
  CHECK_FALSE(std::filesystem::exists(CacheFolder(folder).file_of("a")));
}

TEST_CASE("a table larger than the limit is not kept, and that is said") {
  const Path folder = test::scratch_folder("cache_small");
  Cache cache(folder);
  cache.get("a");
  cache.hooks.cache_bytes = 1000;
  cache.get("b");
  CHECK(cache.built == 2);
  REQUIRE(cache.warnings.size() == 1);
  CHECK(cache.warnings[0].find("SCINTRAY_CACHE_SIZE") != std::string::npos);
  CHECK(std::filesystem::exists(CacheFolder(folder).file_of("a")));
  CHECK_FALSE(std::filesystem::exists(CacheFolder(folder).file_of("b")));
}

TEST_CASE("with a limit of 0, or without a folder, nothing is read or kept") {
  const Path folder = test::scratch_folder("cache_none");
  Cache cache(folder);
  cache.get("a");
  cache.hooks.cache_bytes = 0;
  cache.get("a");
  cache.get("b");
  cache.hooks.cache.clear();
  cache.hooks.cache_bytes.reset();
  cache.get("a");
  CHECK(cache.built == 4);
  CHECK(entries(folder) == 1);
  CHECK(cache.warnings.empty());
}

TEST_CASE("a folder that cannot be written is said once, and stops nothing") {
  const Path folder = test::scratch_folder("cache_unwritable");
  write(folder / "file", "no folder");
  Cache cache(folder / "file" / "cache");
  TableCache kept(cache.hooks);
  for (const char* key : {"a", "b"})
    CHECK(kept.get({key, "ground", ""}, [] { return small_table(); }) != nullptr);
  REQUIRE(cache.warnings.size() == 1);
  CHECK(cache.warnings[0].find("not kept") != std::string::npos);
  CHECK(cache.warnings[0].find((folder / "file").string()) != std::string::npos);
}

TEST_CASE("waiting is shown and can be stopped") {
  const Path folder = test::scratch_folder("cache_wait");
  const auto held = CacheFolder(folder).try_lock("a");
  REQUIRE(held.has_value());
  Cache cache(folder);
  std::string waited_for;
  cache.hooks.table_waiting = [&](const std::string& surface) { waited_for = surface; };
  cache.hooks.stop = [&] { return !waited_for.empty(); };
  CHECK_THROWS_AS(cache.get("a"), TableStopped);
  CHECK(waited_for == "ground");
  CHECK(cache.built == 0);
}

TEST_CASE("an error or a stop while a table is built keeps nothing and releases the lock") {
  const Path folder = test::scratch_folder("cache_error");
  Cache cache(folder);
  TableCache kept(cache.hooks);
  CHECK_THROWS_AS(kept.get({"a", "", ""}, []() -> SurfaceTable { throw TableStopped("stopped"); }),
                  TableStopped);
  CHECK(entries(folder) == 0);
}

TEST_CASE("the limit in the environment has a unit, and a wrong one is said") {
  const test::ScopedVariable size("SCINTRAY_CACHE_SIZE", "20 MB");
  CHECK(cache_limit().bytes == 20'000'000);
  size.set("much");
  CHECK(cache_limit().bytes == kDefaultCacheBytes);
  CHECK(cache_limit().warning.find("\"much\"") != std::string::npos);
  Cache cache(test::scratch_folder("cache_environment"));
  cache.hooks.cache_bytes.reset();
  cache.get("a");
  CHECK(cache.warnings.size() == 1);
  size.set(std::nullopt);
  CHECK(cache_limit().bytes == kDefaultCacheBytes);
  CHECK(cache_limit().warning.empty());
}

namespace {

/// A relief that counts how often its height field is made.
class CountedRelief : public ReliefSpec {
 public:
  static inline int made = 0;

 protected:
  std::string relief_key() const override { return "counted"; }
  Relief make_relief() const override {
    ++made;
    Relief relief;
    SynthesisRecipe recipe;
    recipe.gaussian = {0.1, 1.0};
    recipe.columns = recipe.rows = 32;
    relief.field = std::make_shared<const HeightField>(make_height_field(synthesize(recipe)));
    return relief;
  }
};

Medium medium(const std::string& name, double index) {
  Medium made;
  made.name = name;
  made.index = Curve::constant(index);
  return made;
}

std::string digest_of(const SurfaceSpec& spec, const Path& folder, double index = 1.8) {
  SurfaceFactory::Hooks hooks;
  hooks.cache = folder;
  hooks.cache_bytes = kDefaultCacheBytes;
  const Surface made = SurfaceFactory(hooks)
                           .make(spec, medium("glass", index), medium("air", 1.0), 420.0, 420.0, 420.0)
                           .surface;
  return content_digest(*made.microsurface.get_if<SurfaceTable>());
}

}  // namespace

TEST_CASE(
    "the height field of a cached table is not made, and the table has the bits of one without a cache") {
  const Path folder = test::scratch_folder("cache_lazy");
  CountedRelief relief;
  relief.table = TracingSpec{few_rays(), {}};
  SurfaceSpec spec;
  spec.microsurface = relief;
  const std::string built = digest_of(spec, folder);
  CHECK(CountedRelief::made == 1);
  CHECK(digest_of(spec, folder) == built);
  CHECK(CountedRelief::made == 1);
  CHECK(digest_of(spec, {}) == built);
  CHECK(CountedRelief::made == 2);
  CHECK(digest_of(spec, folder, 1.7) != built);
  CHECK(CountedRelief::made == 3);
  const auto files = CacheFolder(folder).files();
  REQUIRE(files.size() == 2);
  CHECK(describe_cached(files[0].path)->media == "glass to air");
}

TEST_CASE("a height map whose content changes is tabulated again") {
  const Path folder = test::scratch_folder("cache_map");
  const auto write_map = [&](double height) {
    HeightMap map;
    map.columns = map.rows = 8;
    map.pitch_x_um = map.pitch_y_um = 1.0;
    map.heights_um.assign(64, 0.0);
    map.at(3, 3) = height;
    write_gsf(folder / "map.gsf", map);
  };
  HeightMapSpec map;
  map.path = folder / "map.gsf";
  map.table = TracingSpec{few_rays(), {}};
  SurfaceSpec spec;
  spec.microsurface = map;
  write_map(1.0);
  const auto time = std::filesystem::last_write_time(folder / "map.gsf");
  const std::string before = digest_of(spec, folder / "cache");
  CHECK(digest_of(spec, folder / "cache") == before);
  write_map(2.0);
  std::filesystem::last_write_time(folder / "map.gsf", time);
  CHECK(digest_of(spec, folder / "cache") != before);
  CHECK(digest_of(spec, folder / "cache") == digest_of(spec, {}));
}
