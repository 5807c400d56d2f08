#include "graze/branch/monitor.hpp"

#include "base/concatenated.hpp"
#include "base/read_whole.hpp"
#include "branch/equilibrium_monitors.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/flow/roots.hpp"
#include "graze/model/conserved.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/segment_arcs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace graze {

namespace {

bool is_along_arcs(Monitor::Kind kind) {
    return kind == Monitor::Kind::maximum || kind == Monitor::Kind::minimum || kind == Monitor::Kind::mean ||
           kind == Monitor::Kind::norm;
}

bool is_at_point(Monitor::Kind kind) {
    return kind == Monitor::Kind::value || kind == Monitor::Kind::start || kind == Monitor::Kind::conserved;
}

/// Returns the index of the segment given by a number "2", a name "J1" or the second of a name "J1#2".
std::size_t segment_named(const Model& model, const Signature& signature, const Monitor& monitor) {
    const std::string& text = monitor.segment;
    const auto number = [](std::string_view digits) -> std::optional<std::size_t> {
        std::size_t value = 0;
        return read_whole(digits, value) ? std::optional(value) : std::nullopt;
    };
    const auto fail = [&]() -> std::size_t {
        throw InputError(fmt::format("monitor '{}': the orbit has no segment '{}'", monitor.name, text),
                         fmt::format("its signature is {}; give a number from 1 to {}, or a name in it",
                                     to_string(model, signature), signature.size()));
    };
    if (const auto place = number(text))
        return *place >= 1 && *place <= signature.size() ? *place - 1 : fail();
    const std::size_t mark = text.find('#');
    std::size_t wanted = 1;
    if (mark != std::string::npos)
        wanted = number(std::string_view(text).substr(mark + 1)).value_or(0);
    const std::string name = text.substr(0, mark);
    const auto is_named = [&](const Segment& segment) {
        return end_name(model, segment) == name ||
               (segment.end == SegmentEnd::event && model.events[model.transitions[segment.index].event].name == name);
    };
    for (std::size_t s = 0; s < signature.size(); ++s)
        if (is_named(signature[s]) && wanted > 0 && --wanted == 0)
            return s;
    return fail();
}

} // namespace

class OrbitMonitors::Evaluator {
public:
    Evaluator(const System& system, const Signature& signature, std::vector<Monitor> monitors, double tolerance)
        : monitors_(std::move(monitors)), system_(system),
          simulation_(system, {}, observed(), {.tolerance = tolerance}), flow_(flow_of(simulation_)),
          arcs_of_(Simulation(system, {}, {}, {.tolerance = tolerance})), roots_(simulation_.order()) {
        const std::size_t modes = system.model().modes.size();
        for (const Monitor& monitor : monitors_) {
            std::vector<Function>& own = functions_.emplace_back();
            for (std::size_t mode = 0; is_at_point(monitor.kind) && mode < modes; ++mode)
                if (mode == 0 || !monitor.in_modes.empty())
                    own.push_back(system.function_of({&monitor.expression_in(mode), 1}));
        }
        set_signature(signature);
    }

    /// Sets the signature; the compiled functions serve all signatures.
    void set_signature(const Signature& signature) {
        const Model& model = system_.model();
        if (signature.empty())
            throw InputError("the signature is empty", "list at least one event or section");
        for (const Segment& segment : signature) {
            require_index(segment.mode, model.modes.size(), "mode");
            end_name(model, segment); // throws when the end does not exist
        }
        std::vector<std::optional<std::size_t>> segments;
        for (const Monitor& monitor : monitors_) {
            segments.push_back(monitor.segment.empty() ? std::optional<std::size_t>()
                                                       : segment_named(model, signature, monitor));
            if (is_at_point(monitor.kind) && !segments.back())
                segments.back() = 0;
        }
        if (is_rest(signature) && !at_rest_)
            at_rest_.emplace(system_, monitors_);
        signature_ = signature;
        segments_ = std::move(segments);
    }

    const std::vector<Monitor>& monitors() const { return monitors_; }
    std::optional<std::size_t> segment(std::size_t monitor) const {
        require_index(monitor, segments_.size(), "monitor");
        return segments_[monitor];
    }

    std::vector<double> values(const Orbit& orbit) {
        validate_orbit(system_.model(), orbit);
        if (orbit.signature != signature_)
            throw InputError("the orbit does not have the signature of the monitors", "make them anew for it");
        if (is_rest(signature_))
            return (*at_rest_)(orbit);
        totals_.assign(monitors_.size(), {});
        values_.assign(monitors_.size(), std::numeric_limits<double>::quiet_NaN());
        flow_.set_parameters(orbit.parameters);
        for (std::size_t s = 0; s < orbit.segments(); ++s)
            follow(orbit, s, [&](std::size_t m) { return segments_[m] ? *segments_[m] == s : !orbit.symmetry; });
        const auto is_whole = [&](std::size_t m) { return !segments_[m]; };
        if (orbit.symmetry && any_whole()) {
            const Orbit whole = whole_orbit(system_, orbit);
            for (std::size_t s = 0; s < whole.segments(); ++s)
                follow(whole, s, is_whole);
        }
        for (std::size_t m = 0; m < monitors_.size(); ++m)
            values_[m] = value_of(m, orbit);
        return values_;
    }

private:
    /// Values accumulated step by step.
    struct Total {
        double least = std::numeric_limits<double>::infinity();
        double greatest = -std::numeric_limits<double>::infinity();
        double integral = 0, time = 0;
    };

    /// Returns the expressions that are needed as series along arcs.
    std::vector<Expression> observed() {
        std::vector<Expression> result;
        for (const Monitor& monitor : monitors_)
            if (is_along_arcs(monitor.kind)) {
                series_.push_back(result.size());
                result.push_back(monitor.kind == Monitor::Kind::norm ? monitor.expression * monitor.expression
                                                                     : monitor.expression);
            } else {
                series_.push_back(0);
            }
        return result;
    }
    bool any_whole() const {
        for (std::size_t m = 0; m < monitors_.size(); ++m)
            if (!segments_[m] && is_along_arcs(monitors_[m].kind))
                return true;
        return false;
    }

    /// Integrates a segment for the monitors that need it.
    template <class Wanted>
    void follow(const Orbit& orbit, std::size_t s, const Wanted& wanted) {
        bool arcs = false, end = false;
        for (std::size_t m = 0; m < monitors_.size(); ++m) {
            if (!wanted(m))
                continue;
            arcs = arcs || is_along_arcs(monitors_[m].kind);
            end = end || monitors_[m].kind == Monitor::Kind::value;
            if (monitors_[m].kind == Monitor::Kind::start || monitors_[m].kind == Monitor::Kind::conserved)
                values_[m] = at(m, orbit.signature[s].mode, orbit.starts[s], orbit);
        }
        if (!arcs && !end)
            return;
        const std::size_t mode = orbit.signature[s].mode;
        const std::size_t events = simulation_.system().mode(mode).watched.size();
        const SegmentArcs along = arcs_of_(orbit, s);
        std::vector<double> state;
        for (std::size_t i = 0; i < along.starts.size(); ++i) {
            state = along.starts[i];
            flow_.run(mode, state, along.durations[i], [&](const Jet& jet, double, double length) {
                for (std::size_t m = 0; m < monitors_.size(); ++m)
                    if (is_along_arcs(monitors_[m].kind) && wanted(m))
                        gather(m, jet.output(events + series_[m]), length);
            });
        }
        if (!along.end.empty())
            state = along.end;
        for (std::size_t m = 0; m < monitors_.size(); ++m)
            if (monitors_[m].kind == Monitor::Kind::value && wanted(m))
                values_[m] = at(m, mode, state, orbit);
    }

    double at(std::size_t m, std::size_t mode, const std::vector<double>& state, const Orbit& orbit) const {
        const std::vector<Function>& own = functions_[m];
        return own[own.size() == 1 ? 0 : mode](concatenated(state, orbit.parameters))[0];
    }

    void gather(std::size_t m, const double* series, double length) {
        Total& total = totals_[m];
        const auto count = static_cast<std::size_t>(simulation_.order()) + 1;
        coefficients_.assign(series, series + count);
        const Monitor::Kind kind = monitors_[m].kind;
        if (kind == Monitor::Kind::mean || kind == Monitor::Kind::norm) {
            double sum = 0;
            for (std::size_t k = count; k-- > 0;)
                sum = sum * length + coefficients_[k] / static_cast<double>(k + 1);
            total.integral += sum * length;
            total.time += length;
            return;
        }
        const auto note = [&](double value) {
            total.least = std::min(total.least, value);
            total.greatest = std::max(total.greatest, value);
        };
        note(coefficients_[0]);
        note(evaluate_polynomial(coefficients_, length));
        if (length < 0)
            return; // for a segment of negative duration only the ends are evaluated
        derivative_.clear();
        for (std::size_t k = 1; k < count; ++k)
            derivative_.push_back(static_cast<double>(k) * coefficients_[k]);
        roots_.crossings(derivative_, length, RootStart::as_is, found_);
        for (const Root& root : found_)
            note(evaluate_polynomial(coefficients_, root.at));
    }

    double value_of(std::size_t m, const Orbit& orbit) const {
        const Total& total = totals_[m];
        switch (monitors_[m].kind) {
        case Monitor::Kind::duration:
            return segments_[m] ? orbit.durations[*segments_[m]] : orbit.period();
        case Monitor::Kind::maximum:
            return std::isfinite(total.greatest) ? total.greatest : values_[m];
        case Monitor::Kind::minimum:
            return std::isfinite(total.least) ? total.least : values_[m];
        case Monitor::Kind::mean:
            return total.integral / total.time;
        case Monitor::Kind::norm:
            return std::sqrt(total.integral / total.time);
        default:
            return values_[m];
        }
    }

    std::vector<Monitor> monitors_;
    std::vector<std::size_t> series_; ///< index of each monitor's series among the observed ones
    Signature signature_;
    System system_;
    Simulation simulation_;
    ModeFlow flow_;
    SegmentArcsFinder arcs_of_;
    RootFinder roots_;
    std::vector<std::optional<std::size_t>> segments_;
    std::optional<EquilibriumMonitors> at_rest_;   ///< made for the first signature of an equilibrium
    std::vector<std::vector<Function>> functions_; ///< of each monitor at points: one, or one for each mode
    std::vector<Total> totals_;
    std::vector<double> values_, coefficients_, derivative_;
    std::vector<Root> found_;
};

Monitor monitor_of_conserved(const Model& model, const std::string& name) {
    const auto found = find_named(model.conserved, name);
    if (!found) {
        std::string known;
        for (const ConservedQuantity& one : model.conserved)
            known += (known.empty() ? "" : ", ") + one.name;
        throw InputError(fmt::format("the model has no conserved quantity '{}'", name),
                         known.empty() ? "declare it: [conserved] energy = \"...\"" : "it has " + known);
    }
    const ConservedQuantity& conserved = model.conserved[*found];
    Model scratch = model;
    Monitor monitor;
    monitor.name = name;
    monitor.unit = conserved.unit;
    monitor.kind = Monitor::Kind::conserved;
    for (const Mode& mode : model.modes) {
        const Expression* own = conserved_in(conserved, mode.name);
        monitor.in_modes.push_back(own ? scratch.expand(*own) : scratch.number(0));
    }
    monitor.expression = monitor.in_modes.front();
    if (conserved.modes.empty())
        monitor.in_modes.clear();
    return monitor;
}

void measure_multipliers(const std::vector<Monitor>& monitors, const std::vector<std::complex<double>>& multipliers,
                         std::vector<double>& values) {
    require_size(values.size(), monitors.size(), "values of monitors");
    for (const Monitor& monitor : monitors)
        if (monitor.kind == Monitor::Kind::multiplier && monitor.place < 1)
            throw InputError(fmt::format("monitor '{}' is no multiplier", monitor.name), "count them from 1");
    for (std::size_t m = 0; m < monitors.size(); ++m)
        if (monitors[m].kind == Monitor::Kind::multiplier && monitors[m].place <= multipliers.size())
            values[m] = std::abs(multipliers[monitors[m].place - 1]);
}

OrbitMonitors::OrbitMonitors(const System& system, const Signature& signature, std::vector<Monitor> monitors,
                             double tolerance)
    : evaluator_(std::make_unique<Evaluator>(system, signature, std::move(monitors), tolerance)) {}
OrbitMonitors::~OrbitMonitors() = default;
OrbitMonitors::OrbitMonitors(OrbitMonitors&&) noexcept = default;

void OrbitMonitors::set_signature(const Signature& signature) {
    evaluator_->set_signature(signature);
}
const std::vector<Monitor>& OrbitMonitors::monitors() const {
    return evaluator_->monitors();
}
std::optional<std::size_t> OrbitMonitors::segment(std::size_t monitor) const {
    return evaluator_->segment(monitor);
}
std::vector<double> OrbitMonitors::operator()(const Orbit& orbit) {
    return evaluator_->values(orbit);
}

} // namespace graze
