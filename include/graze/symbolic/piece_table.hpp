#pragma once

#include "graze/symbolic/interval.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace graze {

/// A function of one number that is known at some points, such as a record or a measured force: a polynomial between
/// each two of them. Never changes once made, so that graphs, functions and threads share it.
class PieceTable {
public:
    enum class Interpolation {
        linear,
        cubic, ///< natural spline: its second derivative is zero at the ends; or the periodic one
    };
    /// Values outside the points of a table that is not periodic.
    enum class Outside {
        hold,   ///< the value at the end
        linear, ///< the straight line with the slope at the end
        error,  ///< none: NaN, so that a motion ends there
    };
    struct Options {
        Interpolation interpolation = Interpolation::linear;
        bool periodic = false; ///< the last point is the first one a period later
        Outside outside = Outside::hold;
        bool operator==(const Options&) const = default;
    };
    struct Point {
        double x, y;
        bool operator==(const Point&) const = default;
    };
    static constexpr std::size_t most_points = 1'000'000;

    /// @throws InputError for fewer than two points, or more than `most_points`; numbers that are not finite; abscissae
    /// that do not increase; and a periodic table whose ends differ
    PieceTable(std::string name, std::vector<Point> points, Options options, std::string text = {});

    const std::string& name() const { return name_; }
    const std::string& text() const { return text_; }
    const std::vector<Point>& points() const { return points_; }
    const Options& options() const { return options_; }
    /// Returns the degree of the polynomials.
    int degree() const { return options_.interpolation == Interpolation::linear ? 1 : 3; }
    /// Whether the slope has no jumps.
    bool is_smooth() const {
        return options_.interpolation == Interpolation::cubic &&
               (options_.periodic || options_.outside != Outside::hold);
    }

    static constexpr std::size_t most_coefficients = 4;
    /// A polynomial of x - knot, valid for from <= x < to.
    struct Piece {
        double from, to, knot;
        std::array<double, most_coefficients> coefficients{};
        /// Returns the value of a derivative (0: of the polynomial itself).
        double at(double x, int derivative) const;
    };
    /// Returns the piece to which a number belongs; NaN belongs to one whose coefficients are NaN.
    Piece piece_at(double x) const;
    /// Whether nothing is known beyond this end of a piece.
    bool is_last(double end) const {
        return options_.outside == Outside::error && !options_.periodic &&
               (end == points_.front().x || end == points_.back().x);
    }
    double value(double x, int derivative) const { return piece_at(x).at(x, derivative); }
    /// Encloses the values of a derivative.
    Interval enclose(const Interval& x, int derivative) const;

    bool operator==(const PieceTable& other) const {
        return name_ == other.name_ && text_ == other.text_ && points_ == other.points_ && options_ == other.options_;
    }

private:
    void find_coefficients();
    std::vector<double> second_derivatives() const;
    double period() const { return points_.back().x - points_.front().x; }
    Piece outside_piece(bool above) const;

    std::string name_, text_;
    std::vector<Point> points_;
    Options options_;
    std::vector<std::array<double, most_coefficients>> coefficients_; ///< of the piece that begins at each point
};

} // namespace graze
