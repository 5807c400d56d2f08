#include "branch/point_rules.hpp"

#include "base/concatenated.hpp"
#include "branch/point_kind.hpp"
#include "branch/sliding_name.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

int rank(const SpecialPoint& point) {
    const auto rank = rule_of(point.type).rank;
    return rank ? rank(point) : -1;
}

namespace {

/// True when an orbit without contacts returns to its start after half its period; its cuts may lie elsewhere.
bool repeats_in_half(BranchState& state, const Orbit& orbit, double same) {
    ModeFlow flow = flow_of(state.problem().equations().simulation());
    flow.set_parameters(orbit.parameters);
    std::vector<double> there = orbit.starts.front();
    if (flow.run(orbit.signature.front().mode, there, 0.5 * orbit.return_time()) != ModeFlow::Ending::done)
        return false;
    const auto& active = state.problem().evaluation().active;
    return std::all_of(active.begin(), active.end(), [&](std::size_t i) {
        return state.model().states[i].period ||
               std::abs(there[i] - orbit.starts.front()[i]) <= same * state.problem().scales()[i];
    });
}

/// Merges points at the same place that are consequences of one another: only the first in rank is kept.
void merge(std::vector<SpecialPoint>& found, double length) {
    constexpr double same_place = 1e-6;
    for (std::size_t i = 0; i < found.size(); ++i)
        for (std::size_t j = i + 1; j < found.size();) {
            const int a = rank(found[i]), b = rank(found[j]);
            const bool same_type = found[i].type == found[j].type;
            if (std::abs(found[i].arclength - found[j].arclength) > same_place * length ||
                ((a < 0 || b < 0) && !same_type)) {
                ++j;
                continue;
            }
            if (b < a)
                std::swap(found[i], found[j]);
            found.erase(found.begin() + static_cast<std::ptrdiff_t>(j));
        }
}

/// Drops points within a distance of another one of which they are a consequence.
template <class IsConsequence>
void drop_near(std::vector<SpecialPoint>& found, double distance, const IsConsequence& is_consequence) {
    const std::vector<SpecialPoint> all = found;
    std::erase_if(found, [&](const SpecialPoint& one) {
        return std::any_of(all.begin(), all.end(), [&](const SpecialPoint& other) {
            return std::abs(one.arclength - other.arclength) < distance && is_consequence(one, other);
        });
    });
}

/// True when the equations are singular at a point of the last step, as where a segment's duration vanishes, judged by
/// the determinant there against those at the ends of the step.
bool is_singular_at(BranchState& state, const SpecialPoint& point) {
    constexpr double zero = 1e-3; // share of the determinant at the ends
    Continuation& continuation = state.continuation();
    const double typical =
        std::max(std::abs(continuation.previous().determinant), std::abs(continuation.point().determinant));
    ContinuationPoint there;
    return !continuation.between(state.last_step().fraction(point.arclength), there) ||
           std::abs(there.determinant) < zero * typical;
}

/// Drops branch points near the end of a contact. There the branch meets solutions with a segment of zero duration,
/// which are not orbits; the crossing is dropped if the equations are singular at the end point itself.
void drop_spurious_crossings(BranchState& state, std::vector<SpecialPoint>& found, double length) {
    constexpr double near = 0.05; // share of the step within which determinants are ill-conditioned
    constexpr double same_place = 1e-6;
    const bool on_curve = state.settings().kept.has_value();
    drop_near(found, near * length, [&](const SpecialPoint& one, const SpecialPoint& other) {
        const bool crossing = one.type == PointType::branch_point || one.type == PointType::asymmetry;
        // On curves, folds are detected by the equations without the held condition, which may be singular there.
        const bool multiplier = on_curve && (one.type == PointType::fold || one.type == PointType::flip ||
                                             one.type == PointType::fold_flip);
        const bool contact_ends = other.type == PointType::vanishing || (is_grazing(other.type) && other.at_end);
        return contact_ends && ((multiplier && std::abs(one.arclength - other.arclength) < same_place * length) ||
                                (crossing && is_singular_at(state, other)));
    });
}

/// Drops contacts of no speed where the motion between two parts of a slide vanishes, at which its equations are
/// singular: the contacts at both of its ends are only found near it.
void drop_ends_of_excursions(BranchState& state, std::vector<SpecialPoint>& found, double length) {
    constexpr double near = 0.01; // share of the step
    drop_near(found, near * length, [&](const SpecialPoint& one, const SpecialPoint& other) {
        return one.type == PointType::grazing && other.type == PointType::vanishing &&
               is_adding_sliding(state.system(), other) && is_adding_sliding(state.system(), one);
    });
}

/// Drops folds and flips at 1:1 and 1:2 resonances, where the kept pair of multipliers becomes 1 or -1.
void drop_multipliers_of_resonances(std::vector<SpecialPoint>& found, double length) {
    constexpr double same_place = 1e-4;
    drop_near(found, same_place * length, [](const SpecialPoint& one, const SpecialPoint& other) {
        const bool of_one = one.type == PointType::fold || one.type == PointType::fold_torus,
                   of_minus_one = one.type == PointType::flip || one.type == PointType::flip_torus;
        return (of_one && other.type == PointType::resonance_1) ||
               (of_minus_one && other.type == PointType::resonance_2);
    });
}

/// Merges the ends of the curves of folds and flips of impacting orbits into the point of vanishing sensitivity, with
/// which they coincide for two multipliers.
void drop_parts_of_sensitivity(std::vector<SpecialPoint>& found, double length) {
    constexpr double same_place = 1e-6;
    for (SpecialPoint& whole : found) {
        if (whole.type != PointType::sensitivity)
            continue;
        for (const PointType type : {PointType::fold_degenerate, PointType::flip_degenerate})
            for (const SpecialPoint& one : found)
                if (one.type == type && std::abs(one.arclength - whole.arclength) < same_place * length)
                    whole.detail += "; " + one.detail;
    }
    drop_near(found, same_place * length, [](const SpecialPoint& one, const SpecialPoint& whole) {
        return whole.type == PointType::sensitivity &&
               (one.type == PointType::fold_degenerate || one.type == PointType::flip_degenerate);
    });
}

/// Drops folds where a branch returns to the branch of simpler orbits: the parameter has an extremum there.
void drop_folds_at_return(BranchState& state, std::vector<SpecialPoint>& found, double length) {
    constexpr double near = 0.05; // share of the step: both points are ill-conditioned
    drop_near(found, near * length, [&](const SpecialPoint& one, const SpecialPoint& other) {
        return one.type == PointType::fold && is_degenerate(state, other);
    });
}

/// Drops folds that coincide with a branch point, as at a pitchfork seen from the bifurcating branch.
void drop_folds_at_branch_points(std::vector<SpecialPoint>& found, double length) {
    constexpr double same_place = 2e-3; // share of the step: a fold is ill-conditioned near a branch point
    const auto is_pitchfork = [&](const SpecialPoint& fold, const SpecialPoint& crossing) {
        return fold.type == PointType::fold && crossing.type == PointType::branch_point;
    };
    for (SpecialPoint& one : found)
        if (std::any_of(found.begin(), found.end(), [&](const SpecialPoint& fold) {
                return is_pitchfork(fold, one) && std::abs(fold.arclength - one.arclength) < same_place * length;
            }))
            one.detail = "the branch turns there, as at a pitchfork";
    drop_near(found, same_place * length, is_pitchfork);
}

} // namespace

bool is_degenerate(BranchState& state, const Orbit& orbit, double same) {
    const Model& model = state.model();
    if (orbit.symmetry || orbit.cycle || is_homoclinic(orbit.signature))
        return false;
    if (half_of(state.problem().equations(), orbit, same))
        return true;
    const std::size_t half = orbit.segments() / 2;
    if (orbit.segments() % 2 != 0)
        return false;
    if (orbit.signature.front().end == SegmentEnd::cut)
        return repeats_in_half(state, orbit, same);
    for (std::size_t k = 0; k < half; ++k) {
        if (orbit.signature[k] != orbit.signature[k + half])
            return false;
        for (const std::size_t i : state.problem().evaluation().active)
            if (!model.states[i].period &&
                std::abs(orbit.starts[k][i] - orbit.starts[k + half][i]) > same * state.problem().scales()[i])
                return false;
    }
    return true;
}

bool is_degenerate(BranchState& state, const SpecialPoint& special) {
    constexpr double same = 1e-3;
    return special.type == PointType::branch_point && is_degenerate(state, special.solution.orbit, same);
}

std::vector<std::vector<double>> differences_of_halves(BranchState& state, const Orbit& orbit, bool scaled) {
    const Model& model = state.model();
    const std::size_t half = orbit.segments() / 2;
    std::vector<std::vector<double>> all;
    if (orbit.symmetry || orbit.segments() % 2 != 0 || orbit.cycle || is_homoclinic(orbit.signature))
        return all;
    const auto add = [&](const std::vector<std::size_t>* modes, const auto& image) {
        std::vector<double> differences;
        for (std::size_t k = 0; k < half; ++k) {
            const std::size_t mode = orbit.signature[k].mode;
            if ((modes ? (*modes)[mode] : mode) != orbit.signature[k + half].mode)
                return;
            const std::vector<double> start = image(orbit.starts[k]);
            for (const std::size_t i : state.problem().evaluation().active)
                if (!model.states[i].period)
                    differences.push_back((orbit.starts[k + half][i] - start[i]) /
                                          (scaled ? state.problem().scales()[i] : 1));
        }
        all.push_back(std::move(differences));
    };
    add(nullptr, [](const std::vector<double>& start) { return start; });
    for (std::size_t s = 0; s < model.symmetries.size(); ++s)
        add(&model.symmetries[s].modes, [&](const std::vector<double>& start) {
            return state.system().symmetry(s).map(concatenated(start, orbit.parameters));
        });
    return all;
}

void drop_consequences(BranchState& state, std::vector<SpecialPoint>& found, double length) {
    merge(found, length);
    drop_spurious_crossings(state, found, length);
    drop_ends_of_excursions(state, found, length);
    drop_multipliers_of_resonances(found, length);
    drop_parts_of_sensitivity(found, length);
    drop_folds_at_return(state, found, length);
    drop_folds_at_branch_points(found, length);
}

} // namespace graze
