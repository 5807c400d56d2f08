#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Growth of the scaled derivatives along a segment above which it is split.
constexpr double most_growth = 1e3;
constexpr std::size_t most_splits = 64;

} // namespace

Shooting::Shooting(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free,
                   std::vector<double> ranges)
    : OrbitEquations(simulation, orbit, std::move(free), std::move(ranges)) {
    lay_out(orbit, split(orbit));
}

/// Computes the derivatives of the state after a time, and records the extents of the states and their coupling on the
/// way.
bool Shooting::run_recorded(std::size_t mode, std::span<double> state, double duration, Eigen::MatrixXd& derivatives,
                            StateScales& sizes) {
    constexpr int parts = 4; // several parts, since derivatives may vanish after whole periods
    const Eigen::Index n = index(state.size());
    derivatives = Eigen::MatrixXd::Identity(n, n);
    sizes.note(state);
    Eigen::MatrixXd part;
    for (int i = 0; i < parts; ++i) {
        if (run(flow(), mode, state, duration / parts, part) != ModeFlow::Ending::done)
            return false;
        sizes.note(state);
        orbit_scales().note_arc(part.leftCols(n));
        derivatives = part.leftCols(n) * derivatives;
    }
    return true;
}

/// Records the coupling by the jump after a segment: a state that only impacts excite has no extent where the impacts
/// lose their speed, and its scale would be round-off there.
void Shooting::note_jump(std::size_t segment, const std::vector<double>& end) {
    const auto n = index(layout().states());
    OrbitEvaluation::Piece piece;
    piece.end = piece.after = end;
    piece.jump = Eigen::MatrixXd::Identity(n, n + index(free().size()));
    if (ends().pass(segment, piece) && piece.jump.allFinite())
        orbit_scales().note_coupling(piece.jump.leftCols(n));
}

/// Records the flights of a chatter sequence, which are not split further.
void Shooting::note_contacts(std::size_t segment, StateScales& sizes) {
    const ChatterContacts& found = contacts(segment);
    Eigen::MatrixXd derivatives;
    for (std::size_t i = 0; i < found.durations.size(); ++i) {
        std::vector<double> state = found.starts[i];
        if (found.problem.empty() &&
            run_recorded(signature()[segment].mode, state, found.durations[i], derivatives, sizes))
            sizes.note(state);
    }
}

/// Returns the number of pieces of each segment, from the growth of the scaled derivatives along it.
std::vector<std::size_t> Shooting::split(const Orbit& orbit) {
    StateScales sizes(layout().states());
    sizes.begin();
    std::vector<Eigen::MatrixXd> derivatives(orbit.segments());
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        if (orbit.signature[s].end == SegmentEnd::chatter) {
            note_contacts(s, sizes);
            continue;
        }
        std::vector<double> state = orbit.starts[s];
        if (!(orbit.durations[s] > 0) ||
            !run_recorded(orbit.signature[s].mode, state, orbit.durations[s], derivatives[s], sizes))
            derivatives[s].resize(0, 0);
        note_jump(s, state);
    }
    const std::vector<double> chosen = sizes.choose(ends().periods(), orbit_scales().coupling(), orbit_scales().arcs());
    const Eigen::Map<const Eigen::VectorXd> units = vector_of(chosen);
    std::vector<std::size_t> counts;
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        const Eigen::MatrixXd& one = derivatives[s];
        if (orbit.signature[s].end == SegmentEnd::chatter) {
            counts.push_back(contacts(s).problem.empty() ? contacts(s).starts.size() : 1);
            continue;
        }
        std::size_t count = 1;
        if (one.size() > 0) {
            const Eigen::MatrixXd scaled = units.cwiseInverse().asDiagonal() * one * units.asDiagonal();
            count += static_cast<std::size_t>(std::log(std::max(scaled.norm(), 1.0)) / std::log(most_growth));
        }
        counts.push_back(std::min(count, most_splits));
    }
    return counts;
}

bool Shooting::follow(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) {
    OrbitEvaluation::Piece& piece = at.pieces[k];
    const double* start = unknowns.data() + layout().start_of(k);
    piece.end.assign(start, start + layout().states());
    const std::size_t segment = layout().segment_of(k) + 1;
    switch (run(flow(), mode_of(k), piece.end, unknowns[index(layout().duration_of(k))], piece.flow, &piece.watched)) {
    case ModeFlow::Ending::done:
        ends().field(segment - 1, piece.end, piece.field);
        piece.by_time = piece.field;
        return true;
    case ModeFlow::Ending::singular:
        at.problem = fmt::format("the solution ceases to exist within segment {}", segment);
        return false;
    case ModeFlow::Ending::undefined:
        at.problem = fmt::format("segment {} leaves the domain of its vector field", segment);
        return false;
    case ModeFlow::Ending::too_long:
        at.problem = fmt::format("segment {} takes too many steps", segment);
        at.took_too_long = true;
        return false;
    }
    return false;
}

} // namespace graze
