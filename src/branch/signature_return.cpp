#include "branch/signature_return.hpp"

#include "flow/cyclic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

SignatureReturn::SignatureReturn(const Simulation& simulation, const Orbit& orbit, ParameterId parameter,
                                 const Eigen::VectorXd& scales)
    : first_(orbit), parameter_(parameter), flow_(flow_of(simulation, {parameter})),
      ends_(simulation.system(), orbit, {parameter}) {
    ends_.lay_cuts(orbit, scales);
}

bool SignatureReturn::fail(std::string why) {
    problem_ = std::move(why);
    return false;
}

std::optional<SignatureReturn::Image> SignatureReturn::follow(const std::vector<double>& state, double parameter,
                                                              std::span<const double> durations) {
    const Eigen::Index n = index(state.size());
    Image image{first_, state, Eigen::MatrixXd::Identity(n, n + 1)};
    image.motion.parameters[parameter_.place()] = parameter;
    std::ranges::copy(durations, image.motion.durations.begin());
    flow_.set_parameters(image.motion.parameters);
    ends_.set_parameters(image.motion.parameters);
    const double longest = first_.return_time();
    for (std::size_t segment = 0; segment < first_.segments(); ++segment)
        if (!pass_segment(segment, image, longest))
            return std::nullopt;
    return image;
}

/// Finds the duration after which the segment ends, by Newton's method from a motion nearby.
bool SignatureReturn::find_end(std::size_t segment, const std::vector<double>& start, double& duration,
                               double longest) {
    constexpr int iterations = 25;
    constexpr double enough = 1e-15, round_off = 1e-12, farthest = 0.25; // shares of the time of return
    const std::size_t mode = first_.signature[segment].mode;
    const Eigen::Index n = index(start.size());
    double moved = duration, before = 0;
    piece_.end = start;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        if (flow_.run(mode, piece_.end, moved) != ModeFlow::Ending::done)
            return fail(fmt::format("the motion ceases to exist within segment {}", segment + 1));
        piece_.after = piece_.end;
        piece_.jump = Eigen::MatrixXd::Identity(n, n + 1);
        ends_.field(segment, piece_.end, piece_.field);
        if (!ends_.pass(segment, piece_))
            return fail(fmt::format("the jump after segment {} is not defined", segment + 1));
        const double rate = piece_.condition.head(n).dot(piece_.field), step = -piece_.condition_value / rate;
        const double size = std::abs(step);
        if (!(size <= farthest * longest))
            break;
        if (size <= enough * longest || (iteration > 1 && size <= round_off * longest && size >= 0.5 * before))
            return duration > 0 || fail(fmt::format("the duration of segment {} is no longer positive", segment + 1));
        duration += step;
        moved = step;
        before = size;
    }
    return fail(fmt::format("the motion does not come to the end of segment {}", segment + 1));
}

bool SignatureReturn::pass_segment(std::size_t segment, Image& image, double longest) {
    const Eigen::Index n = index(image.after.size());
    const std::vector<double> start = image.motion.starts[segment] = image.after;
    double& duration = image.motion.durations[segment];
    if (!find_end(segment, start, duration, longest))
        return false;
    std::vector<double> end = start;
    if (run(flow_, first_.signature[segment].mode, end, duration, piece_.flow) != ModeFlow::Ending::done)
        return fail(fmt::format("the derivatives of segment {} are not defined", segment + 1));
    const auto then = [n](const Eigen::MatrixXd& later, const Eigen::MatrixXd& earlier) -> Eigen::MatrixXd {
        Eigen::MatrixXd both = later.leftCols(n) * earlier;
        both.col(n) += later.col(n);
        return both;
    };
    Eigen::MatrixXd& derivatives = image.derivatives;
    derivatives = then(piece_.flow, derivatives);
    // The time of the end shifts so that its condition holds.
    Eigen::RowVectorXd change = piece_.condition.head(n).transpose() * derivatives;
    change[n] += piece_.condition[n];
    derivatives -= piece_.field * (change / piece_.condition.head(n).dot(piece_.field));
    derivatives = then(piece_.jump, derivatives);
    if (!derivatives.allFinite())
        return fail(fmt::format("the derivatives of segment {} are not defined", segment + 1));
    image.after = piece_.after;
    remove_turns((segment + 1) % first_.segments(), image);
    return true;
}

/// Brings cyclic states close to those with which a segment of the first orbit begins.
void SignatureReturn::remove_turns(std::size_t next, Image& image) {
    const Eigen::Index n = index(image.after.size());
    for (std::size_t i = 0; i < image.after.size(); ++i) {
        const double period = ends_.periods()[i];
        if (!(period > 0))
            continue;
        const double off = image.after[i] - first_.starts[next][i], turns = std::round(off / period);
        image.after[i] -= turns * period;
        image.derivatives(index(i), n) -= turns * ends_.period_rates()(index(i), 0);
    }
}

} // namespace graze
