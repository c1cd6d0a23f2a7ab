#include <pybind11/stl.h>

#include "bind_formula.hpp"
#include "bind_orbit.hpp"
#include "convert.hpp"
#include "polhode/torque/magnetic_field.hpp"
#include "polhode/torque/plates.hpp"

// polhode.MagneticField, and torques on plates.
namespace polhode::python {
namespace {

/// Tuples (area, normal, centre, specular, diffuse).
std::vector<Plate> to_plates(const py::sequence& given) {
  std::vector<Plate> plates;
  for (const py::handle one : given) {
    const py::sequence numbers = one.cast<py::sequence>();
    plates.push_back({numbers[0].cast<double>(), to_vector3(numbers[1], "Plate.normal"),
                      to_vector3(numbers[2], "Plate.centre"), numbers[3].cast<double>(), numbers[4].cast<double>()});
  }
  return plates;
}

}  // namespace

void bind_torque_field(py::module_& m) {
  py::class_<MagneticField>(m, "_MagneticField")
      .def_static("dipole", [](const py::object& orbit, double strength, double tilt, double spin, double phase) {
        return MagneticField::dipole(to_ephemeris(orbit, "MagneticField.orbit"), strength, tilt, spin, phase);
      })
      .def_static("gauss", [](const py::object& orbit, double radius, const MagneticField::Coefficients& g,
                              const MagneticField::Coefficients& h, double spin, double phase) {
        return MagneticField::gauss(to_ephemeris(orbit, "MagneticField.orbit"), radius, g, h, spin, phase);
      })
      .def("at", [](const MagneticField& field, double t) { return from_vector3(field.at(t)); })
      .def("at", [](const MagneticField& field, double t, const py::object& r) {
        return from_vector3(field.at(t, to_vector3(r, "r")));
      });
  m.def("_make_drag", [](const py::sequence& plates, const py::object& orbit, double coefficient, double density,
                         double height_radius, double scale_height, double spin) {
    return torques::make_drag(to_plates(plates), to_ephemeris(orbit, "Drag.orbit"), coefficient,
                              {density, height_radius, scale_height, spin});
  });
  m.def("_make_solar_pressure", [](const py::sequence& plates, const py::object& sun, double pressure) {
    return torques::make_solar_pressure(to_plates(plates), to_vector3(sun, "SolarPressure.sun"), pressure);
  });
}

}  // namespace polhode::python
