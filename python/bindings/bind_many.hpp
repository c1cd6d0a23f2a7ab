#pragma once

#include <utility>
#include <vector>

#include "bind_scene.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/batch/solve_many.hpp"

namespace polhode::python {

/// The scenes of many bodies as Python gives them: one for all with starts of their own, or a scene for each.
class ManyScenes {
 public:
  ManyScenes(const py::list& scenes, const py::object& moments, const py::object& omega, const py::object& attitude,
             const py::object& t0, const py::object& times)
      : moments_(to_rows(moments)), omega_(to_rows(omega)), attitude_(to_rows(attitude)), t0_(to_rows(t0)),
        times_(to_rows(times)) {
    for (const py::handle scene : scenes) list_.push_back(&scene.cast<const Scene&>());
  }

  /// It must not outlive this object, and needs no interpreter.
  MakeScene maker() const {
    return [this, moments = moments_.data(), rates = omega_.data(), attitudes = attitude_.data()](std::size_t body) {
      if (omega_.size() == 0) return *list_[body];
      const Scene& common = *list_[0];
      const double *a = rates + 3 * body, *b = attitudes + 4 * body, *moment = moments + 3 * body;
      InertiaTensor inertia = common.given_inertia_B();
      if (moments_.size() != 0 && common.changing())
        throw InvalidInput("inertia", "left out for a scene whose inertia changes", "moments of each body");
      if (moments_.size() != 0) inertia = InertiaTensor::from_moments({moment[0], moment[1], moment[2]});
      const auto own_times = [&] {
        const auto count = static_cast<std::size_t>(times_.ndim() == 2 ? times_.shape(1) : 0);
        const double* first = times_.data() + count * body;
        return std::vector<double>(first, first + count);
      };
      return Scene(SceneParts{inertia, {a[0], a[1], a[2]}, {b[0], b[1], b[2], b[3]}, common.given_torques(),
                              times_.size() == 0 ? common.times() : own_times(), common.want(),
                              t0_.size() == 0 ? common.t0() : t0_.data()[body], "", common.given_rotors(),
                              common.given_damper(), common.changing(), common.momentum(), common.leaving(),
                              common.given_controllers()});
    };
  }

 private:
  static Array to_rows(const py::object& given) { return given.is_none() ? Array() : given.cast<Array>(); }

  std::vector<const Scene*> list_;
  Array moments_, omega_, attitude_, t0_, times_;
};

}  // namespace polhode::python
