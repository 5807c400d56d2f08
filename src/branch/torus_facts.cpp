#include "branch/torus_facts.hpp"

#include "base/concatenated.hpp"
#include "base/special_numbers.hpp"
#include "branch/circle_minimum.hpp"
#include "orbit/certify.hpp"
#include "orbit/shooting.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace graze {

namespace {

Eigen::MatrixXd circle_of(const TorusProblem& problem, std::span<const double> u) {
    return Eigen::Map<const Eigen::MatrixXd>(u.data(), index(problem.setting().active.size()), index(problem.terms()));
}

/// The motions from any angle of a torus.
class TorusAngles {
public:
    TorusAngles(const TorusProblem& problem, std::span<const double> u)
        : problem_(&problem), torus_(problem.torus_of(u)), parameter_(u[problem.parameter_place()]) {}

    const Torus& torus() const { return torus_; }
    std::optional<SignatureReturn::Image> image_from(double turns) const {
        const double whole = turns - std::floor(turns);
        const auto nearest = static_cast<std::size_t>(whole * static_cast<double>(problem_->terms()));
        const auto& images = problem_->images();
        return problem_->setting().back->follow(torus_.state_at(turns), parameter_,
                                                images[nearest % images.size()].motion.durations);
    }
    std::optional<Orbit> motion_from(double turns) const {
        auto image = image_from(turns);
        return image ? std::optional(std::move(image->motion)) : std::nullopt;
    }
    /// Returns the motions from equally spaced angles: those at which the equations hold, and as many between as show
    /// what happens along a return. Few harmonics suffice for the circle itself, but not for that.
    std::vector<Orbit> motions() const {
        constexpr std::size_t fewest = 24;
        const std::size_t terms = problem_->terms(), parts = (fewest + terms - 1) / terms;
        std::vector<Orbit> result;
        for (std::size_t j = 0; j < terms * parts; ++j) {
            if (j % parts == 0) {
                result.push_back(problem_->images()[j / parts].motion);
            } else if (auto motion = motion_from(static_cast<double>(j) / static_cast<double>(terms * parts))) {
                result.push_back(std::move(*motion));
            } else {
                return {};
            }
        }
        return result;
    }

private:
    const TorusProblem* problem_;
    Torus torus_;
    double parameter_;
};

/// Returns the error of the circle's image at an angle, in scaled states; infinite where motions do not return.
/// @param round_off share of the states, and of their scales, that is no error
double error_at(const TorusProblem& problem, const TorusAngles& angles, double turns, double round_off = 0) {
    const TorusSetting& setting = problem.setting();
    const auto image = angles.image_from(turns);
    if (!image)
        return infinity;
    const std::vector<double> wanted = angles.torus().state_at(turns + angles.torus().rotation);
    double largest = 0;
    for (const std::size_t i : setting.active) {
        const double scale = setting.scales[index(i)];
        largest = std::max(largest, std::abs(image->after[i] - wanted[i]) / scale -
                                        round_off * std::max(1.0, std::abs(wanted[i]) / scale));
    }
    return largest;
}

/// Returns the largest error, half-way between the angles at which the equations hold.
double largest_defect(const TorusProblem& problem, const TorusAngles& angles) {
    double largest = 0;
    for (std::size_t j = 0; j < problem.terms(); ++j)
        largest = std::max(
            largest, error_at(problem, angles, (static_cast<double>(j) + 0.5) / static_cast<double>(problem.terms())));
    return largest;
}

/// The derivative of the return by the states, in their scales, as a Fourier series around the circle.
class DerivativesAround {
public:
    explicit DerivativesAround(const TorusProblem& problem) : harmonics_(problem.harmonics()) {
        const TorusSetting& setting = problem.setting();
        const Eigen::VectorXd scales = setting.scales(setting.active);
        const auto count = static_cast<double>(problem.terms());
        terms_.assign(problem.terms(), Eigen::MatrixXd::Zero(scales.size(), scales.size()));
        for (std::size_t j = 0; j < problem.terms(); ++j) {
            const Eigen::MatrixXd here = scales.cwiseInverse().asDiagonal() *
                                         problem.images()[j].derivatives(setting.active, setting.active) *
                                         scales.asDiagonal();
            const Eigen::VectorXd functions = circle_functions(harmonics_, static_cast<double>(j) / count);
            for (std::size_t term = 0; term < terms_.size(); ++term)
                terms_[term] += (term == 0 ? 1 : 2) / count * functions[index(term)] * here;
        }
    }
    Eigen::MatrixXd at(double turns) const {
        const Eigen::VectorXd functions = circle_functions(harmonics_, turns);
        Eigen::MatrixXd sum = terms_[0];
        for (std::size_t term = 1; term < terms_.size(); ++term)
            sum += functions[index(term)] * terms_[term];
        return sum;
    }

private:
    std::size_t harmonics_;
    std::vector<Eigen::MatrixXd> terms_;
};

/// Returns the mean growth per return of the deviation that grows fastest, without its component along the circle,
/// which neither grows nor decays: the mean over motions from all angles, which is that along one of them.
double growth_away(const TorusProblem& problem, std::span<const double> u) {
    constexpr std::size_t transient = 100, returns = 50, fewest_angles = 64;
    const Eigen::MatrixXd circle = circle_of(problem, u);
    const Eigen::Index size = circle.rows();
    const std::size_t angles = std::max(fewest_angles, 2 * problem.terms());
    const DerivativesAround derivatives(problem);
    const Eigen::VectorXd scales = problem.setting().scales(problem.setting().active);
    const double rotation = u[problem.rotation_place()];
    const auto along = [&](double turns) -> Eigen::VectorXd {
        return (circle * circle_function_rates(problem.harmonics(), turns)).cwiseQuotient(scales).normalized();
    };
    double sum = 0;
    for (std::size_t j = 0; j < angles; ++j) {
        double turns = static_cast<double>(j) / static_cast<double>(angles);
        Eigen::VectorXd deviation(size), tangent = along(turns);
        for (Eigen::Index i = 0; i < size; ++i)
            deviation[i] = std::cos(2.4 * static_cast<double>(i)); // no special direction
        deviation -= tangent.dot(deviation) * tangent;
        for (std::size_t n = 0; n < transient + returns; ++n) {
            const Eigen::VectorXd after = derivatives.at(turns) * deviation.normalized();
            turns += rotation;
            tangent = along(turns);
            deviation = after - tangent.dot(after) * tangent;
            const double growth = deviation.norm();
            if (!(growth > 1e-13)) // all deviations vanish, up to round-off
                return 0;
            if (n >= transient)
                sum += std::log(growth);
        }
    }
    return std::exp(sum / static_cast<double>(angles * returns));
}

/// Checks whether the model would follow the motions from all angles. They are looked at from equally spaced ones and,
/// where an event is nearly touched, from the angle at which its function is least.
class MotionCheck {
public:
    MotionCheck(const TorusAngles& angles, const Simulation& simulation, TorusFacts& facts)
        : angles_(angles), simulation_(simulation), facts_(facts) {}

    void check() {
        constexpr double near = 0.2; // of the function's size: other events are not nearly touched
        const std::vector<Orbit> motions = angles_.motions();
        if (motions.empty()) {
            facts_.admissible = false;
            facts_.reason = "the motion from some angles does not return";
        }
        std::map<EventOfSegment, std::vector<double>> gaps;
        std::map<EventOfSegment, double> sizes;
        for (std::size_t j = 0; j < motions.size() && facts_.admissible; ++j)
            for (const auto& [event, gap] : certified(motions[j])) {
                gaps.try_emplace(event, motions.size(), infinity).first->second[j] = gap.value;
                sizes[event] = std::max({sizes[event], gap.size, std::abs(gap.value)});
            }
        for (const auto& [event, values] : gaps) {
            if (!facts_.admissible)
                return;
            if (std::abs(*std::ranges::min_element(values)) > near * sizes[event])
                continue;
            least_around(values, [this, &event = event](double turns) -> std::optional<double> {
                const auto motion = facts_.admissible ? angles_.motion_from(turns) : std::nullopt;
                if (!motion)
                    return std::nullopt;
                const auto found = certified(*motion);
                const auto gap = found.find(event);
                return gap == found.end() ? infinity : gap->second.value;
            });
        }
    }

private:
    using EventOfSegment = std::pair<std::size_t, std::size_t>;
    /// Notes the certificate of a motion. @return the least values of the functions of events along it, ends included:
    /// where a minimum has moved beyond the end of a return, the motion after it has it
    std::map<EventOfSegment, OrbitMinimum> certified(const Orbit& motion) {
        Shooting shooting(simulation_, motion, {});
        OrbitEvaluation at = shooting.evaluation();
        Certificate certificate;
        if (shooting.evaluate(shooting.unknowns_of(motion), at)) {
            certificate = certify(shooting, at);
        } else {
            certificate.admissible = false;
            certificate.reason = at.problem;
        }
        if (facts_.admissible && !certificate.admissible) {
            facts_.admissible = false;
            facts_.reason = certificate.reason;
        }
        for (std::size_t s = 0; s < certificate.approach_speeds.size(); ++s)
            facts_.approach_speeds[s] = std::min(facts_.approach_speeds[s], certificate.approach_speeds[s]);
        std::map<EventOfSegment, OrbitMinimum> least;
        for (const OrbitMinimum& minimum : certificate.minima) {
            const auto [one, added] = least.try_emplace({minimum.segment, minimum.event}, minimum);
            if (!added && minimum.value < one->second.value)
                one->second = minimum;
        }
        const auto note = [&](const EventOfSegment& event, double time, double value) {
            const auto [one, added] = least.try_emplace(event);
            if (added)
                one->second = {event.first, event.second, time, value, std::abs(value)};
            one->second.value = std::min(one->second.value, value);
        };
        for (const EndValue& end : certificate.end_values)
            if (kind_of(end.event) != EventKind::section) // may have either sign
                note({end.segment, end.event}, motion.durations[end.segment], end.value);
        for (std::size_t s = 0; s < motion.segments(); ++s)
            note_start(motion, s, note);
        return least;
    }

    EventKind kind_of(std::size_t event) const { return simulation_.model().events[event].kind; }

    /// Notes the barriers at the start of a segment, beyond which a jump may lead; but not that from which it jumps.
    template <class Note>
    void note_start(const Orbit& motion, std::size_t segment, const Note& note) const {
        const System& system = simulation_.system();
        const System::CompiledMode& mode = system.mode(motion.signature[segment].mode);
        const std::size_t before = (segment + motion.segments() - 1) % motion.segments();
        const Transition* const made = transition_of(system.model(), motion.signature[before]);
        std::vector<double> values;
        for (std::size_t w = 0; w < mode.watched.size(); ++w) {
            const std::size_t event = mode.watched[w];
            const bool is_left =
                made && (made->event == event || std::ranges::find(made->also, event) != made->also.end());
            if (kind_of(event) != EventKind::barrier || is_left)
                continue;
            if (values.empty())
                values = mode.events(concatenated(motion.starts[segment], motion.parameters));
            note({segment, event}, 0, values[w]);
        }
    }

    const TorusAngles& angles_;
    const Simulation& simulation_;
    TorusFacts& facts_;
};

} // namespace

TorusFacts facts_of(const TorusProblem& problem, std::span<const double> u, const Simulation& simulation) {
    TorusFacts facts;
    facts.tail = problem.tail_of(u);
    facts.approach_speeds.assign(problem.setting().back->first().segments(), infinity);
    const TorusAngles angles(problem, u);
    MotionCheck(angles, simulation, facts).check();
    if (!facts.admissible)
        return facts; // nothing else is asked of a torus that the model would not follow
    facts.growth = growth_away(problem, u);
    facts.defect = largest_defect(problem, angles);
    return facts;
}

bool is_resolved(const TorusProblem& problem, std::span<const double> u, const TorusResolution& resolution) {
    constexpr double largest_error = 100; // as a multiple of the last harmonics: those left out add up
    constexpr int angles = 5;
    constexpr double golden = 0.6180339887498949; // no equal spacing, of which higher harmonics could make use
    constexpr double round_off = 1e-12;
    if (!(problem.tail_of(u) <= resolution.tail))
        return false;
    const TorusAngles at(problem, u);
    const double allowed = largest_error * resolution.tail * problem.largest_from(1, u);
    for (int k = 0; k < angles; ++k)
        if (!(error_at(problem, at, 0.2137 + k * golden, round_off) <= allowed))
            return false;
    return true;
}

std::vector<double> extremes_of(const TorusProblem& problem, std::span<const double> u, OrbitMonitors& monitors) {
    std::vector<std::vector<double>> samples(monitors.monitors().size());
    const auto sign_of = [&](std::size_t m) {
        return monitors.monitors()[m].kind == Monitor::Kind::maximum ? -1.0 : 1.0;
    };
    const TorusAngles angles(problem, u);
    for (const Orbit& motion : angles.motions()) {
        const std::vector<double> values = monitors(motion);
        for (std::size_t m = 0; m < values.size(); ++m)
            samples[m].push_back(sign_of(m) * values[m]);
    }
    std::vector<double> extremes;
    for (std::size_t m = 0; m < samples.size(); ++m)
        extremes.push_back(sign_of(m) * least_around(samples[m], [&](double turns) -> std::optional<double> {
                               const auto motion = angles.motion_from(turns);
                               return motion ? std::optional(sign_of(m) * monitors(*motion)[m]) : std::nullopt;
                           }));
    return extremes;
}

} // namespace graze
