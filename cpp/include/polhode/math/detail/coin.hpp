#pragma once

#include <cstdint>

namespace polhode::math {

/// A fair coin whose tosses are the same on every machine: Vigna's generator splitmix64 (Steele, Lea & Flood 2014,
/// OOPSLA, 453).
class Coin {
 public:
  explicit Coin(std::uint64_t seed = 2026) : state_(seed) {}

  bool toss() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return ((z ^ (z >> 31)) & 1) != 0;
  }

 private:
  std::uint64_t state_;
};

}  // namespace polhode::math
