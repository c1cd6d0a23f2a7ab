#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "polhode/core/detail/float_flags.hpp"

namespace polhode {

/// A value that no computation can start from; Python sees it as a ValueError.
/// The message states the place, the requirement, the value found and, if known, the likely cause.
class InvalidInput : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;

  /// "omega: must be finite, got nan (...)" from its parts; leave `likely_cause` empty when there is none.
  InvalidInput(std::string_view where, std::string_view requirement, std::string_view found,
               std::string_view likely_cause = {});
};

/// A computation that started well and could not be carried to its end; Python sees it as a RuntimeError.
class IntegrationFailure : public std::runtime_error {
 public:
  IntegrationFailure(double time, const std::string& reason);

  double time() const noexcept { return time_; }                      ///< time reached [s]
  const std::string& reason() const noexcept { return reason_; }

 private:
  double time_;
  std::string reason_;
};

/// The shortest decimal text that reads back as the same double, for messages.
std::string to_text(double value);

}  // namespace polhode
