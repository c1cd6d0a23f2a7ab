#include "solve/ground/formulas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "polhode/core/error.hpp"
#include "polhode/formula/recognise.hpp"

namespace polhode {
namespace {

using formula::KnownTorque;
using torques::During;
using torques::Formula;

LastingTorque make_torque(const KnownTorque& known) {
  using Kind = KnownTorque::Kind;
  const Vector3d& v = known.vector;
  switch (known.kind) {
    case Kind::constant_in_body: return torques::Constant(v, torques::Constant::Frame::body);
    case Kind::constant_in_space: return torques::Constant(v, torques::Constant::Frame::space);
    case Kind::damping: return torques::Damping(known.matrix);
    case Kind::angular_damping: return torques::AngularDamping(known.rate);
    case Kind::rotors: {   // v x w
      Matrix3d C;
      C << 0, v[2], -v[1], -v[2], 0, v[0], v[1], -v[0], 0;
      return torques::Damping(C);
    }
    case Kind::gravity: return torques::Gravity(1.0, v);
    case Kind::gravity_gradient: break;
  }
  return torques::GravityGradient(known.rate, known.phase);
}

std::string show(const Vector3d& v) {
  std::string text = "(";
  for (int i = 0; i < 3; ++i) text.append(i > 0 ? ", " : "").append(to_text(v[i]));
  return text += ')';
}

std::string show(const KnownTorque& known) {
  using Kind = KnownTorque::Kind;
  switch (known.kind) {
    case Kind::constant_in_body: return "Constant(" + show(known.vector) + ")";
    case Kind::constant_in_space: return "Constant(" + show(known.vector) + ", frame=\"space\")";
    case Kind::damping: {
      const Matrix3d& C = known.matrix;
      if (C == Matrix3d(C.diagonal().asDiagonal())) return "Damping(" + show(C.diagonal()) + ")";
      return "Damping((" + show(C.row(0)) + ", " + show(C.row(1)) + ", " + show(C.row(2)) + "))";
    }
    case Kind::angular_damping: return "AngularDamping(" + to_text(known.rate) + ")";
    case Kind::rotors: return "the gyroscopic torque of a momentum " + show(known.vector);
    case Kind::gravity: return "Gravity(weight=1, arm=" + show(known.vector) + ")";
    case Kind::gravity_gradient: break;
  }
  return "GravityGradient(" + to_text(known.rate) + ", " + to_text(known.phase) + ")";
}

/// All numbers of a formula, without signs.
std::vector<double> list_constants(const formula::Program& program) {
  std::vector<double> found;
  const auto add = [&](const formula::Form& form) {
    found.push_back(std::abs(form.constant));
    for (const formula::Term& term : form.terms) found.push_back(std::abs(term.factor));
  };
  for (int i = 0; i < program.graph.size(); ++i) {
    if (program.graph[i].op == formula::Op::linear) add(program.graph.linear(i));
    if (program.graph[i].op == formula::Op::constant) found.push_back(std::abs(program.graph[i].constant));
  }
  for (const formula::Form& output : program.outputs) add(output);
  return found;
}

/// Expansion rounds coefficients. One that is a number of the formula within that rounding is that number.
void restore(const std::vector<double>& constants, double& x) {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  for (const double constant : constants) {
    if (std::abs(std::abs(x) - constant) <= rounding * constant) {
      x = std::copysign(constant, x);
      return;
    }
  }
}

/// The torques of the list whose sum a formula is; none if it is no such sum.
std::optional<std::vector<KnownTorque>> recognise(const Formula& formula, const Scene& scene) {
  if (!formula.recognise() || !formula.states().empty()) return std::nullopt;
  formula::Recognition found = formula::recognise(formula.program(), scene.given_inertia_B().matrix());
  if (!found.is_whole) return std::nullopt;
  // Free rotors take inertia from the body that moves, so multiples of either tensor are written as matrices there.
  const bool carried = scene.given_inertia_B().matrix() != scene.inertia_B().matrix();
  const std::vector<double> constants = list_constants(formula.program());
  for (KnownTorque& part : found.parts) {
    for (double& x : part.vector) restore(constants, x);
    for (double& x : part.matrix.reshaped()) restore(constants, x);
    restore(constants, part.rate), restore(constants, part.phase);
    if (carried && part.kind == KnownTorque::Kind::gravity_gradient) return std::nullopt;
    if (!carried || part.kind != KnownTorque::Kind::angular_damping) continue;
    part.kind = KnownTorque::Kind::damping;
    part.matrix = part.rate * scene.given_inertia_B().matrix();
  }
  return found.parts;
}

AnyTorque with_window(const AnyTorque& like, LastingTorque torque) {
  if (const auto* during = std::get_if<During>(&like)) return During(std::move(torque), during->windows());
  return to_any(torque);
}

/// Whether a recognition holds for every inertia: of a sum without multiples of a tensor, or of what is no such sum.
bool holds_for_any_inertia(const Formula& formula, const std::optional<std::vector<KnownTorque>>& parts) {
  if (!parts) return !formula.recognise() || !formula.traits().uses_time;   // a gravity gradient needs the time
  return std::all_of(parts->begin(), parts->end(), [](const KnownTorque& part) {
    using Kind = KnownTorque::Kind;
    return part.kind != Kind::damping && part.kind != Kind::angular_damping && part.kind != Kind::gravity_gradient;
  });
}

}  // namespace

const std::optional<std::vector<KnownTorque>>& Recognitions::find(const Formula& formula, const Scene& scene) {
  const Matrix3d &given = scene.given_inertia_B().matrix(), &moving = scene.inertia_B().matrix();
  for (const Entry& entry : entries_) {
    if (entry.any_inertia || (entry.given_inertia_B == given && entry.inertia_B == moving))
      if (entry.formula == formula) return entry.parts;
  }
  if (entries_.size() >= most) entries_.clear();
  auto parts = recognise(formula, scene);
  const bool any = holds_for_any_inertia(formula, parts);
  entries_.push_back({formula, given, moving, any, std::move(parts)});
  return entries_.back().parts;
}

AnyTorque as_given(const AnyTorque& torque) {
  const Formula* formula = find_formula(torque);
  return formula == nullptr ? torque : with_window(torque, formula->as_given());
}

Scene resolve_formulas(const Scene& scene, AsCustom as_custom, std::vector<std::string>* recognised) {
  Recognitions known;
  return resolve_formulas(scene, as_custom, known, recognised);
}

Scene resolve_formulas(const Scene& scene, AsCustom as_custom, Recognitions& recognitions,
                       std::vector<std::string>* recognised) {
  const auto& given = scene.torques();
  if (std::none_of(given.begin(), given.end(), [](const auto& torque) { return find_formula(torque) != nullptr; }))
    return scene;
  std::vector<AnyTorque> torques = given;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const AnyTorque torque = given[i];
    const Formula* formula = find_formula(torque);
    if (formula == nullptr) continue;
    // A law with the inertia would be known by that of one time.
    static const std::optional<std::vector<KnownTorque>> unknown;
    const auto& known = scene.changing() ? unknown : recognitions.find(*formula, scene);
    if (!known) {
      const bool steps_over = as_custom == AsCustom::yes && formula->has_switches() && formula->states().empty();
      if (steps_over) torques[i] = with_window(torque, formula->as_custom(scene.inertia_B().matrix()));
      continue;
    }
    std::string names;
    for (std::size_t k = 0; k < known->size(); ++k) {
      const AnyTorque part = with_window(torque, make_torque((*known)[k]));
      if (k == 0) torques[i] = part;
      else torques.push_back(part);
      names.append(k > 0 ? " and " : "").append(show((*known)[k]));
    }
    if (known->empty()) torques[i] = with_window(torque, torques::Constant(Vector3d::Zero()));
    if (recognised != nullptr)
      recognised->push_back("The formula of torques[" + std::to_string(i) + "] is " +
                            (known->empty() ? "zero in every state." : names + "."));
  }
  return scene.with_torques(std::move(torques));
}

}  // namespace polhode
