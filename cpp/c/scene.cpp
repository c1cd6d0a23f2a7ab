#include "c/scene.hpp"

#include "c/call.hpp"

using namespace polhode;

namespace {

/// A function of C as a torque. Its end by the caller leaves the run as an exception of the library's own.
struct Caller {
  polhode_torque_function function;
  void* data;

  void operator()(double t, const double* omega, const double* attitude, double* torque) const {
    if (const int asked = function(t, omega, attitude, torque, data); asked != 0) {
      throw c::Stopped("the torque function returned " + std::to_string(asked) + " at t = " + to_text(t) + " s");
    }
  }
};

template <class Make>
polhode_status add(const char* where, polhode_scene* scene, const Make& make) {
  return c::call(where, [&] { c::need(scene, "scene").torques.push_back({make()}); });
}

}  // namespace

Scene polhode_scene::make() const {
  SceneParts all = parts;
  for (const Torque& one : torques) {
    all.torques.push_back(one.windows.empty() ? to_any(one.torque) : torques::During(one.torque, one.windows));
  }
  return Scene(std::move(all));
}

extern "C" {

polhode_status polhode_scene_create(const double* inertia, const double* omega, const double* attitude,
                                    polhode_scene** made) {
  return c::call(__func__, [&] {
    polhode_scene*& out = c::need(made, "made");
    out = new polhode_scene{
        {.inertia_B = c::inertia(inertia), .omega = c::vector(omega, "omega"), .attitude = c::attitude(attitude)}};
  });
}

void polhode_scene_destroy(polhode_scene* scene) { delete scene; }

polhode_status polhode_scene_set_start_time(polhode_scene* scene, double t0) {
  return c::call(__func__, [&] { c::need(scene, "scene").parts.t0 = t0; });
}

polhode_status polhode_scene_set_times(polhode_scene* scene, const double* times, size_t count) {
  return c::call(__func__, [&] {
    const double* first = count == 0 ? nullptr : &c::need(times, "times");
    c::need(scene, "scene").parts.times.assign(first, first + count);
  });
}

polhode_status polhode_scene_add_constant(polhode_scene* scene, const double* torque, int in_space) {
  using Frame = torques::Constant::Frame;
  return add(__func__, scene, [&] {
    return torques::Constant(c::vector(torque, "torque"), in_space != 0 ? Frame::space : Frame::body);
  });
}

polhode_status polhode_scene_add_gravity(polhode_scene* scene, double weight, const double* arm) {
  return add(__func__, scene, [&] { return torques::Gravity(weight, c::vector(arm, "arm")); });
}

polhode_status polhode_scene_add_gravity_gradient(polhode_scene* scene, double mean_motion, double phase) {
  return add(__func__, scene, [&] { return torques::GravityGradient(mean_motion, phase); });
}

polhode_status polhode_scene_add_damping(polhode_scene* scene, const double* matrix) {
  return add(__func__, scene, [&] { return torques::Damping(c::matrix(matrix, "matrix")); });
}

polhode_status polhode_scene_add_formula(polhode_scene* scene, const char* text, const char* const* names,
                                         const double* values, size_t count) {
  return add(__func__, scene, [&] {
    formula::Text parts{.torque = &c::need(text, "text"), .parameters = {}, .states = {}, .rates = {}, .let = {}};
    for (size_t i = 0; i < count; ++i) {
      parts.parameters.push_back({&c::need((&c::need(names, "names"))[i], "names"), {(&c::need(values, "values"))[i]}});
    }
    return torques::Formula(parts);
  });
}

polhode_status polhode_scene_add_custom(polhode_scene* scene, polhode_torque_function function, void* data) {
  return add(__func__, scene, [&] {
    return torques::Custom::from(Caller{&c::need(function, "function"), data}, torques::Custom::Claims{});
  });
}

polhode_status polhode_scene_add_window(polhode_scene* scene, double begin, double end) {
  return c::call(__func__, [&] {
    auto& torques = c::need(scene, "scene").torques;
    if (torques.empty()) throw InvalidInput("scene: has no torque yet");
    auto windows = torques.back().windows;
    windows.push_back({begin, end});
    torques::arrange(windows, "window");   // refuses what During would
    torques.back().windows = std::move(windows);
  });
}

polhode_status polhode_scene_add_rotor(polhode_scene* scene, const double* axis, double momentum) {
  return c::call(__func__, [&] {
    c::need(scene, "scene").parts.rotors.push_back(Rotor({.axis = c::vector(axis, "axis"), .momentum = momentum}));
  });
}
}
