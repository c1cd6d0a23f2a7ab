#include "polhode/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/scene/parameter.hpp"
#include "scene/held_commands.hpp"

namespace polhode {
namespace {

/// The inertia without the axial moments of free rotors and the damper's; null if there are none.
std::shared_ptr<const InertiaTensor> make_carrier(const InertiaTensor& all, const std::vector<Rotor>& rotors,
                                                  const std::optional<Damper>& damper) {
  Matrix3d J = all.matrix();
  bool any = false;
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    if (!rotors[i].free() || !rotors[i].inertia()) continue;
    const Vector3d a = rotors[i].axis();
    const double own = *rotors[i].inertia(), whole = all.about_axis(a);
    if (!(own < whole)) {
      throw InvalidInput("scene.rotors[" + std::to_string(i) + "].inertia",
                         "below the body's moment about the rotor's axis, " + to_text(whole), to_text(own),
                         "the body's inertia includes its rotors");
    }
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c <= r; ++c) J(r, c) = J(c, r) = J(r, c) - own * a[r] * a[c];
    any = true;
  }
  if (damper) {
    if (!(damper->inertia() < all.moments()[0]))
      throw InvalidInput("scene.damper.inertia", "below the body's least moment, " + to_text(all.moments()[0]),
                         to_text(damper->inertia()), "the body's inertia includes its damper");
    for (int i = 0; i < 3; ++i) J(i, i) -= damper->inertia();
    any = true;
  }
  if (!any) return nullptr;
  const double least = compute_principal_axes(J).moments[0];
  if (!(least > InertiaTensor::tolerance * all.moments()[2])) {
    throw InvalidInput("scene.rotors", damper ? "free rotors and a damper that leave the body three positive moments"
                                              : "free rotors that leave the body three positive moments",
                       "a least moment of " + to_text(least),
                       "the body's inertia includes its rotors, and their axial moments are taken from it");
  }
  // What is left is no body of its own, so the triangle inequality need not hold for it.
  return std::make_shared<const InertiaTensor>(InertiaTensor::from_trusted(J, false));
}

/// The gradient of gravity acts on the mass of free rotors, which is not in their carrier.
void require_no_gradient(const std::vector<AnyTorque>& torques) {
  for (const AnyTorque& torque : torques) {
    if (!std::holds_alternative<torques::GravityGradient>(drop_windows(torque))) continue;
    throw InvalidInput("scene.torques", "without GravityGradient beside free rotors with an inertia or a damper", "GravityGradient",
                       "it acts on the inertia of all, and omega moves the inertia without these");
  }
}

/// The axial moments of free rotors and the damper's.
Matrix3d sum_reduction(const std::vector<Rotor>& rotors, const std::optional<Damper>& damper) {
  Matrix3d sum = Matrix3d::Zero();
  for (const Rotor& rotor : rotors)
    if (rotor.free() && rotor.inertia()) sum += *rotor.inertia() * rotor.axis() * rotor.axis().transpose();
  if (damper) sum += damper->inertia() * Matrix3d::Identity();
  return sum;
}

void require_cover(const Changing& changing, const char* where, double first, double last) {
  if (changing.begin() <= first && last <= changing.end()) return;
  throw InvalidInput(where, "of pieces from " + to_text(first) + " to " + to_text(last) + " s",
                     to_text(changing.begin()) + " to " + to_text(changing.end()) + " s",
                     "give before= and after=, or further pieces");
}

void require_changes(const SceneParts& parts) {
  if (parts.leaving && !parts.changing)
    throw InvalidInput("scene.leaving", "left out for a constant inertia", "true", "no matter leaves");
  if (!parts.changing && !parts.momentum) return;
  const auto [least, most] = std::minmax_element(parts.times.begin(), parts.times.end());
  const double first = std::min(parts.t0, *least), last = std::max(parts.t0, *most);
  if (parts.changing) {
    require_cover(*parts.changing, "scene.inertia", first, last);
    parts.changing->require_inertia("scene.inertia", sum_reduction(parts.rotors, parts.damper));
  }
  if (!parts.momentum) return;
  if (parts.momentum->width() != 3) throw InvalidInput("scene.momentum", "of three numbers", "nine");
  require_cover(*parts.momentum, "scene.momentum", first, last);
}

constexpr const char* damper_state = "damper_momentum";

/// The state of a command that a controller holds on the body or on its dipole.
bool is_command(const Scene& scene, std::string_view name) {
  return std::any_of(scene.controllers().begin(), scene.controllers().end(), [&](const Controller& controller) {
    return (controller.parts().output == Output::torque || controller.parts().output == Output::dipole) &&
           !controller.held().empty() && controller.held()[0] == name;
  });
}

/// Gives driven rotors and the damper a state, and adds their torques, unless they have them.
void add_driven(SceneParts& parts) {
  for (std::size_t i = 0; i < parts.rotors.size(); ++i) {
    Rotor& rotor = parts.rotors[i];
    if (!rotor.is_driven() || !rotor.state().empty()) continue;
    const std::string name = "rotor_momentum_" + std::to_string(i);
    require_free_name(parts, name);
    rotor = rotor.with_state(name);
    parts.torques.emplace_back(make_torque(rotor, rotor.compute_start_momentum(parts.omega)));
  }
  if (!parts.damper || !parts.damper->state().empty()) return;
  require_free_name(parts, damper_state);
  parts.damper = parts.damper->with_state(damper_state);
  const Vector3d momentum = parts.damper->inertia() * (parts.omega + parts.damper->rates());
  parts.torques.emplace_back(make_torque(*parts.damper, momentum));
}

bool is_driven_state(const Scene& scene, std::string_view name) {
  if (scene.damper() && scene.damper()->state() == name) return true;
  return std::any_of(scene.rotors().begin(), scene.rotors().end(),
                     [&](const Rotor& rotor) { return rotor.is_driven() && rotor.state() == name; });
}

/// The torque of a driven rotor.
bool is_drive(const Scene& scene, const AnyTorque& torque) {
  const torques::Formula* formula = find_formula(torque);
  return formula != nullptr && !formula->states().empty() && is_driven_state(scene, formula->states()[0].name);
}

/// The torque of a command that a controller holds.
bool is_held(const Scene& scene, const AnyTorque& torque) {
  const torques::Formula* formula = find_formula(torque);
  return formula != nullptr && !formula->states().empty() && is_command(scene, formula->states()[0].name);
}

Vector3d find_damper_momentum(const Scene& scene, const double* states) {
  const double* p = states + formula::find_place(scene.states(), scene.damper()->state()).first;
  return {p[0], p[1], p[2]};
}

double find_momentum(const Scene& scene, const Rotor& rotor, const double* states) {
  return states[formula::find_place(scene.states(), rotor.state()).first];
}

}  // namespace

Scene::Scene(SceneParts parts) {
  if (parts.changing && std::isfinite(parts.t0))
    parts.inertia_B = InertiaTensor::from_trusted(parts.changing->tensor(parts.t0), parts.changing->physical());
  const Vector3d& moments = parts.inertia_B.moments();
  if (!(moments.minCoeff() > 0.0)) {
    throw InvalidInput("scene.inertia", "a tensor with three positive principal moments",
                       "a least moment of " + to_text(moments.minCoeff()),
                       "a rod or a point has a zero moment, so its rate about that axis is undefined");
  }
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(parts.omega[i])) throw InvalidInput("scene.omega", "finite", to_text(parts.omega[i]));
    require_kept(parts.omega[i], "scene.omega");
  }
  parts.attitude = make_attitude(parts.attitude);
  if (!std::isfinite(parts.t0)) throw InvalidInput("scene.t0", "finite", to_text(parts.t0));
  if (parts.times.empty()) {
    throw InvalidInput("scene.times", "at least one time", "none", "give the times of the samples");
  }
  for (std::size_t i = 0; i < parts.times.size(); ++i) {
    if (!std::isfinite(parts.times[i])) {
      throw InvalidInput("scene.times", "finite", to_text(parts.times[i]) + " at index " + std::to_string(i));
    }
  }
  if (!parts.want.omega && !parts.want.attitude) {
    throw InvalidInput("scene.want", "omega, attitude or both", "neither");
  }
  require_changes(parts);
  if ((parts.changing || parts.momentum) && !parts.controllers.empty()) {
    throw InvalidInput("scene.controllers", "none where the inertia or the momentum changes",
                       std::to_string(parts.controllers.size()));
  }
  add_controllers(parts);
  add_driven(parts);
  torque_sum_ = summarize(parts.torques);
  if (parts.changing || parts.momentum) torque_sum_.keeps_energy = torque_sum_.keeps_jacobi = false;
  if (parts.leaving) torque_sum_.keeps_vertical = false;
  states_ = list_states(parts.torques);
  if (!parts.rotors.empty() || parts.damper) {
    carrier_ = make_carrier(parts.inertia_B, parts.rotors, parts.damper);
    reduction_ = sum_reduction(parts.rotors, parts.damper);
    if (carrier_) require_no_gradient(parts.torques);
    bool steady = true, any = false;
    for (const Rotor& rotor : parts.rotors) {
      const double momentum = rotor.compute_momentum(parts.omega);
      steady = steady && (!rotor.has_windows() || momentum == 0.0);
      any = any || (momentum != 0.0 && rotor.has_windows());
    }
    parts_ = std::make_shared<const SceneParts>(std::move(parts));
    rotor_momentum_ = rotor_momentum(parts_->t0);
    if (!rotor_momentum_.allFinite()) throw InvalidInput("scene.rotors", "of finite momenta together", "an overflow");
    if (any || !rotor_momentum_.isZero(0.0)) add_rotors(torque_sum_, steady);
    return;
  }
  parts_ = std::make_shared<const SceneParts>(std::move(parts));
}

Matrix3d Scene::given_inertia_B(double t) const {
  return parts_->changing ? parts_->changing->tensor(t) : parts_->inertia_B.matrix();
}

Matrix3d Scene::inertia_B(double t) const {
  return parts_->changing ? Matrix3d(parts_->changing->tensor(t) - reduction_) : inertia_B().matrix();
}

Vector3d Scene::inner_momentum(double t) const {
  return parts_->momentum ? parts_->momentum->vector(t) : Vector3d(Vector3d::Zero());
}

std::vector<double> Scene::find_changes(double first, double last) const {
  std::vector<double> times;
  for (const std::optional<Changing>* one : {&parts_->changing, &parts_->momentum}) {
    if (!*one) continue;
    for (const Changing::Piece& piece : (*one)->pieces())
      if (first < piece.begin && piece.begin < last) times.push_back(piece.begin);
  }
  return times;
}

BodyPiece Scene::find_body_piece(double t, bool before) const {
  BodyPiece piece;
  if (parts_->changing) piece.inertia = parts_->changing->find(t, before);
  if (parts_->momentum) piece.momentum = parts_->momentum->find(t, before);
  return piece;
}

Vector3d Scene::rotor_momentum(double t) const {
  Vector3d sum = Vector3d::Zero();
  for (const Rotor& rotor : parts_->rotors)
    if (rotor.rotates_at(t)) sum += rotor.compute_momentum(parts_->omega) * rotor.axis();
  return sum;
}

SceneParts Scene::parts() const {
  SceneParts copy = *parts_;
  for (Rotor& rotor : copy.rotors) {
    if (!rotor.free() || rotor.momentum()) continue;
    RotorParts known = rotor.parts();
    known.momentum = rotor.compute_start_momentum(parts_->omega), known.speed.reset();
    rotor = Rotor(std::move(known)).with_state(rotor.state()).with_command(rotor.command());
  }
  return copy;
}

Scene Scene::with_torques(std::vector<AnyTorque> torques) const {
  SceneParts copy = *parts_;
  copy.torques = std::move(torques);
  return Scene(std::move(copy));
}

std::vector<AnyTorque> Scene::given_torques() const {
  std::vector<AnyTorque> given;
  for (const AnyTorque& torque : torques())
    if (!is_drive(*this, torque) && !is_held(*this, torque)) given.push_back(torque);
  for (const HeldWindow& held : held_windows()) given[held.torque] = held.during;   // given torques come first
  return given;
}

std::vector<Rotor> Scene::given_rotors() const {
  std::vector<Rotor> given;
  for (const Rotor& rotor : rotors()) given.push_back(rotor.as_given());
  return given;
}

std::vector<Controller> Scene::given_controllers() const {
  std::vector<Controller> given;
  for (const Controller& controller : controllers()) given.push_back(controller.with_held({}));
  return given;
}

std::optional<Damper> Scene::given_damper() const {
  return damper() ? std::optional(damper()->with_state("")) : std::nullopt;
}

bool Scene::has_inner_states() const {
  return damper() || std::any_of(rotors().begin(), rotors().end(), [](const Rotor& rotor) { return rotor.is_driven(); });
}

bool Scene::is_closed() const {
  return !leaving() && std::all_of(torques().begin(), torques().end(),
                     [this](const AnyTorque& torque) { return is_drive(*this, torque); });
}

void compute_rotor_speed(const Scene& scene, std::size_t n, const double* t, const double* omega, const double* states,
                         double* speed) {
  const auto width = static_cast<std::size_t>(scene.count_states());
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d w_B{omega[3 * i], omega[3 * i + 1], omega[3 * i + 2]};
    for (const Rotor& rotor : scene.rotors()) {
      double momentum = rotor.compute_start_momentum(scene.omega());
      if (rotor.is_driven())
        momentum = states == nullptr ? std::nan("") : find_momentum(scene, rotor, states + width * i);
      const double rotating = rotor.compute_speed(momentum, w_B);
      *speed++ = rotor.rotates_at(t[i]) || std::isnan(rotating) ? rotating : 0.0;
    }
  }
}

void compute_damper_rates(const Scene& scene, std::size_t n, const double* omega, const double* states, double* rates) {
  if (!scene.damper()) throw InvalidInput("scene.damper", "given", "none");
  const auto width = static_cast<std::size_t>(scene.count_states());
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d w_B{omega[3 * i], omega[3 * i + 1], omega[3 * i + 2]};
    const Vector3d sigma = find_damper_momentum(scene, states + width * i) / scene.damper()->inertia() - w_B;
    for (int c = 0; c < 3; ++c) *rates++ = sigma[c];
  }
}

Vector3d sum_momenta(const Scene& scene, double t, const double* states) {
  Vector3d sum = scene.rotor_momentum(t) + scene.inner_momentum(t);
  for (const Rotor& rotor : scene.rotors())
    if (rotor.is_driven()) sum += find_momentum(scene, rotor, states) * rotor.axis();
  if (scene.damper()) sum += find_damper_momentum(scene, states);
  return sum;
}

double sum_energies(const Scene& scene, const double* states) {
  double sum = 0.0;
  for (const Rotor& rotor : scene.rotors()) {
    if (!rotor.is_driven() || !rotor.inertia()) continue;
    const double h = find_momentum(scene, rotor, states);
    sum += 0.5 * h * (h / *rotor.inertia());
  }
  if (scene.damper()) {
    const Vector3d p = find_damper_momentum(scene, states);
    sum += 0.5 * p.dot(p / scene.damper()->inertia());
  }
  return sum;
}

int Scene::count_states() const {
  std::size_t count = 0;
  for (const formula::Input& state : states_) count += state.values.size();
  return static_cast<int>(count);
}

void set_starts(std::vector<AnyTorque>& torques, const std::vector<double>& starts) {
  set_starts(torques, list_states(torques), starts);
}

void set_starts(std::vector<AnyTorque>& torques, const std::vector<formula::Input>& states,
                const std::vector<double>& starts) {
  for (AnyTorque& torque : torques) {
    const torques::Formula* formula = find_formula(torque);
    if (formula == nullptr || formula->states().empty()) continue;
    std::vector<double> own;
    for (const formula::Input& state : formula->states()) {
      const formula::Place place = formula::find_place(states, state.name);
      const auto first = starts.begin() + place.first;
      own.insert(own.end(), first, first + place.count);
    }
    torque = formula->with_starts(own);
  }
}

}  // namespace polhode
