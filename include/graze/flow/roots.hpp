#pragma once

#include "graze/tape/series.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// How a polynomial may begin at s = 0.
enum class RootStart {
    as_is,   ///< its value at 0 counts
    deflate, ///< it is zero at 0 (up to round-off) because a jump or a section put it there: that root is
             ///< divided out, and roots of the quotient are sought
};

enum class RootKind { falling, rising, touch };

/// A root of an event polynomial in (0, length].
struct Root {
    RootKind kind;
    double at;    ///< s
    double value; ///< of the polynomial there: 0 up to round-off for crossings, the least value for a touch
};

/// Least value of a polynomial on [0, length].
struct Minimum {
    double at;
    double value;
    double lower_bound; ///< guaranteed: value minus what round-off and subdivision leave open
};

/// A Bernstein coefficient of a polynomial, with the same coefficient of sum |c_k| s^k, which bounds its round-off.
struct BernsteinCoefficient {
    double value, bound;
};

/// Finds roots of polynomials c[0] + c[1] s + ... on (0, length] by isolation: an enclosure that excludes roots
/// at the cost of one pass; the same of the first and second derivative, of which one that keeps its sign leaves no
/// more than one root that counts; then subdivision of the Bernstein form with Descartes' rule of signs for the
/// polynomial and for its derivative, then bracketed Newton iteration to round-off on the polynomial as given.
/// (B. Mourrain, F. Rouillier, M.-F. Roy, "The Bernstein basis and real root isolation", 2005; F. Rouillier,
/// P. Zimmermann, "Efficient isolation of polynomial's real roots", J. Comput. Appl. Math. 162, 2004.)
///
/// *What counts.* Coefficients are taken to be known to 4 units of round-off each; with the round-off of Horner's
/// rule the value at s is uncertain by error(s) = u sum (2k + 4) |c_k| s^k, u = 2^-53. A crossing is a passage from
/// a value above error(s) to one below -error(s) (falling), or the reverse. A minimum within +-error(s)
/// between positive stretches is a touch. As the values that this is judged by have round-off themselves, what goes
/// beyond 2 error(s) is never missed, and what does not reach zero is never made a crossing, whatever the degree.
///
/// *The start.* The interval is open at 0, so a zero there is no root: c[0] = 0 (or `deflate`, which treats c[0] as
/// 0) leaves the sign behind 0 to the first non-zero coefficient, which counts as it stands, however small
/// (a chattering ball leaves with arbitrarily small speed). If c[1] is zero too, 0 is a multiple root and is divided
/// out as such. A polynomial that is negative at first falls only after it has risen. With `deflate`, crossings are
/// corrected for the true c[0] by one Newton step where that is a small change.
///
/// *The end.* A crossing belongs to this step if the polynomial is within error(length) of zero at `length` and
/// still heading through zero; it is then at `length` or just before. The step that follows starts on the root
/// and must be searched with `deflate`, so that the root is neither lost nor seen twice. A minimum within
/// round-off of `length` is reported as a touch; the following step may report it too.
///
/// Zero polynomials, non-finite ones, and lengths that are not positive have no roots. Work is bounded for any input.
/// After construction nothing is allocated (but by the caller's vectors), for degrees up to the one given there.
class RootFinder {
public:
    explicit RootFinder(int highest_degree);

    /// What one pass over the coefficients shows of c (of c / s when deflated) on [0, length].
    struct Enclosure {
        double least; ///< lower bound, round-off included; -infinity for polynomials that are not finite
        double size;  ///< sum |c_k| length^k
    };
    static Enclosure enclosure(std::span<const double> c, double length, RootStart start);

    /// True if the enclosure shows at once that c > 0 throughout [0, length] (or (0, length] when deflated).
    static bool surely_positive(std::span<const double> c, double length, RootStart start);

    /// 1 if one pass over the coefficients shows that c rises throughout [0, length], -1 if that it falls, else 0.
    static int trend(std::span<const double> c, double length);

    /// The first falling root, or none.
    /// @param touch local minima with 0 < value <= touch before the falling root are passed to `touches`
    ///        (when not null), as are minima that are zero within round-off
    /// @return whether there is one
    /// @throws InputError if the degree is higher than the highest given at construction
    bool first_falling(std::span<const double> c, double length, RootStart start, Root& root, double touch = 0,
                       std::vector<Root>* touches = nullptr);

    /// All crossings (falling and rising) in (0, length], in increasing order, replacing what `roots` held.
    /// @throws InputError if the degree is higher than the highest given at construction
    void crossings(std::span<const double> c, double length, RootStart start, std::vector<Root>& roots);

    /// Least value on [0, length]. A non-finite polynomial has no bound: value and lower bound are -infinity.
    /// @throws InputError if the degree is higher than the highest given at construction
    Minimum minimum(std::span<const double> c, double length);

    /// What round-off makes uncertain in values of the polynomial on [0, length]: error(length) as above.
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
    /// A part [left, left + width] of the unit interval whose coefficients are uncertain by scale * bound.
    struct Node {
        double left, width, scale;
        double floor; ///< uncertainty of values (not of differences) to be added
    };

    int highest_degree_;
    std::vector<double> reciprocals_;   ///< of the binomial coefficients n over k, triangular, once they are needed
    std::vector<double> power_, slope_; ///< coefficients of the polynomial in work and of its derivative
    /// One row for each node of the stack, and one to spare; what is in them before they are used does not matter.
    std::unique_ptr<BernsteinCoefficient[]> coefficients_;
    std::vector<Node> stack_;
};

/// Value and derivative; round-off is at most that of Horner's rule.
double evaluate_polynomial(std::span<const double> c, double s);
double evaluate_derivative(std::span<const double> c, double s);
/// The first `size` terms of a series.
double evaluate_polynomial(const Series& c, std::size_t size, double s);

} // namespace graze
