#include "orbit/collocation.hpp"

#include "base/linear_systems.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace graze {

namespace {

constexpr std::size_t points = Collocation::points;

/// The start of the unit interval, then its Gauss points.
constexpr std::array<double, points + 1> nodes{0, 0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                               0.9305681557970263};

/// Weights of the polynomial through values at the nodes.
struct Basis {
    Eigen::Matrix<double, points, points + 1> slopes; ///< at the Gauss points, for an interval of length 1
    Eigen::Matrix<double, 1, points + 1> end;         ///< value at the interval's end
};

Basis make_basis() {
    Basis basis;
    for (std::size_t j = 0; j <= points; ++j) {
        // The Lagrange polynomial of node j and its derivative.
        const auto value = [&](double s) {
            double product = 1;
            for (std::size_t k = 0; k <= points; ++k)
                product *= k == j ? 1 : (s - nodes[k]) / (nodes[j] - nodes[k]);
            return product;
        };
        const auto slope = [&](double s) {
            double sum = 0;
            for (std::size_t l = 0; l <= points; ++l) {
                double product = l == j ? 0 : 1 / (nodes[j] - nodes[l]);
                for (std::size_t k = 0; k <= points; ++k)
                    product *= k == j || k == l ? 1 : (s - nodes[k]) / (nodes[j] - nodes[k]);
                sum += product;
            }
            return sum;
        };
        basis.end[index(j)] = value(1);
        for (std::size_t i = 0; i < points; ++i)
            basis.slopes(index(i), index(j)) = slope(nodes[i + 1]);
    }
    return basis;
}

} // namespace

Collocation::Collocation(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free,
                         std::size_t intervals, std::vector<double> ranges)
    : OrbitEquations(simulation, orbit, std::move(free), std::move(ranges)), intervals_(intervals) {
    if (intervals == 0)
        throw InputError("a segment has no intervals", "give at least one");
    if (has_chatter())
        throw InputError("a complete chatter sequence cannot be collocated", "use multiple shooting");
    const std::size_t states = system().states(), inputs = states + system().parameters();
    Model scratch = model();
    for (const Segment& segment : orbit.signature) {
        Rates rates;
        for (const Expression& rate : scratch.expand(scratch.modes[segment.mode].rates)) {
            rates.functions.push_back(system().with_gradient(rate));
            rates.constant.push_back(rate.is_number(0));
        }
        for (const Function& rate : rates.functions)
            work_.resize(std::max(work_.size(), rate.workspace()));
        rates_.push_back(std::move(rates));
    }
    inputs_.resize(inputs);
    values_.resize(1 + inputs);
    lay_out(orbit, std::vector<std::size_t>(orbit.segments(), 1), intervals_ * points * states);
}

void Collocation::set_inner(const Orbit& orbit, Eigen::VectorXd& unknowns) {
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        const double length = orbit.durations[s] / static_cast<double>(intervals_);
        std::vector<double> state = orbit.starts[s];
        double* next = unknowns.data() + layout().inner_of(s);
        for (std::size_t j = 0; j < intervals_; ++j) {
            double before = 0;
            for (std::size_t i = 1; i <= points + 1; ++i) {
                const double here = i <= points ? nodes[i] : 1;
                flow().run(orbit.signature[s].mode, state, (here - before) * length);
                before = here;
                if (i <= points)
                    next = std::copy(state.begin(), state.end(), next);
            }
        }
    }
}

void Collocation::rates_at(const Rates& rates, const double* state, const OrbitEvaluation& at, Eigen::VectorXd& values,
                           Eigen::MatrixXd& derivatives) {
    const std::size_t n = layout().states();
    std::copy(state, state + n, inputs_.begin());
    std::ranges::copy(at.parameters, inputs_.begin() + static_cast<std::ptrdiff_t>(n));
    for (std::size_t i = 0; i < n; ++i) {
        rates.functions[i].evaluate(inputs_, values_, work_);
        values[index(i)] = values_[0];
        derivatives.row(index(i)) = ends().gradient_of(values_).transpose();
    }
}

/// Solves the linearised equations interval by interval. The columns of `changes` are the derivatives with respect to
/// the start, the duration and the free parameters of the segment, then the defect of the inner unknowns.
bool Collocation::follow(std::size_t k, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) {
    static const Basis basis = make_basis();
    const Eigen::Index n = index(layout().states()), q = index(layout().free()), m = index(points),
                       width = n + 1 + q + 1;
    const double part = 1 / static_cast<double>(intervals_), length = unknowns[index(layout().duration_of(k))] * part;
    OrbitEvaluation::Piece& piece = at.pieces[k];
    piece.inner.resize(index(layout().inner()), width);
    Eigen::VectorXd start = unknowns.segment(index(layout().start_of(k)), n), rates(n);
    Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(n, width), derivatives(n, n + q);
    changes.leftCols(n).setIdentity();
    for (std::size_t j = 0; j < intervals_; ++j) {
        const Eigen::Index first = index(j) * m * n;
        const double* values = unknowns.data() + layout().inner_of(k) + first;
        const Eigen::Map<const Eigen::MatrixXd> stages(values, n, m);
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(m * n, m * n), right(m * n, width);
        for (Eigen::Index i = 0; i < m; ++i) {
            rates_at(rates_[k], values + i * n, at, rates, derivatives);
            const auto rows = Eigen::seqN(i * n, n);
            for (Eigen::Index l = 0; l < m; ++l)
                matrix(rows, Eigen::seqN(l * n, n)).diagonal().setConstant(basis.slopes(i, l + 1));
            matrix(rows, rows) -= length * derivatives.leftCols(n);
            right(rows, Eigen::all) = -basis.slopes(i, 0) * changes;
            right(rows, n) += part * rates;
            right(rows, Eigen::seqN(n + 1, q)) += length * derivatives.rightCols(q);
            right(rows, width - 1) -=
                basis.slopes(i, 0) * start + stages * basis.slopes.row(i).tail(m).transpose() - length * rates;
        }
        if (!matrix.allFinite() || !right.allFinite()) {
            at.problem = fmt::format("segment {} leaves the domain of its vector field", k + 1);
            return false;
        }
        const Eigen::MatrixXd solution = PartialLU(matrix).solve_columns(right);
        piece.inner.middleRows(first, m * n) = solution;
        changes *= basis.end[0];
        start *= basis.end[0];
        for (Eigen::Index i = 0; i < m; ++i) {
            changes += basis.end[i + 1] * solution.middleRows(i * n, n);
            start += basis.end[i + 1] * stages.col(i);
        }
    }
    start += changes.rightCols(1);
    for (Eigen::Index i = 0; i < n; ++i) // constant states keep their value exactly, free of round-off
        if (rates_[k].constant[static_cast<std::size_t>(i)]) {
            start[i] = unknowns[index(layout().start_of(k)) + i];
            changes.row(i).setZero();
            changes(i, i) = 1;
        }
    piece.end.assign(start.begin(), start.end());
    piece.flow.resize(n, n + q);
    piece.flow << changes.leftCols(n), changes.middleCols(n + 1, q);
    piece.by_time = changes.col(n);
    ends().field(k, piece.end, piece.field);
    return true;
}

} // namespace graze
