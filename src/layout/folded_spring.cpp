#include "graze/layout/folded_spring.hpp"

#include "layout/require_size.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace graze {

namespace {

/// Loads: force in x and y and moment at the guided end, force in y in the middle; x is the direction of motion, y that
/// of the beams.
using Load = Eigen::Vector4d;

/// A straight part of the chain. Lengths in units of a beam's length, compliances in units of a beam's 1/(E I).
struct Piece {
    double x = 0, y = 0;   ///< start
    double dx = 0, dy = 0; ///< vector to its end
    double bending = 0;    ///< ratio of a beam's I to its own; 0: rigid
    double stretching = 0; ///< ratio of a beam's A to its own, times the squared radius of gyration of a beam
    bool to_end = true, to_middle = false; ///< which loads it carries
    bool is_beam = false;

    double length() const { return std::abs(dx) + std::abs(dy); }
};

class Chain {
public:
    void add(double dx, double dy, double bending = 0, double stretching = 0) {
        pieces_.push_back({x_, y_, dx, dy, bending, stretching});
        x_ += dx;
        y_ += dy;
    }
    void add_beam(double dy, double stretching) {
        add(0, dy, 1, stretching);
        pieces_.back().is_beam = true;
    }
    /// Adds the branch from here to the middle.
    void add_branch(double rigid, double free, double bending) {
        for (Piece& piece : pieces_)
            piece.to_middle = true;
        middle_x_ = x_ - rigid - free;
        // The branch carries no axial force.
        pieces_.push_back({x_ - rigid, y_, -free, 0, bending, 0, false, true});
    }
    const std::vector<Piece>& pieces() const { return pieces_; }

    /// Bending moments at a relative position of a piece, by each load.
    Load moments(const Piece& piece, double share) const {
        const double x = piece.x + share * piece.dx, y = piece.y + share * piece.dy;
        const double end = piece.to_end ? 1 : 0, middle = piece.to_middle ? 1 : 0;
        return {-end * (y_ - y), end * (x_ - x), end, middle * (middle_x_ - x)};
    }
    /// Axial forces of a piece, by each load.
    static Load forces(const Piece& piece) {
        const double x = piece.dx / piece.length(), y = piece.dy / piece.length();
        return {piece.to_end ? x : 0, piece.to_end ? y : 0, 0, piece.to_middle ? y : 0};
    }

    Eigen::Matrix4d compliance() const {
        Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
        for (const Piece& piece : pieces_) {
            const double length = piece.length();
            if (!(length > 0 && (piece.bending > 0 || piece.stretching > 0)))
                continue;
            const Load first = moments(piece, 0), middle = moments(piece, 0.5), last = moments(piece, 1);
            const Load axial = forces(piece);
            // Simpson's rule is exact for a product of linear functions.
            sum += piece.bending * length / 6 *
                   (first * first.transpose() + 4 * middle * middle.transpose() + last * last.transpose());
            sum += piece.stretching * length * axial * axial.transpose();
        }
        return sum;
    }

private:
    std::vector<Piece> pieces_;
    double x_ = 0, y_ = 0, middle_x_ = 0;
};

EtchedWidth finger_of(const FoldedSpring& spring) {
    return {.top = 2 * (spring.half_middle + spring.beam_width.top),
            .bottom = 2 * (spring.half_middle + spring.beam_width.bottom)};
}

Chain chain_of(const FoldedSpring& spring) {
    const double length = spring.beam_length, width = spring.beam_width.mean();
    const double gyration = spring.beam_width.mean_cube() / 12 / width / (length * length);
    const double bending = spring.beam_width.mean_cube() / spring.truss_width.mean_cube();
    const double stretching = gyration * width / spring.truss_width.mean();
    const double half_truss = 0.5 * spring.truss_width.mean() / length, half_beam = 0.5 * width / length;
    Chain chain;
    if (spring.finger_length > 0) // half of it belongs to this half
        chain.add(0, spring.finger_length / length, 2 * spring.beam_width.mean_cube() / finger_of(spring).mean_cube());
    chain.add(spring.half_middle / length + half_beam, 0);
    double direction = 1;
    for (std::size_t i = 0; i < spring.beams; ++i) {
        chain.add_beam(direction, gyration);
        chain.add(0, direction * half_truss);
        if (i == 0)
            chain.add_branch(half_beam, spring.half_middle / length, bending);
        chain.add(half_beam, 0);
        chain.add(spring.spacing / length, 0, bending, stretching);
        if (i + 1 < spring.beams) {
            chain.add(half_beam, 0);
            chain.add(0, -direction * half_truss);
        }
        direction = -direction;
    }
    if (spring.bar_length > 0) {
        const double bar = spring.bar_width.mean();
        chain.add(0.5 * bar / length, 0);
        chain.add(0, direction * half_truss);
        chain.add(0, direction * spring.bar_length / length,
                  spring.beam_width.mean_cube() / spring.bar_width.mean_cube(), gyration * width / bar);
    }
    return chain;
}

/// Largest stress at the ends of beams, in units of E, per displacement in units of a beam's length.
double greatest_stress(const Chain& chain, const Load& loads, double half_width, double gyration) {
    double greatest = 0;
    for (const Piece& piece : chain.pieces())
        if (piece.is_beam)
            for (const double end : {0.0, 1.0})
                greatest = std::max(greatest, std::abs(chain.moments(piece, end).dot(loads)) * half_width +
                                                  std::abs(Chain::forces(piece).dot(loads)) * gyration);
    return greatest;
}

double moving_area(const FoldedSpring& spring) {
    const auto n = static_cast<double>(spring.beams);
    const double beam = spring.beam_length * spring.beam_width.mean();
    const double truss = spring.spacing + 2 * spring.beam_width.mean();
    double sum = 0;
    for (std::size_t i = 0; i < spring.beams; ++i) {
        const auto before = static_cast<double>(i);
        sum += beam * (before * before + before + 13.0 / 35) / (n * n); // integral of (before + 3 s^2 - 2 s^3)^2
        const double length = truss + (i == 0 ? spring.half_middle : 0);
        if (i + 1 < spring.beams)
            sum += spring.truss_width.mean() * length * (before + 1) * (before + 1) / (n * n);
    }
    return sum;
}

} // namespace

SpringProperties properties_of(const FoldedSpring& spring) {
    if (spring.beams < 2)
        throw InputError(fmt::format("a folded spring has {} beams", spring.beams), "it takes at least two");
    require_positive(spring.beam_length, "length of the flexures");
    require_positive(spring.beam_width, "width of the flexures after the etch");
    require_positive(spring.truss_width, "width of the trusses after the etch");
    require_positive(spring.spacing, "distance between the flexures after the etch");
    require_positive(spring.half_middle, "distance of the flexures from the middle after the etch");
    require_positive(spring.height, "height of the flexures");
    require_positive(spring.modulus, "Young's modulus", "Pa");
    require_not_negative(spring.finger_length, "length of the frame's finger");
    require_not_negative(spring.bar_length, "length of the mass's bars after the etch");
    if (spring.bar_length > 0)
        require_positive(spring.bar_width, "width of the mass's bars after the etch");
    const Chain chain = chain_of(spring);
    const Load loads = chain.compliance().ldlt().solve(Load::UnitX());
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
