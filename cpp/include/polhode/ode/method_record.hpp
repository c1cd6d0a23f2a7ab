#pragma once

#include <string_view>

namespace polhode::ode {

/// What the list of methods tells about each of them; ph.methods(), the command line and the docs show it.
struct MethodRecord {
  std::string_view name;
  int order;                   ///< of the solution that is carried on
  int dense_order;             ///< of the continuous extension
  bool adaptive;               ///< chooses its own steps by rtol and atol; else step= is asked for
  std::string_view keeps;      ///< invariants kept to rounding, or "nothing"
  std::string_view doc;
  std::string_view source;
};

}  // namespace polhode::ode
