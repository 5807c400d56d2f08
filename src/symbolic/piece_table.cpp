#include "graze/symbolic/piece_table.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace graze {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
/// A number beyond the range of a table by no more than this share of it, and its own round-off, is taken to be its
/// end.
constexpr double end_roundoff = 1e-12;

/// Returns the factor of coefficient k in a derivative: k!/(k - derivative)!.
double factor_of(int k, int derivative) {
    double factor = 1;
    for (int i = 0; i < derivative; ++i)
        factor *= k - i;
    return factor;
}

/// Solves a system whose matrix has a diagonal and, beside it, the same entries below and above.
std::vector<double> solve_tridiagonal(std::vector<double> diagonal, const std::vector<double>& beside,
                                      std::vector<double> right) {
    const std::size_t size = diagonal.size();
    for (std::size_t i = 1; i < size; ++i) {
        const double share = beside[i - 1] / diagonal[i - 1];
        diagonal[i] -= share * beside[i - 1];
        right[i] -= share * right[i - 1];
    }
    for (std::size_t i = size; i-- > 0;)
        right[i] = (right[i] - (i + 1 < size ? beside[i] * right[i + 1] : 0)) / diagonal[i];
    return right;
}

} // namespace

PieceTable::PieceTable(std::string name, std::vector<Point> points, Options options, std::string text)
    : name_(std::move(name)), text_(std::move(text)), points_(std::move(points)), options_(options) {
    if (points_.size() < 2 || points_.size() > most_points)
        throw InputError(fmt::format("table '{}' has {} points", name_, points_.size()),
                         fmt::format("give from 2 to {} points", most_points));
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (!std::isfinite(points_[i].x) || !std::isfinite(points_[i].y))
            throw InputError(fmt::format("point {} of table '{}' is not finite", i + 1, name_), "give finite numbers");
        if (i > 0 && !(points_[i - 1].x < points_[i].x))
            throw InputError(fmt::format("the abscissae of table '{}' do not increase: point {} is at {}, after {}",
                                         name_, i + 1, points_[i].x, points_[i - 1].x),
                             "sort the points, and leave out repeated ones");
    }
    if (options_.periodic && points_.front().y != points_.back().y)
        throw InputError(fmt::format("the periodic table '{}' begins with the value {} and ends with {}", name_,
                                     points_.front().y, points_.back().y),
                         "repeat the first value at the end, one period later");
    if (!std::isfinite(period()))
        throw InputError(fmt::format("the range of table '{}' is not finite", name_), "choose another unit");
    find_coefficients();
}

/// Returns the second derivatives of the spline at the points (A. Quarteroni, R. Sacco, F. Saleri, Numerical
/// Mathematics, section 8.7.1).
std::vector<double> PieceTable::second_derivatives() const {
    const std::size_t pieces = points_.size() - 1;
    std::vector<double> width(pieces), slope(pieces), second(pieces + 1, 0.0);
    for (std::size_t i = 0; i < pieces; ++i) {
        width[i] = points_[i + 1].x - points_[i].x;
        slope[i] = (points_[i + 1].y - points_[i].y) / width[i];
    }
    if (!options_.periodic) {
        if (pieces < 2)
            return second;
        std::vector<double> diagonal, beside, right;
        for (std::size_t i = 1; i < pieces; ++i) {
            diagonal.push_back(2 * (width[i - 1] + width[i]));
            beside.push_back(width[i]);
            right.push_back(6 * (slope[i] - slope[i - 1]));
        }
        const std::vector<double> inner = solve_tridiagonal(diagonal, beside, right);
        std::ranges::copy(inner, second.begin() + 1);
        return second;
    }
    if (pieces == 1)
        return second;
    std::vector<double> diagonal(pieces), right(pieces);
    for (std::size_t i = 0; i < pieces; ++i) {
        const std::size_t before = i > 0 ? i - 1 : pieces - 1;
        diagonal[i] = 2 * (width[before] + width[i]);
        right[i] = 6 * (slope[i] - slope[before]);
    }
    if (pieces == 2) {
        const double both = width[0] + width[1];
        return {right[0] / both, right[1] / both, right[0] / both};
    }
    // The corners of the matrix are a product of a column and a row (Sherman and Morrison).
    const double corner = width[pieces - 1], first = diagonal[0];
    diagonal[0] += first;
    diagonal[pieces - 1] += corner * corner / first;
    std::vector<double> column(pieces, 0.0);
    column[0] = -first;
    column[pieces - 1] = corner;
    const std::vector<double> plain = solve_tridiagonal(diagonal, width, right),
                              change = solve_tridiagonal(diagonal, width, column);
    const double share =
        (plain[0] - corner / first * plain[pieces - 1]) / (1 + change[0] - corner / first * change[pieces - 1]);
    for (std::size_t i = 0; i < pieces; ++i)
        second[i] = plain[i] - share * change[i];
    second[pieces] = second[0];
    return second;
}

void PieceTable::find_coefficients() {
    const bool cubic = options_.interpolation == Interpolation::cubic;
    const std::vector<double> second = cubic ? second_derivatives() : std::vector<double>(points_.size(), 0.0);
    coefficients_.resize(points_.size() - 1);
    for (std::size_t i = 0; i < coefficients_.size(); ++i) {
        const double width = points_[i + 1].x - points_[i].x;
        const double slope = (points_[i + 1].y - points_[i].y) / width;
        coefficients_[i] = {points_[i].y, slope - width * (2 * second[i] + second[i + 1]) / 6, second[i] / 2,
                            (second[i + 1] - second[i]) / (6 * width)};
        if (!std::ranges::all_of(coefficients_[i], [](double c) { return std::isfinite(c); }))
            throw InputError(fmt::format("table '{}' is too steep between points {} and {}", name_, i + 1, i + 2),
                             "leave out one of them, or choose other units");
    }
}

double PieceTable::Piece::at(double x, int derivative) const {
    const double u = x - knot;
    double value = 0;
    for (int k = static_cast<int>(most_coefficients) - 1; k >= derivative; --k)
        value = value * u + factor_of(k, derivative) * coefficients[static_cast<std::size_t>(k)];
    return value;
}

PieceTable::Piece PieceTable::outside_piece(bool above) const {
    const Point& end = above ? points_.back() : points_.front();
    Piece piece{above ? end.x : -endless, above ? endless : end.x, end.x, {}};
    if (options_.outside == Outside::error) {
        piece.coefficients.fill(std::numeric_limits<double>::quiet_NaN());
        return piece;
    }
    piece.coefficients[0] = end.y;
    if (options_.outside == Outside::linear) {
        const std::size_t i = above ? coefficients_.size() - 1 : 0;
        piece.coefficients[1] = Piece{points_[i].x, points_[i + 1].x, points_[i].x, coefficients_[i]}.at(end.x, 1);
    }
    return piece;
}

PieceTable::Piece PieceTable::piece_at(double x) const {
    if (std::isnan(x) || (options_.periodic && std::isinf(x))) {
        Piece none{-endless, endless, 0, {}};
        none.coefficients.fill(std::numeric_limits<double>::quiet_NaN());
        return none;
    }
    double shift = 0;
    if (options_.periodic) {
        shift = std::floor((x - points_.front().x) / period()) * period();
    } else {
        const double size = std::max(std::abs(points_.front().x), std::abs(points_.back().x));
        const double tolerance = options_.outside == Outside::error ? end_roundoff * period() + 64 * epsilon * size : 0;
        if (x < points_.front().x - tolerance)
            return outside_piece(false);
        if (x >= points_.back().x + tolerance)
            return outside_piece(true);
    }
    const auto above = std::upper_bound(points_.begin() + 1, points_.end() - 1, x - shift,
                                        [](double value, const Point& point) { return value < point.x; });
    const auto i = static_cast<std::size_t>(above - points_.begin()) - 1;
    return {points_[i].x + shift, points_[i + 1].x + shift, points_[i].x + shift, coefficients_[i]};
}

Interval PieceTable::enclose(const Interval& x, int derivative) const {
    if (x.empty())
        return Interval::none();
    Interval all = Interval::none();
    const bool whole = options_.periodic && !(x.width() < period());
    double at = whole ? points_.front().x : x.lower;
    const double end = whole ? points_.back().x : x.upper;
    bool continuous = x.continuous;
    for (bool last = false; !last;) {
        const Piece piece = piece_at(at);
        last = !(piece.to <= end) || std::isinf(piece.to); // at its end the next piece begins
        at = std::max(piece.to, std::nextafter(at, endless));
        if (std::isnan(piece.coefficients[0])) { // outside its domain
            continuous = false;
            continue;
        }
        const Interval here = whole ? Interval{piece.from, piece.to}
                                    : Interval{std::max(x.lower, piece.from), std::min(x.upper, piece.to)};
        const Interval u = (here.empty() ? Interval::point(piece.knot) : here) - Interval::point(piece.knot);
        Interval value = Interval::point(0);
        for (int k = static_cast<int>(most_coefficients) - 1; k >= derivative; --k)
            value = value * u + Interval::point(factor_of(k, derivative)) *
                                    Interval::point(piece.coefficients[static_cast<std::size_t>(k)]);
        all = all.empty() ? value : hull(all, value);
    }
    // A derivative that jumps is not continuous.
    const bool jumps = derivative > (is_smooth() ? 2 : 0);
    all.continuous = all.continuous && continuous && (!jumps || piece_at(x.lower).to > x.upper);
    return all;
}

} // namespace graze
