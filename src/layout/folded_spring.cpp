#include "graze/layout/folded_spring.hpp"

#include "layout/require_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace graze {

namespace {

using Load = std::array<double, 3>; ///< force in x and y, moment; x is the direction of motion, y that of the beams
using Compliance = std::array<Load, 3>;

/// A straight part of the chain. Lengths in units of a beam's, compliances in units of a beam's 1/(E I).
struct Piece {
    double x = 0, y = 0;   ///< where it begins
    double dx = 0, dy = 0; ///< to its end
    double bending = 0;    ///< I of a beam by its own; 0: rigid
    double stretching = 0; ///< the same of A, times the square of a beam's radius of gyration

    double length() const { return std::abs(dx) + std::abs(dy); }
};

class Chain {
public:
    void add(double dx, double dy, double bending = 0, double stretching = 0) {
        pieces_.push_back({x_, y_, dx, dy, bending, stretching});
        x_ += dx;
        y_ += dy;
    }
    const std::vector<Piece>& pieces() const { return pieces_; }

    /// Bending moment in a share of a piece by each load at the chain's end.
    Load moment(const Piece& piece, double share) const {
        return {-(y_ - piece.y - share * piece.dy), x_ - piece.x - share * piece.dx, 1};
    }

    Compliance compliance() const {
        Compliance sum{};
        for (const Piece& piece : pieces_) {
            const double length = piece.length();
            if (!(length > 0))
                continue;
            const Load axial{piece.dx / length, piece.dy / length, 0};
            const std::array<Load, 3> moments{moment(piece, 0), moment(piece, 0.5), moment(piece, 1)};
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j) {
                    const auto product = [&](std::size_t k) { return moments[k][i] * moments[k][j]; };
                    // Simpson's rule is exact for the product of linear functions.
                    sum[i][j] += piece.bending * length * (product(0) + 4 * product(1) + product(2)) / 6 +
                                 piece.stretching * length * axial[i] * axial[j];
                }
        }
        return sum;
    }

private:
    std::vector<Piece> pieces_;
    double x_ = 0, y_ = 0;
};

/// The loads that move the end by one in x, and not otherwise.
Load loads_of_motion(const Compliance& c) {
    const auto minor = [&](std::size_t a, std::size_t b, std::size_t p, std::size_t q) {
        return c[a][p] * c[b][q] - c[a][q] * c[b][p];
    };
    const Load cofactors{minor(1, 2, 1, 2), -minor(1, 2, 0, 2), minor(1, 2, 0, 1)};
    const double determinant = c[0][0] * cofactors[0] + c[0][1] * cofactors[1] + c[0][2] * cofactors[2];
    return {cofactors[0] / determinant, cofactors[1] / determinant, cofactors[2] / determinant};
}

Chain chain_of(const FoldedSpring& spring) {
    const double length = spring.beam_length;
    const double inertia = spring.beam_width.mean_cube() / 12, area = spring.beam_width.mean(); // by height
    const double gyration = inertia / area / (length * length);
    const double truss_bending = spring.beam_width.mean_cube() / spring.truss_width.mean_cube();
    const double truss_stretching = gyration * spring.beam_width.mean() / spring.truss_width.mean();
    const double half_truss = 0.5 * spring.truss_width.mean() / length, half_beam = 0.5 * area / length;
    Chain chain;
    double direction = 1;
    for (std::size_t i = 0; i < spring.beams; ++i) {
        chain.add(0, direction, 1, gyration);
        chain.add(0, direction * half_truss);
        chain.add(half_beam, 0);
        chain.add(spring.spacing / length, 0, truss_bending, truss_stretching);
        if (i + 1 < spring.beams) {
            chain.add(half_beam, 0);
            chain.add(0, -direction * half_truss);
        }
        direction = -direction;
    }
    return chain;
}

/// Greatest stress at the ends of beams, in units of E by displacement in beam lengths, for thickness in beam lengths.
double greatest_stress(const Chain& chain, const Load& loads, double half_width, double gyration) {
    double greatest = 0;
    for (const Piece& piece : chain.pieces())
        if (piece.bending == 1 && piece.dy != 0)
            for (const double end : {0.0, 1.0}) {
                const Load moments = chain.moment(piece, end);
                const double moment = moments[0] * loads[0] + moments[1] * loads[1] + moments[2] * loads[2];
                greatest = std::max(greatest, std::abs(moment) * half_width + std::abs(loads[1]) * gyration);
            }
    return greatest;
}

/// Area that moves with the mass.
double moving_area(const FoldedSpring& spring) {
    const auto n = static_cast<double>(spring.beams);
    const double beam = spring.beam_length * spring.beam_width.mean();
    const double truss = spring.truss_width.mean() * (spring.spacing + 2 * spring.beam_width.mean());
    double sum = 0;
    for (std::size_t i = 0; i < spring.beams; ++i) {
        const double before = static_cast<double>(i);
        sum += beam * (before * before + before + 13.0 / 35) / (n * n); // integral of (before + 3 s^2 - 2 s^3)^2
        if (i + 1 < spring.beams)
            sum += truss * (before + 1) * (before + 1) / (n * n);
    }
    return sum + spring.truss_width.mean() * (spring.spacing + spring.beam_width.mean()); // the link
}

} // namespace

SpringProperties properties_of(const FoldedSpring& spring) {
    if (spring.beams == 0)
        throw InputError("a spring has no beams", "it takes at least one");
    require_positive(spring.beam_length, "length of the flexures");
    require_positive(spring.beam_width.least(), "width of the flexures after the etch");
    require_positive(spring.truss_width.least(), "width of the trusses after the etch");
    require_positive(spring.spacing, "distance between the flexures after the etch");
    require_positive(spring.height, "height of the flexures");
    require_positive(spring.modulus, "Young's modulus");
    const Chain chain = chain_of(spring);
    const Load loads = loads_of_motion(chain.compliance());
    const double length = spring.beam_length, inertia = spring.beam_width.mean_cube() / 12;
    const double slender = inertia / length / length * (spring.height / length); // I/L^3
    const double gyration = inertia / spring.beam_width.mean() / (length * length);
    SpringProperties result;
    result.stiffness = spring.modulus * slender * loads[0];
    result.stiff_trusses = spring.modulus * slender * 12 / static_cast<double>(spring.beams);
    result.stress_per_travel =
        spring.modulus / length * greatest_stress(chain, loads, 0.5 * spring.beam_width.greatest() / length, gyration);
    result.moving_area = moving_area(spring);
    return result;
}

} // namespace graze
