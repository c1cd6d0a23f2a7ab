#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace polhode {

/// The number of threads for so many pieces of work: as asked, else what the machine has, and fewer for little work.
inline std::size_t thread_count(int asked, std::size_t pieces, std::size_t pieces_worth_a_thread) {
  const std::size_t useful = std::max<std::size_t>(1, pieces / std::max<std::size_t>(1, pieces_worth_a_thread));
  const std::size_t available = std::max(1u, std::thread::hardware_concurrency());
  return std::min(useful, asked > 0 ? static_cast<std::size_t>(asked) : available);
}

/// Calls work(begin, end) on ranges that cover [0, n), one a thread, cut at multiples of `grain`. Rethrows the first
/// exception.
template <class Work>
void parallel_for(std::size_t n, std::size_t threads, std::size_t grain, const Work& work) {
  if (threads <= 1 || n <= grain) return work(std::size_t{0}, n);
  const std::size_t run = ((n + threads - 1) / threads + grain - 1) / grain * grain;
  std::vector<std::exception_ptr> failures(threads);
  std::vector<std::thread> workers;
  for (std::size_t i = 0; i < threads && i * run < n; ++i) {
    workers.emplace_back([&, i] {
      try {
        work(i * run, std::min(n, (i + 1) * run));
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : workers) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace polhode
