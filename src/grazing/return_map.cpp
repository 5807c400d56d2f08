#include "grazing/return_map.hpp"

#include "base/concatenated.hpp"
#include "orbit/certify.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

/// Arcs shorter than this share of the cycle belong to a contact at zero speed.
constexpr double no_time = 1e-6;

/// Propagates derivatives with respect to the state at the touch, and to a parameter, along an orbit.
class DerivativeCarrier {
public:
    DerivativeCarrier(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                      const TouchFunctions& functions, std::optional<std::size_t> free)
        : equations_(equations), at_(at), touch_(touch), functions_(functions), free_(free),
          n_(index(equations.layout().states())), flow_(flow_of(equations.simulation(), equations.free())) {
        flow_.set_parameters(at.parameters);
    }

    ReturnMap propagate() {
        if (!find_touch() || !(touch_.at_end ? pass_from_end() : pass_from_inside()))
            return std::move(result_);
        // Project back onto the surface of zero rate, which may move with the parameter.
        const TouchGeometry& here = result_.geometry;
        Eigen::RowVectorXd row = here.rate_gradient.head(n_).transpose() * rows_;
        if (free_)
            row[n_] += here.rate_gradient[n_ + parameter_index()];
        rows_ -= here.field * (row / here.acceleration);
        if (!rows_.allFinite())
            return fail("derivatives along the orbit are not finite");
        result_.matrix = rows_.leftCols(n_);
        if (free_)
            result_.parameter = rows_.col(n_);
        return std::move(result_);
    }

private:
    ReturnMap fail(std::string reason) {
        result_.reason = std::move(reason);
        return std::move(result_);
    }
    bool refuse(std::string reason) {
        result_.reason = std::move(reason);
        return false;
    }
    Eigen::Index parameter_index() const { return index(equations_.free()[*free_].place()); }
    double duration(std::size_t piece) const { return at_.unknowns[index(equations_.layout().duration_of(piece))]; }
    std::vector<double> start(std::size_t piece) const {
        const double* first = at_.unknowns.data() + equations_.layout().start_of(piece);
        return {first, first + n_};
    }

    /// Finds the piece, time and state of the touch, and the derivatives of the state with respect to the start of the
    /// piece.
    bool find_touch() {
        const OrbitLayout& layout = equations_.layout();
        piece_ = layout.last_piece(touch_.segment);
        time_ = duration(piece_);
        if (!touch_.at_end) {
            piece_ = layout.first_piece(touch_.segment);
            time_ = touch_.time;
            while (piece_ < layout.last_piece(touch_.segment) && time_ > duration(piece_))
                time_ -= duration(piece_++);
            if (!refine_time())
                return refuse("the orbit does not turn back from the surface near the given time");
            if (is_beyond_its_arc())
                return refuse(fmt::format("the touch coincides with the end of segment {} or of the one before",
                                          touch_.segment + 1));
        }
        result_.touch = {functions_.mode(), functions_.event(), start(piece_), at_.parameters, {}};
        for (Eigen::Index i = 0; i < n_; ++i)
            result_.touch.scales.push_back(at_.scales[i]);
        if (run(flow_, functions_.mode(), result_.touch.state, time_, before_) != ModeFlow::Ending::done)
            return refuse("the motion to the touch is not defined");
        result_.piece = piece_;
        result_.time = time_;
        result_.geometry = functions_.at(result_.touch.state, at_.parameters);
        return true;
    }

    /// Refines the time of the touch by Newton's method on the rate of the touched function.
    bool refine_time() {
        constexpr int iterations = 30;
        constexpr double farthest = 0.05, enough = 1e-14; // shares of the cycle
        const double cycle = equations_.orbit_of(at_.unknowns).return_time(), first = time_;
        for (int iteration = 0; iteration < iterations; ++iteration) {
            std::vector<double> state = start(piece_);
            if (flow_.run(functions_.mode(), state, time_) != ModeFlow::Ending::done)
                return false;
            const TouchGeometry here = functions_.at(state, at_.parameters);
            const double step = -here.rate / here.acceleration;
            if (!(std::abs(time_ + step - first) < farthest * cycle))
                return false;
            time_ += step;
            if (std::abs(step) < enough * cycle)
                return true;
        }
        // Where the acceleration is small, round-off prevents full convergence.
        return true;
    }

    /// True when the time of the touch lies outside the arc, in another mode.
    bool is_beyond_its_arc() const {
        constexpr double late = 1e-9; // share of the cycle
        const std::size_t pieces = equations_.layout().pieces();
        const double away = late * equations_.orbit_of(at_.unknowns).return_time();
        return (time_ > duration(piece_) + away && has_contact(piece_)) ||
               (time_ < -away && has_contact((piece_ + pieces - 1) % pieces));
    }

    void begin() { rows_ = Eigen::MatrixXd::Identity(n_, n_ + (free_ ? 1 : 0)); }
    void apply(const Eigen::MatrixXd& derivatives) {
        rows_ = (derivatives.leftCols(n_) * rows_).eval();
        if (free_)
            rows_.col(n_) += derivatives.col(n_ + index(*free_));
    }

    bool pass_from_inside() {
        std::vector<double> state = result_.touch.state;
        Eigen::MatrixXd after;
        if (run(flow_, functions_.mode(), state, duration(piece_) - time_, after) != ModeFlow::Ending::done)
            return refuse("the motion after the touch is not defined");
        begin();
        apply(after);
        const std::size_t pieces = equations_.layout().pieces();
        if (!pass_end(piece_))
            return false;
        for (std::size_t k = 1; k < pieces; ++k) {
            const std::size_t piece = (piece_ + k) % pieces;
            apply(at_.pieces[piece].flow);
            if (!pass_end(piece))
                return false;
        }
        apply(before_);
        return true;
    }

    /// Propagates from a touch at the end of a segment. The contact at the touch and the following segments of zero
    /// duration are skipped.
    bool pass_from_end() {
        const OrbitLayout& layout = equations_.layout();
        const std::size_t pieces = layout.pieces();
        const double cycle = equations_.orbit_of(at_.unknowns).return_time();
        begin();
        std::size_t mode = functions_.mode(), k = 1;
        pass_symmetry(piece_, mode);
        for (; k < pieces && std::abs(duration((piece_ + k) % pieces)) < no_time * cycle; ++k)
            pass_symmetry((piece_ + k) % pieces, mode);
        if (equations_.mode_of((piece_ + k) % pieces) != mode)
            return refuse("after the contact at zero speed the orbit continues in another mode");
        for (; k < pieces; ++k) {
            const std::size_t piece = (piece_ + k) % pieces;
            apply(at_.pieces[piece].flow);
            if (!pass_end(piece))
                return false;
        }
        apply(before_);
        return true;
    }

    /// Applies the symmetry only, after the last piece of a half orbit.
    void pass_symmetry(std::size_t piece, std::size_t& mode) {
        if (!equations_.symmetry() || piece + 1 != equations_.layout().pieces())
            return;
        const System::CompiledJump& map = equations_.system().symmetry(*equations_.symmetry());
        mode = equations_.model().symmetries[*equations_.symmetry()].modes[mode];
        if (map.identity)
            return;
        const std::vector<double> entries = map.jacobian(concatenated(at_.pieces[piece].end, at_.parameters));
        Eigen::MatrixXd derivatives = Eigen::MatrixXd::Identity(n_, n_ + index(equations_.free().size()));
        for (const std::size_t i : map.changed)
            derivatives.row(index(i)).setZero();
        for (std::size_t e = 0; e < map.entries.size(); ++e) {
            const auto [row, column] = map.entries[e];
            if (index(column) < n_)
                derivatives(index(row), index(column)) = entries[e];
            else if (free_ && index(column) - n_ == parameter_index())
                derivatives(index(row), n_ + index(*free_)) = entries[e];
        }
        apply(derivatives);
    }

    bool has_contact(std::size_t piece) const {
        const Segment& segment = equations_.signature()[equations_.layout().segment_of(piece)];
        const bool contact = equations_.layout().is_contact(piece) ||
                             (equations_.layout().is_last(piece) && segment.end == SegmentEnd::event);
        return contact && !is_identity_transition(equations_.system(), segment.index);
    }

    /// Applies the end of a piece: the correction for the event time (saltation), the jump and the symmetry.
    bool pass_end(std::size_t piece) {
        const OrbitEvaluation::Piece& one = at_.pieces[piece];
        if (has_contact(piece)) {
            const double rate = one.condition.head(n_).dot(one.field);
            const std::size_t segment = equations_.layout().segment_of(piece);
            if (!(std::abs(rate) > least_rate * equations_.typical_rate_of_piece(at_, piece)))
                return refuse(fmt::format("the contact that ends segment {} has no speed", segment + 1));
            Eigen::RowVectorXd row = one.condition.head(n_).transpose() * rows_;
            if (free_)
                row[n_] += one.condition[n_ + index(*free_)];
            rows_ -= one.field * (row / rate);
        }
        apply(one.jump);
        remove_whole_periods(piece);
        return true;
    }

    /// Removes whole periods of cyclic states, which may depend on the parameter.
    void remove_whole_periods(std::size_t piece) {
        if (!free_)
            return;
        const System& system = equations_.system();
        const std::vector<double> next = start((piece + 1) % equations_.layout().pieces());
        std::vector<double> rates;
        for (Eigen::Index i = 0; i < n_; ++i) {
            const double period = at_.periods[static_cast<std::size_t>(i)];
            if (!(period > 0))
                continue;
            const auto state = static_cast<std::size_t>(i);
            const double turns = std::round((at_.pieces[piece].after[state] - next[state]) / period);
            if (turns == 0)
                continue;
            if (rates.empty())
                rates = system.period_gradients()(at_.parameters);
            rows_(i, n_) -= turns * rates[state * system.parameters() + equations_.free()[*free_].place()];
        }
    }

    const OrbitEquations& equations_;
    const OrbitEvaluation& at_;
    const OrbitTouch& touch_;
    const TouchFunctions& functions_;
    std::optional<std::size_t> free_;
    Eigen::Index n_;
    ModeFlow flow_;
    std::size_t piece_ = 0;
    double time_ = 0;        ///< time of the touch since the start of the piece
    Eigen::MatrixXd before_; ///< derivatives from there to the touch
    Eigen::MatrixXd rows_;   ///< states x (states + parameter)
    ReturnMap result_;
};

} // namespace

ReturnMap return_map(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                     const TouchFunctions& functions, std::optional<std::size_t> free) {
    return DerivativeCarrier(equations, at, touch, functions, free).propagate();
}

} // namespace graze
