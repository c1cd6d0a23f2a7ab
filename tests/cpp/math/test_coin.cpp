#include <doctest/doctest.h>

#include <cstdlib>
#include <initializer_list>

#include "polhode/math/detail/coin.hpp"

using polhode::math::Coin;

TEST_CASE("the coin tosses the last bits of splitmix64") {
  // Published outputs for the seed 0: e220a8397b1dcdaf, 6e789e6aa1b965f4, 06c45d188009454f, f88bb8a8724c81ec,
  // 1b39896a51a8749b.
  Coin coin(0);
  for (const bool expected : {true, false, true, false, true}) CHECK(coin.toss() == expected);
}

TEST_CASE("the coin is fair, and each seed has tosses of its own") {
  Coin first, second(7);
  int heads = 0, equal = 0;
  for (int i = 0; i < 10000; ++i) {
    const bool toss = first.toss();
    heads += toss, equal += toss == second.toss();
  }
  CHECK(std::abs(heads - 5000) < 200);   // four standard deviations
  CHECK(std::abs(equal - 5000) < 200);
}
