#include "derivative/held_friction.hpp"

#include <utility>

#include "polhode/core/error.hpp"

namespace polhode {

using formula::Form;

HeldFriction::HeldFriction(formula::Graph& graph, std::vector<Share> shares)
    : graph_(graph), shares_(std::move(shares)) {
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    const Share& own = shares_[k];
    const Form pivot = dot(own.slope, own.effect);
    if (pivot.is_zero()) throw InvalidInput("friction", "a rate that its own torque changes", "one that it does not");
    for (std::size_t l = k + 1; l < shares_.size(); ++l) {
      Share& other = shares_[l];
      const Form part = divide(dot(other.slope, own.effect), pivot), taken = divide(dot(own.slope, other.effect), pivot);
      for (std::size_t i = 0; i < other.effect.size(); ++i)
        other.effect[i] = other.effect[i] - multiply(taken, own.effect[i]);
      for (std::size_t i = 0; i < other.change.size(); ++i)
        other.change[i] = other.change[i] - multiply(part, own.change[i]);
    }
    pivots_.push_back(pivot);
  }
}

void HeldFriction::add(std::vector<std::vector<Form>>& slopes) const {
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    const std::vector<Form> response = find_response(k);
    for (std::size_t i = 0; i < slopes.size(); ++i)
      for (std::size_t from = 0; from < slopes[i].size(); ++from)
        slopes[i][from] = slopes[i][from] - multiply(response[i], shares_[k].change[from]);
  }
}

void HeldFriction::project(std::vector<Form>& force) const {
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    const Form change = dot(shares_[k].slope, force);
    const std::vector<Form> response = find_response(k);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] = force[i] - multiply(response[i], change);
  }
}

std::vector<Form> HeldFriction::find_response(std::size_t share) const {
  std::vector<Form> response;
  for (const Form& effect : shares_[share].effect) response.push_back(divide(effect, pivots_[share]));
  return response;
}

Form HeldFriction::dot(const std::vector<Form>& a, const std::vector<Form>& b) const {
  Form sum;
  for (std::size_t i = 0; i < a.size(); ++i) sum = sum + multiply(a[i], b[i]);
  return sum;
}

Form HeldFriction::multiply(const Form& a, const Form& b) const {
  return a.is_zero() || b.is_zero() ? Form() : graph_.multiply(a, b);
}

Form HeldFriction::divide(const Form& a, const Form& b) const {
  return a.is_zero() ? Form() : graph_.divide(a, b);
}

}  // namespace polhode
