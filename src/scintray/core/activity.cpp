#include "scintray/core/activity.hpp"

#include <utility>

namespace scintray::core {

namespace {
thread_local ActivityObserver* observer = nullptr;
}  // namespace

ActivityObserver::ActivityObserver(std::function<void(const Activity&)> receive)
    : receive_(std::move(receive)), before_(std::exchange(observer, this)) {}

ActivityObserver::~ActivityObserver() { observer = before_; }

void report_activity(std::string_view what, std::size_t done, std::size_t total) {
  if (observer) observer->receive_({std::string(what), done, total});
}

}  // namespace scintray::core
