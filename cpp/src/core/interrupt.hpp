#pragma once

#include <atomic>

namespace polhode {

/// On a thread that helps another: `check_interrupt` throws Interrupted there once `stopped` is set.
class HelperThread {
 public:
  explicit HelperThread(const std::atomic<bool>& stopped);
  ~HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;
};

/// Ends the work of a helper. The thread that it helps throws the exception that the caller sees.
struct Interrupted {};

/// Whether `check_interrupt` can throw on this thread.
bool is_interruptible();

}  // namespace polhode
