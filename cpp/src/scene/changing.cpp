#include "polhode/scene/changing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "polhode/core/error.hpp"

namespace polhode {
namespace {

using Piece = Changing::Piece;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string name_piece(std::size_t i) { return "Changing.pieces[" + std::to_string(i) + "]"; }

void require_numbers(const std::vector<double>& term, std::size_t width, const std::string& where) {
  if (term.size() != 3 && term.size() != 9)
    throw InvalidInput(where, "of three numbers, or of nine", std::to_string(term.size()));
  if (term.size() != width)
    throw InvalidInput(where, "of one shape in all pieces, " + std::to_string(width) + " numbers as the first",
                       std::to_string(term.size()));
  for (const double x : term)
    if (!std::isfinite(x)) throw InvalidInput(where, "finite", to_text(x));
  if (width != 9) return;
  double largest = 0.0;
  for (const double x : term) largest = std::max(largest, std::abs(x));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!(std::abs(term[3 * i + j] - term[3 * j + i]) <= InertiaTensor::tolerance * largest))
        throw InvalidInput(where, "symmetric", to_text(term[3 * i + j]) + " and " + to_text(term[3 * j + i]));
}

void require_piece(const Piece& piece, const std::string& where, std::size_t width) {
  if (std::isnan(piece.begin) || std::isnan(piece.end) || !(piece.begin < piece.end))
    throw InvalidInput(where, "with an end after its begin", to_text(piece.begin) + " to " + to_text(piece.end));
  if (piece.terms.empty()) throw InvalidInput(where, "with at least one term", "none");
  for (const std::vector<double>& term : piece.terms) require_numbers(term, width, where);
  if (!piece.is_constant() && !(std::isfinite(piece.begin) && std::isfinite(piece.end)))
    throw InvalidInput(where, "with finite ends, because it is not constant",
                       to_text(piece.begin) + " to " + to_text(piece.end));
}

std::vector<double> evaluate(const Piece& piece, double t) {
  std::vector<double> value(piece.terms.front().size());
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = Changing::compute_number(piece, i, t);
  return value;
}

/// Decides whether a polynomial of tensors stays in a convex set, by its coefficients on parts of the piece.
class ConvexCheck {
 public:
  ConvexCheck(const char* where, const Matrix3d& reduction, bool physical)
      : where_(where), reduction_(reduction), physical_(physical) {}

  void require(const Piece& piece) {
    if (piece.is_constant()) return require_value(Changing::make_tensor(piece.terms.front()), piece.begin);
    const std::size_t n = piece.terms.size();
    const double span = piece.end - piece.begin;
    std::vector<Matrix3d> scaled, control(n, Matrix3d::Zero());
    double power = 1.0;
    for (std::size_t k = 0; k < n; ++k, power *= span) scaled.push_back(Changing::make_tensor(piece.terms[k]) * power);
    // Farin 2002, Curves and Surfaces for CAGD, sec. 6.8: b_i = sum_k C(i, k) / C(n - 1, k) c_k.
    for (std::size_t i = 0; i < n; ++i) {
      double ratio = 1.0;
      for (std::size_t k = 0; k <= i; ++k) {
        control[i] += ratio * scaled[k];
        if (k < i) ratio *= static_cast<double>(i - k) / static_cast<double>(n - 1 - k);
      }
    }
    parts_ = 0;
    divide(control, piece.begin, span, 0);
    require_value(control.back(), piece.end);
  }

 private:
  static constexpr int most_divisions = 20, most_parts = 4000;

  void divide(const std::vector<Matrix3d>& control, double begin, double span, int depth) {
    require_value(control.front(), begin);
    if (depth == most_divisions || ++parts_ > most_parts) return;
    if (std::all_of(control.begin(), control.end(), [this](const Matrix3d& J) { return find_flaw(J).empty(); })) return;
    std::vector<Matrix3d> left, right = control;   // de Casteljau's
    for (std::size_t end = control.size(); end > 0; --end) {
      left.push_back(right.front());
      for (std::size_t i = 0; i + 1 < end; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
    }
    divide(left, begin, 0.5 * span, depth + 1);
    divide(right, begin + 0.5 * span, 0.5 * span, depth + 1);
  }

  void require_value(const Matrix3d& J, double t) const {
    const std::string flaw = find_flaw(J);
    if (flaw.empty()) return;
    const std::string when = std::isfinite(t) ? " at t = " + to_text(t) + " s" : " in its first piece";
    const bool positive = flaw.front() == 'a';
    throw InvalidInput(where_, positive ? "positive definite at all times" : "a body's tensor at all times", flaw + when,
                       positive ? (reduction_.isZero(0.0) ? "" : "rotors and a damper take their moments from it")
                                : "no moment is above the sum of the two others; physical=False allows it");
  }

  std::string find_flaw(const Matrix3d& J) const {
    const Vector3d own = compute_principal_axes(J).moments;
    const Vector3d left = reduction_.isZero(0.0) ? own : compute_principal_axes(J - reduction_).moments;
    if (!(left[0] > InertiaTensor::tolerance * own[2])) return "a least moment of " + to_text(left[0]);
    if (physical_ && own[0] + own[1] - own[2] < -InertiaTensor::tolerance * own[2])
      return "moments " + to_text(own[0]) + ", " + to_text(own[1]) + ", " + to_text(own[2]);
    return "";
  }

  const char* where_;
  Matrix3d reduction_;
  bool physical_;
  int parts_ = 0;
};

std::vector<Piece> extend(std::vector<Piece> pieces, const std::optional<std::vector<double>>& before,
                          const std::optional<std::vector<double>>& after) {
  if (pieces.empty()) return pieces;
  const double first = pieces.front().begin, last = pieces.back().end;
  if (before && !std::isfinite(first))
    throw InvalidInput("Changing.before", "left out where the first piece has no begin", "a value");
  if (after && !std::isfinite(last))
    throw InvalidInput("Changing.after", "left out where the last piece has no end", "a value");
  if (before) pieces.insert(pieces.begin(), {-infinity, first, {*before}});
  if (after) pieces.push_back({last, infinity, {*after}});
  return pieces;
}

}  // namespace

bool Changing::Piece::is_constant() const {
  return std::all_of(terms.begin() + 1, terms.end(), [](const std::vector<double>& term) {
    return std::all_of(term.begin(), term.end(), [](double x) { return x == 0.0; });
  });
}

Changing::Changing(std::vector<Piece> pieces, bool physical) : pieces_(std::move(pieces)), physical_(physical) {
  if (pieces_.empty()) throw InvalidInput("Changing.pieces", "at least one", "none");
  const std::size_t width = pieces_.front().terms.empty() ? 0 : pieces_.front().terms.front().size();
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    require_piece(pieces_[i], name_piece(i), width);
    if (i == 0 || pieces_[i].begin == pieces_[i - 1].end) continue;
    throw InvalidInput(name_piece(i), "the continuation of the piece before it, which ends at " +
                       to_text(pieces_[i - 1].end) + " s", "a begin at " + to_text(pieces_[i].begin) + " s",
                       "pieces have neither gaps nor overlaps");
  }
}

Changing::Changing(std::vector<Piece> pieces, const std::optional<std::vector<double>>& before,
                   const std::optional<std::vector<double>>& after, bool physical)
    : Changing(extend(std::move(pieces), before, after), physical) {}

Changing Changing::ramp(const std::vector<double>& before, const std::vector<double>& after, double begin, double end,
                        int order, bool physical) {
  if (!(std::isfinite(begin) && std::isfinite(end) && begin < end))
    throw InvalidInput("Changing.ramp.times", "two finite times, the second after the first",
                       to_text(begin) + " and " + to_text(end));
  static constexpr double first[] = {1.0}, third[] = {0.0, 3.0, -2.0}, fifth[] = {0.0, 0.0, 10.0, -15.0, 6.0};
  if (order != 1 && order != 3 && order != 5)
    throw InvalidInput("Changing.ramp.order", "1, 3 or 5", std::to_string(order));
  if (before.size() != after.size())
    throw InvalidInput("Changing.ramp", "between two values of one shape",
                       std::to_string(before.size()) + " and " + std::to_string(after.size()) + " numbers");
  const double* factors = order == 1 ? first : order == 3 ? third : fifth;
  Piece piece{begin, end, {before}};
  double power = end - begin;
  for (int k = 0; k < order; ++k, power *= end - begin) {
    std::vector<double> term;
    for (std::size_t i = 0; i < before.size(); ++i) term.push_back(factors[k] * (after[i] - before[i]) / power);
    piece.terms.push_back(std::move(term));
  }
  return Changing({std::move(piece)}, before, after, physical);
}

Changing Changing::table(const std::vector<double>& t, const std::vector<std::vector<double>>& values, bool physical) {
  if (t.size() < 2) throw InvalidInput("Changing.table.t", "at least two times", std::to_string(t.size()));
  if (t.size() != values.size())
    throw InvalidInput("Changing.table", "with a value for each of " + std::to_string(t.size()) + " times",
                       std::to_string(values.size()));
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    if (!(std::isfinite(t[i]) && std::isfinite(t[i + 1]) && t[i] < t[i + 1]))
      throw InvalidInput("Changing.table.t", "finite, each above the one before",
                         to_text(t[i + 1]) + " after " + to_text(t[i]));
    std::vector<double> slope;
    for (std::size_t k = 0; k < std::min(values[i].size(), values[i + 1].size()); ++k)
      slope.push_back((values[i + 1][k] - values[i][k]) / (t[i + 1] - t[i]));
    pieces.push_back({t[i], t[i + 1], {values[i], std::move(slope)}});
  }
  return Changing(std::move(pieces), values.front(), values.back(), physical);
}

const Changing::Piece& Changing::find(double t, bool before) const {
  auto at = pieces_.begin();
  while (at + 1 != pieces_.end() && (before ? t > at->end : t >= at->end)) ++at;
  return *at;
}

Matrix3d Changing::make_tensor(const std::vector<double>& term) {
  Matrix3d J = Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (term.size() == 3) J(i, i) = term[static_cast<std::size_t>(i)];
    else for (int j = 0; j <= i; ++j)
      J(i, j) = J(j, i) = 0.5 * (term[static_cast<std::size_t>(3 * i + j)] + term[static_cast<std::size_t>(3 * j + i)]);
  }
  return J;
}

Matrix3d Changing::compute_tensor(const Piece& piece, double t) { return make_tensor(evaluate(piece, t)); }

Vector3d Changing::compute_vector(const Piece& piece, double t) {
  return {compute_number(piece, 0, t), compute_number(piece, 1, t), compute_number(piece, 2, t)};
}

void Changing::require_inertia(const char* where, const Matrix3d& reduction) const {
  ConvexCheck check(where, reduction, physical_);
  for (const Piece& piece : pieces_) check.require(piece);
}

}  // namespace polhode
