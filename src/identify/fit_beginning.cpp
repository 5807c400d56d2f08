#include "identify/fit_beginning.hpp"

#include "base/median.hpp"
#include "identify/fit_start.hpp"
#include "identify/other_openings.hpp"

#include <algorithm>

namespace graze {

namespace {

FitStage soft_stage() {
    FitStage stage;
    stage.joint = 1;
    stage.tolerance = 1e-3;
    stage.most_iterations = 15;
    return stage;
}

} // namespace

double prior_weight(const FitRows& rows) {
    constexpr double usual_change = 0.1;
    return rows.unit() / usual_change;
}

StageReport FitBeginning::by_readings() {
    return extend(soft_stage(), [this](std::size_t& k) {
        if (!pieces()[k].opening)
            continue_from(*rows_, *point_, k);
        return begin_piece(k);
    });
}

StageReport FitBeginning::by_prediction() {
    FitStage together = soft_stage();
    together.joint = 30;
    together.most_iterations = 30;
    return extend(together, [this](std::size_t& k) {
        if (pieces()[k].opening)
            return best_opening(alone(k), k);
        continue_from(*rows_, *point_, k, false);
        return StageReport();
    });
}

template <class Begin>
StageReport FitBeginning::extend(FitStage together, const Begin& begin) {
    StageReport report;
    usual_costs_.clear();
    std::size_t done = 0;
    for (std::size_t count = 1; done < most_pieces() && !report.interrupted; count *= 2) {
        for (std::size_t k = 0; k < pieces().size() && !report.interrupted; ++k) {
            if (ordinal(k) < done || ordinal(k) >= count)
                continue;
            if (!pieces()[k].opening && ends_bound(*rows_, *point_, k - 1))
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
        report = minimise_(together);
        update_modes(*rows_, *point_);
        done = count;
    }
    return report;
}

FitStage FitBeginning::alone(std::size_t piece) const {
    FitStage stage = soft_stage();
    stage.active.assign(rows_->layout.pieces.size(), false);
    stage.active[piece] = true;
    stage.states_only = true;
    stage.prior = 0.03;
    return stage;
}

/// Finds the first state of a piece. Where it meets its readings far worse than others do a contact is amiss, as noise
/// can make it near the piece's beginning: then it begins otherwise, or becomes part of the one before.
StageReport FitBeginning::begin_piece(std::size_t& piece) {
    constexpr double amiss = 3;
    StageReport report = best_opening(alone(piece), piece);
    const auto readings = [&](std::size_t k) { return static_cast<double>(pieces()[k].last - pieces()[k].first); };
    if (pieces()[piece].opening || usual_costs_.empty() || report.interrupted ||
        report.cost < amiss * readings(piece) * usual_cost()) {
        usual_costs_.push_back(report.cost / readings(piece));
        return report;
    }
    const Eigen::VectorXd first = point_->states[piece];
    continue_from(*rows_, *point_, piece, false);
    if (const StageReport other = minimise_(alone(piece)); other.cost < report.cost)
        report = other;
    else
        point_->states[piece] = first;
    if (report.cost < amiss * readings(piece) * usual_cost())
        return report;
    const FitPoint apart = *point_;
    const FitLayout layout = rows_->layout;
    merge(*rows_, *point_, piece);
    const StageReport merged = minimise_(alone(piece - 1));
    if (merged.cost < report.cost) {
        --piece;
        return merged;
    }
    *point_ = apart;
    rows_->layout = layout;
    return report;
}

/// By reading, of half of the pieces.
double FitBeginning::usual_cost() {
    return median(usual_costs_);
}

/// From each of the states in which a piece might begin: the one that meets its readings best.
StageReport FitBeginning::best_opening(const FitStage& stage, std::size_t piece) {
    StageReport best = minimise_(stage);
    const std::vector<Eigen::VectorXd> others =
        pieces()[piece].opening ? other_openings(*rows_, *point_, piece) : std::vector<Eigen::VectorXd>{};
    Eigen::VectorXd found = point_->states[piece];
    for (const Eigen::VectorXd& other : others) {
        point_->states[piece] = other;
        const StageReport report = minimise_(stage);
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

/// Which piece of its record.
std::size_t FitBeginning::ordinal(std::size_t piece) const {
    std::size_t count = 0;
    while (!rows_->layout.pieces[piece - count].opening)
        ++count;
    return count;
}

std::size_t FitBeginning::most_pieces() const {
    std::size_t most = 0;
    for (std::size_t k = 0; k < rows_->layout.pieces.size(); ++k)
        most = std::max(most, ordinal(k) + 1);
    return most;
}

} // namespace graze
