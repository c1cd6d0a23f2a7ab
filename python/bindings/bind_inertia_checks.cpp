#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <algorithm>
#include <vector>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/inertia/checks.hpp"

namespace polhode::python {
namespace {

/// (margins, flaws), each of the shape of `value` without its last two dimensions.
py::typing::Tuple<Array, py::array_t<std::uint8_t>> check_inertia(py::handle value) {
  const Array matrices = to_array_with_tail(value, "matrices", {3, 3});
  const std::vector<py::ssize_t> shape(matrices.shape(), matrices.shape() + matrices.ndim() - 2);
  Array margins(shape);
  py::array_t<std::uint8_t> flaws(shape);
  {
    const double* const in = matrices.data();
    double* const out_margins = margins.mutable_data();
    std::uint8_t* const out_flaws = flaws.mutable_data();
    const auto count = static_cast<std::size_t>(matrices.size() / 9);
    in_parts(count, [&](std::size_t begin, std::size_t part) {
      polhode::check_inertia(in + 9 * begin, part, out_margins + begin, out_flaws + begin);
      return part;
    });
  }
  return py::make_tuple(margins, flaws);
}

/// Numbers of just this shape, for what is written in Python: the same door as for all else.
Array to_numbers(py::handle value, const char* name, const std::vector<py::ssize_t>& shape, bool finite) {
  const Array array = to_array(value, name);
  if (!std::equal(array.shape(), array.shape() + array.ndim(), shape.begin(), shape.end())) {
    throw InvalidInput(name, "of shape " + py::cast<std::string>(py::str(py::tuple(py::cast(shape)))),
                       "shape " + py::cast<std::string>(py::str(array.attr("shape"))));
  }
  if (finite) require_finite(array, name);
  return array;
}

}  // namespace

void bind_inertia_checks(py::module_& m) {
  m.def("check_inertia", &check_inertia, py::arg("matrices"), "(margins, flaws); see polhode.inertia.check.");
  m.def("to_numbers", &to_numbers, py::arg("value"), py::arg("name"), py::arg("shape"), py::arg("finite") = true,
        "A float64 array of this shape, or InvalidInput.");
}

}  // namespace polhode::python
