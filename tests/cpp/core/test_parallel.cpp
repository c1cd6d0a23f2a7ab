#include <doctest/doctest.h>

#include <vector>

#define POLHODE_THREADS 0   // as in WebAssembly
#include "core/parallel.hpp"

using namespace polhode;

TEST_CASE("parallel: without threads the same calls do all the work here, in one piece") {
  CHECK(thread_count(8, 1'000'000, 1) == 1);
  CHECK(thread_count(0, 1'000'000, 1) == 1);
  std::vector<int> done(100, 0);
  int calls = 0;
  parallel_for(done.size(), 4, 16, [&](std::size_t begin, std::size_t end) {
    ++calls;
    for (std::size_t i = begin; i < end; ++i) ++done[i];
  });
  CHECK(calls == 1);
  CHECK(done == std::vector<int>(100, 1));
  CHECK_THROWS_AS(parallel_for(1, 1, 1, [](std::size_t, std::size_t) { throw 7; }), int);
}
