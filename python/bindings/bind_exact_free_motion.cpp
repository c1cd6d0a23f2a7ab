#include <pybind11/typing.h>

#include "bind_exact.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/free_motion.hpp"
#include "progress.hpp"

namespace polhode::python {
namespace {

FreeMotion make_free_motion(py::handle inertia, py::handle omega, py::handle attitude, bool physical) {
  const Vector3d w = to_vector3(omega, "omega");
  const Quat q = to_attitude(attitude, "attitude");
  if (py::isinstance<InertiaTensor>(inertia)) return {inertia.cast<const InertiaTensor&>(), w, q};
  return {InertiaTensor::from_moments(to_moments(inertia, "inertia"), physical), w, q};
}

/// As at(), in parts of whole blocks of the grid, which leave the bits as they are.
py::typing::Tuple<Array, Array> states_at(const FreeMotion& motion, py::handle t, py::handle progress) {
  if (progress.is_none()) return at(motion, t);
  const py::object report = py::module_::import("polhode._batch.progress").attr("reporter")(progress);
  if (report.is_none()) return at(motion, t);
  const Array times = to_array(t, "t");
  Array omega = result_for(times, 3), attitude = result_for(times, 4);
  const auto n = static_cast<std::size_t>(times.size());
  const exact::TimeGrid grid(times.data(), n);
  double *w = omega.mutable_data(), *q = attitude.mutable_data();
  {
    constexpr std::size_t most = 128 * exact::TimeGrid::block;
    ReportedWork work(report, n);
    for (std::size_t begin = 0; begin < n; begin += most) {
      check_interrupt();
      const std::size_t count = std::min(most, n - begin);
      motion.at(grid.piece(begin, count), w + 3 * begin, q + 4 * begin);
      *work.done() += count;
    }
    work.finish();
  }
  return py::make_tuple(omega, attitude);
}

}  // namespace

template <>
void bind_closed_form<FreeMotion>(py::module_& m) {
  auto cls = make_class<FreeMotion>(m, "FreeMotion", R"(Torque-free motion of any rigid body, in closed form at any time.

One class for the sphere, symmetric and triaxial bodies, steady rotation, rest, needles and the separatrix, exactly and
nearly. The error against the exact motion of the same float64 input is a few units of rounding at every time.

Parameters
----------
inertia : InertiaTensor, or array_like of shape (3,)
    About the centre of mass (or a fixed point), in body axes [kg m^2]; three numbers are principal moments in the given
    axes, in any order.
)" POLHODE_START_DOC R"(physical : bool
    False gives up the triangle inequality for three moments, as in :class:`InertiaTensor`.

Raises
------
InvalidInput
    Not finite, a body no mass makes, one without a moment about some axis, or an attitude that is not unit.

Notes
-----
Jacobi (1850), "Sur la rotation d'un corps", J. reine angew. Math. 39, in the Cayley-Klein form; see docs/exact.md.)");
  cls.def(py::init(&make_free_motion), py::arg("inertia"), py::arg("omega"),
          py::arg("attitude") = py::make_tuple(0, 0, 0, 1), py::kw_only(), py::arg("physical") = true)
      .def("at", &states_at, py::arg("t"), py::kw_only(), py::arg("progress") = py::none(),
           at_doc(", up to abs(omega t) = 1e25 rad", "", R"(progress : True or callable, optional
    ``progress(times done, all times)`` is called about fifty times a second. What it raises ends the call. True writes
    a line with the time left to stderr.
)").c_str())
      .def("euler_angles", &along<FreeMotion, &FreeMotion::euler_angles>, py::arg("t"),
           euler_angles_doc("angular").c_str())
      .def("polhode", &along<FreeMotion, &FreeMotion::polhode>, py::arg("t"),
           curve_doc("Poinsot's point of contact in body axes.",
                     "omega / sqrt(2 T), on the inertia ellipsoid [kg^-1/2 m^-1].").c_str())
      .def("herpolhode", &along<FreeMotion, &FreeMotion::herpolhode>, py::arg("t"),
           curve_doc("Poinsot's point of contact in space axes.", "The polhode's point turned by the attitude; it stays "
                     "in the plane L . v = sqrt(2 T) [kg^-1/2 m^-1].").c_str())
      .def(
          "flip_times",
          [](const FreeMotion& motion, py::handle begin, py::handle end) {
            const double first = to_real(begin, "begin"), last = to_real(end, "end");
            std::vector<double> times;
            {
              const WithoutGil nogil;
              times = motion.flip_times(first, last);
            }
            Array result(static_cast<py::ssize_t>(times.size()));
            std::copy(times.begin(), times.end(), result.mutable_data());
            return result;
          },
          py::arg("begin"), py::arg("end"), R"(When the racket flips.

Parameters
----------
begin, end : float
    The span [s], both ends included.

Returns
-------
ndarray, shape (n,)
    Ascending times at which omega's component along the intermediate axis passes through zero. Empty unless the three
    moments differ and the motion is not steady.)")
      .def_property_readonly(
          "kind", [](const FreeMotion& f) { return to_text(f.kind()); },
          "'rest', 'spherical', 'steady', 'oblate', 'prolate', 'about_least', 'about_greatest' (the\n"
          "principal axis that omega encircles) or 'separatrix'.")
      .def_property_readonly("period", &FreeMotion::period,
                             "Period of omega [s]: infinite on the separatrix, 0 where omega is constant.")
      .def_property_readonly("precession_rate", &FreeMotion::precession_rate,
                             "Mean rate of precession about the angular momentum [rad/s].")
      .def_property_readonly("energy", &FreeMotion::energy, "Kinetic energy [J].")
      .def_property_readonly(
          "angular_momentum", [](const FreeMotion& f) { return from_vector3(f.angular_momentum()); },
          "(3,) in space axes, constant [kg m^2/s].")
      .def("__hash__", [](const FreeMotion& f) { return hash_of(f.omega()); })
      .def("__repr__", [](const FreeMotion& f) { return call_text("FreeMotion", f); });
  bind_start(cls, [](const FreeMotion& motion) { return Picture{.period = motion.period()}; });
  cls.def(py::pickle(
      [](const FreeMotion& f) { return py::make_tuple(f.inertia(), from_vector3(f.omega()), from_quat(f.attitude())); },
      [](const py::tuple& state) {
        return from_state("FreeMotion", state, 3, [](const py::tuple& s) {
          const auto inertia = s[0].cast<InertiaTensor>();
          return FreeMotion(inertia, to_vector3(s[1], "omega"), stored_attitude(s[2]));
        });
      }));
}

}  // namespace polhode::python
