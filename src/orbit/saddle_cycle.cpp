#include "orbit/saddle_cycle.hpp"

#include "base/decompositions.hpp"
#include "flow/cyclic.hpp"
#include "graze/orbit/solve.hpp"
#include "orbit/certify.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

/// Multipliers nearer to the unit circle count as on it: distances that hardly grow or decay have no end.
constexpr double off_circle = 1e-6;

Orbit without_mark(Orbit orbit) {
    orbit.cycle.reset();
    return orbit;
}

/// Returns the eigenvector of the real eigenvalue that is nearest to a number; empty where none is found.
Eigen::VectorXd eigenvector_near(const Eigen::MatrixXd& matrix, double value) {
    const auto found = matrix.allFinite() ? eigensystem(matrix) : std::nullopt;
    if (!found)
        return {};
    Eigen::Index nearest = 0;
    (found->values.array() - value).abs().minCoeff(&nearest);
    const Eigen::VectorXd vector = found->vectors.col(nearest).real();
    return vector.norm() > 0 ? Eigen::VectorXd(vector.normalized()) : Eigen::VectorXd();
}

} // namespace

/// The equations of the cycle, with the free parameters among the unknowns.
class SaddleCycle::Equations {
public:
    Equations(const Simulation& simulation, const Orbit& cycle, std::vector<ParameterId> free)
        : shooting(simulation, cycle, std::move(free)), at(shooting.evaluation()),
          unknowns(shooting.unknowns_of(cycle)) {}

    /// Newton's method at fixed parameters, to round-off.
    bool solve(std::span<const double> parameters) {
        constexpr int iterations = 25;
        constexpr double solved = 1e-8, farthest = 3; // corrections in units of the scales
        const Eigen::Index q = index(shooting.layout().free());
        for (Eigen::Index f = 0; f < q; ++f)
            unknowns[index(shooting.layout().parameter(0)) + f] =
                parameters[shooting.free()[static_cast<std::size_t>(f)].place()];
        double before = 0;
        for (int i = 0; i < iterations; ++i) {
            Eigen::VectorXd step;
            if (!shooting.evaluate(unknowns, at) ||
                !shooting.solve(at, fixed_parameters(), Eigen::VectorXd::Zero(q), false, step))
                return false;
            const double size = step.cwiseQuotient(shooting.scales()).cwiseAbs().maxCoeff();
            if (!(size < farthest))
                return false;
            if (i > 0 && size <= solved && size >= 0.5 * before) // corrections that do not shrink are round-off
                return true;
            unknowns += step;
            if (size == 0)
                return true;
            before = size;
        }
        return false;
    }
    Eigen::MatrixXd fixed_parameters() const {
        const Eigen::Index q = index(shooting.layout().free());
        Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(q, unknowns.size());
        rows.rightCols(q).setIdentity();
        return rows;
    }
    /// Returns the derivatives of the start with respect to the free parameters.
    Eigen::MatrixXd start_by_parameters() const {
        const Eigen::Index n = index(shooting.layout().states()), q = index(shooting.layout().free());
        Eigen::MatrixXd result(n, q);
        const OrbitEquations::Closed closed = shooting.close(at, fixed_parameters());
        for (Eigen::Index f = 0; f < q; ++f) {
            Eigen::VectorXd step;
            if (!shooting.solve(at, closed, Eigen::VectorXd::Unit(q, f), true, step))
                return Eigen::MatrixXd();
            result.col(f) = step.head(n);
        }
        return result;
    }

    Shooting shooting;
    OrbitEvaluation at;
    Eigen::VectorXd unknowns;
};

SaddleCycle::SaddleCycle(const Simulation& simulation, const Orbit& cycle, std::vector<ParameterId> free)
    : equations_(std::make_unique<Equations>(simulation, without_mark(cycle), std::move(free))),
      scales_(equations_->shooting.scales().head(index(simulation.system().states()))), orbit_(without_mark(cycle)) {}
SaddleCycle::~SaddleCycle() = default;
SaddleCycle::SaddleCycle(SaddleCycle&&) noexcept = default;
SaddleCycle& SaddleCycle::operator=(SaddleCycle&&) noexcept = default;

bool SaddleCycle::fail(std::string why) {
    problem_ = std::move(why);
    return false;
}

void SaddleCycle::set_scales(const Eigen::VectorXd& scales) {
    scales_ = scales;
    if (direction_.size() > 0)
        find_spaces();
}

bool SaddleCycle::follow(std::span<const double> parameters) {
    if (problem_.empty() && direction_.size() > 0 && std::ranges::equal(orbit_.parameters, parameters))
        return true;
    problem_.clear();
    const Eigen::VectorXd before = equations_->unknowns;
    Shooting& shooting = equations_->shooting;
    const bool solved = equations_->solve(parameters) && shooting.evaluate(equations_->unknowns, equations_->at);
    if (solved && equations_->at.active.size() != shooting.layout().states())
        fail("a state of the cycle drifts, or returns unchanged wherever it begins");
    if (!solved)
        fail("the cycle is not found" +
             (equations_->at.problem.empty() ? std::string() : ": " + equations_->at.problem));
    if (problem_.empty()) {
        orbit_ = shooting.orbit_of(equations_->unknowns);
        periods_ = equations_->at.periods;
        multipliers_ = floquet_multipliers(shooting, equations_->at);
        if (find_spaces())
            return true;
    }
    equations_->unknowns = before;
    return false;
}

bool SaddleCycle::find_spaces() {
    const Shooting& shooting = equations_->shooting;
    const OrbitEvaluation& at = equations_->at;
    const OrbitLayout& layout = shooting.layout();
    const Eigen::Index n = scales_.size();
    const auto outside = std::ranges::count_if(multipliers_, [](auto one) { return std::abs(one) > 1 + off_circle; }),
               inside = std::ranges::count_if(multipliers_, [](auto one) { return std::abs(one) < 1 - off_circle; });
    if (multipliers_.empty())
        return fail("the multipliers of the cycle are not defined");
    if (outside + inside != std::ssize(multipliers_))
        return fail("a multiplier of the cycle lies on the unit circle: it is no saddle");
    if (outside != 1 || inside == 0)
        return fail(outside == 0  ? "the cycle is stable: it is no saddle"
                    : inside == 0 ? "the cycle has no stable direction: it is no saddle"
                                  : fmt::format("the cycle has {} unstable directions: its homoclinic orbits are "
                                                "found where there is one",
                                                outside));
    links_.assign(layout.segments(), Eigen::MatrixXd::Identity(n, n));
    delays_.assign(layout.segments(), Eigen::RowVectorXd::Zero(n));
    Eigen::MatrixXd around = Eigen::MatrixXd::Identity(n, n);
    for (std::size_t k = 0; k < layout.pieces(); ++k) {
        const OrbitEvaluation::Piece& piece = at.pieces[k];
        const std::size_t segment = layout.segment_of(k);
        Eigen::MatrixXd flow = piece.flow.leftCols(n) * links_[segment];
        if (layout.has_end(k)) {
            const Eigen::RowVectorXd gradient = piece.condition.head(n).transpose();
            delays_[segment] = -(gradient * flow) / gradient.dot(piece.by_time);
            flow += piece.by_time * delays_[segment];
        }
        links_[segment] = piece.jump.leftCols(n) * flow;
        if (layout.is_last(k))
            around = links_[segment] * around;
    }
    const Eigen::MatrixXd scaled = scales_.cwiseInverse().asDiagonal() * around * scales_.asDiagonal();
    const double multiplier = multipliers_.front().real();
    Eigen::VectorXd right = eigenvector_near(scaled, multiplier);
    const Eigen::VectorXd left = eigenvector_near(scaled.transpose(), multiplier);
    if (right.size() == 0 || left.size() == 0 || !(std::abs(left.dot(right)) > 0))
        return fail("the eigenvectors of the cycle are not found");
    if (direction_.size() > 0 && right.dot(direction_.cwiseQuotient(scales_)) < 0)
        right = -right;
    direction_ = right.cwiseProduct(scales_);
    coordinate_ = left.cwiseQuotient(scales_).transpose() / left.dot(right);
    state_by_ = equations_->start_by_parameters();
    return state_by_.rows() == n || fail("the cycle is singular: it is no saddle");
}

double SaddleCycle::growth() const {
    return std::log(std::abs(multipliers_.front()));
}

double SaddleCycle::decay() const {
    constexpr double least = 1e-16; // multipliers below it are round-off
    return -std::log(std::max(std::abs(multipliers_[1]), least));
}

/// Turns away from the cycle contract less than those beside it, which matters where the contraction is strong: orbits
/// begin and end nearer than at an equilibrium. Turns are segments of their own, so that round-off does not grow.
EndDistances SaddleCycle::wanted_distances() const {
    constexpr double effect = 1e-17, greatest = 0.01;
    const EndDistances result = graze::wanted_distances(growth(), decay(), effect);
    return {std::min(result.departure, greatest), std::min(result.approach, greatest)};
}

Eigen::VectorXd SaddleCycle::from_cycle(std::span<const double> state) const {
    Eigen::VectorXd result(scales_.size());
    for (std::size_t i = 0; i < state.size(); ++i)
        result[index(i)] = without_turns(state[i] - orbit_.starts.front()[i], periods_[i]);
    return result;
}

SaddleCycle::Turn SaddleCycle::turn_from(const Eigen::VectorXd& off) const {
    Turn turn;
    turn.off = off;
    for (std::size_t s = 0; s < segments(); ++s) {
        turn.starts.push_back(numbers_of(vector_of(orbit_.starts[s]) + turn.off));
        turn.durations.push_back(orbit_.durations[s] + delays_[s].dot(turn.off));
        turn.off = links_[s] * turn.off;
    }
    return turn;
}

} // namespace graze
