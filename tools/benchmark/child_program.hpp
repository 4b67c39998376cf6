#pragma once
/// Another program that runs beside this one and answers line by line.

#include <sys/types.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace scintray::bench {

/// A running program with pipes to its standard input and output. Ended by the end of its input.
class ChildProgram {
 public:
  /// @param arguments  the program first: a path, or a name that is looked up in PATH
  /// @throws SystemError when it cannot be started
  explicit ChildProgram(const std::vector<std::string>& arguments);
  /// Closes its input and waits for its end.
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// Lets its main thread, and those that it starts from now on, run on this processor only.
  /// @throws SystemError when that is not one that it may run on
  void keep_on(int processor);

  /// Writes a line to its input. @throws SystemError when it has ended
  void write_line(const std::string& line);
  /// The next line of its output, without the line's end; nothing when it has ended.
  std::optional<std::string> read_line();

 private:
  pid_t process_ = 0;
  std::FILE* input_ = nullptr;   ///< to the program
  std::FILE* output_ = nullptr;  ///< from it
};

}  // namespace scintray::bench
