#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>

#include "bind.hpp"
#include "polhode/core/interrupt.hpp"

// The lock of the interpreter around long work. A daemon thread may ask for it while Python ends. Python up to 3.13
// then unwinds the thread, which no C++ destructor survives. Here the thread waits for the end of the process instead,
// as it does from Python 3.14 on.
namespace polhode::python {

[[noreturn]] void wait_for_the_end();

/// Takes the lock, on any thread. See with_gil.
PyGILState_STATE take_gil();

/// Calls work() with the lock, on any thread. What unwinds a thread when Python ends is no exception of the standard
/// library's kind: `work` loses the lock as soon as it runs a line of Python, and must not give it back then.
template <class Work>
auto with_gil(const Work& work) {
  const struct Held {
    PyGILState_STATE state = take_gil();
    ~Held() { PyGILState_Release(state); }
  } held;
  try {
    return work();
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    wait_for_the_end();
  }
}

/// Work without the lock. Where that work calls check_interrupt, Ctrl-C ends it with KeyboardInterrupt.
class WithoutGil {
 public:
  WithoutGil();
  ~WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  InterruptGuard guard_;
  PyThreadState* state_;
};

/// Lets Python's handlers of signals run. Throws what they raise.
void check_signals();

/// Calls kernel(begin, count) for rows [0, n) in parts, without the lock. The kernel returns `count`, or the first row
/// of the part that it refuses. Returns n, or the first row that is refused.
template <class Kernel>
std::size_t in_parts(std::size_t n, const Kernel& kernel) {
  constexpr std::size_t most = 32768;
  const WithoutGil nogil;
  for (std::size_t begin = 0; begin < n; begin += most) {
    check_interrupt();
    const std::size_t count = std::min(most, n - begin), refused = kernel(begin, count);
    if (refused < count) return begin + refused;
  }
  return n;
}

}  // namespace polhode::python
