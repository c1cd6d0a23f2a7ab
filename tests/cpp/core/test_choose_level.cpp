#include "core/choose_level.hpp"

#include <doctest/doctest.h>

namespace {

const int* find_one(int) {
  static const int one = 1;
  return &one;
}

const int* find_two(int) {
  static const int two = 2;
  return &two;
}

const int* find_three(int n) {
  static const int three = 3;
  return n > 0 ? &three : nullptr;
}

const int* find_none(int) { return nullptr; }

}  // namespace

TEST_CASE("a level has its own kernels, or those of the next level below that has some") {
  using polhode::choose_level, polhode::SimdLevel;
  CHECK(*choose_level(SimdLevel::avx512, find_one, find_two, find_three, 1) == 3);
  CHECK(*choose_level(SimdLevel::avx512, find_one, find_two, find_three, 0) == 2);
  CHECK(*choose_level(SimdLevel::avx512, find_one, find_none, find_none, 1) == 1);
  CHECK(*choose_level(SimdLevel::avx2, find_one, find_two, find_three, 1) == 2);
  CHECK(*choose_level(SimdLevel::baseline, find_one, find_two, find_three, 1) == 1);
}
