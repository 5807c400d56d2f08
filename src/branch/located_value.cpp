#include "graze/branch/located_value.hpp"

#include "branch/point_kind.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "grazing/return_map.hpp"
#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace graze {

namespace {

constexpr int most_halvings = 8;       ///< largest number of halvings of one correction
constexpr double largest_change = 0.5; ///< largest scaled change of the orbit in one part of the path

std::vector<ParameterId> with_control(const Model& model, ParameterId control, const std::vector<ParameterId>& others) {
    const std::vector<std::string> names = model.independent_parameters();
    require_index(control.place(), names.size(), "parameter");
    std::vector<ParameterId> all{control};
    for (const ParameterId one : others) {
        require_index(one.place(), names.size(), "parameter");
        if (one == control)
            throw InputError(
                fmt::format("'{}' is the parameter whose value follows from the others", names[one.place()]),
                "vary others");
        if (std::find(all.begin(), all.end(), one) != all.end())
            throw InputError(fmt::format("'{}' is to be varied twice", names[one.place()]), "name it once");
        all.push_back(one);
    }
    return all;
}

constexpr double touching_share = 1e-6; // share of the function's size; touches are located far more accurately
constexpr double slow_approach = 1e-4;  // share of the typical rate

/// True when a segment ends with a contact of nearly zero speed, or near an extremum of another watched function.
bool may_touch_at_ends(const Shooting& equations, const OrbitEvaluation& at, const Certificate& certificate) {
    for (std::size_t s = 0; s < equations.signature().size(); ++s) {
        const Segment& segment = equations.signature()[s];
        if (segment.end == SegmentEnd::event && !is_identity_transition(equations.system(), segment.index) &&
            !(std::abs(certificate.approach_speeds[s]) > touching_share * equations.typical_rate(at, s)))
            return true;
    }
    return std::any_of(certificate.end_values.begin(), certificate.end_values.end(), [&](const EndValue& one) {
        return !(std::abs(one.rate) > slow_approach * equations.typical_rate(at, one.segment, one.event));
    });
}

/// Computes cycle maps of a sequence of orbits from existing evaluations, compiling the functions of each mode once.
class TouchedOnce {
public:
    /// @param event the touched event @param certificate of the orbit of the evaluation. The first free parameter of
    /// the equations is that of the map @return empty where the orbit may have other touches or the contact is not
    /// rigid; then use `cycle_map`
    std::optional<CycleMap> map(Shooting& equations, const OrbitEvaluation& at, const Certificate& certificate,
                                std::size_t event) {
        const OrbitMinimum* touch = nullptr;
        for (const OrbitMinimum& one : certificate.minima) {
            if (!(std::abs(one.value) < touching_share * one.size))
                continue;
            if (touch)
                return std::nullopt;
            touch = &one;
        }
        if (!touch || touch->event != event || may_touch_at_ends(equations, at, certificate))
            return std::nullopt;
        const std::size_t mode = equations.signature()[touch->segment].mode;
        auto functions = functions_.find(mode);
        if (functions == functions_.end())
            functions = functions_.emplace(mode, TouchFunctions(equations.system(), mode, event)).first;
        CycleMap map = cycle_map_of(equations, at, {touch->segment, event, touch->time, false}, functions->second, 0,
                                    AskedContacts::rigid);
        if (!map.exists() || map.contact.order != MapOrder::square_root)
            return std::nullopt;
        return map;
    }

private:
    std::map<std::size_t, TouchFunctions> functions_; ///< compiled functions, by mode of the touch
};

} // namespace

void LocatedValueOptions::validate() const {
    orbit.validate();
    constexpr std::size_t most = 30;
    if (halvings > most)
        throw InputError(fmt::format("the path cannot be halved {} times", halvings),
                         fmt::format("choose from 0 to {}", most));
}

std::vector<ParameterId> parameters_but(const Model& model, ParameterId one) {
    std::vector<ParameterId> result;
    for (std::size_t i = 0; i < model.independent_parameters().size(); ++i)
        if (ParameterId(i) != one)
            result.emplace_back(i);
    return result;
}

/// The control parameter and all other parameters are free in the equations of the orbit; the condition of the point
/// and the values of the others close them. Scales and pieces stay those of the point, and so does the condition except
/// along a divided path.
class LocatedValue::Solver {
public:
    Solver(const System& system, const SpecialPoint& point, ParameterId control_parameter,
           std::vector<ParameterId> other_parameters, const LocatedValueOptions& options)
        : others(std::move(other_parameters)), control(control_parameter), options_(options), point_(point),
          simulation_(system, {}, {}, integration(options.orbit.tolerance)),
          equations_(simulation_, point.solution.orbit, with_control(system.model(), control, others)),
          at_(equations_.evaluation()), tried_(equations_.evaluation()), nominal_(equations_.evaluation()) {
        options_.validate();
        Eigen::VectorXd unknowns = equations_.unknowns_of(point.solution.orbit);
        if (!equations_.evaluate(unknowns, nominal_))
            throw InputError(fmt::format("the orbit cannot be followed: {}", nominal_.problem), "choose another point");
        make_condition(nominal_);
        const Eigen::VectorXd wanted = unknowns.tail(index(others.size()));
        std::string problem;
        std::size_t iterations = 0;
        if (!correct(unknowns, wanted, iterations, problem))
            throw InputError(
                fmt::format("the point of type {} is not found again: {}", short_name(point.type), problem),
                "choose another point, or another parameter whose value is to follow");
        nominal_ = at_;
        point_.solution.orbit = equations_.orbit_of(at_.unknowns);
        own = point_;
        make_condition(nominal_);
        if (!condition_->evaluate(equations_, nominal_) || !directions_at(nominal_, nominal_directions_))
            throw InputError(fmt::format("the value of {} does not follow from the other parameters",
                                         system.model().independent_parameters()[control.place()]),
                             "choose one that moves the orbit from the point");
        const Eigen::Index place = index(equations_.layout().parameter(0));
        value = nominal_.unknowns[place];
        values.assign(wanted.begin(), wanted.end());
        for (Eigen::Index i = 0; i < index(others.size()); ++i)
            derivatives.push_back(nominal_directions_(place, i));
    }

    LocatedSolution solve(std::span<const double> asked) {
        require_size(asked.size(), others.size(), "values of parameters");
        require_finite(asked, "values of parameters");
        const Eigen::VectorXd target = vector_of(asked);
        LocatedSolution result;
        result.parts = 1;
        bool moved = false;
        if (!solve_part(nominal_, nominal_directions_, target, result)) {
            moved = true;
            if (!follow_path(target, result)) // the message of the last part is more specific
                result.parts = 0;
        }
        if (result.parts > 0)
            describe(result);
        if (moved) { // restore, so that results do not depend on earlier calls
            point_ = own;
            make_condition(nominal_);
        }
        return result;
    }

    SpecialPoint own; ///< the point at the nominal solution
    std::vector<ParameterId> others;
    ParameterId control;
    double value = 0;
    std::vector<double> values, derivatives;

private:
    void make_condition(const OrbitEvaluation& at) {
        const PointRule& rule = rule_of(point_.type);
        condition_ = rule.condition ? rule.condition(equations_, at, point_) : nullptr;
        if (!condition_)
            throw InputError(fmt::format("a point of type {} ({}) has no condition that could be held",
                                         short_name(point_.type), name_of(point_.type)),
                             "choose a grazing (GR), a fold (SN), a flip (PD), or another whose curve can be followed");
    }

    /// Returns the system closed by the rows of the condition and of the other parameters, scaled to size 1.
    /// @param lack scaled value of the condition. @return empty where the gradient of the condition vanishes or is not
    /// finite
    std::optional<OrbitEquations::Closed> closed(const OrbitEvaluation& at, double& lack) {
        const double unit = condition_->gradient().transpose().cwiseProduct(at.scales).norm();
        if (!std::isfinite(unit) || unit == 0)
            return std::nullopt;
        lack = condition_->value() / unit;
        Eigen::MatrixXd borders = Eigen::MatrixXd::Zero(1 + index(others.size()), index(equations_.unknowns()));
        borders.row(0) = condition_->gradient() / unit;
        for (std::size_t i = 0; i < others.size(); ++i) {
            const Eigen::Index place = index(equations_.layout().parameter(1 + i));
            borders(1 + index(i), place) = 1 / at.scales[place];
        }
        return equations_.close(at, borders);
    }

    /// Computes the derivatives of all unknowns with respect to each other parameter, after an evaluation of the
    /// condition.
    bool directions_at(const OrbitEvaluation& at, Eigen::MatrixXd& directions) {
        double lack = 0;
        const auto system = closed(at, lack);
        if (!system)
            return false;
        directions.resize(index(equations_.unknowns()), index(others.size()));
        Eigen::VectorXd direction;
        // The system must be regular also if there are no other parameters.
        if (!equations_.solve(at, *system, Eigen::VectorXd::Zero(1 + index(others.size())), true, direction))
            return false;
        for (std::size_t i = 0; i < others.size(); ++i) {
            Eigen::VectorXd right = Eigen::VectorXd::Zero(1 + index(others.size()));
            right[1 + index(i)] = 1 / at.scales[index(equations_.layout().parameter(1 + i))];
            if (!equations_.solve(at, *system, right, true, direction))
                return false;
            directions.col(index(i)) = direction;
        }
        return directions.allFinite();
    }

    double size_of(const Eigen::VectorXd& step) const {
        return step.cwiseQuotient(equations_.scales()).cwiseAbs().maxCoeff();
    }

    /// Damped Newton's method from `unknowns`. Sets `at_` to the evaluation at the solution.
    bool correct(Eigen::VectorXd& unknowns, const Eigen::VectorXd& wanted, std::size_t& iterations,
                 std::string& problem) {
        // Corrections below this are accepted without a decrease of the residual, which is round-off.
        constexpr double nearly = 1e-6;
        unknowns.tail(wanted.size()) = wanted;
        if (!equations_.evaluate(unknowns, at_) || !condition_->evaluate(equations_, at_)) {
            problem = at_.problem.empty()
                          ? "the point's condition has no meaning there, as where a touch leaves its segment"
                          : at_.problem;
            return false;
        }
        for (std::size_t k = 0; k < options_.orbit.iterations; ++k) {
            ++iterations;
            double lack = 0;
            const auto system = closed(at_, lack);
            Eigen::VectorXd right = Eigen::VectorXd::Zero(1 + wanted.size()), step;
            right[0] = -lack;
            if (!system || !equations_.solve(at_, *system, right, false, step)) {
                problem = "the equations are singular";
                return false;
            }
            const double size = size_of(step), residual = std::max(at_.residual, std::abs(lack));
            double factor = 1;
            bool improved = false;
            for (int halving = 0; halving < most_halvings && !improved; ++halving, factor *= 0.5) {
                Eigen::VectorXd next = at_.unknowns + factor * step;
                next.tail(wanted.size()) = wanted;
                improved = equations_.evaluate(next, tried_) && condition_->evaluate(equations_, tried_) &&
                           (size < nearly || residual_of(tried_) <= (1 - 0.1 * factor) * residual);
                if (tried_.took_too_long)
                    break;
            }
            if (!improved) {
                problem =
                    tried_.problem.empty()
                        ? "residuals do not fall"
                        : tried_.problem; // without numbers, so that devices with the same problem are counted together
                return false;
            }
            std::swap(at_, tried_);
            unknowns = at_.unknowns;
            if (size < options_.orbit.accuracy)
                return true;
        }
        problem = fmt::format("{} iterations were not enough", options_.orbit.iterations);
        return false;
    }

    double residual_of(const OrbitEvaluation& at) const {
        const double unit = condition_->gradient().transpose().cwiseProduct(at.scales).norm();
        return unit > 0 ? std::max(at.residual, std::abs(condition_->value()) / unit) : at.residual;
    }

    /// Solves for one part of the path. The correction must be small against the prediction; otherwise Newton's method
    /// may have converged to another solution.
    bool solve_part(const OrbitEvaluation& from, const Eigen::MatrixXd& directions, const Eigen::VectorXd& wanted,
                    LocatedSolution& result) {
        constexpr double negligible_correction = 1e-6, largest_part = 0.3;
        const Eigen::VectorXd change = directions * (wanted - from.unknowns.tail(wanted.size()));
        const Eigen::VectorXd predicted = from.unknowns + change;
        Eigen::VectorXd unknowns = predicted;
        if (!(size_of(change) <= largest_change)) {
            result.problem = "the orbit changes too much along the path";
            return false;
        }
        if (!correct(unknowns, wanted, result.iterations, result.problem))
            return false;
        const double correction = size_of(unknowns - predicted), change_size = size_of(change);
        if (correction > std::max(largest_part * change_size, negligible_correction)) {
            result.problem = "Newton's method leads too far from the prediction";
            return false;
        }
        return true;
    }

    /// Finds a touch that has left its segment in the other segments of the predicted orbit.
    bool move_touch_to_segment(const OrbitEvaluation& from, const Eigen::MatrixXd& directions,
                               const Eigen::VectorXd& wanted) {
        if (point_.type != PointType::grazing || point_.at_end)
            return false;
        const Eigen::VectorXd change = directions * (wanted - from.unknowns.tail(wanted.size()));
        if (!(size_of(change) <= largest_change) || !equations_.evaluate(from.unknowns + change, at_))
            return false;
        const auto touch = nearest_touch(certify(equations_, at_), point_.event);
        if (!touch || touch->segment == point_.segment)
            return false;
        point_.solution.orbit = equations_.orbit_of(at_.unknowns);
        point_.segment = touch->segment;
        point_.time = touch->time;
        make_condition(at_);
        return true;
    }

    /// Follows the path to the target values in parts, each predicted from the end of the previous one.
    bool follow_path(const Eigen::VectorXd& target, LocatedSolution& result) {
        OrbitEvaluation from = nominal_;
        Eigen::MatrixXd directions = nominal_directions_;
        const Eigen::VectorXd start = nominal_.unknowns.tail(target.size());
        double done = 0, part = 1;
        for (std::size_t halvings = 0; done < 1;) {
            if (halvings++ == options_.halvings)
                return false;
            for (part = std::min(part / 2, 1 - done); done < 1; done += part) {
                part = std::min(part, 1 - done);
                const Eigen::VectorXd wanted =
                    done + part < 1 ? Eigen::VectorXd(start + (done + part) * (target - start)) : target;
                if (!solve_part(from, directions, wanted, result) &&
                    !(move_touch_to_segment(from, directions, wanted) && solve_part(from, directions, wanted, result)))
                    break;
                ++result.parts;
                from = at_;
                condition_->renew(equations_, from);
                if (!condition_->evaluate(equations_, from) || !directions_at(from, directions))
                    return false;
            }
        }
        result.parts -= 1; // not counting the undivided attempt
        at_ = from;
        return true;
    }

    void describe(LocatedSolution& result) {
        result.problem.clear();
        result.orbit = equations_.orbit_of(at_.unknowns);
        if (!(result.orbit.period() > 0)) {
            result.problem = "Newton's method converged to an orbit of zero duration";
            return;
        }
        result.found = true;
        result.value = at_.unknowns[index(equations_.layout().parameter(0))];
        const Certificate certificate = certify(equations_, at_, held_limit_of(point_));
        result.admissible = certificate.admissible;
        result.problem = certificate.reason;
        if (options_.map && result.admissible && point_.type == PointType::grazing && !point_.at_end)
            result.map = maps_.map(equations_, at_, certificate, point_.event);
    }

    LocatedValueOptions options_;
    SpecialPoint point_; ///< point whose condition is held
    Simulation simulation_;
    Shooting equations_;
    std::unique_ptr<OrbitCondition> condition_;
    OrbitEvaluation at_, tried_;
    OrbitEvaluation nominal_;            ///< evaluation at the point
    Eigen::MatrixXd nominal_directions_; ///< derivatives of the unknowns there, a column for each other parameter
    TouchedOnce maps_;
};

LocatedValue::LocatedValue(const System& system, const SpecialPoint& point, ParameterId control,
                           std::vector<ParameterId> others, const LocatedValueOptions& options)
    : solver_(std::make_unique<Solver>(system, point, control, std::move(others), options)) {}
LocatedValue::~LocatedValue() = default;
LocatedValue::LocatedValue(LocatedValue&&) noexcept = default;

ParameterId LocatedValue::control() const {
    return solver_->control;
}
const std::vector<ParameterId>& LocatedValue::others() const {
    return solver_->others;
}
double LocatedValue::value() const {
    return solver_->value;
}
const std::vector<double>& LocatedValue::values() const {
    return solver_->values;
}
const Orbit& LocatedValue::orbit() const {
    return solver_->own.solution.orbit;
}
const std::vector<double>& LocatedValue::derivatives() const {
    return solver_->derivatives;
}
LocatedSolution LocatedValue::operator()(std::span<const double> values) {
    return solver_->solve(values);
}

} // namespace graze
