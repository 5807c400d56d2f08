#pragma once

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
    double value; ///< of the polynomial there: 0 up to round-off for crossings, the least |value| for a touch
};

/// Least value of a polynomial on [0, length].
struct Minimum {
    double at;
    double value;
    double lower_bound; ///< guaranteed: value minus what round-off and subdivision leave open
};

/// Finds roots of polynomials c[0] + c[1] s + ... on (0, length] by isolation: an enclosure that excludes roots
/// at the cost of one pass, then subdivision of the Bernstein form with Descartes' rule of signs, then bracketed
/// Newton iteration to round-off. (Mourrain, Rouillier and Roy 2005; Rouillier and Zimmermann 2004.)
/// No root is missed unless the polynomial is zero there to within `resolution`. Works without allocating after
/// construction, for degrees up to the one given there.
class RootFinder {
public:
    explicit RootFinder(int highest_degree);

    /// True if the enclosure shows at once that c > 0 throughout [0, length] (or (0, length] when deflated).
    static bool surely_positive(std::span<const double> c, double length, RootStart start);

    /// The first falling root, or none.
    /// @param touch local minima with 0 < value <= touch before the falling root are passed to `touches`
    ///        (when not null), as are minima that are zero within round-off
    /// @return whether there is one
    bool first_falling(std::span<const double> c, double length, RootStart start, Root& root, double touch = 0,
                       std::vector<Root>* touches = nullptr);

    /// All crossings (falling and rising) in (0, length], in increasing order.
    void crossings(std::span<const double> c, double length, RootStart start, std::vector<Root>& roots);

    Minimum minimum(std::span<const double> c, double length);

    /// What round-off makes uncertain in values of the polynomial on [0, length].
    static double resolution(std::span<const double> c, double length);

private:
    struct Interval {
        double left, right;
        int depth;
    };
    int highest_degree_;
    std::vector<double> work_;
    std::vector<Interval> stack_;
};

/// Value and derivative by Horner's rule.
double evaluate_polynomial(std::span<const double> c, double s);
double evaluate_derivative(std::span<const double> c, double s);

} // namespace graze
