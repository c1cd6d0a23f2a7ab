#pragma once

#include <array>
#include <string>
#include <vector>

#include "polhode/inertia/mass_properties.hpp"

/// Bodies of uniform density, by their mass [kg] and lengths [m]: full heights, symmetry axis z, centre at the origin
/// unless the record says otherwise. Each throws InvalidInput for a length that is not positive and finite.
namespace polhode::shapes {

using Tetrahedron = std::array<Vector3d, 4>;            ///< four corners, in any order
using Triangle = std::array<std::array<double, 2>, 3>;  ///< three corners (x, y), in any order

#define POLHODE_SHAPE(name, parameters) MassProperties name parameters;
#include "polhode/inertia/shapes.def"
#undef POLHODE_SHAPE

struct Parameter {
  std::string name;
  std::vector<int> size;  ///< {} one number, {3} three, {4, 3} four rows of three
  std::string doc;
};

/// A shape as data: what the Python functions, the command line and the docs are made from.
struct Record {
  std::string name;
  std::string doc;                               ///< what it is, where it stands, and its formula
  std::vector<Parameter> parameters;             ///< the mass first
  MassProperties (*make)(const double* values);  ///< from all parameters' numbers, one after the other
  long double (*volume)(const double* sizes);    ///< [m^3] from those after the mass; null for thin bodies
};

/// Every shape, in the order of shapes.def.
const std::vector<Record>& all();

/// By name; throws InvalidInput, listing the names there are.
const Record& find(const std::string& name);

}  // namespace polhode::shapes
