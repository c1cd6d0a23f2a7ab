#include "polhode/torque/torques.hpp"

#include <algorithm>

#include "polhode/core/error.hpp"
#include "polhode/formula/derivative.hpp"
#include "polhode/formula/program.hpp"
#include "polhode/formula/singular.hpp"

namespace polhode {

namespace {

/// Calls a function with the torque that acts in windows, or with the torque itself.
auto visit_lasting(const auto& use, const AnyTorque& torque) {
  return std::visit([&]<class T>(const T& one) {
    if constexpr (std::is_same_v<T, torques::During>) {
      return std::visit(use, one.torque());
    } else {
      return use(one);
    }
  }, torque);
}

}  // namespace

void SeveralTorques::add(const TorqueInput& in, double* tau_B) const {
  for (const AnyTorque& torque : torques) std::visit([&](const auto& one) { one.add(in, tau_B); }, torque);
  if (!rotor_momentum.isZero(0.0)) add_rotors(rotor_momentum.data(), in.omega, tau_B);
}

std::vector<formula::Input> list_states(std::span<const AnyTorque> torques) {
  std::vector<formula::Input> all;
  for (std::size_t i = 0; i < torques.size(); ++i) {
    const torques::Formula* formula = find_formula(torques[i]);
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
  return visit_lasting([]<class T>(const T& one) -> const torques::Formula* {
    if constexpr (std::is_same_v<T, torques::Formula>) {
      return &one;
    } else if constexpr (requires { one.formula(); }) {
      return &one.formula();
    } else {
      return nullptr;
    }
  }, torque);
}

std::optional<formula::KnownTorque> find_known(const AnyTorque& torque) {
  return std::visit([]<class T>(const T& one) -> std::optional<formula::KnownTorque> {
    if constexpr (torques::HasKernel<T>) return one.known();
    return std::nullopt;
  }, torque);
}

std::optional<Matrix3d> find_damping(const AnyTorque& torque, const Matrix3d& inertia_B) {
  using Kind = formula::KnownTorque::Kind;
  const std::optional<formula::KnownTorque> known = find_known(torque);
  if (known && known->kind == Kind::damping) return known->matrix;
  if (known && known->kind == Kind::angular_damping) return known->rate * inertia_B;
  return std::nullopt;
}

bool uses_inertia(const AnyTorque& torque) {
  return visit_lasting([](const auto& one) {
    if constexpr (requires { one.open_law(); }) {
      const std::vector<formula::Input> inputs = one.open_law().parameters;
      return !inputs.empty() && inputs.back().name == torques::inertia_input;
    }
    return false;
  }, torque);
}

formula::Program make_inertia_slope(const AnyTorque& torque, const Matrix3d& inertia_B, const Matrix3d& dI_B) {
  return visit_lasting([&](const auto& one) -> formula::Program {
    if constexpr (requires { one.open_law(); }) {
      formula::Program law = one.open_law();
      std::vector<double> own = formula::list_values(law.parameters);
      if (!own.empty() && law.parameters.back().name == torques::inertia_input) own.resize(own.size() - 9);
      law = formula::bind_some(law, 0, own);
      const std::size_t outputs = law.outputs.size();
      std::vector<formula::Variable> by;
      std::vector<double> change;
      for (int i = 0; i < 9 && !law.parameters.empty(); ++i) {
        if (dI_B(i / 3, i % 3) == 0.0) continue;
        by.push_back({formula::Variable::Kind::parameter, i}), change.push_back(dI_B(i / 3, i % 3));
      }
      const formula::Program slopes = formula::differentiate(law, by);
      formula::Program made = slopes;
      made.outputs.assign(outputs, {});
      for (std::size_t k = 0; k < by.size(); ++k)
        for (std::size_t i = 0; i < outputs; ++i)
          made.outputs[i] = made.outputs[i] + slopes.outputs[outputs * (1 + k) + i] * change[k];
      const std::size_t left = formula::list_values(law.parameters).size();   // nine of the inertia, which is symmetric
      return formula::bind_parameters(made, {inertia_B.data(), inertia_B.data() + left});
    } else {
      formula::Program none;
      none.outputs.assign(3, {});
      return none;
    }
  }, torque);
}

std::string find_singular(std::span<const AnyTorque> torques, const Matrix3d& inertia_B, const State& state,
                          double near) {
  const std::vector<formula::Input> all = list_states(torques);
  for (const AnyTorque& torque : torques) {
    const bool in_windows = std::holds_alternative<torques::During>(torque);
    const torques::Formula* formula = in_windows ? nullptr : find_formula(torque);
    if (formula == nullptr) continue;
    const Vector3d& w = state.omega;
    const Quat& q = state.attitude;
    std::vector<double> y = {w[0], w[1], w[2], q.x, q.y, q.z, q.w};
    for (const formula::Input& one : formula->states()) {
      const formula::Place place = formula::find_place(all, one.name);
      y.insert(y.end(), state.states.begin() + place.first, state.states.begin() + place.first + place.count);
    }
    std::string found = formula::find_singular(formula->program(inertia_B), state.t, y.data(), near);
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

formula::Program make_open_law(const AnyTorque& torque, const Matrix3d& inertia_B) {
  return visit_lasting([&]<class T>(const T& one) -> formula::Program {
    if constexpr (requires { one.open_law(); }) {
      formula::Program law = one.open_law();
      if (!law.parameters.empty() && law.parameters.back().name == torques::inertia_input)
        law.parameters.back().values.assign(inertia_B.data(), inertia_B.data() + 9);   // it is symmetric
      return law;
    } else {
      return make_law(torque, inertia_B);
    }
  }, torque);
}

formula::Program make_bound_law(const AnyTorque& torque, const Matrix3d& inertia_B) {
  if (const torques::Formula* formula = find_formula(torque)) return formula->program(inertia_B);
  const formula::Program law = make_law(torque, inertia_B);
  return formula::bind_parameters(law, formula::list_values(law.parameters));
}

torques::Formula as_formula(const AnyTorque& torque, const Matrix3d& inertia_B) {
  return visit_lasting([&]<class T>(const T& one) -> torques::Formula {
    if constexpr (std::is_same_v<T, torques::Formula>) {
      return one.as_given();
    } else {
      return torques::Formula(make_law(torque, inertia_B), false);
    }
  }, torque);
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
