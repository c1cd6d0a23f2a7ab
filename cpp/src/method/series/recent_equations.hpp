#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "method/series/body_series.hpp"
#include "polhode/formula/table.hpp"

namespace polhode {

/// What the equations of a body are made of: the laws of its torques, and numbers.
class EquationsKey {
 public:
  /// @param frame  the body without torques
  EquationsKey(const Scene& scene, const BodySeries& frame);

  void add(const LastingTorque& torque) { torques_.push_back(torque); }
  void add(double number) { numbers_.push_back(number); }
  void add(const double* from, std::size_t n) { numbers_.insert(numbers_.end(), from, from + n); }

  /// Whether all numbers and laws have the same bits, so that equations have.
  friend bool operator==(const EquationsKey& a, const EquationsKey& b);

 private:
  std::vector<LastingTorque> torques_;
  std::vector<double> numbers_;
};

/// Whether a table takes less than about a megabyte.
bool is_small(const formula::Table& table);

/// The last equations that were made, because a motion is integrated several times, and motions from other starts have
/// the same equations. Each thread has its own, without a lock.
template <class Equations>
class RecentEquations {
 public:
  static constexpr std::size_t most = 8;

  /// Those of an equal key, else `make()`, which are kept if `is_small`.
  template <class Make, class IsSmall>
  std::shared_ptr<const Equations> find(EquationsKey key, const Make& make, const IsSmall& is_small) {
    for (const auto& [known, equations] : entries_)
      if (known == key) return equations;
    std::shared_ptr<const Equations> made = make();
    if (!is_small(*made)) return made;
    if (entries_.size() < most) {
      entries_.emplace_back(std::move(key), made);
    } else {
      entries_[oldest_] = {std::move(key), made};
      oldest_ = (oldest_ + 1) % most;
    }
    return made;
  }

 private:
  std::vector<std::pair<EquationsKey, std::shared_ptr<const Equations>>> entries_;
  std::size_t oldest_ = 0;
};

}  // namespace polhode
