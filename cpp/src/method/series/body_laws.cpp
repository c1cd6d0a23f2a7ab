#include "method/series/body_laws.hpp"

#include <optional>
#include <string>

#include "polhode/core/error.hpp"

namespace polhode {
namespace {

using formula::Expr;
using formula::Form;
using formula::Vec;

/// The product of two quaternions, the second a constant.
Vec<Expr, 4> multiply(const Vec<Expr, 4>& p, const Quat& q) {
  return {{p[3] * q.x + p[0] * q.w + p[1] * q.z - p[2] * q.y, p[3] * q.y - p[0] * q.z + p[1] * q.w + p[2] * q.x,
           p[3] * q.z + p[0] * q.y - p[1] * q.x + p[2] * q.w, p[3] * q.w - p[0] * q.x - p[1] * q.y - p[2] * q.z}};
}

}  // namespace

BodyLaws::BodyLaws(formula::Graph& graph, const BodySeries& frame, const Vec<Expr, 3>& w_P, const Vec<Expr, 4>& q_WP,
                   const std::vector<formula::Input>& states)
    : graph_(graph), frame_(frame), w_P_(w_P), states_(states) {
  const bool rotated = frame.is_rotated();
  const Vec<Expr, 3> w_B = rotated ? formula::apply_matrix(frame.axes(), w_P) : w_P;
  const Vec<Expr, 4> q_WB = rotated ? multiply(q_WP, frame.from_axes()) : q_WP;
  for (const Expr& rate : w_B.components) body_.push_back(rate.form());
  for (const Expr& part : q_WB.components) body_.push_back(part.form());
}

std::vector<Form> BodyLaws::add(const formula::Program& law) {
  std::vector<Form> given = body_;
  for (const formula::Input& state : law.states) {
    const formula::Place place = formula::find_place(states_, state.name);
    for (int i = 0; i < place.count; ++i) given.push_back(graph_.state(formula::first_extra + place.first + i));
  }
  return formula::embed(law, graph_, given, frame_.is_rotated() ? &frame_.axes() : nullptr);
}

Vec<Expr, 3> BodyLaws::accelerate(const Vec<Expr, 3>& tau_B) const {
  Vec<Expr, 3> a = frame_.is_rotated() ? formula::apply_matrix(Matrix3d(frame_.axes().transpose()), tau_B) : tau_B;
  for (int i = 0; i < 3; ++i)
    a[static_cast<std::size_t>(i)] = a[static_cast<std::size_t>(i)] / frame_.moments()[i];
  return a;
}

Vec<Expr, 3> BodyLaws::accelerate(const Scene& scene, std::vector<Form>& rates) {
  std::vector<std::optional<Form>> found(formula::list_values(states_).size());
  Vec<Expr, 3> tau_B;
  for (std::size_t k = 0; k < scene.torques().size(); ++k) {
    const formula::Program law = make_bound_law(scene.torques()[k], scene.inertia_B().matrix());
    const std::vector<Form> outputs = add(law);
    for (std::size_t i = 0; i < 3; ++i) tau_B[i] = tau_B[i] + Expr(graph_, outputs[i]);
    std::size_t next = 3;
    for (const formula::Input& state : law.states) {
      const formula::Place place = formula::find_place(states_, state.name);
      for (int i = 0; i < place.count; ++i, ++next) {
        std::optional<Form>& rate = found[static_cast<std::size_t>(place.first + i)];
        if (rate && *rate != outputs[next])
          throw InvalidInput("torques[" + std::to_string(k) + "].states",
                             "with the rates that the torques before it give", "another rate",
                             "name states of different torques differently");
        rate = outputs[next];
      }
    }
  }
  for (std::optional<Form>& rate : found) rates.push_back(*std::move(rate));
  Vec<Expr, 3> a = accelerate(tau_B);
  const Vector3d h_P = frame_.axes().transpose() * scene.rotor_momentum();
  if (h_P.isZero(0.0)) return a;
  const Vec<Expr, 3> gyroscopic = cross(formula::make_vector<Expr>(h_P), w_P_);
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    a[at] = a[at] + gyroscopic[at] / frame_.moments()[i];
  }
  return a;
}

Vector3d make_euler_products(const Vector3d& I) {
  return {(I[1] - I[2]) / I[0], (I[2] - I[0]) / I[1], (I[0] - I[1]) / I[2]};
}

}  // namespace polhode
