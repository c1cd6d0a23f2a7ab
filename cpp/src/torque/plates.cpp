#include "polhode/torque/plates.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "polhode/core/error.hpp"

namespace polhode::torques {
namespace {

void require_atmosphere(const char* name, double value, bool may_be_zero = false) {
  if (!(std::isfinite(value) && (value > 0.0 || (may_be_zero && value == 0.0))))
    throw InvalidInput(std::string("Drag.") + name, may_be_zero ? "at least 0 and finite" : "positive and finite",
                       to_text(value));
}

/// The plates with normals of unit length.
std::vector<Plate> check_plates(const char* torque, std::vector<Plate> plates) {
  const std::string list = std::string(torque) + ".plates";
  if (plates.empty()) throw InvalidInput(list, "at least one plate", "none");
  for (std::size_t i = 0; i < plates.size(); ++i) {
    Plate& plate = plates[i];
    const std::string where = list + "[" + std::to_string(i) + "].";
    if (!(plate.area >= 0.0 && std::isfinite(plate.area)))
      throw InvalidInput(where + "area", "at least 0 and finite", to_text(plate.area));
    const double length = plate.normal.stableNorm();
    if (!(length > 0.0 && std::isfinite(length)))
      throw InvalidInput(where + "normal", "finite and not 0", length == 0.0 ? "0, 0, 0" : to_text(length));
    plate.normal /= length;
    if (!plate.centre.allFinite()) throw InvalidInput(where + "centre", "finite", "a number that is not");
    for (const auto& [name, share] : {std::pair{"specular", plate.specular}, std::pair{"diffuse", plate.diffuse}})
      if (!(share >= 0.0 && share <= 1.0)) throw InvalidInput(where + name, "from 0 to 1", to_text(share));
    if (plate.specular + plate.diffuse > 1.0)
      throw InvalidInput(where + "specular + diffuse", "at most 1", to_text(plate.specular + plate.diffuse));
  }
  return plates;
}

/// The cosine of a face towards a direction, times its length, where it sees it; else 0.
template <class T>
T face(const Vector3d& normal, const formula::Vec<T, 3>& direction) {
  const T along = dot(formula::make_vector<T>(normal), direction);
  return where(along > T(0.0), along, T(0.0));
}

}  // namespace

Formula make_drag(const std::vector<Plate>& given, const formula::Ephemeris& orbit, double coefficient,
                  const Atmosphere& air) {
  const std::vector<Plate> plates = check_plates("Drag", given);
  require_atmosphere("coefficient", coefficient, true), require_atmosphere("density", air.density, true);
  require_atmosphere("height_radius", air.height_radius), require_atmosphere("scale_height", air.scale_height);
  if (!std::isfinite(air.spin)) throw InvalidInput("Drag.spin", "finite", to_text(air.spin));
  return Formula::from(
      [&]<class T>(const formula::TorqueArguments<T>& in) -> formula::Vec<T, 3> {
        const formula::Seen<T> seen = formula::see(orbit, in.t);
        const T spin(air.spin);
        const formula::Vec<T, 3> u{{seen.v[0] + spin * seen.r[1], seen.v[1] - spin * seen.r[0], seen.v[2]}};
        const formula::Vec<T, 3> b = to_body(in.attitude, u);
        const T rho = in.p("density") * exp((T(air.height_radius) - seen.distance) / in.p("scale_height"));
        formula::Vec<T, 3> arm;
        for (const Plate& plate : plates)
          arm = arm + face(plate.normal, b) * formula::make_vector<T>(Vector3d(plate.area * plate.centre));
        return (T(-0.5) * in.p("coefficient") * rho) * cross(arm, b);
      },
      {{"coefficient", {coefficient}}, {"density", {air.density}}, {"scale_height", {air.scale_height}}});
}

Formula make_solar_pressure(const std::vector<Plate>& given, const Vector3d& sun, double pressure) {
  const std::vector<Plate> plates = check_plates("SolarPressure", given);
  const double length = sun.stableNorm();
  if (!(length > 0.0 && std::isfinite(length)))
    throw InvalidInput("SolarPressure.sun", "finite and not 0", length == 0.0 ? "0, 0, 0" : to_text(length));
  if (!(pressure >= 0.0 && std::isfinite(pressure)))
    throw InvalidInput("SolarPressure.pressure", "at least 0 and finite", to_text(pressure));
  return Formula::from(
      [&]<class T>(const formula::TorqueArguments<T>& in) -> formula::Vec<T, 3> {
        const formula::Vec<T, 3> s = to_body(in.attitude, formula::make_vector<T>(Vector3d(sun / length)));
        formula::Vec<T, 3> along, across;   // arms of what acts along s, and the torques along the normals
        for (const Plate& plate : plates) {
          const T c = face(plate.normal, s);
          along = along + c * formula::make_vector<T>(Vector3d((plate.area * (1.0 - plate.specular)) * plate.centre));
          const Vector3d moment = 2.0 * plate.area * plate.centre.cross(plate.normal);
          across = across + (c * (T(plate.specular) * c + T(plate.diffuse / 3.0))) * formula::make_vector<T>(moment);
        }
        return -in.p("pressure") * (cross(along, s) + across);
      },
      {{"pressure", {pressure}}});
}

}  // namespace polhode::torques
