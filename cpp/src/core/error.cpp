#include "polhode/core/error.hpp"

#include <charconv>

namespace polhode {
namespace {

std::string assemble(std::string_view where, std::string_view requirement, std::string_view found,
                     std::string_view likely_cause) {
  std::string message;
  message.append(where).append(": must be ").append(requirement);
  if (!found.empty()) message.append(", got ").append(found);
  if (!likely_cause.empty()) message.append(" (").append(likely_cause).append(")");
  return message;
}

}  // namespace

InvalidInput::InvalidInput(std::string_view where, std::string_view requirement, std::string_view found,
                           std::string_view likely_cause)
    : std::invalid_argument(assemble(where, requirement, found, likely_cause)) {}

IntegrationFailure::IntegrationFailure(double time, const std::string& reason)
    : std::runtime_error("integration stopped at t = " + to_text(time) + " s: " + reason),
      time_(time),
      reason_(reason) {}

std::string to_text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

}  // namespace polhode
