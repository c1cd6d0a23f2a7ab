#pragma once

#include <functional>

namespace polhode {

/// While it lives, long work on this thread calls `check` about fifty times a second. Batches that divide their work
/// among threads call it on this thread alone. An exception of `check` ends the work and comes out of it; what was
/// written until then stays. Guards may be nested: the innermost is called.
class InterruptGuard {
 public:
  explicit InterruptGuard(std::function<void()> check);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  std::function<void()> check_;
  const std::function<void()>* outer_;
};

/// Calls the check of this thread's guard if its time has come. Long loops call it every few milliseconds at least.
void check_interrupt();

}  // namespace polhode
