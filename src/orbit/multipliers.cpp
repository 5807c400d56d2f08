#include "base/neutral_multipliers.hpp"

#include "base/decompositions.hpp"
#include "base/leading_eigenvalues.hpp"
#include "base/linear_systems.hpp"
#include "orbit/certify.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace graze {

namespace {

/// Largest condition number of one factor: beyond it small multipliers would be lost in round-off.
constexpr double most_contraction = 1e5;
/// Largest number of parts into which a piece is divided to keep the condition number low.
constexpr double most_parts = 1024;

/// Returns the derivatives of the start of the next piece from those of the end of this one at fixed time, corrected
/// for the end time that the end condition determines (saltation: Aizerman and Gantmakher 1958). Empty when the end
/// condition is reached with zero speed.
Eigen::MatrixXd with_saltation(const OrbitEquations& equations, const OrbitEvaluation& at, std::size_t k,
                               Eigen::MatrixXd flow) {
    const OrbitLayout& layout = equations.layout();
    const auto n = index(layout.states());
    const OrbitEvaluation::Piece& piece = at.pieces[k];
    if (layout.has_end(k) && !layout.accumulates(k)) { // the time of accumulation is part of the flow already
        const Eigen::RowVectorXd gradient = piece.condition.head(n).transpose();
        const double rate = gradient.dot(piece.field);
        // Contacts that accumulate are slow by nature.
        const double least = layout.is_contact(k) ? least_rate * least_rate : least_rate;
        if (!(std::abs(rate) > least * equations.typical_rate_of_piece(at, k)))
            return {};
        flow -= piece.field * (gradient * flow) / rate;
    }
    return jump_times(piece, flow);
}

/// Returns an orthonormal basis of the orthogonal complement of a vector, in columns.
Eigen::MatrixXd complement(const Eigen::VectorXd& vector) {
    const Eigen::Index n = vector.size();
    if (!(vector.norm() > 0))
        return Eigen::MatrixXd::Identity(n, n);
    return orthogonal_complement(vector);
}

/// A product of matrices of which most elements are negligible, without forming it.
class SparseProduct : public LinearMap {
public:
    /// @param factors the first is applied first; @param directions those at the start of each factor that are
    /// projected out; none: nothing is
    SparseProduct(const std::vector<Eigen::MatrixXd>& factors, const std::vector<Eigen::VectorXd>& directions) {
        constexpr double negligible = 0x1p-60; // of the largest element: far below the error of each
        for (const Eigen::MatrixXd& factor : factors)
            factors_.emplace_back(factor.sparseView(factor.cwiseAbs().maxCoeff(), negligible));
        for (const Eigen::VectorXd& direction : directions)
            directions_.push_back(direction.normalized());
    }
    Eigen::Index size() const override { return factors_.front().rows(); }
    /// True if products with vectors take less time than those of full matrices that separate eigenvalues.
    bool pays() const {
        constexpr double full_products = 13500, full_vectors = 0.12; // from measurements
        const auto n = static_cast<double>(size()), count = static_cast<double>(factors_.size());
        double elements = 0;
        for (const Eigen::SparseMatrix<double>& factor : factors_)
            elements += static_cast<double>(factor.nonZeros());
        return elements < n * n * (full_vectors + n * (count + 1) / full_products);
    }
    Eigen::VectorXd times(const Eigen::VectorXd& vector) const override {
        Eigen::VectorXd result = vector;
        project(0, result);
        for (std::size_t k = 0; k < factors_.size(); ++k) {
            result = Eigen::VectorXd(factors_[k] * result);
            project((k + 1) % factors_.size(), result);
        }
        return result;
    }
    Eigen::VectorXd transposed_times(const Eigen::VectorXd& vector) const override {
        Eigen::VectorXd result = vector;
        project(0, result);
        for (std::size_t k = factors_.size(); k-- > 0;) {
            result = Eigen::VectorXd(factors_[k].transpose() * result);
            project(k, result);
        }
        return result;
    }

private:
    void project(std::size_t k, Eigen::VectorXd& vector) const {
        if (!directions_.empty())
            vector -= directions_[k] * directions_[k].dot(vector);
    }
    std::vector<Eigen::SparseMatrix<double>> factors_;
    std::vector<Eigen::VectorXd> directions_;
};

/// The derivative of the section map as a product of factors, restricted to active states, in balanced units.
class SectionMapFactors {
public:
    SectionMapFactors(const OrbitEquations& equations, const OrbitEvaluation& at)
        : equations_(&equations), at_(&at), active_(&at.active), work_(equations.system().workspace()),
          inputs_(equations.layout().states() + at.parameters.size()) {
        std::ranges::copy(at.parameters, inputs_.begin() + static_cast<std::ptrdiff_t>(equations.layout().states()));
        units_.resize(index(active_->size()));
        for (std::size_t i = 0; i < active_->size(); ++i)
            units_[index(i)] = at.scales[index((*active_)[i])];
        balance();
    }

    /// Appends the factors of a piece. @param undivided leaves it whole even where it contracts so much that small
    /// multipliers are lost. @return false when its end is reached with zero speed
    bool add(std::size_t k, bool undivided = false) {
        const OrbitLayout& layout = equations_->layout();
        const auto n = index(layout.states());
        const double* start = at_->unknowns.data() + layout.start_of(k);
        mode_ = equations_->mode_of(k);
        std::vector<Eigen::MatrixXd> flows{at_->pieces[k].flow.leftCols(n)};
        std::vector<std::vector<double>> starts{{start, start + n}};
        if (!undivided && !layout.accumulates(k) && contracts(flows[0]))
            split(at_->unknowns[index(layout.duration_of(k))], flows, starts);
        flows.back() = with_saltation(*equations_, *at_, k, flows.back());
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

    /// Returns the factors projected onto the complement of the flow direction at each start: shifts along the flow are
    /// removed.
    std::vector<Eigen::MatrixXd> without_shifts() const;

    /// True if the flow moves at all starts: shifts along it can be removed.
    bool all_move() const {
        return std::ranges::all_of(directions_, [](const Eigen::VectorXd& one) { return one.norm() > 0; });
    }
    /// Returns the eigenvalues of their product that lie outside a circle.
    std::optional<LeadingEigenvalues> leading() const;

private:
    /// Chooses units that balance rows and columns of the derivatives (E. E. Osborne 1960). The scales of the orbit are
    /// arbitrary for constant states, and where the units of position and velocity do not match, every oscillation
    /// would look like a contraction. What may be round-off must not count: the rate of a clock depends on no state,
    /// and units that balance its round-off would make that as large as the derivatives (D. S. Watkins 2006).
    void balance() {
        constexpr double round_off = 1e-13; // of an element, relative to its row
        const Eigen::Index n = units_.size();
        Eigen::MatrixXd sizes = Eigen::MatrixXd::Zero(n, n);
        for (const OrbitEvaluation::Piece& piece : at_->pieces)
            if (const Eigen::MatrixXd one = restricted(piece.flow).cwiseAbs(); n > 0)
                sizes.array() +=
                    (one.array() > round_off * one.rowwise().maxCoeff().replicate(1, n).array()).select(one.array(), 0);
        if (!sizes.allFinite())
            return;
        sizes.diagonal().setZero();
        if (n <= many_states) {
            balance(sizes, units_);
            return;
        }
        // Along a chain of states whose scales fall steadily rows and columns are alike, although a disturbance that
        // runs along it would seem to grow without limit: units that are all equal may be better.
        Eigen::VectorXd equal = Eigen::VectorXd::Ones(n);
        Eigen::MatrixXd others = units_.asDiagonal() * sizes * units_.cwiseInverse().asDiagonal();
        const double size = balance(sizes, units_), other = balance(others, equal);
        if (other < size)
            units_ = equal;
    }
    /// Changes units step by step. @return the sum of all sizes in these units
    static double balance(Eigen::MatrixXd& sizes, Eigen::VectorXd& units) {
        constexpr int sweeps = 4;
        constexpr double farthest = 1e12;
        const Eigen::VectorXd before = units;
        for (int sweep = 0; sweep < sweeps; ++sweep)
            for (Eigen::Index i = 0; i < units.size(); ++i) {
                const double ratio = std::sqrt(sizes.row(i).sum() / sizes.col(i).sum());
                if (!(ratio > 0 && std::isfinite(ratio)))
                    continue;
                const double unit = std::clamp(units[i] * ratio, before[i] / farthest, before[i] * farthest);
                sizes.row(i) *= units[i] / unit;
                sizes.col(i) *= unit / units[i];
                units[i] = unit;
            }
        return sizes.sum();
    }
    /// The drifting state from which an active one is measured, if it is translated with one.
    const std::optional<std::size_t>& drifts_with(std::size_t active) const {
        return equations_->model().states[(*active_)[active]].drifts_with;
    }
    Eigen::MatrixXd restricted(const Eigen::MatrixXd& matrix) const {
        const auto& active = *active_;
        Eigen::MatrixXd result(index(active.size()), index(active.size()));
        for (std::size_t i = 0; i < active.size(); ++i) {
            const auto& with = drifts_with(i);
            for (std::size_t j = 0; j < active.size(); ++j) {
                double value = matrix(index(active[i]), index(active[j]));
                if (with)
                    value -= matrix(index(*with), index(active[j]));
                result(index(i), index(j)) = value * units_[index(j)] / units_[index(i)];
            }
        }
        return result;
    }
    Eigen::VectorXd direction(const std::vector<double>& state) {
        std::ranges::copy(state, inputs_.begin());
        std::vector<double> field(state.size());
        equations_->system().mode(mode_).rates.evaluate(inputs_, field, work_);
        Eigen::VectorXd result(index(active_->size()));
        for (std::size_t i = 0; i < active_->size(); ++i)
            result[index(i)] =
                (field[(*active_)[i]] - (drifts_with(i) ? field[*drifts_with(i)] : 0)) / units_[index(i)];
        return result;
    }
    /// True when the condition number of the restricted matrix is too large.
    bool contracts(const Eigen::MatrixXd& flow) const {
        const Eigen::MatrixXd matrix = restricted(flow);
        if (matrix.size() == 0 || !matrix.allFinite())
            return false;
        return !(matrix.norm() * PartialLU(matrix).inverse().norm() < most_contraction);
    }
    /// Divides a piece into parts of which none contracts too much. The length of a part adapts to the last accepted
    /// one, down to a smallest length; where the integration fails, the piece stays undivided.
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
            // The last part takes a short remainder with it.
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
    Eigen::VectorXd units_;        ///< units of the active states
    std::optional<ModeFlow> flow_; ///< made when first needed
    std::size_t mode_ = 0;
    std::vector<double> work_, inputs_;
    std::vector<Eigen::MatrixXd> factors_;
    std::vector<Eigen::VectorXd> directions_; ///< direction of the flow at the start of each factor
};

std::vector<Eigen::MatrixXd> SectionMapFactors::without_shifts() const {
    std::vector<Eigen::MatrixXd> result = factors_;
    if (!factors_.empty() && index(active_->size()) > many_states) {
        for (std::size_t k = 0; k < result.size() && all_move(); ++k)
            result[k] = between_complements(directions_[(k + 1) % result.size()], factors_[k], directions_[k]);
        return result;
    }
    std::vector<Eigen::MatrixXd> bases;
    bool shifts = true;
    for (const Eigen::VectorXd& direction : directions_) {
        bases.push_back(complement(direction));
        shifts = shifts && bases.back().cols() + 1 == bases.back().rows();
    }
    for (std::size_t k = 0; k < result.size() && shifts; ++k)
        result[k] = bases[(k + 1) % bases.size()].transpose() * factors_[k] * bases[k];
    return result;
}

std::optional<LeadingEigenvalues> SectionMapFactors::leading() const {
    // Largest product of the norms of the factors, for which those of the leading multipliers keep their digits.
    constexpr double most_growth = 1e5;
    double growth = 1;
    const double size = std::sqrt(static_cast<double>(factors_.front().rows()));
    for (const Eigen::MatrixXd& factor : factors_)
        growth *= factor.norm() / size;
    if (!(growth < most_growth))
        return std::nullopt;
    const SparseProduct sparse(factors_, all_move() ? directions_ : std::vector<Eigen::VectorXd>());
    if (sparse.pays())
        return leading_eigenvalues(sparse);
    const std::vector<Eigen::MatrixXd> map = without_shifts();
    Eigen::MatrixXd product = map.front();
    for (std::size_t k = 1; k < map.size(); ++k)
        product = Eigen::MatrixXd(map[k] * product);
    return leading_eigenvalues(product);
}

/// Returns the eigenvalues of the product itself if they are of similar magnitude, so that none loses digits to
/// another; empty otherwise, or if the product is not finite.
std::vector<std::complex<double>> similar_eigenvalues(const std::vector<Eigen::MatrixXd>& factors) {
    constexpr std::size_t most_factors = 8; // each adds its round-off
    constexpr double least = 0.1;           // of a typical magnitude
    if (factors.size() > most_factors)
        return {};
    Eigen::MatrixXd product = factors.front();
    const double size = std::sqrt(static_cast<double>(product.rows()));
    double typical = product.norm() / size;
    for (std::size_t k = 1; k < factors.size(); ++k) {
        product = factors[k] * product;
        typical *= factors[k].norm() / size;
    }
    const auto values = product.allFinite() ? eigenvalues(product) : std::nullopt;
    if (!values || !(values->cwiseAbs().minCoeff() >= least * typical))
        return {};
    return {values->begin(), values->end()};
}

/// Enough to separate eigenvalues whose moduli differ by a factor of six.
constexpr int most_sweeps = 16;
constexpr double coupling_tolerance = 1e-13;
/// Diagonal elements below this share of the factor's norm count as zero: the factor is singular, as the jump that sets
/// a velocity to zero.
constexpr double eigenvalue_roundoff = 4e-16;

} // namespace

std::size_t moving_neutral_states(const OrbitEquations& equations, const OrbitEvaluation& at) {
    constexpr double same = 1e-7;
    const OrbitLayout& layout = equations.layout();
    std::size_t count = 0;
    for (std::size_t i = 0; i < layout.states(); ++i) {
        if (equations.model().states[i].drifting || at.periods[i] > 0 ||
            std::ranges::find(at.active, i) != at.active.end())
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
    // With a single active state only the shift along the flow remains: the section map is constant.
    const bool constant_map = at.active.size() == 1 && map.front().size() == 0;
    std::vector<std::complex<double>> result;
    if (!constant_map)
        result = product_eigenvalues(map);
    else if (neutral == 0)
        result = {0.0};
    add_neutral_multipliers(result, neutral);
    return result;
}

std::optional<LeadingMultipliers> leading_multipliers(const OrbitEquations& equations, const OrbitEvaluation& at) {
    if (index(at.active.size()) <= many_states)
        return std::nullopt;
    SectionMapFactors factors(equations, at);
    for (std::size_t k = 0; k < equations.layout().pieces(); ++k)
        if (!factors.add(k, true))
            return std::nullopt;
    auto found = factors.leading();
    if (!found)
        return std::nullopt;
    LeadingMultipliers result{std::move(found->values), 0, found->others_within};
    result.others = at.active.size() - (factors.all_move() ? 1 : 0) - result.values.size();
    add_neutral_multipliers(result.values, moving_neutral_states(equations, at));
    return result;
}

std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors) {
    std::vector<std::complex<double>> result;
    if (factors.empty() || factors.front().rows() == 0)
        return result;
    const auto largest_first = [](auto& values) {
        std::ranges::stable_sort(values, [](auto a, auto b) { return std::abs(a) > std::abs(b); });
    };
    result = similar_eigenvalues(factors);
    if (!result.empty()) {
        largest_first(result);
        return result;
    }
    const Eigen::Index n = factors.front().rows();
    Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(n, n), before = basis;
    std::vector<Eigen::MatrixXd> triangles(factors.size());
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        before = basis;
        for (std::size_t k = 0; k < factors.size(); ++k) {
            OrthogonalFactors image = orthogonal_factors(factors[k] * basis);
            triangles[k] = std::move(image.triangle);
            basis = std::move(image.orthogonal);
        }
    }
    // In the basis before the last sweep the product is turn * (product of triangles).
    const Eigen::MatrixXd turn = before.transpose() * basis;
    for (Eigen::Index begin = 0; begin < n;) {
        Eigen::Index end = begin + 1;
        while (end < n && turn.block(end, begin, n - end, end - begin).norm() > coupling_tolerance)
            ++end;
        const Eigen::Index size = end - begin;
        Eigen::MatrixXd block = Eigen::MatrixXd::Identity(size, size);
        double exponent = 0;
        bool vanishes = false;
        for (const Eigen::MatrixXd& triangle : triangles) {
            vanishes = vanishes || (size == 1 && std::abs(triangle(begin, begin)) <=
                                                     eigenvalue_roundoff * static_cast<double>(n) * triangle.norm());
            block = triangle.block(begin, begin, size, size) * block;
            const double norm = block.norm();
            if (norm > 0 && std::isfinite(norm)) {
                block /= norm;
                exponent += std::log(norm);
            }
        }
        block = turn.block(begin, begin, size, size) * block;
        const double factor = vanishes ? 0 : std::exp(exponent);
        if (!block.allFinite() || !std::isfinite(factor)) {
            result.insert(result.end(), static_cast<std::size_t>(size), std::numeric_limits<double>::infinity());
        } else {
            const auto values = eigenvalues(block);
            if (!values)
                return {};
            for (Eigen::Index i = 0; i < size; ++i)
                result.push_back((*values)[i] * factor);
        }
        begin = end;
    }
    largest_first(result);
    return result;
}

} // namespace graze
