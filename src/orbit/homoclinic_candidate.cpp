#include "graze/base/input_error.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/saddle.hpp"
#include "orbit/solve_homoclinic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// A part of an orbit between two contacts.
struct Arc {
    Segment end;
    std::vector<double> start;
    double duration = 0;
};

/// Returns the arcs of an orbit; of one without contacts a single arc, once around. Empty where contacts accumulate.
std::vector<Arc> arcs_of(const Orbit& orbit) {
    const Signature& signature = orbit.signature;
    const auto is_event = [](const Segment& one) { return one.end == SegmentEnd::event; };
    if (std::ranges::any_of(signature, [](const Segment& one) { return one.end == SegmentEnd::chatter; }))
        return {};
    const auto last = std::find_if(signature.rbegin(), signature.rend(), is_event);
    const std::size_t first = static_cast<std::size_t>(signature.rend() - last) % signature.size();
    std::vector<Arc> arcs;
    bool continues = false;
    for (std::size_t i = 0; i < orbit.segments(); ++i) {
        const std::size_t s = (first + i) % orbit.segments();
        if (!continues)
            arcs.push_back({signature[s], orbit.starts[s], 0});
        arcs.back().end = signature[s];
        arcs.back().duration += orbit.durations[s];
        continues = !is_event(signature[s]);
    }
    return arcs;
}

/// Where an orbit is slowest.
struct SlowPlace {
    std::size_t arc = 0;
    double time = 0;
    std::vector<double> state;
    double speed = std::numeric_limits<double>::infinity(), fastest = 0; ///< in scales of the states per time
};

/// @return empty where the orbit cannot be followed
std::optional<SlowPlace> slowest_place(const std::vector<Arc>& arcs, ModeFlow& flow,
                                       const std::vector<double>& parameters, const Eigen::VectorXd& scales) {
    constexpr int parts = 200;
    SlowPlace slowest;
    for (std::size_t a = 0; a < arcs.size(); ++a) {
        const std::size_t mode = arcs[a].end.mode;
        std::vector<double> state = arcs[a].start;
        for (int part = 0; part < parts; ++part) {
            std::vector<double> inputs = state;
            inputs.insert(inputs.end(), parameters.begin(), parameters.end());
            const double speed = vector_of(flow.system().mode(mode).rates(inputs)).cwiseQuotient(scales).norm();
            slowest.fastest = std::max(slowest.fastest, speed);
            if (speed < slowest.speed) {
                slowest.arc = a;
                slowest.time = part * arcs[a].duration / parts;
                slowest.state = state;
                slowest.speed = speed;
            }
            if (flow.run(mode, state, arcs[a].duration / parts) != ModeFlow::Ending::done)
                return std::nullopt;
        }
    }
    return slowest;
}

/// The orbit from a time after the slow place to a time before it recurs.
/// @param rounds number of arcs until it recurs
std::optional<Orbit> orbit_between(const std::vector<Arc>& arcs, const SlowPlace& place, std::size_t rounds,
                                   double round_time, std::vector<double> start, double after, double before) {
    const Segment approach{arcs[place.arc].end.mode, SegmentEnd::saddle, 0};
    Orbit orbit;
    orbit.starts.push_back(std::move(start));
    if (arcs[place.arc].end.end != SegmentEnd::event) { // without contacts
        orbit.signature = {approach};
        orbit.durations = {round_time - after - before};
    } else {
        orbit.signature.push_back(arcs[place.arc].end);
        orbit.durations.push_back(arcs[place.arc].duration - place.time - after);
        for (std::size_t i = 1; i <= rounds; ++i) {
            const Arc& arc = arcs[(place.arc + i) % arcs.size()];
            orbit.starts.push_back(arc.start);
            orbit.signature.push_back(i < rounds ? arc.end : approach);
            orbit.durations.push_back(i < rounds ? arc.duration : place.time - before);
        }
    }
    const bool lasts = std::ranges::all_of(orbit.durations, [](double one) { return one > 0; });
    return lasts ? std::optional(orbit) : std::nullopt;
}

/// The whole of an orbit; empty where the image of a half orbit has no segments.
std::optional<Orbit> whole_of(const System& system, const Orbit& orbit) {
    try {
        return whole_orbit(system, orbit);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

} // namespace

std::optional<HomoclinicCandidate> homoclinic_candidate(const System& system, const Orbit& orbit,
                                                        const Eigen::VectorXd& scales, double tolerance) {
    // Largest share of the greatest speed; largest distance of the slow place from the saddle; the candidate begins and
    // ends at a multiple of that, where its distance from the spaces is small against that from the saddle.
    constexpr double slow = 0.1, nearest = 0.05, farther = 4, uncertain = 3;
    const auto whole = whole_of(system, orbit);
    const std::vector<Arc> arcs = whole ? arcs_of(*whole) : std::vector<Arc>();
    if (arcs.empty())
        return std::nullopt;
    const Simulation simulation(system, {}, {}, integration(tolerance));
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    const auto place = slowest_place(arcs, flow, orbit.parameters, scales);
    if (!place || !(place->speed < slow * place->fastest))
        return std::nullopt;
    const std::size_t mode = arcs[place->arc].end.mode;
    Saddle saddle(system, mode, {}, scales);
    if (!saddle.find(place->state, orbit.parameters))
        return std::nullopt;
    const Eigen::VectorXd there = saddle.to_coordinates() * saddle.from_saddle(place->state);
    const double distance = there.norm();
    if (!(distance < nearest))
        return std::nullopt;
    Eigen::VectorXd leaving = there, coming = there;
    leaving.tail(saddle.stable()).setZero();
    coming.head(saddle.unstable()).setZero();
    const double after = saddle.time_to(farther * distance, leaving),
                 before = -saddle.time_to(farther * distance, coming);
    const std::size_t half = orbit.symmetry ? 2 : 1;
    auto candidate = orbit_between(arcs, *place, arcs.size() / half, orbit.return_time(),
                                   saddle.state_at(saddle.moved(leaving, after)), after, before);
    if (!candidate)
        return std::nullopt;
    candidate->parameters = orbit.parameters;
    std::vector<double> end = candidate->starts.back();
    if (flow.run(mode, end, candidate->durations.back()) != ModeFlow::Ending::done ||
        !((saddle.to_coordinates() * saddle.from_saddle(end)).norm() < uncertain * farther * distance))
        return std::nullopt; // of another saddle, such as the image of this one
    return HomoclinicCandidate{std::move(*candidate), distance};
}

} // namespace graze
