#pragma once
/// What long work is doing, for those who wait for it.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace scintray::core {

/// A step of long work.
struct Activity {
  std::string what;       ///< such as "placing parts: guide"
  std::size_t done = 0;   ///< of `total`
  std::size_t total = 0;  ///< 0: not known
};

/// Receives the activities of the thread that made it, until it is destroyed. Of several the latest does.
class ActivityObserver {
 public:
  /// `receive` is called by that thread, within report_activity().
  explicit ActivityObserver(std::function<void(const Activity&)> receive);
  ~ActivityObserver();
  ActivityObserver(const ActivityObserver&) = delete;
  ActivityObserver& operator=(const ActivityObserver&) = delete;

 private:
  std::function<void(const Activity&)> receive_;
  ActivityObserver* before_;
  friend void report_activity(std::string_view what, std::size_t done, std::size_t total);
};

/// Reports to the observer of the calling thread what it does next; without one nothing happens.
void report_activity(std::string_view what, std::size_t done = 0, std::size_t total = 0);

}  // namespace scintray::core
