#include "convert.hpp"

#include <cmath>
#include <string>

#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += std::to_string(array.shape(i));
    if (i + 1 < array.ndim() || array.ndim() == 1) text += i + 1 < array.ndim() ? ", " : ",";
  }
  return text + ")";
}

std::string tail_text(std::initializer_list<py::ssize_t> tail, const char* open) {
  std::string text = open;
  bool first = true;
  for (const auto size : tail) {
    if (!first) text += ", ";
    text += std::to_string(size);
    first = false;
  }
  if (tail.size() == 1 && text[1] != '.') text += ",";
  return text + ")";
}

Array exact_shape(py::handle value, const char* name, std::initializer_list<py::ssize_t> shape) {
  Array array = to_array(value, name);
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  py::ssize_t axis = 0;
  for (const auto size : shape) fits = fits && array.shape(axis++) == size;
  if (!fits) throw InvalidInput(name, "an array of shape " + tail_text(shape, "("), "shape " + shape_text(array));
  require_finite(array, name);
  return array;
}

}  // namespace

Array to_array(py::handle value, const char* name) {
  py::array array;
  try {
    array = py::array::ensure(value);
    if (!array) {
      PyErr_Clear();
      throw InvalidInput(name, "an array of real numbers", std::string(py::str(py::type::of(value))));
    }
  } catch (const py::error_already_set&) {
    throw InvalidInput(name, "an array of real numbers", std::string(py::str(py::type::of(value))));
  }
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b') {
    throw InvalidInput(name, "an array of real numbers",
                       "dtype " + std::string(py::str(static_cast<py::object>(array.dtype()))),
                       kind == 'O' ? "a ragged list, perhaps, or objects that are no numbers" : "");
  }
  Array result = Array::ensure(array);
  if (!result) {
    PyErr_Clear();
    throw InvalidInput(name, "an array of real numbers", std::string(py::str(py::type::of(value))));
  }
  return result;
}

void require_finite(const Array& array, const char* name) {
  const double* data = array.data();
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    if (!std::isfinite(data[i])) {
      throw InvalidInput(name, "finite", to_text(data[i]) + " at flat index " + std::to_string(i));
    }
  }
}

Array to_array_with_tail(py::handle value, const char* name, std::initializer_list<py::ssize_t> tail) {
  Array array = to_array(value, name);
  const auto n = static_cast<py::ssize_t>(tail.size());
  bool fits = array.ndim() >= n;
  py::ssize_t axis = array.ndim() - n;
  for (const auto size : tail) fits = fits && array.shape(axis++) == size;
  if (!fits) throw InvalidInput(name, "an array of shape " + tail_text(tail, "(..., "), "shape " + shape_text(array));
  return array;
}

double to_real(py::handle value, const char* name) {
  const Array array = to_array(value, name);
  if (array.size() != 1) throw InvalidInput(name, "one number", "an array of shape " + shape_text(array));
  require_finite(array, name);
  return *array.data();
}

Vector3d to_vector3(py::handle value, const char* name) {
  const Array array = exact_shape(value, name, {3});
  return {array.data()[0], array.data()[1], array.data()[2]};
}

Matrix3d to_matrix3(py::handle value, const char* name) {
  const Array array = exact_shape(value, name, {3, 3});
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(array.data());
}

Quat to_attitude(py::handle value, const char* name) {
  const py::object quat =
      py::hasattr(value, "as_quat") ? value.attr("as_quat")() : py::reinterpret_borrow<py::object>(value);
  const Array array = exact_shape(quat, name, {4});
  const double* d = array.data();
  return make_attitude({d[0], d[1], d[2], d[3]});
}

Array from_vector3(const Vector3d& v) {
  Array array(3);
  for (int i = 0; i < 3; ++i) array.mutable_data()[i] = v[i];
  return array;
}

Array from_matrix3(const Matrix3d& m) {
  Array array({3, 3});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) array.mutable_at(i, j) = m(i, j);
  return array;
}

Array from_quat(const Quat& q) {
  Array array(4);
  double* d = array.mutable_data();
  d[0] = q.x, d[1] = q.y, d[2] = q.z, d[3] = q.w;
  return array;
}

}  // namespace polhode::python
