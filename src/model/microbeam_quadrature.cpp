#include "model/microbeam_quadrature.hpp"

#include "graze/base/input_error.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace graze {
namespace {

constexpr int most_points = 10000;

std::vector<NodePair> simpson_pairs(int intervals) {
    if (intervals < 2 || intervals % 2 != 0 || intervals > most_points)
        throw InputError("Simpson's rule cannot have " + std::to_string(intervals) + " intervals",
                         "give an even number between 2 and " + std::to_string(most_points));
    std::vector<NodePair> pairs;
    for (int k = 1; k <= intervals / 2; ++k) {
        const double height = k % 2 == 1 ? 4 : 2;
        pairs.push_back({static_cast<double>(k) / intervals, height / (3.0 * intervals)});
    }
    return pairs;
}

struct Legendre {
    double value, slope;
};

Legendre legendre(int degree, double z) {
    double before = 1;
    double value = z;
    for (int n = 2; n <= degree; ++n) {
        const double next = ((2 * n - 1) * z * value - (n - 1) * before) / n;
        before = value;
        value = next;
    }
    return {value, degree * (before - z * value) / ((1 - z) * (1 + z))};
}

std::vector<NodePair> gauss_pairs(int nodes) {
    if (nodes < 1 || nodes > most_points)
        throw InputError("Gauss's rule cannot have " + std::to_string(nodes) + " nodes",
                         "give a number between 1 and " + std::to_string(most_points));
    if (nodes == 1)
        return {{0.5, 1.0}};
    std::vector<NodePair> pairs;
    for (int k = 1; k <= (nodes + 1) / 2; ++k) {
        const bool centre = 2 * k == nodes + 1;
        // Tricomi's estimate is so close to the root of the Legendre polynomial that Newton needs at most four steps.
        double z = centre ? 0 : std::cos(std::numbers::pi * (k - 0.25) / (nodes + 0.5));
        for (int step = 0; step < 10 && !centre; ++step) {
            const Legendre polynomial = legendre(nodes, z);
            const double change = polynomial.value / polynomial.slope;
            z -= change;
            if (std::abs(change) < 1e-16)
                break;
        }
        const double slope = legendre(nodes, z).slope;
        pairs.push_back({(1 - z) / 2, 1 / ((1 - z) * (1 + z) * slope * slope)});
    }
    return pairs;
}

} // namespace

std::vector<NodePair> node_pairs(Quadrature rule, int points) {
    return rule == Quadrature::simpson ? simpson_pairs(points) : gauss_pairs(points);
}

} // namespace graze
