#include "graze/branch/located_value.hpp"

#include "branch/point_kind.hpp"
#include "branch/touched_once.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

constexpr int most_halvings = 8;    ///< of one correction
constexpr double longest_way = 0.5; ///< of one part, in units of the orbit's sizes

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

} // namespace

void LocatedValueOptions::validate() const {
    orbit.validate();
    constexpr std::size_t most = 30;
    if (halvings > most)
        throw InputError(fmt::format("the way cannot be halved {} times", halvings),
                         fmt::format("choose from 0 to {}", most));
}

std::vector<ParameterId> parameters_but(const Model& model, ParameterId one) {
    std::vector<ParameterId> result;
    for (std::size_t i = 0; i < model.independent_parameters().size(); ++i)
        if (ParameterId(i) != one)
            result.emplace_back(i);
    return result;
}

/// The equations have the control parameter and all others as free ones. What closes them are the point's condition and
/// the others' values. Scales, pieces and, but for divided ways, the condition are those of the point for good.
class LocatedValue::Solver {
public:
    Solver(const System& system, const SpecialPoint& point, ParameterId control, std::vector<ParameterId> others,
           const LocatedValueOptions& options)
        : options_(options), point_(point), others_(std::move(others)), control_(control),
          simulation_(system, {}, {}, integration(options.orbit.tolerance)),
          equations_(simulation_, point.solution.orbit, with_control(system.model(), control, others_)),
          at_(equations_.evaluation()), tried_(equations_.evaluation()), neighbour_(equations_.evaluation()) {
        options_.validate();
        Eigen::VectorXd unknowns = equations_.unknowns_of(point.solution.orbit);
        if (!equations_.evaluate(unknowns, neighbour_))
            throw InputError(fmt::format("the orbit cannot be followed: {}", neighbour_.problem),
                             "choose another point");
        make_condition(neighbour_);
        const Eigen::VectorXd wanted = unknowns.tail(index(others_.size()));
        std::string problem;
        std::size_t iterations = 0;
        if (!correct(unknowns, wanted, iterations, problem))
            throw InputError(
                fmt::format("the point of type {} is not found again: {}", short_name(point.type), problem),
                "choose another point, or another parameter whose value is to follow");
        neighbour_ = at_;
        point_.solution.orbit = equations_.orbit_of(at_.unknowns);
        own_ = point_;
        make_condition(neighbour_);
        if (!condition_->evaluate(equations_, neighbour_) || !directions_at(neighbour_, neighbour_directions_))
            throw InputError(fmt::format("the value of {} does not follow from the other parameters",
                                         system.model().independent_parameters()[control.place()]),
                             "choose one that moves the orbit from the point");
        const Eigen::Index place = index(equations_.layout().parameter(0));
        value_ = neighbour_.unknowns[place];
        values_.assign(wanted.begin(), wanted.end());
        for (Eigen::Index i = 0; i < index(others_.size()); ++i)
            derivatives_.push_back(neighbour_directions_(place, i));
    }

    ParameterId control() const { return control_; }
    const std::vector<ParameterId>& others() const { return others_; }
    double value() const { return value_; }
    const std::vector<double>& values() const { return values_; }
    const std::vector<double>& derivatives() const { return derivatives_; }
    const Orbit& orbit() const { return own_.solution.orbit; }

    LocatedSolution solve(std::span<const double> values) {
        require_size(values.size(), others_.size(), "values of parameters");
        require_finite(values, "values of parameters");
        const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(values.data(), index(values.size()));
        LocatedSolution result;
        result.parts = 1;
        bool moved = false;
        if (!go(neighbour_, neighbour_directions_, target, result)) {
            moved = true;
            if (!divide(target, result)) // the problem of its last part says more than that of the whole
                result.parts = 0;
        }
        if (result.parts > 0)
            describe(result);
        if (moved) { // as it was, whatever has been asked for
            point_ = own_;
            make_condition(neighbour_);
        }
        return result;
    }

private:
    void make_condition(const OrbitEvaluation& at) {
        const PointRule& rule = rule_of(point_.type);
        condition_ = rule.condition ? rule.condition(equations_, at, point_) : nullptr;
        if (!condition_)
            throw InputError(fmt::format("a point of type {} ({}) has no condition that could be held",
                                         short_name(point_.type), name_of(point_.type)),
                             "choose a grazing (GR), a fold (SN), a flip (PD), or another whose curve can be followed");
    }

    /// Rows of the condition and of the others, in units in which they are of size 1.
    /// @param lack what the condition is off, in these units. @return none where that has no meaning
    std::optional<OrbitEquations::Closed> closed(const OrbitEvaluation& at, double& lack) {
        const double unit = condition_->gradient().transpose().cwiseProduct(at.scales).norm();
        if (!std::isfinite(unit) || unit == 0)
            return std::nullopt;
        lack = condition_->value() / unit;
        Eigen::MatrixXd borders = Eigen::MatrixXd::Zero(1 + index(others_.size()), index(equations_.unknowns()));
        borders.row(0) = condition_->gradient() / unit;
        for (std::size_t i = 0; i < others_.size(); ++i) {
            const Eigen::Index place = index(equations_.layout().parameter(1 + i));
            borders(1 + index(i), place) = 1 / at.scales[place];
        }
        return equations_.close(at, borders);
    }

    /// What all unknowns gain by a unit of each of the others, where the condition has just been evaluated.
    bool directions_at(const OrbitEvaluation& at, Eigen::MatrixXd& directions) {
        double lack = 0;
        const auto system = closed(at, lack);
        if (!system)
            return false;
        directions.resize(index(equations_.unknowns()), index(others_.size()));
        Eigen::VectorXd direction;
        // Without others the system must be regular all the same.
        if (!equations_.solve(at, *system, Eigen::VectorXd::Zero(1 + index(others_.size())), true, direction))
            return false;
        for (std::size_t i = 0; i < others_.size(); ++i) {
            Eigen::VectorXd right = Eigen::VectorXd::Zero(1 + index(others_.size()));
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

    /// Newton's method from `unknowns`, damped where it would overshoot. `at_` is the evaluation at what it leads to.
    bool correct(Eigen::VectorXd& unknowns, const Eigen::VectorXd& wanted, std::size_t& iterations,
                 std::string& problem) {
        constexpr double nearly = 1e-6; // corrections below this are small enough for round-off to decide
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
                           (size < nearly || off(tried_) <= (1 - 0.1 * factor) * residual);
                if (tried_.took_too_long)
                    break;
            }
            if (!improved) {
                problem =
                    tried_.problem.empty() ? "residuals do not fall" : tried_.problem; // the same for many devices
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

    double off(const OrbitEvaluation& at) const {
        const double unit = condition_->gradient().transpose().cwiseProduct(at.scales).norm();
        return unit > 0 ? std::max(at.residual, std::abs(condition_->value()) / unit) : at.residual;
    }

    /// One part of the way. What Newton's method corrects must be a part of what was predicted: else it may have gone
    /// to another solution.
    bool go(const OrbitEvaluation& from, const Eigen::MatrixXd& directions, const Eigen::VectorXd& wanted,
            LocatedSolution& result) {
        constexpr double no_way = 1e-6, largest_part = 0.3;
        const Eigen::VectorXd change = directions * (wanted - from.unknowns.tail(wanted.size()));
        const Eigen::VectorXd predicted = from.unknowns + change;
        Eigen::VectorXd unknowns = predicted;
        if (!(size_of(change) <= longest_way)) {
            result.problem = "the orbit changes too much on the way";
            return false;
        }
        if (!correct(unknowns, wanted, result.iterations, result.problem))
            return false;
        const double correction = size_of(unknowns - predicted), way = size_of(change);
        if (correction > std::max(largest_part * way, no_way)) {
            result.problem = "Newton's method leads too far away from what is predicted";
            return false;
        }
        return true;
    }

    /// A touch that has left its segment is looked for in the others of the predicted orbit.
    bool pass_on(const OrbitEvaluation& from, const Eigen::MatrixXd& directions, const Eigen::VectorXd& wanted) {
        constexpr double near = 1e-2; // of the function's size along the arc
        if (point_.type != PointType::grazing || point_.at_end)
            return false;
        const Eigen::VectorXd change = directions * (wanted - from.unknowns.tail(wanted.size()));
        if (!(size_of(change) <= longest_way) || !equations_.evaluate(from.unknowns + change, at_))
            return false;
        double nearest = near;
        bool found = false;
        SpecialPoint passed = point_;
        passed.solution.orbit = equations_.orbit_of(at_.unknowns);
        for (const OrbitMinimum& minimum : certify(equations_, at_).minima)
            if (minimum.event == point_.event && std::abs(minimum.value) < nearest * minimum.size) {
                nearest = std::abs(minimum.value) / minimum.size;
                passed.segment = minimum.segment;
                passed.time = minimum.time;
                found = true;
            }
        if (!found || passed.segment == point_.segment)
            return false;
        point_ = std::move(passed);
        make_condition(at_);
        return true;
    }

    /// The way to the others' values in parts, each predicted from the end of the one before.
    bool divide(const Eigen::VectorXd& target, LocatedSolution& result) {
        OrbitEvaluation from = neighbour_;
        Eigen::MatrixXd directions = neighbour_directions_;
        const Eigen::VectorXd start = neighbour_.unknowns.tail(target.size());
        double done = 0, part = 1;
        for (std::size_t halvings = 0; done < 1;) {
            if (halvings++ == options_.halvings)
                return false;
            for (part = std::min(part / 2, 1 - done); done < 1; done += part) {
                part = std::min(part, 1 - done);
                const Eigen::VectorXd wanted =
                    done + part < 1 ? Eigen::VectorXd(start + (done + part) * (target - start)) : target;
                if (!go(from, directions, wanted, result) &&
                    !(pass_on(from, directions, wanted) && go(from, directions, wanted, result)))
                    break;
                ++result.parts;
                from = at_;
                condition_->renew(equations_, from);
                if (!condition_->evaluate(equations_, from) || !directions_at(from, directions))
                    return false;
            }
        }
        result.parts -= 1; // the one that was not gone at once
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
    SpecialPoint point_, own_; ///< whose condition is held; that of the nominal solution
    std::vector<ParameterId> others_;
    ParameterId control_;
    Simulation simulation_;
    Shooting equations_;
    std::unique_ptr<OrbitCondition> condition_;
    OrbitEvaluation at_, tried_;
    OrbitEvaluation neighbour_;            ///< at the point
    Eigen::MatrixXd neighbour_directions_; ///< of the unknowns there, a column for each of the others
    double value_ = 0;
    std::vector<double> values_, derivatives_;
    TouchedOnce maps_;
};

LocatedValue::LocatedValue(const System& system, const SpecialPoint& point, ParameterId control,
                           std::vector<ParameterId> others, const LocatedValueOptions& options)
    : solver_(std::make_unique<Solver>(system, point, control, std::move(others), options)) {}
LocatedValue::~LocatedValue() = default;
LocatedValue::LocatedValue(LocatedValue&&) noexcept = default;

ParameterId LocatedValue::control() const {
    return solver_->control();
}
const std::vector<ParameterId>& LocatedValue::others() const {
    return solver_->others();
}
double LocatedValue::value() const {
    return solver_->value();
}
const std::vector<double>& LocatedValue::values() const {
    return solver_->values();
}
const Orbit& LocatedValue::orbit() const {
    return solver_->orbit();
}
const std::vector<double>& LocatedValue::derivatives() const {
    return solver_->derivatives();
}
LocatedSolution LocatedValue::operator()(std::span<const double> values) {
    return solver_->solve(values);
}

} // namespace graze
