#include "convert.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"

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

bool has_shape(const Array& array, std::initializer_list<py::ssize_t> shape) {
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  py::ssize_t axis = 0;
  for (const auto size : shape) fits = fits && array.shape(axis++) == size;
  return fits;
}

Array exact_shape(py::handle value, const char* name, std::initializer_list<py::ssize_t> shape) {
  Array array = to_array(value, name);
  if (!has_shape(array, shape)) {
    throw InvalidInput(name, "an array of shape " + tail_text(shape, "("), "shape " + shape_text(array));
  }
  require_finite(array, name);
  return array;
}

/// As NumPy's own conversion, without leave for another type; InvalidInput for what is no array of numbers.
py::object from_any(py::handle value, const char* name, py::handle dtype, int flags) {
  auto& numpy = py::detail::npy_api::get();
  dtype.inc_ref();   // the call takes it over
  PyObject* array = numpy.PyArray_FromAny_(value.ptr(), dtype.ptr(), 0, 0,
                                           py::detail::npy_api::NPY_ARRAY_ENSUREARRAY_ | flags, nullptr);
  if (array != nullptr) return py::reinterpret_steal<py::object>(array);
  py::error_already_set error;
  if (error.matches(PyExc_MemoryError) || !error.matches(PyExc_Exception)) throw error;
  throw InvalidInput(name, "an array of real numbers", std::string(py::str(py::type::of(value))));
}

/// With flush-to-zero the processor takes denormal numbers for 0.
void refuse_flushed(const Array& array, const char* name) {
  if (!flushes_to_zero()) return;
  const double* data = array.data();
  for (py::ssize_t i = 0; i < array.size(); ++i) require_kept(data[i], name);
}

/// What a caller likely meant by an inertia of another shape.
const char* inertia_hint(const Array& array) {
  if (array.ndim() == 1 && array.shape(0) == 6) {
    return "six numbers? write the matrix [[Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], [Ixz, Iyz, Izz]], where the products of "
           "inertia have their minus sign";
  }
  if (array.ndim() == 1 && array.shape(0) == 9) return "nine numbers in a row? reshape(3, 3) makes the matrix";
  if (array.ndim() == 1 && array.shape(0) == 3) return "InertiaTensor.from_moments takes principal moments";
  if (array.ndim() == 2 && array.shape(0) == 3 && array.shape(1) == 3) return "InertiaTensor(matrix) takes a matrix";
  return "";
}

Array inertia_of_shape(py::handle value, const char* name, std::initializer_list<py::ssize_t> shape) {
  const Array array = to_array(value, name);
  if (has_shape(array, shape)) {
    require_finite(array, name);
    return array;
  }
  throw InvalidInput(name, "an array of shape " + tail_text(shape, "("), "shape " + shape_text(array),
                     inertia_hint(array));
}

/// What a caller likely meant by an attitude of another shape.
const char* attitude_hint(const Array& array) {
  if (array.ndim() == 2 && array.shape(0) == 3 && array.shape(1) == 3) {
    return "a rotation matrix? Rotation.from_matrix makes an attitude of it";
  }
  if (array.ndim() == 1 && array.shape(0) == 3) {
    return "angles or a rotation vector? Rotation.from_euler or Rotation.from_rotvec makes an attitude of them";
  }
  return "";
}

}  // namespace

// NumPy's conversion would take what stands under the mask.
void refuse_masked(py::handle value, const char* name) {
  auto& numpy = py::detail::npy_api::get();
  if (!numpy.PyArray_Check_(value.ptr()) || Py_TYPE(value.ptr()) == numpy.PyArray_Type_) return;
  if (!py::hasattr(value, "mask") || !py::hasattr(value, "filled")) return;
  const py::module_ ma = py::module_::import("numpy.ma");
  if (!ma.attr("is_masked")(value).cast<bool>()) return;
  throw InvalidInput(name, "without masked entries",
                     std::to_string(ma.attr("count_masked")(value).cast<long>()) + " of them",
                     "leave them out, or give them a value by .filled()");
}

Array to_array(py::handle value, const char* name) {
  refuse_masked(value, name);
  const auto array = py::reinterpret_borrow<py::array>(from_any(value, name, nullptr, 0));
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b') {
    throw InvalidInput(name, "an array of real numbers",
                       "dtype " + std::string(py::str(static_cast<py::object>(array.dtype()))),
                       kind == 'O' ? "a ragged list, perhaps, or objects that are no numbers" : "");
  }
  const auto result = py::reinterpret_borrow<Array>(from_any(array, name, py::dtype::of<double>(), plain));
  refuse_flushed(result, name);
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

Vector3d to_moments(py::handle value, const char* name) {
  const Array array = inertia_of_shape(value, name, {3});
  return {array.data()[0], array.data()[1], array.data()[2]};
}

Matrix3d to_tensor(py::handle value, const char* name) {
  const Array array = inertia_of_shape(value, name, {3, 3});
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(array.data());
}

Quat to_attitude(py::handle value, const char* name, int frames) {
  const bool numbers = PyType_Check(value.ptr()) || !py::hasattr(value, "as_quat");
  const py::object quat = numbers ? py::reinterpret_borrow<py::object>(value) : value.attr("as_quat")();
  const Array array = to_array(quat, name);
  if (!has_shape(array, {4})) {
    throw InvalidInput(name, "an array of shape (4,)", "shape " + shape_text(array), attitude_hint(array));
  }
  require_finite(array, name);
  const double* d = array.data();
  if (numbers && d[0] == 1.0 && d[1] == 0.0 && d[2] == 0.0 && d[3] == 0.0) {
    const std::string text =
        std::string(name) +
        ": (1, 0, 0, 0) is a half turn about x, as quaternions are (x, y, z, w) here. "
        "Rotation.from_quat(..., scalar_first=True) reads (w, x, y, z); a Rotation gives no warning";
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), frames) != 0) throw py::error_already_set();
  }
  return make_attitude({d[0], d[1], d[2], d[3]});
}

void refuse_state(const char* name) {
  throw InvalidInput(std::string(name) + ".__setstate__", "given what pickle saved", "another state");
}

std::vector<double> to_state_numbers(const std::vector<formula::Input>& states, py::handle given) {
  std::vector<double> numbers = formula::list_values(states);
  if (given.is_none()) return numbers;
  if (!py::isinstance<py::dict>(given))
    throw InvalidInput("states", "a dict of names and numbers", std::string(py::str(py::type::of(given))));
  for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(given)) {
    const std::string name = py::str(key), where = "states." + name;
    const formula::Place place = formula::find_place(states, name);
    if (place.first < 0) {
      std::string known;
      for (const formula::Input& state : states) known += (known.empty() ? "" : ", ") + state.name;
      throw InvalidInput("states", "named as the torque's: " + (known.empty() ? "it has none" : known), "'" + name + "'");
    }
    const Array array = to_array(value, where.c_str());
    require_finite(array, where.c_str());
    if (array.size() != place.count)
      throw InvalidInput(where, std::to_string(place.count) + " numbers", std::to_string(array.size()));
    std::copy_n(array.data(), place.count, numbers.begin() + place.first);
  }
  return numbers;
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

std::string array_text(const Array& array) { return py::cast<std::string>(py::str(array.attr("tolist")())); }

}  // namespace polhode::python
