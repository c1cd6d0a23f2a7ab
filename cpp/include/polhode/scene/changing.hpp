#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {

/// A tensor or a vector that changes with time: a polynomial in each of its pieces.
///
/// As the inertia of a scene it is the tensor of a boom that unfolds, of fuel that burns; as its momentum, that of parts
/// that move within the body. Values may jump from one piece to the next; at such a time the later value holds.
class Changing {
 public:
  struct Piece {
    double begin, end;   ///< [s]; infinite ones have a constant value
    /// A0, A1, ...: the value is A0 + A1 (t - begin) + A2 (t - begin)^2 + ... Three numbers each: a vector, or moments
    /// about the body axes. Nine: a tensor by rows.
    std::vector<std::vector<double>> terms;

    bool is_constant() const;
    friend bool operator==(const Piece&, const Piece&) = default;
  };

  /// @param pieces    in the order of time, without gaps
  /// @param physical  whether an inertia has the triangle inequality
  /// @throws InvalidInput for no pieces, gaps, overlaps, numbers that are not finite, and terms of several shapes
  explicit Changing(std::vector<Piece> pieces, bool physical = true);
  /// The same with a constant value before and after the pieces, where they are given.
  Changing(std::vector<Piece> pieces, const std::optional<std::vector<double>>& before,
           const std::optional<std::vector<double>>& after, bool physical = true);

  /// From one value to another between two times, constant before and after. With s from 0 to 1:
  /// order 1: s; 3: s^2 (3 - 2 s); 5: s^3 (10 - 15 s + 6 s^2), whose first two derivatives vanish at the ends.
  static Changing ramp(const std::vector<double>& before, const std::vector<double>& after, double begin, double end,
                       int order = 5, bool physical = true);
  /// Linear between given times, constant outside.
  static Changing table(const std::vector<double>& t, const std::vector<std::vector<double>>& values,
                        bool physical = true);

  const std::vector<Piece>& pieces() const { return pieces_; }
  bool physical() const { return physical_; }
  std::size_t width() const { return pieces_.front().terms.front().size(); }   ///< three or nine numbers
  double begin() const { return pieces_.front().begin; }
  double end() const { return pieces_.back().end; }
  /// The piece that holds from a time on, or up to it. The first and the last hold beyond the ends, too.
  const Piece& find(double t, bool before = false) const;

  /// One of the numbers of a piece at a time, for any type of real numbers.
  template <class Real>
  static Real compute_number(const Piece& piece, std::size_t number, Real t) {
    const Real since = piece.terms.size() > 1 ? t - Real(piece.begin) : Real(0);
    Real sum(0);
    for (std::size_t k = piece.terms.size(); k-- > 0;) sum = sum * since + Real(piece.terms[k][number]);
    return sum;
  }
  /// The values of a piece at a time, as a tensor and as a vector.
  static Matrix3d compute_tensor(const Piece& piece, double t);
  static Vector3d compute_vector(const Piece& piece, double t);
  Matrix3d tensor(double t) const { return compute_tensor(find(t), t); }
  Vector3d vector(double t) const { return compute_vector(find(t), t); }
  /// The term of a tensor with this number.
  static Matrix3d make_tensor(const std::vector<double>& term);

  /// @param reduction  of rotors and a damper, taken from the tensor
  /// @throws InvalidInput if the tensor less the reduction is not positive definite at some time, or the tensor is that
  ///         of no body. Between two times this is known from the coefficients of Bernstein's polynomials, because both
  ///         sets of tensors are convex.
  void require_inertia(const char* where, const Matrix3d& reduction) const;

  friend bool operator==(const Changing&, const Changing&) = default;

 private:
  std::vector<Piece> pieces_;
  bool physical_;
};

}  // namespace polhode
