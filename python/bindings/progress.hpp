#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

#include "bind.hpp"
#include "gil.hpp"
#include "polhode/core/interrupt.hpp"

namespace polhode::python {

/// Work without the lock that reports to Python how far it is: callback(done, total) about fifty times a second, on the
/// calling thread. The work itself only adds to a counter. What the callback raises ends the work.
class ReportedWork {
 public:
  ReportedWork(const py::object& callback, std::size_t total) : callback_(callback), total_(total) {
    if (!callback.is_none()) guard_.emplace([this] { report(done_); });
  }

  /// To be counted up; null if there is no callback.
  std::atomic<std::size_t>* done() { return guard_ ? &done_ : nullptr; }

  /// The last call, with all done.
  void finish() {
    if (guard_) report(total_);
  }

 private:
  void report(std::size_t done) const {
    with_gil([&] {
      check_signals();
      callback_(done, total_);
    });
  }

  const py::object& callback_;
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
  WithoutGil nogil_;
  std::optional<InterruptGuard> guard_;
};

}  // namespace polhode::python
