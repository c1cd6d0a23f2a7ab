#pragma once

#include <algorithm>
#include <cstddef>

/// 0 where a process has one thread only, as in WebAssembly without its extension for threads.
#ifndef POLHODE_THREADS
#if defined(__wasm__) && !defined(_REENTRANT)
#define POLHODE_THREADS 0
#else
#define POLHODE_THREADS 1
#endif
#endif

#if POLHODE_THREADS
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "core/interrupt.hpp"
#include "polhode/core/interrupt.hpp"
#endif

namespace polhode {

#if POLHODE_THREADS

/// The number of threads for so many pieces of work: as asked, else what the machine has, and fewer for little work.
inline std::size_t thread_count(int asked, std::size_t pieces, std::size_t least_pieces) {
  const std::size_t useful = std::max<std::size_t>(1, pieces / std::max<std::size_t>(1, least_pieces));
  if (asked > 0) return std::min(useful, static_cast<std::size_t>(asked));
  // To count the processors takes 5 us: the system's library reads a file each time.
  return useful == 1 ? 1 : std::min<std::size_t>(useful, std::max(1u, std::thread::hardware_concurrency()));
}

/// Threads that work while this one waits and asks its InterruptGuard, if there is one.
class Helpers {
 public:
  explicit Helpers(std::size_t most) { threads_.reserve(most); }

  /// Runs work() on a new thread; here, where the system has no more threads.
  template <class Work>
  void start(const Work& work, std::exception_ptr& failure) {
    const auto run = [this, work, &failure] {
      {
        const HelperThread helper(stopped_);
        try {
          work();
        } catch (...) {
          failure = std::current_exception();
        }
      }
      const std::lock_guard lock(mutex_);
      if (--running_ == 0) ended_.notify_all();
    };
    {
      const std::lock_guard lock(mutex_);
      ++running_;
    }
    try {
      threads_.emplace_back(run);
    } catch (const std::system_error&) {
      run();
    }
  }

  /// Waits for all. Throws what the guard threw, once all have ended.
  void wait() {
    std::exception_ptr interruption;
    std::unique_lock lock(mutex_);
    while (running_ > 0) {
      if (interruption || !is_interruptible()) {
        ended_.wait(lock);
        continue;
      }
      ended_.wait_for(lock, std::chrono::milliseconds(20));
      lock.unlock();
      try {
        check_interrupt();
      } catch (...) {
        interruption = std::current_exception();
        stopped_ = true;
      }
      lock.lock();
    }
    lock.unlock();
    for (std::thread& thread : threads_) thread.join();
    if (interruption) std::rethrow_exception(interruption);
  }

 private:
  std::vector<std::thread> threads_;
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t running_ = 0;
};

/// Calls work(begin, end) on ranges that cover [0, n), one a thread, cut at multiples of `grain`. Rethrows the first
/// exception.
template <class Work>
void parallel_for(std::size_t n, std::size_t threads, std::size_t grain, const Work& work) {
  if (threads <= 1 || n <= grain) return work(std::size_t{0}, n);
  const std::size_t run = ((n + threads - 1) / threads + grain - 1) / grain * grain;
  std::vector<std::exception_ptr> failures(threads);
  Helpers helpers(threads);
  for (std::size_t i = 0; i < threads && i * run < n; ++i) {
    helpers.start([&work, n, run, i] { work(i * run, std::min(n, (i + 1) * run)); }, failures[i]);
  }
  helpers.wait();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

#else

/// The same two functions for one thread. A namespace of their own lets a test use them beside those above.
inline namespace sequential {

inline std::size_t thread_count(int, std::size_t, std::size_t) { return 1; }

template <class Work>
void parallel_for(std::size_t n, std::size_t, std::size_t, const Work& work) {
  work(std::size_t{0}, n);
}

}  // namespace sequential

#endif

}  // namespace polhode
