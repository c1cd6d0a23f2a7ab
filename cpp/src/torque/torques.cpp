#include "polhode/torque/torques.hpp"

#include <algorithm>

#include "polhode/core/error.hpp"
#include "polhode/formula/program.hpp"
#include "polhode/formula/singular.hpp"

namespace polhode {

void SeveralTorques::add(const TorqueInput& in, double* tau_B) const {
  for (const AnyTorque& torque : torques) std::visit([&](const auto& one) { one.add(in, tau_B); }, torque);
  if (!rotor_momentum.isZero(0.0)) add_rotors(rotor_momentum.data(), in.omega, tau_B);
}

std::vector<formula::Input> list_states(std::span<const AnyTorque> torques) {
  std::vector<formula::Input> all;
  for (std::size_t i = 0; i < torques.size(); ++i) {
    const auto* formula = std::get_if<torques::Formula>(&torques[i]);
    if (formula == nullptr) continue;
    for (const formula::Input& state : formula->states()) {
      const auto same = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == state.name; });
      if (same == all.end()) {
        all.push_back(state);
      } else if (same->values != state.values) {
        throw InvalidInput("torques[" + std::to_string(i) + "].states." + state.name, "as in the torques before it",
                           "another start", "name states of different torques differently");
      }
    }
  }
  return all;
}

AnyTorque to_any(const LastingTorque& torque) {
  return std::visit([](const auto& one) { return AnyTorque(one); }, torque);
}

LastingTorque drop_windows(const AnyTorque& torque) {
  return std::visit(
      []<class T>(const T& one) -> LastingTorque {
        if constexpr (std::is_same_v<T, torques::During>) {
          return one.torque();
        } else {
          return one;
        }
      },
      torque);
}

const torques::Formula* find_formula(const AnyTorque& torque) {
  const auto* during = std::get_if<torques::During>(&torque);
  return during != nullptr ? std::get_if<torques::Formula>(&during->torque()) : std::get_if<torques::Formula>(&torque);
}

std::string find_singular(std::span<const AnyTorque> torques, const State& state, double near) {
  const std::vector<formula::Input> all = list_states(torques);
  for (const AnyTorque& torque : torques) {
    const auto* formula = std::get_if<torques::Formula>(&torque);
    if (formula == nullptr) continue;
    const Vector3d& w = state.omega;
    const Quat& q = state.attitude;
    std::vector<double> y = {w[0], w[1], w[2], q.x, q.y, q.z, q.w};
    for (const formula::Input& one : formula->states()) {
      const formula::Place place = formula::find_place(all, one.name);
      y.insert(y.end(), state.states.begin() + place.first, state.states.begin() + place.first + place.count);
    }
    std::string found = formula::find_singular(formula->program(), state.t, y.data(), near);
    if (!found.empty()) return found;
  }
  return "";
}

formula::Program make_law(const AnyTorque& torque, const Matrix3d& inertia_B) {
  return std::visit(
      [&](const auto& any) -> formula::Program {
        if constexpr (requires { any.law(inertia_B); }) {
          return any.law(inertia_B);
        } else if constexpr (requires { any.windows(); any.torque(); }) {
          return make_law(to_any(any.torque()), inertia_B);
        } else {
          throw InvalidInput("torques", "formulas", std::string(any.record().name));
        }
      },
      torque);
}

formula::Program make_bound_law(const AnyTorque& torque, const Matrix3d& inertia_B) {
  if (const auto* formula = std::get_if<torques::Formula>(&torque)) return formula->program();
  const formula::Program law = make_law(torque, inertia_B);
  return formula::bind_parameters(law, formula::list_values(law.parameters));
}

TorqueTraits traits(const AnyTorque& torque) {
  return std::visit([](const auto& any) { return any.traits(); }, torque);
}

std::string_view torque_name(const AnyTorque& torque) {
  return std::visit([](const auto& lasting) { return lasting.record().name; }, torque);
}

TorqueSum summarize(std::span<const AnyTorque> torques) {
  TorqueSum sum;
  bool same_pattern = true, rotating = false, stationary = true;
  for (const AnyTorque& torque : torques) {
    const TorqueTraits t = traits(torque);
    if (t.vanishes) continue;
    ++sum.acting;
    sum.uses_time |= t.uses_time;
    sum.uses_attitude |= t.uses_attitude;
    sum.uses_rates |= t.uses_rates;
    sum.has_potential &= t.has_potential;
    sum.keeps_vertical &= t.keeps_vertical;
    if (t.pattern_rate != 0.0) {
      same_pattern &= !rotating || t.pattern_rate == sum.pattern_rate;
      sum.pattern_rate = t.pattern_rate;
      rotating = true;
    } else {
      // A potential that is symmetric about the vertical is stationary in every rotating frame.
      same_pattern &= t.keeps_vertical && !t.uses_time;
      stationary &= !t.uses_time;
    }
  }
  sum.keeps_energy = sum.has_potential && !rotating && stationary;
  sum.keeps_jacobi = sum.has_potential && rotating && same_pattern;
  return sum;
}

void add_rotors(TorqueSum& sum, bool steady) {
  ++sum.acting;
  sum.rotors = sum.uses_rates = true;
  sum.steady_rotors = steady;
  if (steady) return;
  sum.uses_time = true;
  sum.keeps_energy = sum.keeps_jacobi = false;   // the motor of a wheel does work
}

}  // namespace polhode
