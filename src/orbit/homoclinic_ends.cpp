#include "orbit/homoclinic_ends.hpp"

#include <algorithm>

namespace graze {

void HomoclinicEnds::keep_distances(std::span<const double> begin, std::span<const double> end,
                                    std::span<const double> parameters, const Eigen::VectorXd& scales) {
    saddle_.emplace(system_, mode_, free_, scales);
    if (!saddle_->find(begin, parameters)) {
        problem_ = saddle_->problem();
        return;
    }
    by_unstable_ = saddle_->to_coordinates().topRows(saddle_->unstable());
    by_stable_ = saddle_->to_coordinates().bottomRows(saddle_->stable());
    departure_ = (by_unstable_ * saddle_->from_saddle(begin)).norm();
    approach_ = (by_stable_ * saddle_->from_saddle(end)).norm();
}

bool HomoclinicEnds::set_parameters(std::span<const double> parameters) {
    if (by_stable_.size() == 0) // there is no saddle yet, or none
        return problem_.empty();
    saddle_->follow(parameters);
    problem_ = saddle_->problem();
    if (problem_.empty() && saddle_->unstable() != by_unstable_.rows())
        problem_ = "an eigenvalue of the saddle has crossed the imaginary axis";
    return problem_.empty();
}

HomoclinicEnds::Condition HomoclinicEnds::distance(const Eigen::MatrixXd& measured_by, double kept,
                                                   std::span<const double> state) const {
    const Eigen::VectorXd off = measured_by * saddle_->from_saddle(state);
    const double size = off.norm();
    const Eigen::RowVectorXd by_state = (off / (size > 0 ? size : 1)).transpose() * measured_by;
    Condition result{size - kept, Eigen::VectorXd(by_state.size() + saddle_->state_by_parameters().cols())};
    result.gradient << by_state.transpose(), -(by_state * saddle_->state_by_parameters()).transpose();
    return result;
}

HomoclinicEnds::Condition HomoclinicEnds::departs(std::span<const double> begin) const {
    return distance(by_unstable_, departure_, begin);
}

HomoclinicEnds::Condition HomoclinicEnds::approaches(std::span<const double> end) const {
    return distance(by_stable_, approach_, end);
}

HomoclinicEnds::Projections HomoclinicEnds::projections(std::span<const double> begin,
                                                        std::span<const double> end) const {
    const Saddle& saddle = *saddle_;
    const Eigen::Index u = saddle.unstable(), s = saddle.stable(), n = u + s;
    const Eigen::MatrixXd& coordinates = saddle.to_coordinates();
    Projections result;
    result.values.resize(n);
    result.values << coordinates.bottomRows(s) * saddle.from_saddle(begin),
        coordinates.topRows(u) * saddle.from_saddle(end);
    result.by_begin = Eigen::MatrixXd::Zero(n, n);
    result.by_begin.topRows(s) = coordinates.bottomRows(s);
    result.by_end = Eigen::MatrixXd::Zero(n, n);
    result.by_end.bottomRows(u) = coordinates.topRows(u);
    result.by_parameters.resize(n, saddle.state_by_parameters().cols());
    result.by_parameters << saddle.coordinates_by_parameters(begin).bottomRows(s),
        saddle.coordinates_by_parameters(end).topRows(u);
    return result;
}

bool HomoclinicEnds::have_turned() const {
    // The first coordinates see the vectors of the present spaces, which have length 1, at least by this share.
    constexpr double seen = 0.5;
    const Eigen::Index u = saddle_->unstable(), s = saddle_->stable();
    const auto least = [&](const Eigen::MatrixXd& measured_by, Eigen::Index first, Eigen::Index count) {
        double result = 1;
        for (Eigen::Index k = first; k < first + count; ++k)
            result = std::min(result, (measured_by * saddle_->direction(k)).norm());
        return result;
    };
    return least(by_unstable_, 0, u) < seen || least(by_stable_, u, s) < seen;
}

} // namespace graze
