#include "orbit/homoclinic_candidate.hpp"

#include "base/concatenated.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/orbit_scales.hpp"
#include "orbit/saddle.hpp"

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

/// A state along arcs.
struct ArcPlace {
    std::size_t arc = 0;
    double time = 0; ///< since the start of the arc
    std::vector<double> state;
};

/// States along arcs, at equal intervals of time in each.
class Samples {
public:
    Samples(const std::vector<Arc>& arcs, ModeFlow& flow) : flow_(&flow) {
        for (std::size_t a = 0; a < arcs.size() && followed_; ++a)
            follow(a, arcs[a].end.mode, arcs[a].start, arcs[a].duration);
    }
    Samples(std::size_t mode, const std::vector<double>& start, double duration, ModeFlow& flow) : flow_(&flow) {
        follow(0, mode, start, duration);
    }
    bool are_complete() const { return followed_; }

    /// Scales of the states: their extents.
    Eigen::VectorXd scales() const {
        const std::size_t states = flow_->system().states();
        StateScales sizes(states);
        sizes.begin();
        for (const ArcPlace& place : places_)
            sizes.note(place.state);
        const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(index(states), index(states));
        return vector_of(sizes.choose(flow_->system().periods()(flow_->parameters()), none, none));
    }
    struct Extremes {
        ArcPlace slowest, fastest;
        double least = std::numeric_limits<double>::infinity(), greatest = 0; ///< speeds there
    };
    Extremes extremes(const Eigen::VectorXd& scales) const {
        Extremes result;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const std::vector<double> inputs = concatenated(places_[i].state, flow_->parameters());
            const double speed = vector_of(flow_->system().mode(modes_[i]).rates(inputs)).cwiseQuotient(scales).norm();
            if (speed < result.least) {
                result.least = speed;
                result.slowest = places_[i];
            }
            if (speed > result.greatest) {
                result.greatest = speed;
                result.fastest = places_[i];
            }
        }
        return result;
    }

private:
    void follow(std::size_t arc, std::size_t mode, std::vector<double> state, double duration) {
        constexpr int parts = 200;
        for (int part = 0; part < parts; ++part) {
            places_.push_back({arc, part * duration / parts, state});
            modes_.push_back(mode);
            followed_ = followed_ && flow_->run(mode, state, duration / parts) == ModeFlow::Ending::done;
            if (!followed_)
                return;
        }
    }

    ModeFlow* flow_;
    std::vector<ArcPlace> places_;
    std::vector<std::size_t> modes_;
    bool followed_ = true;
};

/// The orbit from a time after a place at which it is slow to a time before it comes back to the saddle there.
/// @param arcs between which it does; @param round_time after which it does
std::optional<Orbit> orbit_between(const std::vector<Arc>& arcs, const ArcPlace& place, std::size_t rounds,
                                   double round_time, std::vector<double> start, double after, double before,
                                   ModeFlow& flow) {
    const std::size_t mode = arcs[place.arc].end.mode;
    const Segment approach{mode, SegmentEnd::saddle, 0};
    Orbit orbit;
    orbit.starts.push_back(std::move(start));
    if (arcs[place.arc].end.end != SegmentEnd::event) {
        // Without contacts it is cut where it is fastest: deviations where it leaves the saddle then do not grow up to
        // where it comes back.
        const Samples round(mode, place.state, round_time, flow);
        if (!round.are_complete())
            return std::nullopt;
        const ArcPlace cut = round.extremes(round.scales()).fastest;
        orbit.starts.push_back(cut.state);
        orbit.signature = {{mode, SegmentEnd::cut, 0}, approach};
        orbit.durations = {cut.time - after, round_time - cut.time - before};
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

std::optional<HomoclinicCandidate> homoclinic_candidate(const System& system, const Orbit& orbit, double tolerance) {
    // Largest share of the greatest speed; largest distance of the slow place from the saddle; the candidate begins and
    // ends at a multiple of that, where its distance from the spaces is small against that from the saddle.
    constexpr double slow = 0.1, nearest = 0.05, farther = 4, uncertain = 3;
    const auto whole = orbit.cycle ? std::nullopt : whole_of(system, orbit);
    const std::vector<Arc> arcs = whole ? arcs_of(*whole) : std::vector<Arc>();
    if (arcs.empty())
        return std::nullopt;
    const Simulation simulation(system, {}, {}, integration(tolerance));
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    const Samples samples(arcs, flow);
    const Eigen::VectorXd scales = samples.scales();
    const Samples::Extremes extremes = samples.extremes(scales);
    const ArcPlace& place = extremes.slowest;
    if (!samples.are_complete() || !(extremes.least < slow * extremes.greatest))
        return std::nullopt;
    const std::size_t mode = arcs[place.arc].end.mode;
    Saddle saddle(system, mode, {}, scales);
    if (!saddle.find(place.state, orbit.parameters))
        return std::nullopt;
    const Eigen::VectorXd there = saddle.to_coordinates() * saddle.from_saddle(place.state);
    const double distance = there.norm();
    if (!(distance < nearest))
        return std::nullopt;
    Eigen::VectorXd leaving = there, coming = there;
    leaving.tail(saddle.stable()).setZero();
    coming.head(saddle.unstable()).setZero();
    const double after = saddle.time_to(farther * distance, leaving),
                 before = -saddle.time_to(farther * distance, coming);
    const std::size_t half = orbit.symmetry ? 2 : 1;
    auto candidate = orbit_between(arcs, place, arcs.size() / half, orbit.return_time(),
                                   saddle.state_at(saddle.moved(leaving, after)), after, before, flow);
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
