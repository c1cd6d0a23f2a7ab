#include "solve/pieces.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "method/samples.hpp"
#include "polhode/core/error.hpp"
#include "solve/custom_check.hpp"
#include "solve/perturb.hpp"

namespace polhode {
namespace {

using torques::During;

const During* find_windows(const AnyTorque& torque) {
  const auto* during = std::get_if<During>(&torque);
  return during != nullptr && !during->traits().vanishes ? during : nullptr;
}

AnyTorque drop_window(const AnyTorque& torque) {
  const auto* during = std::get_if<During>(&torque);
  return during == nullptr ? torque : std::visit([](const auto& lasting) { return AnyTorque(lasting); }, during->torque());
}

/// The first and the last of the times, the start among them.
std::pair<double, double> find_span(const Scene& scene) {
  const auto [least, most] = std::minmax_element(scene.times().begin(), scene.times().end());
  return {std::min(scene.t0(), *least), std::max(scene.t0(), *most)};
}

/// The torques that act between two times, without their windows.
std::vector<AnyTorque> find_acting(const Scene& scene, double begin, double end) {
  std::vector<AnyTorque> acting;
  for (const AnyTorque& torque : scene.torques()) {
    const auto* during = std::get_if<During>(&torque);
    if (during != nullptr && !(begin < end ? during->acts_throughout(begin, end) : during->acts_at(begin))) continue;
    acting.push_back(drop_window(torque));
  }
  return acting;
}

bool is_exact(const Motion& motion) { return motion.plan.method == "exact"; }

/// Runs the pieces of each direction and joins their rows.
class PieceRunner {
 public:
  PieceRunner(const Scene& scene, const SolveOptions& options, const RunPiece& run, bool perturb_joins)
      : scene_(scene), options_(options), run_(run), perturb_joins_(perturb_joins), reached_(scene.times().size(), 0) {
    const Wanted want = scene.want();
    if (want.omega) motion_.omega.resize(3 * reached_.size());
    if (want.attitude) motion_.attitude.resize(4 * reached_.size());
    motion_.start = scene.start();
    motion_.t_reached = scene.t0();
    motion_.has_dense = options.dense;
  }

  /// False when a piece did not reach its end.
  bool run_direction(const std::vector<Piece>& pieces, const std::vector<std::size_t>& order, const Wanted& want) {
    State start = scene_.start();
    std::size_t next = 0;
    for (const Piece& piece : pieces) {
      const bool forward = piece.end >= piece.begin, last = &piece == &pieces.back();
      std::vector<double> times;
      const std::size_t first = next;
      for (; next < order.size(); ++next) {
        const double t = scene_.times()[order[next]];
        if (forward ? t > piece.end : t < piece.end) break;
        times.push_back(t);
      }
      if (!last || times.empty()) times.push_back(piece.end);
      const Scene part = make_piece_scene(scene_, piece, start, std::move(times), want);
      if (part.torque_sum().acting > 0) require_true_claims(part);
      Motion motion = run_(part, piece, make_options(pieces.back().end));
      add(motion);
      place(part, motion, std::span(order).subspan(first, next - first));
      const bool finished = motion.status == Status::finished;
      motion_.t_reached = finished ? piece.end : find_reached(motion, piece);
      if (finished && !last) start = get_end(motion, piece.end, want);
      motion_.status = motion.status;
      motion_.message = finished ? "" : motion.message;
      if (motion.status == Status::max_steps) motion_.message = describe_max_steps();
      if (options_.dense) keep_dense(std::move(motion), piece);
      if (!finished) return motion_.status == Status::event;
      if (!last && wants_to_stop(pieces.back().end)) return false;
    }
    return true;
  }

  Motion finish() {
    drop_unreached(scene_.times(), reached_, motion_);
    return std::move(motion_);
  }

 private:
  SolveOptions make_options(double last) const {
    SolveOptions made = options_;
    made.max_steps = options_.max_steps - motion_.stats.steps;
    if (options_.progress)
      made.progress = [this, last](double reached, double) { return options_.progress(reached, last); };
    return made;
  }

  void add(const Motion& part) {
    motion_.stats += part.stats;
    motion_.events.insert(motion_.events.end(), part.events.begin(), part.events.end());
    if (!std::isnan(part.error))
      motion_.error = std::isnan(motion_.error) ? part.error : std::max(part.error, motion_.error);
  }

  /// The piece's rows into their places; those that were not reached are not among them.
  void place(const Scene& part, const Motion& motion, std::span<const std::size_t> order) {
    std::size_t row = 0;
    for (std::size_t i = 0; i < order.size() && row < motion.t.size(); ++i) {
      if (motion.t[row] != part.times()[i]) continue;
      if (!motion_.omega.empty()) std::copy_n(motion.omega.data() + 3 * row, 3, motion_.omega.data() + 3 * order[i]);
      if (!motion_.attitude.empty())
        std::copy_n(motion.attitude.data() + 4 * row, 4, motion_.attitude.data() + 4 * order[i]);
      reached_[order[i]] = 1;
      ++row;
    }
  }

  static double find_reached(const Motion& motion, const Piece& piece) {
    if (!is_exact(motion) || motion.status != Status::stopped) return motion.t_reached;
    return motion.t.empty() ? piece.begin : motion.t.back();
  }

  State get_end(const Motion& motion, double t, const Wanted& want) {
    const double* w = motion.omega.data() + motion.omega.size() - 3;
    State end{t, {w[0], w[1], w[2]}, scene_.attitude()};
    if (want.attitude) {
      const double* q = motion.attitude.data() + motion.attitude.size() - 4;
      end.attitude = {q[0], q[1], q[2], q[3]};
    }
    ++joins_;
    return perturb_joins_ ? perturb_state(end, is_exact(motion) ? 8.0 : 2.0, joins_) : end;
  }

  std::string describe_max_steps() const {
    return "gave up after max_steps = " + std::to_string(options_.max_steps) + " steps at t = " +
           polhode::to_text(motion_.t_reached) + " s";
  }

  void keep_dense(Motion motion, const Piece& piece) {
    motion.t_begin = std::min(piece.begin, motion_.t_reached);
    motion.t_reached = std::max(piece.begin, motion_.t_reached);
    motion.t.clear(), motion.omega.clear(), motion.attitude.clear(), motion.events.clear();
    motion_.pieces.push_back(std::make_shared<const Motion>(std::move(motion)));
  }

  /// Closed forms have no steps between which to ask.
  bool wants_to_stop(double last) {
    if (!options_.progress || (++asked_ & 15) != 0) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_call_ < std::chrono::milliseconds(50)) return false;
    last_call_ = now;
    if (options_.progress(motion_.t_reached, last)) return false;
    motion_.status = Status::stopped;
    motion_.message = "stopped by the progress callback at t = " + polhode::to_text(motion_.t_reached) + " s";
    return true;
  }

  const Scene& scene_;
  const SolveOptions& options_;
  const RunPiece& run_;
  bool perturb_joins_;
  std::vector<unsigned char> reached_;
  Motion motion_;
  int joins_ = 0;
  unsigned asked_ = 0;
  std::chrono::steady_clock::time_point last_call_ = std::chrono::steady_clock::now();
};

}  // namespace

bool has_windows(const Scene& scene) {
  return std::any_of(scene.torques().begin(), scene.torques().end(),
                     [](const AnyTorque& torque) { return std::holds_alternative<During>(torque); });
}

Pieces cut(const Scene& scene, std::vector<double> method_switches) {
  const auto [first, last] = find_span(scene);
  const double t0 = scene.t0();
  std::vector<double> edges = method_switches;
  for (const AnyTorque& torque : scene.torques()) {
    const During* during = find_windows(torque);
    if (during == nullptr) continue;
    for (const torques::Window& window : during->windows()) {
      for (const double t : {window.begin, window.end}) {
        if (first < t && t < last) edges.push_back(t);
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  Pieces pieces;
  pieces.whole = edges.empty();
  pieces.method_switches = std::move(method_switches);
  const auto add = [&](std::vector<Piece>& direction, double end) {
    const double begin = direction.empty() ? t0 : direction.back().end;
    direction.push_back({begin, end, find_acting(scene, std::min(begin, end), std::max(begin, end))});
  };
  if (std::any_of(scene.times().begin(), scene.times().end(), [t0](double t) { return t >= t0; })) {
    for (const double t : edges) {
      if (t > t0) add(pieces.forward, t);
    }
    add(pieces.forward, last);
  }
  if (first < t0) {
    for (auto t = edges.rbegin(); t != edges.rend(); ++t) {
      if (*t < t0) add(pieces.backward, *t);
    }
    add(pieces.backward, first);
  }
  return pieces;
}

Scene make_piece_scene(const Scene& scene, const Piece& piece, const State& start, std::vector<double> times,
                       const Wanted& want) {
  return Scene(SceneParts{.inertia_B = scene.inertia_B(),
                          .omega = start.omega,
                          .attitude = start.attitude,
                          .torques = piece.torques,
                          .times = std::move(times),
                          .want = want,
                          .t0 = start.t,
                          .name = scene.name()});
}

Scene drop_windows(const Scene& scene) {
  const auto [first, last] = find_span(scene);
  SceneParts parts = scene.parts();
  parts.torques = find_acting(scene, first, last);
  return Scene(std::move(parts));
}

std::string describe_span(const Piece& piece) {
  return "from t = " + to_text(std::min(piece.begin, piece.end)) + " to " + to_text(std::max(piece.begin, piece.end)) +
         " s";
}

bool carries_attitude(const Scene& scene, const Pieces& pieces, const SolveOptions& options) {
  bool uses = scene.want().attitude || !options.events.empty();
  for (const Piece* piece : pieces.all()) uses |= summarize(piece->torques).uses_attitude;
  return uses;
}

std::vector<Piece*> Pieces::all() {
  std::vector<Piece*> list;
  for (Piece& piece : backward) list.push_back(&piece);
  for (Piece& piece : forward) list.push_back(&piece);
  return list;
}

std::vector<const Piece*> Pieces::all() const {
  std::vector<const Piece*> list;
  for (const Piece& piece : backward) list.push_back(&piece);
  for (const Piece& piece : forward) list.push_back(&piece);
  return list;
}

Motion run_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options, const RunPiece& run,
                  bool perturb_joins) {
  const Wanted want{true, carries_attitude(scene, pieces, options)};
  PieceRunner runner(scene, options, run, perturb_joins);
  const SampleOrder order(scene.times(), scene.t0());
  if (runner.run_direction(pieces.backward, order.backward, want))
    runner.run_direction(pieces.forward, order.forward, want);
  Motion motion = runner.finish();
  motion.model = "pieces", motion.state = want.attitude ? "omega, attitude" : "omega";
  return motion;
}

}  // namespace polhode
