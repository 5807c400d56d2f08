#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/product_eigenvalues.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace graze {

namespace {

/// Derivatives of the start of the next piece with respect to that of this one, where the end condition and not the
/// time says when it ends (saltation: Aizerman and Gantmakher 1958). Empty when the condition is met without speed.
Eigen::MatrixXd map_of(const Shooting::Piece& piece, Eigen::Index n) {
    Eigen::MatrixXd flow = piece.flow.leftCols(n);
    if (piece.last) {
        const Eigen::RowVectorXd gradient = piece.condition.head(n).transpose();
        const double rate = gradient.dot(piece.field);
        if (!(std::abs(rate) > 0))
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

} // namespace

std::vector<std::complex<double>> floquet_multipliers(const Shooting& shooting, const Eigen::VectorXd& unknowns) {
    const auto n = index(shooting.states());
    const auto& active = shooting.active();
    const CompiledModel& compiled = shooting.simulation().compiled();
    const std::size_t count = shooting.pieces();
    const auto restricted = [&](const Eigen::MatrixXd& matrix) {
        Eigen::MatrixXd result(index(active.size()), index(active.size()));
        for (std::size_t i = 0; i < active.size(); ++i)
            for (std::size_t j = 0; j < active.size(); ++j)
                result(index(i), index(j)) = matrix(index(active[i]), index(active[j])) *
                                             shooting.scales()[index(active[j])] / shooting.scales()[index(active[i])];
        return result;
    };
    // Shifts along the flow are taken out at the start of each piece: what is left lives in the quotient by it.
    std::vector<Eigen::MatrixXd> bases;
    std::vector<double> inputs(shooting.states() + shooting.parameters().size()), work(compiled.workspace());
    std::copy(shooting.parameters().begin(), shooting.parameters().end(),
              inputs.begin() + static_cast<std::ptrdiff_t>(shooting.states()));
    for (std::size_t k = 0; k < count; ++k) {
        std::copy_n(unknowns.data() + shooting.start_of(k), shooting.states(), inputs.begin());
        std::vector<double> field(shooting.states());
        compiled.mode(shooting.signature()[shooting.piece(k).segment].mode).rates.evaluate(inputs, field, work);
        Eigen::VectorXd direction(index(active.size()));
        for (std::size_t i = 0; i < active.size(); ++i)
            direction[index(i)] = field[active[i]] / shooting.scales()[index(active[i])];
        bases.push_back(complement(direction));
    }
    bool all_move = true;
    for (const Eigen::MatrixXd& basis : bases)
        all_move = all_move && basis.cols() + 1 == basis.rows();
    std::vector<Eigen::MatrixXd> factors;
    for (std::size_t k = 0; k < count; ++k) {
        const Eigen::MatrixXd map = map_of(shooting.piece(k), n);
        if (map.size() == 0 || !map.allFinite())
            return {};
        Eigen::MatrixXd factor = restricted(map);
        if (all_move)
            factor = bases[(k + 1) % count].transpose() * factor * bases[k];
        factors.push_back(std::move(factor));
    }
    return product_eigenvalues(factors);
}

} // namespace graze
