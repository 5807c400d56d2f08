#include "identify/fit_initialisation.hpp"

#include "base/median.hpp"
#include "identify/fit_start.hpp"

#include <algorithm>

namespace graze {

namespace {

FitStage soft_stage() {
    return {.joint = 1, .most_iterations = 15, .tolerance = 1e-3};
}

class FitInitialisation {
public:
    FitInitialisation(FitRows& rows, FitPoint& point, const FitMinimiser& minimise)
        : rows_(&rows), point_(&point), minimise_(&minimise) {}

    StageReport by_readings() {
        return extend(soft_stage(), [this](std::size_t& k) {
            if (!pieces()[k].is_first)
                continue_from(*rows_, *point_, k);
            return initialise_piece(k);
        });
    }

    StageReport by_prediction() {
        FitStage together = soft_stage();
        together.joint = 30;
        together.most_iterations = 30;
        return extend(together, [this](std::size_t& k) {
            if (pieces()[k].is_first)
                return best_initial_state(alone(k), k);
            continue_from(*rows_, *point_, k, false);
            return StageReport();
        });
    }

private:
    template <class Begin>
    StageReport extend(FitStage together, const Begin& begin) {
        StageReport report;
        std::size_t done = 0;
        for (std::size_t count = 1; done < most_pieces() && !report.interrupted; count *= 2) {
            for (std::size_t k = 0; k < pieces().size() && !report.interrupted; ++k) {
                if (ordinal(k) < done || ordinal(k) >= count)
                    continue;
                if (!pieces()[k].is_first && ends_constrained(*rows_, *point_, k - 1))
                    merge(*rows_, *point_, k--);
                else
                    report = begin(k);
            }
            if (report.interrupted)
                break;
            together.active.clear();
            for (std::size_t k = 0; k < pieces().size(); ++k)
                together.active.push_back(ordinal(k) < count);
            together.prior = prior_weight(*rows_);
            report = (*minimise_)(together);
            update_modes(*rows_, *point_);
            done = count;
        }
        return report;
    }

    FitStage alone(std::size_t piece) const {
        FitStage stage = soft_stage();
        stage.active.assign(rows_->layout.pieces.size(), false);
        stage.active[piece] = true;
        stage.states_only = true;
        stage.prior = 0.03;
        return stage;
    }

    /// Finds the initial state of a piece. If its cost per reading is far larger than usual, a contact is wrong, as
    /// noise near the start of the piece can cause: then the piece starts from the prediction instead, or is merged
    /// with the one before.
    StageReport initialise_piece(std::size_t& piece) {
        constexpr double suspicious = 3;
        StageReport report = best_initial_state(alone(piece), piece);
        const auto readings = [&](std::size_t k) { return static_cast<double>(pieces()[k].last - pieces()[k].first); };
        if (pieces()[piece].is_first || usual_costs_.empty() || report.interrupted ||
            report.cost < suspicious * readings(piece) * median(usual_costs_)) {
            usual_costs_.push_back(report.cost / readings(piece));
            return report;
        }
        const Eigen::VectorXd first = point_->states[piece];
        continue_from(*rows_, *point_, piece, false);
        if (const StageReport other = (*minimise_)(alone(piece)); other.cost < report.cost)
            report = other;
        else
            point_->states[piece] = first;
        if (report.cost < suspicious * readings(piece) * median(usual_costs_))
            return report;
        const FitPoint apart = *point_;
        const FitLayout layout = rows_->layout;
        merge(*rows_, *point_, piece);
        const StageReport merged = (*minimise_)(alone(piece - 1));
        if (merged.cost < report.cost) {
            --piece;
            return merged;
        }
        *point_ = apart;
        rows_->layout = layout;
        return report;
    }

    /// Minimises from each candidate of the initial state, and keeps the best result.
    StageReport best_initial_state(const FitStage& stage, std::size_t piece) {
        StageReport best = (*minimise_)(stage);
        const std::vector<Eigen::VectorXd> others =
            pieces()[piece].is_first ? other_initial_states(*rows_, *point_, piece) : std::vector<Eigen::VectorXd>{};
        Eigen::VectorXd found = point_->states[piece];
        for (const Eigen::VectorXd& other : others) {
            point_->states[piece] = other;
            const StageReport report = (*minimise_)(stage);
            if (report.interrupted)
                return report;
            if (!report.failed && (report.cost < best.cost || best.failed)) {
                best = report;
                found = point_->states[piece];
            }
        }
        point_->states[piece] = found;
        return best;
    }

    /// Number of a piece within its record, from 0.
    std::size_t ordinal(std::size_t piece) const {
        std::size_t count = 0;
        while (!rows_->layout.pieces[piece - count].is_first)
            ++count;
        return count;
    }

    std::size_t most_pieces() const {
        std::size_t most = 0;
        for (std::size_t k = 0; k < rows_->layout.pieces.size(); ++k)
            most = std::max(most, ordinal(k) + 1);
        return most;
    }

    std::vector<FitPiece>& pieces() { return rows_->layout.pieces; }

    FitRows* rows_;
    FitPoint* point_;
    const FitMinimiser* minimise_;
    std::vector<double> usual_costs_{}; ///< cost per reading of the pieces fitted so far
};

} // namespace

double prior_weight(const FitRows& rows) {
    constexpr double usual_change = 0.1;
    return rows.unit() / usual_change;
}

StageReport initialise_by_readings(FitRows& rows, FitPoint& point, const FitMinimiser& minimise) {
    return FitInitialisation(rows, point, minimise).by_readings();
}

StageReport initialise_by_prediction(FitRows& rows, FitPoint& point, const FitMinimiser& minimise) {
    return FitInitialisation(rows, point, minimise).by_prediction();
}

} // namespace graze
