#include "solve/proof/enclose.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "method/samples.hpp"
#include "polhode/core/error.hpp"
#include "solve/proof/window.hpp"

namespace polhode::proof {
namespace {

/// Follows the motion in one direction of time.
class Run {
 public:
  Run(const Scene& scene, const BodyEquations& body, const EncloseOptions& options, double sign, Enclosure& result)
      : scene_(scene), body_(body), options_(options), sign_(sign), result_(result),
        errors_(start_radii(body)), lost_(to_index(body.size())) {
    for (const Interval& y : body.start()) state_.push_back(y.middle);
    SampleOrder order(scene.times(), scene.t0());
    samples_ = std::move(sign_ > 0 ? order.forward : order.backward);
  }

  void follow(const std::vector<Piece>& pieces) {
    std::vector<bool> rotating = body_.find_rotating(scene_.t0(), scene_.t0());
    for (const Piece& piece : pieces) {
      std::vector<bool> next = body_.find_rotating(std::min(piece.begin, piece.end), std::max(piece.begin, piece.end));
      jump(body_.compute_jump(rotating, next));
      rotating = std::move(next);
      // A window includes its begin, so a sample at the end has the rotors that rotate then.
      end_jump_ = body_.compute_jump(rotating, body_.find_rotating(piece.end, piece.end));
      end_ = piece.end;
      if (!follow(piece, rotating)) return;
    }
  }

 private:
  static std::vector<double> start_radii(const BodyEquations& body) {
    std::vector<double> radii;
    for (const Interval& y : body.start()) radii.push_back(y.radius);
    return radii;
  }

  /// The exact distance of a time from the start, in units of 1 / pace, along the run.
  Interval distance(double t) const {
    const Interval seconds(sign_ > 0 ? math::two_diff(t, scene_.t0()) : math::two_diff(scene_.t0(), t), 0.0);
    return seconds * Interval(body_.pace());
  }

  void jump(const std::array<Interval, 3>& change) {
    if (std::all_of(change.begin(), change.end(), [](const Interval& x) { return x.is_zero(); })) return;
    const std::size_t n = state_.size();
    std::vector<double> identity(n * n), rest(n);
    for (std::size_t i = 0; i < n; ++i) identity[n * i + i] = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Interval sum = Interval(state_[i], 0.0) + change[i];
      state_[i] = sum.middle, rest[i] = sum.radius;
    }
    errors_.advance(identity, static_cast<int>(n), rest);
  }

  bool follow(const Piece& piece, const std::vector<bool>& rotating) {
    const Interval end = distance(piece.end);
    std::unique_ptr<TaylorStep> smooth;
    modes_.reset();
    if (body_.has_switches(piece.torques)) {
      modes_ = body_.make_modes(piece.torques, rotating, sign_, options_.step);
      sides_ = modes_->find_sides(now_, enclose_state());
    } else {
      smooth = body_.make_step(piece.torques, rotating, sign_, options_.step);
    }
    const auto find_step = [&]() -> TaylorStep& { return modes_ ? modes_->find(sides_).step : *smooth; };
    if (!largest_sizes_.empty()) find_step().expect_sizes(largest_sizes_);
    if (end.is_zero()) {   // a sample at the start itself
      TaylorStep& step = find_step();
      step.expand(state_, now_);
      if (!step.bound(0x1p-60, errors_)) return end_here(Status::failed, "the start cannot be enclosed");
      take_samples(step, 0x1p-60);
      return true;
    }
    if (!end.is_bounded()) return end_here(Status::failed, "the times are too far from the start");
    while (true) {
      TaylorStep& step = find_step();
      const Interval left = end - now_;
      if (!(left.upper() > 0.0)) break;
      if (result_.steps >= options_.max_steps) return end_here(Status::max_steps, "max_steps was reached");
      if (result_.steps % 64 == 0 && options_.go_on && !options_.go_on(reached())) {
        return end_here(Status::stopped, "it was stopped");
      }
      double length = step.expand(state_, now_);
      const double proposed = length;
      const bool last = !(length < left.lower());
      if (last) length = left.upper();
      else length = round_down(std::min(length, 0.9 * left.lower()) < 0.5 * length ? 0.5 * left.lower() : length);
      bool is_last = last;
      while (!step.bound(length, errors_)) {
        ++result_.rejected;
        length = round_down(0.5 * length), is_last = false;
        if (!(length > 1e-9 * std::min(proposed, left.upper())) || length < 0x1p-900)
          return end_here(Status::failed, "no bound on the next step was found: errors have grown too large");
      }
      if (is_too_wide(step))
        return end_here(Status::failed, "the set of possible states has become too large");
      if (modes_) {
        const double certain = find_certain(length);
        if (certain < length) {
          if (certain < std::max(0x1p-58 * proposed, 0x1p40 * now_.radius)) {
            if (!cross(left, proposed, is_last)) return false;
            if (!is_last) continue;
            now_ = end;
            break;
          }
          length = round_down(certain), is_last = false;
        }
      }
      // Else a sample between two steps might lie in neither.
      if (!is_last && !(left.radius < 0x1p-34 * length))
        return end_here(Status::failed, "steps are too short to be told apart, so far from the start");
      take_samples(step, length);
      advance(step, is_last ? left : Interval(length));
      now_ = is_last ? end : now_ + Interval(length);
      ++result_.steps;
      if (is_last) break;
    }
    largest_sizes_ = find_step().largest_sizes();
    (sign_ > 0 ? result_.end : result_.begin) = piece.end;
    return true;
  }

  bool is_too_wide(const TaylorStep& step) const {
    for (int v = 0; v < body_.size(); ++v) {
      const double size = std::max(step.largest_rate(), step.largest_size(v));
      if (!(step.spread()[to_index(v)] <= options_.widest * std::max(1.0, size))) return true;
    }
    return false;
  }

  /// Few digits, so that sums of lengths are exact.
  static double round_down(double length) {
    int exponent;
    const double part = std::frexp(length, &exponent);
    return std::ldexp(std::floor(std::ldexp(part, 20)), exponent - 20);
  }

  double reached() const { return scene_.t0() + sign_ * now_.middle.hi / body_.pace(); }

  std::vector<Interval> enclose_state() const {
    const std::vector<double> box = errors_.box();
    std::vector<Interval> state;
    for (std::size_t i = 0; i < state_.size(); ++i) state.emplace_back(state_[i], box[i]);
    return state;
  }

  /// How long the guards of the mode have their signs for certain.
  double find_certain(double length) const {
    const FormulaModes::Mode& mode = modes_->find(sides_);
    std::vector<double> signs;
    for (const int number : mode.guards)
      signs.push_back(sides_[to_index(number)] == formula::Side::above ? 1.0 : -1.0);
    return mode.step.find_certain(signs, length);
  }

  /// A short step over the surfaces of switches: see Window. @return false where the enclosure ends
  bool cross(const Interval& left, double proposed, bool& is_last) {
    FormulaStep& step = modes_->find(sides_).step;
    double length = std::clamp(1.5 * step.find_crossing(), 0x1p-57 * proposed, proposed);
    length = std::max(length, 0x1p40 * now_.radius);
    Window window;
    for (bool is_longest = false; !is_longest; length *= 4.0) {
      is_longest = length >= proposed;
      const double shorter = round_down(std::min(length, proposed));
      is_last = !(shorter < left.lower());
      length = is_last ? left.upper() : shorter;
      if (!step.bound(length, errors_)) break;
      WindowMotion motion = follow_mode(step, length);
      motion.is_final = is_last;
      window = find_window(*modes_, sides_, motion);
      if (window.result == Window::Result::passed) {
        pass(step, window, motion, is_last ? left : Interval(length));
        now_ = now_ + Interval(length);
        sides_ = window.sides;
        modes_->find(sides_).step.expect_sizes(step.largest_sizes());
        ++result_.steps;
        return true;
      }
      if (window.result == Window::Result::refused || is_last) break;
      ++result_.rejected;
    }
    const std::string why = window.why.empty() ? "the side of a switch cannot be told" : window.why;
    return end_here(Status::failed, why + ", near t = " + to_text(reached()) + " s");
  }

  /// What is known of the mode's own motion over a bounded step.
  WindowMotion follow_mode(const TaylorStep& step, double length) {
    const Interval whole(math::DD(0.5 * length), 0.5 * length * (1.0 + 0x1p-20));
    WindowMotion motion;
    motion.begin = now_, motion.end = now_ + Interval(length), motion.during = now_ + whole;
    motion.length = length * TaylorStep::margin;
    motion.change_factor = options_.step.switch_factor;
    motion.first_error = errors_.box();
    std::vector<DD> state(state_.size());
    std::vector<double> lost(state_.size());
    step.evaluate(DD(length), 0.0, state, lost);
    for (std::size_t i = 0; i < state.size(); ++i) {
      motion.first.emplace_back(state_[i], 0.0), motion.last.emplace_back(state[i], 0.0);
      motion.box.emplace_back(state_[i], step.reach(static_cast<int>(i)));
    }
    step.evaluate_derivative(length, 0.0, derivative_, lost_);
    for (std::size_t i = 0; i < lost.size(); ++i) lost[i] = raised(lost[i] + lost_[i] + step.rest()[i]);
    motion.last_error = errors_.image_box(derivative_, step.width(), lost);
    return motion;
  }

  /// The samples of a window, and the set behind it.
  void pass(const TaylorStep& step, const Window& window, const WindowMotion& motion, const Interval& length) {
    take_samples(step, length.middle.hi, window.change);
    step.evaluate_derivative(length.middle.hi, length.radius, derivative_, lost_);
    rest_ = step.rest();
    for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] += lost_[i];
    step.evaluate(length.middle, length.radius, state_, lost_);
    for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] = raised(rest_[i] + lost_[i]);
    if (window.factors.empty()) {
      for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] = raised(rest_[i] + window.change[i]);
    } else {
      shift(window, motion, step.width());
    }
    errors_.advance(derivative_, step.width(), rest_);
  }

  /// e becomes e + factors (value + gradient.e).
  void shift(const Window& window, const WindowMotion& motion, int width) {
    const std::size_t n = state_.size(), w = to_index(width);
    std::vector<double> combined(w, 0.0);
    double by_rest = 0.0, size = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      by_rest += std::abs(window.gradient[j]) * rest_[j], size += std::abs(window.gradient[j]) * motion.last_error[j];
      for (std::size_t c = 0; c < w; ++c) combined[c] += window.gradient[j] * derivative_[j * w + c];
    }
    const double rounding = (4.0 * static_cast<double>(n) + 16.0) * 0x1p-53;
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = window.factors[i];
      const Interval moved = Interval(state_[i], 0.0) + Interval(factor) * window.value;
      state_[i] = moved.middle;
      for (std::size_t c = 0; c < w; ++c) derivative_[i * w + c] += factor * combined[c];
      rest_[i] = raised(rest_[i] + std::abs(factor) * by_rest + moved.radius + window.rest[i] +
                        rounding * (motion.last_error[i] + std::abs(factor) * size));
    }
  }

  bool end_here(Status status, const std::string& why) {
    // The steps so far reach a little further than a time rounded towards the start.
    const double t = reached(), bound = t - sign_ * 0x1p-50 * (std::abs(t) + std::abs(scene_.t0()));
    result_.ended_at = sign_ > 0 ? std::max(bound, scene_.t0()) : std::min(bound, scene_.t0());
    (sign_ > 0 ? result_.end : result_.begin) = result_.ended_at;
    result_.status = status;
    result_.ended = why;
    return false;
  }

  void advance(const TaylorStep& step, const Interval& length) {
    step.evaluate_derivative(length.middle.hi, length.radius, derivative_, lost_);
    rest_ = step.rest();
    for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] += lost_[i];
    step.evaluate(length.middle, length.radius, state_, lost_);
    for (std::size_t i = 0; i < rest_.size(); ++i) rest_[i] = raised(rest_[i] + lost_[i]);
    errors_.advance(derivative_, step.width(), rest_);
  }

  /// @param more  to which the exact motion may be off the step's in addition
  void take_samples(const TaylorStep& step, double length, const std::vector<double>& more = {}) {
    std::vector<DD> state(state_.size());
    std::vector<double> lost(state_.size()), slack(state_.size()), box = step.spread();
    const bool is_narrow = *std::max_element(box.begin(), box.end()) < 1e-17;
    for (; next_ < samples_.size(); ++next_) {
      const std::size_t sample = samples_[next_];
      const double t = scene_.times()[sample];
      // Behind the piece's end another torque or rotor may act, however little behind: float64 times tell.
      if (sign_ > 0 ? t > end_ : t < end_) return;
      const Interval time = distance(t) - now_;
      if (!TaylorStep::is_bounded_at(time.upper(), length)) return;
      step.evaluate(time.middle, time.radius, state, lost);
      if (!is_narrow) {
        step.evaluate_derivative(time.middle.hi, time.radius, derivative_, slack);
        for (std::size_t i = 0; i < slack.size(); ++i) slack[i] += step.rest()[i];
        box = errors_.image_box(derivative_, step.width(), slack);
      }
      const auto value = [&](std::size_t i) {
        return Interval(state[i], raised(box[i] + lost[i] + (more.empty() ? 0.0 : more[i])));
      };
      const bool at_end = t == end_;
      for (std::size_t i = 0; i < 3 && scene_.want().omega; ++i)
        result_.omega[3 * sample + i] = (at_end ? value(i) + end_jump_[i] : value(i)) * Interval(body_.rate());
      if (scene_.want().attitude) {
        const auto first = to_index(body_.attitude());
        for (std::size_t i = 0; i < 4; ++i) result_.attitude[4 * sample + i] = value(first + i);
      }
      const std::size_t own = body_.state_units().size(), first = to_index(body_.first_own());
      for (std::size_t i = 0; i < own; ++i)
        result_.states[own * sample + i] = value(first + i) * Interval(body_.state_units()[i]);
    }
  }

  const Scene& scene_;
  const BodyEquations& body_;
  const EncloseOptions& options_;
  const double sign_;
  Enclosure& result_;
  std::unique_ptr<FormulaModes> modes_ = {};   ///< of the piece, if it has switches
  FormulaModes::Sides sides_ = {};
  std::vector<DD> state_;
  ErrorSet errors_;
  Interval now_ = {};                    ///< since the start, in units of 1 / pace
  std::array<Interval, 3> end_jump_ = {};   ///< of the variables of the rates, for samples at the piece's end
  double end_ = 0.0;                     ///< of the piece
  std::vector<double> largest_sizes_;    ///< of the variables, up to the last piece
  std::vector<std::size_t> samples_;     ///< in the order of the run
  std::size_t next_ = 0;
  std::vector<double> derivative_, lost_, rest_;
};

}  // namespace

Enclosure enclose(const Scene& scene, const Pieces& pieces, const EncloseOptions& options) {
  Enclosure result;
  result.begin = result.end = scene.t0();
  const std::size_t n = scene.times().size();
  if (scene.want().omega) result.omega.assign(3 * n, Interval::all());
  if (scene.want().attitude) result.attitude.assign(4 * n, Interval::all());
  result.states.assign(to_index(scene.count_states()) * n, Interval::all());
  const BodyEquations body(scene);
  Run(scene, body, options, 1.0, result).follow(pieces.forward);
  if (result.status == Status::finished || result.status == Status::failed)
    Run(scene, body, options, -1.0, result).follow(pieces.backward);
  return result;
}

}  // namespace polhode::proof
