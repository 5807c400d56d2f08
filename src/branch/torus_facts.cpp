#include "branch/torus_facts.hpp"

#include "base/special_numbers.hpp"
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

/// Returns the largest error, half-way between the angles at which the equations hold, in scaled states.
double largest_defect(const TorusProblem& problem, std::span<const double> u) {
    const TorusSetting& setting = problem.setting();
    const Torus torus = problem.torus_of(u);
    const auto count = static_cast<double>(problem.terms());
    double largest = 0;
    for (std::size_t j = 0; j < problem.terms(); ++j) {
        const double turns = (static_cast<double>(j) + 0.5) / count;
        const auto image = setting.back->follow(torus.state_at(turns), u[problem.parameter_place()],
                                                problem.images()[j].motion.durations);
        if (!image)
            return infinity;
        const std::vector<double> wanted = torus.state_at(turns + torus.rotation);
        for (const std::size_t i : setting.active)
            largest = std::max(largest, std::abs(image->after[i] - wanted[i]) / setting.scales[index(i)]);
    }
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
/// which neither grows nor decays. The mean along the quasi-periodic motion is weighted by a smooth bump, with which it
/// converges faster than any power of the number of returns (S. Das, Y. Saiki, E. Sander and J. A. Yorke, Nonlinearity
/// 30, 2017).
double growth_away(const TorusProblem& problem, std::span<const double> u) {
    constexpr std::size_t transient = 300, returns = 1500;
    const Eigen::MatrixXd circle = circle_of(problem, u);
    const Eigen::Index size = circle.rows();
    if (size < 2)
        return 0;
    const DerivativesAround derivatives(problem);
    const Eigen::VectorXd scales = problem.setting().scales(problem.setting().active);
    const double rotation = u[problem.rotation_place()];
    const auto along = [&](double turns) -> Eigen::VectorXd {
        return (circle * circle_function_rates(problem.harmonics(), turns)).cwiseQuotient(scales).normalized();
    };
    Eigen::VectorXd deviation(size);
    for (Eigen::Index i = 0; i < size; ++i)
        deviation[i] = std::cos(2.4 * static_cast<double>(i)); // no special direction
    Eigen::VectorXd tangent = along(0);
    double sum = 0, weights = 0;
    for (std::size_t n = 0; n < transient + returns; ++n) {
        const double turns = rotation * static_cast<double>(n);
        deviation -= tangent.dot(deviation) * tangent;
        const double before = deviation.norm();
        if (!(before > 0))
            return 0;
        const Eigen::VectorXd after = derivatives.at(turns) * (deviation / before);
        tangent = along(turns + rotation);
        deviation = after - tangent.dot(after) * tangent;
        const double growth = deviation.norm();
        if (!(growth > 1e-13)) // all deviations vanish, up to round-off
            return 0;
        if (n < transient)
            continue;
        const double at = (static_cast<double>(n - transient) + 1) / (static_cast<double>(returns) + 1);
        const double weight = std::exp(-1 / (at * (1 - at)));
        sum += weight * std::log(growth);
        weights += weight;
    }
    return std::exp(sum / weights);
}

/// Checks whether the model would follow the motions from all angles. They are looked at from those at which the
/// equations hold and, where an event is nearly touched, from the angle at which its function is least.
class MotionCheck {
public:
    MotionCheck(const TorusProblem& problem, std::span<const double> u, const Simulation& simulation, TorusFacts& facts)
        : problem_(problem), simulation_(simulation), torus_(problem.torus_of(u)),
          parameter_(u[problem.parameter_place()]), facts_(facts) {}

    void check() {
        for (std::size_t j = 0; j < problem_.terms(); ++j)
            note(static_cast<double>(j) / static_cast<double>(problem_.terms()), problem_.images()[j].motion);
        if (facts_.admissible)
            for (const auto& [event, gaps] : gaps_)
                if (gaps.size() == problem_.terms())
                    seek_least(event, gaps);
    }

private:
    using EventOfSegment = std::pair<std::size_t, std::size_t>;
    /// The least value of an event's function along the motion from an angle.
    struct Gap {
        double turns = 0, value = 0, size = 0;
    };

    /// Returns the least values of functions of events along a motion, and notes its certificate.
    std::map<EventOfSegment, Gap> note(double turns, const Orbit& motion, bool keep = true) {
        Shooting shooting(simulation_, motion, {});
        OrbitEvaluation at = shooting.evaluation();
        const bool followed = shooting.evaluate(shooting.unknowns_of(motion), at);
        const Certificate certificate =
            followed ? certify(shooting, at) : Certificate{.admissible = false, .reason = at.problem};
        if (facts_.admissible && !certificate.admissible) {
            facts_.admissible = false;
            facts_.reason = certificate.reason;
        }
        for (std::size_t s = 0; s < certificate.approach_speeds.size(); ++s)
            facts_.approach_speeds[s] = std::min(facts_.approach_speeds[s], certificate.approach_speeds[s]);
        std::map<EventOfSegment, Gap> least;
        for (const OrbitMinimum& minimum : certificate.minima) {
            const auto [one, added] =
                least.try_emplace({minimum.segment, minimum.event}, Gap{turns, minimum.value, minimum.size});
            if (!added && minimum.value < one->second.value)
                one->second = {turns, minimum.value, minimum.size};
        }
        for (const auto& [event, gap] : least)
            if (keep)
                gaps_[event].push_back(gap);
        return least;
    }

    /// Looks where the function of an event is least, by parabolas through three angles.
    void seek_least(const EventOfSegment& event, const std::vector<Gap>& gaps) {
        constexpr double near = 0.2; // of the function's size: other events are not nearly touched
        constexpr int parabolas = 4;
        const std::size_t count = gaps.size();
        const auto lowest = static_cast<std::size_t>(
            std::ranges::min_element(gaps, {}, [](const Gap& gap) { return gap.value; }) - gaps.begin());
        if (!(gaps[lowest].value < near * gaps[lowest].size))
            return;
        Gap before = gaps[(lowest + count - 1) % count], middle = gaps[lowest], after = gaps[(lowest + 1) % count];
        before.turns = middle.turns - 1 / static_cast<double>(count);
        after.turns = middle.turns + 1 / static_cast<double>(count);
        for (int i = 0; i < parabolas && facts_.admissible; ++i) {
            const double left = middle.turns - before.turns, right = after.turns - middle.turns,
                         rise = (after.value - middle.value) / right, fall = (middle.value - before.value) / left,
                         curvature = (rise - fall) / (left + right),
                         turns = middle.turns - 0.5 * ((fall * right + rise * left) / (left + right)) / curvature;
            if (!(curvature > 0) || !(turns > before.turns && turns < after.turns) || turns == middle.turns)
                return;
            const auto image = problem_.setting().back->follow(torus_.state_at(turns), parameter_,
                                                               problem_.images()[lowest].motion.durations);
            if (!image)
                return;
            const auto found = note(turns, image->motion, false);
            const auto here = found.find(event);
            if (here == found.end())
                return;
            const Gap& gap = here->second;
            Gap& outer = gap.value < middle.value ? (turns > middle.turns ? before : after)
                                                  : (turns > middle.turns ? after : before);
            outer = gap.value < middle.value ? middle : gap;
            if (gap.value < middle.value)
                middle = gap;
        }
    }

    const TorusProblem& problem_;
    const Simulation& simulation_;
    Torus torus_;
    double parameter_;
    TorusFacts& facts_;
    std::map<EventOfSegment, std::vector<Gap>> gaps_;
};

} // namespace

TorusFacts facts_of(const TorusProblem& problem, std::span<const double> u, const Simulation& simulation) {
    TorusFacts facts;
    facts.tail = problem.tail_of(u);
    facts.growth = growth_away(problem, u);
    facts.approach_speeds.assign(problem.setting().back->first().segments(), infinity);
    MotionCheck(problem, u, simulation, facts).check();
    facts.defect = largest_defect(problem, u);
    return facts;
}

} // namespace graze
