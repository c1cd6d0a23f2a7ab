#pragma once

#include <string>

#include "bind.hpp"
#include "polhode/formula/ephemeris.hpp"

namespace polhode::python {

/// The core of a Python Orbit as torques take it. @throws InvalidInput for another object, and for a table
formula::Ephemeris to_ephemeris(py::handle orbit, const std::string& where, std::string name = {});
/// A Python Orbit.
py::object from_ephemeris(const formula::Ephemeris& ephemeris);

}  // namespace polhode::python
