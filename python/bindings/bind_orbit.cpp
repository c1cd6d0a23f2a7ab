#include <pybind11/typing.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bind_orbit.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/orbit/orbit.hpp"

namespace polhode::python {
namespace {

std::array<std::pair<const char*, double*>, 11> list_places(OrbitElements& elements) {
  return {{{"mu", &elements.mu}, {"periapsis_distance", &elements.periapsis_distance}, {"a", &elements.semi_major_axis},
           {"e", &elements.e}, {"inclination", &elements.inclination}, {"node", &elements.node},
           {"periapsis", &elements.periapsis}, {"anomaly", &elements.anomaly}, {"t0", &elements.t0},
           {"j2", &elements.j2}, {"radius", &elements.radius}}};
}

std::vector<Vector3d> to_rows(py::handle value, const char* name) {
  const Array array = to_array_with_tail(value, name, {3});
  if (array.ndim() != 2) throw InvalidInput(name, "of shape (n, 3)", std::to_string(array.ndim()) + " dimensions");
  std::vector<Vector3d> rows;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) rows.emplace_back(*array.data(i, 0), *array.data(i, 1), *array.data(i, 2));
  return rows;
}

void fill(const Orbit& orbit, const Array& times, Array& r, Array& v) {
  const double* in = times.data();
  double *to_r = r.mutable_data(), *to_v = v.mutable_data();
  const py::ssize_t n = times.size();
  const WithoutGil nogil;
  for (py::ssize_t i = 0; i < n; ++i) {
    if ((i & 1023) == 0) check_interrupt();
    const OrbitState state = orbit.at(in[i]);
    for (int k = 0; k < 3; ++k) to_r[3 * i + k] = state.r[k], to_v[3 * i + k] = state.v[k];
  }
}

py::typing::Tuple<Array, Array> states_at(const Orbit& orbit, py::handle t) {
  const Array times = to_array(t, "t");
  std::vector<py::ssize_t> shape(times.shape(), times.shape() + times.ndim());
  shape.push_back(3);
  Array r(shape), v(shape);
  fill(orbit, times, r, v);
  return py::make_tuple(r, v);
}

Array find_eclipses(const Orbit& orbit, py::handle sun, py::handle shadow, py::handle begin, py::handle end) {
  const Vector3d towards = to_vector3(sun, "sun");
  const double radius = to_real(shadow, "shadow"), first = to_real(begin, "begin"), last = to_real(end, "end");
  std::vector<Eclipse> found;
  {
    const WithoutGil nogil;
    found = orbit.find_eclipses(towards, radius, first, last);
  }
  Array pairs({static_cast<py::ssize_t>(found.size()), static_cast<py::ssize_t>(2)});
  double* to = pairs.mutable_data();
  for (const Eclipse& one : found) *to++ = one.begin, *to++ = one.end;
  return pairs;
}

template <class Rows>
Array from_rows(const Rows& rows) {
  Array array({static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(3)});
  double* to = array.mutable_data();
  for (const Vector3d& row : rows) to = std::copy_n(row.data(), 3, to);
  return array;
}

py::tuple describe(const OrbitStart& start) {
  py::dict given;
  given["mu"] = start.mu, given["r0"] = from_vector3(start.r0), given["v0"] = from_vector3(start.v0);
  given["t0"] = start.t0;
  return py::make_tuple("state", given);
}

/// The elements without those that are 0 or not given.
py::tuple describe(const OrbitElements& elements) {
  py::dict given;
  given["mu"] = elements.mu;
  OrbitElements copy = elements;
  for (const auto& [name, place] : list_places(copy))
    if (*place != 0.0 && !std::isnan(*place)) given[name] = *place;
  return py::make_tuple("elements", given);
}

py::tuple describe(const OrbitRows& rows) {
  py::dict given;
  given["t"] = Array(static_cast<py::ssize_t>(rows.t.size()), rows.t.data());
  given["r"] = from_rows(rows.r), given["v"] = from_rows(rows.v);
  if (!std::isnan(rows.mu)) given["mu"] = rows.mu;
  return py::make_tuple("table", given);
}

}  // namespace

formula::Ephemeris to_ephemeris(py::handle orbit, const std::string& where, std::string name) {
  if (!py::hasattr(orbit, "_core") || !py::isinstance<Orbit>(orbit.attr("_core")))
    throw InvalidInput(where, "an Orbit", std::string(py::str(py::type::of(orbit).attr("__name__"))));
  const auto& own = orbit.attr("_core").cast<const Orbit&>();
  if (own.kind() == OrbitKind::table)
    throw InvalidInput(where, "a conic", "a table", "torques take tables in a later version: fit elements to the table");
  return own.ephemeris(std::move(name));
}

py::object from_ephemeris(const formula::Ephemeris& ephemeris) {
  const std::optional<Orbit> orbit = Orbit::from_ephemeris(ephemeris);
  if (!orbit) return py::none();
  const py::tuple given = std::visit([](const auto& one) { return describe(one); }, orbit->given());
  return py::module_::import("polhode._orbit.orbit").attr("_restore")(given[0], given[1]);
}

void bind_orbit(py::module_& m) {
  py::class_<Orbit>(m, "_Orbit")
      .def_static("from_state", [](double mu, py::handle r0, py::handle v0, double t0) {
        return Orbit::from_state(mu, to_vector3(r0, "r0"), to_vector3(v0, "v0"), t0);
      })
      .def_static("from_elements", [](const py::dict& given) {
        OrbitElements elements{.mu = 0.0};
        for (const auto& [name, place] : list_places(elements))
          if (given.contains(name)) *place = to_real(given[name], name);
        return Orbit::from_elements(elements);
      })
      .def_static("table", [](py::handle t, py::handle r, py::handle v, double mu) {
        const Array times = to_array(t, "t");
        return Orbit::table({times.data(), times.data() + times.size()}, to_rows(r, "r"), to_rows(v, "v"), mu);
      })
      .def("at", &states_at)
      .def("eclipses", &find_eclipses)
      .def_property_readonly("kind", [](const Orbit& orbit) { return std::string(to_text(orbit.kind())); })
      .def_property_readonly("mu", &Orbit::mu)
      .def_property_readonly("e", &Orbit::e)
      .def_property_readonly("period", &Orbit::period)
      .def_property_readonly("periapsis_distance", &Orbit::periapsis_distance);
}

}  // namespace polhode::python
