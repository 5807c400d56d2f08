#include "orbit/cut.hpp"

#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

bool is_event(const Segment& segment) {
    return segment.end == SegmentEnd::event;
}

/// Merges each segment that no event ends with the following ones, up to the next event.
UncutOrbit joined(const Orbit& orbit, const OrbitDirection& direction, std::size_t first) {
    UncutOrbit result{orbit, direction};
    Orbit& whole = result.orbit;
    OrbitDirection& gain = result.direction;
    whole.signature.clear();
    whole.starts.clear();
    whole.durations.clear();
    gain.starts.clear();
    gain.durations.clear();
    bool continues = false;
    for (std::size_t i = 0; i < orbit.segments(); ++i) {
        const std::size_t s = (first + i) % orbit.segments();
        if (!continues) {
            whole.signature.push_back(orbit.signature[s]);
            whole.starts.push_back(orbit.starts[s]);
            whole.durations.push_back(0);
            gain.starts.push_back(direction.starts[s]);
            gain.durations.push_back(0);
        }
        whole.signature.back() = orbit.signature[s];
        whole.durations.back() += orbit.durations[s];
        gain.durations.back() += direction.durations[s];
        continues = !is_event(orbit.signature[s]);
    }
    return result;
}

} // namespace

std::vector<double> passing_rates(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const Eigen::Index states = index(equations.layout().states());
    std::vector<double> rates;
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        const OrbitEvaluation::Piece& piece = at.pieces[equations.layout().last_piece(s)];
        const SegmentEnd end = equations.signature()[s].end;
        rates.push_back(end == SegmentEnd::section ? equations.rate_at_end(at, s) / equations.typical_rate(at, s)
                        : end == SegmentEnd::cut   ? std::copysign(1, piece.condition.head(states).dot(piece.field))
                                                   : 1);
    }
    return rates;
}

std::optional<std::size_t> touched_section(const std::vector<double>& rates) {
    constexpr double hardly = 1e-2; // share of the typical rate
    for (std::size_t s = 0; s < rates.size(); ++s)
        if (!(std::abs(rates[s]) > hardly))
            return s;
    return std::nullopt;
}

std::optional<std::size_t> reversed_section(const std::vector<double>& before, const std::vector<double>& rates) {
    for (std::size_t s = 0; s < std::min(before.size(), rates.size()); ++s)
        if (before[s] * rates[s] < 0)
            return s;
    return std::nullopt;
}

bool cuts_are_oblique(const OrbitEquations& equations, const OrbitEvaluation& at) {
    constexpr double oblique = 0.7; // cosine of the angle to the normal, in scaled states
    const Eigen::VectorXd scales = at.scales.head(index(equations.layout().states()));
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        if (equations.signature()[s].end != SegmentEnd::cut)
            continue;
        const OrbitEvaluation::Piece& piece = at.pieces[equations.layout().last_piece(s)];
        const Eigen::VectorXd normal = piece.condition.head(scales.size()).cwiseProduct(scales);
        Eigen::VectorXd motion = piece.field.cwiseQuotient(scales);
        for (Eigen::Index i = 0; i < motion.size(); ++i) // the position of a drifting state is arbitrary
            if (equations.model().states[static_cast<std::size_t>(i)].drifting)
                motion[i] = 0;
        if (std::abs(normal.dot(motion)) < oblique * normal.norm() * motion.norm())
            return true;
    }
    return false;
}

std::optional<UncutOrbit> without_sections(const Model& model, const Orbit& orbit, const OrbitDirection& direction) {
    const Signature& signature = orbit.signature;
    const auto last = std::find_if(signature.rbegin(), signature.rend(), is_event);
    if (last == signature.rend()) {
        UncutOrbit result{orbit, direction};
        for (Segment& segment : result.orbit.signature)
            segment = {segment.mode, SegmentEnd::cut, 0};
        return result;
    }
    // If segments after the last event continue to the first event, the orbit begins with them.
    const auto first = static_cast<std::size_t>(signature.rend() - last) % signature.size();
    const bool drifts =
        std::any_of(model.states.begin(), model.states.end(), [](const State& one) { return one.drifting; });
    if (first != 0 && (orbit.symmetry || drifts))
        return std::nullopt;
    return joined(orbit, direction, first);
}

} // namespace graze
