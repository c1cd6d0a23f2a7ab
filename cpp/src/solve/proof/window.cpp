#include "solve/proof/window.hpp"

#include <algorithm>
#include <cmath>

#include "solve/proof/basis.hpp"

namespace polhode::proof {
namespace {

using formula::Side;
using Sides = FormulaModes::Sides;

constexpr std::size_t most_open = 4;

/// One of the modes that may act in a window.
struct Branch {
  Sides sides;
  const FormulaModes::Mode* mode;
  FormulaModes::Values values;

  /// The place of a guard in the mode; -1 where it does not act.
  int find(int number) const {
    const auto at = std::find(mode->guards.begin(), mode->guards.end(), number);
    return at == mode->guards.end() ? -1 : static_cast<int>(at - mode->guards.begin());
  }
};

double sign_of(const Interval& x) {
  if (!x.is_bounded() || !(x.mignitude() > 0.0)) return 0.0;
  return x.middle.hi > 0.0 ? 1.0 : -1.0;
}

Interval widen(const Interval& x, double by) { return {x.middle, Interval::raise(x.radius + by)}; }

class Finder {
 public:
  Finder(FormulaModes& modes, const Sides& sides, const WindowMotion& motion)
      : modes_(modes), sides_(sides), motion_(motion), n_(motion.box.size()) {}

  Window find() {
    own_ = modes_.evaluate(modes_.find(sides_), motion_.during, motion_.box);
    std::vector<double> guess(n_, 0.0);
    for (int attempt = 0; attempt < 8; ++attempt) {
      box_.clear();
      for (std::size_t i = 0; i < n_; ++i) box_.push_back(widen(motion_.box[i], guess[i]));
      if (!collect()) return window_;
      if (!measure()) return refuse("the switches of its formulas have no bounds");
      bool confirmed = true;
      for (std::size_t i = 0; i < n_; ++i)
        confirmed = confirmed && (window_.change[i] < guess[i] || window_.change[i] == 0.0);
      if (confirmed) return pass();
      for (std::size_t i = 0; i < n_; ++i) guess[i] = 2.0 * window_.change[i] + 0x1p-900;
    }
    return refuse("its switches change the rates faster than a short step can follow");
  }

 private:
  Window refuse(std::string why) {
    window_.result = Window::Result::refused;
    window_.why = std::move(why);
    return window_;
  }
  Window ask_longer() {
    window_.result = Window::Result::too_short;
    return window_;
  }

  /// Lists the guards that may change sign, and the modes that may act.
  bool collect() {
    open_.clear();
    while (true) {
      branches_.clear();
      std::vector<int> more;
      for (std::size_t which = 0; which < (std::size_t{1} << open_.size()) && more.empty(); ++which) {
        Sides sides = sides_;
        for (std::size_t k = 0; k < open_.size(); ++k)
          sides[to_index(open_[k])] = (which >> k & 1) != 0 ? Side::above : Side::below;
        more = modes_.settle(sides, open_, motion_.during, box_);
        const FormulaModes::Mode& mode = modes_.find(sides);
        branches_.push_back({sides, &mode, modes_.evaluate(mode, motion_.during, box_)});
      }
      if (more.empty()) return true;
      open_.insert(open_.end(), more.begin(), more.end());
      if (open_.size() > most_open) {
        refuse("more than four switches are met at once");
        return false;
      }
    }
  }

  /// Bounds |f(y) - f_mode(phi)| and with it |y - phi|. @return false where it has no bound
  bool measure() {
    window_.change.assign(n_, 0.0);
    for (const Branch& branch : branches_)
      for (std::size_t i = 0; i < n_; ++i) {
        const Interval difference = branch.values.rates[i] - own_.rates[i];
        if (!difference.is_bounded()) return false;
        // The mode's own rates at one point differ by nothing from themselves.
        const bool is_own = branches_.size() == 1 && branch.sides == sides_;
        const double size = is_own ? 0.0 : difference.magnitude();
        window_.change[i] = std::max(window_.change[i], raised(motion_.change_factor * size * motion_.length));
      }
    return true;
  }

  /// The sign of a guard's speed in all modes; 0 where it is not known to have one.
  double find_direction(int number) const {
    double direction = 0.0;
    bool is_first = true;
    for (const Branch& branch : branches_) {
      const int place = branch.find(number);
      if (place < 0) continue;
      const double sign = sign_of(branch.values.speeds[to_index(place)]);
      if (sign == 0.0 || (!is_first && sign != direction)) return 0.0;
      direction = sign, is_first = false;
    }
    return direction;
  }

  /// A guard at a time, of states within `wide` of a point.
  Interval find_guard(const Branch& branch, int place, const Interval& time, const std::vector<Interval>& point,
                      const std::vector<double>& wide) const {
    Interval guard = modes_.evaluate(*branch.mode, time, point).guards[to_index(place)];
    for (std::size_t i = 0; i < n_; ++i)
      guard = guard + branch.values.slopes[to_index(place)][i] * Interval(math::DD(0.0), wide[i]);
    return guard;
  }

  Window pass() {
    window_.rest = window_.change;
    window_.sides = sides_;
    for (const int number : open_) {
      if (open_.size() > 1)
        for (const int other : open_)
          if (modes_.depends(number, other)) return refuse("two switches are met at once, one within the other");
      if (!modes_.is_kink(number) && find_direction(number) == 0.0)
        return refuse("it meets a switch along whose surface it may slide, or which it may touch without passing");
    }
    if (motion_.is_final) return done();
    std::vector<double> wide(n_);
    for (std::size_t i = 0; i < n_; ++i) wide[i] = raised(motion_.last_error[i] + window_.change[i]);
    Sides behind = sides_;
    for (const int number : open_) {
      double sign = 0.0;
      for (const Branch& branch : branches_) {
        const int place = branch.find(number);
        if (place < 0) continue;
        const double found = sign_of(find_guard(branch, place, motion_.end, motion_.last, wide));
        if (found == 0.0 || (sign != 0.0 && found != sign)) return ask_longer();
        sign = found;
      }
      if (sign != 0.0) behind[to_index(number)] = sign > 0.0 ? Side::above : Side::below;
    }
    // The sides of other guards in the mode behind.
    for (const Branch& branch : branches_) {
      const bool is_behind = std::all_of(open_.begin(), open_.end(), [&](int number) {
        return branch.sides[to_index(number)] == behind[to_index(number)];
      });
      if (is_behind) window_.sides = branch.sides;
    }
    if (open_.size() == 1 && branches_.size() == 2) refine(open_[0]);
    return done();
  }

  Window done() {
    window_.result = Window::Result::passed;
    return window_;
  }

  /// The set behind one surface, to first order.
  void refine(int number) {
    const std::size_t k = to_index(number);
    if (window_.sides[k] == sides_[k] || find_direction(number) == 0.0) return;
    const bool own_first = branches_[0].sides[k] == sides_[k];
    const Branch &before = branches_[own_first ? 0 : 1], &behind = branches_[own_first ? 1 : 0];
    const int place = before.find(number);
    if (place < 0) return;
    // phi is at first on the mode's side, for certain.
    const double side = sides_[k] == Side::above ? 1.0 : -1.0;
    if (sign_of(find_guard(before, place, motion_.begin, motion_.first, motion_.first_error)) != side) return;
    const Interval& speed = before.values.speeds[to_index(place)];
    const double speed0 = speed.middle.hi;
    const double off_speed = Interval::raise((speed - Interval(speed0)).magnitude() / std::abs(speed0));
    const std::vector<Interval>& slopes = before.values.slopes[to_index(place)];
    window_.value = modes_.evaluate(*before.mode, motion_.end, motion_.last).guards[to_index(place)];
    double curved = 0.0, reach = window_.value.magnitude();   // of the guard's second order, and of its size
    for (std::size_t i = 0; i < n_; ++i) {
      window_.gradient.push_back(slopes[i].middle.hi);
      curved += (slopes[i] - Interval(slopes[i].middle.hi)).magnitude() * motion_.last_error[i];
      reach += slopes[i].magnitude() * motion_.last_error[i];
    }
    const double least_speed = std::abs(speed0) * (1.0 - 0x1p-40);
    for (std::size_t i = 0; i < n_; ++i) {
      const Interval jump = behind.values.rates[i] - own_.rates[i];
      const double jump0 = jump.middle.hi, off_jump = (jump - Interval(jump0)).magnitude();
      window_.factors.push_back(jump0 / speed0);
      window_.rest[i] = raised(motion_.length * (off_jump + std::abs(jump0) * off_speed) +
                               std::abs(jump0) * curved / least_speed +
                               0x1p-50 * std::abs(window_.factors[i]) * reach + 0x1p-900);
    }
  }

  FormulaModes& modes_;
  const Sides& sides_;
  const WindowMotion& motion_;
  const std::size_t n_;
  FormulaModes::Values own_ = {};
  std::vector<Interval> box_;
  std::vector<int> open_;
  std::vector<Branch> branches_;
  Window window_;
};

}  // namespace

Window find_window(FormulaModes& modes, const FormulaModes::Sides& sides, const WindowMotion& motion) {
  return Finder(modes, sides, motion).find();
}

}  // namespace polhode::proof
