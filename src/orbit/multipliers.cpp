#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/product_eigenvalues.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Contraction within one factor beyond which small multipliers would be round-off.
constexpr double most_contraction = 1e5;
constexpr std::size_t most_parts = 1024;

/// Derivatives of the start of the next piece from those of the end of this one at fixed time, where the end condition
/// and not the time says when it ends (saltation: Aizerman and Gantmakher 1958). Empty when it is met without speed.
Eigen::MatrixXd passed(const Shooting& shooting, std::size_t k, Eigen::MatrixXd flow) {
    const auto n = index(shooting.states());
    const Shooting::Piece& piece = shooting.piece(k);
    if (piece.last) {
        const Eigen::RowVectorXd gradient = piece.condition.head(n).transpose();
        const double rate = gradient.dot(piece.field);
        if (!(std::abs(rate) > least_rate * shooting.usual_rate(piece.segment)))
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
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(vector);
    const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
    return q.rightCols(n - 1);
}

/// The section map as factors, restricted to active states and measured by their scales.
class SectionMapFactors {
public:
    explicit SectionMapFactors(const Shooting& shooting)
        : shooting_(&shooting), active_(&shooting.active()), work_(shooting.simulation().system().workspace()),
          inputs_(shooting.states() + shooting.parameters().size()) {
        std::copy(shooting.parameters().begin(), shooting.parameters().end(),
                  inputs_.begin() + static_cast<std::ptrdiff_t>(shooting.states()));
    }

    /// Adds those of a piece. @return false when its end is met without speed
    bool add(std::size_t k, const Eigen::VectorXd& unknowns) {
        const auto n = index(shooting_->states());
        const double* start = unknowns.data() + shooting_->start_of(k);
        mode_ = shooting_->signature()[shooting_->piece(k).segment].mode;
        std::vector<Eigen::MatrixXd> flows{shooting_->piece(k).flow.leftCols(n)};
        std::vector<std::vector<double>> starts{{start, start + n}};
        if (contracts(flows[0]))
            split(unknowns[index(shooting_->duration_of(k))], flows, starts);
        flows.back() = passed(*shooting_, k, flows.back());
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
    Eigen::MatrixXd restricted(const Eigen::MatrixXd& matrix) const {
        const auto& active = *active_;
        const Eigen::VectorXd& scales = shooting_->scales();
        Eigen::MatrixXd result(index(active.size()), index(active.size()));
        for (std::size_t i = 0; i < active.size(); ++i)
            for (std::size_t j = 0; j < active.size(); ++j)
                result(index(i), index(j)) =
                    matrix(index(active[i]), index(active[j])) * scales[index(active[j])] / scales[index(active[i])];
        return result;
    }
    Eigen::VectorXd direction(const std::vector<double>& state) {
        std::copy(state.begin(), state.end(), inputs_.begin());
        std::vector<double> field(state.size());
        shooting_->simulation().system().mode(mode_).rates.evaluate(inputs_, field, work_);
        Eigen::VectorXd result(index(active_->size()));
        for (std::size_t i = 0; i < active_->size(); ++i)
            result[index(i)] = field[(*active_)[i]] / shooting_->scales()[index((*active_)[i])];
        return result;
    }
    bool contracts(const Eigen::MatrixXd& flow) const {
        const Eigen::MatrixXd matrix = restricted(flow);
        if (matrix.size() == 0 || !matrix.allFinite())
            return false;
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix);
        const Eigen::VectorXd& values = svd.singularValues();
        return values[values.size() - 1] * most_contraction < values[0];
    }
    /// Follows a piece in ever more parts until none contracts too much, or what there is must do.
    void split(double duration, std::vector<Eigen::MatrixXd>& flows, std::vector<std::vector<double>>& starts) {
        const auto n = index(shooting_->states());
        if (!flow_) {
            flow_ = flow_of(shooting_->simulation());
            flow_->set_parameters(shooting_->parameters());
        }
        for (std::size_t count = 4; count <= most_parts; count *= 4) {
            std::vector<Eigen::MatrixXd> finer;
            std::vector<std::vector<double>> begins;
            std::vector<double> state = starts.front();
            bool good = true;
            for (std::size_t part = 0; part < count; ++part) {
                begins.push_back(state);
                Eigen::MatrixXd flow;
                if (run(*flow_, mode_, state, duration / static_cast<double>(count), flow) != ModeFlow::Ending::done)
                    return;
                good = good && !contracts(flow);
                finer.emplace_back(flow.leftCols(n));
            }
            flows = std::move(finer);
            starts = std::move(begins);
            if (good)
                return;
        }
    }

    const Shooting* shooting_;
    const std::vector<std::size_t>* active_;
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

std::vector<std::complex<double>> floquet_multipliers(const Shooting& shooting, const Eigen::VectorXd& unknowns) {
    SectionMapFactors factors(shooting);
    for (std::size_t k = 0; k < shooting.pieces(); ++k)
        if (!factors.add(k, unknowns))
            return {};
    return product_eigenvalues(factors.without_shifts());
}

} // namespace graze
