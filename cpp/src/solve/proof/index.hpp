#pragma once

#include <cstddef>

namespace polhode::proof {

template <class Integer>
constexpr std::size_t to_index(Integer i) {
  return static_cast<std::size_t>(i);
}

}  // namespace polhode::proof
