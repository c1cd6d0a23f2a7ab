#pragma once

#include <pybind11/numpy.h>

#include "bind.hpp"
#include "polhode/core/quat.hpp"
#include "polhode/formula/program.hpp"

// What comes from Python is checked here, once. Every refusal is an InvalidInput (a ValueError) that names the
// argument, also where pybind11 alone would say TypeError.
namespace polhode::python {

/// The arrays that are taken as they are: other ones (strided, of another type, at an odd address) are copied.
constexpr int plain = py::array::c_style | py::array::forcecast | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
using Array = py::array_t<double, plain>;

/// Whether a value is such an array already. pybind11's own check does not look at the address.
inline bool is_plain(py::handle value) {
  return Array::check_(value) &&
         py::detail::check_flags(value.ptr(), py::detail::npy_api::NPY_ARRAY_ALIGNED_);
}

/// Any array-like of real numbers as a C-contiguous float64 array (no copy when it is one already).
/// Refused: complex, text, objects, ragged lists, masked values, and denormal numbers where the processor drops them.
/// NaN and inf pass: see require_finite.
Array to_array(py::handle value, const char* name);

/// Throws for an array with masked entries: what stands under a mask is no value.
void refuse_masked(py::handle value, const char* name);

/// Throws unless every entry is finite.
void require_finite(const Array& array, const char* name);

/// to_array with the shape (..., last...): `tail` gives the last dimensions, e.g. {3} or {3, 3}.
Array to_array_with_tail(py::handle value, const char* name, std::initializer_list<py::ssize_t> tail);

double to_real(py::handle value, const char* name);             ///< one finite number
Vector3d to_vector3(py::handle value, const char* name);        ///< shape (3,), finite
Matrix3d to_matrix3(py::handle value, const char* name);        ///< shape (3, 3), finite
Vector3d to_moments(py::handle value, const char* name);        ///< to_vector3; other shapes get a hint
Matrix3d to_tensor(py::handle value, const char* name);         ///< to_matrix3; other shapes get a hint

/// One attitude: (4,) scalar last, or any object with as_quat() (polhode's and SciPy's Rotation); unit, or refused.
/// The plain numbers (1, 0, 0, 0) are taken with a warning. `frames` is 1 for a direct caller in Python.
Quat to_attitude(py::handle value, const char* name, int frames = 1);

/// Numbers of states by their names, in their order; those that are not named have their starts.
std::vector<double> to_state_numbers(const std::vector<formula::Input>& states, py::handle given);

Array from_vector3(const Vector3d& v);
Array from_matrix3(const Matrix3d& m);
Array from_quat(const Quat& q);

std::string array_text(const Array& array);  ///< as nested lists, each number in full

[[noreturn]] void refuse_state(const char* name);

/// The entries of a state of pickle as make(state) reads them. InvalidInput for a state of another kind.
template <class Make>
auto from_state(const char* name, const py::tuple& state, std::size_t size, const Make& make) {
  if (state.size() != size) refuse_state(name);
  try {
    return make(state);
  } catch (const py::cast_error&) {
    refuse_state(name);
  }
}

}  // namespace polhode::python
