#include "base/neutral_multipliers.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/product_eigenvalues.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Contraction within one factor beyond which small multipliers would be round-off.
constexpr double most_contraction = 1e5;
/// Into how many parts a piece is cut for that at most.
constexpr double most_parts = 1024;

/// Derivatives of the start of the next piece from those of the end of this one at fixed time, where the end condition
/// and not the time says when it ends (saltation: Aizerman and Gantmakher 1958). Empty when it is met without speed.
Eigen::MatrixXd passed(const OrbitEquations& equations, const OrbitEvaluation& at, std::size_t k,
                       Eigen::MatrixXd flow) {
    const OrbitLayout& layout = equations.layout();
    const auto n = index(layout.states());
    const OrbitEvaluation::Piece& piece = at.pieces[k];
    if (layout.is_last(k)) {
        const Eigen::RowVectorXd gradient = piece.condition.head(n).transpose();
        const double rate = gradient.dot(piece.field);
        if (!(std::abs(rate) > least_rate * equations.usual_rate(at, layout.segment_of(k))))
            return {};
        flow -= piece.field * (gradient * flow) / rate;
    }
    return piece.jump.leftCols(n) * flow;
}

/// Orthonormal basis of what is orthogonal to a vector, in columns.
Eigen::MatrixXd complement(const Eigen::VectorXd& vector) {
    const Eigen::Index n = vector.size();
    if (!(vector.norm() > 0))
        return Eigen::MatrixXd::Identity(n, n);
    return orthogonal_complement(vector);
}

/// The section map as factors, restricted to active states and measured in units in which they are balanced.
class SectionMapFactors {
public:
    SectionMapFactors(const OrbitEquations& equations, const OrbitEvaluation& at)
        : equations_(&equations), at_(&at), active_(&at.active), work_(equations.system().workspace()),
          inputs_(equations.layout().states() + at.parameters.size()) {
        std::copy(at.parameters.begin(), at.parameters.end(),
                  inputs_.begin() + static_cast<std::ptrdiff_t>(equations.layout().states()));
        units_.resize(index(active_->size()));
        for (std::size_t i = 0; i < active_->size(); ++i)
            units_[index(i)] = at.scales[index((*active_)[i])];
        balance();
    }

    /// Adds those of a piece. @return false when its end is met without speed
    bool add(std::size_t k) {
        const OrbitLayout& layout = equations_->layout();
        const auto n = index(layout.states());
        const double* start = at_->unknowns.data() + layout.start_of(k);
        mode_ = equations_->mode_of(k);
        std::vector<Eigen::MatrixXd> flows{at_->pieces[k].flow.leftCols(n)};
        std::vector<std::vector<double>> starts{{start, start + n}};
        if (contracts(flows[0]))
            split(at_->unknowns[index(layout.duration_of(k))], flows, starts);
        flows.back() = passed(*equations_, *at_, k, flows.back());
        if (flows.back().size() == 0)
            return false;
        for (std::size_t part = 0; part < flows.size(); ++part) {
            factors_.push_back(restricted(flows[part]));
            directions_.push_back(direction(starts[part]));
            if (!factors_.back().allFinite())
                return false;
        }
        return true;
    }

    /// Shifts along the flow are taken out at the start of each factor: what is left lives in the quotient by it.
    std::vector<Eigen::MatrixXd> without_shifts() const;

private:
    /// Chooses units in which what acts on a state is as large as what it does (E. E. Osborne 1960): those of an orbit
    /// say little of states that it leaves at rest, and where those of position and speed differ, every oscillation
    /// would look like a contraction.
    void balance() {
        constexpr int sweeps = 4;
        constexpr double farthest = 1e12;
        const Eigen::Index n = units_.size();
        Eigen::MatrixXd sizes = Eigen::MatrixXd::Zero(n, n);
        for (const OrbitEvaluation::Piece& piece : at_->pieces)
            sizes += restricted(piece.flow).cwiseAbs();
        if (!sizes.allFinite())
            return;
        sizes.diagonal().setZero();
        const Eigen::VectorXd before = units_;
        for (int sweep = 0; sweep < sweeps; ++sweep)
            for (Eigen::Index i = 0; i < n; ++i) {
                const double ratio = std::sqrt(sizes.row(i).sum() / sizes.col(i).sum());
                if (!(ratio > 0 && std::isfinite(ratio)))
                    continue;
                const double unit = std::clamp(units_[i] * ratio, before[i] / farthest, before[i] * farthest);
                sizes.row(i) *= units_[i] / unit;
                sizes.col(i) *= unit / units_[i];
                units_[i] = unit;
            }
    }
    Eigen::MatrixXd restricted(const Eigen::MatrixXd& matrix) const {
        const auto& active = *active_;
        Eigen::MatrixXd result(index(active.size()), index(active.size()));
        for (std::size_t i = 0; i < active.size(); ++i)
            for (std::size_t j = 0; j < active.size(); ++j)
                result(index(i), index(j)) =
                    matrix(index(active[i]), index(active[j])) * units_[index(j)] / units_[index(i)];
        return result;
    }
    Eigen::VectorXd direction(const std::vector<double>& state) {
        std::copy(state.begin(), state.end(), inputs_.begin());
        std::vector<double> field(state.size());
        equations_->system().mode(mode_).rates.evaluate(inputs_, field, work_);
        Eigen::VectorXd result(index(active_->size()));
        for (std::size_t i = 0; i < active_->size(); ++i)
            result[index(i)] = field[(*active_)[i]] / units_[index(i)];
        return result;
    }
    /// Whether one direction shrinks too much against another: by the matrix and its inverse.
    bool contracts(const Eigen::MatrixXd& flow) const {
        const Eigen::MatrixXd matrix = restricted(flow);
        if (matrix.size() == 0 || !matrix.allFinite())
            return false;
        return !(matrix.norm() * PartialLU<double>(matrix).inverse().norm() < most_contraction);
    }
    /// Follows a piece in parts of which none contracts too much, or what there is must do: each as long as the last
    /// one that was good, shorter where that is too long.
    void split(double duration, std::vector<Eigen::MatrixXd>& flows, std::vector<std::vector<double>>& starts) {
        constexpr double shorter = 0.5, longer = 1.5;
        const auto n = index(equations_->layout().states());
        if (!flow_) {
            flow_ = flow_of(equations_->simulation());
            flow_->set_parameters(at_->parameters);
        }
        std::vector<Eigen::MatrixXd> parts;
        std::vector<std::vector<double>> begins;
        std::vector<double> state = starts.front(), next;
        const double shortest = duration / most_parts;
        double length = shorter * duration;
        for (double remaining = duration; remaining != 0;) {
            // Not a remnant in the end.
            const double here = std::abs(remaining) < longer * std::abs(length) ? remaining : length;
            next = state;
            Eigen::MatrixXd flow;
            if (run(*flow_, mode_, next, here, flow) != ModeFlow::Ending::done)
                return;
            if (std::abs(here) > std::abs(shortest) && contracts(flow)) {
                length = shorter * here;
                continue;
            }
            begins.push_back(state);
            parts.emplace_back(flow.leftCols(n));
            state.swap(next);
            length = longer * here;
            remaining = here == remaining ? 0 : remaining - here;
        }
        flows = std::move(parts);
        starts = std::move(begins);
    }

    const OrbitEquations* equations_;
    const OrbitEvaluation* at_;
    const std::vector<std::size_t>* active_;
    Eigen::VectorXd units_;        ///< of active states
    std::optional<ModeFlow> flow_; ///< once it is needed
    std::size_t mode_ = 0;
    std::vector<double> work_, inputs_;
    std::vector<Eigen::MatrixXd> factors_;
    std::vector<Eigen::VectorXd> directions_; ///< of the flow at the start of each
};

std::vector<Eigen::MatrixXd> SectionMapFactors::without_shifts() const {
    std::vector<Eigen::MatrixXd> bases;
    bool all_move = true;
    for (const Eigen::VectorXd& direction : directions_) {
        bases.push_back(complement(direction));
        all_move = all_move && bases.back().cols() + 1 == bases.back().rows();
    }
    std::vector<Eigen::MatrixXd> result = factors_;
    for (std::size_t k = 0; k < result.size() && all_move; ++k)
        result[k] = bases[(k + 1) % bases.size()].transpose() * factors_[k] * bases[k];
    return result;
}

} // namespace

std::size_t moving_neutral_states(const OrbitEquations& equations, const OrbitEvaluation& at) {
    constexpr double same = 1e-7;
    const OrbitLayout& layout = equations.layout();
    std::size_t count = 0;
    for (std::size_t i = 0; i < layout.states(); ++i) {
        if (equations.model().states[i].drifting || at.periods[i] > 0 ||
            std::find(at.active.begin(), at.active.end(), i) != at.active.end())
            continue;
        double least = at.unknowns[index(i)], greatest = least;
        for (std::size_t k = 0; k < layout.pieces(); ++k)
            for (const double value : {at.pieces[k].end[i], at.pieces[k].after[i]}) {
                least = std::min(least, value);
                greatest = std::max(greatest, value);
            }
        count += greatest - least > same * std::abs(at.unknowns[index(i)]) ? 1 : 0;
    }
    return count;
}

std::vector<std::complex<double>> floquet_multipliers(const OrbitEquations& equations, const OrbitEvaluation& at) {
    SectionMapFactors factors(equations, at);
    for (std::size_t k = 0; k < equations.layout().pieces(); ++k)
        if (!factors.add(k))
            return {};
    const std::size_t neutral = moving_neutral_states(equations, at);
    const std::vector<Eigen::MatrixXd> map = factors.without_shifts();
    // Of a single state nothing is left but the shift along the flow: the map of its section forgets all.
    const bool forgets = at.active.size() == 1 && map.front().size() == 0;
    std::vector<std::complex<double>> result;
    if (!forgets)
        result = product_eigenvalues(map);
    else if (neutral == 0)
        result = {0.0};
    add_neutral_multipliers(result, neutral);
    return result;
}

} // namespace graze
