#include <pybind11/stl.h>

#include "bind_scene.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/scene/changing.hpp"

// polhode.Changing: an inertia or a momentum that changes with time.
namespace polhode::python {
namespace {

using Piece = Changing::Piece;

/// A vector, or a tensor by rows.
std::vector<double> to_term(py::handle value, const std::string& name) {
  const Array array = to_array(value, name.c_str());
  const bool fits = (array.ndim() == 1 && array.shape(0) == 3) ||
                    (array.ndim() == 2 && array.shape(0) == 3 && array.shape(1) == 3);
  if (!fits) throw InvalidInput(name, "of shape (3,) or (3, 3)", array_text(array));
  return {array.data(), array.data() + array.size()};
}

std::vector<std::vector<double>> to_terms(py::handle values, const std::string& name) {
  if (!py::isinstance<py::iterable>(values) || py::isinstance<py::str>(values))
    throw InvalidInput(name, "a list of terms", std::string(py::repr(values)));
  std::vector<std::vector<double>> terms;
  for (const py::handle term : py::iter(values)) terms.push_back(to_term(term, name));
  return terms;
}

std::optional<std::vector<double>> to_optional_term(py::handle value, const std::string& name) {
  return value.is_none() ? std::nullopt : std::optional(to_term(value, name));
}

/// A time that may be infinite.
double to_time(py::handle value, const std::string& name) {
  try {
    return py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(value)));
  } catch (const py::error_already_set&) {
    throw InvalidInput(name, "a time", std::string(py::repr(value)));
  }
}

std::vector<Piece> to_pieces(py::handle value) {
  if (!py::isinstance<py::iterable>(value) || py::isinstance<py::str>(value))
    throw InvalidInput("Changing.pieces", "a list of (begin, end, terms)", std::string(py::repr(value)));
  std::vector<Piece> pieces;
  for (const py::handle one : py::iter(value)) {
    const std::string name = "Changing.pieces[" + std::to_string(pieces.size()) + "]";
    if ((!py::isinstance<py::tuple>(one) && !py::isinstance<py::list>(one)) || py::len(one) != 3)
      throw InvalidInput(name, "(begin, end, terms)", std::string(py::repr(one)));
    const auto parts = py::reinterpret_borrow<py::sequence>(one);
    pieces.push_back({to_time(parts[0], name), to_time(parts[1], name), to_terms(parts[2], name)});
  }
  return pieces;
}

Array from_numbers(const std::vector<double>& numbers) {
  std::vector<py::ssize_t> shape{3};
  if (numbers.size() == 9) shape.push_back(3);
  return Array(shape, numbers.data());
}

py::object to_plain_term(const std::vector<double>& numbers) { return from_numbers(numbers).attr("tolist")(); }

py::tuple get_changing_state(const Changing& changing) {
  py::list pieces;
  for (const Piece& piece : changing.pieces()) {
    py::list terms;
    for (const std::vector<double>& term : piece.terms) terms.append(to_plain_term(term));
    pieces.append(py::make_tuple(piece.begin, piece.end, terms));
  }
  return py::make_tuple(pieces, changing.physical());
}

Array values_at(const Changing& changing, py::handle t) {
  const Array times = to_array(t, "t");
  require_finite(times, "t");
  std::vector<py::ssize_t> shape(times.shape(), times.shape() + times.ndim());
  shape.push_back(3);
  if (changing.width() == 9) shape.push_back(3);
  Array values(shape);
  double* to = values.mutable_data();
  for (py::ssize_t i = 0; i < times.size(); ++i) {
    const double time = times.data()[i];
    if (!(changing.begin() <= time && time <= changing.end()))
      throw InvalidInput("t", "between " + to_text(changing.begin()) + " and " + to_text(changing.end()), to_text(time));
    const Piece& piece = changing.find(time);
    for (std::size_t k = 0; k < changing.width(); ++k) *to++ = Changing::compute_number(piece, k, time);
  }
  return values;
}

constexpr const char* changing_doc =
    R"doc(Changing(pieces, *, before=None, after=None, physical=True)

An inertia or a momentum that changes with time: a polynomial in each of its pieces.

As `inertia` of a `Scene` it is the tensor of a body whose parts move or leave; as `momentum`, the angular momentum of
parts inside, relative to the body axes. Values may jump between pieces; at such a time the later value holds.

Parameters
----------
pieces : iterable of (begin, end, terms)
    In the order of time, without gaps [s]. The value is ``A0 + A1 (t - begin) + A2 (t - begin)^2 + ...``, with the terms
    ``[A0, A1, ...]`` of shape (3,) or (3, 3) each. Three numbers are a vector, or the moments about the body axes.
before, after : array_like, optional
    Constant values before the first piece and after the last.
physical : bool
    Whether an inertia must have the triangle inequality at all times.

Raises
------
InvalidInput
    For no pieces, gaps, overlaps, numbers that are not finite, and terms of several shapes. A scene refuses an inertia
    that is not positive definite at some time.

Examples
--------
>>> import polhode as ph
>>> boom = ph.Changing.ramp((1, 2, 3), (2, 4, 5), (5, 15), order=1)
>>> boom.at(10.0).tolist()
[1.5, 3.0, 4.0]
)doc";

}  // namespace

std::optional<Changing> to_changing(py::handle value, const char* name) {
  if (value.is_none()) return std::nullopt;
  if (!py::isinstance<Changing>(value)) throw InvalidInput(name, "a polhode.Changing", std::string(py::repr(value)));
  return value.cast<const Changing&>();
}

void bind_scene_changing(py::module_& m) {
  py::class_<Changing>(m, "Changing", changing_doc)
      .def(py::init([](py::handle pieces, py::handle before, py::handle after, bool physical) {
             return Changing(to_pieces(pieces), to_optional_term(before, "Changing.before"),
                             to_optional_term(after, "Changing.after"), physical);
           }),
           py::arg("pieces"), py::kw_only(), py::arg("before") = py::none(), py::arg("after") = py::none(),
           py::arg("physical") = true)
      .def_static(
          "ramp",
          [](py::handle before, py::handle after, py::handle times, py::handle order, bool physical) {
            const Array ends = to_array(times, "Changing.ramp.times");
            if (ends.ndim() != 1 || ends.size() != 2)
              throw InvalidInput("Changing.ramp.times", "(begin, end)", array_text(ends));
            if (!py::isinstance<py::int_>(order))
              throw InvalidInput("Changing.ramp.order", "1, 3 or 5", std::string(py::repr(order)));
            return Changing::ramp(to_term(before, "Changing.ramp.before"), to_term(after, "Changing.ramp.after"),
                                  ends.data()[0], ends.data()[1], order.cast<int>(), physical);
          },
          py::arg("before"), py::arg("after"), py::arg("times"), py::kw_only(), py::arg("order") = 5,
          py::arg("physical") = true, R"doc(Return the change from one value to another between two times.

With s from 0 to 1 between the times it is s for order 1, ``s^2 (3 - 2 s)`` for order 3, and ``s^3 (10 - 15 s + 6 s^2)`` for
order 5, whose rate and acceleration vanish at both ends.

Parameters
----------
before, after : array_like, shape (3,) or (3, 3)
    Constant values before and after.
times : (float, float)
    Begin and end [s].
order : {1, 3, 5}
    Degree of the polynomial.
physical : bool
    Whether an inertia must have the triangle inequality at all times.

Returns
-------
Changing
    A constant, a polynomial, and a constant.

Raises
------
InvalidInput
    For times that are not finite or not in order, values of several shapes, and another order.
)doc")
      .def_static(
          "table",
          [](py::handle t, py::handle values, bool physical) {
            const Array times = to_array(t, "Changing.table.t");
            if (times.ndim() != 1)
              throw InvalidInput("Changing.table.t", "a one-dimensional array", std::to_string(times.ndim()) + " dimensions");
            return Changing::table({times.data(), times.data() + times.size()}, to_terms(values, "Changing.table.values"),
                                   physical);
          },
          py::arg("t"), py::arg("values"), py::kw_only(), py::arg("physical") = true,
          R"doc(Return values that are linear between given times, and constant outside.

Parameters
----------
t : array_like, shape (n,)
    Times in their order, at least two [s].
values : array_like, shape (n, 3) or (n, 3, 3)
    The values there.
physical : bool
    Whether an inertia must have the triangle inequality at all times.

Returns
-------
Changing
    A constant, n - 1 linear pieces, and a constant.

Raises
------
InvalidInput
    For times that are not in order or not finite, and another number of values.
)doc")
      .def_property_readonly("pieces",
                             [](const Changing& changing) {
                               py::list pieces;
                               for (const Piece& piece : changing.pieces()) {
                                 py::list terms;
                                 for (const std::vector<double>& term : piece.terms) terms.append(from_numbers(term));
                                 pieces.append(py::make_tuple(piece.begin, piece.end, py::tuple(terms)));
                               }
                               return py::tuple(pieces);
                             },
                             "tuple of (begin, end, terms), with the constant ones before and after.")
      .def_property_readonly("physical", &Changing::physical, "Whether an inertia must have the triangle inequality.")
      .def("at", &values_at, py::arg("t"), R"doc(Return the values at times.

Parameters
----------
t : array_like
    Times [s]. At the time of a jump the later value holds.

Returns
-------
ndarray, shape (..., 3) or (..., 3, 3)

Raises
------
InvalidInput
    For a time outside the pieces.
)doc")
      .def("__repr__",
           [](const Changing& changing) {
             const py::tuple state = get_changing_state(changing);
             return "polhode.Changing(" + std::string(py::repr(state[0])) + (changing.physical() ? ")" : ", physical=False)");
           })
      .def("__eq__", [](const Changing& a, const py::object& b) {
        return py::isinstance<Changing>(b) && a == b.cast<const Changing&>();
      })
      .def("__hash__", [](const Changing& changing) {
        return py::hash(py::make_tuple(changing.pieces().size(), changing.begin(), changing.end(), changing.physical()));
      })
      .def(py::pickle(&get_changing_state, [](const py::tuple& state) {
        return from_state("Changing", state, 2, [](const py::tuple& parts) {
          return Changing(to_pieces(parts[0]), parts[1].cast<bool>());
        });
      }));
}

}  // namespace polhode::python
