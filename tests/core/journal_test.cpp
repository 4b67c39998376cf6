// Journals of finished pieces: what is there after any end of a process, and what is refused.
#include "scintray/core/journal.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <thread>

#include "scintray/core/error.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray::core;
using namespace scintray::test;

namespace {

JournalSettings settings(const std::filesystem::path& path, JournalStart start = JournalStart::resume) {
  return {path, start, std::chrono::milliseconds(0)};
}

void write_three(const std::filesystem::path& path) {
  Journal journal(settings(path), "work");
  journal.add("one", "first");
  journal.add("two", bytes_of(std::vector<double>{1.5, -2.0}));
  journal.add("three", std::string(1000, 'x'));
}

}  // namespace

TEST_CASE("Pieces of a journal are there for the next process") {
  const auto path = scratch_folder("journal") / "a.journal";
  {
    Journal journal(settings(path), "work");
    CHECK(journal.pieces() == 0);
    CHECK_FALSE(std::filesystem::exists(path));  // made by the first piece
  }
  write_three(path);
  Journal journal(settings(path), "work");
  CHECK(journal.pieces() == 3);
  CHECK(journal.find("one") == "first");
  CHECK(numbers_of<double>(journal.find("two").value()) == std::vector<double>{1.5, -2.0});
  CHECK_FALSE(journal.find("four").has_value());
  journal.add("four", "");
  CHECK(journal.find("four") == "");
  CHECK(journal.find("three").value().size() == 1000);
  journal.remove();
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE(
    "A journal that ends anywhere, or with damaged bytes, has the pieces before, and goes on after them") {
  const auto folder = scratch_folder("journal_cut");
  write_three(folder / "whole.journal");
  const auto size = std::filesystem::file_size(folder / "whole.journal");
  for (std::uintmax_t cut = 0; cut <= size; cut += cut + 30 < size ? 7 : 1) {
    const auto path = folder / "cut.journal";
    std::filesystem::copy_file(folder / "whole.journal", path,
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(path, cut);
    std::size_t pieces = 0;
    {
      Journal journal(settings(path), "work");
      pieces = journal.pieces();
      CHECK(pieces <= (cut == size ? 3 : 2));
      if (journal.find("one")) CHECK(journal.find("one") == "first");
      journal.add("late", "piece");
    }
    Journal again(settings(path), "work");
    CHECK(again.pieces() == pieces + 1);
    CHECK(again.find("late") == "piece");
  }
  const auto path = folder / "flipped.journal";
  std::filesystem::copy_file(folder / "whole.journal", path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size) - 500);
    file.put('y');
  }
  const Journal flipped(settings(path), "work");
  CHECK(flipped.pieces() == 2);
}

TEST_CASE("A journal of other work, or of this without --resume, is refused with what to do") {
  const auto folder = scratch_folder("journal_refused");
  const auto path = folder / "a.journal";
  const auto complaint = [&](JournalStart start, const std::string& identity) {
    return complaint_of([&] { Journal(settings(path, start), identity); });
  };
  write_three(path);
  check_contains(complaint(JournalStart::refuse, "work"),
                 {"a.journal", "unfinished work", "--resume", "--restart"});
  check_contains(complaint(JournalStart::resume, "other work"), {"a.journal", "other work", "--restart"});
  CHECK(Journal(settings(path), "work").pieces() == 3);  // nothing was lost by it
  CHECK(Journal(settings(path, JournalStart::restart), "work").pieces() == 0);
  {
    Journal other(settings(path, JournalStart::refuse), "other work");
    other.add("only", "piece");
  }
  const Journal other(settings(path), "other work");
  CHECK(other.pieces() == 1);
  const auto foreign = folder / "foreign.journal";
  std::ofstream(foreign) << "what somebody wrote";
  for (const JournalStart start : {JournalStart::refuse, JournalStart::resume, JournalStart::restart})
    check_contains(complaint_of([&] { Journal(settings(foreign, start), "work"); }),
                   {"no journal", "move it away"});
}

TEST_CASE("Threads add and find pieces of one journal") {
  const auto path = scratch_folder("journal_threads") / "a.journal";
  {
    Journal journal(settings(path), "work");
    std::vector<std::thread> threads;
    for (int thread = 0; thread < 4; ++thread)
      threads.emplace_back([&, thread] {
        for (int piece = 0; piece < 25; ++piece) {
          const std::string key = std::to_string(thread) + "." + std::to_string(piece);
          journal.add(key, key);
          if (journal.find(key) != key) throw std::logic_error("a piece is not there");
        }
      });
    for (std::thread& thread : threads) thread.join();
  }
  const Journal journal(settings(path), "work");
  CHECK(journal.pieces() == 100);
  CHECK(journal.find("3.24") == "3.24");
}
