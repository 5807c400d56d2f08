#include "graze/grazing/verdict.hpp"

#include "base/decompositions.hpp"
#include "base/enumerator_name.hpp"
#include "base/linear_systems.hpp"
#include "graze/grazing/map_motion.hpp"
#include "grazing/return_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace graze {

namespace {

using Complex = std::complex<double>;

/// Relative tolerance below which a projection counts as zero against its terms, and multipliers as equal.
constexpr double vanishing = 1e-9;
constexpr double stable = 1 - 1e-9;
constexpr std::size_t most_cycles = 1'000'000;

/// Projections as sums over multipliers: weight_i multiplier_i^k.
struct Modes {
    std::vector<Complex> multipliers, weights; ///< in order of decreasing magnitude of the multipliers
    bool known = false; ///< false: the sums do not reproduce the projections, as with double multipliers
};

Modes modes_of(const ScaledCycleMap& map, const std::vector<double>& projections) {
    const auto system = eigensystem(map.matrix);
    Modes modes;
    if (!system)
        return modes;
    const Eigen::MatrixXcd& vectors = system->vectors;
    const Eigen::VectorXcd amounts = FullLU<Complex>(vectors).solve(map.impact.cast<Complex>());
    const Eigen::RowVectorXcd seen = map.gradient.cast<Complex>().transpose() * vectors;
    std::vector<Eigen::Index> order(static_cast<std::size_t>(amounts.size()));
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = index(i);
    std::ranges::sort(order, [&](Eigen::Index one, Eigen::Index other) {
        return std::abs(system->values[one]) > std::abs(system->values[other]);
    });
    for (const Eigen::Index i : order) {
        modes.multipliers.push_back(system->values[i]);
        modes.weights.push_back(seen[i] * amounts[i]);
    }
    modes.known = true;
    for (std::size_t k = 1; k <= projections.size(); ++k) {
        Complex sum = 0;
        double size = 0;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Complex term = modes.weights[i] * std::pow(modes.multipliers[i], static_cast<double>(k));
            sum += term;
            size += std::abs(term);
        }
        constexpr double agreement = 1e-6;
        modes.known = modes.known && std::abs(sum - projections[k - 1]) <= agreement * size;
    }
    return modes;
}

/// Signs of all projections.
struct Signs {
    std::size_t first_negative = 0; ///< 0: none
    std::size_t vanishing = 0;      ///< first projection before it that cannot be told from zero; 0: none
    bool decided = false;
    bool none = false; ///< a contact has no effect on later cycles
    double leading = 0;
};

Signs signs_of(const Modes& modes) {
    Signs signs;
    const double size = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < modes.weights.size(); ++i)
            sum += std::abs(modes.weights[i]) * std::abs(modes.multipliers[i]);
        return sum;
    }();
    // Terms with negligible weight are round-off and left out.
    std::vector<Complex> multipliers, terms;
    double largest = 0;
    for (std::size_t i = 0; i < modes.weights.size(); ++i)
        largest = std::max(largest, std::abs(modes.weights[i]));
    for (std::size_t i = 0; i < modes.weights.size(); ++i)
        if (std::abs(modes.weights[i]) > vanishing * largest && std::abs(modes.multipliers[i]) > vanishing) {
            multipliers.push_back(modes.multipliers[i]);
            terms.push_back(modes.weights[i]);
        }
    if (multipliers.empty() || !(size > 0)) {
        signs.none = true;
        return signs;
    }
    const double unit = std::abs(multipliers.front());
    signs.leading = multipliers.front().real();
    const bool tail_known = multipliers.front().imag() == 0 && multipliers.front().real() > 0 &&
                            terms.front().real() > 0 &&
                            (multipliers.size() == 1 || std::abs(multipliers[1]) < unit * stable);
    for (std::size_t k = 1; k <= most_cycles; ++k) {
        double sum = 0, all = 0, others = 0;
        for (std::size_t i = 0; i < terms.size(); ++i) {
            terms[i] *= multipliers[i] / unit;
            sum += terms[i].real();
            all += std::abs(terms[i]);
            others += i > 0 ? std::abs(terms[i]) : 0;
        }
        if (std::abs(sum) <= vanishing * all) {
            signs.vanishing = k;
            return signs;
        }
        if (sum < 0) {
            signs.first_negative = k;
            signs.decided = true;
            return signs;
        }
        constexpr double dominance = 0.5;
        if (tail_known && others < dominance * terms.front().real()) {
            signs.decided = true;
            return signs;
        }
    }
    return signs;
}

AttractorKind kind_of_multiplier(double leading) {
    return leading < 0.25 ? AttractorKind::period_adding
                          : (3 * leading < 2 ? AttractorKind::periodic_windows : AttractorKind::chaotic);
}

void classify_rigid(const CycleMap& map, Verdict& verdict) {
    const ScaledCycleMap scaled(map);
    const Modes modes = modes_of(scaled, map.projections(std::max<std::size_t>(8, 2 * map.active.size())));
    if (map.clearance_rate)
        verdict.speed_factor = std::sqrt(2 * map.contact.acceleration * std::abs(*map.clearance_rate));
    if (!modes.known) {
        verdict.reason = "multipliers are too close to one another to tell how contacts act on late passes";
        return;
    }
    const Signs signs = signs_of(modes);
    if (signs.none) {
        verdict.reason = "to leading order a contact acts on no later pass";
        return;
    }
    if (signs.vanishing > 0) {
        verdict.reason = fmt::format("to leading order a contact does not act on pass {} after it", signs.vanishing);
        return;
    }
    if (!signs.decided) {
        verdict.reason = fmt::format("the first {} passes do not decide", most_cycles);
        return;
    }
    if (signs.first_negative == 0) {
        verdict.outcome = GrazingOutcome::persists;
        verdict.leading = signs.leading;
        verdict.attractor = kind_of_multiplier(signs.leading);
        return;
    }
    verdict.outcome = GrazingOutcome::lost;
    verdict.next_contact = signs.first_negative;
    const double projection = map.projections(signs.first_negative).back();
    verdict.growth = std::sqrt(-2 * map.contact.acceleration * projection);
    verdict.reach = -2 * map.contact.acceleration * projection;
    if (map.contact.restitution > -1)
        verdict.jump_growth = *verdict.growth * std::sqrt(1 + map.contact.restitution);
}

/// Returns the largest multiplier at a depth. @param root square root of the depth
Complex largest_multiplier(const ScaledCycleMap& map, double root) {
    constexpr double three_halves = 1.5;
    const Eigen::MatrixXd here = map.matrix * (Eigen::MatrixXd::Identity(map.matrix.rows(), map.matrix.cols()) -
                                               three_halves * root * map.impact * map.gradient.transpose());
    const Eigen::VectorXcd values = eigenvalues_or_nan(here);
    return *std::ranges::max_element(values,
                                     [](Complex one, Complex other) { return std::abs(one) < std::abs(other); });
}

/// Returns the square root of the smallest depth at which the orbit loses stability. @param greatest largest root that
/// is searched @return empty if the orbit stays stable
std::optional<double> loss_of_stability(const ScaledCycleMap& map, double greatest) {
    constexpr int parts = 200;
    double before = 0;
    for (int part = 1; part <= parts; ++part) {
        const double root = greatest * part / parts;
        if (std::abs(largest_multiplier(map, root)) < 1) {
            before = root;
            continue;
        }
        double low = before, high = root;
        constexpr int halvings = 60;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (low + high);
            (std::abs(largest_multiplier(map, middle)) < 1 ? low : high) = middle;
        }
        return high;
    }
    return std::nullopt;
}

void classify_compliant(const CycleMap& map, Verdict& verdict) {
    const ScaledCycleMap scaled(map);
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(scaled.matrix.rows(), scaled.matrix.cols());
    const Eigen::VectorXd passed = scaled.matrix * scaled.impact;
    const Eigen::VectorXd settled = FullLU<double>(identity - scaled.matrix).solve(passed);
    const double chi = scaled.gradient.dot(settled);
    const double size = scaled.gradient.cwiseAbs().dot(settled.cwiseAbs());
    verdict.alpha = -chi;
    if (!(std::abs(chi) > vanishing * size)) {
        verdict.reason = "to leading order contacts do not act on the orbit";
        return;
    }
    const double root = 2 / (3 * std::abs(chi));
    if (chi < 0) {
        verdict.fold_depth = root * root;
        verdict.fold_clearance = -4 / (27 * chi * chi);
        if (map.clearance_rate && *map.clearance_rate != 0)
            verdict.fold_distance = *verdict.fold_clearance / *map.clearance_rate;
    }
    // Without a fold, search up to depths at which the leading order is no longer valid.
    constexpr double beyond = 10;
    const auto lost = loss_of_stability(scaled, chi < 0 ? (1 - 1e-6) * root : beyond * root);
    if (lost)
        verdict.unstable_depth = *lost * *lost;
    // A fold far beyond the extent of the states is outside the validity of the map.
    constexpr double deepest = 10;
    const bool near = root * root < deepest * scaled.gradient.cwiseAbs().sum();
    verdict.outcome = chi < 0 && !lost && near ? GrazingOutcome::folds : GrazingOutcome::persists;
}

/// Counts the real multipliers above 1 (sign 1) or below -1 (sign -1).
std::size_t count_beyond(const Eigen::VectorXcd& multipliers, double sign) {
    return static_cast<std::size_t>(
        std::ranges::count_if(multipliers, [&](Complex one) { return one.imag() == 0 && sign * one.real() > 1; }));
}

void classify_sliding(const CycleMap& map, Verdict& verdict) {
    const ScaledCycleMap scaled(map);
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(scaled.matrix.rows(), scaled.matrix.cols());
    const Eigen::VectorXcd multipliers =
        eigenvalues_or_nan(scaled.matrix * (identity - scaled.impact * scaled.gradient.transpose()));
    if (map.clearance_rate)
        verdict.speed_factor = std::sqrt(2 * map.contact.acceleration * std::abs(*map.clearance_rate));
    const double leading = multipliers.cwiseAbs().maxCoeff();
    verdict.leading = leading;
    if ((multipliers.cwiseAbs().array() - 1).abs().minCoeff() <= vanishing) {
        verdict.reason = "the sliding orbit has a multiplier on the unit circle";
        return;
    }
    // The touching orbit is stable, so only multipliers of the sliding orbit count.
    verdict.border = count_beyond(multipliers, 1) % 2 == 0 ? BorderCollision::persistence : BorderCollision::fold;
    verdict.doubles = count_beyond(multipliers, -1) % 2 == 1;
    if (leading < 1) {
        verdict.outcome = GrazingOutcome::persists;
        verdict.attractor = AttractorKind::periodic;
        verdict.slides = verdict.in = 1;
        return;
    }
    // The map scales with the clearance, so one clearance decides. Unbounded motions grow by the leading multiplier per
    // cycle.
    constexpr double clearance = 1e-8, far = 1e6, slow = 1.01;
    const double size = clearance * scaled.gradient.cwiseAbs().sum();
    const MapMotion motion = map_motion(map, -size);
    const double depth = motion.largest * motion.largest / (2 * map.contact.acceleration);
    if (!motion.bounded || depth > far * size) {
        verdict.outcome = GrazingOutcome::lost;
        return;
    }
    if (motion.period == 0 && leading < slow) {
        verdict.reason = "motions leave the sliding orbit too slowly to tell the outcome";
        return;
    }
    verdict.outcome = GrazingOutcome::persists;
    verdict.attractor = motion.period > 0 ? AttractorKind::periodic : AttractorKind::chaotic;
    verdict.slides = motion.contacts;
    verdict.in = motion.period;
}

/// The square of the depth does not change the derivative of the map: a stable orbit remains.
void classify_excursion(const CycleMap& map, Verdict& verdict) {
    if (map.clearance_rate)
        verdict.speed_factor = std::sqrt(2 * map.contact.acceleration * std::abs(*map.clearance_rate));
    verdict.outcome = GrazingOutcome::persists;
    verdict.attractor = AttractorKind::periodic;
}

} // namespace

std::string_view name_of(GrazingOutcome outcome) {
    constexpr std::string_view names[] = {"persists", "lost", "folds", "undecided"};
    return enumerator_name(names, outcome, "undecided");
}

std::string_view name_of(AttractorKind kind) {
    constexpr std::string_view names[] = {"none", "period-adding", "periodic-windows", "chaotic", "periodic"};
    return enumerator_name(names, kind, "none");
}

std::string_view name_of(BorderCollision collision) {
    constexpr std::string_view names[] = {"none", "persistence", "fold"};
    return enumerator_name(names, collision, "none");
}

Verdict verdict_of(const CycleMap& map, std::size_t shown) {
    Verdict verdict;
    if (!map.exists() && !map.contact.ends) {
        verdict.reason = map.reason.empty() ? map.contact.reason : map.reason;
        return verdict;
    }
    verdict.projections = map.projections(shown);
    if (map.clearance_rate)
        verdict.side = *map.clearance_rate < 0 ? 1 : (*map.clearance_rate > 0 ? -1 : 0);
    if (!map.multipliers.empty() && !(std::abs(map.multipliers.front()) < stable)) {
        verdict.reason = "the orbit that touches is not stable itself";
        return verdict;
    }
    if (map.contact.ends) { // other touches do not matter
        verdict.outcome = GrazingOutcome::lost;
        return verdict;
    }
    if (map.touches > 1) {
        verdict.reason = fmt::format("the orbit touches in {} places at once", map.touches);
        return verdict;
    }
    if (map.contact.order == MapOrder::square_root)
        classify_rigid(map, verdict);
    else if (map.contact.order == MapOrder::linear)
        classify_sliding(map, verdict);
    else if (map.contact.order == MapOrder::quadratic)
        classify_excursion(map, verdict);
    else
        classify_compliant(map, verdict);
    return verdict;
}

} // namespace graze
