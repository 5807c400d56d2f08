#include "identify/fit_information.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"

#include <cmath>

namespace graze {

namespace {

/// The triangular factor R of a matrix's QR decomposition, padded to as many rows as columns.
Eigen::MatrixXd triangle(Eigen::MatrixXd matrix) {
    if (matrix.rows() < matrix.cols())
        matrix.conservativeResizeLike(Eigen::MatrixXd::Zero(matrix.cols(), matrix.cols()));
    const Eigen::Index size = matrix.cols();
    make_triangular(matrix);
    return matrix.topRows(size).triangularView<Eigen::Upper>();
}

/// Rows of one record. Columns: its unknown initial states, the shared unknowns, the residuals.
Eigen::MatrixXd record_rows(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known,
                            std::size_t first, std::size_t last, double joint, double& eliminated) {
    const std::vector<FitPiece>& pieces = rows.layout.pieces;
    Eigen::MatrixXd carried;
    for (std::size_t k = last + 1; k-- > first;) {
        const PieceRows& piece = known[k];
        if (!pieces[k].has_next) {
            carried = piece.readings;
            continue;
        }
        // Columns: states of the next piece, states of this piece, shared unknowns, residuals.
        const Eigen::Index ahead = point.states[k + 1].size(), own = piece.readings.cols(), behind = carried.rows();
        const Eigen::Index states = own - (carried.cols() - ahead);
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(behind + own + ahead, ahead + own);
        all.topLeftCorner(behind, ahead) = carried.leftCols(ahead);
        all.block(0, ahead + states, behind, own - states) = carried.rightCols(own - states);
        all.block(behind, ahead, own, own) = piece.readings;
        all.block(behind + own, 0, ahead, ahead).diagonal().setConstant(-joint);
        Eigen::MatrixXd ends = piece.ends.leftCols(own - 1);
        rows.add_period_slopes(piece, point.states[k + 1], ends.rightCols(rows.layout.shared()));
        all.block(behind + own, ahead, ahead, own - 1) = joint * ends;
        all.block(behind + own, ahead + own - 1, ahead, 1) = joint * rows.gap(piece, point.states[k + 1]);
        // Gap rows are far heavier than reading rows; placing them first keeps the Householder reflections accurate for
        // both.
        Eigen::MatrixXd sorted(all.rows(), all.cols());
        sorted << all.bottomRows(ahead), all.topRows(behind + own);
        const Eigen::MatrixXd factor = triangle(std::move(sorted));
        eliminated += factor.col(ahead + own - 1).head(ahead).squaredNorm();
        carried = factor.bottomRightCorner(own, own);
    }
    return carried;
}

} // namespace

FitInformation information_of(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known,
                              double joint) {
    const std::vector<FitPiece>& pieces = rows.layout.pieces;
    const Eigen::Index shared = rows.layout.shared();
    Eigen::Index states = 0;
    for (std::size_t k = 0; k < pieces.size(); ++k)
        states += pieces[k].is_first ? point.states[k].size() : 0;
    FitInformation result;
    Eigen::MatrixXd carried = Eigen::MatrixXd::Zero(0, states + shared + 1);
    Eigen::Index at = 0;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (!pieces[k].is_first)
            continue;
        std::size_t last = k;
        while (pieces[last].has_next)
            ++last;
        const Eigen::MatrixXd one = record_rows(rows, point, known, k, last, joint, result.eliminated);
        const Eigen::Index own = one.cols() - shared - 1, before = carried.rows();
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(before + one.rows(), carried.cols());
        all.topRows(before) = carried;
        all.block(before, at, one.rows(), own) = one.leftCols(own);
        all.bottomRightCorner(one.rows(), shared + 1) = one.rightCols(shared + 1);
        carried = triangle(std::move(all));
        at += own;
    }
    result.rows = std::move(carried);
    return result;
}

FitDecomposition decompose(const FitInformation& information, const std::vector<bool>& held) {
    // Derivatives are accurate to about ten digits; smaller singular values may be their error.
    constexpr double negligible = 1e-9, involved = 1e-3;
    const Eigen::Index count = information.rows.cols() - 1;
    FitDecomposition result;
    Eigen::MatrixXd scaled = information.rows.topLeftCorner(count, count);
    for (Eigen::Index c = 0; c < count; ++c)
        if (held[static_cast<std::size_t>(c)])
            scaled.col(c).setZero();
    result.lengths = scaled.colwise().norm();
    const double longest = count > 0 ? result.lengths.maxCoeff() : 0;
    for (Eigen::Index c = 0; c < count; ++c)
        scaled.col(c) = result.lengths[c] > 1e-13 * longest ? Eigen::VectorXd(scaled.col(c) / result.lengths[c])
                                                            : Eigen::VectorXd::Zero(count);
    const SingularValues factors = singular_values(scaled, SingularVectors::thin);
    result.values = factors.values;
    result.directions = factors.right;
    result.covariance = Eigen::MatrixXd::Zero(count, count);
    result.step = Eigen::VectorXd::Zero(count);
    const Eigen::VectorXd left = factors.left.transpose() * information.rows.col(count).head(count);
    result.known.assign(static_cast<std::size_t>(count), true);
    for (Eigen::Index k = 0; k < count; ++k) {
        const bool determined = result.values[k] > negligible * result.values[0];
        result.determined.push_back(determined);
        const Eigen::VectorXd direction = result.directions.col(k);
        if (determined) {
            result.covariance += direction * direction.transpose() / (result.values[k] * result.values[k]);
            result.gain += left[k] * left[k];
            result.step -= direction * (left[k] / result.values[k]);
        } else
            for (Eigen::Index c = 0; c < count; ++c)
                if (std::abs(direction[c]) > involved)
                    result.known[static_cast<std::size_t>(c)] = false;
    }
    for (Eigen::Index i = 0; i < count; ++i)
        result.step[i] = result.lengths[i] > 0 ? result.step[i] / result.lengths[i] : 0;
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index j = 0; j < count; ++j) {
            const double size = result.lengths[i] * result.lengths[j];
            result.covariance(i, j) = size > 0 ? result.covariance(i, j) / size : 0;
        }
    for (Eigen::Index c = 0; c < count; ++c)
        if (held[static_cast<std::size_t>(c)])
            result.known[static_cast<std::size_t>(c)] = false;
    return result;
}

} // namespace graze
