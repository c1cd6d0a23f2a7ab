#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "polhode/math/detail/double_double.hpp"

namespace polhode::formula {

/// A position and a velocity in space axes that are known functions of time, as those of an orbit.
///
/// A formula may use its numbers as it uses the time: x, y, z, their rates, the distance r from the origin, and 1/r.
/// Copies share the path. Equal paths are equal ephemerides.
class Ephemeris {
 public:
  static constexpr int size = 8;
  enum Number : int { position = 0, velocity = 3, distance = 6, inverse_distance = 7 };

  class Path {
   public:
    virtual ~Path() = default;
    /// The eight numbers at a time.
    virtual void evaluate(math::DD t, double* numbers) const = 0;
    /// Rows 0 to `order` of their coefficients in powers of (time - t) / unit, eight numbers a row.
    virtual void expand(math::DD t, double unit, int order, double* rows) const = 0;
    virtual double mu() const = 0;   ///< gravitational parameter [m^3/s^2]; NaN: not known
    virtual bool is_same(const Path& other) const = 0;
  };

  Ephemeris() = default;   ///< none
  explicit Ephemeris(std::shared_ptr<const Path> path, std::string name = {}) : path_(std::move(path)), name_(std::move(name)) {}

  const std::shared_ptr<const Path>& path() const { return path_; }
  const std::string& name() const { return name_; }   ///< in texts; not compared
  double mu() const { return path_ ? path_->mu() : std::numeric_limits<double>::quiet_NaN(); }
  std::array<double, size> at(double t) const {
    std::array<double, size> numbers{};
    path_->evaluate(math::DD(t), numbers.data());
    return numbers;
  }

  friend bool operator==(const Ephemeris& a, const Ephemeris& b) {
    return a.path_ == b.path_ || (a.path_ && b.path_ && a.path_->is_same(*b.path_));
  }

 private:
  std::shared_ptr<const Path> path_;
  std::string name_;
};

}  // namespace polhode::formula
