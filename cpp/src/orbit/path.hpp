#pragma once

#include <utility>

#include "polhode/orbit/orbit.hpp"

namespace polhode {

/// What an orbit is: a conic or a table.
class Orbit::Path : public formula::Ephemeris::Path {
 public:
  explicit Path(OrbitGiven given) : given_(std::move(given)) {}
  virtual OrbitState at(math::DD t) const = 0;
  virtual std::vector<Eclipse> find_eclipses(const Vector3d& sun, double radius, double first, double last) const = 0;
  virtual OrbitKind kind() const = 0;
  virtual double t0() const = 0;
  virtual double e() const { return std::numeric_limits<double>::quiet_NaN(); }
  virtual double period() const { return std::numeric_limits<double>::quiet_NaN(); }
  virtual double periapsis_distance() const { return std::numeric_limits<double>::quiet_NaN(); }
  virtual double first_time() const { return -std::numeric_limits<double>::infinity(); }
  virtual double last_time() const { return std::numeric_limits<double>::infinity(); }

  const OrbitGiven& given() const { return given_; }
  bool is_same(const formula::Ephemeris::Path& other) const override;
  void evaluate(math::DD t, double* numbers) const override;

 private:
  OrbitGiven given_;
};

/// Cubic Hermite pieces.
class OrbitTable final : public Orbit::Path {
 public:
  explicit OrbitTable(OrbitRows rows);
  OrbitState at(math::DD t) const override;
  void expand(math::DD t, double unit, int order, double* rows) const override;
  std::vector<Eclipse> find_eclipses(const Vector3d& sun, double radius, double first, double last) const override;
  OrbitKind kind() const override { return OrbitKind::table; }
  double mu() const override { return mu_; }
  double t0() const override { return t_.front(); }
  double first_time() const override { return t_.front(); }
  double last_time() const override { return t_.back(); }

 private:
  class Track;
  void require_within(double t) const;
  std::size_t find_piece(double t) const;

  std::vector<double> t_;
  std::vector<Vector3d> r_, v_;
  double mu_;
};

}  // namespace polhode
