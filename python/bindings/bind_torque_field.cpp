#include <pybind11/stl.h>

#include "bind_formula.hpp"
#include "bind_orbit.hpp"
#include "convert.hpp"
#include "polhode/torque/magnetic_field.hpp"

// polhode.MagneticField.
namespace polhode::python {

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
}

}  // namespace polhode::python
