#pragma once

#include <atomic>

namespace polhode {

/// The value that choose() returns, kept in `chosen` after the first call. There is no lock, as in a static that is
/// initialised late: a thread that holds one while the process forks would leave the child waiting for ever. Threads
/// that come first together choose the same.
template <class T, class Choose>
const T& choose_once(std::atomic<const T*>& chosen, const Choose& choose) {
  const T* found = chosen.load(std::memory_order_acquire);
  if (found == nullptr) chosen.store(found = &choose(), std::memory_order_release);
  return *found;
}

}  // namespace polhode
