#pragma once

#include "graze/tape/series.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// How the coefficient c[0] is treated.
enum class RootStart {
    as_is,   ///< the value at 0 is exact
    deflate, ///< the value at 0 is zero up to round-off, because a jump or section put it there: this root is
             ///< divided out, and roots of the quotient are sought
};

enum class RootKind { falling, rising, touch };

/// A root of an event polynomial in (0, length].
struct Root {
    RootKind kind;
    double at;    ///< s
    double value; ///< value there: 0 up to round-off for crossings, the local minimum for a touch
};

/// The least value of a polynomial on [0, length].
struct Minimum {
    double at;
    double value;
    double lower_bound; ///< guaranteed: value less the uncertainty due to round-off and subdivision
};

/// A Bernstein coefficient of a polynomial, and that of sum |c_k| s^k, which bounds its round-off.
struct BernsteinCoefficient {
    double value, bound;
};

/// Finds roots of polynomials c[0] + c[1] s + ... on (0, length] by isolation. In order of cost: an enclosure that
/// excludes roots in one pass; enclosures of the first and second derivative, whose constant sign leaves at most one
/// root of interest; subdivision of the Bernstein form with Descartes' rule of signs for the polynomial and its
/// derivative; then bracketed Newton iteration to round-off on the original polynomial. (B. Mourrain, F. Rouillier,
/// M.-F. Roy, "The Bernstein basis and real root isolation", 2005; F. Rouillier, P. Zimmermann, "Efficient isolation of
/// polynomial's real roots", J. Comput. Appl. Math. 162, 2004.)
///
/// *Definitions.* Coefficients are taken to be known to 4 units of round-off each; with the round-off of Horner's rule
/// the value at s is uncertain by error(s) = u sum (2k + 4) |c_k| s^k, u = 2^-53. A falling crossing is a passage from
/// a value above error(s) to one below -error(s), a rising one the reverse. A minimum within +-error(s) between
/// positive stretches is a touch. Since the computed values have round-off too, the guarantees are: a passage beyond 2
/// error(s) is never missed, and a polynomial that does not reach zero never has a crossing, for any degree.
///
/// *The start.* The interval is open at 0, so a zero there is no root: with c[0] = 0 (or `deflate`, which treats c[0]
/// as 0) the sign just after 0 is that of the first non-zero coefficient, however small (a chattering ball leaves with
/// arbitrarily small speed). If c[1] is zero too, 0 is a multiple root and is divided out as such. A polynomial that is
/// negative at first can fall only after it has risen. With `deflate`, crossings are corrected for the true c[0] by one
/// Newton step where that is a small change.
///
/// *The end.* A crossing belongs to this step if the polynomial is within error(length) of zero at `length` and still
/// moving through zero; it is then reported at `length` or just before. The next step starts on the root and must be
/// searched with `deflate`, so that the root is neither lost nor found twice. A minimum within round-off of `length` is
/// reported as a touch; the next step may report it too.
///
/// Zero polynomials, non-finite ones, and lengths that are not positive have no roots. Work is bounded for any input.
/// After construction nothing is allocated (except by the caller's vectors).
class RootFinder {
public:
    explicit RootFinder(int highest_degree);

    /// Bounds of c (of c / s when deflated) on [0, length], from one pass over the coefficients.
    struct Enclosure {
        double least; ///< lower bound, round-off included; -infinity for polynomials that are not finite
        double size;  ///< sum |c_k| length^k
    };
    static Enclosure enclosure(std::span<const double> c, double length, RootStart start);

    /// True if the enclosure proves c > 0 throughout [0, length] ((0, length] when deflated).
    static bool surely_positive(std::span<const double> c, double length, RootStart start);

    /// Returns 1 if one pass over the coefficients proves that c rises throughout [0, length], -1 if that it falls,
    /// else 0.
    static int trend(std::span<const double> c, double length);

    /// Finds the first falling root.
    /// @param touch local minima with 0 < value <= touch before the falling root are appended to `touches` (unless
    /// null), as are minima that are zero within round-off
    /// @return whether there is a falling root
    /// @throws InputError if the degree is higher than the highest given at construction
    bool first_falling(std::span<const double> c, double length, RootStart start, Root& root, double touch = 0,
                       std::vector<Root>* touches = nullptr);

    /// Finds all crossings (falling and rising) in (0, length], in increasing order; replaces the contents of `roots`.
    /// @throws InputError if the degree is higher than the highest given at construction
    void crossings(std::span<const double> c, double length, RootStart start, std::vector<Root>& roots);

    /// Returns the least value on [0, length]. For a non-finite polynomial, value and lower bound are -infinity.
    /// @throws InputError if the degree is higher than the highest given at construction
    Minimum minimum(std::span<const double> c, double length);

    /// Returns the uncertainty of values on [0, length] due to round-off: error(length) as above.
    static double resolution(std::span<const double> c, double length);

private:
    class Isolation;
    void find_reciprocals();
    bool has_room(std::span<const double> c) const { return c.size() <= power_.size(); }
    double lowest_place(std::span<const double> c, double length, double slope);
    std::optional<bool> falls_once_or_never(std::span<const double> c, double length, int way, double touch,
                                            Root& root);
    static bool crosses_once_or_never(std::span<const double> c, double length, std::vector<Root>& roots);
    bool simple_minimum(std::span<const double> c, double length, Minimum& minimum);
    /// A part [left, left + width] of the unit interval; its coefficients are uncertain by scale * bound.
    struct Node {
        double left, width, scale;
        double floor; ///< additional uncertainty of values (not of differences)
    };

    int highest_degree_;
    std::vector<double> reciprocals_;   ///< of the binomial coefficients n over k, triangular, made when needed
    std::vector<double> power_, slope_; ///< coefficients of the current polynomial and of its derivative
    /// One row for each node of the stack, and a spare one; uninitialised.
    std::unique_ptr<BernsteinCoefficient[]> coefficients_;
    std::vector<Node> stack_;
};

/// Return value and derivative; round-off is at most that of Horner's rule.
double evaluate_polynomial(std::span<const double> c, double s);
double evaluate_derivative(std::span<const double> c, double s);
/// Returns the sum of the first `size` terms of a series.
double evaluate_polynomial(const Series& c, std::size_t size, double s);

} // namespace graze
